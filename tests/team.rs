//! Missions of teams: what is said of them, who executes what, and all of them in one simulation.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod binary;

use binary::{kirk, kirk_with_input, stderr, stdout};
use serde_json::Value;

fn file(name: &str) -> String {
    format!("tests/rmpl/team/{name}.rmpl")
}

/// The one document that a command prints.
fn document(arguments: &[&str]) -> Value {
    let output = kirk(arguments);
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)))
}

#[test]
fn the_verdict_on_a_team_is_yes_with_promises_no_or_not_found() {
    let mut said = String::new();
    for (name, status) in [("drill", 0), ("free", 0), ("not-found", 1), ("no", 1)] {
        let output = kirk(&["check", "--color", "never", &file(name)]);
        assert_eq!(output.status.code(), Some(status), "{name}");
        said.push_str(&format!("{}{}\n", stdout(&output), stderr(&output)));
    }
    insta::assert_snapshot!(said);
}

#[test]
fn what_is_not_found_is_said_to_programs_with_what_would_do() {
    let document = document(&["check", "--format", "json", &file("not-found")]);
    assert_eq!(document["controllable"], false);
    let team = &document["team"];
    assert_eq!((&team["verdict"], &team["missing"]["lacks"]), (&"not-found".into(), &1.into()));
    let link = serde_json::json!([{"from": "astronaut", "to": "robot", "max_delay": 14}]);
    assert_eq!(team["missing"]["remedies"], link);
    assert_eq!(document["diagnostics"][0]["code"], "K0602");
}

#[test]
fn a_between_fixes_a_promise_and_programs_read_it() {
    let promise = |name: &str| {
        let document = document(&["check", "--format", "json", &file(name)]);
        let promises = document["team"]["promises"].as_array().unwrap().clone();
        promises.into_iter().find(|it| it["event"] == "drill:start").unwrap()
    };
    let fixed = promise("drill");
    let wanted = serde_json::json!({"agent": "robot", "event": "drill:start", "base": "downlink:end", "lower": 5, "upper": 15,
        "heard": [{"agent": "astronaut", "delay": [0, 1]}]});
    assert_eq!(fixed, wanted);
    assert_eq!((&promise("free")["base"], &promise("free")["upper"]), (&"main:start".into(), &30.into()));
}

#[test]
fn the_examples_of_the_page_on_missing_promises_are_true() {
    let page = kirk::compiler::explain("K0602").unwrap();
    for (title, status, code) in [("Wrong", 1, true), ("Right", 0, false)] {
        let (_, example) = page.split_once(&format!("\n{title}:\n\n")).unwrap();
        let example: Vec<&str> =
            example.lines().take_while(|line| line.is_empty() || line.starts_with("    ")).collect();
        let output = kirk_with_input(&["check", "-"], example.join("\n").as_bytes());
        assert_eq!(output.status.code(), Some(status), "{title}");
        assert_eq!(stderr(&output).contains("K0602"), code, "{title}");
    }
}

#[test]
fn what_knows_one_executive_refuses_a_team() {
    let drill = file("drill");
    for arguments in [
        vec!["slack", &drill],
        vec!["repair", &drill],
        vec!["query", &drill],
        vec!["check", "--delays", "zero", &drill],
        vec!["compile", "--emit", "dispatchable", &drill],
    ] {
        let output = kirk(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains("error[K0705]"), "{arguments:?}: {}", stderr(&output));
    }
}

