//! A new name for something, everywhere; or why not.

use std::collections::BTreeMap;

use kirk_compiler::read::{TokenKind, tokens};
use kirk_compiler::words::word;
use kirk_compiler::{Mention, Severity, Span, Symbol, SymbolKind, Symbols};

use crate::analysis::Analysis;
use crate::cursor::pointed_at;
use crate::definition::bare;

/// The name at an offset that can be changed.
pub fn prepare_rename(analysis: &Analysis, offset: u32) -> Result<Span, String> {
    let Some((symbol, place)) = analysis.symbols.at(0, offset) else {
        let written = pointed_at(analysis.text(), offset).map_or("", |cursor| analysis.slice(cursor.word));
        let is_number = matches!(tokens(written).as_slice(), [one] if one.kind == TokenKind::Number);
        return Err(match written {
            "" => "There is no name here.".to_string(),
            _ if is_number => format!("{written} is a number, and no name."),
            _ if word(written).is_some() || written.starts_with(':') => {
                format!("`{written}` is a word of the language.")
            }
            _ => format!("Nothing kirk knows is called `{written}`."),
        });
    };
    renameable(analysis, symbol)?;
    Ok(bare(analysis, place.span))
}

/// All places of the name at an offset with the new name. The program means the same afterwards.
pub fn rename(analysis: &Analysis, offset: u32, new: &str) -> Result<Vec<(Span, String)>, String> {
    prepare_rename(analysis, offset)?;
    let Some((symbol, _)) = analysis.symbols.at(0, offset) else {
        return Err("There is no name here.".to_string());
    };
    let is_name = matches!(tokens(new).as_slice(), [one] if one.kind == TokenKind::Symbol && one.end - one.start == new.len());
    if !is_name || new.contains(':') {
        return Err(format!(
            "`{new}` is not a name: names are letters, digits and `-+*/<>=.!?%&$_~^@`, and no number."
        ));
    }
    if word(new).is_some() || ["t", "nil"].iter().any(|taken| new.eq_ignore_ascii_case(taken)) {
        return Err(format!("`{new}` is a word of the language."));
    }
    let edits: Vec<(Span, String)> =
        symbol.places.iter().map(|place| (bare(analysis, place.span), new.to_string())).collect();
    let (after, _) = analysis.after(&edits);
    let errors = |analysis: &Analysis| {
        let all = analysis.diagnostics.iter().filter(|d| d.severity == Severity::Error);
        all.map(|d| (d.message.clone(), d.span)).collect::<Vec<_>>()
    };
    match difference(&analysis.symbols, &after.symbols) {
        // Two things of one name that nothing means are told by the compiler alone.
        None if after.has_errors() && errors(&after).len() > errors(analysis).len() => {
            let line =
                errors(&after).last().map_or(0, |(_, span)| after.lines_of(*span).line_of(span.start) + 1);
            Err(format!("The name `{new}` is taken: in line {line}, it would be defined twice."))
        }
        None => Ok(edits),
        Some(place) => {
            let line = after.lines_of(place.span).line_of(place.span.start) + 1;
            Err(format!("The name `{new}` is taken: in line {line}, it would mean something else than now."))
        }
    }
}

fn renameable(analysis: &Analysis, symbol: &Symbol) -> Result<(), String> {
    let name = &symbol.name;
    match symbol.kind {
        SymbolKind::Program(_) if name == "main" => {
            Err("A mission starts with `main`: with another name it would not start.".to_string())
        }
        SymbolKind::Package => {
            Err(format!("The package `{name}` is also named by `in-package` and on command lines."))
        }
        SymbolKind::Program(_) | SymbolKind::Label => {
            let home = |kind| match kind {
                SymbolKind::Program(index) => Some(&analysis.program.programs[index].home),
                _ => None,
            };
            let same = |other: &&Symbol| match (other.kind, symbol.kind) {
                (SymbolKind::Program(_), SymbolKind::Program(_)) => home(other.kind) == home(symbol.kind),
                (SymbolKind::Program(_) | SymbolKind::Label, _) => true,
                _ => false,
            };
            match analysis.symbols.symbols.iter().filter(|other| other.name == *name).filter(same).count() {
                1 => Ok(()),
                _ => Err(format!(
                    "Several programs or labels are called `{name}`, and which is meant depends on the place."
                )),
            }
        }
        _ => Ok(()),
    }
}

/// The first place after a renaming that belongs together with others than before.
fn difference(before: &Symbols, after: &Symbols) -> Option<Mention> {
    let numbered = |symbols: &Symbols| {
        let mut seen: BTreeMap<*const Symbol, usize> = BTreeMap::new();
        let mut number = |symbol: &Symbol| {
            let next = seen.len();
            *seen.entry(symbol).or_insert(next)
        };
        symbols.places().map(|(place, symbol)| (place.span, number(symbol))).collect::<Vec<(Span, usize)>>()
    };
    let (before, after) = (numbered(before), numbered(after));
    let place = |span: Span| Mention { span, definition: false };
    let differs = before.iter().zip(&after).find(|((_, before), (_, after))| before != after);
    match differs {
        Some((_, (span, _))) => Some(place(*span)),
        None if before.len() != after.len() => {
            Some(place(after.last().map_or(Span::default(), |(span, _)| *span)))
        }
        None => None,
    }
}
