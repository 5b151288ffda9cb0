//! News over HTTP to the real binary: four executives with a driver server between them, and a flood.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use serde_json::{Value, json};

/// An executive that runs, where it hears news, and what it says.
struct Running {
    child: Child,
    address: SocketAddr,
    said: Receiver<String>,
}

impl Running {
    fn start(arguments: &[&str]) -> Running {
        let mut child = Command::new(env!("CARGO_BIN_EXE_kirk"))
            .args(arguments)
            .args(["--port", "0", "--format", "json"])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let mut before = String::new();
        let address = loop {
            let line = lines.next().expect(&before).unwrap();
            if let Some(address) = line.strip_prefix("news is heard at http://") {
                break address.trim_end_matches('/').parse().unwrap();
            }
            before.push_str(&line);
        };
        let (sender, said) = channel();
        std::thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                let _ = sender.send(line);
            }
        });
        Running { child, address, said }
    }

    /// The execution, when the mission is over.
    fn end(mut self) -> Value {
        let mut text = String::new();
        self.child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
        let status = self.child.wait().unwrap();
        let said: Vec<String> = self.said.iter().collect();
        assert_eq!(status.code(), Some(0), "{text}\n{}", said.join("\n"));
        serde_json::from_str(&text).unwrap()
    }
}

