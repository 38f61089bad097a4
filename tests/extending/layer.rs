//! A contact law that the program doesn't have: sides with an elastic layer between them, thin and soft.
//!
//! > λ = max(0, t − g) / e
//!
//! instead of λ ≥ 0, t ≤ g, λ (g − t) = 0, with a compliance e for each approach (m²/N). It is the
//! unilateral law behind a spring: with τ = t − e λ, the approach without what the layer gives way,
//!
//! > λ = G (c − S_tΓ U − H τ) ≥ 0,  τ ≤ g,  λ (g − τ) = 0,  G = (1 + H E)⁻¹,
//!
//! so that the Schur complement on [τ | U] takes the place of that on [t | U], and nothing else changes.

use contact_dd_mpi::schur::condensed::Condensed;
use faer::Mat;
use faer::linalg::solvers::Solve;

/// The Schur complement of a pair, of which both triangles are filled, behind a layer of these
/// `compliances`.
pub fn behind_layer(pair: &Condensed, compliances: &[f64]) -> Condensed {
    let m = pair.approaches;
    let n = pair.s.nrows() - m;
    let h = pair.s.submatrix(0, 0, m, m);
    let one_plus_he = Mat::from_fn(m, m, |i, j| {
        f64::from(u8::from(i == j)) + h[(i, j)] * compliances[j]
    });
    // G [H | S_tΓ | c].
    let right = Mat::from_fn(m, m + n + 1, |i, j| match j < m + n {
        true => pair.s[(i, j)],
        false => pair.load[i],
    });
    let solved = one_plus_he.partial_piv_lu().solve(right);
    let mut layered = pair.clone();
    for i in 0..m {
        for j in 0..m + n {
            layered.s[(i, j)] = solved[(i, j)];
            layered.s[(j, i)] = solved[(i, j)];
        }
        layered.load[i] = solved[(i, m + n)];
    }
    // S_ΓΓ − S_Γt E G S_tΓ, and the load likewise.
    for j in m..m + n {
        for k in 0..m {
            let give = pair.s[(k, j)] * compliances[k];
            for i in m..m + n {
                layered.s[(i, j)] -= give * solved[(k, i)];
            }
            layered.load[j] -= give * solved[(k, m + n)];
        }
    }
    layered
}
