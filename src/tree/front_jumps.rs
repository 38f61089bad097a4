//! The jumps of a contact group in the front where they are eliminated, for a fixed active set.
//!
//! A closed dependent row is an equation that [`ActiveEqualities`] solves for an open jump p of its own,
//!
//! ```text
//! τ = t_p + Σ c t = Σ share·(d − D_C g_C)
//! ```
//!
//! over other open jumps t. The front replaces t_p by τ, a closed jump like any other. The balance at τ is the force
//! there of this row and others.

use std::borrow::Cow;

use crate::contact::active_equalities::ActiveEqualities;
use crate::contact::dependent::DependentConstraints;
use crate::contact::laws::Iterate;
use crate::contact::sharing::ForceSharing;
use crate::schur::substitution::Replaced;

/// The jumps of a group in which closed rows replace open jumps.
#[derive(Clone, Debug, Default)]
pub(super) struct FrontJumps {
    /// D.
    rows: DependentConstraints,
    /// Open limits.
    pub open: Vec<bool>,
    /// The closed rows that are independent of closed jumps.
    equalities: ActiveEqualities,
    /// The shares of other limits' forces in dependent closed rows.
    sharing: ForceSharing,
}

impl FrontJumps {
    /// The jumps of a group with these dependent `rows` and flags of `open` limits.
    pub fn new(rows: &DependentConstraints, open: &[bool]) -> Self {
        let equalities = ActiveEqualities::new(rows, open);
        let mut independent = open.to_vec();
        let m = open.len() - rows.len();
        equalities
            .redundant
            .iter()
            .for_each(|j| independent[m + j] = true);
        Self {
            rows: rows.clone(),
            open: open.to_vec(),
            sharing: ForceSharing::new(rows, &independent, &equalities),
            equalities,
        }
    }

    /// Flags of the jumps that are open in the front.
    pub fn open_in_front(&self) -> Vec<bool> {
        let mut open = self.open[..self.open.len() - self.rows.len()].to_vec();
        for equality in &self.equalities.equalities {
            open[equality.pivot] = false;
        }
        open
    }

    /// The displacements that jumps `replaced`, in terms of the front's jumps.
    pub fn replaced<'r>(&self, replaced: &'r [Replaced]) -> Cow<'r, [Replaced]> {
        if self.equalities.equalities.is_empty() {
            return Cow::Borrowed(replaced);
        }
        let mut replaced = replaced.to_vec();
        for jumps in replaced.iter_mut().map(|replaced| &mut replaced.jumps) {
            for equality in &self.equalities.equalities {
                let own = jumps.iter().find(|(t, _)| *t == equality.pivot);
                let Some(&(_, factor)) = own else { continue };
                for &(other, c) in &equality.others {
                    match jumps.iter_mut().find(|(t, _)| *t == other) {
                        Some((_, known)) => *known -= factor * c,
                        None => jumps.push((other, -factor * c)),
                    }
                }
            }
        }
        Cow::Owned(replaced)
    }

    /// The values of the jumps closed in the front, given the `prescribed` ones of all closed limits (m).
    pub fn closed_values(&self, prescribed: &[f64]) -> Vec<f64> {
        let open = self.open_in_front();
        let both = prescribed.iter().zip(&self.open).take(open.len());
        let known = both.map(|(value, open)| if *open { 0.0 } else { *value });
        let mut values: Vec<f64> = known.collect();
        self.equalities.hold(&self.rows, prescribed, &mut values);
        let all = values.into_iter().zip(open);
        all.filter(|(_, open)| !open)
            .map(|(value, _)| value)
            .collect()
    }

    /// The forces on the jumps open in the front, given those on open limits (N/m).
    pub fn open_forces(&self, of_limits: &[f64]) -> Vec<f64> {
        let mut forces = self.given(of_limits);
        for equality in &self.equalities.equalities {
            for &(other, c) in &equality.others {
                forces[other] -= c * forces[equality.pivot];
            }
        }
        let all = forces.into_iter().zip(self.open_in_front());
        all.filter(|(_, open)| *open)
            .map(|(force, _)| force)
            .collect()
    }

    /// The forces on every jump due to given ones on open limits (N/m).
    fn given(&self, of_limits: &[f64]) -> Vec<f64> {
        let m = self.open.len() - self.rows.len();
        let is_open = |(force, open): (&f64, &bool)| if *open { *force } else { 0.0 };
        let mut forces: Vec<f64> = of_limits.iter().zip(&self.open).map(is_open).collect();
        let of_rows = forces.split_off(m.min(forces.len()));
        forces.resize(m, 0.0);
        for (row, force) in self.rows.iter().zip(of_rows) {
            for &(i, c) in row {
                forces[i] += c * force;
            }
        }
        forces
    }

    /// The jumps and forces of all limits, 0 on open ones, from the jumps of the front and the balance at its closed
    /// ones, with given forces on open limits.
    pub fn answer(&self, mut jumps: Vec<f64>, balance: Vec<f64>, of_limits: &[f64]) -> Iterate {
        let mut forces = balance;
        if self.rows.is_empty() {
            return Iterate { jumps, forces };
        }
        for equality in &self.equalities.equalities {
            let others = equality.others.iter().map(|&(other, c)| c * jumps[other]);
            jumps[equality.pivot] -= others.sum::<f64>();
        }
        let given = self.given(of_limits);
        forces
            .iter_mut()
            .zip(given)
            .for_each(|(force, given)| *force -= given);
        let count = self.rows.len();
        let of_rows = self.equalities.forces(count, |pivot| forces[pivot]);
        self.rows.subtract_transposed(&of_rows, &mut forces);
        for (force, open) in forces.iter_mut().zip(&self.open) {
            *force = if *open { 0.0 } else { *force };
        }
        forces.extend(of_rows);
        self.sharing.share(&mut forces);
        let values: Vec<f64> = (0..count).map(|j| self.rows.value(j, &jumps)).collect();
        jumps.extend(values);
        Iterate { jumps, forces }
    }
}

#[cfg(test)]
mod tests;
