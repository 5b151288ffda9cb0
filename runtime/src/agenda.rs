//! The real-time execution of a dispatchable network: what may be executed next, and when. Knows nodes only.
//!
//! L. Hunsberger, R. Posenato, *Foundations of dispatchability for simple temporal networks with uncertainty* (RTE*),
//! 2024. Executing a node looks at its direct neighbours and costs its degree (times the logarithm of the queue).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use kirk_network::controllability::Wait;
use kirk_network::stnu::{Edge, NONE, Rows};
use kirk_network::{Dispatchable, Duration, Time};

/// The state of an execution of one dispatchable network. The weights of its edges are microseconds.
#[derive(Clone, Debug)]
pub(crate) struct Agenda {
    edges: Vec<Edge>,
    /// How many of them are of the network; the others say what follows what.
    ordinary: usize,
    /// For each edge: its source is not executed before its target.
    holds: Vec<bool>,
    outgoing: Rows,
    incoming: Rows,
    /// The link ending at each node, and the links starting there.
    ending: Vec<u32>,
    starting: Rows,
    waits: Vec<ActiveWait>,
    waits_for: Rows,
    waits_of: Rows,
    nodes: Vec<NodeState>,
    /// Executable nodes that nothing holds back but time: (due less lead, node). Entries go stale and are then skipped.
    ready: BinaryHeap<Reverse<(Time, u32)>>,
}

#[derive(Clone, Debug)]
struct NodeState {
    executed: Option<Time>,
    /// It is in somebody's hands: not to be offered again.
    taken: bool,
    /// How long before it is due it is offered.
    lead: Duration,
    lower: Time,
    /// What the node came to wait for until then.
    hold: Hold,
    upper: Time,
    /// How many nodes must be executed before this one.
    held_by: u32,
}

impl NodeState {
    /// Of what holds until the same time, what came last counts.
    fn wait_until(&mut self, time: Time, hold: Hold) {
        if time >= self.lower {
            (self.lower, self.hold) = (time, hold);
        }
    }
}

/// What a node waits for, and so what its earliest time comes of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hold {
    /// For nothing but time 0.
    Nothing,
    /// Until so long after another node.
    After { node: u32, distance: Duration },
    /// For another node to be done, at whatever distance.
    Order { node: u32 },
    /// Until so long after the activation of a link, as its end has not come.
    Wait { link: u32, distance: Duration },
}

#[derive(Clone, Debug)]
struct ActiveWait {
    waiter: u32,
    link: u32,
    /// How long to wait after that.
    distance: Duration,
    /// Until when, once the activation is executed; `None` before, and again when the wait has ended.
    until: Option<Time>,
}

impl Agenda {
    /// Starts with the origin executed at time 0. Every node has a lead, by which it is offered before it is due.
    pub(crate) fn new(net: &Dispatchable, lead: impl Fn(u32) -> Duration) -> Agenda {
        let count = net.nodes as usize;
        let node = |node| NodeState {
            executed: None,
            taken: false,
            lead: lead(node),
            lower: Time::ZERO,
            hold: Hold::Nothing,
            upper: Time::MAX,
            held_by: 0,
        };
        let mut nodes: Vec<NodeState> = (0..net.nodes).map(node).collect();
        for edge in net.edges.iter().filter(|edge| net.holds(edge)) {
            nodes[edge.from as usize].held_by += 1;
        }
        for wait in &net.waits {
            nodes[wait.waiter as usize].held_by += 1;
        }
        // What follows at no distance is held like what follows at one.
        let follows = net.follows.iter().map(|&(from, to)| Edge { from, to, weight: 0 });
        let edges: Vec<Edge> = net.edges.iter().copied().chain(follows).collect();
        for &(later, _) in &net.follows {
            nodes[later as usize].held_by += 1;
        }
        let mut ending = vec![NONE; count];
        for (index, link) in net.links.iter().enumerate() {
            ending[link.contingent as usize] = index as u32;
        }
        let mut agenda = Agenda {
            outgoing: Rows::new(net.nodes, edges.iter().map(|edge| edge.from)),
            incoming: Rows::new(net.nodes, edges.iter().map(|edge| edge.to)),
            holds: net
                .edges
                .iter()
                .map(|edge| net.holds(edge))
                .chain(net.follows.iter().map(|_| true))
                .collect(),
            edges,
            ordinary: net.edges.len(),
            starting: Rows::new(net.nodes, net.links.iter().map(|link| link.activation)),
            waits_for: Rows::new(net.links.len() as u32, net.waits.iter().map(|wait| wait.link)),
            waits_of: Rows::new(net.nodes, net.waits.iter().map(|wait| wait.waiter)),
            waits: net
                .waits
                .iter()
                .map(|&Wait { waiter, link, weight }| {
                    let distance = -Duration::from_micros(weight);
                    ActiveWait { waiter, link, distance, until: None }
                })
                .collect(),
            ending,
            nodes,
            ready: BinaryHeap::new(),
        };
        for node in 1..net.nodes {
            agenda.offer(node);
        }
        agenda.execute(0, Time::ZERO);
        agenda
    }

