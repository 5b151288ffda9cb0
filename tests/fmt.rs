//! `kirk fmt`: what it writes, what it refuses to touch, and its exit statuses.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod binary;

use std::fs;

use binary::{kirk, kirk_with_input, stderr, stdout};

const UNTIDY: &str = "(define-control-program main () (sequence (:slack t) (a) ; first\n (a)))\n";
const TIDY: &str = "(define-control-program main ()\n  (sequence (:slack t)\n    (a)  ; first\n    (a)))\n";

#[test]
fn files_are_laid_out_in_place_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let (tidy, untidy, broken) = (path("tidy.rmpl"), path("untidy.rmpl"), path("broken.rmpl"));
    fs::write(&tidy, TIDY).unwrap();
    fs::write(&untidy, UNTIDY).unwrap();
    fs::write(&broken, "(a   (b)\n").unwrap();

    let check = kirk(&["fmt", "--check", &tidy, &untidy]);
    assert_eq!((check.status.code(), stdout(&check)), (Some(1), format!("{untidy}\n")));
    let all = kirk(&["fmt", &broken, &tidy, &untidy]);
    assert_eq!((all.status.code(), stdout(&all).as_str()), (Some(2), ""));
    assert!(stderr(&all).contains("K0101"), "{}", stderr(&all));
    assert_eq!(fs::read_to_string(&broken).unwrap(), "(a   (b)\n");
    assert_eq!(fs::read_to_string(&untidy).unwrap(), TIDY);
    assert_eq!(fs::read_to_string(&tidy).unwrap(), TIDY);
    assert_eq!(kirk(&["fmt", "--check", &tidy, &untidy]).status.code(), Some(0));
}

/// The names in a folder, sorted.
fn names(folder: &std::path::Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn what_cannot_be_written_is_left_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.rmpl");
    // Longer than any file may be below: 2 blocks of 512 bytes.
    let program = UNTIDY.repeat(40).replace("main", "other");
    fs::write(&file, &program).unwrap();
    let script =
        format!("trap '' XFSZ; ulimit -f 2; exec '{}' fmt '{}'", env!("CARGO_BIN_EXE_kirk"), file.display());
    let output = std::process::Command::new("sh").args(["-c", &script]).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("which is as it was"), "{}", stderr(&output));
    assert_eq!(fs::read_to_string(&file).unwrap(), program);
    assert_eq!(names(folder.path()), ["a.rmpl"], "nothing is left lying about");
}

#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempfile::tempdir().unwrap();
    let (real, link) = (folder.path().join("real.rmpl"), folder.path().join("link.rmpl"));
    fs::write(&real, UNTIDY).unwrap();
    fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real.rmpl", &link).unwrap();
    let output = kirk(&["fmt", link.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&real).unwrap(), TIDY);
    assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o7777, 0o640);
    assert_eq!(names(folder.path()), ["link.rmpl", "real.rmpl"]);
}

#[test]
fn a_dash_is_a_filter() {
    let filtered = kirk_with_input(&["fmt", "-"], UNTIDY.as_bytes());
    assert_eq!((filtered.status.code(), stdout(&filtered).as_str()), (Some(0), TIDY));
    let checked = kirk_with_input(&["fmt", "--check", "-"], UNTIDY.as_bytes());
    assert_eq!((checked.status.code(), stdout(&checked).as_str()), (Some(1), "<stdin>\n"));
    for wrong in [&b"(a"[..], b"{\"format\": 1}", b"\xff\xfe", b"x = 5"] {
        let refused = kirk_with_input(&["fmt", "-"], wrong);
        assert_eq!((refused.status.code(), stdout(&refused).as_str()), (Some(2), ""));
        assert!(!stderr(&refused).is_empty());
    }
}

#[test]
fn the_examples_are_laid_out() {
    let files: Vec<String> = fs::read_dir("examples/rmpl")
        .unwrap()
        .map(|entry| entry.unwrap().path().to_str().unwrap().to_string())
        .filter(|path| path.ends_with(".rmpl"))
        .collect();
    let arguments: Vec<&str> =
        ["fmt", "--check"].into_iter().chain(files.iter().map(String::as_str)).collect();
    let output = kirk(&arguments);
    assert_eq!((output.status.code(), stdout(&output).as_str()), (Some(0), ""));
}
