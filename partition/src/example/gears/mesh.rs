//! Two spur gears with involute flanks, from a geometry of Gmsh.
//!
//! `gears.msh` is what Gmsh makes of `gears.geo`, whose first lines have the command: curved triangles of
//! six nodes.

use super::{Example, Shape};

pub(super) const EXAMPLE: Example = Example {
    name: "gears",
    about: "two spur gears meshed by Gmsh, involute flanks of curved quadratic cells",
    subdomains: 8,
    scene: include_str!("scene.toml"),
    shape: Shape::Gmsh {
        geometry: include_str!("gears.geo"),
        mesh: include_bytes!("gears.msh"),
    },
};
