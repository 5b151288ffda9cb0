//! `(define-team name (agent a) (agent b) (link a b :min-delay 5 :max-delay 15))`.

use super::body::{bodies, interval};
use super::ident;
use super::options::{flag, options};
use super::problem::{Expected, Missing, Problem, Twice};
use crate::ast::{Body, Ident, Limits, Link, Team, WithAgent};
use crate::form::{Form, FormKind};
use crate::problem::Problems;
use crate::words::keywords;

/// The keywords of a link.
const LINK: [&str; 4] = keywords("link");

/// Parses the definition of a team.
pub(super) fn team(form: &Form, rest: &[Form], home: &str, problems: &mut Problems) -> Option<Team> {
    let Some((name, rest)) = rest.split_first() else {
        problems.push(Problem::Missing { at: form.span, what: Missing::PartsOfTeam });
        return None;
    };
    let Some(name) = ident(name) else {
        problems.push(Problem::Unexpected { found: name, expected: Expected::TeamName });
        return None;
    };
    let mut team =
        Team { home: home.to_string(), name, agents: Vec::new(), links: Vec::new(), span: form.span };
    for item in rest {
        match item.call() {
            Some(("agent", inside)) => {
                let mut named = None;
                agent(item, inside, &mut named, problems);
                team.agents.extend(named);
            }
            Some(("link", [from, to, choice @ ..])) => {
                team.links.extend(link(item, [from, to], choice, problems))
            }
            Some(("link", _)) => {
                problems.push(Problem::Missing { at: item.span, what: Missing::Linked });
            }
            // What it is for.
            _ if matches!(item.kind, FormKind::String(_)) || item.is_error() => {}
            _ => problems.push(Problem::Unexpected { found: item, expected: Expected::PartOfTeam }),
        }
    }
    Some(team)
}

fn link(form: &Form, ends: [&Form; 2], choice: &[Form], problems: &mut Problems) -> Option<Link> {
    if let Some(end) = ends.into_iter().find(|end| ident(end).is_none()) {
        problems.push(Problem::Unexpected { found: end, expected: Expected::AgentOfLink });
        return None;
    }
    let [min, max, one_way, stamped] = options(choice, LINK, "link", problems);
    let mut is_set = |form: Option<&Form>, name| form.is_some_and(|form| flag(form, name, problems));
    let (one_way, stamped) = (is_set(one_way, LINK[2]), is_set(stamped, LINK[3]));
    let delay = interval([min, max], Limits::Message, form.span, problems);
    let [from, to] = ends.map(ident);
    Some(Link { from: from?, to: to?, delay, one_way, stamped, span: form.span })
}

/// `(with-agent robot body...)`.
pub(super) fn with_agent(form: &Form, rest: &[Form], problems: &mut Problems) -> Option<Body> {
    let (agent, body) = match rest.split_first() {
        Some((agent, body)) if ident(agent).is_some() && !body.is_empty() => (ident(agent)?, body),
        _ => {
            problems.push(Problem::Missing { at: form.span, what: Missing::PartsOfWithAgent });
            return None;
        }
    };
    Some(Body::WithAgent(WithAgent { agent, body: bodies(body, problems), span: form.span }))
}

/// `(agent robot)` in a `declare`.
pub(super) fn agent(form: &Form, inside: &[Form], known: &mut Option<Ident>, problems: &mut Problems) {
    match (inside, &known) {
        ([name], None) if ident(name).is_some() => *known = ident(name),
        (_, Some(first)) => {
            let (what, first, again) = (Twice::Agent, first.span, form.span);
            problems.push(Problem::Twice { what, first, again, whole: None });
        }
        _ => problems.push(Problem::Missing { at: form.span, what: Missing::Agent }),
    }
}

/// The agent after `:observed-by`.
pub(super) fn observer(form: &Form, problems: &mut Problems) -> Option<Ident> {
    let named = ident(form);
    if named.is_none() && !form.is_error() {
        problems.push(Problem::Unexpected { found: form, expected: Expected::Observer });
    }
    named
}
