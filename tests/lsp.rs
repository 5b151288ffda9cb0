//! One editor at work: a session with the real binary on its standard input and output.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

struct Editor {
    kirk: Child,
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
    asked: i32,
    /// What the server said unasked and nobody has looked at.
    told: Vec<Value>,
}

impl Editor {
    fn start() -> Editor {
        let mut kirk = Command::new(env!("CARGO_BIN_EXE_kirk"))
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let input = kirk.stdin.take();
        let output = BufReader::new(kirk.stdout.take().unwrap());
        // What is waited for in vain ends the test, and not the patience of whoever runs it.
        let pid = kirk.id().to_string();
        std::thread::spawn(move || {
            std::thread::sleep(Duration::from_secs(100));
            let _ = Command::new("kill").arg(pid).status();
        });
        Editor { kirk, input, output, asked: 0, told: Vec::new() }
    }

    /// Starts a session as far as a first document.
    fn open(text: &str) -> Editor {
        let mut editor = Editor::start();
        editor.ask("initialize", json!({"capabilities": {}})).unwrap();
        editor.tell("initialized", json!({}));
        let document = json!({"uri": URI, "languageId": "rmpl", "version": 1, "text": text});
        editor.tell("textDocument/didOpen", json!({"textDocument": document}));
        editor
    }

    fn raw(&mut self, body: &str) {
        let input = self.input.as_mut().unwrap();
        write!(input, "Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
        input.flush().unwrap();
    }

    fn tell(&mut self, method: &str, params: Value) {
        self.raw(&json!({"jsonrpc": "2.0", "method": method, "params": params}).to_string());
    }

    /// The next message of the server; `None` at the end.
    fn hear(&mut self) -> Option<Value> {
        let mut length = 0;
        loop {
            let mut line = String::new();
            if self.output.read_line(&mut line).unwrap() == 0 {
                return None;
            }
            match line.trim().split_once(": ") {
                Some((_, value)) => length = value.parse().unwrap(),
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        Some(serde_json::from_slice(&body).unwrap())
    }

    /// The result of a request, or its error.
    fn ask(&mut self, method: &str, params: Value) -> Result<Value, Value> {
        self.asked += 1;
        let id = self.asked;
        self.raw(&json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}).to_string());
        loop {
            let mut message = self.hear().expect("an answer");
            if message["id"] == id && message.get("method").is_none() {
                return match message.get_mut("error") {
                    Some(error) => Err(error.take()),
                    None => Ok(message["result"].take()),
                };
            }
            self.told.push(message);
        }
    }

    /// What is said of a version of the document.
    fn diagnostics(&mut self, version: i32) -> Vec<Value> {
        let is_it = |message: &Value| {
            message["method"] == "textDocument/publishDiagnostics" && message["params"]["version"] == version
        };
        let told = self.told.iter().position(is_it).map(|at| self.told.remove(at));
        let message = told.unwrap_or_else(|| {
            loop {
                let message = self.hear().expect("diagnostics");
                if is_it(&message) {
                    break message;
                }
            }
        });
        message["params"]["diagnostics"].as_array().unwrap().clone()
    }

    fn leave(mut self) -> Option<i32> {
        self.input = None;
        while self.hear().is_some() {}
        self.kirk.wait().unwrap().code()
    }
}

const URI: &str = "file:///missions/drill%20%C3%B6.rmpl";

/// Nine seconds are there for what may take ten.
const MISSION: &str = "; Bohren für Anfänger 𝄞\r
(define-control-program drill ()\r
  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 10) :contingent t)))\r
(define-control-program main ()\r
  (with-temporal-constraint (simple-temporal :upper-bound 9)\r
    (drill)))\r
";

fn at(line: u32, character: u32) -> Value {
    json!({"textDocument": {"uri": URI}, "position": {"line": line, "character": character}})
}

fn change(version: i32, start: (u32, u32), end: (u32, u32), text: &str) -> Value {
    let position = |(line, character)| json!({"line": line, "character": character});
    let range = json!({"start": position(start), "end": position(end)});
    json!({"textDocument": {"uri": URI, "version": version}, "contentChanges": [{"range": range, "text": text}]})
}

