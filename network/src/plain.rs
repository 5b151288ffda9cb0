//! Reads plain text STNUs (`.plainstnu`), the exchange format of several STNU benchmarks.
//!
//! Lines that start with `#` open a section or are comments. An ordinary edge `A 10 B` reads `B - A <= 10`; a contingent
//! link `A 4 6 C` says that Nature picks `C - A` in `[4, 6]`. The origin is the time-point `Z`. Times are seconds. Names
//! may be quoted (`"A" 10 "B b"`), as the CSTNU Tool writes them; the quotes are no part of the name.
//!
//! ```
//! let network = kirk_network::plain::read(
//!     "# KIND OF NETWORK\nSTNU\n# Time-Point Names\nZ A C\n# Ordinary Edges\nC 10 Z\n# Contingent Links\nA 4 6 C\n",
//! );
//! assert_eq!(network.unwrap().events().len(), 3);
//! ```

use std::collections::{BTreeMap, VecDeque};
use std::ops::Range;

use crate::json::ReadProblem;
use crate::kinds;
use crate::model::{ContingentLink, Delay, Event, EventId, Name, Network, Requirement, normal_name};
use crate::source_map::SourceMap;
use crate::time::{Bound, Duration};

/// Reads a plain text STNU, or lists everything that is wrong with it. The network has no name and no delays.
///
/// Edges in opposite directions between two events become one requirement, where the first of the two stands.
pub fn read(text: &str) -> Result<Network, Vec<ReadProblem>> {
    read_with_source_map(text).map(|(network, _)| network)
}

/// Reads a plain text STNU as [`read`] does, and remembers where its constraints stand.
pub fn read_with_source_map(text: &str) -> Result<(Network, SourceMap), Vec<ReadProblem>> {
    let mut reader = Reader::default();
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut offset = text.len() - body.len();
    for (index, line) in body.split_inclusive('\n').enumerate() {
        reader.line(Line { number: index + 1, offset, words: words(line, offset), text: line.trim() });
        offset += line.len();
    }
    let network = reader.network(text.len());
    let mut problems = reader.problems;
    problems.sort_by_key(|problem| problem.offset);
    network.filter(|_| problems.is_empty()).ok_or(problems)
}

/// Joins the edges of a distance graph to requirements.
///
/// An edge joins the first one in the opposite direction that still lacks its lower bound, unless the two contradict
/// each other: then both stay, and the controllability check says so.
#[derive(Default)]
pub(crate) struct Intervals {
    pub(crate) requirements: Vec<Requirement>,
    /// For each requirement where its upper and its lower bound are said.
    pub(crate) places: Vec<[Range<usize>; 2]>,
    /// The requirements without a lower bound, by their events.
    open: BTreeMap<(EventId, EventId), VecDeque<usize>>,
}

impl Intervals {
    /// Adds `to - from <= weight`, said at `place`.
    pub(crate) fn add(&mut self, from: EventId, to: EventId, weight: Duration, place: Range<usize>) {
        let lower = -weight;
        if let Some(open) = self.open.get_mut(&(to, from))
            && let Some(&first) = open.front()
            && self.requirements[first].upper.finite().is_some_and(|upper| lower <= upper)
        {
            open.pop_front();
            self.requirements[first].lower = Bound::Finite(lower);
            self.places[first][1] = place;
            return;
        }
        self.open.entry((from, to)).or_default().push_back(self.requirements.len());
        self.places.push([place.clone(), place]);
        self.requirements.push(Requirement {
            from,
            to,
            lower: Bound::Infinite,
            upper: Bound::Finite(weight),
        });
    }
}

/// A word without its quotes, and where it stands with them.
#[derive(Clone, Copy)]
struct Word<'a> {
    text: &'a str,
    offset: usize,
    end: usize,
}

struct Line<'a> {
    number: usize,
    offset: usize,
    words: Vec<Word<'a>>,
    text: &'a str,
}

impl Line<'_> {
    /// From the first word to the last.
    fn range(&self) -> Range<usize> {
        self.words.first().map_or(self.offset, |word| word.offset)
            ..self.words.last().map_or(self.offset, |word| word.end)
    }
}

