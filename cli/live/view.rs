//! What the screen shows: a function of what is known, the moment and the size. ASCII but for names, so that any
//! terminal and any encoding will do; colours only underline what words say.

use kirk_executive::{Next, Possible, Snapshot, Waits};
use kirk_network::Time;
use kirk_network::time::Interval;
use kirk_runtime::{How, Outcome, Pending, Row};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};

use super::log::Tone;
use super::state::State;
use super::text::{cut, fill, shorten, width, wrap};
use crate::timetable::cells;

/// From this width on the timetable and the rest stand side by side.
const WIDE: u16 = 110;

/// From this width on there is room for whole sentences.
const ROOMY: usize = 48;

/// The rows of the timetable that stay visible, if there are so many, whatever else there is to show.
const ROWS: usize = 4;

/// Draws everything. Returns how many rows of the timetable are visible.
pub(crate) fn view(state: &State, now: Time, color: bool, buffer: &mut Buffer) -> usize {
    let area = buffer.area;
    let wide = area.width as usize;
    let view = View { state, now, color };
    let Some(snapshot) = &state.snapshot else {
        put(buffer, area, &[Line::raw("starting the mission")]);
        return 0;
    };
    let headlines = view.headlines(snapshot, wide);
    let (header, rest) = split(area, 1);
    let (top, body) = split(rest, headlines.len() as u16);
    put(buffer, header, &[view.header(snapshot, wide)]);
    put(buffer, top, &headlines);
    if state.help {
        put(buffer, body, &help(wide));
        return 0;
    }
    let (left, right, below) = if area.width >= WIDE {
        let needed = columns(snapshot).iter().sum::<usize>() + 6;
        let width = (needed as u16).clamp(area.width / 3, area.width * 3 / 5);
        let right = Rect { x: body.x + width, width: body.width - width, ..body };
        let below = view.below(snapshot, right.width as usize, right.height as usize);
        (Rect { width, ..body }, right, below)
    } else {
        let rows = (snapshot.rows.len() + 1).min(ROWS.min(body.height as usize / 4) + 1);
        let below = view.below(snapshot, wide, (body.height as usize).saturating_sub(rows));
        let (left, right) = split(body, body.height.saturating_sub(below.len() as u16));
        (left, right, below)
    };
    put(buffer, right, &below);
    let visible = (left.height as usize).saturating_sub(1);
    put(buffer, left, &view.rows(snapshot, left.width as usize, visible));
    visible
}

struct View<'a> {
    state: &'a State,
    now: Time,
    color: bool,
}

