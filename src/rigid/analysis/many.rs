//! The analysis of many bodies: motions of one body that no condition touches are free, and sparse matrices show
//! whether the conditions hold all others and balance the load.

use nalgebra::DVector;

use super::{BALANCE_TOLERANCE, LOAD_TOLERANCE, RigidMotions, RigidRow, Scene, UNDECIDED};
use crate::error::Failure;
use crate::rigid::forces::{Forces, slips};
use crate::rigid::free_motion::FreeMotion;
use crate::rigid::kinematics::Kinematics;
use crate::rigid::many_bodies::{ManyBodies, Rest, SparseRow, jump};
use crate::vector::dot;

/// Load that contact can't balance, relative to all loads, that is more than the interior points leave.
const CERTAIN: f64 = 1e-6;

/// The conditions against the motions that they touch.
struct Touched<'a> {
    rows: &'a [RigidRow],
    kinematics: Kinematics,
    sparse: Vec<SparseRow>,
    load: DVector<f64>,
}

impl Scene {
    /// The free motions of many bodies, where all loads are `scale`; nothing where dense matrices alone can tell: where
    /// several bodies have a free motion together, or what holds them is almost nothing.
    pub(super) fn analyse_many(
        &self,
        kinematics: &Kinematics,
        scale: f64,
    ) -> Option<Result<RigidMotions, Failure>> {
        let (bodies, names) = (&self.bodies, &self.names);
        let (touched, alone) = kinematics.touched(&self.rows);
        let mut driven = DVector::zeros(kinematics.len);
        for motion in &alone {
            let own = motion.bodies.iter();
            let along: f64 = own.map(|(b, z)| dot(z, &bodies[*b].load)).sum();
            driven.axpy(along, &kinematics.unknowns_of(motion), 1.0);
        }
        if driven.norm() > LOAD_TOLERANCE * scale {
            let why = "nothing holds it";
            return Some(Err(kinematics.ill_posed(bodies, names, &driven, why)));
        }
        let touched = Touched {
            sparse: self.rows.iter().map(|r| touched.sparse_row(r)).collect(),
            load: touched.load(bodies),
            rows: &self.rows,
            kinematics: touched,
        };
        if touched.are_held()? && touched.are_balanced(scale) {
            return Some(Ok(self.fix_alone(kinematics, alone)));
        }
        let (unbalanced, is_sliding) = touched.unbalanced(scale)?;
        let kinematics = &touched.kinematics;
        Some(Err(match is_sliding {
            true => kinematics.sliding(bodies, names, &unbalanced),
            false => kinematics.ill_posed(bodies, names, &unbalanced, "contact can't hold it"),
        }))
    }

    /// The load that normal forces can't balance, if it is more than round-off.
    pub(super) fn unpressed_many(
        &self,
        kinematics: &Kinematics,
        scale: f64,
    ) -> Option<DVector<f64>> {
        let normals = self.rows.iter().filter(|row| row.friction.is_none());
        let normals = normals.map(|row| kinematics.sparse_row(row)).collect();
        let load = kinematics.load(&self.bodies);
        let rest = ManyBodies::new(&kinematics.centers, normals)?.residual(load.as_slice())?;
        (rest.unbalanced() > BALANCE_TOLERANCE * scale).then(|| DVector::from_vec(rest.left))
    }

    /// Pins motions of single bodies.
    fn fix_alone(&self, kinematics: &Kinematics, alone: Vec<FreeMotion>) -> RigidMotions {
        let mut fixing_dofs = Vec::new();
        for of_body in alone.chunk_by(|one, other| one.bodies[0].0 == other.bodies[0].0) {
            let body = std::slice::from_ref(&self.bodies[of_body[0].bodies[0].0]);
            let kinematics = Kinematics::new(self.dim, body);
            let columns = of_body.iter().map(|motion| {
                let z = motion.bodies.iter().map(|(_, z)| (0, z.clone()));
                kinematics.unknowns_of(&FreeMotion {
                    bodies: z.collect(),
                })
            });
            let columns: Vec<DVector<f64>> = columns.collect();
            let free = nalgebra::DMatrix::from_columns(&columns);
            fixing_dofs.extend(kinematics.fixing_dofs(body, &free));
        }
        kinematics.fix(&self.bodies, &self.names, alone, fixing_dofs)
    }
}

impl Touched<'_> {
    /// Whether the conditions certainly hold every motion that they touch.
    fn are_held(&self) -> Option<bool> {
        let centers = &self.kinematics.centers;
        Some(centers.is_empty() || ManyBodies::new(centers, self.sparse.clone())?.hold_all())
    }

    /// Whether forces that contact can give balance the load: along normals, or with friction.
    fn are_balanced(&self, scale: f64) -> bool {
        if self.kinematics.len == 0 {
            return true;
        }
        let balance = |rows: Vec<SparseRow>| {
            let rest = ManyBodies::new(&self.kinematics.centers, rows)
                .and_then(|bodies| bodies.rest(self.load.as_slice(), &vec![0.0; bodies.len()]));
            rest.is_some_and(|rest| rest.unbalanced() <= UNDECIDED * scale)
        };
        let forces = Forces::new(self.rows, |_| true);
        balance(self.normals()) || forces.has_friction && balance(forces.cones(&self.sparse, false))
    }

    /// The load that contact can't balance, and whether bodies slide under it; nothing where it isn't certain.
    fn unbalanced(&self, scale: f64) -> Option<(DVector<f64>, bool)> {
        let forces = Forces::new(self.rows, |_| true);
        if forces.are_bounded() {
            return None;
        }
        let left = self.residual(forces.cones(&self.sparse, true), &self.load)?;
        if left.unbalanced() <= CERTAIN * scale {
            return None;
        }
        let unbalanced = DVector::from_vec(left.left);
        if !forces.has_friction {
            return Some((unbalanced, false));
        }
        // As a few bodies slip: tangential forces are taken from the load, and normal ones balance what they can.
        let held = forces.tangential_of_cones(&left.forces, self.rows.len());
        let mut rest = self.load.clone();
        for (row, held) in self.sparse.iter().zip(held.iter()) {
            row.iter().for_each(|&(i, b)| rest[i] -= b * held);
        }
        let drive = self.residual(self.normals(), &rest)?.left;
        let moved: Vec<f64> = self.sparse.iter().map(|row| jump(row, &drive)).collect();
        Some(match slips(self.rows, &moved) {
            true => (DVector::from_vec(drive), true),
            false => (unbalanced, false),
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
