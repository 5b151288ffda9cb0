//! The benchmark of figure 5.2 by hand: `examples/rmpl/antennas.rmpl` has the structure of `kirk generate repeaters`.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]

use kirk_compiler::{Options, Source, compile};
use kirk_network::generate::{RepeaterOptions, repeaters};
use kirk_network::merge::merge;
use kirk_network::{Delay, Network};

/// The example for other numbers of rovers and antennas.
fn by_hand(rovers: u32, antennas: u32) -> Network {
    let text = std::fs::read_to_string("examples/rmpl/antennas.rmpl").unwrap();
    let lines = text.lines().filter(|line| !line.trim().is_empty() && !line.starts_with(';'));
    assert!(lines.count() < 40, "a planner writes it in under 40 lines");
    let (eight, two) = ("(defconstant +rovers+ 8)", "(defconstant +antennas+ 2)");
    assert!(text.contains(eight) && text.contains(two));
    let text = text
        .replace(eight, &format!("(defconstant +rovers+ {rovers})"))
        .replace(two, &format!("(defconstant +antennas+ {antennas})"));
    let compiled = compile(&[Source::new("antennas.rmpl", text)], &Options::default());
    merge(&compiled.lowered.unwrap_or_else(|| panic!("{:?}", compiled.diagnostics)).network).network
}

/// What makes the figure: how many links there are, how many of them are heard late, and for each end of a test how
/// many starts of tests wait for it.
fn structure(network: &Network) -> (usize, usize, Vec<usize>) {
    let late: Vec<_> = network.contingents().iter().filter(|link| link.delay != Delay::NONE).collect();
    let mut waiting: Vec<usize> = late
        .iter()
        .map(|before| {
            let starts_a_test = |event| late.iter().any(|link| link.from == event);
            let waits = network.requirements().iter().filter(|requirement| {
                requirement.from == before.to
                    && starts_a_test(requirement.to)
                    && requirement.upper.finite().is_none()
            });
            waits.count()
        })
        .collect();
    waiting.sort_unstable();
    (network.contingents().len(), late.len(), waiting)
}

#[test]
fn the_figure_by_hand_has_the_structure_of_the_generated_one() {
    for (rovers, antennas) in [(1, 1), (2, 1), (1, 3), (2, 3), (5, 4), (20, 10)] {
        let all_late = RepeaterOptions { clean_up_at_end: true, ..RepeaterOptions::default() };
        let generated = (0..).find_map(|seed| {
            let network = merge(&repeaters(rovers, antennas, seed, &all_late).unwrap()).network;
            // Delays and durations are drawn; where all differ from 0, the structure is that of the figure.
            let late = network.contingents().iter().filter(|link| link.delay != Delay::NONE).count();
            (late == (rovers * antennas) as usize).then_some(network)
        });
        assert_eq!(
            structure(&by_hand(rovers, antennas)),
            structure(&generated.unwrap()),
            "{rovers} rovers, {antennas} antennas"
        );
    }
}
