//! `kirk explain [CODE...]`: the pages on diagnostic codes, or a list of all codes.

use std::io;

use kirk_compiler::Code;

use crate::args::Explain;
use crate::output::{Status, complain, print};

pub(crate) fn explain(arguments: &Explain) -> io::Result<Status> {
    if arguments.list || arguments.codes.is_empty() {
        print(&list(|_| true))?;
        return Ok(Status::Yes);
    }
    let mut status = Status::Yes;
    let mut pages = Vec::new();
    for code in &arguments.codes {
        match kirk_compiler::explain(&full(code)) {
            Some(page) => pages.push(page),
            None => {
                complain(&unknown(code));
                status = Status::Wrong;
            }
        }
    }
    print(&pages.join("\n"))?;
    Ok(status)
}

/// `203`, `k203`, `[K0203]`, `error[K0203]` as the code is written.
fn full(code: &str) -> String {
    let bare = code.rsplit('[').next().unwrap_or(code).trim_matches(|c: char| !c.is_alphanumeric());
    let digits = bare.strip_prefix(['K', 'k']).unwrap_or(bare);
    format!("K{digits:0>4}")
}

fn unknown(code: &str) -> String {
    let wanted = full(code);
    let is_code = wanted.len() == 5 && wanted[1..].bytes().all(|byte| byte.is_ascii_digit());
    let near = if is_code { list(|known| known.starts_with(&wanted[..3])) } else { String::new() };
    let help = match near.is_empty() {
        true => "codes look like K0203 and stand in brackets in every message; `kirk explain` lists them all"
            .to_string(),
        false => format!("those like it are:\n{}", near.trim_end()),
    };
    format!("there is no diagnostic `{code}`; {help}")
}

/// A line for each code.
fn list(wanted: impl Fn(&str) -> bool) -> String {
    let codes = Code::ALL.iter().filter(|code| wanted(&code.to_string()));
    codes.map(|code| format!("{code}  {}\n", code.title())).collect()
}
