//! What the screen shows: a function of what is known, the moment and the size. ASCII but for names, so that any
//! terminal and any encoding will do; colours only underline what words say.

use kirk_executive::{Next, Possible, Snapshot, Waits};
use kirk_network::Time;
use kirk_network::time::Interval;
use kirk_runtime::{How, Outcome, Pending, Row};
use ratatui::buffer::Buffer;
use ratatui::layout::Constraint::{Fill, Length};
use ratatui::layout::{Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::text::{Line, Text};
use ratatui::widgets::Row as Cells;
use ratatui::widgets::{Block, Padding, Paragraph, Table, Widget};

use super::log::Tone;
use super::state::State;
use super::text::{cut, shorten, width, wrap};
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
        Line::raw("starting the mission").render(area, buffer);
        return 0;
    };
    let headlines = view.headlines(snapshot, wide);
    let [header, rest] = Layout::vertical([Length(1), Fill(1)]).areas(area);
    let [top, body] = Layout::vertical([Length(headlines.height() as u16), Fill(1)]).areas(rest);
    view.header(snapshot, header, buffer);
    headlines.render(top, buffer);
    if state.help {
        help(wide).render(body, buffer);
        return 0;
    }
    let (left, right, below) = if area.width >= WIDE {
        let needed = columns(snapshot).iter().sum::<usize>() + 6;
        let width = (needed as u16).clamp(area.width / 3, area.width * 3 / 5);
        let [left, right] = Layout::horizontal([Length(width), Fill(1)]).areas(body);
        (left, right, view.below(snapshot, right.width as usize, right.height as usize))
    } else {
        let rows = (snapshot.rows.len() + 1).min(ROWS.min(body.height as usize / 4) + 1);
        let below = view.below(snapshot, wide, (body.height as usize).saturating_sub(rows));
        let [left, right] = Layout::vertical([Fill(1), Length(below.height())]).areas(body);
        (left, right, below)
    };
    below.render(right, buffer);
    let visible = (left.height as usize).saturating_sub(1);
    view.rows(snapshot, left.width as usize, visible).render(left, buffer);
    visible
}

/// Everything but the timetable.
struct Below {
    /// What may be heard, and the height it takes.
    possible: Table<'static>,
    listed: u16,
    /// What the driver has in hand, and what was said.
    lines: Vec<Line<'static>>,
}

impl Below {
    fn height(&self) -> u16 {
        self.listed + self.lines.len() as u16
    }

    fn render(self, area: Rect, buffer: &mut Buffer) {
        let [list, rest] = Layout::vertical([Length(self.listed), Fill(1)]).areas(area);
        self.possible.render(list, buffer);
        Paragraph::new(self.lines).render(rest, buffer);
    }
}

struct View<'a> {
    state: &'a State,
    now: Time,
    color: bool,
}

