//! Plain text forms of what the compiler yields, for snapshots.
#![allow(
    dead_code,
    unreachable_pub,
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "each test binary uses a part"
)]

use kirk_compiler::{
    Compilation, Diagnostic, LineIndex, Lowered, Options, Origin, Severity, Source, Span, Suggestion,
};
use kirk_network::{Bound, Network};

pub fn compile(text: &str) -> Compilation {
    compile_with(text, &Options::default())
}

pub fn compile_with(text: &str, options: &Options) -> Compilation {
    kirk_compiler::compile(&[Source::new("mission.rmpl", text)], options)
}

/// The options a source asks for in its comments: `--entry NAME` and `-P NAME`.
pub fn options_in(text: &str) -> Options {
    let mut options = Options::default();
    let after = |word: &str| {
        let lines = text.lines().filter(|line| line.starts_with(';'));
        let mut words = lines.flat_map(str::split_whitespace);
        words.by_ref().find(|found| *found == word)?;
        words.next().map(str::to_string)
    };
    if let Some(entry) = after("--entry") {
        options.entry = entry;
    }
    options.package = after("-P");
    options
}

/// `3:5 error K0203: message`, the labels below it.
pub fn diagnostics(text: &str, diagnostics: &[Diagnostic]) -> String {
    let lines = LineIndex::new(text);
    let place = |offset| {
        let (line, column) = lines.line_column(text, offset);
        format!("{line}:{column}")
    };
    let mut out = String::new();
    for d in diagnostics {
        let severity = match d.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        };
        let shown = |span: kirk_compiler::Span| {
            let slice = &text[span.start as usize..span.end as usize];
            let first = slice.lines().next().unwrap_or("");
            let cut: String = first.chars().take(40).collect();
            if cut.len() < slice.len() { format!("{cut} ...") } else { cut }
        };
        out.push_str(&format!("{} {severity} {}: {}\n", place(d.span.start), d.code, d.message));
        out.push_str(&format!("    `{}` {}\n", shown(d.span), d.primary));
        for label in &d.labels {
            out.push_str(&format!(
                "    {} `{}` {}\n",
                place(label.span.start),
                shown(label.span),
                label.message
            ));
        }
        if let Some(help) = &d.help {
            out.push_str(&format!("    = {help}\n"));
        }
        for suggestion in &d.suggestions {
            out.push_str(&format!("    > {}\n", suggestion.title));
        }
    }
    out
}

/// The text after a suggestion.
pub fn applied(text: &str, suggestion: &Suggestion) -> String {
    let sources = [Source::new("mission.rmpl", text)];
    let mut edits: Vec<(Span, &str)> = suggestion.edits.iter().map(|e| (e.span, e.text(&sources))).collect();
    edits.sort_by_key(|(span, _)| *span);
    assert!(edits.windows(2).all(|pair| pair[0].0.end <= pair[1].0.start), "{suggestion:?} overlaps itself");
    let mut after = text.to_string();
    for (span, new) in edits.into_iter().rev() {
        after.replace_range(span.start as usize..span.end as usize, new);
    }
    after
}

/// One line for each constraint, with the words it comes from.
pub fn network(lowered: &Lowered) -> String {
    let network = &lowered.network;
    let mut out = format!("network {}, origin {}\n", network.name(), network.id(network.origin()));
    for event in network.events() {
        let names: Vec<String> = event
            .names
            .iter()
            .map(|n| if n.internal { format!("({})", n.text) } else { n.text.clone() })
            .collect();
        out.push_str(&format!("  {}\n", names.join(" ")));
    }
    for (r, origin) in network.requirements().iter().zip(&lowered.origins.requirements) {
        let interval = format!("[{}, {}]", bound(r.lower, "-inf"), bound(r.upper, "inf"));
        out.push_str(&line(network, r.from, r.to, "->", &interval, origin));
    }
    for (link, origin) in network.contingents().iter().zip(&lowered.origins.contingents) {
        let mut interval = format!("[{}, {}]", link.lower, link.upper);
        if link.delay != kirk_network::Delay::NONE {
            interval.push_str(&format!(" delay [{}, {}]", link.delay.min, bound(link.delay.max, "inf")));
        }
        out.push_str(&line(network, link.from, link.to, "=>", &interval, origin));
    }
    out
}

fn line(
    network: &Network,
    from: kirk_network::EventId,
    to: kirk_network::EventId,
    arrow: &str,
    interval: &str,
    origin: &Origin,
) -> String {
    format!("  {} {arrow} {} {interval}    ; {}\n", network.id(from), network.id(to), origin.text())
}

fn bound(bound: Bound, infinite: &str) -> String {
    bound.finite().map_or(infinite.to_string(), |duration| duration.to_string())
}

/// Every source of a directory below the repository, sorted by name.
pub fn sources(directory: &str) -> Vec<(String, String)> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(directory);
    let mut found: Vec<(String, String)> = std::fs::read_dir(&path)
        .unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        .filter_map(|entry| {
            let path = entry.ok()?.path();
            let name = path.file_stem()?.to_str()?.to_string();
            let rmpl = path.extension().is_some_and(|extension| extension == "rmpl");
            rmpl.then(|| (name, String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned()))
        })
        .collect();
    found.sort();
    found
}
