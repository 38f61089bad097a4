//! The known word that an unknown one was probably meant to be.

/// The candidate with the fewest letters different from `word`, capitals aside; the first of
/// several.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    candidates.into_iter().min_by_key(|candidate| {
        strsim::damerau_levenshtein(word.as_str(), candidate.to_lowercase().as_str())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_is_nearer_than_another_word() {
        let keys = ["young", "poisson", "stiffness"];
        assert_eq!(nearest("yuong", keys), Some("young"));
        assert_eq!(nearest("Possion", keys), Some("poisson"));
        assert_eq!(nearest("x", []), None);
    }
}
