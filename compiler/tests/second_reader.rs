//! lexpr reads the examples as well, knowing nothing of our grammar: both must see the same forms.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use kirk_compiler::Problems;
use kirk_compiler::Source;
use kirk_compiler::form::{Form, FormKind};
use kirk_compiler::read::read;

#[test]
fn lexpr_reads_the_same_forms() {
    let mut compared = 0;
    for (name, text) in common::sources("examples/rmpl").into_iter().filter(|(_, text)| text.is_ascii()) {
        let mut problems = Problems::default();
        let ours: Vec<String> =
            read(&Source::new("x", text.as_str()), 0, &mut problems).iter().map(ours).collect();
        assert!(!problems.has_errors());
        let options =
            lexpr::parse::Options::new().with_keyword_syntax(lexpr::parse::KeywordSyntax::ColonPrefix);
        // lexpr has no uninterned symbols.
        let plain = text.replace("#:", "");
        let mut parser = lexpr::Parser::from_str_custom(&plain, options);
        let mut theirs = Vec::new();
        while let Some(value) = parser.next_value().unwrap() {
            theirs.push(other(&value));
        }
        assert_eq!(ours, theirs, "{name}");
        compared += ours.len();
    }
    assert!(compared > 60, "only {compared} forms were compared");
}

/// A form as text that both readers can produce.
fn ours(form: &Form) -> String {
    match &form.kind {
        FormKind::List(items) => format!("({})", items.iter().map(ours).collect::<Vec<_>>().join(" ")),
        FormKind::Symbol(symbol) => match &symbol.package {
            Some(package) => format!("{package}:{}", symbol.name),
            None => symbol.name.clone(),
        },
        FormKind::Uninterned(name) => name.clone(),
        FormKind::Keyword(name) => format!(":{name}"),
        FormKind::Number(text) => text.parse::<f64>().unwrap().to_string(),
        FormKind::String(text) => format!("{text:?}"),
        FormKind::Quote(inner) => format!("(quote {})", ours(inner)),
        FormKind::Error => panic!("unreadable"),
    }
}

fn other(value: &lexpr::Value) -> String {
    if let Some(items) = value.list_iter() {
        return format!("({})", items.map(other).collect::<Vec<_>>().join(" "));
    }
    if let Some(name) = value.as_keyword() {
        return format!(":{name}");
    }
    if let Some(text) = value.as_str() {
        return format!("{text:?}");
    }
    if let Some(name) = value.as_symbol() {
        return name.to_lowercase();
    }
    value.as_f64().map(|number| number.to_string()).unwrap_or_else(|| format!("{value:?}"))
}
