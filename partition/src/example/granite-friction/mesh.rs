//! The granite block with friction in its cracks.

use super::{Shape, granite};

pub(super) const ABOUT: &str = "the granite block with friction in its cracks";
pub(super) const SUBDOMAINS: usize = granite::SUBDOMAINS;
pub(super) const SHAPE: Shape = granite::SHAPE;
