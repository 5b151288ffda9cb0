//! From the name of a file to a network, or to what is wrong with it.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use kirk_compiler::{
    Companion, Compilation, Diagnostic, Options, Origins, Source, Span, Team, companions, compile,
};
use kirk_network::json::ReadProblem;
use kirk_network::{Network, SourceMap, graphml, json, kinds, plain};

use crate::args::Selection;
use crate::wording::Problem;

/// Everything that became of one input file, or of several that are one program.
pub(crate) struct Loaded {
    /// The files, for diagnostics to point into.
    pub(crate) sources: Vec<Source>,
    /// What there is to say about it.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// What kind of input it is.
    content: Content,
    /// The network, not merged; `None` if there was an error.
    pub(crate) network: Option<Network>,
}

/// What kind of input there is, and what is known of it besides the network.
enum Content {
    /// RMPL: how far the compiler got, and if to a network, where its constraints come from and where its program is named.
    /// Then also who executes it, if it is not one alone.
    Program { compilation: Box<Compilation>, origins: Option<(Origins, Span)>, team: Option<Team> },
    /// A network: where its constraints stand, and whether its name stands there or is that of its file.
    Network { origins: Box<Origins>, named: bool },
    /// Nothing that could be read.
    Unread,
}

/// RMPL of more bytes than this is no program a person wrote.
pub(crate) const LARGEST_PROGRAM: u64 = 16 << 20;
/// Networks are written by machines.
const LARGEST_NETWORK: u64 = 64 << 20;

enum Kind {
    Rmpl,
    Network(Reader),
}

type Reader = fn(&str) -> Result<(Network, SourceMap), Vec<ReadProblem>>;

/// Reads and compiles an input file; `-` is standard input.
pub(crate) fn load(file: &str, selection: &Selection) -> Loaded {
    load_one(file, bytes_of(file), selection)
}

fn load_one(file: &str, bytes: Bytes, selection: &Selection) -> Loaded {
    let text = match text_of(file, bytes) {
        Ok(text) => text,
        Err(unreadable) => return Loaded::broken(shown(file), *unreadable),
    };
    match kind(file, &text) {
        Kind::Network(reader) => {
            let mut input = network(shown(file), text, reader);
            input.refuse(selection);
            input
        }
        Kind::Rmpl => match with_companions(file, text) {
            Ok(sources) => program(sources, selection),
            Err((source, unreadable)) => Loaded {
                sources: vec![source],
                diagnostics: unreadable,
                content: Content::Unread,
                network: None,
            },
        },
    }
}

/// The sources of the program that a file is part of: those it names (`;;; kirk: files ...`), or itself alone.
fn with_companions(file: &str, own: String) -> Result<Vec<Source>, (Source, Vec<Diagnostic>)> {
    let (mut sources, mut problems, mut is_there) = (Vec::new(), Vec::new(), false);
    let folder = Path::new(file).parent().filter(|_| file != "-").unwrap_or(Path::new(""));
    for Companion { name, span } in companions(&own) {
        let path = folder.join(&name).to_string_lossy().into_owned();
        // A file of that name, not standard input.
        let path = if path == "-" { "./-".to_string() } else { path };
        if !is_there && is_same_file(&path, file) {
            is_there = true;
            sources.push(Source::new(shown(file), own.as_str()));
            continue;
        }
        match text(&path) {
            Ok(text) => sources.push(Source::new(path.as_str(), text)),
            Err(unreadable) => problems.push(Diagnostic { span, ..unreadable.diagnostic }),
        }
    }
    if !problems.is_empty() {
        return Err((Source::new(shown(file), own), problems));
    }
    if !is_there {
        sources.push(Source::new(shown(file), own));
    }
    Ok(sources)
}

fn is_same_file(one: &str, other: &str) -> bool {
    let real = |path: &str| std::fs::canonicalize(path).ok();
    real(one).is_some_and(|path| Some(path) == real(other))
}

/// Reads several files and compiles them as one program.
pub(crate) fn load_all(files: &[String], selection: &Selection) -> Loaded {
    load_begun(files, None, selection)
}

