//! What one file lacks and another has: files that were meant as one program, and are checked each by itself.

use std::collections::BTreeMap;

use crate::input::Loaded;

/// Says of every program that a file lacks and another one defines where it is, and how to check both as one.
pub(crate) fn point_out(inputs: &mut [Loaded]) {
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
        for diagnostic in &mut input.diagnostics {
            let Some(name) = &diagnostic.lacks else { continue };
            let Some((_, file)) = homes.get(name).filter(|(home, _)| *home != index) else { continue };
            let said =
                format!("`{name}` is in {file}: `kirk check --together` takes the files as one program.");
            diagnostic.help = Some(match diagnostic.help.take() {
                Some(help) => format!("{said} {help}"),
                None => said,
            });
        }
    }
}