fn codes(diagnostics: &[Value]) -> Vec<&str> {
    diagnostics.iter().map(|diagnostic| diagnostic["code"].as_str().unwrap()).collect()
}

#[test]
fn an_editor_opens_changes_asks_and_leaves() {
    let mut editor = Editor::open(MISSION);

    let told = editor.diagnostics(1);
    assert_eq!(codes(&told), ["K0601"]);
    let blamed: Vec<_> = told[0]["relatedInformation"]
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it["message"].as_str().unwrap())
        .collect();
    assert_eq!(blamed, ["at most 9 s from start to end of this", "Nature may take up to 10 s for `drill`"]);

    // What would put it right is offered, in the units of the protocol.
    let range = told[0]["range"].clone();
    let asked = json!({"textDocument": {"uri": URI}, "range": range, "context": {"diagnostics": []}});
    let actions = editor.ask("textDocument/codeAction", asked).unwrap();
    assert_eq!(actions[0]["title"], "Repair: at most 10 s instead of 9 s for the `with-temporal-constraint`");
    assert_eq!(
        actions[0]["edit"]["changes"][URI],
        json!([{"newText": "10", "range": {"start": {"line": 4, "character": 58}, "end": {"line": 4, "character": 59}}}])
    );
    assert_eq!(actions[0]["diagnostics"][0]["code"], "K0601");

    // A slip: the verdict goes, the slip is shown.
    editor.tell("textDocument/didChange", change(2, (5, 5), (5, 10), "drlil"));
    assert_eq!(codes(&editor.diagnostics(2)), ["K0301"]);
    // Put right, with a longer bound: nothing is left to say.
    editor.tell("textDocument/didChange", change(3, (5, 5), (5, 10), "drill"));
    editor.tell("textDocument/didChange", change(4, (4, 58), (4, 59), "10"));
    assert_eq!(editor.diagnostics(4), Vec::<Value>::new());

    let hover = editor.ask("textDocument/hover", at(5, 6)).unwrap();
    let text = hover["contents"]["value"].as_str().unwrap();
    assert!(text.contains("ends from 5 to 10 s"), "{text}");
    let definition = editor.ask("textDocument/definition", at(5, 6)).unwrap();
    assert_eq!(definition[0]["range"]["start"], json!({"line": 1, "character": 24}));

    let lenses = editor.ask("textDocument/codeLens", json!({"textDocument": {"uri": URI}})).unwrap();
    assert_eq!(
        lenses[0]["command"]["title"],
        "controllable: whatever happens, takes 5 to 10 s, 1 contingent duration"
    );

    let rename = |position: Value, name: &str| {
        let mut params = position;
        params["newName"] = json!(name);
        params
    };
    let renamed = editor.ask("textDocument/rename", rename(at(5, 6), "bohren")).unwrap();
    assert_eq!(renamed["changes"][URI].as_array().unwrap().len(), 2);
    let refused = editor.ask("textDocument/rename", rename(at(3, 26), "bohren")).unwrap_err();
    assert!(refused["message"].as_str().unwrap().contains("starts with `main`"), "{refused}");
    let layout = json!({"textDocument": {"uri": URI}, "options": {"tabSize": 2, "insertSpaces": true}});
    let edits = editor.ask("textDocument/formatting", layout).unwrap();
    assert!(edits.as_array().unwrap().iter().all(|edit| edit["newText"].as_str().unwrap().contains("\r\n")));

    // Closed, it is nobody's business any more.
    editor.tell("textDocument/didClose", json!({"textDocument": {"uri": URI}}));
    assert_eq!(editor.ask("textDocument/hover", at(5, 6)).unwrap_err()["code"], -32602);
    assert!(editor.told.iter().any(|told| told["params"]["diagnostics"] == json!([])));

    assert_eq!(editor.ask("shutdown", Value::Null), Ok(Value::Null));
    assert_eq!(editor.ask("textDocument/hover", at(5, 6)).unwrap_err()["code"], -32600);
    editor.tell("exit", Value::Null);
    assert_eq!(editor.leave(), Some(0));
}