#[test]
fn each_agent_has_a_view_in_every_format_and_it_can_be_executed() {
    let drill = file("drill");
    let mut shown = String::new();
    for agent in ["astronaut", "robot"] {
        for emit in ["stnu", "rmpl"] {
            let output = kirk(&["compile", "--agent", agent, "--emit", emit, &drill]);
            assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
            shown.push_str(&format!("; {agent}, {emit}\n{}\n", stdout(&output)));
        }
        let network = kirk(&["compile", "--agent", agent, "--format", "json", &drill]);
        let again = kirk_with_input(&["run", "-", "--simulate"], &network.stdout);
        assert_eq!(again.status.code(), Some(0), "{agent}: {}", stderr(&again));
        for emit in ["ast", "episodes", "reduced", "dispatchable"] {
            let output = kirk(&["compile", "--agent", agent, "--emit", emit, "--format", "json", &drill]);
            assert_eq!(output.status.code(), Some(0), "{agent} {emit}: {}", stderr(&output));
            serde_json::from_str::<Value>(&stdout(&output)).unwrap();
        }
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn the_program_of_a_view_is_the_view() {
    for name in ["drill", "free"] {
        for agent in ["astronaut", "robot"] {
            let output = kirk(&["compile", "--agent", agent, "--format", "json", &file(name)]);
            let view = kirk::network::json::read(&stdout(&output)).unwrap();
            let output = kirk(&["compile", "--agent", agent, "--emit", "rmpl", &file(name)]);
            let source = kirk::Source::new("view", stdout(&output));
            let compilation = kirk::compile(&[source], &kirk::Options::default());
            let program = compilation.lowered.expect("a program").network;
            assert_eq!(distances(&program, &view), distances(&view, &view), "{name} {agent}");
            assert_eq!(links(&program, &view), links(&view, &view), "{name} {agent}");
            let laid_out = kirk_with_input(&["fmt", "-"], &output.stdout);
            assert_eq!(stdout(&laid_out), stdout(&output), "{name} {agent}");
        }
    }
}

/// The event of a network, or of the program that it was written as, in a program under the name of its activity or of its label.
fn event_in(network: &kirk::Network, name: &str) -> usize {
    let plain = name.replace(':', ".");
    let names = [name.to_string(), format!("{plain}:end"), format!("{plain}:start")];
    names.iter().find_map(|name| network.find(name)).expect(name).index()
}

/// From each event of a view to each other the longest and shortest ways, with durations of Nature's as requirements.
fn distances(network: &kirk::Network, view: &kirk::Network) -> Vec<i64> {
    let far = i64::MAX / 4;
    let count = network.events().len();
    let mut ways = vec![vec![far; count]; count];
    for (event, row) in ways.iter_mut().enumerate() {
        row[event] = 0;
        row[network.origin().index()] = 0;
    }
    let mut edge = |from: usize, to: usize, weight: i64| ways[from][to] = ways[from][to].min(weight);
    for (from, to, weight) in network.requirements().iter().flat_map(|it| it.edges()).flatten() {
        edge(from.index(), to.index(), weight.as_micros());
    }
    for link in network.contingents() {
        edge(link.from.index(), link.to.index(), link.upper.as_micros());
        edge(link.to.index(), link.from.index(), -link.lower.as_micros());
    }
    for over in 0..count {
        for from in 0..count {
            for to in 0..count {
                ways[from][to] = ways[from][to].min(ways[from][over] + ways[over][to]).min(far);
            }
        }
    }
    let events: Vec<usize> = view.event_ids().map(|event| event_in(network, view.id(event))).collect();
    events
        .iter()
        .flat_map(|&from| events.iter().map(move |&to| (from, to)))
        .map(|(a, b)| ways[a][b])
        .collect()
}

/// Nature's durations and the delays of their news, by what they end in.
fn links(network: &kirk::Network, view: &kirk::Network) -> Vec<String> {
    let network = &kirk::network::merge::merge(network).network;
    let link = |event| {
        let end = kirk::EventId(event_in(network, view.id(event)) as u32);
        let link = network.link_of(end).map(|link| network.contingents()[link]);
        link.map(|it| format!("{} {} {:?}", it.lower, it.upper, it.delay))
    };
    view.event_ids().map(|event| format!("{} {:?}", view.id(event), link(event))).collect()
}

#[test]
fn the_network_of_a_team_is_no_network_of_one_alone() {
    let output = kirk(&["compile", &file("drill")]);
    assert_eq!(output.status.code(), Some(0));
    assert!(
        stderr(&output).contains("`--agent NAME` prints what one of its agents executes: astronaut, robot")
    );
    let document = document(&["compile", "--quiet", "--format", "json", &file("drill")]);
    assert_eq!(
        (&document["format"], &document["owners"]["drill:end"]),
        (&"kirk-team/1".into(), &"robot".into())
    );
    assert_eq!(document["network"]["format"], "kirk-network/1");
    let refused = kirk_with_input(&["check", "-"], document.to_string().as_bytes());
    assert_eq!(refused.status.code(), Some(2));
    for (arguments, says) in [
        (vec!["compile", "--agent", "robt", "tests/rmpl/team/drill.rmpl"], "(did you mean `robot`?)"),
        (
            vec!["compile", "--agent", "robot", "examples/rmpl/robot.rmpl"],
            "this mission has no `define-team`",
        ),
        (vec!["compile", "--emit", "rmpl", "--format", "dot", "examples/rmpl/robot.rmpl"], "try text"),
    ] {
        let output = kirk(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    }
    let output = kirk(&["compile", "--agent", "robot", &file("not-found")]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("error[K0602]"), "{}", stderr(&output));
}

#[test]
fn the_whole_team_is_simulated_and_what_happened_is_verified() {
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("record.json");
    let record = record.to_str().unwrap();
    let drill = file("drill");
    let verify = || kirk(&["verify", record, &drill]);
    for nature in ["upper", "lower", "random"] {
        for links in ["longest", "shortest", "random", "lossy"] {
            for (strategy, seed) in [("buffer", "1"), ("optimistic", "2")] {
                let options = [
                    "--nature",
                    nature,
                    "--links",
                    links,
                    "--strategy",
                    strategy,
                    "--seed",
                    seed,
                    "--format",
                    "json",
                ];
                let run = kirk(&[&["run", &drill, "--simulate"], &options[..]].concat());
                assert_eq!(run.status.code(), Some(0), "{options:?}: {}", stderr(&run));
                std::fs::write(record, &run.stdout).unwrap();
                let verified = verify();
                assert_eq!(verified.status.code(), Some(0), "{options:?}: {}", stdout(&verified));
            }
        }
    }
    // What is not so is found out, in true time: a start too early, an end of Nature's too late, and news too early and too late.
    let original: Value = serde_json::from_slice(&std::fs::read(record).unwrap()).unwrap();
    let row = |name: &str| {
        original["rows"].as_array().unwrap().iter().position(|row| row["event"] == name).unwrap()
    };
    let number = |value: &Value| value.as_f64().unwrap();
    let mut said = Vec::new();
    for (event, agent, by) in [
        ("drill:start", None, -20.0),
        ("drill:end", None, 20.0),
        ("downlink:end", Some("robot"), -20.0),
        ("downlink:end", Some("robot"), 20.0),
    ] {
        let mut changed = original.clone();
        let at = match agent {
            None => &mut changed["rows"][row(event)]["happened"],
            Some(agent) => &mut changed["rows"][row(event)]["heard"][agent]["at"],
        };
        *at = Value::from((number(at) + by).round());
        std::fs::write(record, changed.to_string()).unwrap();
        let verified = verify();
        assert_eq!(verified.status.code(), Some(1), "{event} {agent:?} {by}");
        said.push(stdout(&verified).lines().next().unwrap().to_string());
    }
    assert!(said[0].contains("`drill:start`") && said[1].contains("`drill:end`"), "{said:?}");
    assert!(
        said[2].contains("robot heard of `downlink:end`") && said[2].contains("cannot before"),
        "{said:?}"
    );
    assert!(said[3].contains("robot heard of `downlink:end` only at"), "{said:?}");
    // Of a team's record only a team's mission knows whether it is kept.
    let alone = kirk(&["verify", record, "examples/rmpl/robot.rmpl"]);
    assert_eq!(alone.status.code(), Some(2));
    std::fs::write(record, r#"{"format": "kirk-team-execution/1", "rows": 3}"#).unwrap();
    assert_eq!(verify().status.code(), Some(2));
}

#[test]
fn the_timetable_says_who_knows_what_when() {
    let mut shown = String::new();
    for options in [&["--nature", "lower"][..], &["--nature", "random", "--seed", "3", "--links", "lossy"]] {
        let output = kirk(&[&["run", &file("drill"), "--simulate", "--quiet"], options].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        shown.push_str(&format!("$ {}\n{}\n", options.join(" "), stdout(&output)));
    }
    insta::assert_snapshot!(shown);
}

#[test]
fn a_team_is_run_whole_or_not_at_all() {
    let drill = file("drill");
    for (arguments, says) in [
        (vec!["run", &drill], "`--simulate` executes all of its agents"),
        (vec!["run", &drill, "--simulate", "--observe", "drill:end@30"], "`--observe` is of one executive"),
        (vec!["run", &drill, "--simulate", "--why"], "`--why` is of one executive"),
        (vec!["run", "examples/rmpl/robot.rmpl", "--simulate", "--links", "random"], "no `define-team`"),
    ] {
        let output = kirk(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(says), "{arguments:?}: {}", stderr(&output));
    }
    for name in ["not-found", "no"] {
        let output = kirk(&["run", &file(name), "--simulate", "--format", "json"]);
        assert_eq!(output.status.code(), Some(1));
        let record: Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(record["failure"]["reason"], "not-controllable");
    }
}

/// When each of these events is decided in the view of an agent that hears of these things then, and how.
fn decided(mission: &str, agent: &str, heard: &[&str], events: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let view = folder.path().join("view.json");
    let view = view.to_str().unwrap();
    let compiled = kirk(&["compile", mission, "--agent", agent, "--format", "json", "-o", view, "--quiet"]);
    assert_eq!(compiled.status.code(), Some(0), "{}", stderr(&compiled));
    let mut arguments = vec!["run", view, "--simulate", "--format", "json"];
    arguments.extend(heard.iter().flat_map(|heard| ["--observe", heard]));
    let record = document(&arguments);
    let row = |name: &&str| {
        let rows = record["rows"].as_array().unwrap();
        let row = rows.iter().find(|row| row["event"] == *name).unwrap_or_else(|| panic!("{name}"));
        format!("{} {}", row["time"], row["how"].as_str().unwrap())
    };
    events.iter().map(row).collect()
}

/// The thesis' section 7.3.2: what was programmed twice by hand there, from one source. Tables 7.5 to 7.8 on every decision.
#[test]
fn both_demonstrations_of_the_thesis_come_from_one_source() {
    let mission = "examples/rmpl/lunar-team.rmpl";
    let (downlinked, drill, drilled) =
        ("human-downlink-science:end", "robot-drilling:start", "robot-drilling:end");
    let by_astronaut = |heard: &[&str]| {
        let closeout = ["human-closeout:start", "human-closeout:end"];
        decided(mission, "astronaut", heard, &[downlinked, drill, drilled, closeout[0], closeout[1]])
    };
    let by_robot = |heard: &[&str]| {
        decided(
            mission,
            "robot",
            heard,
            &[downlinked, drill, drilled, "robot-poweroff:start", "robot-poweroff:end"],
        )
    };
    let heard = ["human-downlink-science:end@16", "robot-drilling:start@23", "robot-drilling:end@49"];
    let first = ["16 observed", "23 observed", "49 observed", "49 dispatched", "59 dispatched"];
    assert_eq!(by_astronaut(&heard), first);
    let heard = ["human-downlink-science:end@22", "robot-drilling:end@46"];
    let first = ["22 observed", "22 dispatched", "46 observed", "46 dispatched", "56 dispatched"];
    assert_eq!(by_robot(&heard), first);
    // In the second nothing is heard from the other.
    let second = ["30 observed", "45 imagined", "71 imagined", "71 dispatched", "81 dispatched"];
    assert_eq!(by_astronaut(&["human-downlink-science:end@30"]), second);
    let second = ["35 imagined", "35 dispatched", "60 observed", "60 dispatched", "70 dispatched"];
    assert_eq!(by_robot(&["robot-drilling:end@60"]), second);
}

/// The two teams of drones: one verdict from one source, whatever the links do.
#[test]
fn the_second_team_of_drones_never_starts_before_the_first_has_landed() {
    let source = std::fs::read_to_string("examples/rmpl/two-teams.rmpl").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("teams.rmpl");
    let file = path.to_str().unwrap();
    let mut waits = Vec::new();
    for delays in ["30 :max-delay 40", "5 :max-delay 5", "0 :max-delay 130", "30 :max-delay :infinity"] {
        let text = source.replace(":min-delay 30 :max-delay 40", &format!(":min-delay {delays}"));
        assert!(text.contains(&format!(":min-delay {delays}")));
        std::fs::write(&path, text).unwrap();
        let check = document(&["check", "--format", "json", file]);
        assert_eq!(check["team"]["verdict"], "yes", "{delays}");
        for nature in ["lower", "upper", "random"] {
            for links in ["longest", "shortest", "lossy"] {
                for seed in ["1", "2", "3"] {
                    let options = ["--nature", nature, "--links", links, "--seed", seed, "--format", "json"];
                    let record = document(&[&["run", file, "--simulate"], &options[..]].concat());
                    assert_eq!(record["outcome"], "completed", "{delays} {options:?}");
                    let rows = record["rows"].as_array().unwrap();
                    let at = |name: &str| {
                        rows.iter().find(|row| row["event"] == name).unwrap()["happened"].as_f64().unwrap()
                    };
                    let landed = at("land:end").max(at("land#2:end"));
                    let started = at("fly#3:start").min(at("fly#4:start"));
                    assert!(started >= landed, "{delays} {options:?}: {started} before {landed}");
                    if (nature, links, seed) == ("lower", "longest", "1") {
                        waits.push(started - landed);
                    }
                }
            }
        }
    }
    // Team two starts when it hears of it; if it may never hear, by the time at which team one has promised to have landed.
    assert_eq!(waits, [40.0, 5.0, 130.0, 599.0]);
    std::fs::write(&path, source.replace("2400", "1261")).unwrap();
    let check = document(&["check", "--format", "json", file]);
    assert_eq!(
        (&check["team"]["verdict"], &check["conflicts"][0]["total"]),
        (&"no".into(), &Value::from(-1))
    );
}
