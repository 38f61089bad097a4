//! A contact law that the program doesn't have: sides with an elastic layer between them, thin and soft.
//!
//! > λ = max(0, t − g) / e
//!
//! instead of λ ≥ 0, t ≤ g, λ (g − t) = 0, with a compliance e for each normal jump (m²/N). It is the
//! unilateral law behind a spring: with τ = t − e λ, the normal jump without what the layer gives way,
//!
//! > λ = G (c − S_tΓ U − H τ) ≥ 0,  τ ≤ g,  λ (g − τ) = 0,  G = (1 + H E)⁻¹,
//!
//! so that the Schur complement on [τ | U] takes the place of that on [t | U], the load with it, and
//! nothing else changes.

use contact_dd_mpi::schur::condensed::Condensed;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The layer between the sides of a pair.
pub struct Layer {
    /// G.
    g: Mat<f64>,
    /// S_Γt E.
    give: Mat<f64>,
}

impl Layer {
    /// The layer of these `compliances` E between the sides of `pair`, of which both triangles are
    /// filled.
    pub fn new(pair: &Condensed, compliances: &[f64]) -> Self {
        let m = pair.jumps;
        let unit = |i, j| f64::from(u8::from(i == j));
        let one_plus_he = Mat::from_fn(m, m, |i, j| unit(i, j) + pair.s[(i, j)] * compliances[j]);
        let interface_dofs = pair.s.nrows() - m;
        Self {
            g: one_plus_he.partial_piv_lu().solve(Mat::from_fn(m, m, unit)),
            give: Mat::from_fn(interface_dofs, m, |i, j| {
                pair.s[(m + i, j)] * compliances[j]
            }),
        }
    }

    /// The Schur complement on [τ | U]: G H, G S_tΓ and S_ΓΓ − S_Γt E G S_tΓ.
    pub fn before(&self, pair: &Condensed) -> Condensed {
        let (m, n) = (pair.jumps, pair.s.nrows());
        let rows = &self.g * pair.s.submatrix(0, 0, m, n);
        let given = &self.give * &rows;
        let mut layered = pair.clone();
        for j in 0..n {
            for i in 0..m {
                layered.s[(i, j)] = rows[(i, j)];
                layered.s[(j, i)] = rows[(i, j)];
            }
        }
        for j in m..n {
            for i in m..n {
                layered.s[(i, j)] -= given[(i - m, j)];
            }
        }
        layered
    }

    /// The load on it: G c and f_Γ − S_Γt E G c.
    pub fn load(&self, load: &[f64]) -> Vec<f64> {
        let (c, f) = load.split_at(self.g.nrows());
        let c = &self.g * Mat::from_fn(c.len(), 1, |i, _| c[i]);
        let given = &self.give * &c;
        let on_traces = f.iter().enumerate().map(|(i, f)| f - given[(i, 0)]);
        (0..c.nrows()).map(|i| c[(i, 0)]).chain(on_traces).collect()
    }
}
