//! Parameters of supported keywords.

use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};
use crate::name;

/// Parameters that are read.
const PARAMETERS: [(&str, &[&str]); 50] = [
    ("NODE", &["NSET", "INPUT", "SYSTEM"]),
    ("ELEMENT", &["TYPE", "ELSET", "INPUT"]),
    (
        "NSET",
        &["NSET", "ELSET", "GENERATE", "INSTANCE", "INTERNAL", "INPUT"],
    ),
    (
        "ELSET",
        &["ELSET", "GENERATE", "INSTANCE", "INTERNAL", "INPUT"],
    ),
    ("SURFACE", &["NAME", "TYPE", "COMBINE", "INTERNAL"]),
    ("PART", &["NAME"]),
    ("END PART", &[]),
    ("ASSEMBLY", &["NAME"]),
    ("END ASSEMBLY", &[]),
    ("INSTANCE", &["NAME", "PART"]),
    ("END INSTANCE", &[]),
    ("MODEL CHANGE", &["TYPE", "ADD", "REMOVE"]),
    ("CHANGE FRICTION", &["INTERACTION"]),
    ("CHANGE SURFACE BEHAVIOR", &["INTERACTION"]),
    ("DISTRIBUTING COUPLING", &["ELSET"]),
    ("MATERIAL", &["NAME"]),
    ("ELASTIC", &["TYPE", "MODULI"]),
    ("EXPANSION", &["TYPE", "ZERO"]),
    ("DENSITY", &[]),
    (
        "SOLID SECTION",
        &["ELSET", "MATERIAL", "ORIENTATION", "COMPOSITE"],
    ),
    ("ORIENTATION", &["NAME", "SYSTEM", "DEFINITION"]),
    ("DISTRIBUTION", &["NAME", "LOCATION", "TABLE"]),
    ("TRANSFORM", &["NSET", "TYPE"]),
    (
        "AMPLITUDE",
        &["NAME", "TIME", "VALUE", "DEFINITION", "USER"],
    ),
    ("INITIAL CONDITIONS", &["TYPE"]),
    ("BOUNDARY", &["OP", "AMPLITUDE", "TYPE", "FIXED"]),
    ("CLOAD", &["OP", "AMPLITUDE"]),
    ("DLOAD", &["OP", "AMPLITUDE"]),
    ("DSLOAD", &["OP", "AMPLITUDE"]),
    ("TEMPERATURE", &["OP", "AMPLITUDE"]),
    ("SURFACE INTERACTION", &["NAME"]),
    ("SURFACE BEHAVIOR", &["PRESSURE-OVERCLOSURE"]),
    ("FRICTION", &[]),
    ("CONTACT PAIR", &["INTERACTION", "TYPE", "ADJUST", "TIED"]),
    (
        "TIE",
        &["NAME", "POSITION TOLERANCE", "ADJUST", "CYCLIC SYMMETRY"],
    ),
    ("EQUATION", &[]),
    ("MPC", &[]),
    (
        "COUPLING",
        &["CONSTRAINT NAME", "REF NODE", "SURFACE", "ORIENTATION"],
    ),
    ("KINEMATIC", &[]),
    ("SPRING", &["ELSET"]),
    ("DISTRIBUTING", &["COUPLING", "WEIGHTING METHOD"]),
    (
        "RIGID BODY",
        &[
            "NSET", "PIN NSET", "TIE NSET", "ELSET", "REF NODE", "ROT NODE",
        ],
    ),
    ("PRE-TENSION SECTION", &["SURFACE", "NODE", "ELEMENT"]),
    ("CYCLIC SYMMETRY MODEL", &["N", "NGRAPH", "TIE", "ELSET"]),
    ("CLEARANCE", &["MASTER", "SLAVE", "VALUE"]),
    ("CONTACT", &["OP"]),
    ("CONTACT INCLUSIONS", &["ALL EXTERIOR"]),
    ("CONTACT PROPERTY ASSIGNMENT", &[]),
    ("STEP", &["NAME", "NLGEOM", "PERTURBATION"]),
    ("STATIC", &["RIKS"]),
];

/// Parameters of these keywords for other than what their blocks mean here; readers refuse them with what they expect.
const REFUSED: [(&str, &[&str]); 4] = [
    // Other than displacements of nodes.
    (
        "BOUNDARY",
        &[
            "USER",
            "SUBMODEL",
            "LOAD CASE",
            "STEP",
            "DATA SET",
            "REGION TYPE",
        ],
    ),
    // Other laws than Coulomb's.
    (
        "FRICTION",
        &[
            "ROUGH",
            "TAUMAX",
            "EXPONENTIAL DECAY",
            "USER",
            "LAGRANGE",
            "ANISOTROPIC",
        ],
    ),
    // Other than a tie of two sides.
    ("TIE", &["MULTISTAGE", "FLUID PERIODIC", "FLUID CYCLIC"]),
    // Other than a constant stiffness along an axis.
    ("SPRING", &["NONLINEAR", "ORIENTATION", "COMPLEX STIFFNESS"]),
];

