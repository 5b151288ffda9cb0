//! Missions with known answers: the listings of the thesis, executed to the second as the original's logs have it.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use binary::{kirk, stdout};
use serde_json::Value;

/// A script, its arguments, and for each event that matters when it is executed and, if it matters, how.
struct Mission {
    script: &'static str,
    arguments: &'static [&'static str],
    schedule: &'static [(&'static str, f64)],
    how: &'static [(&'static str, &'static str)],
}

const MISSIONS: &[Mission] = &[
    Mission {
        script: "eat-and-bike",
        arguments: &[],
        schedule: &[
            ("eat-breakfast:start", 0.0),
            ("eat-breakfast:end", 15.0),
            ("bike-to-lecture:start", 15.0),
            ("bike-to-lecture:end", 30.0),
        ],
        how: &[("bike-to-lecture:end", "dispatched")],
    },
    Mission {
        script: "morning-lecture",
        arguments: &["-P", "morning-lecture"],
        schedule: &[
            ("shower:start", 0.0),
            ("shower:end", 5.0),
            ("eat-breakfast:start", 5.0),
            ("eat-breakfast:end", 20.0),
            ("review-scheduling-notes:start", 5.0),
            ("review-scheduling-notes:end", 15.0),
            ("review-planning-notes:start", 15.0),
            ("review-planning-notes:end", 25.0),
            ("pack-bag:start", 25.0),
            ("pack-bag:end", 30.0),
            ("bike-to-lecture:start", 30.0),
            ("bike-to-lecture:end", 45.0),
        ],
        how: &[],
    },
    Mission {
        script: "drive-to-lecture",
        arguments: &["--observe", "drive-to-lecture:end@47"],
        schedule: &[
            ("pack-bag:start", 25.0),
            ("pack-bag:end", 30.0),
            ("drive-to-lecture:start", 30.0),
            ("drive-to-lecture:end", 47.0),
        ],
        how: &[("drive-to-lecture:end", "observed")],
    },
    Mission {
        script: "astronaut",
        arguments: &[
            "--observe",
            "human-downlink-science:end@16",
            "--observe",
            "sync:end@23",
            "--observe",
            "robot-drilling:end@49",
        ],
        schedule: &[
            ("human-downlink-science:end", 16.0),
            ("sync:end", 23.0),
            ("robot-drilling:end", 49.0),
            ("human-closeout:start", 49.0),
            ("human-closeout:end", 59.0),
        ],
        how: &[("sync:end", "observed")],
    },
    Mission {
        script: "robot",
        arguments: &["--observe", "+HUMAN-DOWNLINK-SCIENCE::END+@22", "--observe", "robot-drilling:end@46"],
        schedule: &[("sync:end", 22.0), ("robot-poweroff:start", 46.0), ("robot-poweroff:end", 56.0)],
        how: &[("human-downlink-science:end", "observed")],
    },
    Mission {
        script: "robot",
        arguments: &[
            "--strategy",
            "buffer",
            "--observe",
            "sync:start@22",
            "--observe",
            "robot-drilling:end@54",
        ],
        schedule: &[
            ("human-downlink-science:end", 30.0),
            ("sync:end", 30.0),
            ("robot-poweroff:start", 54.0),
            ("robot-poweroff:end", 64.0),
        ],
        how: &[("human-downlink-science:end", "buffered")],
    },
    Mission {
        script: "astronaut",
        arguments: &[],
        schedule: &[
            ("human-downlink-science:end", 30.0),
            ("sync:end", 45.0),
            ("robot-drilling:end", 71.0),
            ("human-closeout:start", 71.0),
            ("human-closeout:end", 81.0),
        ],
        how: &[
            ("human-downlink-science:end", "observed"),
            ("sync:end", "imagined"),
            ("robot-drilling:end", "imagined"),
        ],
    },
    Mission {
        script: "robot",
        arguments: &["--observe", "robot-drilling:end@60"],
        schedule: &[
            ("human-downlink-science:end", 35.0),
            ("sync:end", 35.0),
            ("robot-poweroff:start", 60.0),
            ("robot-poweroff:end", 70.0),
        ],
        how: &[("human-downlink-science:end", "imagined")],
    },
    Mission {
        script: "collect-sample",
        arguments: &[],
        schedule: &[("collect-science-sample:start", 0.0), ("collect-science-sample:end", 35.0)],
        how: &[("collect-science-sample:end", "imagined")],
    },
    Mission {
        script: "no-slack",
        arguments: &[],
        schedule: &[("take-pictures:start", 0.0), ("eat-snack:end", 6.0)],
        how: &[],
    },
    Mission {
        script: "with-slack",
        arguments: &[],
        schedule: &[("take-pictures:start", 0.0), ("main:end", 6.0)],
        how: &[],
    },
    Mission {
        script: "repeater",
        arguments: &["--observe", "traverse/0-0:end@10", "--observe", "confirm/0-0:end@17"],
        schedule: &[
            ("install/0-0:start", 10.0),
            ("install/0-0:end", 11.0),
            ("confirm/0-0:end", 17.0),
            ("start/0-1:start", 17.0),
            ("start/0-1:end", 19.0),
        ],
        how: &[],
    },
    Mission {
        script: "glider",
        arguments: &[],
        schedule: &[("move:start", 0.0), ("move:end", 10.0)],
        how: &[],
    },
];

