//! From a keystroke to diagnostics in a file of 2,000 lines: `cargo bench --bench editing`.
//!
//! The file is a mission of four astronauts with 26 samples each, as `kirk generate sampling` writes it; `slip` has a
//! misspelt name in it, `conflict` too short a deadline.

#![allow(clippy::unwrap_used, reason = "a benchmark may fail")]

use std::io::{BufRead, BufReader, PipeReader, PipeWriter, Read, Write, pipe};

use divan::{Bencher, black_box};
use kirk_compiler::Problems;
use kirk_compiler::Source;
use kirk_lsp::{analyse, judge, serve};
use kirk_network::generate::{Exponential, Lambda, SamplingOptions, controllable, sampling};
use kirk_network::rmpl;
use serde_json::{Value, json};

fn main() {
    divan::main();
}

const KINDS: &[&str] = &["sound", "slip", "conflict"];

fn mission(kind: &str) -> String {
    let delay = Exponential { lambda: 0.3, lambda_is: Lambda::Mean };
    let traverse = kirk_network::generate::Link::Requirement;
    let options = SamplingOptions { scan_delay: delay, message_delay: delay, traverse };
    let (_, network) = controllable(|seed| sampling(4, 26, seed, &options), 0).unwrap().unwrap();
    let text = rmpl::write(&network);
    match kind {
        "slip" => {
            let at = text.rfind("(message.").unwrap();
            format!("{}(massage.{}", &text[..at], &text[at + "(message.".len()..])
        }
        "conflict" => {
            text.replacen(
                "(parallel (:slack t)",
                "(with-temporal-constraint (simple-temporal :upper-bound 60) (parallel (:slack t)",
                1,
            ) + ")"
        }
        _ => text,
    }
}

/// The forms of the text.
#[divan::bench(args = KINDS)]
fn read(bencher: Bencher<'_, '_>, kind: &str) {
    let source = Source::new("", mission(kind));
    bencher.bench_local(|| kirk_compiler::read::read(black_box(&source), 0, &mut Problems::default()).len());
}

/// Everything that is said at once: forms, names, bounds.
#[divan::bench(args = KINDS)]
fn analysis(bencher: Bencher<'_, '_>, kind: &str) {
    let text = mission(kind);
    bencher.bench_local(|| analyse(black_box(text.clone())).0.diagnostics.len());
}

/// What takes longer: unfolding, windows and the verdict.
#[divan::bench(args = KINDS)]
fn verdict(bencher: Bencher<'_, '_>, kind: &str) {
    let text = mission(kind);
    bencher.with_inputs(|| analyse(text.clone()).1).bench_local_values(|unjudged| judge(unjudged).0.len());
}

/// The whole way, as an editor sees it: a character typed, the diagnostics of that text received.
#[divan::bench(args = KINDS)]
fn keystroke_to_diagnostics(bencher: Bencher<'_, '_>, kind: &str) {
    let mut editor = Editor::open(&mission(kind));
    bencher.bench_local(|| editor.type_and_wait());
}

/// An editor on the other end of two pipes.
struct Editor {
    input: PipeWriter,
    output: BufReader<PipeReader>,
    version: i32,
}

impl Editor {
    fn open(text: &str) -> Editor {
        assert!((1_900..2_300).contains(&text.lines().count()), "{} lines", text.lines().count());
        let (theirs, input) = pipe().unwrap();
        let (output, ours) = pipe().unwrap();
        std::thread::spawn(move || serve(BufReader::new(theirs), ours, Box::new(|_| None)));
        let mut editor = Editor { input, output: BufReader::new(output), version: 0 };
        editor.send(json!({"id": 1, "method": "initialize", "params": {"capabilities": {}}}));
        editor.receive();
        let document = json!({"uri": "file:///m.rmpl", "languageId": "rmpl", "version": 0, "text": text});
        editor.send(json!({"method": "textDocument/didOpen", "params": {"textDocument": document}}));
        editor.receive();
        editor
    }

    /// Types a character into the comment at the top, or takes it back, and waits for what is said.
    fn type_and_wait(&mut self) -> usize {
        self.version += 1;
        let at = |character| json!({"line": 0, "character": character});
        let (end, text) = if self.version % 2 == 1 { (3, "x") } else { (4, "") };
        self.send(json!({"method": "textDocument/didChange", "params": {
            "textDocument": {"uri": "file:///m.rmpl", "version": self.version},
            "contentChanges": [{"range": {"start": at(3), "end": at(end)}, "text": text}]}}));
        loop {
            let told = self.receive();
            if told["params"]["version"] == self.version {
                break told["params"]["diagnostics"].as_array().map_or(0, Vec::len);
            }
        }
    }

    fn send(&mut self, message: Value) {
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
    }

    fn receive(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            self.output.read_line(&mut line).unwrap();
            match line.trim().split_once(": ") {
                Some((_, value)) => length = value.parse().unwrap(),
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }
}
