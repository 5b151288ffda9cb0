//! "Did you mean": the known name closest to an unknown one.

/// How many names are looked at: enough for programs people write.
const MAX_CANDIDATES: usize = 5_000;

/// The candidate with the smallest edit distance to `word`, if it is close enough to be a slip; else one that begins
/// with it.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let start = word;
    let mut longer: Option<&str> = None;
    let word: Vec<char> = word.chars().take(64).collect();
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates.into_iter().take(MAX_CANDIDATES) {
        if start.len() >= 3
            && longer.is_none()
            && candidate.len() > start.len()
            && candidate.starts_with(start)
        {
            longer = Some(candidate);
        }
        let limit = best.map_or((word.len().max(candidate.len()) / 3).max(1), |(distance, _)| distance);
        let length = candidate.chars().count();
        if length.abs_diff(word.len()) > limit || length > 64 {
            continue;
        }
        let distance = distance(&word, &candidate.chars().collect::<Vec<_>>());
        if best.is_none_or(|(least, _)| distance < least)
            && distance <= limit
            && distance < word.len().min(length)
        {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate).or(longer)
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn one word into the other.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, y) in b.iter().enumerate() {
            let mut least = (last[j] + usize::from(x != y)).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i - 1] == *y && b[j - 1] == *x {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_slip_is_recognised_and_a_different_word_is_not() {
        let known = ["sequence", "parallel", "with-temporal-constraint"];
        assert_eq!(nearest("sequnce", known), Some("sequence"));
        assert_eq!(nearest("paralell", known), Some("parallel"));
        assert_eq!(nearest("seqeunce", known), Some("sequence"));
        assert_eq!(nearest("with-temporal-constrain", known), Some("with-temporal-constraint"));
        assert_eq!(nearest("shower", known), None);
        assert_eq!(nearest("x", ["a", "b"]), None);
        assert_eq!(nearest("wait", ["main"]), None);
        assert_eq!(nearest("seq", ["let", "sequence"]), Some("sequence"));
        assert_eq!(nearest("par", known), Some("parallel"));
        assert_eq!(nearest("", known), None);
    }
}
