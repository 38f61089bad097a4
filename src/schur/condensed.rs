//! A node of the hierarchy, condensed onto normal jumps and traces, the unknowns on Γ.

use faer::{Mat, MatRef};
use serde::{Deserialize, Serialize};

/// The Schur complement of a node of the hierarchy on its kept unknowns: normal jumps, then traces on Γ.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Condensed {
    /// Number of normal jumps.
    pub jumps: usize,
    /// Unknowns on Γ, ascending.
    pub interface_dofs: Vec<InterfaceDof>,
    /// S (Pa); only the lower triangle is used.
    #[serde(with = "crate::bytes::lower")]
    pub s: Mat<f64>,
    /// The diagonal of the matrix from which S is condensed (Pa), the scale of S's round-off.
    #[serde(with = "crate::bytes")]
    pub diagonal: Vec<f64>,
    /// The smallest pivot of the eliminated unknowns, relative to its diagonal entry.
    pub smallest_pivot: f64,
}

impl Condensed {
    /// S_tt, on the normal jumps.
    pub fn s_tt(&self) -> MatRef<'_, f64> {
        let m = self.jumps;
        self.s.as_ref().submatrix(0, 0, m, m)
    }

    /// S_tΓ, rows of normal jumps and columns of traces; in the upper triangle.
    pub fn s_t_gamma(&self) -> MatRef<'_, f64> {
        let m = self.jumps;
        self.s
            .as_ref()
            .submatrix(0, m, m, self.interface_dofs.len())
    }

    /// S_ΓΓ: the Schur complement with every contact closed (16).
    pub fn bilateral(&self) -> MatRef<'_, f64> {
        let (m, n) = (self.jumps, self.interface_dofs.len());
        self.s.as_ref().submatrix(m, m, n, n)
    }

    /// The places of its unknowns in a front: those of jumps from `first_jump` on, those of traces by `place`.
    pub fn places(&self, first_jump: usize, place: impl Fn(&InterfaceDof) -> usize) -> Vec<u32> {
        let jumps = (0..self.jumps).map(|j| (first_jump + j) as u32);
        let dofs = self.interface_dofs.iter().map(|dof| place(dof) as u32);
        jumps.chain(dofs).collect()
    }

    /// Copies the lower triangle of S to the upper one.
    pub fn fill_upper_triangle(&mut self) {
        for j in 0..self.s.ncols() {
            for i in j + 1..self.s.nrows() {
                self.s[(j, i)] = self.s[(i, j)];
            }
        }
    }
}

/// An unknown on Γ: the node's number on Γ and the axis of its frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct InterfaceDof {
    /// Number on Γ.
    pub node: u32,
    /// Axis of the node's frame.
    pub axis: u32,
}
