//! Who is let in, and who is not.

use std::fs::Permissions;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;

use super::super::{listen, read_token};
use super::*;

const TOKEN: &str = "0123456789abcdef";

#[test]
fn other_machines_are_listened_to_only_with_a_token() {
    for bind in ["0.0.0.0", "::", "192.0.2.1", "::ffff:192.0.2.1"] {
        let refused = listen(bind, 0, false).unwrap_err();
        assert!(refused.starts_with(&format!("`--bind {bind}` demands `--token-file FILE`")), "{refused}");
    }
    for bind in ["127.0.0.1", "127.0.0.2", "localhost", "LOCALHOST"] {
        assert!(listen(bind, 0, false).unwrap().local_addr().unwrap().ip().is_loopback());
    }
    let open = listen("0.0.0.0", 0, true).unwrap();
    // Nor does a server start there without one.
    let (desk, _messages) = Desk::new(&network(), Clock::starting(Time::ZERO, kirk_runtime::Speed::REAL));
    let refused = Server::start(open, ServerOptions { token: None }, desk).err().unwrap();
    assert!(refused.to_string().contains("demands a token"), "{refused}");
}

#[test]
fn what_cannot_be_listened_to_is_said() {
    for bind in ["", "rover", "localhost:80", "127.0.0.1:80", "1.2.3"] {
        let refused = listen(bind, 0, true).unwrap_err();
        assert!(refused.contains("is not an address of this machine such as 127.0.0.1"), "{refused}");
    }
    let first = listen("127.0.0.1", 0, false).unwrap();
    let refused = listen("127.0.0.1", first.local_addr().unwrap().port(), false).unwrap_err();
    assert!(
        refused.ends_with("somebody does already. Each executive needs a `--port` of its own"),
        "{refused}"
    );
    assert!(listen("192.0.2.1", 0, true).unwrap_err().starts_with("cannot listen on 192.0.2.1:0: "));
}

#[test]
fn a_token_is_read_without_the_space_around_it_if_it_is_any_good() {
    let folder = tempfile::tempdir().unwrap();
    let read = |bytes: &[u8]| {
        let path = folder.path().join("token");
        std::fs::write(&path, bytes).unwrap();
        std::fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        read_token(&path)
    };
    assert_eq!(read(b" 0123456789abcdef\r\n"), Ok(TOKEN.as_bytes().to_vec()));
    assert!(
        read(b"0123456789abcde\n").unwrap_err().contains("has 15 bytes, which can be guessed; it takes 16")
    );
    assert!(read(b" \n").unwrap_err().contains("has 0 bytes"));
    assert!(read(b"0123456789 abcdef").unwrap_err().contains("has a byte 0x20 in it"));
    assert!(read(b"0123456789abcdef\0").unwrap_err().contains("has a byte 0x00 in it"));
    assert!(read(&[b'x'; 5000]).unwrap_err().contains("is longer than 4096 bytes"));
    assert!(read(&[b'x'; 4096]).is_ok());
    assert!(
        read_token(&PathBuf::from("no/such/file"))
            .unwrap_err()
            .starts_with("cannot read the token in no/such/file")
    );
    assert!(read_token(folder.path()).unwrap_err().starts_with("cannot read the token in "));
    // One that everybody may read, or write.
    for mode in [0o644, 0o602] {
        let path = folder.path().join("open");
        std::fs::write(&path, TOKEN).unwrap();
        std::fs::set_permissions(&path, Permissions::from_mode(mode)).unwrap();
        let refused = read_token(&path).unwrap_err();
        assert!(refused.contains(&format!("(mode {mode:o})")) && refused.contains("chmod 600"), "{refused}");
    }
    // One that never ends.
    assert!(read_token(&PathBuf::from("/dev/zero")).is_err());
}

