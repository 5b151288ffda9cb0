//! Every file in `examples/rmpl` is a case by being there: what `check` says, what it is compiled to, how it is executed.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use binary::{kirk, stderr, stdout};

#[test]
fn every_example_is_checked_compiled_executed_and_verified() {
    let mut files: Vec<_> = std::fs::read_dir("examples/rmpl")
        .unwrap()
        .map(|entry| entry.unwrap().path().to_str().unwrap().replace('\\', "/"))
        .filter(|path| path.ends_with(".rmpl"))
        .collect();
    files.sort();
    assert!(files.len() >= 15, "{files:?}");
    for file in &files {
        let name = file.rsplit('/').next().unwrap().trim_end_matches(".rmpl");
        let mut shown = String::new();
        let mut show = |arguments: &[&str]| {
            let output = kirk(arguments);
            let line = format!("$ kirk {}\n", arguments.join(" "));
            shown.push_str(&line);
            shown.push_str(&stdout(&output));
            shown.push_str(&format!("exit status {}\n\n", output.status.code().unwrap()));
            output
        };
        let check = show(&["check", file]);
        shown.push_str(&format!("messages\n{}\n", stderr(&check)));
        let mut show = |arguments: &[&str]| {
            let output = kirk(arguments);
            shown.push_str(&format!("$ kirk {}\n{}", arguments.join(" "), stdout(&output)));
            shown.push_str(&format!("exit status {}\n\n", output.status.code().unwrap()));
            output
        };
        show(&["compile", file, "--quiet"]);
        show(&["compile", file, "--emit", "reduced", "--quiet"]);
        show(&["compile", file, "--emit", "dispatchable", "--quiet"]);
        let run = show(&["run", file, "--simulate", "--quiet"]);
        insta::with_settings!({ description => format!("{file}"), omit_expression => true, prepend_module_to_snapshot => false }, {
            insta::assert_snapshot!(name, shown);
        });
        let controllable = check.status.code() == Some(0);
        assert_eq!(controllable, name != "too-late", "{file}");
        assert_eq!(run.status.code(), check.status.code(), "{file}");
        if controllable {
            survives_nature(file);
        }
    }
}

/// Whatever Nature does and however it is executed, the record satisfies the verifier, which knows only the network.
fn survives_nature(file: &str) {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("execution.json");
    for nature in ["upper", "lower", "random"] {
        for strategy in ["buffer", "optimistic"] {
            for seed in ["1", "2"] {
                let options = ["--nature", nature, "--strategy", strategy, "--seed", seed];
                let mut arguments = vec!["run", file, "--simulate", "--format", "json"];
                arguments.extend(options);
                let run = kirk(&arguments);
                assert_eq!(run.status.code(), Some(0), "{file} {options:?}: {}", stderr(&run));
                std::fs::write(&record, &run.stdout).unwrap();
                let verify = kirk(&["verify", record.to_str().unwrap(), file]);
                assert_eq!(verify.status.code(), Some(0), "{file} {options:?}: {}", stdout(&verify));
            }
        }
    }
}
