//! "Did you mean": the nearest of some candidates to a word that is not among them.

/// Candidates looked at; a scene may have a million names.
const LOOKED_AT: usize = 10_000;

/// The candidate with the fewest edits to `word`, the first of equals, if at most a third of the word is edited (one
/// edit in a short word). Case does not count.
pub(super) fn nearest<'c>(word: &str, candidates: impl IntoIterator<Item = &'c str>) -> Option<&'c str> {
    let length = word.chars().count();
    // Words of this length are no typing errors, and comparing them costs the square of it.
    if length > 64 {
        return None;
    }
    let allowed = (length / 3).max(1);
    let word = word.to_lowercase();
    let distance = |candidate: &'c str| {
        let near = candidate.chars().count().abs_diff(length) <= allowed;
        near.then(|| strsim::osa_distance(&word, &candidate.to_lowercase())).filter(|&edits| edits <= allowed)
    };
    let near = candidates.into_iter().take(LOOKED_AT).filter_map(|c| distance(c).map(|edits| (edits, c)));
    // `min_by_key` keeps the first of equals.
    near.min_by_key(|&(edits, _)| edits).map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn finds_typing_errors_and_nothing_else() {
        let keys = ["color", "ka", "kd", "ks", "exponent", "transparent"];
        assert_eq!(nearest("colour", keys), Some("color"));
        assert_eq!(nearest("Exponent", keys), Some("exponent"));
        assert_eq!(nearest("trasnparent", keys), Some("transparent"));
        assert_eq!(nearest("kx", keys), Some("ka"));
        assert_eq!(nearest("radius", keys), None);
        assert_eq!(nearest("", keys), None);
        assert_eq!(nearest(&"k".repeat(10_000), keys), None);
    }
}
