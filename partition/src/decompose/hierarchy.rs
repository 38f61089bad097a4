//! What the tree along which Schur complements are merged costs.

mod work;

pub use self::work::Work;
