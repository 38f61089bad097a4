//! Two spur gears with involute flanks, from a geometry of Gmsh.
//!
//! `gears.msh` is Gmsh's mesh of `gears.geo`, whose first lines contain the command: curved triangles of six nodes.

use super::Shape;

pub(super) const ABOUT: &str =
    "two spur gears meshed by Gmsh, involute flanks of curved quadratic cells";
pub(super) const SUBDOMAINS: usize = 8;
pub(super) const SHAPE: Shape = Shape::Gmsh {
    geometry: include_str!("gears.geo"),
    mesh: include_bytes!("gears.msh"),
};
