//! Who may speak to us. Other machines only with a token; web pages of others never, for a browser sends whatever a page
//! likes to addresses only this machine can reach.

use std::fs::File;
use std::io::{self, Read};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, TcpListener};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use hyper::header::{AUTHORIZATION, HOST, ORIGIN};
use hyper::http::request::Parts;
use hyper::http::uri::{Authority, Uri};
use subtle::ConstantTimeEq;

/// Listens on `port` of `bind`, an address of this machine. Anything but a loopback address demands a token.
pub(crate) fn listen(bind: &str, port: u16, token_given: bool) -> Result<TcpListener, String> {
    let address =
        if bind.eq_ignore_ascii_case("localhost") { Ok(Ipv4Addr::LOCALHOST.into()) } else { bind.parse() };
    let address: IpAddr = address.map_err(|_| {
        format!("`--bind {bind}` is not an address of this machine such as 127.0.0.1, ::1 or 0.0.0.0 (all of them)")
    })?;
    if !is_loopback(address) && !token_given {
        return Err(format!(
            "`--bind {bind}` demands `--token-file FILE`: other machines can reach that address, and whoever does could report news"
        ));
    }
    let address = SocketAddr::new(address, port);
    TcpListener::bind(address).map_err(|error| match error.kind() {
        io::ErrorKind::AddrInUse => {
            format!("cannot listen on {address}: somebody does already. Each executive needs a `--port` of its own")
        }
        io::ErrorKind::PermissionDenied => {
            format!("cannot listen on {address}: not permitted. Ports below 1024 often are not; choose another `--port`")
        }
        _ => format!("cannot listen on {address}: {error}"),
    })
}

/// The shortest token that is not easily guessed.
const SHORTEST: usize = 16;
/// A longer one would not fit into the head of a request.
const LONGEST: usize = 4096;

/// The token in a file, without the white space around it.
pub(crate) fn read_token(path: &Path) -> Result<Vec<u8>, String> {
    let file = path.display();
    let mut text = Vec::new();
    let cannot = |error: io::Error| format!("cannot read the token in {file}: {error}");
    let open = File::open(path).map_err(cannot)?;
    let metadata = open.metadata().map_err(cannot)?;
    let mode = metadata.permissions().mode() & 0o777;
    // A pipe is only for whoever made it, whatever its mode says.
    if metadata.is_file() && mode & 0o007 != 0 {
        return Err(format!(
            "the token in {file} is open to everybody on this machine (mode {mode:o}), so it keeps no secret: `chmod 600 {file}`"
        ));
    }
    open.take(LONGEST as u64 + 2).read_to_end(&mut text).map_err(cannot)?;
    let token = text.trim_ascii();
    if token.len() < SHORTEST {
        let length = token.len();
        return Err(format!(
            "the token in {file} has {length} bytes, which can be guessed; it takes {SHORTEST}. `openssl rand -hex 32` makes a good one"
        ));
    }
    if token.len() > LONGEST {
        return Err(format!("the token in {file} is longer than {LONGEST} bytes"));
    }
    if let Some(byte) = token.iter().find(|byte| !byte.is_ascii_graphic()) {
        return Err(format!(
            "the token in {file} has a byte 0x{byte:02x} in it, which no client can send: letters, digits and signs only"
        ));
    }
    Ok(token.to_vec())
}

fn is_loopback(address: IpAddr) -> bool {
    address.to_canonical().is_loopback()
}

/// What a request must show.
pub(super) struct Access {
    token: Option<Vec<u8>>,
}

impl Access {
    /// An error if others could reach `address` without a token.
    pub(super) fn new(address: SocketAddr, token: Option<Vec<u8>>) -> io::Result<Access> {
        if token.is_none() && !is_loopback(address.ip()) {
            let error = format!("others can reach {address}, which demands a token");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, error));
        }
        Ok(Access { token })
    }

    /// The token is there and right.
    pub(super) fn token(&self, request: &Parts) -> Result<(), &'static str> {
        let Some(token) = &self.token else { return Ok(()) };
        let mut given = request.headers.get_all(AUTHORIZATION).iter();
        let (Some(given), None) = (given.next(), given.next()) else {
            return Err(
                "this needs the header `Authorization: Bearer TOKEN`, the token being what is in the `--token-file`",
            );
        };
        match given.as_bytes().split_at_checked("bearer ".len()) {
            // Takes the same time wherever the first difference is.
            Some((scheme, shown)) if scheme.eq_ignore_ascii_case(b"bearer ") => {
                if shown.trim_ascii().ct_eq(token).into() {
                    Ok(())
                } else {
                    Err("that is not the token in the `--token-file`")
                }
            }
            _ => Err("the header `Authorization` should be `Bearer TOKEN`"),
        }
    }

    /// The request does not come from a web page of others.
    pub(super) fn site(&self, request: &Parts) -> Result<(), String> {
        let mut hosts: Vec<&[u8]> =
            request.headers.get_all(HOST).iter().map(|host| host.as_bytes()).collect();
        hosts.extend(request.uri.authority().map(|host| host.as_str().as_bytes()));
        // A page whose name was made to mean this machine is of the same site as we are, as the browser sees it, but calls
        // us by that name. A token it has not.
        if self.token.is_none()
            && let Some(host) = hosts.iter().find(|host| !names_this_machine(host))
        {
            let host = String::from_utf8_lossy(host);
            return Err(format!(
                "without a token kirk answers only to 127.0.0.1, [::1] and localhost, not to `{host}`: use one of these in the URL, or give `--token-file`"
            ));
        }
        for origin in request.headers.get_all(ORIGIN) {
            if !hosts.iter().all(|host| same_site(origin.as_bytes(), host)) || hosts.is_empty() {
                let origin = String::from_utf8_lossy(origin.as_bytes());
                return Err(format!("web pages of `{origin}` have no business here (header `Origin`)"));
            }
        }
        if request.headers.get("sec-fetch-site").is_some_and(|site| site == "cross-site") {
            return Err("web pages of others have no business here (header `Sec-Fetch-Site`)".to_string());
        }
        Ok(())
    }
}

fn names_this_machine(host: &[u8]) -> bool {
    let Ok(authority) = Authority::try_from(host) else { return false };
    let name = authority.host();
    let address = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    name.eq_ignore_ascii_case("localhost") || address.parse().is_ok_and(is_loopback)
}

/// `http://localhost:8000` is the site of the host `localhost:8000`.
fn same_site(origin: &[u8], host: &[u8]) -> bool {
    let origin = Uri::try_from(origin).ok();
    let origin = origin.as_ref().filter(|origin| origin.scheme().is_some()).and_then(Uri::authority);
    origin.is_some_and(|origin| origin.as_str().as_bytes().eq_ignore_ascii_case(host))
}
