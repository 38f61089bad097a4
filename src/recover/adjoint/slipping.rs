//! Slipping points: dependence of their forces on the normal force and the slip, λ_s = M λ_n + Q s + φ.

use contact_dd_partition::id::OnGroups;

use crate::contact::status::FixedStatus;
use crate::fem::contact_group::ContactGroup;
use crate::recover::GroupSolution;

/// The slipping points of a contact group.
#[derive(Clone, Debug, Default)]
pub struct SlippingPoints(pub Vec<SlippingPoint>);

/// A slipping point.
#[derive(Clone, Debug)]
pub struct SlippingPoint {
    /// The normal condition.
    pub normal: usize,
    /// True if the normal condition is closed, so that its jump may depend on the slip.
    pub is_closed: bool,
    /// The slipping conditions and the components e of the slip direction along them.
    pub tangents: Vec<(usize, f64)>,
    /// Coefficient of friction.
    pub coefficient: f64,
    /// κ (N/m): its force turns with the slip.
    pub turning: f64,
    /// True if the matrix of the symmetric problem contains this turning.
    pub turns_in_matrix: bool,
    /// Approximate stiffness of the bodies against a jump (N/m).
    pub stiffness: f64,
    /// The normal force (N/m).
    pub pressing: f64,
    /// The part of the bound without normal force (N/m).
    pub cohesion: f64,
}

impl SlippingPoints {
    /// The slipping points of a group in a solution with forces at their bounds, in these directions; forces turn with
    /// slips `in_matrix`, or by an iteration of their own.
    pub fn new(group: &ContactGroup, solution: &GroupSolution, in_matrix: bool) -> Self {
        let mut all = Vec::new();
        for law in group.point_laws() {
            let here = solution.point(&law);
            let (size, distance) = (here.size(), here.distance());
            let open = law.limits().filter(|&j| !solution.closed[j]);
            let tangents = open.map(|j| (j, solution.forces[j] / size));
            let tangents: Vec<(usize, f64)> = tangents.collect();
            let Some(normal) = law.normal.filter(|_| size > 0.0 && !tangents.is_empty()) else {
                continue;
            };
            let turning = match tangents.len() > 1 && distance > 0.0 {
                true => size / distance,
                false => 0.0,
            };
            all.push(SlippingPoint {
                normal,
                is_closed: law.is_closed(&solution.closed),
                coefficient: law.bound.coefficient,
                turning,
                turns_in_matrix: in_matrix && turning > 0.0,
                tangents,
                stiffness: law.stiffness,
                pressing: solution.forces[normal],
                cohesion: law.bound.cohesion,
            });
        }
        Self(all)
    }

    /// Right-hand side of the transposed problem at these points, where `left` is the residual b_s − B_s w of slipping
    /// conditions: a jump at normal conditions (m), and forces at tangents, over their stiffness (m).
    pub fn wanted(&self, left: &[f64]) -> Vec<f64> {
        let mut wanted = vec![0.0; left.len()];
        for point in &self.0 {
            let along: f64 = point.tangents.iter().map(|&(j, e)| e * left[j]).sum();
            if point.is_closed {
                wanted[point.normal] += point.coefficient * along;
            }
            if point.turning > 0.0 && !point.turns_in_matrix {
                for &(j, e) in &point.tangents {
                    wanted[j] -= point.turning / point.stiffness * (left[j] - e * along);
                }
            }
        }
        wanted
    }

    /// Splits a right-hand side at conditions into jumps, and forces at slipping tangents.
    pub fn split(&self, wanted: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (mut jumps, mut forces) = (wanted.to_vec(), vec![0.0; wanted.len()]);
        for point in &self.0 {
            for &(j, _) in &point.tangents {
                jumps[j] = 0.0;
                forces[j] = point.stiffness * wanted[j];
            }
        }
        (jumps, forces)
    }

    /// Multiplies a vector on conditions by W = e eᵀ + r/(r + κ) (I − e eᵀ) for every point with the stiffness r:
    /// forces that turn with the slip become as large as others.
    pub fn weigh(&self, of: &mut [f64]) {
        let turns = |point: &&SlippingPoint| point.turning > 0.0 && !point.turns_in_matrix;
        for point in self.0.iter().filter(turns) {
            let along: f64 = point.tangents.iter().map(|&(j, e)| e * of[j]).sum();
            let weight = point.stiffness / (point.stiffness + point.turning);
            for &(j, e) in &point.tangents {
                of[j] = e * along + weight * (of[j] - e * along);
            }
        }
    }

    /// Sets the forces at slipping tangents, except those which the matrix contains.
    pub fn set_forces(&self, forces: &[f64], of_group: &mut GroupSolution) {
        let others = self.0.iter().filter(|point| !point.turns_in_matrix);
        for (j, _) in others.flat_map(|point| &point.tangents) {
            of_group.forces[*j] = forces[*j];
        }
    }

    /// Sets the forces which the matrix contains, Q (B_s w − b_s), at the start of a problem; the residual jumps are
    /// those of the group.
    pub fn start_forces(&self, of_group: &mut GroupSolution) {
        for point in self.0.iter().filter(|point| point.turns_in_matrix) {
            let gaps = &of_group.gaps;
            let along: f64 = point.tangents.iter().map(|&(j, e)| e * gaps[j]).sum();
            for &(j, e) in &point.tangents {
                of_group.forces[j] = -point.turning * (of_group.gaps[j] - e * along);
            }
        }
    }

    /// Sets the statuses of the conditions at which the matrix contains forces that turn.
    pub fn set_turning(&self, statuses: &mut [FixedStatus]) {
        for point in self.0.iter().filter(|point| point.turns_in_matrix) {
            for &(j, share) in &point.tangents {
                let turning = point.turning;
                statuses[j] = FixedStatus::Turns { share, turning };
            }
        }
    }
}

/// A number for every condition of the contact groups of this rank.
pub type OnConditions = OnGroups<Vec<f64>>;

/// A change z of the conditions of slipping points, and W (I − G) z.
pub type Direction = (OnConditions, OnConditions);