/// The same where the first of them was read already: a pipe can be read only once.
pub(crate) fn load_begun(files: &[String], mut first: Option<Bytes>, selection: &Selection) -> Loaded {
    let mut bytes = |file: &str| first.take().unwrap_or_else(|| bytes_of(file));
    if let [file] = files {
        return load_one(file, bytes(file), selection);
    }
    let mut sources = Vec::new();
    let mut diagnostics = Vec::new();
    for (index, file) in files.iter().enumerate() {
        let place = Span::new(index as u32, 0, 0);
        let text = if files[..index].contains(file) {
            Err(Unreadable::at_all(Problem::Twice(shown(file))))
        } else {
            text_of(file, bytes(file))
        };
        let (text, whole) = match text {
            Ok(text) => (text, true),
            Err(unreadable) => {
                let Unreadable { text, diagnostic } = *unreadable;
                let span = Span { source: index as u32, ..diagnostic.span };
                diagnostics.push(Diagnostic { span, ..diagnostic });
                (text, false)
            }
        };
        if whole && is_network(file, &text) {
            diagnostics.push(Problem::NetworkInProgram(shown(file)).at(place));
        }
        sources.push(Source::new(shown(file), text));
    }
    if diagnostics.is_empty() {
        program(sources, selection)
    } else {
        Loaded { sources, diagnostics, content: Content::Unread, network: None }
    }
}

/// What standard input is called.
pub(crate) const STDIN: &str = "<stdin>";

/// What to call a file in messages.
pub(crate) fn shown(file: &str) -> &str {
    if file == "-" { STDIN } else { file }
}

/// Why a file is no text to go on with.
pub(crate) struct Unreadable {
    /// As much of it as can be shown, up to what is wrong.
    pub(crate) text: String,
    /// What is wrong.
    pub(crate) diagnostic: Diagnostic,
}

impl Unreadable {
    /// There is nothing to show.
    fn at_all(problem: Problem<'_>) -> Box<Unreadable> {
        Box::new(Unreadable { text: String::new(), diagnostic: problem.at(Span::default()) })
    }

    /// There are bytes in it, at a place, that are no UTF-8.
    fn bytes(bytes: &[u8], valid: usize) -> Box<Unreadable> {
        let line = bytes[..valid].iter().filter(|&&b| b == b'\n').count();
        // The rest of the line, if it is one.
        let rest = bytes[valid..].iter().take(MOST_SHOWN).position(|&byte| byte == b'\n');
        let end = (valid + rest.unwrap_or(MOST_SHOWN)).min(bytes.len());
        let text = String::from_utf8_lossy(&bytes[..end]).into_owned();
        // What is wrong was replaced by one character.
        let span = Span::new(0, valid, valid + char::REPLACEMENT_CHARACTER.len_utf8());
        let diagnostic = Problem::NotText { line: line + 1, byte: valid }.at(span);
        Box::new(Unreadable { text, diagnostic })
    }
}

/// How much is shown of a line after what is wrong in it.
const MOST_SHOWN: usize = 100;

/// A text without the mark some programs put at its beginning (BOM). JSON has none.
pub(crate) fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// The text of an input file.
pub(crate) fn text(file: &str) -> Result<String, Box<Unreadable>> {
    text_of(file, bytes_of(file))
}

fn bytes_of(file: &str) -> Bytes {
    read(file, LARGEST_NETWORK)
}

fn text_of(file: &str, bytes: Bytes) -> Result<String, Box<Unreadable>> {
    let bytes = bytes
        .and_then(|bytes| at_most(file, bytes, LARGEST_NETWORK))
        .map_err(|message| Unreadable::at_all(Problem::Unreadable(message)))?;
    let text = String::from_utf8(bytes)
        .map_err(|error| Unreadable::bytes(error.as_bytes(), error.utf8_error().valid_up_to()))?;
    if text.len() as u64 > LARGEST_PROGRAM && !is_network(file, &text) {
        return Err(Unreadable::at_all(Problem::TooLong { length: text.len(), most: LARGEST_PROGRAM }));
    }
    Ok(text)
}