fn execution(mission: &Mission) -> Value {
    let file = format!("examples/rmpl/{}.rmpl", mission.script);
    let mut arguments = vec!["run", &file, "--simulate", "--format", "json"];
    arguments.extend(mission.arguments);
    let output = kirk(&arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}: {}",
        mission.script,
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_str(&stdout(&output)).unwrap()
}

#[test]
fn every_mission_is_executed_to_the_known_second() {
    for mission in MISSIONS {
        let execution = execution(mission);
        let row = |event: &str| {
            let rows = execution["rows"].as_array().unwrap();
            rows.iter()
                .find(|row| row["event"] == event)
                .unwrap_or_else(|| panic!("{}: no {event}", mission.script))
        };
        assert_eq!(execution["outcome"], "completed", "{}", mission.script);
        for (event, time) in mission.schedule {
            assert_eq!(
                row(event)["time"].as_f64(),
                Some(*time),
                "{} {:?}: {event}",
                mission.script,
                mission.arguments
            );
        }
        for (event, how) in mission.how {
            assert_eq!(row(event)["how"], *how, "{} {:?}: {event}", mission.script, mission.arguments);
        }
    }
}

#[test]
fn slack_makes_the_difference_of_a_moment() {
    for (script, moments) in [("no-slack", 3), ("with-slack", 4)] {
        let mission = MISSIONS.iter().find(|mission| mission.script == script).unwrap();
        let execution = execution(mission);
        let mut times: Vec<f64> =
            execution["rows"].as_array().unwrap().iter().filter_map(|row| row["time"].as_f64()).collect();
        times.dedup();
        assert_eq!(times.len(), moments, "{script}: {times:?}");
    }
}

#[test]
fn the_glider_is_told_that_conditions_are_not_planned_with() {
    let output = kirk(&["run", "examples/rmpl/glider.rmpl", "--simulate", "--entry", "move"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("K0507"), "{output:?}");
}

/// What a constraint is, and its bound.
type Blamed = (&'static str, f64);

/// A source that is not controllable and what its explanation must name.
const UNCONTROLLABLE: &[(&str, &str, &[Blamed])] = &[
    (
        "two ends forced together",
        "(define-control-program a () (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 5) :contingent t)))
         (define-control-program b () (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 5) :contingent t)))
         (define-control-program main () (parallel (:slack nil) (a) (b)))",
        &[("contingent-lower", 1.0), ("contingent-upper", 5.0)],
    ),
    (
        "a drive in too small a window",
        "(define-control-program drive () (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
         (define-control-program lecture () (declare (primitive) (duration (simple :lower-bound 60 :upper-bound 90))))
         (define-control-program main () (sequence (:slack nil)
           (with-temporal-constraint (simple-temporal :lower-bound 0 :upper-bound 18) (drive))
           (lecture)))",
        &[("requirement-upper", 18.0), ("contingent-upper", 20.0)],
    ),
    (
        "a sample heard too late to act on",
        "(define-control-program sample () (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 30
           :min-observation-delay 5 :max-observation-delay 15) :contingent t)))
         (define-control-program pause () (declare (primitive) (duration (simple :lower-bound 0 :upper-bound 3))))
         (define-control-program store () (declare (primitive) (duration (simple :lower-bound 1 :upper-bound 9))))
         (define-control-program main () (sequence (:slack nil) (sample) (pause) (store)))",
        &[("requirement-upper", 3.0), ("delay-max", 15.0)],
    ),
    (
        "the astronaut within a minute",
        "",
        &[
            ("requirement-upper", 60.0),
            ("requirement-lower", 10.0),
            ("contingent-upper", 30.0),
            ("contingent-upper", 15.0),
            ("contingent-upper", 26.0),
        ],
    ),
];

#[test]
fn what_is_not_controllable_is_explained_by_the_constraints_to_blame() {
    let folder = tempfile::tempdir().unwrap();
    for (name, source, blamed) in UNCONTROLLABLE {
        let source = if source.is_empty() {
            let astronaut = std::fs::read_to_string("examples/rmpl/astronaut.rmpl").unwrap();
            astronaut.replace(":upper-bound 480", ":upper-bound 60")
        } else {
            source.to_string()
        };
        let file = folder.path().join("mission.rmpl");
        std::fs::write(&file, source).unwrap();
        let output = kirk(&["check", file.to_str().unwrap(), "--format", "json"]);
        assert_eq!(output.status.code(), Some(1), "{name}: {output:?}");
        let check: Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(check["controllable"], false, "{name}");
        assert_eq!(check["conservative"], false, "{name}");
        let conflict = check["conflict"].as_array().unwrap();
        for (kind, bound) in *blamed {
            assert!(
                conflict
                    .iter()
                    .any(|member| member["kind"] == *kind && member["bound"].as_f64() == Some(*bound)),
                "{name}: {kind} {bound} is not blamed: {conflict:#?}"
            );
        }
        let sum: f64 = conflict.iter().map(|member| member["amount"].as_f64().unwrap()).sum();
        assert!(sum < 0.0, "{name}");
        // Every one of them can be shown in the source.
        assert!(
            conflict.iter().all(|member| member["span"]["start"]["line"].is_u64()),
            "{name}: {conflict:#?}"
        );
    }
}
