//! Contact between non-matching meshes.

mod order;
mod patch;
mod round;
mod space;
mod system;
