//! Parameters of supported keywords.

use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};
use crate::name;

/// Parameters that are read, refused by the reader of the block, or without effect.
const PARAMETERS: [(&str, &[&str]); 39] = [
    ("MODEL CHANGE", &["TYPE", "ADD", "REMOVE"]),
    ("CHANGE FRICTION", &["INTERACTION"]),
    ("CHANGE SURFACE BEHAVIOR", &["INTERACTION"]),
    ("DISTRIBUTING COUPLING", &["ELSET"]),
    ("MATERIAL", &["NAME", "RTOL"]),
    ("ELASTIC", &["TYPE", "MODULI"]),
    ("EXPANSION", &["TYPE", "ZERO"]),
    ("DENSITY", &[]),
    (
        "SOLID SECTION",
        &[
            "ELSET",
            "MATERIAL",
            "ORIENTATION",
            "CONTROLS",
            "COMPOSITE",
            "OFFSET",
        ],
    ),
    ("ORIENTATION", &["NAME", "SYSTEM", "DEFINITION"]),
    ("DISTRIBUTION", &["NAME", "LOCATION", "TABLE"]),
    ("TRANSFORM", &["NSET", "TYPE"]),
    (
        "AMPLITUDE",
        &["NAME", "TIME", "VALUE", "DEFINITION", "USER"],
    ),
    ("INITIAL CONDITIONS", &["TYPE"]),
    (
        "BOUNDARY",
        &[
            "OP",
            "AMPLITUDE",
            "TYPE",
            "FIXED",
            "USER",
            "SUBMODEL",
            "LOAD CASE",
            "STEP",
            "DATA SET",
            "REGION TYPE",
        ],
    ),
    ("CLOAD", &["OP", "AMPLITUDE", "REGION TYPE"]),
    ("DLOAD", &["OP", "AMPLITUDE"]),
    ("DSLOAD", &["OP", "AMPLITUDE"]),
    ("TEMPERATURE", &["OP", "AMPLITUDE"]),
    ("SURFACE INTERACTION", &["NAME"]),
    (
        "SURFACE BEHAVIOR",
        &[
            "PRESSURE-OVERCLOSURE",
            "PENALTY",
            "DIRECT",
            "AUGMENTED LAGRANGE",
        ],
    ),
    (
        "FRICTION",
        &[
            "SLIP TOLERANCE",
            "ROUGH",
            "TAUMAX",
            "EXPONENTIAL DECAY",
            "USER",
            "LAGRANGE",
            "ANISOTROPIC",
        ],
    ),
    (
        "CONTACT PAIR",
        &[
            "INTERACTION",
            "TYPE",
            "SMALL SLIDING",
            "ADJUST",
            "TIED",
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
    (
        "TIE",
        &[
            "NAME",
            "POSITION TOLERANCE",
            "ADJUST",
            "TYPE",
            "NO ROTATION",
            "NO THICKNESS",
            "CYCLIC SYMMETRY",
            "MULTISTAGE",
            "FLUID PERIODIC",
            "FLUID CYCLIC",
        ],
    ),
    ("EQUATION", &[]),
    ("MPC", &[]),
    (
        "COUPLING",
        &["CONSTRAINT NAME", "REF NODE", "SURFACE", "ORIENTATION"],
    ),
    ("KINEMATIC", &[]),
    (
        "SPRING",
        &["ELSET", "NONLINEAR", "ORIENTATION", "COMPLEX STIFFNESS"],
    ),
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
    (
        "STEP",
        &[
            "NAME",
            "NLGEOM",
            "INC",
            "INCR",
            "INCF",
            "PERTURBATION",
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
            "RIKS",
            "STABILIZE",
            "ALLSDTOL",
            "CONTINUE",
            "FACTOR",
        ],
    ),
];

/// Replaces parameters by their spelling in this table: blanks are insignificant.
pub(super) fn spell(block: &mut Block) {
    let letters = |word: &str| word.replace(' ', "");
    let known = PARAMETERS.iter().find(|(name, _)| *name == block.keyword);
    let Some((_, known)) = known else {
        return;
    };
    block.spell_parameters(|name| {
        let same = known.iter().find(|other| letters(other) == letters(name));
        same.copied()
    });
}

/// Refuses unknown parameters of a keyword.
///
/// # Errors
/// An unknown parameter, with its line.
pub(super) fn check(source: &Source, block: &Block) -> Result<(), InputError> {
    let keyword = block.keyword.as_str();
    let known = PARAMETERS.iter().find(|(name, _)| *name == keyword);
    let mut names = block.parameter_names();
    let unknown = known.and_then(|(_, known)| names.find(|name| !known.contains(name)));
    match unknown {
        None => Ok(()),
        Some(name) => {
            let name = name::shown(name);
            let message = format!("*{keyword} with {name} isn't read, and may change the answer");
            Err(source.error(block.place, message))
        }
    }
}
