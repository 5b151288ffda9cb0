//! The team, and which of its agents is meant where one is named.

use super::Variable;
use super::expression::{Numbers, Resolver};
use super::names::Names;
use super::problem::{Defined, Problem};
use super::symbols::Uses;
use crate::ast::{self, Ident, Limits, ValueKind};
use crate::nearest::nearest;
use crate::problem::Problems;
use crate::typed::{Expression, ExpressionKind, Link, Team};

/// Resolves the one team that there may be.
pub(super) fn team(
    program: &ast::Program,
    names: &Names,
    numbers: &Numbers,
    uses: &mut Uses,
    problems: &mut Problems,
) -> Option<Team> {
    let (written, others) = program.teams.split_first()?;
    for other in others {
        problems.push(Problem::SecondTeam { team: other.name.clone(), first: written.name.span });
    }
    if written.agents.is_empty() {
        problems.push(Problem::EmptyTeam { team: written.name.clone() });
    }
    for (index, agent) in written.agents.iter().enumerate() {
        if let Some(first) = written.agents[..index].iter().find(|first| first.name == agent.name) {
            let (what, name) = (Defined::Agent, agent.clone());
            problems.push(Problem::DefinedTwice { what, name, first: first.span });
        }
    }
    let home = &written.home;
    let mut resolver = Resolver { names, numbers, program, home, scope: &[], uses, problems };
    let links = written.links.iter().filter_map(|link| resolver.link(link, &written.agents)).collect();
    Some(Team { name: written.name.clone(), agents: written.agents.clone(), links })
}

impl Resolver<'_> {
    fn link(&mut self, written: &ast::Link, agents: &[Ident]) -> Option<Link> {
        let [from, to] = [&written.from, &written.to].map(|name| {
            self.agent(name)?;
            agents.iter().position(|agent| agent.name == name.name)
        });
        let delay = self.delay(&written.delay, Limits::Message);
        let (from, to) = (from?, to?);
        if from == to {
            self.problems.push(Problem::LinkToItself { agent: written.to.clone(), link: written.span });
        }
        let ast::Link { one_way, stamped, span, .. } = *written;
        Some(Link { from, to, delay, one_way, stamped, span })
    }

    /// An agent, or a variable that stands for one; what is neither is reported.
    pub(super) fn agent(&mut self, name: &Ident) -> Option<Expression> {
        let is_meant = |known: &Variable| name.package.is_none() && known.name == name.name;
        let kind = if let Some(index) = self.scope.iter().rposition(is_meant) {
            self.uses.place(self.scope[index].symbol, name.span);
            ExpressionKind::Variable(index, name.name.clone())
        } else if self.names_agent(name) {
            ExpressionKind::Value(ValueKind::Name(None, name.name.clone()))
        } else {
            let team = self.program.teams.first();
            let agents = team.into_iter().flat_map(|team| &team.agents).map(|agent| agent.name.as_str());
            let known = agents.chain(self.scope.iter().map(|variable| variable.name.as_str()));
            let near = nearest(&name.name, known).map(str::to_string);
            let team = team.map(|team| team.name.clone());
            if !self.problems.has_lost(&name.name) {
                self.problems.push(Problem::UnknownAgent { name: name.clone(), team, near });
            }
            return None;
        };
        Some(Expression { kind, span: name.span })
    }

    /// True if this names an agent of the team, which is taken down.
    pub(super) fn names_agent(&mut self, name: &Ident) -> bool {
        let agents = self.program.teams.first().map_or(&[][..], |team| &team.agents);
        let is_known = agents.iter().any(|agent| agent.name == name.name);
        if is_known {
            self.uses.agent(name);
        }
        is_known
    }
}
