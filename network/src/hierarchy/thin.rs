//! Thinning: ways that are no shortest paths are not needed.
//!
//! J. Dibbelt, B. Strasser, D. Wagner, *Customizable contraction hierarchies*, 2016 (perfect customisation).

use super::{Way, Ways};

/// Leaves out most of the ways to which there is a shorter path.
pub(super) fn thin(up: &mut Ways, down: &mut Ways) {
    let mut out = Thinning::new(up);
    let mut into = Thinning::new(down);
    // From the last node to the first: the ways between later nodes are then as short as they get.
    for rank in (0..up.count()).rev() {
        out.shorten(rank, up, down);
        into.shorten(rank, down, up);
    }
    up.retain(&out.needed);
    down.retain(&into.needed);
}

/// For the ways in one direction.
struct Thinning {
    needed: Vec<bool>,
    /// The shortest path known from (or to) the node at hand, by the rank of the other end.
    length: Vec<i64>,
}

impl Thinning {
    fn new(ways: &Ways) -> Thinning {
        Thinning { needed: vec![true; ways.ways.len()], length: vec![i64::MAX; ways.count()] }
    }

    /// Shortens the ways of a node by paths of two, by way of another node of higher rank.
    fn shorten(&mut self, rank: usize, ways: &mut Ways, back: &Ways) {
        // Only triangles over higher ranks: elimination has closed those over lower ones. The ways of the middle are final,
        // as it had its turn. A way as long as a path stays, because its `least` counts.
        for way in ways.of(rank) {
            self.length[way.end as usize] = way.length;
        }
        for first in ways.of(rank) {
            let middle = first.end as usize;
            // From the middle to higher ranks, and from higher ranks to the middle.
            for second in ways.of(middle) {
                let length = &mut self.length[second.end as usize];
                *length = (*length).min(first.length + second.length);
            }
            for second in back.of(middle) {
                let length = self.length[second.end as usize].saturating_add(second.length);
                self.length[middle] = self.length[middle].min(length);
            }
        }
        for at in ways.range(rank) {
            let Way { end, length, .. } = ways.ways[at];
            self.needed[at] = length == self.length[end as usize];
            ways.ways[at].length = self.length[end as usize];
        }
        for way in ways.of(rank) {
            self.length[way.end as usize] = i64::MAX;
            for second in ways.of(way.end as usize) {
                self.length[second.end as usize] = i64::MAX;
            }
        }
    }
}
