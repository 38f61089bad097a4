//! A cluster: its unknowns [own | shared] with own ones eliminated, and its part of the preconditioner.

use std::collections::BTreeSet;
use std::ops::Range;

use contact_dd_partition::id::OnMergeRoots;
use faer::linalg::triangular_inverse::invert_lower_triangular;
use faer::{Mat, MatMut, Par, Side::Lower};

use crate::bddc::constraints::{Basis, Mechanism, Side};
use crate::bddc::placement::Placement;
use crate::bddc::preconditioner_level::PreconditionerLevel;
use crate::bddc::transform::transformed;
use crate::schur::cluster_schur::ClusterSchur;
use crate::schur::condensed::InterfaceDof;
use crate::schur::symmetric::PackedSymmetric;
use crate::schur::trapezoid::{NotDefinite, Trapezoid};

/// Copies the lower triangle of a symmetric matrix to the upper one.
fn fill_upper_triangle(mut s: MatMut<'_, f64>) {
    // Tiles keep the rows that are written in the cache.
    const TILE: usize = 32;
    let n = s.nrows();
    for first in (0..n).step_by(TILE) {
        for from in (first..n).step_by(TILE) {
            for j in first..n.min(first + TILE) {
                for i in from.max(j + 1)..n.min(from + TILE) {
                    s[(j, i)] = s[(i, j)];
                }
            }
        }
    }
}

/// A vector on the clusters' shared unknowns, by cluster.
pub type Vectors = OnMergeRoots<Vec<f64>>;

/// The unknowns that a cluster shares with others, class after class.
#[derive(Debug)]
pub struct Shared {
    placement: Placement,
    own: Trapezoid<f64>,
    /// The smallest pivot of own unknowns relative to the diagonal entry.
    pub smallest_pivot: f64,
    /// The spring on each unknown of the cluster; empty if there are none.
    springs: Vec<f64>,
    /// A bound on the round-off of S.
    round_off: f64,
}

impl Shared {
    /// A cluster whose unknowns have this `placement`, with a `spring`, relative to the diagonal, on those that are
    /// `sprung`, and its S on shared unknowns.
    ///
    /// # Errors
    /// The cluster can move although its shared unknowns are held.
    pub fn new(
        cluster: &ClusterSchur,
        placement: Placement,
        (sprung, spring): (&BTreeSet<InterfaceDof>, f64),
        par: Par,
    ) -> Result<(Self, Mat<f64>), Mechanism> {
        let mut springs = Vec::new();
        if spring > 0.0 {
            let dofs = cluster.dofs.iter().zip(&cluster.diagonal);
            let has_one = |dof| f64::from(sprung.contains(dof));
            springs.extend(dofs.map(|(dof, d)| spring * d * has_one(dof)));
        }
        let s = transformed(&cluster.s, &springs, &placement.terms, placement.size());
        let diagonal: Vec<f64> = (0..placement.own).map(|i| s[(i, i)]).collect();
        let (own, whole) = Trapezoid::new(s, placement.own, par)?;
        let s = match (placement.own, whole.nrows() - placement.own) {
            (0, _) => whole,
            (first, n) => whole.submatrix(first, first, n, n).to_owned(),
        };
        let shared = Self {
            smallest_pivot: own.smallest_pivot(&diagonal),
            placement,
            own,
            springs,
            round_off: ROUND_OFF * cluster.diagonal.iter().copied().fold(0.0, f64::max),
        };
        Ok((shared, s))
    }

    /// The Schur complement of each class that `is_chosen`, by its index, with all other shared unknowns held and, if
    /// it `uses_energies`, with them free.
    pub fn sides(
        &self,
        s: &Mat<f64>,
        is_chosen: impl Fn(usize) -> bool,
        uses_energies: bool,
        par: Par,
    ) -> Result<Vec<Option<Side>>, Mechanism> {
        let n = s.nrows();
        // The cluster may move as a whole, and may lack some unknowns of a class.
        let held_by = |share: f64| {
            let mut held = s.clone();
            for range in &self.placement.ranges {
                hold(held.as_mut(), range.clone(), share, self.round_off);
            }
            held.llt(Lower).ok()
        };
        let mut inverse = Mat::zeros(0, 0);
        if uses_energies {
            let factor = DIAGONAL_SHIFTS
                .into_iter()
                .find_map(held_by)
                .ok_or(Mechanism)?;
            inverse.resize_with(n, n, |_, _| 0.0);
            invert_lower_triangular(inverse.as_mut(), factor.L(), par);
        }
        let side = |(at, range): (usize, &Range<usize>)| {
            is_chosen(at).then(|| {
                let (first, len) = (range.start, range.len());
                // The cluster may also move with all but this class held; such modes become coarse.
                let mut s = s.submatrix(first, first, len, len).to_owned();
                fill_upper_triangle(s.as_mut());
                hold(s.as_mut(), 0..len, CLASS_SHIFT, self.round_off);
                let compliance = match uses_energies {
                    true => {
                        let columns = inverse.submatrix(first, first, n - first, len);
                        columns.transpose() * columns
                    }
                    false => Mat::zeros(0, 0),
                };
                Side::Whole { s, compliance }
            })
        };
        Ok(self.placement.ranges.iter().enumerate().map(side).collect())
    }
}

