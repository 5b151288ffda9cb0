//! Promises, and what is missing for them, as sentences.

use kirk_compiler::{Code, Diagnostic, Explain, Span};
use kirk_network::{Bound, Delay, Duration, EventId, Network};

use crate::find::Agreement;
use crate::mission::Mission;
use crate::model::{AgentId, Team, TeamError};
use crate::promise::Promise;
use crate::shortage::{Cause, Change, Member, NotFound, Remedy};

impl Agreement {
    /// Who gives a promise.
    pub fn owner(&self, promise: &Promise, team: &Team) -> Option<AgentId> {
        team.owner(team.network().find(self.network.id(promise.event))?)
    }

    /// Who counts on a promise, and how late each hears that it was kept; `None` if never.
    pub fn hearers(&self, promise: &Promise, team: &Team) -> Vec<(AgentId, Option<Delay>)> {
        let name = self.network.id(promise.event);
        let Some(event) = team.network().find(name) else { return Vec::new() };
        let counts_on = |view: &&crate::View| {
            let here = view.network.find(name).and_then(|here| view.network.link_of(here));
            here.is_some() && team.owner(event) != Some(view.agent)
        };
        let hears = |view: &crate::View| (view.agent, team.news(event, view.agent));
        self.views.iter().filter(counts_on).map(hears).collect()
    }

    /// Each promise as a sentence.
    pub fn sentences(&self, team: &Team) -> Vec<String> {
        self.promises.iter().map(|promise| self.sentence(promise, team)).collect()
    }

    fn sentence(&self, promise: &Promise, team: &Team) -> String {
        let owner = self.owner(promise, team).map_or("somebody", |agent| team.name(agent));
        let doing = Moment::of(&self.network, promise.event, ":start").to_come();
        let base = if promise.base == self.network.origin() {
            "all have started".to_string()
        } else {
            Moment::of(&self.network, promise.base, ":end").has_come()
        };
        let when = match (promise.low, promise.high) {
            (Duration::ZERO, Duration::ZERO) => format!("at the very moment at which {base}"),
            (low, high) if low == high => format!("{low} s after {base}"),
            (low, high) => format!("{low} to {high} s after {base}"),
        };
        let hears = |(agent, news): (AgentId, Option<Delay>)| {
            format!("; {} hears of it {}", team.name(agent), how_late(news))
        };
        let heard: String = self.hearers(promise, team).into_iter().map(hears).collect();
        format!("{owner} promises to {doing} {when}{heard}")
    }
}

fn how_late(news: Option<Delay>) -> String {
    match news {
        None => "never".to_string(),
        Some(Delay::NONE) => "at once".to_string(),
        Some(Delay { min, max: Bound::Infinite }) => format!("{min} s later at the soonest, or never"),
        Some(Delay { min, max: Bound::Finite(max) }) if min == max => format!("{min} s later"),
        Some(Delay { min, max: Bound::Finite(max) }) => format!("{min} to {max} s later"),
    }
}

/// The start or the end of something, or what has neither.
enum Moment<'a> {
    Start(&'a str),
    End(&'a str),
    Event(&'a str),
}

impl<'a> Moment<'a> {
    /// By a name that a user wrote and that ends so, if there is one.
    fn of(network: &'a Network, event: EventId, wanted: &str) -> Moment<'a> {
        let names = || network.events()[event.index()].names.iter().filter(|name| !name.internal);
        let name = names().find(|name| name.text.ends_with(wanted));
        let name = name.map_or_else(|| network.label(event), |name| name.text.as_str());
        if let Some(what) = name.strip_suffix(":start") {
            Moment::Start(what)
        } else if let Some(what) = name.strip_suffix(":end") {
            Moment::End(what)
        } else {
            Moment::Event(name)
        }
    }

    fn to_come(&self) -> String {
        match self {
            Moment::Start(what) => format!("start `{what}`"),
            Moment::End(what) => format!("end `{what}`"),
            Moment::Event(what) => format!("execute `{what}`"),
        }
    }

    fn has_come(&self) -> String {
        match self {
            Moment::Start(what) => format!("`{what}` has started"),
            Moment::End(what) => format!("`{what}` has ended"),
            Moment::Event(what) => format!("`{what}` has happened"),
        }
    }
}

/// What is said of parts that do not make a team. Most of that the compiler has told already.
pub(crate) fn no_team(wrong: &TeamError, mission: Span) -> Diagnostic {
    Diagnostic::error(Code::WrongShape, mission, wrong.to_string())
}

/// That no promises were found, how much is missing, of what that is the sum, and which link would do.
pub(crate) fn not_found(mission: &Mission, missing: &NotFound, explain: &Explain<'_>) -> Diagnostic {
    let mut message = format!("no promises were found with which `{}` can be sure of this", mission.name);
    if let Some(lacks) = missing.lacks {
        message.push_str(&format!(": {lacks} s is missing"));
    }
    let mut diagnostic = Diagnostic::error(Code::NoPromises, explain.program.unwrap_or_default(), message)
        .primary("possible if everybody knew everything at once, but news is late");
    for Member { what, .. } in &missing.members {
        let (place, says) = match *what {
            Cause::Part(part) => match explain.origins.constraint(part) {
                Some(origin) => (origin.span, origin.text()),
                None => continue,
            },
            Cause::Longest(link) | Cause::Shortest(link) => (mission.place(link), mission.says(link, *what)),
        };
        if diagnostic.labels.iter().all(|known| (known.span, &known.message) != (place, &says)) {
            diagnostic = diagnostic.label(place, says);
        }
    }
    let would_do: Vec<String> =
        mission.remedies.iter().map(|remedy| remedy.sentence(&mission.team)).collect();
    diagnostic.help(match would_do.as_slice() {
        [] => "No change of one link alone was found that would do. Let the bounds leave more room; a moment that was agreed on needs no \
               news."
            .to_string(),
        [one] => format!("This would do: {one}."),
        _ => format!("Each alone would do: {}.", would_do.join("; ")),
    })
}

impl Mission {
    /// Where a link is written.
    pub fn place(&self, link: u32) -> Span {
        self.places[link as usize]
    }

    /// What a link contributes to what is missing.
    pub fn says(&self, link: u32, cause: Cause) -> String {
        let Delay { min, max } = self.team.links()[link as usize].delay;
        match (cause, max) {
            (Cause::Shortest(_), _) => format!("news takes {min} s or more over this link"),
            (_, Bound::Finite(max)) => format!("news takes up to {max} s over this link"),
            (_, Bound::Infinite) => "news may be lost on this link".to_string(),
        }
    }
}

impl Remedy {
    /// It as a sentence without its end.
    pub fn sentence(&self, team: &Team) -> String {
        let link = &team.links()[self.link];
        let both = if link.one_way { "to" } else { "and" };
        let ends = format!("the link `{}` {both} `{}`", link.from, link.to);
        match self.change {
            Change::Within(most) => format!("`:max-delay {most}` on {ends}"),
            Change::Stamped => format!("`:stamped t` on {ends}"),
        }
    }
}
