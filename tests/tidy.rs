//! The rules of the house that a machine can hold.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use std::fs;
use std::path::{Path, PathBuf};

/// The dependencies a manifest names, without those of tests.
fn dependencies(manifest: &str) -> Vec<String> {
    let text = fs::read_to_string(manifest).unwrap();
    let section = text.split("\n[dependencies]\n").nth(1).unwrap();
    let section = section.split("\n[").next().unwrap();
    section.lines().filter_map(|line| line.split(['.', ' ', '=']).next()).map(str::to_string).collect()
}

#[test]
fn the_crates_know_only_whom_they_may_know() {
    let ours = |manifest: &str| -> Vec<String> {
        dependencies(manifest).into_iter().filter(|name| name.starts_with("kirk-")).collect()
    };
    assert_eq!(ours("network/Cargo.toml"), Vec::<String>::new());
    assert_eq!(ours("compiler/Cargo.toml"), ["kirk-network"]);
    assert_eq!(ours("runtime/Cargo.toml"), ["kirk-network"]);
    assert_eq!(ours("team/Cargo.toml"), ["kirk-compiler", "kirk-network", "kirk-runtime"]);
    assert_eq!(ours("picture/Cargo.toml"), ["kirk-compiler", "kirk-network", "kirk-runtime", "kirk-team"]);
    assert_eq!(ours("executive/Cargo.toml"), ["kirk-network", "kirk-runtime"]);
    assert_eq!(ours("lsp/Cargo.toml"), ["kirk-compiler", "kirk-network", "kirk-team"]);
}

#[test]
fn what_belongs_in_one_place_is_named_in_one_place() {
    for (name, owner) in [
        ("pest", "compiler"),
        ("lexpr", "compiler"),
        ("petgraph", "network"),
        ("strsim", "network"),
        ("good_lp", "network"),
        ("lsp-server", "lsp"),
        ("lsp-types", "lsp"),
        ("clap", "."),
        ("codespan-reporting", "."),
        ("hyper", "executive"),
        ("subtle", "executive"),
        ("crossterm", "."),
        ("jiff", "."),
        ("ratatui", "."),
        ("signal-hook", "."),
        ("similar", "."),
    ] {
        for folder in [".", "compiler", "executive", "lsp", "network", "picture", "runtime", "team"] {
            let named =
                dependencies(&format!("{folder}/Cargo.toml")).iter().any(|dependency| dependency == name);
            assert_eq!(named, folder == owner, "{name} in {folder}");
        }
    }
}

#[test]
fn every_source_file_says_what_it_is_and_has_nothing_unfinished() {
    let mut files = Vec::new();
    for folder in ["cli", "compiler", "executive", "lsp", "network", "picture", "runtime", "team", "tests"] {
        rust_files(Path::new(folder), &mut files);
    }
    assert!(files.len() > 80, "only {} files", files.len());
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        let name = file.display();
        assert!(text.starts_with("//!"), "{name} does not open with what it is");
        for unfinished in [
            concat!("todo", "!("),
            concat!("unimple", "mented!("),
            concat!("#[ig", "nore"),
            concat!("FIX", "ME"),
        ] {
            assert!(!text.contains(unfinished), "{name} contains {unfinished}");
        }
        let is_code = file.components().any(|part| part.as_os_str() == "src" || part.as_os_str() == "cli");
        assert!(!is_code || text.lines().count() <= 600, "{name} may want to be two ideas");
    }
}

#[test]
fn the_map_names_every_room() {
    let map = fs::read_to_string("docs/ARCHITECTURE.md").unwrap();
    let mut missing = Vec::new();
    for folder in [
        "compiler/src",
        "executive/src",
        "lsp/src",
        "network/src",
        "picture/src",
        "runtime/src",
        "team/src",
        "cli",
    ] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_str().unwrap();
            let is_named =
                [format!("`{name}`"), format!("`{name}/")].iter().any(|written| map.contains(written));
            if path.is_file() && !matches!(name, "lib" | "main") && !is_named {
                missing.push(path);
            }
        }
    }
    assert!(missing.is_empty(), "docs/ARCHITECTURE.md does not say what these are: {missing:?}");
}

#[test]
fn the_phases_of_the_compiler_report_what_they_know_and_no_sentences() {
    let mut files = Vec::new();
    for phase in ["read", "parse", "analyse", "expand", "evaluate"] {
        let folder = Path::new("compiler/src").join(phase);
        files.push(folder.with_extension("rs"));
        if folder.is_dir() {
            rust_files(&folder, &mut files);
        }
    }
    assert!(files.len() > 40, "only {} files", files.len());
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        assert!(!text.contains("Diagnostic"), "{} may want to leave that to wording/", file.display());
    }
}

#[test]
fn diagnostics_are_worded_in_one_place_of_each_crate() {
    let mut files = Vec::new();
    for folder in ["cli", "compiler/src", "lsp/src", "team/src"] {
        rust_files(Path::new(folder), &mut files);
    }
    let is_there = |file: &Path| file.iter().any(|part| part == "wording" || part == "wording.rs");
    assert!(files.iter().filter(|file| is_there(file)).count() > 10);
    for file in files.iter().filter(|file| !is_there(file) && !file.ends_with("diagnostic.rs")) {
        let text = fs::read_to_string(file).unwrap();
        for made in ["error", "warning", "note"] {
            let made = format!("Diagnostic::{made}(");
            assert!(!text.contains(&made), "{} may want to leave its words to wording", file.display());
        }
    }
}

fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}
