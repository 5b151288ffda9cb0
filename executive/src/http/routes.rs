//! A request in, a response out.

use std::rc::Rc;

use http_body_util::{BodyExt, Either, Full, LengthLimitError, Limited};
use hyper::body::{Body, Bytes, Incoming};
use hyper::header::{
    ALLOW, CACHE_CONTROL, CONTENT_TYPE, HeaderName, HeaderValue, RETRY_AFTER, WWW_AUTHENTICATE,
};
use hyper::{Method, Request, Response, StatusCode};
use serde_json::json;
use tokio::time::timeout;

use super::connections::Connection;
use super::events::Stream;
use super::front::Silence;
use super::{BODY, House, observations};

type Content = Either<Full<Bytes>, Stream>;

/// What there is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Route {
    Observations,
    State,
    Events,
    Health,
}

/// Why a request is not done.
struct Refusal {
    status: StatusCode,
    error: String,
    header: Option<(HeaderName, &'static str)>,
}

/// Never fails: what cannot be done is said in the response.
pub(super) async fn answer(
    house: Rc<House>,
    connection: Rc<Connection>,
    request: Request<Incoming>,
) -> Response<Content> {
    connection.heard();
    respond(house, &connection, request).await.unwrap_or_else(|refusal| {
        let mut response = json(json!({ "error": refusal.error }).to_string() + "\n");
        *response.status_mut() = refusal.status;
        response
            .headers_mut()
            .extend(refusal.header.map(|(name, value)| (name, HeaderValue::from_static(value))));
        response
    })
}

async fn respond(
    house: Rc<House>,
    connection: &Connection,
    request: Request<Incoming>,
) -> Result<Response<Content>, Refusal> {
    let (head, body) = request.into_parts();
    house.access.site(&head).map_err(|error| refuse(StatusCode::FORBIDDEN, error))?;
    let route = Route::of(head.uri.path());
    if route != Some(Route::Health) {
        house.access.token(&head).map_err(|error| {
            refuse(StatusCode::UNAUTHORIZED, error).with(WWW_AUTHENTICATE, r#"Bearer realm="kirk""#)
        })?;
    }
    let route = route.ok_or_else(|| {
        let known = "what there is: POST / (news), GET /state, GET /events, GET /healthz";
        refuse(StatusCode::NOT_FOUND, format!("there is no `{}`; {known}", head.uri.path()))
    })?;
    if !route.methods().split(", ").any(|method| method == head.method.as_str()) {
        let error = format!("`{}` takes {}, not {}", head.uri.path(), route.methods(), head.method);
        return Err(refuse(StatusCode::METHOD_NOT_ALLOWED, error).with(ALLOW, route.methods()));
    }
    match route {
        Route::Observations => {
            let body = whole(body, &house).await?;
            let _busy = connection.busy();
            let names = observations::read(&body).map_err(|error| refuse(StatusCode::BAD_REQUEST, error))?;
            let answer = house.front.observe(names).await?;
            Ok(json(json!(answer).to_string() + "\n"))
        }
        Route::State => {
            let _busy = connection.busy();
            Ok(json(house.front.state().await?))
        }
        Route::Events => {
            let content = match head.method {
                Method::HEAD => Either::Left(Full::default()),
                _ => Either::Right(Stream::start(house, connection.busy()).await?),
            };
            Ok(response("text/event-stream", content))
        }
        Route::Health => Ok(response("text/plain", Either::Left("ok\n".into()))),
    }
}

impl Route {
    fn of(path: &str) -> Option<Route> {
        match path {
            "/" => Some(Route::Observations),
            "/state" => Some(Route::State),
            "/events" => Some(Route::Events),
            "/healthz" => Some(Route::Health),
            _ => None,
        }
    }

    /// As in the header `Allow`.
    fn methods(self) -> &'static str {
        match self {
            Route::Observations => "POST",
            Route::State | Route::Events | Route::Health => "GET, HEAD",
        }
    }
}

/// A body that comes in time and is not too long.
async fn whole(body: Incoming, house: &House) -> Result<Bytes, Refusal> {
    let too_long = || {
        let error = format!("a message may have {BODY} bytes; send the events in several");
        refuse(StatusCode::PAYLOAD_TOO_LARGE, error)
    };
    // If it says so beforehand nobody need send it.
    if body.size_hint().lower() > BODY as u64 {
        return Err(too_long());
    }
    match timeout(house.limits.body, Limited::new(body, BODY).collect()).await {
        Ok(Ok(body)) => Ok(body.to_bytes()),
        Ok(Err(error)) if error.is::<LengthLimitError>() => Err(too_long()),
        Ok(Err(error)) => {
            Err(refuse(StatusCode::BAD_REQUEST, format!("the body does not come through: {error}")))
        }
        Err(_) => {
            let limit = house.limits.body;
            Err(refuse(StatusCode::REQUEST_TIMEOUT, format!("the body did not come within {limit:?}")))
        }
    }
}

impl From<Silence> for Refusal {
    fn from(silence: Silence) -> Refusal {
        let error = match silence {
            Silence::Over => "the mission is over".to_string(),
            Silence::Late(limit) => {
                format!(
                    "the executive did not answer within {limit:?}; ask again, repeated news does no harm"
                )
            }
            Silence::Flooded => "too many ask at the same time; ask again".to_string(),
        };
        refuse(StatusCode::SERVICE_UNAVAILABLE, error).with(RETRY_AFTER, "1")
    }
}

fn refuse(status: StatusCode, error: impl Into<String>) -> Refusal {
    Refusal { status, error: error.into(), header: None }
}

impl Refusal {
    fn with(self, name: HeaderName, value: &'static str) -> Refusal {
        Refusal { header: Some((name, value)), ..self }
    }
}

fn json(text: impl Into<Bytes>) -> Response<Content> {
    response("application/json", Either::Left(Full::new(text.into())))
}

fn response(kind: &'static str, content: Content) -> Response<Content> {
    let mut response = Response::new(content);
    response.headers_mut().insert(CONTENT_TYPE, HeaderValue::from_static(kind));
    response.headers_mut().insert(CACHE_CONTROL, HeaderValue::from_static("no-store"));
    response
}