#[test]
fn columns_are_bytes_for_an_editor_that_offers_it() {
    let mut editor = Editor::start();
    let offered = json!({"capabilities": {"general": {"positionEncodings": ["utf-16", "utf-8"]}}});
    let answer = editor.ask("initialize", offered).unwrap();
    assert_eq!(answer["capabilities"]["positionEncoding"], "utf-8");
    let text = "#| ö𝄞 |# (define-control-program main () (delay 5))";
    let document = json!({"uri": URI, "languageId": "rmpl", "version": 1, "text": text});
    editor.tell("textDocument/didOpen", json!({"textDocument": document}));
    let symbols = editor.ask("textDocument/documentSymbol", json!({"textDocument": {"uri": URI}})).unwrap();
    assert_eq!(symbols[0]["selectionRange"]["start"]["character"], 37);
}

#[test]
fn of_many_changes_the_last_text_counts_and_old_requests_can_be_withdrawn() {
    let mut editor = Editor::open(MISSION);
    for version in 2..200 {
        editor.tell("textDocument/didChange", change(version, (0, 2), (0, 2), "x"));
    }
    assert_eq!(codes(&editor.diagnostics(199)), ["K0601"]);
    // In one piece, so that both are there when the first is looked at.
    let hover =
        json!({"jsonrpc": "2.0", "id": 77, "method": "textDocument/hover", "params": at(5, 6)}).to_string();
    let cancel = json!({"jsonrpc": "2.0", "method": "$/cancelRequest", "params": {"id": 77}}).to_string();
    let frame = |body: &str| format!("Content-Length: {}\r\n\r\n{body}", body.len());
    editor.input.as_mut().unwrap().write_all((frame(&hover) + &frame(&cancel)).as_bytes()).unwrap();
    let answer = loop {
        let message = editor.hear().unwrap();
        if message["id"] == 77 {
            break message;
        }
    };
    // It was withdrawn, or had been answered before.
    assert!(answer["error"]["code"] == -32800 || answer["result"]["contents"].is_object(), "{answer}");
}

