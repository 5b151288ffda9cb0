//! placeholder until the http branch is merged
use crate::desk::Desk;
use std::{io, net::*, path::Path};
pub struct Server(SocketAddr);
pub struct ServerOptions {
    pub token: Option<Vec<u8>>,
}
impl Server {
    pub fn start(l: TcpListener, _o: ServerOptions, _d: Desk) -> io::Result<Server> {
        Ok(Server(l.local_addr()?))
    }
    pub fn stop(self) {}
    pub fn address(&self) -> SocketAddr {
        self.0
    }
}
pub fn listen(b: &str, p: u16, _t: bool) -> Result<TcpListener, String> {
    TcpListener::bind((b, p)).map_err(|e| e.to_string())
}
pub fn read_token(p: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(p).map_err(|e| e.to_string())
}