/// Share of a cluster's largest stiffness that certainly exceeds the round-off of its S.
const ROUND_OFF: f64 = 1e-14;
/// Shares of the largest diagonal entry, the least of which that makes the matrix definite in spite of round-off is
/// added where unknowns may be free.
const DIAGONAL_SHIFTS: [f64; 3] = [1e-11, 1e-9, 1e-7];
/// Share added to a class's stiffness, far above round-off.
const CLASS_SHIFT: f64 = 1e-9;

/// Adds to the diagonal a share of its largest entry, and a bound on the round-off.
fn hold(mut s: MatMut<'_, f64>, range: Range<usize>, share: f64, round_off: f64) {
    let largest = range.clone().fold(0.0, |m: f64, i| m.max(s[(i, i)]));
    range.for_each(|i| s[(i, i)] += share * largest + round_off);
}

/// The factor of the unknowns that aren't coarse.
#[derive(Debug)]
enum Others {
    Single(Trapezoid<f32>),
    Double(Trapezoid<f64>),
}

impl Others {
    /// Factors in the precision of this `level`, and the Schur complement on the coarse unknowns.
    fn new(
        s: Mat<f64>,
        count: usize,
        level: PreconditionerLevel,
        par: Par,
    ) -> Result<(Self, PackedSymmetric), NotDefinite> {
        let coarse = |whole: &Mat<f64>| PackedSymmetric::trailing(whole, count);
        Ok(match level {
            PreconditionerLevel::Diagonals => {
                let (others, whole) = Trapezoid::new(s, count, par)?;
                (Self::Single(others), coarse(&whole))
            }
            _ => {
                let (others, whole) = Trapezoid::new(s, count, par)?;
                (Self::Double(others), coarse(&whole))
            }
        })
    }

    fn eliminated(&self) -> usize {
        match self {
            Self::Single(others) => others.eliminated(),
            Self::Double(others) => others.eliminated(),
        }
    }

    fn forward(&self, x: &mut [f64]) {
        match self {
            Self::Single(others) => others.forward(x),
            Self::Double(others) => others.forward(x),
        }
    }

    fn backward(&self, x: &mut [f64]) {
        match self {
            Self::Single(others) => others.backward(x),
            Self::Double(others) => others.backward(x),
        }
    }
}

/// A cluster's operator in conjugate gradients and its part of the preconditioner, in the basis of coarse and other
/// unknowns of its classes.
#[derive(Debug)]
pub struct Local {
    /// The unknowns that it shares.
    pub shared: Shared,
    /// The basis and the scaling of every class.
    bases: Vec<Basis>,
    /// Positions of [others | coarse].
    order: Vec<usize>,
    others: Others,
}

impl Local {
    /// A cluster with the bases of its classes, at this `level`, and its Schur complement on coarse unknowns.
    ///
    /// # Errors
    /// The cluster can move although its coarse unknowns are held.
    pub fn new(
        (shared, mut s): (Shared, Mat<f64>),
        bases: Vec<Basis>,
        level: PreconditionerLevel,
        par: Par,
    ) -> Result<(Self, PackedSymmetric), Mechanism> {
        let (mut others, mut coarse) = (Vec::new(), Vec::new());
        for (range, basis) in shared.placement.ranges.iter().zip(&bases) {
            if let Some(q) = &basis.q {
                // The lower triangle alone, with the class's own block as a whole.
                let (first, len) = (range.start, range.len());
                fill_upper_triangle(s.submatrix_mut(first, first, len, len));
                q.multiply_right(s.submatrix_mut(first, first, s.nrows() - first, len));
                q.multiply_right(s.submatrix_mut(first, 0, len, range.end).transpose_mut());
            }
            coarse.extend(range.start..range.start + basis.coarse);
            others.extend(range.start + basis.coarse..range.end);
        }
        let count = others.len();
        others.extend(coarse);
        let order = others;
        let n = order.len();
        let mut permuted = Mat::zeros(n, n);
        for j in 0..n {
            let (of_j, from) = (order[j], s.col_as_slice(order[j]));
            for (to, &i) in permuted.col_as_slice_mut(j)[j..]
                .iter_mut()
                .zip(&order[j..])
            {
                *to = if i >= of_j { from[i] } else { s[(of_j, i)] };
            }
        }
        let factor = |mut held: Mat<f64>, share: f64| {
            hold(held.as_mut(), 0..n, share, 0.0);
            Others::new(held, count, level, par)
        };
        let (last, before) = level.shifts().split_last().ok_or(Mechanism)?;
        let found = before
            .iter()
            .find_map(|&share| factor(permuted.clone(), share).ok());
        let (others, coarse) = match found {
            Some(found) => found,
            None => factor(permuted, *last)?,
        };
        let local = Self {
            shared,
            bases,
            order,
            others,
        };
        Ok((local, coarse))
    }

