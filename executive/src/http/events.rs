//! The stream of happenings (server-sent events): the state first, then everything that happens, as it happens.

use std::convert::Infallible;
use std::pin::Pin;
use std::rc::Rc;
use std::sync::Arc;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame};
use tokio::sync::broadcast::Receiver;
use tokio::sync::broadcast::error::{RecvError, TryRecvError};
use tokio::sync::mpsc;
use tokio::task::spawn_local;
use tokio::time::{sleep, timeout};

use super::House;
use super::connections::Busy;
use super::front::Silence;
use crate::happening::Happening;

/// The body of a response that goes on as long as the mission.
pub(super) struct Stream {
    events: mpsc::Receiver<Bytes>,
}

/// How many events may wait to be written. The rest waits in the listener's place at the desk, which is bounded.
const UNWRITTEN: usize = 16;

impl Stream {
    /// A stream that begins now; its client waits for us until all is told.
    pub(super) async fn start(house: Rc<House>, busy: Busy) -> Result<Stream, Silence> {
        let place = house.streams.clone().try_acquire_owned().map_err(|_| Silence::Flooded)?;
        // Before the state is asked for: what happens meanwhile shall be told twice rather than never.
        let happenings = house.front.desk.listen();
        let state = house.front.state().await?;
        let (out, events) = mpsc::channel(UNWRITTEN);
        spawn_local(async move {
            // The listener left, took nothing for too long, or was told everything.
            let _ = tell(&house, happenings, &out, &state).await;
            drop((place, busy));
        });
        Ok(Stream { events })
    }
}

impl Body for Stream {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        self.events.poll_recv(context).map(|event| event.map(|event| Ok(Frame::data(event))))
    }
}

/// The listener is not there any more.
struct Gone;

async fn tell(
    house: &House,
    mut happenings: Receiver<Arc<Happening>>,
    out: &mpsc::Sender<Bytes>,
    state: &[u8],
) -> Result<(), Gone> {
    let send = async |event: Bytes| match timeout(house.limits.stalled, out.send(event)).await {
        Ok(Ok(())) => Ok(()),
        _ => Err(Gone),
    };
    send(event("state", state.trim_ascii_end())).await?;
    loop {
        let next = tokio::select! {
            happening = happenings.recv() => match happening {
                Ok(happening) => told(&happening),
                Err(RecvError::Lagged(count)) => missed(count),
                Err(RecvError::Closed) => return Ok(()),
            },
            () = sleep(house.limits.keep_alive) => Bytes::from_static(b": still here\n\n"),
            () = out.closed() => return Err(Gone),
            () = house.stopped() => break,
        };
        send(next).await?;
    }
    loop {
        match happenings.try_recv() {
            Ok(happening) => send(told(&happening)).await?,
            Err(TryRecvError::Lagged(count)) => send(missed(count)).await?,
            Err(TryRecvError::Empty | TryRecvError::Closed) => return Ok(()),
        }
    }
}

fn told(happening: &Happening) -> Bytes {
    // There is nothing in a happening that JSON could not say.
    let data = serde_json::to_vec(happening).unwrap_or_default();
    event(kind(happening), &data)
}

fn missed(count: u64) -> Bytes {
    event("missed", format!(r#"{{"kind":"missed","count":{count}}}"#).as_bytes())
}

/// `data` is one line.
fn event(kind: &str, data: &[u8]) -> Bytes {
    [b"event: ", kind.as_bytes(), b"\ndata: ", data, b"\n\n"].concat().into()
}

/// As in its JSON.
fn kind(happening: &Happening) -> &'static str {
    match happening {
        Happening::Sent { .. } => "sent",
        Happening::Fixed { .. } => "fixed",
        Happening::Failed { .. } => "failed",
        Happening::Warning { .. } => "warning",
        Happening::Note { .. } => "note",
        Happening::Ignored { .. } => "ignored",
        Happening::Over { .. } => "over",
    }
}