/// Parameters of these keywords without effect here, as they steer what other programs do on the way to the answer; those
/// that docs/decks.md lists.
const HARMLESS: [(&str, &[&str]); 11] = [
    ("NSET", &["UNSORTED", "FREQUENCY"]),
    ("SURFACE", &["TRIM"]),
    ("MATERIAL", &["RTOL"]),
    ("SOLID SECTION", &["CONTROLS", "OFFSET"]),
    ("CLOAD", &["REGION TYPE"]),
    (
        "SURFACE BEHAVIOR",
        &["PENALTY", "DIRECT", "AUGMENTED LAGRANGE"],
    ),
    ("FRICTION", &["SLIP TOLERANCE"]),
    (
        "CONTACT PAIR",
        &[
            "SMALL SLIDING",
            "EXTENSION ZONE",
            "HCRIT",
            "NO THICKNESS",
            "SMOOTH",
            "SUPPLEMENTARY CONSTRAINTS",
            "CPSET",
            "GEOMETRIC CORRECTION",
            "TRACKING",
            "SLIDING TRANSITION",
            "MECHANICAL CONSTRAINT",
        ],
    ),
    ("TIE", &["TYPE", "NO ROTATION", "NO THICKNESS"]),
    (
        "STEP",
        &[
            "INC",
            "INCR",
            "INCF",
            "AMPLITUDE",
            "EXTRAPOLATION",
            "UNSYMM",
            "CONVERT SDI",
        ],
    ),
    (
        "STATIC",
        &[
            "DIRECT",
            "SOLVER",
            "STABILIZE",
            "ALLSDTOL",
            "CONTINUE",
            "FACTOR",
        ],
    ),
];

/// Types of `*CONTACT PAIR`: ways in which other programs discretize contact.
const PAIRS: [&str; 5] = [
    "NODE TO SURFACE",
    "SURFACE TO SURFACE",
    "MORTAR",
    "LINMORTAR",
    "PGLINMORTAR",
];

/// The parameters of a keyword in a table.
fn of_keyword(
    table: &[(&str, &'static [&'static str])],
    keyword: &str,
) -> Option<&'static [&'static str]> {
    let found = table.iter().find(|(name, _)| *name == keyword);
    found.map(|(_, names)| *names)
}

/// The parameters of a keyword that are known; `None` where parameters don't matter, as of output.
fn known(keyword: &str) -> Option<Vec<&'static str>> {
    let mut names = of_keyword(&PARAMETERS, keyword)?.to_vec();
    names.extend(of_keyword(&REFUSED, keyword).unwrap_or_default());
    names.extend(of_keyword(&HARMLESS, keyword).unwrap_or_default());
    Some(names)
}

/// The first parameter of a block that its reader refuses.
pub(super) fn refused(block: &Block) -> Option<&'static str> {
    let names = of_keyword(&REFUSED, &block.keyword).unwrap_or_default();
    (names.iter().copied()).find(|name| block.parameter(name).is_some())
}

/// A word without blanks, which are insignificant.
fn letters(word: &str) -> String {
    word.replace(' ', "").to_uppercase()
}

/// Replaces parameters by their spelling in these tables.
pub(super) fn spell(block: &mut Block) {
    let Some(known) = known(&block.keyword) else {
        return;
    };
    block.spell_parameters(|name| {
        let same = known.iter().find(|other| letters(other) == letters(name));
        same.copied()
    });
}

/// Refuses unknown parameters of a keyword, and unknown types of contact pairs.
///
/// # Errors
/// An unknown parameter or type, with its line.
pub(super) fn check(source: &Source, block: &Block) -> Result<(), InputError> {
    let keyword = block.keyword.as_str();
    let mut names = block.parameters().map(|(name, _)| name);
    let unknown = known(keyword).and_then(|known| names.find(|name| !known.contains(name)));
    let kind = block.parameter("TYPE").filter(|kind| {
        let is_known = PAIRS.iter().any(|pair| letters(pair) == letters(kind));
        keyword == "CONTACT PAIR" && !is_known
    });
    let parameters: Vec<(&str, &str)> = block.parameters().collect();
    let number = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
    let mut pairs = parameters.windows(2);
    let parted = pairs.find(|pair| number(pair[0].1) && number(pair[1].0));
    if let Some(&[(name, whole), (digits, _)]) = parted {
        let message = format!(
            "*{keyword} has {name}={whole},{digits}; expected a decimal point: {name}={whole}.{digits}"
        );
        return Err(source.error(block.place, message));
    }
    let name = match (unknown, kind) {
        (None, None) => return Ok(()),
        (Some(name), _) => name::shown(name),
        (None, Some(kind)) => format!("TYPE={}", name::shown(kind)),
    };
    let message = format!("*{keyword} with {name} isn't read, and may change the answer");
    Err(source.error(block.place, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_decimal_comma_in_a_parameter_is_answered_with_the_number() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part.inp");
        std::fs::write(&path, "*CLEARANCE, MASTER=A, SLAVE=B, VALUE=0,15\n").unwrap();
        let source = Source::read(&path).unwrap();
        let error = check(&source, &source.blocks[0]).unwrap_err().to_string();
        assert!(
            error.contains("expected a decimal point: VALUE=0.15"),
            "{error}"
        );
    }
}
