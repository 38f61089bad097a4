//! Flops: estimated costs of factorizations.

/// Overhead per unknown of a subdomain beyond its elimination, in flops.
const PER_UNKNOWN: f64 = 3e4;
/// Overhead per entry of a subdomain's S beyond its elimination, in flops: its fronts are small, and kept unknowns pass
/// through many of them.
const PER_ENTRY_OF_SUBDOMAIN: f64 = 900.0;
/// Overhead per entry of a front beyond its elimination, in flops.
const PER_ENTRY_OF_FRONT: f64 = 40.0;

/// The dense matrix of an inner node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Front {
    /// Dofs of the nodes of Γ whose blocks are all under this node, but not all under one child.
    pub eliminated: usize,
    /// Dofs of the other nodes of Γ that the children keep, and contact constraints.
    pub kept: usize,
}

impl Front {
    /// Flops of the partial Cholesky factorization.
    pub fn flops(&self) -> f64 {
        let (e, b) = (self.eliminated as f64, self.kept as f64);
        e * e * e / 3.0 + e * e * b + e * b * b
    }

    /// Estimated time of its factorization, in flops: its arithmetic and overhead.
    pub fn time(&self) -> f64 {
        PER_ENTRY_OF_FRONT * ((self.eliminated + self.kept) as f64).powi(2) + self.flops()
    }

    /// Estimated time of condensing a subdomain, represented by this front.
    pub fn time_to_condense(&self, dim: usize) -> f64 {
        let (eliminated, kept) = (self.eliminated as f64, self.kept as f64);
        let beside = PER_UNKNOWN * eliminated + PER_ENTRY_OF_SUBDOMAIN * kept * kept;
        beside + condensation(eliminated, kept, dim)
    }
}

/// Estimated flops to condense a mesh by nested dissection, with `interior` dofs to be eliminated and `kept` on its
/// boundary: eliminating the interior, and carrying the boundary through fronts as large as the separators.
///
/// In the plane 829/84 n^1.5 multiplications, and as many additions, for n nodes of one dof (George 1973), eight times
/// as many for two dofs. In space eight times the cost of the first separator, with 3 (n/3)^(2/3) dofs in a cube.
pub fn condensation(interior: f64, kept: f64, dim: usize) -> f64 {
    let (alone, separator) = match dim {
        2 => (56.0 * interior.powf(1.5), (2.0 * interior).sqrt()),
        _ => (
            24.0 * interior.powi(2),
            3.0 * (interior / 3.0).powf(2.0 / 3.0),
        ),
    };
    alone + separator * kept * kept + 2.0 * interior * kept
}
