//! Every file in `tests/rmpl/good` is a case by existing: it compiles, and to this network. Each is about one form.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "tests read the cases")]

mod common;

use kirk_compiler::{Explain, Severity, Source, to_sexpr};

#[test]
fn every_form_is_compiled_to_what_it_means() {
    let sources = common::sources("tests/rmpl/good");
    assert!(sources.len() >= 8, "the cases are gone: {sources:?}");
    for (name, text) in sources {
        let compiled = common::compile_with(&text, &common::options_in(&text));
        let said = common::diagnostics(&text, &compiled.diagnostics);
        assert!(compiled.diagnostics.iter().all(|d| d.severity != Severity::Error), "{name}:\n{said}");
        let plan = compiled.lowered.expect("a network");
        let result = format!(
            "{text}\n--- ast\n{}\n--- network\n{}--- diagnostics\n{said}",
            to_sexpr(&compiled.ast).unwrap(),
            common::network(&plan),
        );
        insta::with_settings!({prepend_module_to_snapshot => false, snapshot_path => "snapshots/good", omit_expression => true}, {
            insta::assert_snapshot!(name, result);
        });
    }
}

/// The benchmark of figure 5.2 of the thesis for any number of rovers and antennas.
#[test]
fn the_antennas_have_every_constraint_of_the_figure_for_any_number_of_rovers() {
    let found = common::sources("examples/rmpl").into_iter().find(|(name, _)| name == "antennas");
    let (_, example) = found.expect("the example");
    let lines = example.lines().filter(|line| !line.is_empty() && !line.starts_with(';'));
    assert!(lines.count() < 40);
    for (rovers, antennas) in [(1, 1), (2, 1), (1, 3), (4, 5), (12, 10)] {
        let text = example
            .replace("+rovers+ 8)", &format!("+rovers+ {rovers})"))
            .replace("+antennas+ 2)", &format!("+antennas+ {antennas})"));
        let compiled = common::compile(&text);
        let plan = compiled
            .lowered
            .unwrap_or_else(|| panic!("{}", common::diagnostics(&text, &compiled.diagnostics)));
        let rounds = rovers * antennas;
        assert_eq!(plan.network.contingents().len(), 2 * rounds);
        let across: Vec<String> = (plan.origins.requirements.iter())
            .filter(|origin| origin.kind == kirk_compiler::OriginKind::Between)
            .map(|origin| origin.subject.to_string())
            .collect();
        assert_eq!(across.len(), (rovers - 1) * antennas);
        // The confirmation of rover 1 for antenna 0 comes right after those of rover 0.
        if (rovers, antennas) == (4, 5) {
            assert_eq!(across[0], "from the end of `confirm` to the start of `confirm#6`");
        }
    }
}

#[test]
fn a_conflict_shows_what_between_says() {
    let text = "(define-control-program drive ()
  (declare (primitive) (duration (simple :lower-bound 15 :upper-bound 20) :contingent t)))
(define-control-program main ()
  (sequence (:slack t)
    (label out (drive))
    (delay 5)
    (label back (drive)))
  (between (start out) (start back) (simple-temporal :upper-bound 24)))
";
    let compiled = common::compile(text);
    let plan = compiled.lowered.expect("a network");
    let problems = Explain::of(&plan, &[Source::new("test.rmpl", text)]).all().unwrap();
    insta::assert_snapshot!(common::diagnostics(text, &problems));
}

#[test]
fn label_names_are_names_of_events() {
    let text = "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack t) (label first (a)) (dotimes (i 2) (label (next i) (a))) (label A (a)) (label twice (a)))
  (dotimes (i 1) (label twice (a))))";
    let network = common::compile(text).lowered.expect("a network").network;
    let find = |name| network.find(name).map(|event| network.id(event).to_string());
    assert_eq!(find("first:start").as_deref(), Some("a:start"));
    assert_eq!(find("+FIRST::END+").as_deref(), Some("a:end"));
    assert_eq!(find("next/1:end").as_deref(), Some("a#3:end"));
    assert_eq!(find("a:start").as_deref(), Some("a:start"), "the occurrence has the name, not the label");
    assert_eq!(find("twice:start"), None, "two are called that");
}

#[test]
fn every_activity_of_a_team_has_an_agent_and_what_joins_several_is_nobodys() {
    let text = "(define-team crew (agent rover) (agent base) (link rover base :min-delay 1 :max-delay 2))
(define-control-program dig () (declare (primitive) (agent rover)))
(define-control-program look (who)
  (declare (primitive) (agent who)
    (duration (simple :lower-bound 1 :upper-bound 2) :contingent t :observed-by rover)))
(define-control-program pack () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack t)
    (sequence () (dig) (delay 5))
    (with-agent base (sequence (:slack t) (pack) (dig)))
    (look base)))";
    let lowered = common::compile(text).lowered.expect("a network");
    let (network, team) = (lowered.network, lowered.team.expect("a team"));
    let owner = |name: &str| {
        let event = network.find(name).expect("an event");
        team.owners[event.index()].map(|agent| team.agents[agent as usize].as_str())
    };
    let rovers = ["dig:start", "dig:end", "main.2:start", "main.3:start", "dig#2:end", "look:end"];
    assert!(rovers.iter().all(|event| owner(event) == Some("rover")), "{:?}", rovers.map(owner));
    let bases = ["pack:start", "pack:end", "look:start"];
    assert!(bases.iter().all(|event| owner(event) == Some("base")), "{:?}", bases.map(owner));
    // Also where it was given to somebody.
    assert_eq!(["main:end", "main.1:start", "main.4:start", "main.4:end"].map(owner), [None; 4]);
    let second = kirk_network::Duration::from_secs;
    assert_eq!((team.links[0].delay.min, team.links[0].delay.max.finite()), (second(1), Some(second(2))));
}

#[test]
fn between_takes_the_program_started_from_and_numbered_occurrences() {
    let text = "(define-control-program a () (declare (primitive)))
(define-control-program main ()
  (sequence (:slack t) (a) (a) (a))
  (between (start main) (end main) (simple-temporal :upper-bound 30))
  (between (end a#2) (start a#3) (simple-temporal :lower-bound 5)))";
    let network = common::compile(text).lowered.expect("a network").network;
    let bounds = |from: &str, to: &str| {
        let (from, to) = (network.find(from).expect("an event"), network.find(to).expect("an event"));
        let between = network.requirements().iter().filter(|it| (it.from, it.to) == (from, to));
        between.map(|it| (it.lower.finite(), it.upper.finite())).collect::<Vec<_>>()
    };
    let seconds = |seconds| Some(kirk_network::Duration::from_secs(seconds));
    assert!(bounds("main:start", "main:end").contains(&(seconds(0), seconds(30))));
    assert!(bounds("a#2:end", "a#3:start").contains(&(seconds(5), None)));
}
