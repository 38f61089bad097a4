//! Local Schur complements: ordering, factorization with the boundary last, condensation and
//! recovery. The only importer of faer's sparse API.

pub mod condensed;
pub mod factor;
pub mod local;
pub mod merge;
pub mod ordering;
pub mod pattern;