/// True if a file of this name and text is a network.
pub(crate) fn is_network(file: &str, text: &str) -> bool {
    matches!(kind(file, text), Kind::Network(_))
}

/// The extension decides; without a known one, the first character.
fn kind(file: &str, text: &str) -> Kind {
    let extension = Path::new(file).extension().and_then(|e| e.to_str()).map(str::to_lowercase);
    let start = text.trim_start_matches('\u{feff}').trim_start();
    match extension.as_deref() {
        Some("rmpl" | "lisp") => Kind::Rmpl,
        Some("json") => Kind::Network(json::read_with_source_map),
        Some("stnu") => Kind::Network(graphml::read_with_source_map),
        Some("plainstnu") => Kind::Network(plain::read_with_source_map),
        Some("ostnu") => Kind::Network(with_oracles),
        _ if start.starts_with('{') => Kind::Network(json::read_with_source_map),
        _ if start.starts_with('<') && start.contains("graphml") => {
            Kind::Network(graphml::read_with_source_map)
        }
        _ if start.starts_with("# ") && start.contains("\n# Time-Point Names") => {
            Kind::Network(plain::read_with_source_map)
        }
        _ => Kind::Rmpl,
    }
}

/// What the oracles of a network tell is not part of the model: without them the verdict would be another.
fn with_oracles(_: &str) -> Result<(Network, SourceMap), Vec<ReadProblem>> {
    let refused = kinds::check("OSTNU").err().unwrap_or_default();
    Err(vec![ReadProblem { offset: 0, message: format!("the kind of network is {refused}") }])
}

/// The bytes of a file, or a sentence that says why not.
pub(crate) type Bytes = Result<Vec<u8>, String>;

/// Of a file that may have at most so many.
pub(crate) fn read(file: &str, most: u64) -> Bytes {
    let mut bytes = Vec::new();
    let result = if file == "-" {
        io::stdin().lock().take(most + 1).read_to_end(&mut bytes)
    } else {
        File::open(file).and_then(|open| {
            if open.metadata()?.is_dir() {
                return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
            }
            open.take(most + 1).read_to_end(&mut bytes)
        })
    };
    match result {
        Err(error) => {
            let why = match error.kind() {
                io::ErrorKind::NotFound => "there is no such file".to_string(),
                io::ErrorKind::PermissionDenied => "you may not read it".to_string(),
                io::ErrorKind::IsADirectory => "it is a directory; name a file in it".to_string(),
                _ => error.to_string(),
            };
            Err(format!("cannot read `{file}`: {why}"))
        }
        Ok(_) => at_most(file, bytes, most),
    }
}

/// Refuses what is larger.
pub(crate) fn at_most(file: &str, bytes: Vec<u8>, most: u64) -> Bytes {
    if bytes.len() as u64 > most {
        return Err(format!("`{file}` has more than {most} bytes; kirk does not read that"));
    }
    Ok(bytes)
}

fn program(sources: Vec<Source>, selection: &Selection) -> Loaded {
    let options = Options { package: selection.package.clone(), entry: selection.entry().to_string() };
    let mut compilation = compile(&sources, &options);
    let diagnostics = std::mem::take(&mut compilation.diagnostics);
    let (network, origins, team) = match compilation.lowered.take() {
        Some(plan) => (Some(plan.network), Some((plan.origins, plan.entry)), plan.team),
        None => (None, None, None),
    };
    let content = Content::Program { compilation: Box::new(compilation), origins, team };
    Loaded { sources, diagnostics, content, network }
}

fn network(name: &str, text: String, reader: Reader) -> Loaded {
    let text = without_mark(&text);
    let read = reader(text);
    let sources = vec![Source::new(name, text)];
    match read {
        Ok((network, places)) => {
            let origins = Box::new(Origins::of_network(&network, &places));
            let content = Content::Network { origins, named: !network.name().is_empty() };
            Loaded { sources, diagnostics: Vec::new(), content, network: Some(named(network, name)) }
        }
        Err(problems) => {
            let told = |problem: ReadProblem| {
                Problem::BadNetwork(problem.message).at(Span::new(0, problem.offset, problem.offset))
            };
            let diagnostics = problems.into_iter().map(told).collect();
            Loaded { sources, diagnostics, content: Content::Unread, network: None }
        }
    }
}

