//! What one file lacks and another has: files that were meant as one program, and are checked each by itself.

use std::collections::BTreeMap;

use kirk_compiler::{Code, Diagnostic};

use crate::args::Selection;
use crate::input::Input;

/// Says of every program that a file lacks and another one defines where it is, and how to check both as one.
pub(crate) fn point_out(inputs: &mut [Input], selection: &Selection) {
    if inputs.len() < 2 {
        return;
    }
    let mut homes: BTreeMap<String, (usize, String)> = BTreeMap::new();
    for (index, input) in inputs.iter().enumerate() {
        let programs = input.compilation().into_iter().flat_map(|compilation| &compilation.ast.programs);
        for program in programs {
            let source = input.sources.get(program.name.span.source as usize);
            let file = source.map_or("", |source| source.name.as_str());
            homes.entry(program.name.name.clone()).or_insert((index, file.to_string()));
        }
    }
    for (index, input) in inputs.iter_mut().enumerate() {
        let lacking = |diagnostic: &Diagnostic| match diagnostic.code {
            Code::UnknownProgram => {
                let source = input.sources.get(diagnostic.span.source as usize);
                let word = source.map(|source| source.slice(diagnostic.span));
                word.and_then(|word| word.rsplit(':').next()).map(str::to_lowercase)
            }
            Code::NoEntry => Some(selection.entry().to_lowercase()),
            _ => None,
        };
        let found: Vec<Option<(String, String)>> = input
            .diagnostics
            .iter()
            .map(|diagnostic| {
                let name = lacking(diagnostic)?;
                let (_, file) = homes.get(&name).filter(|(home, _)| *home != index)?;
                Some((name, file.clone()))
            })
            .collect();
        for (diagnostic, found) in input.diagnostics.iter_mut().zip(found) {
            if let Some((name, file)) = found {
                let said =
                    format!("`{name}` is in {file}: `kirk check --together` takes the files as one program.");
                diagnostic.help = Some(match diagnostic.help.take() {
                    Some(help) => format!("{said} {help}"),
                    None => said,
                });
            }
        }
    }
}
