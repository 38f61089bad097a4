//! Analysis of many bodies. Motions of single bodies that no constraint touches are free; sparse matrices find the
//! other free motions and decide whether contact forces balance the load.

use nalgebra::DVector;

use super::{
    BALANCE_TOLERANCE, FixingDof, LOAD_TOLERANCE, RigidMotions, RigidRow, Scene, WARNED_IMBALANCE,
};
use crate::error::Failure;
use crate::rigid::forces::{Forces, slips};
use crate::rigid::free_motion::FreeMotion;
use crate::rigid::kinematics::Kinematics;
use crate::rigid::many_bodies::{ManyBodies, Rest, SparseRow, jump};
use crate::rigid::proof::proves_sparse;
use crate::rigid::unheld_motions::unheld_motions;
use crate::vector::dot;

/// Number of unknown motions up to which dense matrices decide where sparse ones don't.
const FEW: usize = 300;

/// The contact constraints on the rigid motions of the bodies that they touch.
struct Touched<'a> {
    rows: &'a [RigidRow],
    kinematics: Kinematics,
    sparse: Vec<SparseRow>,
    load: DVector<f64>,
}

/// The balance of a load and the forces of many contacts.
enum Balance {
    /// Contact forces balance the load.
    Holds,
    /// A motion along which the load does more work than contact forces can absorb; true if bodies slide on each other
    /// in it.
    Fails(DVector<f64>, bool),
    /// Neither balance nor its failure is certain.
    Undecided,
}

impl Scene {
    /// The free motions of many bodies, where `scale` is the sum of all loads; `None` if dense matrices are to decide.
    /// Where these would take too long, a load whose imbalance isn't certain is left to the solver.
    pub(super) fn analyse_many(
        &self,
        kinematics: &Kinematics,
        scale: f64,
    ) -> Option<Result<RigidMotions, Failure>> {
        let (bodies, names) = (&self.bodies, &self.names);
        let rows = self.two_sided_rows();
        let (touched, alone) = kinematics.touched(&rows);
        let driven = self.driven_alone(kinematics, &alone);
        let touched = Touched {
            sparse: rows.iter().map(|r| touched.sparse_row(r)).collect(),
            load: touched.load(bodies),
            rows: &rows,
            kinematics: touched,
        };
        let is_driven = |driven: &DVector<f64>| driven.norm() > LOAD_TOLERANCE * scale;
        let nothing_holds = |kinematics: &Kinematics, driven: &DVector<f64>| {
            Some(Err(kinematics.ill_posed(
                bodies,
                names,
                driven,
                "nothing resists it",
            )))
        };
        if is_driven(&driven) {
            return nothing_holds(kinematics, &driven);
        }
        let together = unheld_motions(&touched.kinematics.centers, &touched.sparse);
        let together = match kinematics.len > FEW {
            // After a signal the run ends, and no result is needed.
            true => together.unwrap_or_default(),
            false => together?,
        };
        let mut driven = DVector::zeros(touched.kinematics.len);
        for motion in &together {
            let along = jump(motion, touched.load.as_slice());
            motion.iter().for_each(|&(i, z)| driven[i] += along * z);
        }
        if is_driven(&driven) {
            return nothing_holds(&touched.kinematics, &driven);
        }
        let motions = || {
            let together = together.iter().map(|motion| touched.motion(motion));
            self.fix_all(kinematics, alone, together.collect())
        };
        match touched.balance(scale) {
            Balance::Holds => Some(Ok(motions())),
            Balance::Undecided if kinematics.len > FEW => Some(Ok(motions())),
            Balance::Undecided => None,
            Balance::Fails(motion, is_sliding) => {
                let kinematics = &touched.kinematics;
                Some(Err(match is_sliding {
                    true => kinematics.sliding(bodies, names, &motion),
                    false => {
                        kinematics.ill_posed(bodies, names, &motion, "contact doesn't resist it")
                    }
                }))
            }
        }
    }

    /// The motion driven by the load among free motions of single bodies, `alone`.
    fn driven_alone(&self, kinematics: &Kinematics, alone: &[FreeMotion]) -> DVector<f64> {
        let mut driven = DVector::zeros(kinematics.len);
        for motion in alone {
            let own = motion.bodies.iter();
            let along: f64 = own.map(|(b, z)| dot(z, &self.bodies[*b].load)).sum();
            let own = kinematics.sparse_motion(motion);
            own.iter().for_each(|&(i, z)| driven[i] += along * z);
        }
        driven
    }

    /// The part of the load that normal forces can't balance, if it is more than round-off.
    pub(super) fn unbalanced_part_many(
        &self,
        kinematics: &Kinematics,
        scale: f64,
    ) -> Option<DVector<f64>> {
        let rows = self.two_sided_rows();
        let normals = rows.iter().filter(|row| row.friction.is_none());
        let normals = normals.map(|row| kinematics.sparse_row(row)).collect();
        let load = kinematics.load(&self.bodies);
        let rest = ManyBodies::new(&kinematics.centers, normals)?.residual(load.as_slice())?;
        (rest.unbalanced() > BALANCE_TOLERANCE * scale).then(|| DVector::from_vec(rest.left))
    }