    /// The ranges of its classes among the shared unknowns.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.shared.placement.ranges
    }

    /// The bases of its classes.
    pub fn bases(&self) -> &[Basis] {
        &self.bases
    }

    /// Condenses a load on the cluster's unknowns: the reduced load on own ones, and the load on shared ones.
    pub fn condense(&self, load: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut f = self.gather(load);
        self.shared.own.forward(&mut f);
        let shared = f.split_off(self.own());
        (f, shared)
    }

    /// The unknowns of the cluster, without constants, from the shared ones.
    pub fn recover(&self, own: &[f64], shared: &[f64]) -> Vec<f64> {
        let mut x = [own, shared].concat();
        self.shared.own.backward(&mut x);
        let of = |terms: &Vec<(usize, f64)>| terms.iter().map(|&(i, c)| c * x[i]).sum();
        self.shared.placement.terms.iter().map(of).collect()
    }

    /// S x on shared unknowns, with the `s` of all unknowns of the cluster.
    pub fn multiply(&self, s: &PackedSymmetric, x: &[f64]) -> Vec<f64> {
        let x = self.recover(&vec![0.0; self.own()], x);
        self.on_shared(&self.forces(s, &x))
    }

    /// The part on shared unknowns of forces on all unknowns of the cluster.
    pub fn on_shared(&self, forces: &[f64]) -> Vec<f64> {
        self.gather(forces).split_off(self.own())
    }

    /// Number of shared unknowns.
    pub fn shared(&self) -> usize {
        self.shared.own.size() - self.own()
    }

    /// The forces (S + springs) x of the cluster, whose S is `s`.
    pub fn forces(&self, s: &PackedSymmetric, x: &[f64]) -> Vec<f64> {
        let mut y = s.multiply(x);
        let springs = self.shared.springs.iter().zip(x);
        y.iter_mut()
            .zip(springs)
            .for_each(|(y, (k, x))| *y += k * x);
        y
    }

    /// Number of unknowns of this cluster alone.
    pub fn own(&self) -> usize {
        self.shared.own.eliminated()
    }

    /// A load on the cluster's unknowns on [own | shared].
    fn gather(&self, load: &[f64]) -> Vec<f64> {
        let mut f = vec![0.0; self.shared.own.size()];
        for (terms, load) in self.shared.placement.terms.iter().zip(load) {
            terms.iter().for_each(|&(i, c)| f[i] += c * load);
        }
        f
    }

    /// The cluster's share of a residual: the reduced load on other unknowns, and the load on coarse ones.
    pub fn share(&self, r: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut scaled = vec![0.0; r.len()];
        for (range, basis) in self.shared.placement.ranges.iter().zip(&self.bases) {
            scaled[range.clone()].copy_from_slice(&basis.share(&r[range.clone()]));
        }
        let mut load: Vec<f64> = self.order.iter().map(|&i| scaled[i]).collect();
        self.others.forward(&mut load);
        let coarse = load.split_off(self.others.eliminated());
        (load, coarse)
    }

    /// The cluster's share of a correction, from its coarse unknowns.
    pub fn correct(&self, mut others: Vec<f64>, coarse: &[f64]) -> Vec<f64> {
        others.extend(coarse);
        self.others.backward(&mut others);
        let mut x = vec![0.0; others.len()];
        self.order
            .iter()
            .zip(others)
            .for_each(|(&i, value)| x[i] = value);
        for (range, basis) in self.shared.placement.ranges.iter().zip(&self.bases) {
            let scaled = basis.correct(&x[range.clone()]);
            x[range.clone()].copy_from_slice(&scaled);
        }
        x
    }
}
