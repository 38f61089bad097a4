//! The model: a scene on its mesh.

mod bodies;
mod contact;
mod corner;
mod diagnostics;
mod invariance;
mod loads;
mod mortar;
mod mortar_discs;
mod obstacle;
mod quadratic;
mod space;
mod steps;
mod supports;
mod touching;
