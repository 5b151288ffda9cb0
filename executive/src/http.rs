//! News over HTTP: a small server on a thread of its own, so that no flood and no slow client delays the loop or the drivers.
//!
//! | module | is about |
//! | --- | --- |
//! | `access` | who may speak to us: the address, the token, the web pages that may not |
//! | `connections` | who is connected, and who makes room when too many are |
//! | `routes` | a request in, a response out |
//! | `news` | the body of a message |
//! | `explained` | what hyper refuses by itself, with a reason |
//! | `front` | what is asked of the loop, and how long we wait for it |
//! | `events` | the stream of happenings |

mod access;
mod connections;
mod events;
mod explained;
mod front;
mod observations;
mod routes;
#[cfg(test)]
mod tests;

use std::cell::Cell;
use std::convert::Infallible;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::rc::Rc;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::TokioIo;
use tokio::io::AsyncReadExt;
use tokio::net::TcpStream;
use tokio::sync::{Semaphore, watch};
use tokio::task::{LocalSet, spawn_local, yield_now};
use tokio::time::{sleep, timeout};

use self::access::Access;
pub(crate) use self::access::{listen, read_token};
use self::connections::{Connection, Connections};
use self::explained::Explained;
use self::front::Front;
pub use self::observations::read as read_observations;
use crate::desk::Desk;

/// A server that runs.
pub(crate) struct Server {
    address: SocketAddr,
    stopping: watch::Sender<bool>,
    thread: Option<JoinHandle<()>>,
}

/// How a server is to be.
#[derive(Clone, Default)]
pub(crate) struct ServerOptions {
    /// What everybody must show, if anything.
    pub(crate) token: Option<Vec<u8>>,
}

/// What the server puts up with.
#[derive(Clone, Copy, Debug)]
struct Limits {
    /// Connections at a time. Beyond, whoever keeps us waiting longest makes room.
    connections: usize,
    /// Of these, streams of happenings.
    streams: usize,
    /// Questions and news in the loop's inbox at a time; the rest of it is for the drivers.
    questions: usize,
    /// For a client to send the head of its next request, or to take our response.
    patience: Duration,
    /// For a client to send a body.
    body: Duration,
    /// For the loop to answer.
    answer: Duration,
    /// How old an answer of the loop about the state may get.
    fresh: Duration,
    /// Between signs of life in a stream.
    keep_alive: Duration,
    /// For a listener to take anything from a stream.
    stalled: Duration,
    /// For a client to hang up, after a response that ends the connection.
    linger: Duration,
    /// For everybody to be done when the server stops.
    grace: Duration,
}

const LIMITS: Limits = Limits {
    connections: 256,
    streams: 64,
    questions: 1024,
    patience: Duration::from_secs(60),
    body: Duration::from_secs(10),
    answer: Duration::from_secs(5),
    fresh: Duration::from_millis(200),
    keep_alive: Duration::from_secs(15),
    stalled: Duration::from_secs(60),
    linger: Duration::from_secs(1),
    grace: Duration::from_millis(500),
};

/// Bytes in the body of a request.
const BODY: usize = 64 * 1024;

/// Bytes and lines in the head of a request.
const HEAD: usize = 16 * 1024;
const HEADERS: usize = 64;

impl Server {
    /// Serves on `listener` from now on. A listener that others than this machine can reach demands a token.
    pub(crate) fn start(listener: TcpListener, options: ServerOptions, desk: Desk) -> io::Result<Server> {
        Server::with_limits(listener, options, desk, LIMITS)
    }

    fn with_limits(
        listener: TcpListener,
        options: ServerOptions,
        desk: Desk,
        limits: Limits,
    ) -> io::Result<Server> {
        let address = listener.local_addr()?;
        let access = Access::new(address, options.token)?;
        listener.set_nonblocking(true)?;
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().enable_time().build()?;
        let listener = {
            let _inside = runtime.enter();
            tokio::net::TcpListener::from_std(listener)?
        };
        let (stopping, stop) = watch::channel(false);
        let thread = std::thread::Builder::new().name("http".to_string()).spawn(move || {
            let house = Rc::new(House {
                access,
                front: Front::new(desk, limits),
                streams: Arc::new(Semaphore::new(limits.streams)),
                limits,
                stop,
            });
            // Whatever is still open when `serve` returns is closed with the tasks.
            LocalSet::new().block_on(&runtime, serve(listener, house));
        })?;
        Ok(Server { address, stopping, thread: Some(thread) })
    }

    /// Where it listens.
    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }

    /// Ends the server: requests under way are answered, streams get what has happened and end, and who is not done
    /// within half a second is cut off. The same happens when it is dropped.
    pub(crate) fn stop(self) {}
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stopping.send_replace(true);
        if let Some(thread) = self.thread.take() {
            // A panic there is not worth one here.
            let _ = thread.join();
        }
    }
}

/// What all connections share.
struct House {
    access: Access,
    front: Front,
    streams: Arc<Semaphore>,
    limits: Limits,
    stop: watch::Receiver<bool>,
}

impl House {
    /// Returns when the server is to stop.
    async fn stopped(&self) {
        // An error says that the `Server` is gone, which means the same.
        let _ = self.stop.clone().wait_for(|stop| *stop).await;
    }
}

async fn serve(listener: tokio::net::TcpListener, house: Rc<House>) {
    let connections = Connections::new(house.limits.connections);
    let accept = async {
        loop {
            match listener.accept().await {
                Ok((stream, _)) => {
                    let connection = connections.admit().await;
                    spawn_local(serve_connection(stream, connection, house.clone()));
                    // Whoever was there first shall be read first: a burst of connections must not push each other out unread.
                    yield_now().await;
                }
                // The client is gone already, or there are no file descriptors left.
                Err(_) => sleep(Duration::from_millis(20)).await,
            }
        }
    };
    tokio::select! {
        () = accept => {}
        () = house.stopped() => {}
    }
    drop(listener);
    let _ = timeout(house.limits.grace, connections.all_gone()).await;
}

async fn serve_connection(mut stream: TcpStream, connection: Rc<Connection>, house: Rc<House>) {
    let _ = stream.set_nodelay(true);
    let answer = service_fn(|request| {
        let (house, connection) = (house.clone(), connection.clone());
        async move { Ok::<_, Infallible>(routes::answer(house, connection, request).await) }
    });
    let stopping = Cell::new(false);
    let talk = async {
        // No timer: `Connection::overdue` is about heads, idle connections and responses nobody takes.
        let talk = http1::Builder::new()
            .half_close(true)
            .max_headers(HEADERS)
            .max_buf_size(HEAD)
            .serve_connection(TokioIo::new(Explained::new(&mut stream)), answer);
        let mut talk = std::pin::pin!(talk);
        tokio::select! {
            _ = &mut talk => return,
            () = house.stopped() => {}
        }
        stopping.set(true);
        talk.as_mut().graceful_shutdown();
        let _ = talk.await;
    };
    tokio::select! {
        // First: who is cut off must not be heard any more, having no way to learn what came of it.
        biased;
        () = connection.cut() => return,
        () = talk => {}
        () = connection.overdue(house.limits.patience) => return,
    }
    if stopping.get() {
        return;
    }
    // A socket that is closed with something unread in it takes the response back that says why. So read on for a moment.
    let mut waste = [0; 4096];
    let drain = async { while let Ok(1..) = stream.read(&mut waste).await {} };
    tokio::select! {
        _ = timeout(house.limits.linger, drain) => {}
        () = connection.cut() => {}
        () = house.stopped() => {}
    }
}
