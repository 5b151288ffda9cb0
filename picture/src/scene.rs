//! Where everything is: boxes, lines and words with coordinates, in pixels from the upper left corner. No two words overlap.

use kirk_network::{Duration, Interval, Time};
use kirk_runtime::How;

use crate::chart::{Bar, Chart, Moment, Whose};
use crate::ticks::{say, ticks};

/// How a chart is to look.
#[derive(Clone, Copy, Debug, Default)]
pub struct Look {
    /// The time of day at which the mission starts, from midnight; without it times are those of the mission.
    pub start: Option<Duration>,
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// How wide it is.
    pub width: f64,
    /// How high.
    pub height: f64,
    /// What it is called, and what is said of it.
    pub title: String,
    /// What is said of it.
    pub says: String,
    /// What each bar is called, and what is said when it is pointed at.
    pub bars: Vec<(String, String)>,
    /// What is to be drawn, in this order.
    pub items: Vec<Item>,
    /// Where the times from the start to the end are.
    pub plot: (f64, f64),
    /// The time at its right edge.
    pub end: Time,
}

/// Something to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What shape it has.
    pub shape: Shape,
    /// What it is, which decides how it looks.
    pub class: &'static str,
    /// The bar it belongs to, of those of the scene.
    pub of: Option<usize>,
    /// From when on it is known, in an execution.
    pub known: Option<Time>,
}

/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box: its left upper corner, its width, its height.
    Box([f64; 4]),
    /// A line from one point to another.
    Line([f64; 4]),
    /// An arrow from one point to another.
    Arrow([f64; 4]),
    /// A diamond around a point.
    Diamond([f64; 2]),
    /// Words from a point on, or ending there.
    Words {
        /// Where they begin, on the line they stand on; or where they end, or their middle.
        at: [f64; 2],
        /// Which of these.
        anchor: Anchor,
        /// The words.
        text: String,
    },
}

/// What of some words is at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Their beginning.
    Start,
    /// Their middle.
    Middle,
}

/// What a letter takes at most on average.
const LETTER: f64 = 6.8;
const ROW: f64 = 36.0;
const BAR: f64 = 18.0;
const LEFT: f64 = 24.0;
const TOP: f64 = 78.0;
const PLOT: f64 = 1_040.0;
/// Below the rows: the axis and the words for what is drawn.
const BOTTOM: f64 = 76.0;

/// A line below them.
const NOTE: f64 = 16.0;

/// How wide some words are, rather too wide than too narrow.
pub(crate) fn width(text: &str) -> f64 {
    text.chars().count() as f64 * LETTER
}

impl Scene {
    /// Lays out a chart.
    pub fn new(chart: &Chart, look: Look) -> Scene {
        let end = chart.end.max(Time::from_micros(1));
        let mut drawing =
            Drawing { chart, look, end, items: Vec::new(), of: None, taken: vec![Vec::new(); chart.rows] };
        let bottom = TOP + ROW * chart.rows as f64;
        drawing.axis(bottom);
        // What is around is behind.
        for (number, bar) in chart.bars.iter().enumerate().filter(|(_, bar)| bar.around > 0) {
            drawing.of = Some(number);
            drawing.form(bar);
        }
        for (number, bar) in chart.bars.iter().enumerate().filter(|(_, bar)| bar.around == 0) {
            drawing.of = Some(number);
            drawing.bar(bar);
        }
        drawing.lanes();
        drawing.news_of_others();
        drawing.names();
        drawing.of = None;
        drawing.legend(bottom + 54.0);
        for (line, text) in chart.notes.iter().enumerate() {
            let at = [LEFT, bottom + BOTTOM + 8.0 + NOTE * line as f64];
            drawing.add(Shape::Words { at, anchor: Anchor::Start, text: text.clone() }, "note");
        }
        let bars = chart.bars.iter().map(|bar| (bar.name.clone(), drawing.hint(bar))).collect();
        let items = drawing.items;
        Scene {
            width: LEFT * 2.0 + PLOT,
            height: bottom + BOTTOM + NOTE * chart.notes.len() as f64,
            title: chart.title.clone(),
            says: chart.says.clone(),
            bars,
            items,
            plot: (LEFT, LEFT + PLOT),
            end,
        }
    }

