//! Every file in `tests/rmpl/bad` is a case by existing: its name begins with the code it is about. All codes occur.
#![allow(clippy::disallowed_methods, reason = "tests read and write files")]

mod common;

use std::collections::BTreeSet;

use kirk_compiler::{Code, Options, code};

#[test]
fn every_bad_file_is_told_what_is_wrong_with_it() {
    let mut covered: BTreeSet<String> = BTreeSet::new();
    for (name, text) in common::sources("tests/rmpl/bad") {
        let compiled = common::compile_with(&text, &common::options_in(&text));
        let found: BTreeSet<String> = compiled.diagnostics.iter().map(|d| d.code.to_string()).collect();
        let said = common::diagnostics(&text, &compiled.diagnostics);
        assert!(found.contains(&name[..5]), "{name}:\n{said}");
        let errors = compiled.diagnostics.iter().any(|d| d.severity == kirk_compiler::Severity::Error);
        assert_eq!(
            compiled.lowered.is_none(),
            errors,
            "{name}: There is a network exactly if there is no error"
        );
        covered.extend(found);
        let shown =
            if text.len() > 4_000 { format!("({} bytes)\n", text.len()) } else { text.replace('\0', "\\0") };
        let clipped: String = said.lines().take(80).map(|line| format!("{line}\n")).collect();
        insta::with_settings!({prepend_module_to_snapshot => false, snapshot_path => "snapshots/bad", omit_expression => true}, {
            insta::assert_snapshot!(name, format!("{shown}\n---\n{clipped}"));
        });
    }
    // `conflicts.rs`, the tests of teams and `robustness.rs` have these: what is found out later, and a source too long to keep.
    let elsewhere = [Code::NotControllable, Code::NoPromises, Code::TooLong].map(|code| code.to_string());
    // From 7 on, the hundreds are spoken by others: the command line and the network files.
    let ours = Code::ALL.iter().filter(|code| (**code as u16) < 700).map(Code::to_string);
    let missing: Vec<String> =
        ours.filter(|code| !covered.contains(code) && !elsewhere.contains(code)).collect();
    assert!(missing.is_empty(), "no bad file earns {missing:?}");
}

#[test]
fn a_package_is_chosen_or_the_choice_is_explained() {
    let text = "(defpackage #:astronaut)\n(defpackage #:robot)\n(in-package #:astronaut)\n\
                (define-control-program main () (declare (primitive)))\n(in-package #:robot)\n\
                (define-control-program main () (astronaut:main))\n";
    let with = |package: &str| {
        let options = Options { package: Some(package.to_string()), ..Options::default() };
        let compiled = common::compile_with(text, &options);
        let said = common::diagnostics(text, &compiled.diagnostics);
        compiled.lowered.map(|lowered| common::network(&lowered)).unwrap_or(said)
    };
    insta::assert_snapshot!(["astronaut", "ROBOT", "#:robot", "robbot", "moon"].map(with).join("---\n"));
}

#[test]
fn several_sources_are_one_program() {
    let sources = [
        kirk_compiler::Source::new("lib.rmpl", "(define-control-program a () (declare (primitive)))\n"),
        kirk_compiler::Source::new("main.rmpl", "(define-control-program main () (a) (b))\n"),
    ];
    let compiled = kirk_compiler::compile(&sources, &Options::default());
    let places: Vec<(String, u32)> =
        compiled.diagnostics.iter().map(|d| (d.code.to_string(), d.span.source)).collect();
    assert_eq!(places, [("K0301".to_string(), 1)]);
}

#[test]
fn every_code_has_a_page_and_the_document_is_made_of_them() {
    for code in Code::ALL {
        let page = kirk_compiler::explain(&code.to_string().to_lowercase()).unwrap();
        assert!(page.len() > 200, "the page of {code} says too little:\n{page}");
    }
    assert_eq!(kirk_compiler::explain("K9999"), None);
    assert_eq!(kirk_compiler::explain(""), None);
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/DIAGNOSTICS.md");
    if std::env::var("INSTA_UPDATE").as_deref() == Ok("always") {
        std::fs::write(&path, code::pages()).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == code::pages(),
        "docs/DIAGNOSTICS.md is not what the pages say; run with INSTA_UPDATE=always"
    );
}

#[test]
fn the_examples_of_a_page_earn_the_code_and_do_not() {
    let block = |page: &str, title: &str| -> Option<String> {
        let (_, after) = page.split_once(&format!("\n{title}:\n\n"))?;
        let lines = after.lines().take_while(|line| line.is_empty() || line.starts_with("    "));
        Some(lines.map(|line| format!("{}\n", line.trim_start())).collect())
    };
    let mut tried = 0;
    for code in Code::ALL {
        let page = kirk_compiler::explain(&code.to_string()).unwrap();
        for (title, expected) in [("Wrong", true), ("Right", false)] {
            let Some(example) = block(&page, title) else { continue };
            // The tests of teams try them.
            if *code == Code::NoPromises {
                continue;
            }
            let compiled = common::compile(&example);
            let said = common::diagnostics(&example, &compiled.diagnostics);
            let found = match code {
                Code::NotControllable => {
                    let lowered = compiled.lowered.expect("a network");
                    matches!(
                        kirk_network::check(&lowered.network),
                        Ok(kirk_network::Verdict::Uncontrollable(_))
                    )
                }
                _ => compiled.diagnostics.iter().any(|d| d.code == *code),
            };
            assert_eq!(found, expected, "{code} {title}:\n{example}\n{said}");
            tried += 1;
        }
    }
    assert!(tried > 80, "only {tried} examples");
}