    /// When a node was executed.
    pub(crate) fn executed(&self, node: u32) -> Option<Time> {
        self.nodes[node as usize].executed
    }

    /// The latest time at which a node may be executed, as far as its neighbours say.
    pub(crate) fn upper(&self, node: u32) -> Time {
        self.nodes[node as usize].upper
    }

    /// The executable node to take in hand next and when that is: the earliest there is.
    pub(crate) fn next(&mut self) -> Option<(Time, u32)> {
        while let Some(&Reverse((time, node))) = self.ready.peek() {
            if self.action(node) == Some(time) {
                return Some((time, node));
            }
            self.ready.pop();
        }
        None
    }

    /// When a node that nothing holds back is due.
    pub(crate) fn due(&self, node: u32) -> Time {
        self.earliest(node).unwrap_or(Time::MAX)
    }

    /// What the time at which a node is due comes of.
    pub(crate) fn hold(&self, node: u32) -> Hold {
        let NodeState { lower, hold, .. } = self.nodes[node as usize];
        let waits = self.waits_of.of(node).iter().map(|&wait| &self.waits[wait as usize]);
        let longest = waits.filter(|wait| wait.until > Some(lower)).max_by_key(|wait| wait.until);
        longest.map_or(hold, |wait| Hold::Wait { link: wait.link, distance: wait.distance })
    }

    /// The link that ends at a node, if one does.
    pub(crate) fn ending(&self, node: u32) -> Option<u32> {
        Some(self.ending[node as usize]).filter(|&link| link != NONE)
    }

    /// Somebody has a node in hand: it is not offered again, and executed when that is known.
    pub(crate) fn take(&mut self, node: u32) {
        self.nodes[node as usize].taken = true;
    }

    /// Executes a node, or says that a contingent node has happened. Returns the links this starts.
    pub(crate) fn execute(&mut self, node: u32, time: Time) -> Vec<u32> {
        // Between calls `lower` and `upper` are the tightest that executed neighbours say, and `held_by` counts what must
        // come first and has not. Neighbours are enough, as the network is dispatchable (Muscettola 1998): a bound from
        // afar has come to a neighbour by then. The edges passed over say nothing: an incoming one of weight >= 0 bounds
        // from below by the past; the target of an outgoing negative one has been executed, for it held us.
        self.nodes[node as usize].executed = Some(time);
        for at in 0..self.outgoing.of(node).len() {
            let Edge { to, weight, .. } = self.edges[self.outgoing.of(node)[at] as usize];
            if weight >= 0 {
                let upper = &mut self.nodes[to as usize].upper;
                *upper = (*upper).min(time.saturating_add(Duration::from_micros(weight)));
            }
        }
        for at in 0..self.incoming.of(node).len() {
            let edge = self.incoming.of(node)[at];
            let Edge { from, weight, .. } = self.edges[edge as usize];
            if self.holds[edge as usize] {
                let distance = -Duration::from_micros(weight);
                let hold = match (edge as usize) < self.ordinary {
                    true => Hold::After { node, distance },
                    false => Hold::Order { node },
                };
                let state = &mut self.nodes[from as usize];
                state.wait_until(time.saturating_add(distance), hold);
                state.held_by -= 1;
                self.offer(from);
            }
        }
        let started = self.starting.of(node).to_vec();
        for &link in &started {
            for at in 0..self.waits_for.of(link).len() {
                let wait = &mut self.waits[self.waits_for.of(link)[at] as usize];
                wait.until = Some(time.saturating_add(wait.distance));
                let waiter = wait.waiter;
                self.nodes[waiter as usize].held_by -= 1;
                self.offer(waiter);
            }
        }
        let link = self.ending[node as usize];
        if link != NONE {
            for at in 0..self.waits_for.of(link).len() {
                let wait = &mut self.waits[self.waits_for.of(link)[at] as usize];
                wait.until = None;
                let waiter = wait.waiter;
                // It may go ahead now, not earlier.
                self.nodes[waiter as usize].wait_until(time, Hold::After { node, distance: Duration::ZERO });
                self.offer(waiter);
            }
        }
        started
    }

    /// The earliest time for a node nothing holds back, else `None`.
    fn earliest(&self, node: u32) -> Option<Time> {
        let state = &self.nodes[node as usize];
        if state.held_by > 0 || state.executed.is_some() {
            return None;
        }
        let waits = self.waits_of.of(node).iter().filter_map(|&wait| self.waits[wait as usize].until);
        Some(waits.fold(state.lower, Time::max))
    }

    /// When to take a node in hand.
    fn action(&self, node: u32) -> Option<Time> {
        let state = &self.nodes[node as usize];
        if state.taken { None } else { self.earliest(node).map(|time| time.saturating_sub(state.lead)) }
    }

    fn offer(&mut self, node: u32) {
        if self.ending[node as usize] == NONE
            && let Some(time) = self.action(node)
        {
            self.ready.push(Reverse((time, node)));
        }
    }
}