impl View<'_> {
    /// The program, the time and what may be asked.
    fn header(&self, snapshot: &Snapshot, wide: usize) -> Line<'static> {
        let state = match snapshot.outcome {
            _ if self.state.stopping => "stopping",
            Outcome::Running if snapshot.waits.is_some() => "waiting",
            Outcome::Running => "running",
            Outcome::Completed => "completed",
            Outcome::Failed => "failed",
        };
        let time = format!("{} s", self.now.as_micros().div_euclid(1_000_000));
        let help = if wide < ROOMY { "? help" } else { "? help   Ctrl-C stop" };
        let name =
            cut(&snapshot.program, wide.saturating_sub(time.len() + state.len() + help.len() + 7).max(6));
        let left = format!(" {name}  {time}  {state}");
        let gap = wide.saturating_sub(width(&left) + help.len() + 1).max(1);
        let text = format!("{left}{}{help}", " ".repeat(gap));
        Line::styled(fill(&text, wide), Style::new().add_modifier(Modifier::REVERSED | Modifier::BOLD))
    }

    /// What stands below the header: a question, the end, or what comes next.
    fn headlines(&self, snapshot: &Snapshot, wide: usize) -> Vec<Line<'static>> {
        let lines = |text: &str, style| {
            let lines = wrap(text, wide).into_iter().take(3);
            lines.map(|line| Line::styled(fill(&line, wide), style)).collect()
        };
        match (self.state.question(), &snapshot.failure, &snapshot.next) {
            (Some(question), ..) => lines(question, Style::new().add_modifier(Modifier::REVERSED)),
            (_, Some(failure), _) => lines(&failure.detail, self.style(Color::Red)),
            _ if snapshot.waits.is_some() => {
                let until = match &snapshot.waits {
                    Some(Waits::Driver(event)) => format!("when the driver has confirmed {event}"),
                    Some(Waits::Hour) | None => format!("in {} s", self.seconds_to(Time::ZERO)),
                };
                lines(&format!("next: the mission begins {until}"), Style::new())
            }
            (_, _, Some(next)) => vec![self.next(next, wide)],
            _ if snapshot.outcome != Outcome::Running => Vec::new(),
            _ if snapshot.pending.is_empty() => vec![Line::raw("next: waiting for news")],
            _ => vec![Line::raw("next: waiting for the driver")],
        }
    }

    fn next(&self, next: &Next, wide: usize) -> Line<'static> {
        let left = self.seconds_to(next.at);
        let unless = match next.how {
            How::Imagined => ", heard or not",
            How::Buffered => ", heard before",
            How::Dispatched | How::Observed | How::Never => "",
        };
        let at = brief(next.at);
        let when =
            if wide < ROOMY { format!(" at {at} s") } else { format!(" at {at} s, in {left} s{unless}") };
        let name = cut(&next.event, wide.saturating_sub(when.len() + 6));
        Line::raw(format!("next: {name}{when}"))
    }

    /// How many seconds there are to a time, rounded up.
    fn seconds_to(&self, time: Time) -> i64 {
        let left = time.as_micros().saturating_sub(self.now.as_micros()).max(0);
        (left as u64).div_ceil(1_000_000) as i64
    }

    /// The timetable with its heading, from the row that was scrolled to or up to the latest.
    fn rows(&self, snapshot: &Snapshot, wide: usize, visible: usize) -> Vec<Line<'static>> {
        let [time, event, how] = columns(snapshot);
        let room = wide.saturating_sub(time + 5);
        // The word for how comes first, so the rest of it may be cut; names are wanted whole.
        let event = event.min(room.saturating_sub(how.min(room / 2)));
        let line = |at: &str, name: &str, how: &str| {
            format!(" {at:>time$}  {}  {}", fill(name, event), shorten(how, room.saturating_sub(event)))
        };
        let last = snapshot.rows.len().saturating_sub(visible);
        let first = self.state.first.map_or(last, |first| first.min(last));
        let later = last - first;
        let heading = if later > 0 { format!("how ({later} later: End)") } else { "how".to_string() };
        let heading =
            Line::styled(line("time", "event", &heading), Style::new().add_modifier(Modifier::BOLD));
        let row = |row: &Row| {
            let [at, name, how] = brief_cells(row);
            let style = match row.how {
                How::Observed | How::Buffered => self.style(Color::Green),
                How::Imagined => self.style(Color::Yellow),
                How::Dispatched | How::Never => Style::new(),
            };
            Line::styled(line(&at, &name, &how), style)
        };
        let rows = snapshot.rows.iter().skip(first).take(visible).map(row);
        std::iter::once(heading).chain(rows).collect()
    }

    /// Everything but the timetable: what may be heard, what the driver has in hand, and what was said.
    fn below(&self, snapshot: &Snapshot, wide: usize, height: usize) -> Vec<Line<'static>> {
        let possible = self.possible(snapshot, wide);
        let pending: Vec<Line<'static>> =
            snapshot.pending.iter().map(|pending| self.pending(pending, wide)).collect();
        // The latest is always there; more of it if there is room.
        let said = self.said(wide, height.saturating_sub(possible.len() + pending.len()).clamp(2, 6));
        let said_least = said.len().min(2);
        let possible = self.page(possible, height.saturating_sub(said_least));
        let mut pending = pending;
        pending.truncate(height.saturating_sub(said_least + possible.len()));
        let room = height.saturating_sub(possible.len() + pending.len());
        let said = said[said.len().saturating_sub(room)..].to_vec();
        [possible, pending, said].concat()
    }

    /// What may be heard, with its keys.
    fn possible(&self, snapshot: &Snapshot, wide: usize) -> Vec<Line<'static>> {
        let mut all: Vec<(bool, Option<char>, &Possible)> = snapshot
            .possible
            .iter()
            .map(|possible| (self.now < possible.from, self.state.keys.of(&possible.event), possible))
            .collect();
        // What has no key comes last, digits come before letters.
        all.sort_by_key(|&(early, key, _)| (early, key.is_none(), key));
        let name = all.iter().map(|(.., possible)| width(&possible.event)).max().unwrap_or(0);
        let name = name.min(if wide < ROOMY { wide.saturating_sub(20) } else { wide / 2 });
        let mut lines = Vec::new();
        if !all.is_empty() {
            let title =
                if wide < ROOMY { "Press what has happened:" } else { "Press the key of what has happened:" };
            lines.push(Line::styled(title, Style::new().add_modifier(Modifier::BOLD)));
        }
        for (early, key, possible) in all {
            let key = key.map_or("   ".to_string(), |key| format!("[{key}]"));
            let text = format!(" {key} {}  {}", fill(&possible.event, name), self.window(possible, wide));
            let style = match possible.until {
                _ if early => Style::new().add_modifier(Modifier::DIM),
                Some(until) if self.now > until => self.style(Color::Red),
                _ => self.style(Color::Green).add_modifier(Modifier::BOLD),
            };
            lines.push(Line::styled(shorten(&text, wide), style));
        }
        lines
    }

    /// As many lines as there is room for: if these are not all below the title, a page of them.
    fn page(&self, mut lines: Vec<Line<'static>>, height: usize) -> Vec<Line<'static>> {
        if lines.len() <= height {
            return lines;
        }
        let room = height.saturating_sub(1).max(1);
        let pages = (lines.len() - 1).div_ceil(room);
        let page = self.state.turned % pages;
        let title = format!("Press what has happened (page {} of {pages}: Tab)", page + 1);
        lines[0] = Line::styled(title, Style::new().add_modifier(Modifier::BOLD));
        lines.drain(1..1 + page * room);
        lines.truncate(height);
        lines
    }

    /// When news may come, according to the model.
    fn window(&self, possible: &Possible, wide: usize) -> String {
        let (early, roomy) = (self.now < possible.from, wide >= ROOMY);
        let from = brief(possible.from);
        let Some(until) = possible.until else {
            return match (early, roomy) {
                (true, true) => format!("later: from {from} s on, or never"),
                (true, false) => format!("from {from} s"),
                (false, true) => "now, later or never".to_string(),
                (false, false) => "now".to_string(),
            };
        };
        let (late, left, until) = (self.now > until, self.seconds_to(until), brief(until));
        match (early, late, roomy) {
            (true, _, true) => format!("later: from {from} s to {until} s"),
            (true, _, false) => format!("from {from} s"),
            (_, true, true) => format!("late: due by {until} s"),
            (_, true, false) => format!("late: {until} s"),
            (_, _, true) => format!("now: by {until} s, {left} s left"),
            (_, _, false) => format!("by {until} s"),
        }
    }

    /// What the driver has in hand.
    fn pending(&self, pending: &Pending, wide: usize) -> Line<'static> {
        let Pending { name, latest, attempts, again, reason } = pending;
        let mut text = match again {
            None => "with the driver".to_string(),
            Some(again) => format!("failed, again at {} s", brief(*again)),
        };
        if *attempts > 1 || again.is_some() {
            text.push_str(&format!(", attempt {attempts}"));
        }
        if let Some(latest) = latest {
            text.push_str(&format!(", until {} s", brief(*latest)));
        }
        if !reason.is_empty() {
            text.push_str(&format!(": {reason}"));
        }
        let name = cut(name, if wide < ROOMY { wide / 3 } else { wide / 2 });
        let style = if again.is_some() { self.style(Color::Red) } else { self.style(Color::Cyan) };
        Line::styled(shorten(&format!(" {name} {text}"), wide), style)
    }

    /// What was said lately, in lines, the latest last.
    fn said(&self, wide: usize, most: usize) -> Vec<Line<'static>> {
        let mut lines: Vec<Line<'static>> = Vec::new();
        for note in self.state.log.latest() {
            let times = if note.times > 1 { format!(" ({} times)", note.times) } else { String::new() };
            let (mark, style) = match note.tone {
                Tone::Answer => ("", Style::new()),
                Tone::Warning => ("! ", self.style(Color::Red)),
            };
            let text = format!("{} s {mark}{}{times}", brief(note.at), note.text);
            let wrapped = wrap(&text, wide.saturating_sub(1));
            if lines.len() + wrapped.len() > most && !lines.is_empty() {
                break;
            }
            let styled = wrapped.into_iter().map(|line| Line::styled(format!(" {line}"), style));
            lines.splice(0..0, styled);
        }
        lines.truncate(most);
        lines
    }

    fn style(&self, color: Color) -> Style {
        if self.color { Style::new().fg(color) } else { Style::new() }
    }
}