#[test]
fn colours_of_a_line_of_many_activities_come_at_once() {
    let hop = "(define-control-program hop () (declare (primitive) (duration (simple :upper-bound 1))))";
    let text = format!("{hop} (define-control-program main () (sequence (){}))", " (hop)".repeat(60_000));
    let mut editor = Editor::open(&text);
    let document = json!({"textDocument": {"uri": URI}});
    // So that what is measured begins with an analysed text.
    editor.ask("textDocument/documentSymbol", document.clone()).unwrap();
    let start = Instant::now();
    let tokens = editor.ask("textDocument/semanticTokens/full", document).unwrap();
    assert_eq!(tokens["data"].as_array().unwrap().len() / 5, 60_000 + 11);
    // A walk over the line for each of them takes minutes.
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn what_makes_no_sense_is_answered_with_an_error_and_the_session_goes_on() {
    let mut editor = Editor::start();
    assert_eq!(editor.ask("textDocument/hover", at(0, 0)).unwrap_err()["code"], -32002);
    assert_eq!(editor.ask("initialize", json!({"capabilities": 7})).unwrap_err()["code"], -32602);
    assert!(editor.ask("initialize", json!({"capabilities": {}})).is_ok());
    editor.raw("this is not JSON");
    assert_eq!(editor.hear().unwrap()["error"]["code"], -32700);
    editor.raw("{\"jsonrpc\": \"2.0\", \"id\": 5}");
    assert_eq!(editor.hear().unwrap()["error"]["code"], -32600);
    assert_eq!(editor.ask("kirk/fly", json!({})).unwrap_err()["code"], -32601);
    assert_eq!(editor.ask("textDocument/hover", json!({"a": 1})).unwrap_err()["code"], -32602);
    assert_eq!(editor.ask("textDocument/hover", at(0, 0)).unwrap_err()["code"], -32602, "it is not open");
    editor.tell("textDocument/didOpen", json!({"nonsense": []}));
    editor.tell("textDocument/didChange", change(2, (9, 9), (0, 0), "x"));
    editor.tell("no/such/thing", json!(null));
    assert_eq!(editor.ask("shutdown", Value::Null), Ok(Value::Null));
    editor.tell("exit", Value::Null);
    assert_eq!(editor.leave(), Some(0));
}

#[test]
fn without_taking_leave_the_exit_status_is_1() {
    let mut editor = Editor::open(MISSION);
    editor.tell("exit", Value::Null);
    assert_eq!(editor.leave(), Some(1));
    // The editor is gone in the middle of everything.
    assert_eq!(Editor::open(MISSION).leave(), Some(1));
    let mut editor = Editor::open(MISSION);
    editor.ask("shutdown", Value::Null).unwrap();
    assert_eq!(editor.leave(), Some(0), "to close the stream is to leave as well");
}

/// What is said of a document, as soon as it is what is waited for.
fn wait_for(editor: &mut Editor, uri: &str, wanted: impl Fn(&[&str]) -> bool) -> Vec<Value> {
    loop {
        let message =
            if editor.told.is_empty() { editor.hear().expect("diagnostics") } else { editor.told.remove(0) };
        if message["method"] == "textDocument/publishDiagnostics" && message["params"]["uri"] == uri {
            let diagnostics = message["params"]["diagnostics"].as_array().unwrap();
            if wanted(&codes(diagnostics)) {
                return diagnostics.clone();
            }
        }
    }
}

#[test]
fn the_files_that_a_mission_names_are_one_program_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().canonicalize().unwrap();
    let library = "(define-control-program drive ()\n  (declare (primitive) (duration (simple :lower-bound 5 :upper-bound 8))))\n";
    let mission = ";;; kirk: files lib.rmpl mission.rmpl\n(define-control-program main ()\n  \
                   (with-temporal-constraint (simple-temporal :upper-bound 7)\n    (drive)))\n";
    std::fs::write(folder.join("lib.rmpl"), library).unwrap();
    std::fs::write(folder.join("mission.rmpl"), mission).unwrap();
    let uri = |name: &str| format!("file://{}/{name}", folder.display());
    let (lib, main) = (uri("lib.rmpl"), uri("mission.rmpl"));
    let mut editor = Editor::start();
    editor.ask("initialize", json!({"capabilities": {}})).unwrap();
    editor.tell("initialized", json!({}));
    let opened = |uri: &str, text: &str| json!({"textDocument": {"uri": uri, "languageId": "rmpl", "version": 1, "text": text}});
    editor.tell("textDocument/didOpen", opened(&main, mission));
    wait_for(&mut editor, &main, |codes| codes.is_empty());

    // Names lead from file to file.
    let call = json!({"textDocument": {"uri": main}, "position": {"line": 3, "character": 6}});
    let found = editor.ask("textDocument/definition", call.clone()).unwrap();
    assert_eq!(
        (&found[0]["uri"], &found[0]["range"]["start"]),
        (&json!(lib), &json!({"line": 0, "character": 24}))
    );
    let mut rename = call.clone();
    rename["newName"] = json!("go");
    let changes = editor.ask("textDocument/rename", rename).unwrap()["changes"].take();
    assert_eq!((&changes[&lib][0]["newText"], &changes[&main][0]["newText"]), (&json!("go"), &json!("go")));
    let mut taken = call;
    taken["newName"] = json!("main");
    let refused = editor.ask("textDocument/rename", taken).unwrap_err();
    assert!(refused["message"].as_str().unwrap().contains("The name `main` is taken"), "{refused}");

    // What is being typed in one file counts for the other, and what is not saved is forgotten when it is closed.
    editor.tell(
        "textDocument/didOpen",
        opened(&lib, &library.replace(":lower-bound 5 :upper-bound 8", ":lower-bound 50")),
    );
    let told = wait_for(&mut editor, &main, |codes| codes == ["K0601"]);
    let related = told[0]["relatedInformation"].as_array().unwrap();
    assert!(related.iter().any(|place| place["location"]["uri"] == json!(lib)), "{told:?}");
    editor.tell("textDocument/didClose", json!({"textDocument": {"uri": lib}}));
    wait_for(&mut editor, &main, |codes| codes.is_empty());

    // So does what changes on the disk.
    std::fs::write(folder.join("lib.rmpl"), "").unwrap();
    editor.tell("workspace/didChangeWatchedFiles", json!({"changes": [{"uri": lib, "type": 2}]}));
    let told = wait_for(&mut editor, &main, |codes| codes == ["K0109"]);
    assert_eq!(told[0]["range"]["start"], json!({"line": 0, "character": 16}), "where it is named");
    std::fs::remove_file(folder.join("lib.rmpl")).unwrap();
    editor.tell("workspace/didChangeWatchedFiles", json!({"changes": [{"uri": lib, "type": 3}]}));
    wait_for(&mut editor, &main, |codes| codes.contains(&"K0701"));
    editor.ask("shutdown", Value::Null).unwrap();
    editor.tell("exit", Value::Null);
    assert_eq!(editor.leave(), Some(0));
}