#[test]
fn with_a_token_only_who_shows_it_is_let_in() {
    let rig = Rig::with(LIMITS, Loop::Answers, Some(TOKEN));
    let ask = |what: &str, shown: &str| {
        rig.client().ask(&format!("{what} HTTP/1.1\r\nHost: rover.example\r\n{shown}\r\n"))
    };
    for shown in
        ["Authorization: Bearer 0123456789abcdef\r\n", "authorization: bearer  0123456789abcdef \r\n"]
    {
        assert_eq!(ask("GET /state", shown).status, 200, "{shown}");
    }
    for (shown, part) in [
        ("", "needs the header `Authorization: Bearer TOKEN`"),
        ("Authorization: Bearer 0123456789abcdeF\r\n", "not the token"),
        ("Authorization: Bearer 0123456789abcde\r\n", "not the token"),
        ("Authorization: Bearer 0123456789abcdef0\r\n", "not the token"),
        ("Authorization: Bearer \r\n", "should be `Bearer TOKEN`"),
        ("Authorization: Basic 0123456789abcdef\r\n", "should be `Bearer TOKEN`"),
        ("Authorization: 0123456789abcdef\r\n", "should be `Bearer TOKEN`"),
        ("Authorization: Bearer 0123456789abcdef\r\nAuthorization: Bearer x\r\n", "needs the header"),
    ] {
        // Nor are others told what there is.
        for what in ["GET /state", "GET /events", "POST /", "GET /nothing"] {
            let answer = ask(what, shown);
            assert_eq!(answer.status, 401, "{what} {shown}");
            assert!(answer.head.contains("www-authenticate: bearer realm=\"kirk\"\r\n"), "{}", answer.head);
            assert!(answer.body.contains(part), "{what} {shown}: {}", answer.body);
        }
    }
    assert_eq!(ask("GET /healthz", "").status, 200);
    assert!(rig.seen.lock().unwrap().news.is_empty());
}

#[test]
fn web_pages_of_others_are_refused() {
    let rig = Rig::new();
    let ask = |headers: &str| {
        let body = r#"{"event-ids": ["scan:end"]}"#;
        rig.client().ask(&format!("POST / HTTP/1.1\r\n{headers}Content-Length: 27\r\n\r\n{body}"))
    };
    let port = rig.address.port();
    for headers in [
        "Host: localhost\r\nOrigin: https://evil.example\r\n",
        "Host: localhost\r\nOrigin: null\r\n",
        "Host: localhost\r\nOrigin: localhost\r\n",
        "Host: localhost\r\nOrigin: http://localhost:1\r\n",
        "Host: localhost\r\nOrigin: http://localhost\r\nOrigin: http://evil.example\r\n",
        "Host: localhost\r\nOrigin: http://localhost@evil.example\r\n",
        "Origin: http://localhost\r\n",
        "Host: localhost\r\nSec-Fetch-Site: cross-site\r\n",
    ] {
        let answer = ask(headers);
        assert_eq!(answer.status, 403, "{headers}");
        assert!(answer.body.contains("have no business here"), "{headers}: {}", answer.body);
    }
    // The name of a page may be made to mean this machine; then page and server are of one site.
    for headers in [
        "Host: evil.example\r\nOrigin: http://evil.example\r\n",
        "Host: evil.example\r\n",
        "Host: 127.0.0.1.evil.example\r\n",
        "Host: localhost@evil.example\r\n",
        "Host: 192.0.2.1\r\n",
        "Host: localhost\r\nHost: evil.example\r\n",
        "Host: \r\n",
        "Host: \u{e4}\r\n",
    ] {
        let answer = ask(headers);
        assert_eq!(answer.status, 403, "{headers}");
        assert!(
            answer.body.contains("answers only to 127.0.0.1, [::1] and localhost"),
            "{headers}: {}",
            answer.body
        );
    }
    let answer = rig.client().ask("GET http://evil.example/state HTTP/1.1\r\nHost: localhost\r\n\r\n");
    assert_eq!(answer.status, 403);
    assert!(rig.seen.lock().unwrap().news.is_empty());

    for headers in [
        String::new(),
        format!("Host: localhost:{port}\r\nOrigin: http://LOCALHOST:{port}\r\n"),
        format!(
            "Host: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nSec-Fetch-Site: same-origin\r\n"
        ),
        "Host: [::1]:9\r\n".to_string(),
        "Host: 127.1.2.3\r\nSec-Fetch-Site: none\r\n".to_string(),
    ] {
        assert_eq!(ask(&headers).status, 200, "{headers}");
    }
}