    /// Fixes the free motions of single bodies, `alone`, and those of several bodies, `together`.
    fn fix_all(
        &self,
        kinematics: &Kinematics,
        alone: Vec<FreeMotion>,
        together: Vec<FreeMotion>,
    ) -> RigidMotions {
        let mut motions = alone;
        motions.extend(together);
        // Motions with bodies in common are fixed one after the other.
        let mut part_of_body: Vec<Option<usize>> = vec![None; self.bodies.len()];
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for (k, motion) in motions.iter().enumerate() {
            let own = || motion.bodies.iter().map(|&(b, _)| b);
            let known: Vec<usize> = own().filter_map(|b| part_of_body[b]).collect();
            let part = known.first().copied().unwrap_or(parts.len());
            if part == parts.len() {
                parts.push(Vec::new());
            }
            parts[part].push(k);
            for other in known.into_iter().filter(|&other| other != part) {
                let moved = std::mem::take(&mut parts[other]);
                parts[part].extend(moved);
                (part_of_body.iter_mut().filter(|p| **p == Some(other)))
                    .for_each(|p| *p = Some(part));
            }
            own().for_each(|b| part_of_body[b] = Some(part));
        }
        let fixing_dofs = parts
            .iter()
            .flat_map(|part| self.pins(part.iter().map(|&k| &motions[k])));
        let fixing_dofs = fixing_dofs.collect();
        kinematics.fix(&self.bodies, &self.names, motions, fixing_dofs)
    }

    /// Fixing dofs for motions of few bodies.
    fn pins<'a>(&self, motions: impl Iterator<Item = &'a FreeMotion> + Clone) -> Vec<FixingDof> {
        let mut own: Vec<usize> = motions
            .clone()
            .flat_map(|motion| motion.bodies.iter().map(|&(b, _)| b))
            .collect();
        own.sort_unstable();
        own.dedup();
        let bodies: Vec<_> = own.iter().map(|&b| self.bodies[b].clone()).collect();
        let kinematics = Kinematics::new(self.dim, &bodies);
        let columns = motions.map(|motion| {
            let z = motion.bodies.iter();
            let z = z.filter_map(|(b, z)| Some((own.binary_search(b).ok()?, z.clone())));
            kinematics.unknowns_of(&FreeMotion {
                bodies: z.collect(),
            })
        });
        let columns: Vec<DVector<f64>> = columns.collect();
        match columns.is_empty() {
            true => Vec::new(),
            false => kinematics.fixing_dofs(&bodies, &nalgebra::DMatrix::from_columns(&columns)),
        }
    }
}

impl Touched<'_> {
    /// A motion from its coefficients on the unknowns, body by body.
    fn motion(&self, motion: &SparseRow) -> FreeMotion {
        let mut x = DVector::zeros(self.kinematics.len);
        motion.iter().for_each(|&(i, z)| x[i] = z);
        self.kinematics.motion(&x)
    }

    /// Balance of the load by admissible contact forces, normal ones and friction.
    fn balance(&self, scale: f64) -> Balance {
        if self.kinematics.len == 0 {
            return Balance::Holds;
        }
        let balance = |rows: Vec<SparseRow>| {
            let rest = ManyBodies::new(&self.kinematics.centers, rows)
                .and_then(|bodies| bodies.rest(self.load.as_slice(), &vec![0.0; bodies.len()]));
            rest.is_some_and(|rest| rest.unbalanced() <= WARNED_IMBALANCE * scale)
        };
        let forces = Forces::new(self.rows, |_| true);
        if balance(self.normals())
            || forces.has_friction && balance(forces.cones(&self.sparse, false))
        {
            return Balance::Holds;
        }
        self.fails(&forces, scale).unwrap_or(Balance::Undecided)
    }

    /// A motion that proves that no contact forces balance the load; `None` if none is found.
    fn fails(&self, forces: &Forces, scale: f64) -> Option<Balance> {
        let left = self.residual(forces.cones(&self.sparse, true), &self.load)?;
        let load = self.load.as_slice();
        if left.unbalanced() <= BALANCE_TOLERANCE * scale
            || !proves_sparse(self.rows, &self.sparse, load, scale, &left.left)
        {
            return None;
        }
        let unbalanced = DVector::from_vec(left.left);
        if !forces.has_friction {
            return Some(Balance::Fails(unbalanced, false));
        }
        // The drive is that of few bodies: tangential forces are subtracted from the load, and normal forces balance as
        // much of the rest as they can.
        let held = forces.tangential_of_cones(&left.forces, self.rows.len());
        let mut rest = self.load.clone();
        for (row, held) in self.sparse.iter().zip(held.iter()) {
            row.iter().for_each(|&(i, b)| rest[i] -= b * held);
        }
        let drive = self.residual(self.normals(), &rest)?.left;
        let moved: Vec<f64> = self.sparse.iter().map(|row| jump(row, &drive)).collect();
        Some(match slips(self.rows, &moved) {
            true => Balance::Fails(DVector::from_vec(drive), true),
            false => Balance::Fails(unbalanced, false),
        })
    }

    fn residual(&self, rows: Vec<SparseRow>, load: &DVector<f64>) -> Option<Rest> {
        ManyBodies::new(&self.kinematics.centers, rows)?.residual(load.as_slice())
    }

    fn normals(&self) -> Vec<SparseRow> {
        let rows = self.rows.iter().zip(&self.sparse);
        let normals = rows.filter(|(row, _)| row.friction.is_none());
        normals.map(|(_, sparse)| sparse.clone()).collect()
    }
}
