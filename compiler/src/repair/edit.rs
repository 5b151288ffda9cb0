//! What a change of an amount is in the source: in the unit and the way it is written.

use kirk_network::json;
use kirk_network::vary::Change;
use kirk_network::{Bound, Duration, Network, Part};

use crate::diagnostic::{Edit, Text};
use crate::episode::Kind;
use crate::origins::{Origin, OriginKind, Side, Subject};
use crate::source::{Source, Span};
use crate::words;

const SECOND: Duration = Duration::from_secs(1);

/// The unit an author writes amounts in; the smallest is the least.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Unit {
    pub(crate) micros: i64,
    /// The word for it, if it is written.
    word: Option<&'static str>,
}

impl Default for Unit {
    fn default() -> Unit {
        Unit::SECONDS
    }
}

impl Unit {
    /// What is meant where no unit is written.
    pub const SECONDS: Unit = Unit { word: None, micros: SECOND.as_micros() };

    /// An amount in words: `90 s`, `1.5 minutes`.
    pub fn say(self, amount: Duration) -> String {
        match (self.word, self.number(amount)) {
            (Some(word), Some(number)) if number == SECOND => {
                format!("{number} {}", word.strip_suffix('s').unwrap_or(word))
            }
            (Some(word), Some(number)) => format!("{number} {word}"),
            _ => format!("{amount} s"),
        }
    }

    /// How many of it an amount is, if that can be written with six digits.
    pub(crate) fn number(self, amount: Duration) -> Option<Duration> {
        let millionths = i128::from(amount.as_micros()) * i128::from(SECOND.as_micros());
        let unit = i128::from(self.micros);
        (millionths % unit == 0).then(|| i64::try_from(millionths / unit).ok().map(Duration::from_micros))?
    }

    /// An amount as it is written in a program.
    fn write(self, amount: Duration) -> String {
        match (self.word, self.number(amount)) {
            (Some(word), Some(number)) => format!("({word} {number})"),
            _ => amount.to_string(),
        }
    }
}

fn slice(place: Span, sources: &[Source]) -> &str {
    sources.get(place.source as usize).map_or("", |source| source.slice(place))
}

/// The unit of what is written at a place.
pub(crate) fn unit(place: Span, sources: &[Source]) -> Unit {
    written_unit(place, sources).unwrap_or(Unit::SECONDS)
}

/// The same; `None` if no number stands there, or one of which the unit does not matter.
pub fn written_unit(place: Span, sources: &[Source]) -> Option<Unit> {
    let is_some = |number: &str| Duration::parse_seconds(number).is_ok_and(|it| it != Duration::ZERO);
    let inner = slice(place, sources).strip_prefix('(').and_then(|text| text.strip_suffix(')'));
    let words: Vec<&str> = inner.unwrap_or_default().split_whitespace().collect();
    match words[..] {
        [word, number] if Duration::parse_seconds(number).is_ok() => {
            words::unit(&word.to_lowercase()).map(|(word, micros)| Unit { word: Some(word), micros })
        }
        _ => is_some(slice(place, sources)).then_some(Unit::SECONDS),
    }
}

/// The step in which an author would change an amount: a unit, of hours and days a tenth, or the last decimal place that is
/// written.
pub(super) fn step(place: Span, value: Bound, sources: &[Source]) -> Duration {
    const LARGE: i64 = 600 * SECOND.as_micros();
    let unit = unit(place, sources).micros;
    let unit = if unit > LARGE { unit / 10 } else { unit };
    let value = value.finite().unwrap_or_default().as_micros().abs();
    let mut steps =
        std::iter::successors(Some(unit), |step| (step % 10 == 0 && *step > 1).then_some(step / 10));
    // A step that is more than a fifth of the amount would be a leap.
    let fits = steps.find(|step| value % step == 0 && (value == 0 || *step <= value / 5));
    Duration::from_micros(fits.unwrap_or(1))
}

/// True if there is an amount at the place of a bound that can be changed there.
pub(super) fn is_written(part: Part, origin: &Origin, sources: &[Source]) -> bool {
    match origin.kind {
        OriginKind::Requirement | OriginKind::Link => true,
        _ => Side::of(part).is_some_and(|side| {
            let place = origin.place(side);
            let text = slice(place, sources);
            place != origin.span && !text.is_empty() && !text.starts_with("(simple")
        }),
    }
}

/// True if one amount says both bounds, as in `(delay 5)`.
pub(super) fn says_both(origin: &Origin) -> bool {
    let is_delay = origin.subject == Subject::Form(Kind::Delay.word());
    is_delay && origin.place(Side::Lower) == origin.place(Side::Upper)
}

/// The change of the source. Of a file in which amounts have no place of their own it is nothing.
pub(super) fn edits(change: &Change, network: &Network, origin: &Origin, sources: &[Source]) -> Vec<Edit> {
    let part = change.knob.parts()[0];
    let Some(to) = change.to.finite() else { return Vec::new() };
    let mut edits: Vec<Edit> = edit(part, change.from, to, origin, sources).into_iter().collect();
    // A shortest delay follows a longest one that becomes less. Where one text stands for several there is no such edit.
    let least = |part: &Part| match *part {
        Part::DelayMax(link) => Some(network.contingents()[link].delay.min),
        _ => None,
    };
    let shortest: Vec<Duration> = change.knob.parts().iter().filter_map(least).collect();
    if shortest.iter().any(|least| *least > to) && shortest.iter().any(|least| *least != shortest[0]) {
        return Vec::new();
    }
    if let Part::DelayMax(link) = part
        && let least = network.contingents()[link].delay.min
        && least > to
        && let Some(edit) = edit(Part::DelayMin(link), least.into(), to, origin, sources)
        && edits.iter().all(|known| known.span != edit.span)
    {
        edits.push(edit);
    }
    edits
}

fn edit(part: Part, from: Bound, to: Duration, origin: &Origin, sources: &[Source]) -> Option<Edit> {
    let place = origin.place(Side::of(part)?);
    let edit = |span: Span, text: String| Edit { span, text: Text::Plain(text) };
    if matches!(origin.kind, OriginKind::Requirement | OriginKind::Link) {
        let at = json::amount_in(slice(place, sources), part)?;
        let start = place.start as usize;
        return Some(edit(Span::new(place.source, start + at.start, start + at.end), to.to_string()));
    }
    let written = slice(place, sources);
    let unit = unit(place, sources);
    let known = unit.word.is_some() || Duration::parse_seconds(written).is_ok();
    let text = match from.finite() {
        // What is no plain number is calculated from what is written.
        Some(from) if !known => {
            let by = to.checked_sub(from)?;
            let sign = if by < Duration::ZERO { '-' } else { '+' };
            format!("({sign} {written} {})", by.abs())
        }
        _ => unit.write(to),
    };
    Some(edit(
        place,
        match part {
            Part::RequirementLower(_) if says_both(origin) => format!("{text} {written}"),
            Part::RequirementUpper(_) if says_both(origin) => format!("{written} {text}"),
            _ => text,
        },
    ))
}
