//! Classification of a deck's keywords: read, irrelevant to the solution, or refused with advice.

use std::collections::HashMap;

use super::parameters;
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Source};
use crate::name;
use crate::scene::suggest::nearest;

/// Keywords that are read.
const READ: [&str; 54] = [
    "NODE",
    "ELEMENT",
    "NSET",
    "ELSET",
    "SURFACE",
    "PART",
    "END PART",
    "ASSEMBLY",
    "END ASSEMBLY",
    "INSTANCE",
    "END INSTANCE",
    "MATERIAL",
    "ELASTIC",
    "EXPANSION",
    "DENSITY",
    "SOLID SECTION",
    "ORIENTATION",
    "DISTRIBUTION",
    "TRANSFORM",
    "AMPLITUDE",
    "INITIAL CONDITIONS",
    "BOUNDARY",
    "CLOAD",
    "DLOAD",
    "DSLOAD",
    "TEMPERATURE",
    "SURFACE INTERACTION",
    "SURFACE BEHAVIOR",
    "FRICTION",
    "CONTACT PAIR",
    "CLEARANCE",
    "CONTACT",
    "CONTACT INCLUSIONS",
    "CONTACT PROPERTY ASSIGNMENT",
    "TIE",
    "EQUATION",
    "MPC",
    "COUPLING",
    "KINEMATIC",
    "DISTRIBUTING",
    "RIGID BODY",
    "SPRING",
    "PRE-TENSION SECTION",
    "CYCLIC SYMMETRY MODEL",
    "DISTRIBUTING COUPLING",
    "CHANGE FRICTION",
    "CHANGE SURFACE BEHAVIOR",
    "MODEL CHANGE",
    "STEP",
    "END STEP",
    "STATIC",
    "HEADING",
    "NODE PRINT",
    "EL PRINT",
];

/// Keywords without effect on the solution.
const NOT_NEEDED: [&str; 38] = [
    "CONDUCTIVITY",
    "ELECTRICAL CONDUCTIVITY",
    "SPECIFIC HEAT",
    "GAP CONDUCTANCE",
    "GAP HEAT GENERATION",
    "PHYSICAL CONSTANTS",
    "DAMPING",
    "DAMPING CONTROLS",
    "GLOBAL DAMPING",
    "PREPRINT",
    "RESTART",
    "OUTPUT",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "CONTACT OUTPUT",
    "ENERGY OUTPUT",
    "ELEMENT PRINT",
    "CONTACT PRINT",
    "FACE PRINT",
    "SECTION PRINT",
    "ENERGY PRINT",
    "NODE FILE",
    "EL FILE",
    "CONTACT FILE",
    "ENERGY FILE",
    "FILE FORMAT",
    "FILTER",
    "MONITOR",
    "PRINT",
    "TIME POINTS",
    "CONTROLS",
    "CONTACT CONTROLS",
    "SECTION CONTROLS",
    "DIAGNOSTICS",
    "VISUALIZATION",
    "NO ANALYSIS",
    "SURFACE SMOOTHING",
    "DISTRIBUTION TABLE",
];

const NOT_LINEAR: &str = "bodies are linear elastic here";
const NOT_STATIC: &str = "loads are static here: expected *STATIC";
const NO_DAMPING: &str = "it damps motions, and nothing moves fast under static loads";
const NOT_YET: &str = "isn't supported yet";