    /// The boxes that words take, to see that none overlap.
    pub fn words(&self) -> Vec<([f64; 4], &str)> {
        let words = self.items.iter().filter_map(|item| match &item.shape {
            Shape::Words { at: [x, y], anchor, text } => {
                let wide = width(text);
                let left = if *anchor == Anchor::Middle { x - wide / 2.0 } else { *x };
                Some(([left, y - 10.0, wide, 13.0], text.as_str()))
            }
            _ => None,
        });
        words.collect()
    }
}

struct Drawing<'a> {
    chart: &'a Chart,
    look: Look,
    end: Time,
    items: Vec<Item>,
    /// The bar that is being drawn.
    of: Option<usize>,
    /// Of each row, from where to where something stands.
    taken: Vec<Vec<(f64, f64)>>,
}

impl Drawing<'_> {
    fn x(&self, time: Time) -> f64 {
        let share = time.min(self.end).as_micros() as f64 / self.end.as_micros() as f64;
        LEFT + share * PLOT
    }

    fn say(&self, time: Time) -> String {
        say(time, self.end, self.look.start)
    }

    fn length(&self, length: Duration) -> String {
        say(Time::after_origin(length), self.end, None)
    }

    fn add(&mut self, shape: Shape, class: &'static str) {
        self.add_known(shape, class, None);
    }

    /// Something that is known from some time on.
    fn add_known(&mut self, shape: Shape, class: &'static str, known: Option<Time>) {
        let known = known.filter(|_| self.chart.happened);
        self.items.push(Item { shape, class, of: self.of, known });
    }

    fn axis(&mut self, bottom: f64) {
        for time in ticks(self.end, 12) {
            let x = self.x(time);
            self.add(Shape::Line([x, TOP - 8.0, x, bottom + 4.0]), "grid");
            let text = self.say(time);
            // The last would stand over the edge.
            let is_inside = x + width(&text) / 2.0 <= LEFT * 2.0 + PLOT && x - width(&text) / 2.0 >= 0.0;
            if is_inside {
                self.add(Shape::Words { at: [x, bottom + 20.0], anchor: Anchor::Middle, text }, "tick");
            }
        }
    }

    /// A form around activities, with its limit.
    fn form(&mut self, bar: &Bar) {
        let y = TOP + ROW * bar.row as f64 + ROW / 2.0;
        let (from, to) = (self.x(bar.start.at()), self.x(bar.end.at()));
        let below = ROW * bar.around as f64;
        let class = if bar.is_blamed { "around blamed" } else { "around" };
        let shape = Shape::Box([from, y - 12.0, (to - from).max(2.0), below + ROW / 2.0 + 8.0]);
        self.add(shape, class);
        if let Some(latest) = bar.limit.map(|limit| bar.start.at().saturating_add(limit))
            && latest <= self.end
        {
            let x = self.x(latest);
            let class = if bar.is_blamed { "limit blamed" } else { "limit" };
            let line = Shape::Line([x, y - 14.0, x, y + below + ROW / 2.0 - 2.0]);
            self.add(line, class);
        }
    }

    fn bar(&mut self, bar: &Bar) {
        let y = TOP + ROW * bar.row as f64 + (ROW - BAR) / 2.0 + 4.0;
        let (start, end) = (self.x(bar.start.at()), self.x(bar.end.at()));
        let known = bar.start.done.map(|(time, _)| time);
        let class = match (bar.whose, bar.is_blamed) {
            (Whose::Ours, false) => "ours",
            (Whose::Natures, false) => "natures",
            (Whose::Ours, true) => "ours blamed",
            (Whose::Natures, true) => "natures blamed",
        };
        let mut last = end.max(start + 2.0);
        match bar.open {
            // What is certain, and between when and when Nature ends it.
            Some(Interval { earliest, latest }) => {
                let (earliest, latest) = (self.x(earliest).max(start), self.x(latest));
                self.add_known(Shape::Box([start, y, (earliest - start).max(1.0), BAR]), class, known);
                if latest > earliest {
                    self.add_known(Shape::Box([earliest, y, latest - earliest, BAR]), "open", known);
                }
                self.news(bar, y);
                last = last.max(latest);
            }
            None => self.add_known(Shape::Box([start, y, (end - start).max(2.0), BAR]), class, known),
        }
        if !self.chart.happened {
            // Those of what comes one after the other are not to be taken for one.
            let apart = if self.taken[bar.row].len().is_multiple_of(2) { 4.0 } else { 7.0 };
            self.whisker(&bar.start, y - apart);
        }
        self.taken[bar.row].push((start, last));
    }

    /// Between which times something can happen.
    fn whisker(&mut self, moment: &Moment, y: f64) {
        let latest = moment.latest.map_or(self.end, |latest| latest.min(self.end));
        if latest > moment.earliest {
            let (from, to) = (self.x(moment.earliest), self.x(latest));
            for line in [[from, y, to, y], [from, y - 2.0, from, y + 2.0], [to, y - 2.0, to, y + 2.0]] {
                self.add(Shape::Line(line), "whisker");
            }
        }
    }

    /// From when Nature ended something to when that was heard, and how it was acted on.
    fn news(&mut self, bar: &Bar, y: f64) {
        let Moment { done, heard, truth, .. } = bar.end;
        let below = y + BAR + 6.0;
        if let Some(truth) = truth.filter(|_| self.chart.happened) {
            let at = [self.x(truth), y + BAR / 2.0];
            self.add(Shape::Diamond(at), "truth");
        }
        let happened = truth.or(bar.open.map(|open| open.latest)).unwrap_or(bar.end.at());
        if let Some(heard) = heard.filter(|heard| *heard > happened) {
            let (from, to) = (self.x(happened), self.x(heard));
            self.add_known(Shape::Arrow([from, below, to, below]), "heard", Some(heard));
        }
        if let Some((time, how)) = done {
            let class = match how {
                How::Imagined => "imagined",
                How::Buffered => "held",
                How::Dispatched | How::Observed | How::Never => "acted",
            };
            let x = self.x(time);
            self.add_known(Shape::Line([x, y - 5.0, x, y + BAR + 5.0]), class, Some(time));
        }
    }

    /// Whose rows they are, and a line above them.
    fn lanes(&mut self) {
        self.of = None;
        for (agent, row) in &self.chart.lanes {
            let y = TOP + ROW * *row as f64;
            self.add(Shape::Line([LEFT, y + 6.0, LEFT + PLOT, y + 6.0]), "grid");
            let words = Shape::Words { at: [LEFT, y + 26.0], anchor: Anchor::Start, text: agent.clone() };
            self.add(words, "agent");
        }
    }

    /// From the row of what happened to the row of who heard of it.
    fn news_of_others(&mut self) {
        let middle = |row: usize| TOP + ROW * row as f64 + ROW / 2.0 + 4.0;
        for news in &self.chart.news {
            let ((from, at), (to, heard)) = (news.from, news.to);
            let toward = if to > from { BAR / 2.0 } else { -BAR / 2.0 };
            let arrow = [self.x(at), middle(from) + toward, self.x(heard), middle(to) - toward];
            self.add_known(Shape::Arrow(arrow), "heard", Some(heard));
        }
    }

    /// Names stand in their bars, or beside them, as long as there is room.
    fn names(&mut self) {
        let mut bars: Vec<(usize, &Bar)> = self.chart.bars.iter().enumerate().collect();
        bars.sort_by_key(|(_, bar)| (bar.row, bar.start.at(), bar.end.at()));
        let mut written: Vec<Vec<(f64, f64)>> = vec![Vec::new(); self.chart.rows];
        for (number, bar) in bars {
            self.of = Some(number);
            let y = TOP + ROW * bar.row as f64 + (ROW - BAR) / 2.0 + 4.0 + BAR / 2.0 + 4.0;
            let (start, end) = (self.x(bar.start.at()), self.x(bar.end.at()));
            let name = self.called(bar);
            let wide = width(&name);
            let inside = start + 4.0;
            let is_form = bar.around > 0;
            // Letters on a bar are bold.
            let fits = is_form || wide * 1.1 + 8.0 <= end - start;
            let taken = &self.taken[bar.row];
            let beside =
                taken.iter().filter(|(from, _)| *from <= start).map(|(_, to)| *to).fold(end, f64::max) + 5.0;
            let x = if fits { inside } else { beside };
            if name.is_empty() {
                continue;
            }
            let is_free = |spans: &[(f64, f64)]| {
                spans.iter().all(|&(from, to)| x + wide + 2.0 <= from || to + 2.0 <= x)
            };
            let own = (start, end);
            let others: Vec<(f64, f64)> =
                taken.iter().copied().filter(|span| !(fits && span.0 == own.0)).collect();
            let has_room =
                x + wide <= LEFT * 2.0 + PLOT - 2.0 && is_free(&written[bar.row]) && is_free(&others);
            if has_room {
                written[bar.row].push((x, x + wide));
                let at = if is_form { [x, y - 6.0] } else { [x, y] };
                let words = Shape::Words { at, anchor: Anchor::Start, text: name };
                let class = match (is_form, fits) {
                    (true, _) => "form",
                    (false, true) => "name inside",
                    (false, false) => "name",
                };
                self.add(words, class);
            }
        }
    }

    /// What stands at a bar: its name, and of a form its limit.
    fn called(&self, bar: &Bar) -> String {
        match (bar.is_nameless, bar.limit) {
            (false, None) => bar.name.clone(),
            (false, Some(limit)) => format!("{}, at most {}", bar.name, self.length(limit)),
            (true, Some(limit)) => format!("at most {}", self.length(limit)),
            (true, None) => String::new(),
        }
    }

    /// What the shapes mean, as far as they are there.
    fn legend(&mut self, y: f64) {
        let shapes: &[(&'static str, &str)] = match self.chart.happened {
            true => &[
                ("ours", "ours"),
                ("natures", "Nature's, certainly"),
                ("open", "ended in here"),
                ("truth", "ended, truly"),
                ("heard", "news on its way"),
                ("acted", "acted on when heard"),
                ("imagined", "acted on unheard"),
                ("held", "heard early and held"),
            ],
            false => &[
                ("ours", "ours"),
                ("natures", "Nature's, at the least"),
                ("open", "Nature ends it in here"),
                ("whisker", "can start in here"),
                ("heard", "its news, at the latest"),
                ("limit", "limit"),
                ("blamed", "does not go together"),
            ],
        };
        let mut x = LEFT;
        for &(class, text) in shapes {
            let is_there = self.items.iter().any(|item| item.class.split(' ').any(|word| word == class));
            if !is_there || x + 30.0 + width(text) > LEFT + PLOT {
                continue;
            }
            let middle = y - 4.0;
            let shape = match class {
                "truth" => Shape::Diamond([x + 9.0, middle]),
                "heard" => Shape::Arrow([x, middle, x + 18.0, middle]),
                "whisker" => Shape::Line([x, middle, x + 18.0, middle]),
                "acted" | "imagined" | "held" | "limit" => {
                    Shape::Line([x + 9.0, middle - 7.0, x + 9.0, middle + 7.0])
                }
                _ => Shape::Box([x, middle - 6.0, 18.0, 12.0]),
            };
            self.add(shape, if class == "blamed" { "ours blamed" } else { class });
            self.add(
                Shape::Words { at: [x + 24.0, y], anchor: Anchor::Start, text: text.to_string() },
                "legend",
            );
            x += 24.0 + width(text) + 18.0;
        }
    }

    /// All there is to say of a bar.
    fn hint(&self, bar: &Bar) -> String {
        let moment = |moment: &Moment| match (moment.done, moment.latest) {
            (Some((time, How::Dispatched)), _) => self.say(time),
            (Some((time, how)), _) => format!("{} ({})", self.say(time), how.word()),
            (None, Some(latest)) if latest == moment.earliest => self.say(latest),
            (None, Some(latest)) => format!("{} to {}", self.say(moment.earliest), self.say(latest)),
            (None, None) => format!("{} or later", self.say(moment.earliest)),
        };
        let mut lines = vec![bar.name.clone()];
        lines.push(format!("starts {}", moment(&bar.start)));
        lines.push(format!("ends {}", moment(&bar.end)));
        if let (Whose::Natures, true, Some(latest)) = (bar.whose, bar.end.done.is_some(), bar.end.latest) {
            lines.push(format!("happened {} to {}", self.say(bar.end.earliest), self.say(latest)));
        }
        if let Some(heard) = bar.end.heard {
            let words = if self.chart.happened { "heard" } else { "heard by" };
            lines.push(format!("{words} {}", self.say(heard)));
        }
        if let Some(limit) = bar.limit {
            lines.push(format!("at most {}", self.length(limit)));
        }
        if bar.is_blamed {
            lines.push("does not go together with what else is marked".to_string());
        }
        lines.join("\n")
    }
}
