//! Scenes and meshes in the library.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod abaqus;
mod blocks;
#[path = "../../../tests/support/close.rs"]
mod close;
mod curve;
mod deck;
mod decompose;
mod element;
mod example;
mod gmsh;
mod hierarchy;
mod model;
mod problem;
mod problem_scenes;
mod says;
mod scene;
mod table;
