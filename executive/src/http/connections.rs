//! Who is connected. Their number is limited; when it is reached, whoever keeps us waiting longest makes room for the next,
//! so that clients who open connections and say nothing shut nobody out.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;
use std::time::Duration;

use tokio::sync::Notify;
use tokio::time::{Instant, sleep_until};

/// All connections.
pub(super) struct Connections {
    limit: usize,
    open: Rc<Open>,
}

#[derive(Default)]
struct Open {
    next: Cell<u64>,
    connections: RefCell<BTreeMap<u64, Rc<State>>>,
    /// Somebody left, or waits no more for us.
    changed: Notify,
}

/// One connection, which counts until this is dropped.
pub(super) struct Connection {
    number: u64,
    state: Rc<State>,
    open: Rc<Open>,
}

struct State {
    /// Since when we wait for the client; `None` while the client waits for us.
    waiting: Cell<Option<Instant>>,
    cut: Notify,
}

/// While this lives it is the client who waits for us.
pub(super) struct Busy {
    state: Rc<State>,
    open: Rc<Open>,
}

impl Connections {
    pub(super) fn new(limit: usize) -> Connections {
        Connections { limit, open: Rc::default() }
    }

    /// One more, as soon as there is room.
    pub(super) async fn admit(&self) -> Rc<Connection> {
        while self.open.connections.borrow().len() >= self.limit {
            if !self.open.cut_one() {
                // All of them wait for us. Not for long, unless they are streams, which are fewer.
                self.open.changed.notified().await;
            }
        }
        let state = Rc::new(State { waiting: Cell::new(Some(Instant::now())), cut: Notify::new() });
        let number = self.open.next.get();
        self.open.next.set(number + 1);
        self.open.connections.borrow_mut().insert(number, state.clone());
        Rc::new(Connection { number, state, open: self.open.clone() })
    }

    /// Returns when nobody is connected.
    pub(super) async fn all_gone(&self) {
        while !self.open.connections.borrow().is_empty() {
            self.open.changed.notified().await;
        }
    }
}

impl Open {
    /// Cuts off who keeps us waiting longest, if anybody does.
    fn cut_one(&self) -> bool {
        let mut connections = self.connections.borrow_mut();
        let waiting = connections.iter().filter_map(|(number, state)| Some((state.waiting.get()?, *number)));
        let Some((_, number)) = waiting.min() else { return false };
        if let Some(state) = connections.remove(&number) {
            state.cut.notify_one();
        }
        true
    }
}

impl Connection {
    /// The client has sent something whole; its time begins anew.
    pub(super) fn heard(&self) {
        self.state.waiting.set(Some(Instant::now()));
    }

    /// Now the client waits for us, until what this returns is dropped.
    pub(super) fn busy(&self) -> Busy {
        self.state.waiting.set(None);
        Busy { state: self.state.clone(), open: self.open.clone() }
    }

    /// Returns when somebody else needs the room.
    pub(super) async fn cut(&self) {
        self.state.cut.notified().await;
    }

    /// Returns when the client has kept us waiting for longer than `patience`.
    pub(super) async fn overdue(&self, patience: Duration) {
        loop {
            let now = Instant::now();
            let deadline = self.state.waiting.get().unwrap_or(now) + patience;
            if deadline <= now {
                return;
            }
            sleep_until(deadline).await;
        }
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.open.connections.borrow_mut().remove(&self.number);
        self.open.changed.notify_one();
    }
}

impl Drop for Busy {
    fn drop(&mut self) {
        self.state.waiting.set(Some(Instant::now()));
        self.open.changed.notify_one();
    }
}
