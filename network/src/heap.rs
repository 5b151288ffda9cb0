//! A priority queue over node numbers with decrease-key: a 4-ary heap with a position index, allocated once.

/// The smallest key first; equal keys in the order of the node numbers, so that nothing depends on chance.
#[derive(Clone, Debug)]
pub(crate) struct Heap {
    /// Heap-ordered (key, node) pairs.
    entries: Vec<(i64, u32)>,
    /// Where each node is in `entries`, or a mark.
    position: Vec<u32>,
    touched: Vec<u32>,
}

const ABSENT: u32 = u32::MAX;
const DONE: u32 = u32::MAX - 1;
const ARITY: usize = 4;

impl Heap {
    /// An empty queue for nodes `0..nodes`.
    pub(crate) fn new(nodes: u32) -> Heap {
        Heap { entries: Vec::new(), position: vec![ABSENT; nodes as usize], touched: Vec::new() }
    }

    /// Forgets everything, in time proportional to what was put in.
    pub(crate) fn clear(&mut self) {
        self.entries.clear();
        for node in self.touched.drain(..) {
            self.position[node as usize] = ABSENT;
        }
    }

    /// Puts `node` in, or lowers its key; false if it is there with a key as low, or was taken out already.
    #[inline]
    pub(crate) fn push(&mut self, node: u32, key: i64) -> bool {
        let at = match self.position[node as usize] {
            DONE => return false,
            ABSENT => {
                self.touched.push(node);
                self.entries.push((key, node));
                self.entries.len() - 1
            }
            at => {
                if self.entries[at as usize].0 <= key {
                    return false;
                }
                self.entries[at as usize].0 = key;
                at as usize
            }
        };
        self.sift_up(at);
        true
    }

    /// Takes out the smallest: (key, node).
    #[inline]
    pub(crate) fn pop(&mut self) -> Option<(i64, u32)> {
        let smallest = *self.entries.first()?;
        self.position[smallest.1 as usize] = DONE;
        let last = self.entries.pop()?;
        if last.1 != smallest.1 {
            self.entries[0] = last;
            self.sift_down(0);
        }
        Some(smallest)
    }

    fn sift_up(&mut self, mut at: usize) {
        let entry = self.entries[at];
        while at > 0 {
            let parent = (at - 1) / ARITY;
            let above = self.entries[parent];
            if !before(entry, above) {
                break;
            }
            self.place(at, above);
            at = parent;
        }
        self.place(at, entry);
    }

    fn sift_down(&mut self, mut at: usize) {
        let entry = self.entries[at];
        loop {
            let first = at * ARITY + 1;
            let children = match self.entries.get(first..) {
                Some(children) if !children.is_empty() => &children[..ARITY.min(children.len())],
                _ => break,
            };
            let (mut child, mut least) = (0, children[0]);
            for (index, &candidate) in children.iter().enumerate().skip(1) {
                if before(candidate, least) {
                    (child, least) = (index, candidate);
                }
            }
            if !before(least, entry) {
                break;
            }
            self.place(at, least);
            at = first + child;
        }
        self.place(at, entry);
    }

    #[inline]
    fn place(&mut self, at: usize, entry: (i64, u32)) {
        self.entries[at] = entry;
        self.position[entry.1 as usize] = at as u32;
    }
}

#[inline]
fn before(a: (i64, u32), b: (i64, u32)) -> bool {
    a.0 < b.0 || a.0 == b.0 && a.1 < b.1
}

#[cfg(test)]
mod tests {
    use super::Heap;

    #[test]
    fn nodes_come_out_by_key_then_number_and_never_twice() {
        let mut heap = Heap::new(10);
        for (node, key) in [(3, 5), (1, 5), (7, -2), (9, 8), (0, 9)] {
            assert!(heap.push(node, key));
        }
        assert!(heap.push(0, 1), "a lower key counts");
        assert!(!heap.push(9, 8), "the same key does not");
        let order: Vec<_> = std::iter::from_fn(|| heap.pop()).collect();
        assert_eq!(order, [(-2, 7), (1, 0), (5, 1), (5, 3), (8, 9)]);
        assert!(!heap.push(7, -10), "taken out is done");
        heap.clear();
        assert!(heap.push(7, -10));
    }
}