impl View<'_> {
    /// The program, the time and what may be asked.
    fn header(&self, snapshot: &Snapshot, area: Rect, buffer: &mut Buffer) {
        let wide = area.width as usize;
        let state = match snapshot.outcome {
            _ if self.state.stopping => "stopping",
            Outcome::Running if snapshot.waits.is_some() => "waiting",
            Outcome::Running => "running",
            Outcome::Completed => "completed",
            Outcome::Failed => "failed",
            Outcome::BrokenModel => "broken model",
        };
        let time = format!("{} s", self.now.second());
        let help = if wide < ROOMY { "? help" } else { "? help   Ctrl-C stop" };
        let name =
            cut(&snapshot.program, wide.saturating_sub(time.len() + state.len() + help.len() + 7).max(6));
        let [left, right] = Layout::horizontal([Fill(1), Length(help.len() as u16 + 1)]).areas(area);
        Line::raw(format!(" {name}  {time}  {state}")).render(left, buffer);
        Line::raw(help).render(right, buffer);
        buffer.set_style(area, Style::new().reversed().bold());
    }

    /// What stands below the header: a question, the end, or what comes next.
    fn headlines(&self, snapshot: &Snapshot, wide: usize) -> Text<'static> {
        let lines =
            |text: &str, style: Style| Text::from_iter(wrap(text, wide).into_iter().take(3)).style(style);
        match (self.state.question(), &snapshot.failure, &snapshot.next) {
            (Some(question), ..) => lines(question, Style::new().reversed()),
            (_, Some(failure), _) => lines(&failure.detail, self.style(Color::Red)),
            _ if snapshot.waits.is_some() => {
                let until = match &snapshot.waits {
                    Some(Waits::Driver(event)) => format!("when the driver has confirmed {event}"),
                    Some(Waits::Hour) | None => format!("in {} s", self.seconds_to(Time::ZERO)),
                };
                lines(&format!("next: the mission begins {until}"), Style::new())
            }
            (_, _, Some(next)) => self.next(next, wide).into(),
            _ if snapshot.outcome != Outcome::Running => Text::default(),
            _ if snapshot.pending.is_empty() => Text::raw("next: waiting for news"),
            _ => Text::raw("next: waiting for the driver"),
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
    fn rows(&self, snapshot: &Snapshot, wide: usize, visible: usize) -> Table<'static> {
        let [time, event, how] = columns(snapshot);
        let room = wide.saturating_sub(time + 5);
        // The word for how comes first, so the rest of it may be cut; names are wanted whole.
        let event = event.min(room.saturating_sub(how.min(room / 2)));
        let line = |at: String, name: &str, how: &str| {
            let how = shorten(how, room.saturating_sub(event));
            Cells::new([Line::from(at).right_aligned(), cut(name, event).into(), how.into()])
        };
        let last = snapshot.rows.len().saturating_sub(visible);
        let first = self.state.first.map_or(last, |first| first.min(last));
        let later = last - first;
        let heading = if later > 0 { format!("how ({later} later: End)") } else { "how".to_string() };
        let heading = line("time".to_string(), "event", &heading).bold();
        let row = |row: &Row| {
            let [at, name, how] = brief_cells(row);
            let style = match row.how {
                How::Observed | How::Buffered => self.style(Color::Green),
                How::Imagined => self.style(Color::Yellow),
                How::Dispatched | How::Never => Style::new(),
            };
            line(at, &name, &how).style(style)
        };
        let rows = snapshot.rows.iter().skip(first).take(visible).map(row);
        let widths = [Length(time as u16 + 1), Length(event as u16), Fill(1)];
        Table::new(rows, widths).header(heading).column_spacing(2)
    }

    /// Everything but the timetable: what may be heard, what the driver has in hand, and what was said.
    fn below(&self, snapshot: &Snapshot, wide: usize, height: usize) -> Below {
        let possible = self.possible(snapshot);
        let all = if possible.is_empty() { 0 } else { possible.len() + 1 };
        // The latest is always there; more of it if there is room.
        let said = self.said(wide, height.saturating_sub(all + snapshot.pending.len()).clamp(2, 6));
        let room = height.saturating_sub(said.len().min(2));
        let listed = all.min(room);
        let pending = snapshot.pending.iter().take(room - listed).map(|pending| self.pending(pending, wide));
        let mut lines: Vec<Line<'static>> = pending.collect();
        let latest = said.len().saturating_sub(height - listed - lines.len());
        lines.extend(said.into_iter().skip(latest));
        Below { possible: self.listed(&possible, wide, listed), listed: listed as u16, lines }
    }

    /// What may be heard, and the keys for it: what has no key comes last, digits come before letters.
    fn possible<'a>(&self, snapshot: &'a Snapshot) -> Vec<(bool, Option<char>, &'a Possible)> {
        let keyed = |possible: &'a Possible| {
            (self.now < possible.from, self.state.keys.of(&possible.event), possible)
        };
        let mut all: Vec<_> = snapshot.possible.iter().map(keyed).collect();
        all.sort_by_key(|&(early, key, _)| (early, key.is_none(), key));
        all
    }

    /// What may be heard below a title: if there is no room for all of it, a page.
    fn listed(&self, all: &[(bool, Option<char>, &Possible)], wide: usize, height: usize) -> Table<'static> {
        let room = height.saturating_sub(1).max(1);
        let pages = all.len().div_ceil(room).max(1);
        let page = self.state.turned % pages;
        let title = match pages {
            1 if wide < ROOMY => "Press what has happened:".to_string(),
            1 => "Press the key of what has happened:".to_string(),
            _ => format!("Press what has happened (page {} of {pages}: Tab)", page + 1),
        };
        let name = all.iter().map(|(.., possible)| width(&possible.event)).max().unwrap_or(0);
        let name = name.min(if wide < ROOMY { wide.saturating_sub(20) } else { wide / 2 });
        let rows = all.iter().skip(page * room).take(room).map(|&(early, key, possible)| {
            let style = match possible.until {
                _ if early => Style::new().dim(),
                Some(until) if self.now > until => self.style(Color::Red),
                _ => self.style(Color::Green).bold(),
            };
            let key = key.map_or(String::new(), |key| format!(" [{key}]"));
            let window = shorten(&self.window(possible, wide), wide.saturating_sub(name + 7));
            Cells::new([key, cut(&possible.event, name), window]).style(style)
        });
        Table::new(rows, [Length(4), Length(name as u16 + 1), Fill(1)])
            .block(Block::new().title(Line::raw(title).bold()))
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

fn help(wide: usize) -> Table<'static> {
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
    let rows = keys.map(|(key, text)| {
        let key = Text::from_iter(wrap(key, column)).bold();
        let text = Text::from_iter(wrap(text, wide.saturating_sub(column + 2)));
        let height = key.height().max(text.height());
        Cells::new([key, text]).height(height as u16)
    });
    Table::new(rows, [Length(column as u16), Fill(1)]).block(Block::new().padding(Padding::left(1)))
}
