//! "Did you mean": the known name closest to an unknown one.

/// How many names are looked at: enough for programs people write.
const MAX_CANDIDATES: usize = 5_000;
/// Longer names are not compared letter by letter.
const MAX_LENGTH: usize = 64;

/// The candidate with the smallest edit distance to `word` (case does not count), if it is close enough to be a slip;
/// else one that begins with it.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let candidates: Vec<&str> = candidates.into_iter().take(MAX_CANDIDATES).collect();
    let slips = candidates.iter().filter_map(|name| Some((slip(&word, &name.to_lowercase())?, *name)));
    slips.min_by_key(|(distance, _)| *distance).map(|(_, name)| name).or_else(|| {
        let begins = |name: &&str| name.len() > word.len() && name.to_lowercase().starts_with(&word);
        candidates.iter().copied().find(|name| word.len() >= 3 && begins(name))
    })
}

/// Insertions, deletions, substitutions and swaps of neighbours that turn one word into the other, if they are few for
/// words of that length.
fn slip(word: &str, name: &str) -> Option<usize> {
    let (a, b) = (word.chars().count(), name.chars().count());
    let most = a.max(b);
    let limit = (most / 3).max(1);
    (most <= MAX_LENGTH && a.abs_diff(b) <= limit)
        .then(|| strsim::osa_distance(word, name))
        .filter(|&distance| distance <= limit && distance < most)
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
        assert_eq!(nearest("", ["a"]), None);
        assert_eq!(nearest("xx", ["a", "x"]), Some("x"));
        assert_eq!(nearest("Sequnce", known), Some("sequence"));
        assert_eq!(nearest("go", ["stop", "GO"]), Some("GO"));
    }
}
