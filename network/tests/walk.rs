//! Walks of conflicts: they lead round, take what the conflict takes, and add up to what it lacks.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

mod oracle;

use std::collections::BTreeMap;

use kirk_network::merge::merge;
use kirk_network::walk::{Step, walk};
use kirk_network::{Part, Verdict, check, json};
use oracle::random::{self, Shape};

#[test]
fn every_conflict_is_a_walk_that_leads_round() {
    let cases = std::env::var("KIRK_CASES").ok().and_then(|cases| cases.parse().ok()).unwrap_or(3_000);
    let shapes =
        [Shape::tiny_delayed(), Shape::tiny_delayed().chained(), Shape::medium(), Shape::medium().chained()];
    let (mut walks, mut by_news) = (0, 0);
    for seed in 0..cases {
        let network = random::network(seed, &shapes[(seed % 4) as usize]);
        let Verdict::Uncontrollable(conflict) = check(&network).unwrap() else { continue };
        let describe = || format!("seed {seed}: {conflict:?}\n{}", random::describe(&network));
        let steps = walk(&network, &conflict).unwrap_or_else(|| panic!("no walk, {}", describe()));
        walks += 1;
        by_news +=
            usize::from(steps.iter().any(|step| matches!(step.part, Part::DelayMin(_) | Part::DelayMax(_))));
        let class = merge(&network).event_of;
        let next = |at: usize| steps[(at + 1) % steps.len()];
        let leads_on = (0..steps.len()).all(|at| class[steps[at].to.index()] == class[next(at).from.index()]);
        assert!(leads_on, "{steps:?}, {}", describe());
        let needs: i64 = steps.iter().map(|step| step.needs.as_micros()).sum();
        assert_eq!(needs, -conflict.total.as_micros(), "{steps:?}, {}", describe());
        let mut taken: BTreeMap<Part, u32> = BTreeMap::new();
        steps.iter().for_each(|step| *taken.entry(step.part).or_default() += 1);
        for share in conflict.members.iter().filter(|share| share.times > 0) {
            let is_step = !matches!(share.part, Part::Join(_) | Part::AfterOrigin);
            assert!(!is_step || taken.get(&share.part) == Some(&share.times), "{share:?}, {}", describe());
        }
    }
    assert!(walks > 500 && by_news > 20, "{walks} walks, {by_news} with news");
}

#[test]
fn the_walk_goes_forward_and_ends_with_what_is_allowed() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "driven", "scanned", "docked"],
        "requirements": [{"from": "scanned", "to": "docked", "lower": 50, "upper": 80},
                         {"from": "z", "to": "docked", "upper": 300}],
        "contingents": [{"from": "z", "to": "driven", "lower": 100, "upper": 200},
                        {"from": "driven", "to": "scanned", "lower": 60, "upper": 120}]}"#;
    let network = json::read(text).unwrap();
    let Verdict::Uncontrollable(conflict) = check(&network).unwrap() else { panic!("370 s are needed") };
    let steps = walk(&network, &conflict).unwrap();
    let told = |step: &Step| format!("{} to {}: {}", network.id(step.from), network.id(step.to), step.needs);
    assert_eq!(
        steps.iter().map(told).collect::<Vec<_>>(),
        ["z to driven: 200", "driven to scanned: 120", "scanned to docked: 50", "docked to z: -300"]
    );
}