/// A network without a name takes that of its file.
fn named(network: Network, file: &str) -> Network {
    let stem = Path::new(file).file_stem().and_then(|stem| stem.to_str());
    let (true, Some(stem)) = (network.name().is_empty(), stem) else { return network };
    let (events, requirements) = (network.events().to_vec(), network.requirements().to_vec());
    let contingents = network.contingents().to_vec();
    Network::new(stem.to_string(), network.origin(), events, requirements, contingents).unwrap_or(network)
}

impl Loaded {
    /// Standard input, which was read already.
    pub(crate) fn twice() -> Loaded {
        Loaded::broken(shown("-"), *Unreadable::at_all(Problem::StandardInputTwice))
    }

    fn broken(name: &str, Unreadable { text, diagnostic }: Unreadable) -> Loaded {
        Loaded {
            sources: vec![Source::new(name, text)],
            diagnostics: vec![diagnostic],
            content: Content::Unread,
            network: None,
        }
    }

    /// What becomes of the same input with other texts.
    pub(crate) fn with_sources(&self, sources: Vec<Source>, selection: &Selection) -> Loaded {
        let reader = |source: &Source| match kind(&source.name, &source.text) {
            Kind::Network(reader) if self.is_network() => Some(reader),
            _ => None,
        };
        match sources.first().and_then(reader) {
            Some(reader) => network(&sources[0].name, sources[0].text.clone(), reader),
            None => program(sources, selection),
        }
    }

    /// How far the compiler got, if it is RMPL.
    pub(crate) fn compilation(&self) -> Option<&Compilation> {
        if let Content::Program { compilation, .. } = &self.content { Some(compilation) } else { None }
    }

    /// Where its constraints come from.
    pub(crate) fn origins(&self) -> Option<&Origins> {
        match &self.content {
            Content::Program { origins, .. } => origins.as_ref().map(|(origins, _)| origins),
            Content::Network { origins, .. } => Some(origins),
            Content::Unread => None,
        }
    }

    /// Where the program that is executed is named, if it is RMPL.
    pub(crate) fn program_span(&self) -> Option<Span> {
        match &self.content {
            Content::Program { origins: Some((_, program)), .. } => Some(*program),
            _ => None,
        }
    }

    /// Who executes it, if it is not one alone.
    pub(crate) fn team(&self) -> Option<&Team> {
        if let Content::Program { team, .. } = &self.content { team.as_ref() } else { None }
    }

    /// Refuses the mission of a team, as what is asked is known of one executive only.
    pub(crate) fn for_one_alone(&mut self, asked: &str) {
        let Some(team) = self.team() else { return };
        let problem = Problem::ForOneAlone { asked, team: &team.name, agents: &team.agents };
        let problem = problem.at(self.program_span().unwrap_or_default());
        self.diagnostics.push(problem);
        self.network = None;
    }

    /// True if it is a network file.
    pub(crate) fn is_network(&self) -> bool {
        matches!(self.content, Content::Network { .. })
    }

    /// Refuses options that choose among programs: a network has none.
    fn refuse(&mut self, selection: &Selection) {
        for (option, value) in [("--package", &selection.package), ("--entry", &selection.entry)] {
            let Some(value) = value else { continue };
            self.diagnostics.push(Problem::NoPrograms { option, value }.at(Span::default()));
            self.network = None;
        }
    }

    /// True if a record of this program may be of it. A network without a name may be a copy of another file.
    pub(crate) fn may_be(&self, program: &str, selection: &Selection) -> bool {
        let nameless = matches!(self.content, Content::Network { named: false, .. });
        nameless || self.program(selection).eq_ignore_ascii_case(program)
    }

    /// What the network is called: the program it is of, or its own name.
    pub(crate) fn program(&self, selection: &Selection) -> String {
        match (&self.network, self.compilation()) {
            (Some(network), None) => network.name().to_string(),
            _ => selection.entry().to_lowercase(),
        }
    }
}