/// A time to a tenth of a second: clocks tell more digits than anybody wants to read. The record has them all.
fn brief(time: Time) -> Time {
    Time::from_micros(time.as_micros().saturating_add(50_000).div_euclid(100_000) * 100_000)
}

fn brief_cells(row: &Row) -> [String; 3] {
    cells(&Row {
        time: row.time.map(brief),
        observed: row.observed.map(|heard| heard.map(brief)),
        happened: row.happened.map(|within| Interval::new(brief(within.earliest), brief(within.latest))),
        ..row.clone()
    })
}

/// The widths of the columns of the timetable.
fn columns(snapshot: &Snapshot) -> [usize; 3] {
    let mut widths = ["time".len(), "event".len(), "how".len()];
    for row in &snapshot.rows {
        for (column, cell) in brief_cells(row).iter().enumerate() {
            widths[column] = widths[column].max(width(cell));
        }
    }
    widths
}

fn help(wide: usize) -> Vec<Line<'static>> {
    let keys = [
        ("1-9, a-z", "the event beside the key has happened: kirk hears of it now"),
        ("Up Down PgUp PgDn Home", "look back in the timetable"),
        ("Tab", "turn the page of what may happen"),
        ("End", "follow the timetable again"),
        ("Ctrl-L", "draw the screen anew"),
        ("Ctrl-C", "twice: stop the mission"),
        ("any key", "close this help"),
    ];
    let column = if wide < ROOMY { 9 } else { 23 };
    let mut lines = Vec::new();
    for (key, text) in keys {
        let mut names = wrap(key, column).into_iter();
        let mut texts = wrap(text, wide.saturating_sub(column + 2)).into_iter();
        loop {
            let (name, text) = (names.next(), texts.next());
            if name.is_none() && text.is_none() {
                break;
            }
            let name = fill(&name.unwrap_or_default(), column);
            let name = Span::styled(format!(" {name} "), Style::new().add_modifier(Modifier::BOLD));
            lines.push(Line::from(vec![name, Span::raw(text.unwrap_or_default())]));
        }
    }
    lines
}

fn split(area: Rect, height: u16) -> (Rect, Rect) {
    let height = height.min(area.height);
    (Rect { height, ..area }, Rect { y: area.y + height, height: area.height - height, ..area })
}

fn put(buffer: &mut Buffer, area: Rect, lines: &[Line<'_>]) {
    for (line, y) in lines.iter().zip(area.y..area.bottom()) {
        buffer.set_line(area.x, y, line, area.width);
    }
}