/// Splits a line at white space that is not in quotes.
fn words(line: &str, offset: usize) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    let mut rest = line.trim_start();
    while !rest.is_empty() {
        let (word, after) = rest.split_at(length_of_word(rest));
        let start = offset + (line.len() - rest.len());
        words.push(Word { text: unquoted(word), offset: start, end: start + word.len() });
        rest = after.trim_start();
    }
    words
}

/// A quote that is not closed before the end of a word is a character like others.
fn length_of_word(text: &str) -> usize {
    let to_space = |text: &str| text.find(char::is_whitespace).unwrap_or(text.len());
    let Some(quote) = text.chars().next().filter(|char| QUOTES.contains(char)) else { return to_space(text) };
    let closes = |&(at, _): &(usize, &str)| at > 0 && to_space(&text[at + 1..]) == 0;
    text.match_indices(quote).find(closes).map_or(to_space(text), |(at, _)| at + 1)
}

const QUOTES: [char; 2] = ['"', '\''];

/// A name without the quotes around it, if it has any.
pub(crate) fn unquoted(name: &str) -> &str {
    let inside = |&quote: &char| name.strip_prefix(quote).and_then(|rest| rest.strip_suffix(quote));
    QUOTES.iter().find_map(inside).unwrap_or(name)
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
enum Section {
    #[default]
    None,
    Kind,
    Counts,
    Points,
    Edges,
    Links,
}

/// The section a comment line opens, if it opens one.
fn section(comment: &str) -> Option<Section> {
    let title = comment.trim_start_matches('#').to_lowercase();
    let title = title.split_whitespace().collect::<Vec<_>>().join(" ");
    Some(match title.trim_end_matches([':', '.']) {
        "kind of network" | "type of network" | "network type" => Section::Kind,
        title if title.starts_with("num ") || title.starts_with("number of ") => Section::Counts,
        "time-point names" | "time-points" | "timepoint names" | "timepoints" => Section::Points,
        "ordinary edges" | "ordinary constraints" => Section::Edges,
        "contingent links" => Section::Links,
        _ => return None,
    })
}

#[derive(Default)]
struct Reader<'a> {
    section: Section,
    /// What the count section in progress counts, in lower case.
    counted: String,
    counts: Vec<(String, Line<'a>)>,
    has_points: bool,
    points: Vec<(usize, Word<'a>)>,
    edges: Vec<Line<'a>>,
    links: Vec<Line<'a>>,
    problems: Vec<ReadProblem>,
}

impl<'a> Reader<'a> {
    fn line(&mut self, line: Line<'a>) {
        if line.text.starts_with('#') {
            if let Some(section) = section(line.text) {
                self.section = section;
                self.counted = line.text.to_lowercase();
                self.has_points |= section == Section::Points;
            }
            return;
        }
        if line.words.is_empty() {
            return;
        }
        let first = line.words[0];
        match self.section {
            Section::None => {
                let message = format!(
                    "line {}: expected a section such as `# Time-Point Names` or `# Ordinary Edges` before `{}`",
                    line.number, first.text
                );
                self.problem(first.offset, message);
            }
            Section::Kind => {
                if let Err(refused) = kinds::check(unquoted(line.text)) {
                    let message = format!("line {}: the kind of network is {refused}", line.number);
                    self.problem(first.offset, message);
                }
            }
            Section::Counts => self.counts.push((self.counted.clone(), line)),
            Section::Points => self.points.extend(line.words.iter().map(|&word| (line.number, word))),
            Section::Edges => self.edges.push(line),
            Section::Links => self.links.push(line),
        }
    }

    fn network(&mut self, end: usize) -> Option<(Network, SourceMap)> {
        if !self.has_points {
            self.problem(end, "there is no section `# Time-Point Names`".to_string());
            return None;
        }
        let mut index: BTreeMap<&'a str, EventId> = BTreeMap::new();
        let mut names: BTreeMap<String, &'a str> = BTreeMap::new();
        let mut events = Vec::new();
        for (number, word) in std::mem::take(&mut self.points) {
            if word.text.is_empty() {
                self.problem(word.offset, format!("line {number}: a time-point needs a name"));
            }
            if index.insert(word.text, EventId(events.len() as u32)).is_some() {
                let message = format!("line {number}: the time-point `{}` is listed twice", word.text);
                self.problem(word.offset, message);
            } else if let Some(other) = names.insert(normal_name(word.text), word.text) {
                let message = format!(
                    "line {number}: the time-points `{}` and `{other}` have the same name (case does not count)",
                    word.text
                );
                self.problem(word.offset, message);
            }
            events.push(Event { names: [Name { text: word.text.to_string(), internal: false }].into() });
        }
        let (edges, links) = (std::mem::take(&mut self.edges), std::mem::take(&mut self.links));
        self.compare_counts(events.len(), edges.len(), links.len());
        let mut intervals = Intervals::default();
        for line in &edges {
            let &[from, weight, to] = line.words.as_slice() else {
                self.shape(line, "an edge `A 10 B`, which reads B - A <= 10");
                continue;
            };
            let ends = (self.point(&index, line, from), self.point(&index, line, to));
            let weight = self.seconds(line, weight, "the weight");
            if let ((Some(from), Some(to)), Some(weight)) = (ends, weight) {
                intervals.add(from, to, weight, line.range());
            }
        }
        let mut contingents = Vec::new();
        for line in &links {
            let &[from, lower, upper, to] = line.words.as_slice() else {
                self.shape(line, "a contingent link `A 4 6 C`, which reads C - A in [4, 6]");
                continue;
            };
            let ends = (self.point(&index, line, from), self.point(&index, line, to));
            let lower = self.seconds(line, lower, "the lower bound");
            let upper = self.seconds(line, upper, "the upper bound");
            if let ((Some(from), Some(to)), Some(lower), Some(upper)) = (ends, lower, upper) {
                contingents.push(ContingentLink { from, to, lower, upper, delay: Delay::NONE });
            }
        }
        let origin = index.get("Z").copied();
        if origin.is_none() {
            let message = "there is no time-point `Z`: the origin, executed first at time 0, has that name";
            self.problem(end, message.to_string());
        }
        if !self.problems.is_empty() {
            return None;
        }
        match Network::new(String::new(), origin?, events, intervals.requirements, contingents) {
            Ok(network) => {
                let contingents = links.iter().map(|line| [line.range(), line.range()]).collect();
                Some((network, SourceMap { requirements: intervals.places, contingents }))
            }
            Err(errors) => {
                for error in errors {
                    match error.link().and_then(|link| links.get(link)) {
                        Some(line) => {
                            let message = format!("line {}: {}", line.number, error.what());
                            self.problem(line.words[0].offset, message);
                        }
                        None => self.problem(end, error.to_string()),
                    }
                }
                None
            }
        }
    }

    fn compare_counts(&mut self, points: usize, edges: usize, links: usize) {
        for (title, line) in std::mem::take(&mut self.counts) {
            let (what, there) = if title.contains("edge") || title.contains("constraint") {
                ("ordinary edges", edges)
            } else if title.contains("link") {
                ("contingent links", links)
            } else if title.contains("point") {
                ("time-points", points)
            } else {
                continue;
            };
            if line.text.parse() != Ok(there) {
                let message = format!(
                    "line {}: the number of {what} is given as `{}`, but there are {there}",
                    line.number, line.text
                );
                self.problem(line.offset, message);
            }
        }
    }

    fn shape(&mut self, line: &Line<'a>, expected: &str) {
        let count = line.words.len();
        let plural = if count == 1 { "" } else { "s" };
        let message = format!(
            "line {}: expected {expected}; this line has {count} word{plural}: `{}`",
            line.number, line.text
        );
        self.problem(line.words[0].offset, message);
    }

    fn point(
        &mut self,
        index: &BTreeMap<&'a str, EventId>,
        line: &Line<'a>,
        word: Word<'a>,
    ) -> Option<EventId> {
        let found = index.get(word.text).copied();
        if found.is_none() {
            let message = format!("line {}: there is no time-point `{}`", line.number, word.text);
            self.problem(word.offset, message);
        }
        found
    }

    fn seconds(&mut self, line: &Line<'a>, word: Word<'a>, what: &str) -> Option<Duration> {
        Duration::parse_seconds(word.text)
            .map_err(|error| {
                let message = format!("line {}: {what} `{}`: {error}", line.number, word.text);
                self.problem(word.offset, message);
            })
            .ok()
    }

    fn problem(&mut self, offset: usize, message: String) {
        self.problems.push(ReadProblem { offset, message });
    }
}