#[test]
fn an_editor_that_asks_for_diagnostics_is_not_told_and_asks_again_when_there_is_a_verdict() {
    let mut editor = Editor::start();
    let can = json!({
        "textDocument": {"diagnostic": {}},
        "workspace": {"diagnostic": {"refreshSupport": true}},
    });
    let about = editor.ask("initialize", json!({"capabilities": can})).unwrap();
    assert_eq!(about["capabilities"]["diagnosticProvider"]["identifier"], "kirk");
    editor.tell("initialized", json!({}));
    let document = json!({"uri": URI, "languageId": "rmpl", "version": 1, "text": MISSION});
    editor.tell("textDocument/didOpen", json!({"textDocument": document}));
    loop {
        let message = editor.hear().unwrap();
        assert_ne!(message["method"], "textDocument/publishDiagnostics");
        if message["method"] == "workspace/diagnostic/refresh" {
            break;
        }
    }
    let report = editor.ask("textDocument/diagnostic", json!({"textDocument": {"uri": URI}})).unwrap();
    assert_eq!(
        (&report["kind"], codes(report["items"].as_array().unwrap())),
        (&json!("full"), vec!["K0601"])
    );
}

#[test]
fn a_part_is_laid_out_symbols_are_found_in_all_documents_and_a_lens_says_its_verdict() {
    let mut editor = Editor::open(MISSION);
    assert_eq!(codes(&editor.diagnostics(1)), ["K0601"]);
    let found = editor.ask("workspace/symbol", json!({"query": "DL"})).unwrap();
    assert_eq!((&found[0]["name"], &found[0]["location"]["uri"]), (&json!("drill"), &json!(URI)));
    assert_eq!(found.as_array().unwrap().len(), 1);

    let lenses = editor.ask("textDocument/codeLens", json!({"textDocument": {"uri": URI}})).unwrap();
    let command = &lenses[0]["command"];
    let run = json!({"command": command["command"], "arguments": command["arguments"]});
    let said = editor.ask("workspace/executeCommand", run).unwrap();
    assert!(said.as_str().unwrap().starts_with("`main` is not controllable: some bounds"), "{said}");
    assert!(editor.told.iter().any(|message| message["method"] == "window/showMessage"));
    let unknown = editor.ask("workspace/executeCommand", json!({"command": "kirk.fly", "arguments": []}));
    assert!(unknown.is_err());

    // Only the form that is touched: the other stays as it was typed.
    let text =
        "(define-control-program   a () (declare (primitive)))\n(define-control-program   main () (a))\n";
    editor.tell(
        "textDocument/didChange",
        json!({"textDocument": {"uri": URI, "version": 2}, "contentChanges": [{"text": text}]}),
    );
    let range = json!({"start": {"line": 1, "character": 3}, "end": {"line": 1, "character": 3}});
    let options = json!({"tabSize": 2, "insertSpaces": true});
    let asked = json!({"textDocument": {"uri": URI}, "range": range, "options": options});
    let edits = editor.ask("textDocument/rangeFormatting", asked).unwrap();
    assert_eq!(edits.as_array().unwrap().len(), 1);
    assert_eq!(edits[0]["range"]["start"], json!({"line": 1, "character": 0}));
    assert_eq!(edits[0]["newText"], "(define-control-program main ()\n  (a))");
}