/// Keywords that would change the solution: the message, and the advice.
const REFUSED: [(&[&str], &str, &str); 21] = [
    (
        &[
            "PLASTIC",
            "CREEP",
            "VISCOELASTIC",
            "HYPERELASTIC",
            "HYPERFOAM",
            "CYCLIC HARDENING",
            "DEFORMATION PLASTICITY",
            "MOHR COULOMB",
            "DRUCKER PRAGER",
            "CAP PLASTICITY",
            "USER MATERIAL",
            "DEPVAR",
            "RATE DEPENDENT",
            "POTENTIAL",
            "DAMAGE INITIATION",
            "CONCRETE",
            "COHESIVE BEHAVIOR",
            "NO COMPRESSION",
            "NO TENSION",
            "HYPOELASTIC",
            "POROUS ELASTIC",
        ],
        NOT_LINEAR,
        "leave it out, and look whether stresses stay where the material is elastic",
    ),
    (
        &[
            "DYNAMIC",
            "MODAL DYNAMIC",
            "STEADY STATE DYNAMICS",
            "FREQUENCY",
            "COMPLEX FREQUENCY",
            "BUCKLE",
            "VISCO",
            "CFD",
            "ELECTROMAGNETICS",
            "SENSITIVITY",
            "GREEN",
            "SUBSTRUCTURE GENERATE",
            "COUPLED TEMPERATURE-DISPLACEMENT",
            "UNCOUPLED TEMPERATURE-DISPLACEMENT",
            "CRACK PROPAGATION",
            "FEASIBLE DIRECTION",
            "FLUID CONSTANTS",
            "SPECIFIC GAS CONSTANT",
            "OBJECTIVE",
            "CONSTRAINT",
            "MATRIX ASSEMBLE",
            "ROBUST DESIGN",
            "DESIGN VARIABLES",
            "DESIGN RESPONSE",
        ],
        NOT_STATIC,
        "make a deck of the steps that are static",
    ),
    (
        &["HEAT TRANSFER", "FILM", "RADIATE", "CFLUX", "DFLUX"],
        NOT_STATIC,
        "give the temperatures that result, by *TEMPERATURE",
    ),
    (
        &["KINEMATIC COUPLING"],
        "isn't read",
        "give *COUPLING with *KINEMATIC or *DISTRIBUTING",
    ),
    (
        &["CONNECTOR SECTION", "GAP"],
        NOT_YET,
        "give *SPRING of elements of type SPRING1, or a *CONTACT PAIR",
    ),
    (
        &["SELECT CYCLIC SYMMETRY MODES"],
        NOT_STATIC,
        "leave it out: all sectors do the same",
    ),
    (
        &["SHELL SECTION", "MEMBRANE SECTION", "SHELL GENERAL SECTION"],
        "shells and membranes have no stiffness here",
        "mesh the part by solids",
    ),
    (
        &[
            "BEAM SECTION",
            "BEAM GENERAL SECTION",
            "FRAME SECTION",
            "TRUSS SECTION",
            "FLUID SECTION",
        ],
        "beams and trusses aren't computed",
        "mesh the part by solids",
    ),
    (
        &["MASS", "ROTARY INERTIA", "USER ELEMENT"],
        "such elements aren't computed",
        "load the body by *DSLOAD",
    ),
    (
        &[
            "CHANGE CONTACT TYPE",
            "CHANGE MATERIAL",
            "CHANGE SOLID SECTION",
        ],
        "laws are the same in all steps here",
        "give one for all of them, or make a deck with the other from its first step on",
    ),
    (
        &["CONTACT INTERFERENCE"],
        NOT_YET,
        "give a negative *CLEARANCE",
    ),
    (
        &["CONTACT EXCLUSIONS"],
        NOT_YET,
        "name the sides by *CONTACT PAIR",
    ),
    (
        &["SUBMODEL", "GLOBAL"],
        "submodels aren't read",
        "give the displacements by *BOUNDARY",
    ),
    (
        &["BASE MOTION", "BOUNDARYF", "INERTIA RELIEF"],
        NOT_STATIC,
        "leave it out",
    ),
    (&["VALUES AT INFINITY"], NOT_STATIC, "leave it out"),
    (
        &[
            "DASHPOT",
            "CONTACT DAMPING",
            "CONTACT STABILIZATION",
            "SURFACE INTERACTION DAMPING",
            "CONNECTOR DAMPING",
        ],
        NO_DAMPING,
        "leave it out",
    ),
    (
        &["RESTRAINT", "RELEASE", "NORMAL"],
        "shells and beams aren't computed",
        "mesh the part by solids",
    ),
    (
        &[
            "SYSTEM", "NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY",
        ],
        "isn't read",
        "list all nodes and elements, in Cartesian coordinates",
    ),
    (
        &["REFINE MESH", "USE REFINED MESH"],
        "isn't read",
        "give the mesh as fine as it is to be",
    ),
    (
        &["PARAMETER"],
        "isn't read: other lines take its values by <name>",
        "write the values there",
    ),
    (
        &["FIELD", "INITIAL STRAIN INCREASE"],
        "isn't read",
        "give numbers by sets",
    ),
];

/// Replaces the keywords and parameters of blocks by their spelling in these tables: blanks are insignificant.
pub(super) fn spell(blocks: &mut [Block]) {
    let letters = |word: &str| word.replace(' ', "");
    let refused = REFUSED.iter().flat_map(|(names, ..)| *names);
    let known = READ.iter().chain(&NOT_NEEDED).chain(refused);
    let known: HashMap<String, &str> = known.map(|word| (letters(word), *word)).collect();
    for block in blocks {
        if let Some(word) = known.get(&letters(&block.keyword)) {
            block.keyword = (*word).to_owned();
        }
        parameters::spell(block);
    }
}

/// Treatment of a block.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    Read,
    NotNeeded,
}

/// The classification of a block by its keyword.
///
/// # Errors
/// A keyword or a parameter that would change the solution or is unknown, with its line.
pub(super) fn meaning(source: &Source, block: &Block) -> Result<Meaning, InputError> {
    let keyword = block.keyword.as_str();
    if READ.contains(&keyword) {
        parameters::check(source, block)?;
        return Ok(Meaning::Read);
    }
    if NOT_NEEDED.contains(&keyword) {
        return Ok(Meaning::NotNeeded);
    }
    let shown = name::shown(keyword);
    let refused = REFUSED.iter().find(|(names, ..)| names.contains(&keyword));
    let message = match refused {
        Some((_, why, instead)) if why.starts_with("isn't") => {
            format!("*{shown} {why}; instead {instead}")
        }
        Some((_, why, instead)) => format!("*{shown} isn't read: {why}; instead {instead}"),
        None => {
            let others = REFUSED.iter().flat_map(|(names, ..)| *names);
            let known = READ.iter().chain(&NOT_NEEDED).chain(others).copied();
            let near = nearest(keyword, known).filter(|near| near.get(..2) == keyword.get(..2));
            let hint = match near {
                Some(near) => format!("; did you mean *{near}?"),
                None if keyword.contains("DAMP") => {
                    format!("; if it is damping, leave it out: {NO_DAMPING}")
                }
                None => String::new(),
            };
            format!("the keyword *{shown} isn't known, and may change the answer{hint}")
        }
    };
    Err(source.error(block.place, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_keyword_has_one_meaning() {
        let refused = REFUSED.iter().flat_map(|(names, ..)| *names);
        let mut all: Vec<&str> = READ
            .iter()
            .chain(&NOT_NEEDED)
            .chain(refused)
            .copied()
            .collect();
        all.sort_unstable();
        let twice: Vec<&[&str]> = all.windows(2).filter(|pair| pair[0] == pair[1]).collect();
        assert!(twice.is_empty(), "{twice:?}");
    }
}
