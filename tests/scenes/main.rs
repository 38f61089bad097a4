//! The program on whole scenes.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

extern crate contact_dd_trials as support;

mod axisymmetric;
mod bending;
mod compliant;
mod conditioning;
mod convergence;
mod coupling;
mod crack_tips;
mod cyclic;
mod decks;
mod elements;
mod exact;
mod floating;
mod forces;
mod friction;
mod groups;
mod initial_stress;
mod invariance;
mod iterative;
mod laws;
mod monolithic;
mod mortar;
mod moving;
mod obstacles;
mod pretension;
mod quantities;
mod reduced;
mod redundant;
mod released_modes;
mod resultants;
mod space;
mod springs;
mod stability;
mod stages;
mod steps;
mod strains;
mod tie;
mod touching;
mod unloaded;
mod validation;