#[test]
fn before_time_zero_nothing_has_happened_and_nothing_is_heard() {
    let arguments = ["run", "tests/live/field.rmpl", "--start-at", "+2s", "--speed", "20"];
    let running = Running::start(&arguments);
    let mut stream = BufReader::new(TcpStream::connect(running.address).unwrap());
    let (status, body) = ask(&mut stream, "GET /state", b"").unwrap();
    let state: Value = serde_json::from_str(&body).unwrap();
    assert_eq!((status, &state["outcome"], &state["rows"]), (200, &json!("running"), &json!([])));
    let (status, body) = ask(&mut stream, "POST /", br#"{"event-ids": ["fly:end"]}"#).unwrap();
    assert_eq!((status, body.contains("the mission has not begun")), (200, true), "{body}");
    let execution = running.end();
    let end = execution["rows"].as_array().unwrap().iter().find(|row| row["event"] == "fly:end").unwrap();
    assert_eq!((&end["time"], &end["how"]), (&json!(60), &json!("imagined")));
}

#[test]
fn of_news_of_no_use_the_operator_is_told_once_and_why() {
    let running = Running::start(&["run", "tests/live/field.rmpl", "--speed", "20"]);
    let mut stream = connect(running.address);
    for body in [&br#"{"event-ids": ["lunch:end"]}"#[..], br#"{"event-ids": ["lunch:end", "+FLY::START+"]}"#]
    {
        ask(&mut stream, "POST /", body).unwrap();
    }
    let said: Vec<String> = running.said.iter().collect();
    let told = |text: &str| said.iter().filter(|line| line.contains(text)).count();
    assert_eq!(told("lunch:end  ignored: there is no such event in this mission"), 1, "{said:#?}");
    assert_eq!(told("+FLY::START+  ignored: it is not Nature's to decide"), 1, "{said:#?}");
}

/// Sends a request on a connection that stays open, and returns the status and the body of the answer.
fn ask(stream: &mut BufReader<TcpStream>, request: &str, body: &[u8]) -> std::io::Result<(u16, String)> {
    let head = format!("{request} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {}\r\n\r\n", body.len());
    stream.get_mut().write_all(&[head.as_bytes(), body].concat())?;
    let (mut status, mut length, mut line) = (0, 0, String::new());
    loop {
        line.clear();
        if stream.read_line(&mut line)? == 0 {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        if let Some(rest) = line.strip_prefix("HTTP/1.1 ") {
            status = rest[..3].parse().unwrap();
        }
        if let Some(value) = line.to_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().unwrap();
        }
        if line == "\r\n" {
            break;
        }
    }
    let mut text = vec![0; length];
    stream.read_exact(&mut text)?;
    Ok((status, String::from_utf8(text).unwrap()))
}

fn connect(address: SocketAddr) -> BufReader<TcpStream> {
    let stream = TcpStream::connect(address).unwrap();
    stream.set_nodelay(true).unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    BufReader::new(stream)
}

/// Reads a request and answers it. Returns its head and its body.
fn receive(stream: TcpStream, status: &str) -> (String, Vec<u8>) {
    let mut stream = BufReader::new(stream);
    let (mut head, mut length, mut line) = (String::new(), 0, String::new());
    while line != "\r\n" {
        line.clear();
        stream.read_line(&mut line).unwrap();
        if let Some(value) = line.to_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().unwrap();
        }
        head.push_str(&line);
    }
    let mut body = vec![0; length];
    stream.read_exact(&mut body).unwrap();
    let answer = format!("HTTP/1.1 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    stream.get_mut().write_all(answer.as_bytes()).unwrap();
    (head, body)
}

/// A driver server as people have written them for the original: takes start and end of an activity, lets it take a while,
/// and tells every executive of its end, and the next drone that it may fly.
fn serve(listener: TcpListener, executives: Arc<Mutex<Vec<SocketAddr>>>) {
    for stream in listener.incoming() {
        let (_, body) = receive(stream.unwrap(), "200 OK");
        let command: Value = serde_json::from_slice(&body).unwrap();
        let end = command["end_cmd"].as_str().unwrap().to_string();
        if let Some(number) = end.strip_prefix("+FLY-").and_then(|rest| rest.strip_suffix("::END+")) {
            let next = format!("+WAIT-FOR-{number}::END+");
            let executives = Arc::clone(&executives);
            std::thread::spawn(move || {
                std::thread::sleep(Duration::from_millis(400));
                for &address in executives.lock().unwrap().iter() {
                    // The executive of a drone that has landed is gone.
                    let Ok(stream) = TcpStream::connect(address) else { continue };
                    let body = json!({ "event-ids": [end, next] }).to_string();
                    let _ = ask(&mut BufReader::new(stream), "POST /", body.as_bytes());
                }
            });
        }
    }
}

#[test]
fn four_executives_side_by_side_fly_four_drones_through_one_driver_server() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let server = listener.local_addr().unwrap();
    let executives = Arc::new(Mutex::new(Vec::new()));
    let has_curl = Command::new("curl").arg("--version").output().is_ok_and(|output| output.status.success());
    // The field's command line, or the same request without curl.
    let post = r#"{\"start_cmd\":\"~A\",\"end_cmd\":\"~A\"}"#;
    let command = if has_curl {
        format!("curl -s -X POST -H 'Content-Type: application/json' -d \"{post}\" http://{server}/")
    } else {
        format!(
            "exec 3<>/dev/tcp/127.0.0.1/{0} || exit 1; B=\"{post}\"; printf 'POST / HTTP/1.1\\r\\nHost: x\\r\\nContent-Length: \
             %s\\r\\n\\r\\n%s' ${{#B}} \"$B\" >&3; cat <&3 >/dev/null",
            server.port()
        )
    };
    let command = if has_curl { command } else { format!("bash -c '{}'", command.replace('\'', "'\\''")) };
    let drones: Vec<Running> = (1..=4)
        .map(|number| {
            let package = format!("drone-{number}");
            Running::start(&[
                "run",
                "tests/live/drones.rmpl",
                "-P",
                &package,
                "--driver-command",
                &command,
                "--tolerance",
                "1.0",
                "--optimistic",
                "--verbose",
                "--speed",
                "20",
            ])
        })
        .collect();
    executives.lock().unwrap().extend(drones.iter().map(|drone| drone.address));
    std::thread::spawn(move || serve(listener, executives));
    let mut landed = Vec::new();
    for (index, drone) in drones.into_iter().enumerate() {
        let execution = drone.end();
        let row = |event: &str| -> Value {
            let rows = execution["rows"].as_array().unwrap();
            rows.iter().find(|row| row["event"] == event).unwrap_or(&Value::Null).clone()
        };
        let number = index + 1;
        assert_eq!(row(&format!("fly-{number}:end"))["how"], "observed", "{execution}");
        if index > 0 {
            assert_eq!(row(&format!("wait-for-{index}:end"))["how"], "observed", "{execution}");
        }
        landed.push(row(&format!("fly-{number}:end"))["time"].as_f64().unwrap());
        let mut record = tempfile::NamedTempFile::new().unwrap();
        write!(record, "{execution}").unwrap();
        let package = format!("drone-{number}");
        let path = record.path().to_str().unwrap();
        let verified = binary::kirk(&["verify", path, "tests/live/drones.rmpl", "-P", &package, "-q"]);
        assert_eq!(verified.status.code(), Some(0), "{}\n{execution}", binary::stdout(&verified));
    }
    assert!(landed.windows(2).all(|pair| pair[1] > pair[0] + 4.0), "one after the other: {landed:?}");
}

#[test]
fn dispatches_are_posted_until_the_server_confirms_them_under_one_id() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("http://{}/robot", listener.local_addr().unwrap());
    let mission = Running::start(&["run", "tests/live/once.rmpl", "--driver-url", &url, "--speed", "10"]);
    let statuses = ["503 Busy", "500 Oops", "204 No Content"];
    let requests: Vec<_> =
        statuses.iter().map(|status| receive(listener.accept().unwrap().0, status)).collect();
    let execution = mission.end();
    assert_eq!(execution["outcome"], "completed");
    let mut ids = Vec::new();
    for (attempt, (head, body)) in requests.iter().enumerate() {
        assert!(head.starts_with("POST /robot HTTP/1.1\r\n"), "{head}");
        let body: Value = serde_json::from_slice(body).unwrap();
        let dispatch = &body["dispatch"];
        assert_eq!(dispatch["event"], "go:start");
        assert_eq!(dispatch["companion"], "go:end");
        assert_eq!(dispatch["name"], "+GO::START+");
        assert_eq!(dispatch["due"], 1.0);
        assert_eq!(dispatch["attempt"], attempt + 1);
        let id = dispatch["id"].as_str().unwrap();
        assert!(head.to_lowercase().contains(&format!("idempotency-key: {id}\r\n").to_lowercase()), "{head}");
        ids.push(id.to_string());
    }
    ids.dedup();
    assert_eq!(ids.len(), 1, "{ids:?}");
}

