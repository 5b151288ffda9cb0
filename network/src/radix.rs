//! A priority queue for searches whose keys never go down: a radix heap.
//!
//! R. K. Ahuja, K. Mehlhorn, J. B. Orlin, R. E. Tarjan, *Faster algorithms for the shortest path problem*, 1990. An item is
//! in the bucket of the highest bit in which its key differs from the last key taken out, so every item moves at most 64
//! times, and in practice a few. There is no decrease-key: push again and skip what comes out a second time.

/// Items come out by key; equal keys in an order that depends on nothing but the pushes.
#[derive(Clone, Debug)]
pub(crate) struct RadixQueue {
    buckets: [Vec<(u64, u32)>; 64],
    /// Which buckets have items, one bit each.
    filled: u64,
    last: u64,
}

impl RadixQueue {
    /// An empty queue.
    pub(crate) fn new() -> RadixQueue {
        RadixQueue { buckets: std::array::from_fn(|_| Vec::new()), filled: 0, last: 0 }
    }

    /// Forgets everything; keys may start anew from any value of at least `least`.
    pub(crate) fn restart(&mut self, least: i64) {
        while self.filled != 0 {
            self.buckets[self.filled.trailing_zeros() as usize].clear();
            self.filled &= self.filled - 1;
        }
        self.last = code(least);
    }

    /// Puts an item in. The key must not be below the last one taken out.
    #[inline]
    pub(crate) fn push(&mut self, key: i64, item: u32) {
        let key = code(key);
        debug_assert!(key >= self.last, "keys never go down");
        self.insert(key, item);
    }

    #[inline]
    fn insert(&mut self, key: u64, item: u32) {
        // Bucket 0 holds the keys equal to the last one.
        let bucket = (64 - (key ^ self.last).leading_zeros()) as usize;
        self.buckets[bucket].push((key, item));
        self.filled |= 1 << bucket;
    }

    /// Takes out an item with the least key.
    #[inline]
    pub(crate) fn pop(&mut self) -> Option<(i64, u32)> {
        if self.filled == 0 {
            return None;
        }
        let mut first = self.filled.trailing_zeros() as usize;
        if first > 0 && self.buckets[first].len() > 1 {
            self.redistribute(first);
            first = 0;
        }
        // All of bucket 0, or the one item of the first bucket, which is the least of all.
        let bucket = &mut self.buckets[first];
        let (key, item) = bucket.pop()?;
        if bucket.is_empty() {
            self.filled &= !(1 << first);
        }
        self.last = key;
        Some((decode(key), item))
    }

    /// Moves the items of the first bucket that has any to lower ones; the least become bucket 0.
    fn redistribute(&mut self, first: usize) {
        let mut items = std::mem::take(&mut self.buckets[first]);
        self.filled &= !(1 << first);
        self.last = items.iter().map(|&(key, _)| key).min().unwrap_or(self.last);
        for &(key, item) in &items {
            self.insert(key, item);
        }
        items.clear();
        self.buckets[first] = items;
    }
}

/// Keys within a quarter of the range of `i64` as unsigned numbers below 2^63, in order.
#[inline]
fn code(key: i64) -> u64 {
    (key + (1 << 62)) as u64
}

#[inline]
fn decode(code: u64) -> i64 {
    code as i64 - (1 << 62)
}

#[cfg(test)]
mod tests {
    use super::RadixQueue;

    #[test]
    fn items_come_out_by_key_whatever_is_pushed_in_between() {
        let mut queue = RadixQueue::new();
        let mut random = fastrand::Rng::with_seed(7);
        for round in 0..200 {
            queue.restart(-(1 << 40));
            let mut held: Vec<i64> = Vec::new();
            let mut least = -(1 << 40);
            for _ in 0..200 {
                if random.u8(..3) > 0 || held.is_empty() {
                    let bits = random.u8(..30);
                    let key = least + random.i64(0..1 << bits);
                    queue.push(key, round);
                    held.push(key);
                } else {
                    held.sort_unstable();
                    least = held.remove(0);
                    assert_eq!(queue.pop(), Some((least, round)));
                }
            }
            held.sort_unstable();
            for key in held {
                assert_eq!(queue.pop(), Some((key, round)));
            }
            assert_eq!(queue.pop(), None);
        }
    }
}
