//! The known word that an unknown one was probably meant to be.

/// What other programs call what a scene has another word for, or doesn't have.
const ELSEWHERE: [(&str, &str); 7] = [
    ("e modulus youngs", "Young's modulus is 'young'"),
    ("nu ν", "Poisson's ratio is 'poisson'"),
    (
        "density rho gravity weight acceleration",
        "weight is a body's body_force = [0.0, -density*gravity]",
    ),
    (
        "load loads force forces",
        "loads are 'pressure', 'traction' and a body's 'body_force'",
    ),
    (
        "support supports fixed fix boundary constraint dirichlet",
        "supports are 'displacement' and 'bilateral'",
    ),
    ("friction mu μ", "contacts are without friction"),
    (
        "thickness",
        "forces are those of a thickness of 1, and all is in proportion to it",
    ),
];

/// The candidate with the fewest letters different from `word`, capitals aside; the first of
/// several.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    candidates
        .into_iter()
        .min_by_key(|candidate| distance(&word, candidate))
}

/// A question or advice to end a message about an unknown word with, `; did you mean 'young'?`; empty
/// where nothing known is like it.
pub fn hint<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let lower = word.to_lowercase();
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let like = |candidate: &&str| {
        let known = candidate.to_lowercase();
        let holds = |a: &str, b: &str| b.chars().count() > 2 && a.contains(b);
        holds(&known, &lower)
            || holds(&lower, &known)
            || distance(&lower, candidate) <= word.chars().count().div_ceil(3)
    };
    if let Some(near) = nearest(word, candidates.into_iter().filter(like)) {
        return format!("; did you mean '{near}'?");
    }
    (ELSEWHERE.iter())
        .find(|(words, _)| words.split(' ').any(|word| word == lower))
        .map(|(_, advice)| format!("; {advice}."))
        .unwrap_or_default()
}

/// [`hint`] and all that is known.
pub fn hint_and_known<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let hint = hint(word, candidates.iter().copied());
    let stop = if hint.is_empty() { "." } else { "" };
    format!("{hint}{stop} Known here: {}", candidates.join(", "))
}

fn distance(lower: &str, candidate: &str) -> usize {
    strsim::damerau_levenshtein(lower, candidate.to_lowercase().as_str())
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

    #[test]
    fn what_is_like_no_known_word_is_not_taken_for_one() {
        let keys = [
            "title",
            "mesh",
            "displacement",
            "pressure",
            "body_force",
            "x",
        ];
        for (word, expected) in [
            ("presure", "; did you mean 'pressure'?"),
            ("force", "; did you mean 'body_force'?"),
            ("ux", "; did you mean 'x'?"),
            ("punch", ""),
            ("support", "; supports are 'displacement' and 'bilateral'."),
        ] {
            assert_eq!(hint(word, keys), expected, "{word}");
        }
        let other = hint("force", ["title", "mesh"]);
        assert!(other.starts_with("; loads are 'pressure'"), "{other}");
        assert!(hint("E", ["young", "on"]).contains("'young'"));
    }
}