#[test]
fn a_flood_of_news_of_every_kind_does_not_keep_a_mission_from_its_times() {
    let mission = Running::start(&["run", "tests/live/deliveries.rmpl", "--speed", "20"]);
    let address = mission.address;
    // Two flights and deliveries at a time: news of use now and then, and all else that can be posted.
    let pour = move |client: usize| {
        let mut stream = connect(address);
        let mut counts = [0_usize; 3];
        for n in 0..10_000_usize {
            let ends = ["fly:end", "deliver:end", "fly#2:end", "+DELIVER#4::END+", "fly#6:end"];
            let body: Vec<u8> = match n % 5 {
                0 => json!({ "event-ids": [format!("stranger-{n}:end")] }).to_string().into_bytes(),
                1 => json!({ "event-ids": ["load:start", "main:end"] }).to_string().into_bytes(),
                2 => b"{\"event-ids\": [".to_vec(),
                3 => vec![0xff; n % 300],
                // Those that are impossible now would break the model if they were of activities that run: one in 500.
                _ if n % 500 == 4 => {
                    json!({ "event-ids": [ends[(n / 500 + client) % 5]] }).to_string().into_bytes()
                }
                _ => json!({ "event-ids": [] }).to_string().into_bytes(),
            };
            match ask(&mut stream, "POST /", &body) {
                Ok((200, text)) => {
                    let answer: Value = serde_json::from_str(&text).unwrap();
                    assert!(answer["accepted"].is_array() && answer["ignored"].is_array(), "{text}");
                    counts[0] += answer["accepted"].as_array().unwrap().len();
                    counts[1] += 1;
                }
                Ok((400, text)) => {
                    assert!(text.contains("error"), "{text}");
                    counts[2] += 1;
                }
                // It is about to end.
                Ok((503, _)) | Err(_) => break,
                Ok((status, text)) => panic!("{status} {text}"),
            }
        }
        counts
    };
    let clients: Vec<_> = (0..3).map(|client| std::thread::spawn(move || pour(client))).collect();
    let counts: Vec<_> = clients.into_iter().map(|client| client.join().unwrap()).collect();
    let total: usize = counts.iter().map(|counts| counts[1] + counts[2]).sum();
    assert!(total > 1000, "only {total} posts were answered");
    let execution = mission.end();
    assert_eq!(execution["outcome"], "completed");
}
