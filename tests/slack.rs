//! `kirk slack`: what it prints of examples, for people and for programs.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod binary;

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::{Value, json};

#[test]
fn what_is_left_of_examples() {
    let mut all = String::new();
    for example in ["robot", "with-slack", "drive-to-lecture"] {
        let output = kirk(&["slack", &format!("examples/rmpl/{example}.rmpl")]);
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
        all.push_str(&format!("{}\n", stdout(&output)));
    }
    insta::assert_snapshot!(all);
}

/// `b` is heard up to 5 s late, and `c` is to come within 10 s of it.
const NETWORK: &str = r#"{"format": "kirk-network/1", "name": "n", "origin": "a", "events": ["a", "b", "c"],
    "requirements": [{"from": "b", "to": "c", "lower": 2, "upper": 10}],
    "contingents": [{"from": "a", "to": "b", "lower": 20, "upper": 40, "delay": [0, 5]}]}"#;

#[test]
fn a_network_is_measured_as_well_and_programs_can_read_it() {
    let output = kirk_with_input(&["slack", "-", "--format", "json"], NETWORK.as_bytes());
    let document: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((&document["format"], &document["controllable"]), (&json!("kirk-slack/1"), &json!(true)));
    let bounds = document["slack"].as_array().unwrap();
    let of = |what: &str, side: &str| {
        bounds
            .iter()
            .find(|it| it["what"].as_str().unwrap().starts_with(what) && it["bound"] == side)
            .unwrap()
    };
    // Heard after 5 s at the latest, and not to come before 2 s after that: of 10 s, 3 are left.
    let upper = of("requirements[0]", "upper");
    assert_eq!(
        (&upper["value"], &upper["least"], &upper["most"], &upper["room"]),
        (&json!(10), &json!(7), &json!(null), &json!(3))
    );
    assert_eq!(of("contingents[0]: how late", "max-delay")["most"], 8);
    assert_eq!(document["budget"], json!([{"event": "b", "value": 5, "most": 8}]));
    assert_eq!(document["factor"], 1.6);
    assert_eq!(
        document["activities"],
        json!([{"name": "c", "decided_by": "us", "put_off_to": 30, "earliest_start": 22, "latest_start": 50, "may_take": null}])
    );
}

#[test]
fn of_a_no_nothing_is_left_and_wrong_input_is_wrong() {
    let no = kirk(&["slack", "examples/rmpl/too-late.rmpl"]);
    assert_eq!(no.status.code(), Some(1));
    assert!(stdout(&no).contains("nothing is left") && stderr(&no).contains("K0601"), "{}", stdout(&no));
    for (input, said) in [(&b"(define"[..], "K0101"), (b"", "K0109")] {
        let wrong = kirk_with_input(&["slack", "-"], input);
        assert_eq!(wrong.status.code(), Some(2));
        assert!(stderr(&wrong).contains(said), "{}", stderr(&wrong));
    }
}
