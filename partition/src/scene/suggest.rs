//! Suggestions for unknown words.

/// Words of other programs, the equivalent key of a scene, and advice where that key isn't valid.
const FOREIGN_WORDS: [(&str, Option<&str>, &str); 23] = [
    (
        "e modulus youngs emod young_modulus youngs_modulus elastic_modulus elasticity",
        Some("young"),
        "Young's modulus is a material's 'young'",
    ),
    (
        "nu ν pr poissons poisson_ratio poissons_ratio",
        Some("poisson"),
        "Poisson's ratio is a material's 'poisson'",
    ),
    (
        "g shear shear_modulus k bulk bulk_modulus lambda lame",
        None,
        "a material has 'young' and 'poisson': E = 2 G (1 + ν) = 3 K (1 − 2 ν)",
    ),
    (
        "ex ey ez exx eyy ezz e1 e2 e3 gxy gyz gxz g12 g13 g23 nuxy nuyz nuxz nu12 nu13 nu23 orthotropic",
        Some("stiffness"),
        "an anisotropic material has a matrix 'stiffness'",
    ),
    (
        "yield yield_stress sigma_y plastic plasticity hardening",
        None,
        "materials are linearly elastic",
    ),
    (
        "density rho ρ weight acceleration gravity self_weight",
        None,
        "weight is a body's body_force = [0.0, -density*gravity], in space with three numbers",
    ),
    (
        "alpha α cte expansion thermal_expansion temperature",
        Some("thermal"),
        "thermal strain is a body's thermal = { expansion = …, temperature = … }",
    ),
    (
        "prestress insitu in_situ sigma0",
        Some("initial_stress"),
        "in-situ stress is a body's 'initial_stress'",
    ),
    (
        "load loads force forces cload dload neumann point_load point_force",
        Some("body_force"),
        "loads are 'pressure', 'traction', 'force' on nodes and a body's 'body_force'",
    ),
    (
        "support supports fixed fix boundary constraint constraints bc spc dirichlet encastre",
        None,
        "supports are 'displacement' and 'bilateral'",
    ),
    (
        "symmetry roller rollers",
        Some("bilateral"),
        "rollers and planes of symmetry are [[bilateral]]",
    ),
    (
        "mu μ friction friction_coefficient coefficient cof fric",
        Some("friction"),
        "friction is the key 'friction' of a [[contact]]",
    ),
    (
        "master slave primary secondary target source side_a side_b surface_a surface_b",
        Some("sides"),
        "a [[contact]] has two 'sides', the slave first",
    ),
    (
        "clearance offset initial_gap",
        Some("gap"),
        "a prescribed gap is the key 'gap' of a [[contact]]",
    ),
    (
        "penalty penalty_stiffness contact_stiffness normal_stiffness augmented kn",
        None,
        "contact is exact, with no penalty to choose; a compliant [[contact]] has 'stiffness'",
    ),
    (
        "tie tied bonded glue",
        None,
        "ties are [[tie]]; bodies whose meshes share nodes are tied, too",
    ),
    (
        "set nset elset group surface region location where boundaries",
        Some("on"),
        "the place of a condition is its key 'on'",
    ),
    (
        "magnitude amount p",
        Some("value"),
        "the magnitude of a load is its key 'value'",
    ),
    (
        "tol eps epsilon",
        Some("tolerance"),
        "the tolerance is the key 'tolerance' of [solver]",
    ),
    (
        "iterations max_iterations maxiter max_iter",
        Some("max_sweeps"),
        "the largest number of sweeps is the key 'max_sweeps' of [solver]",
    ),
    (
        "dim dimension type analysis",
        Some("plane"),
        "the scene's key 'plane' is \"strain\", \"stress\" or \"axisymmetric\"; in space it has none",
    ),
    (
        "3d space solid",
        None,
        "in space the key 'plane' is left out",
    ),
    ("thickness", None, "forces are per unit of thickness"),
];

/// The candidate with the fewest letters different from `word`, case-insensitive; the first of several.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    candidates
        .into_iter()
        .min_by_key(|candidate| distance(&word, candidate))
}

/// A question or advice for the end of a message about an unknown word, `; did you mean 'young'?`; empty if no known
/// word is similar.
pub fn hint<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let lower = word.to_lowercase();
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let elsewhere =
        (FOREIGN_WORDS.iter()).find(|(words, ..)| words.split(' ').any(|word| word == lower));
    let meant = elsewhere.and_then(|(_, key, _)| key.filter(|key| candidates.contains(key)));
    let like = |candidate: &&str| {
        let known = candidate.to_lowercase();
        let holds = |a: &str, b: &str| b.chars().count() > 2 && a.contains(b);
        holds(&known, &lower)
            || holds(&lower, &known)
            || distance(&lower, candidate) <= word.chars().count().div_ceil(3)
    };
    let near = meant.or_else(|| nearest(word, candidates.into_iter().filter(like)));
    match (near, elsewhere) {
        (Some(near), _) => format!("; did you mean '{near}'?"),
        (None, Some((.., advice))) => format!("; {advice}."),
        (None, None) => String::new(),
    }
}

/// The [`hint`] and all known words.
pub fn hint_and_known<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    if candidates.is_empty() {
        return "; the scene has none".to_owned();
    }
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

    #[test]
    fn words_of_other_programs_are_answered_with_the_key_here_or_its_place() {
        let material = &["young", "poisson", "stiffness", "out_of_plane"][..];
        let contact = &[
            "name", "sides", "between", "gap", "friction", "cohesion", "tresca",
        ][..];
        let body = &["material", "body_force", "initial_stress", "thermal"][..];
        for (word, known, expected) in [
            ("E", material, "did you mean 'young'"),
            ("nu", material, "did you mean 'poisson'"),
            ("mu", contact, "did you mean 'friction'"),
            ("mu", material, "'friction' of a [[contact]]"),
            ("friction", body, "'friction' of a [[contact]]"),
            ("rho", material, "body_force = [0.0, -density*gravity]"),
            ("density", body, "body_force = [0.0, -density*gravity]"),
            ("alpha", body, "did you mean 'thermal'"),
            ("E1", material, "did you mean 'stiffness'"),
            ("master", contact, "did you mean 'sides'"),
            ("clearance", contact, "did you mean 'gap'"),
            ("penalty", contact, "no penalty"),
            ("nset", &["on", "value"], "did you mean 'on'"),
            ("3d", &["strain", "stress"], "'plane' is left out"),
        ] {
            let printed = hint(word, known.iter().copied());
            assert!(printed.contains(expected), "{word}: {printed}");
        }
    }

    #[test]
    fn every_word_of_other_programs_is_answered_once() {
        let mut words: Vec<&str> = FOREIGN_WORDS
            .iter()
            .flat_map(|(words, ..)| words.split(' '))
            .collect();
        words.sort_unstable();
        let twice = words.windows(2).find(|pair| pair[0] == pair[1]);
        assert_eq!(twice, None);
    }
}
