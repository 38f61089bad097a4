//! H condensed onto the jumps of a patch; all other jumps are open and eliminated.
//!
//! > H̃ = H_pp − H_po H_oo⁻¹ H_op

use std::cell::RefCell;
use std::rc::Rc;

use faer::linalg::solvers::Llt;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Mat, Par};

use super::active_set::ContactProblem;
use super::open_factor::{factorize, scale_of};

/// The share of jumps in a patch above which condensing doesn't pay.
pub const LARGE: f64 = 0.7;

/// Contact problem that is condensed onto a patch.
#[derive(Debug)]
pub struct CondensedPatch {
    /// The jumps of the patch, ascending.
    pub jumps: Vec<usize>,
    /// The open jumps outside the patch.
    pub open: Vec<usize>,
    /// H_oo = L Lᵀ.
    pub factor: Llt<f64>,
    /// H̃.
    pub h: Mat<f64>,
}

/// The last patch for the same H, on which the next problem is tried first.
#[derive(Clone, Debug, Default)]
pub struct LastPatch(RefCell<Option<Rc<CondensedPatch>>>);

impl CondensedPatch {
    /// H condensed onto these `jumps`; `None` if there are too many, or if holding them leaves the bodies free to move.
    fn new(contact: &ContactProblem<'_>, jumps: Vec<usize>) -> Option<Self> {
        let ContactProblem { h, diagonal, .. } = *contact;
        if jumps.len() as f64 > LARGE * diagonal.len() as f64 {
            return None;
        }
        let is_open = |i: &usize| jumps.binary_search(i).is_err();
        let open: Vec<usize> = (0..diagonal.len()).filter(is_open).collect();
        let part = |rows: &[usize], columns: &[usize]| {
            Mat::from_fn(rows.len(), columns.len(), |a, b| h[(rows[a], columns[b])])
        };
        let scale: Vec<f64> = (open.iter())
            .map(|&i| scale_of(h[(i, i)], diagonal[i]))
            .collect();
        let factor = factorize(part(&open, &open).as_ref(), &scale, 0.0)?;
        let mut coupling = part(&open, &jumps);
        solve_lower_triangular_in_place(factor.L(), coupling.as_mut(), Par::Seq);
        let h = part(&jumps, &jumps) - coupling.transpose() * &coupling;
        Some(Self {
            jumps,
            open,
            factor,
            h,
        })
    }
}

impl LastPatch {
    /// Discards the patch, so that the next problem is solved like the first one.
    pub fn forget(&self) {
        self.0.take();
    }

    /// H condensed onto these `jumps`, the known matrix or a new one; `None` if there are too many, or if holding them
    /// leaves the bodies free to move.
    pub fn condensed(
        &self,
        contact: &ContactProblem<'_>,
        jumps: Vec<usize>,
    ) -> Option<Rc<CondensedPatch>> {
        let mut last = self.0.borrow_mut();
        let known = last.take().filter(|last| last.jumps == jumps);
        let condensed = match known {
            Some(known) => known,
            None => Rc::new(CondensedPatch::new(contact, jumps)?),
        };
        *last = Some(condensed.clone());
        Some(condensed)
    }
}
