//! Contact points: the common representation of every contact, from the model through the problem file to the results.
//!
//! Node pairs, mortar and rigid obstacles all produce contact points; the stages after the model don't distinguish
//! them. Side a is the slave side, side b the master side.

use serde::{Deserialize, Serialize};

use crate::element::geometry::{advance, cross, dot, length};

/// A point of a contact: a node of side a with the opposite nodes, a local frame, a gap and a law.
///
/// The jump of the displacements at the point is ⟦u⟧ = Σ weight·u(node), its normal component t = n·⟦u⟧, and there is
/// no penetration as long as t ≤ gap: a row of B u ≤ g. `N` identifies a node: of the mesh, of a subdomain, or of a
/// block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactPoint<N> {
    /// Index of its contact among those of the scene.
    pub contact: u32,
    /// Index within that contact, along the side that carries the constraints.
    pub place: u32,
    /// Nodes and their weights, which sum to 1 on side a, and to −1 on side b; an obstacle has no nodes.
    pub entries: Vec<(N, f64)>,
    /// Directions of the entries of an equation, along which displacements have the weights as coefficients; empty
    /// where all have the directions of the frame.
    pub axes: Vec<[f64; 3]>,
    /// The normal and tangential directions of jumps and forces.
    pub frame: LocalFrame,
    /// The gap g (m), negative for an interference: of the undeformed bodies, or, for a contact activated later,
    /// relative to the position at its activation.
    pub gap: f64,
    /// True if the scene gives the gap, false if it is measured on the mesh, within the round-off of coordinates.
    pub is_gap_given: bool,
    /// The jump ⟦u⟧ at its activation (m), from which slip is measured.
    pub since: [f64; 3],
    /// True if its gap is that of the undeformed bodies although it is activated later.
    pub is_absolute: bool,
    /// Tributary area, the integral of its shape function (m, in space m²): pressure is force over
    /// area.
    pub area: f64,
    /// Undeformed position of its node: that on side a, or the one on side b where it has none on side a (m).
    pub position: [f64; 3],
    /// Point at which its force on side a acts, Σ weight·position over the nodes of side a (m).
    pub force_point: [f64; 3],
    /// Tag of its node on side a; −1 if there are several, as the nodes of side b carry the constraints (mortar).
    pub tag_a: i64,
    /// Tag of its node on side b; −1 for an obstacle, and if there are several, as the nodes of side a carry the
    /// constraints (mortar).
    pub tag_b: i64,
    /// The law that bounds its force.
    pub law: Law,
    /// Contact stiffness along the normal and along the tangents (N/m, per metre of thickness in the plane); 0 for a
    /// rigid contact.
    pub stiffness: [f64; 2],
    /// Displacement of its obstacle in every load step (m); of an equation the change of its value beyond `gap`, along
    /// the axis of its first entry. Empty if nothing moves.
    pub motion: Vec<[f64; 3]>,
    /// Given force on the first point of a pretension in every load step (N, per metre of thickness in the plane);
    /// otherwise empty.
    pub preload: Vec<f64>,
}

/// The bound on the tangential force λ_t at a point, in addition to λ ≥ 0 for the normal force. Below the bound the
/// sides stick; at it they slip, and λ_t opposes the increment of the tangential jump.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Law {
    /// No tangential force.
    #[default]
    Frictionless,
    /// Tresca friction: |λ_t| ≤ bound·area, whether the contact is closed or open.
    Given {
        /// The bound (Pa).
        bound: f64,
    },
    /// Coulomb friction, with cohesion Mohr-Coulomb friction: |λ_t| ≤ coefficient·λ + cohesion·area where the contact
    /// is closed, 0 where it is open.
    Coulomb {
        /// Coefficient of friction.
        coefficient: f64,
        /// Cohesion (Pa).
        cohesion: f64,
    },
    /// A tie: all components of the jump are prescribed, and the force is unbounded.
    Tied,
}

impl Law {
    /// Tresca friction with a nonnegative `bound` (Pa); frictionless if it is 0.
    pub fn given(bound: f64) -> Self {
        match bound > 0.0 {
            true => Self::Given { bound },
            false => Self::Frictionless,
        }
    }

    /// Coulomb friction with a nonnegative `coefficient` and `cohesion` (Pa); frictionless if both are 0.
    pub fn coulomb(coefficient: f64, cohesion: f64) -> Self {
        match coefficient > 0.0 || cohesion > 0.0 {
            true => Self::Coulomb {
                coefficient,
                cohesion,
            },
            false => Self::Frictionless,
        }
    }

    /// True if there are bounded tangential forces.
    pub fn has_friction(&self) -> bool {
        !matches!(self, Self::Frictionless | Self::Tied)
    }

    /// True for a tie, whose forces may have either sign.
    pub fn is_tied(&self) -> bool {
        *self == Self::Tied
    }
}

/// A right-handed orthonormal frame (n, t₁, t₂).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LocalFrame {
    /// n, outward of side a.
    pub normal: [f64; 3],
    /// t₁ and t₂; in the plane t₁ is n rotated by 90° counter-clockwise, and t₂ points out of the plane.
    pub tangents: [[f64; 3]; 2],
}

impl LocalFrame {
    /// The frame of a unit `normal`.
    pub fn new(normal: [f64; 3]) -> Self {
        // The axis with the smallest component along the normal, z first: the plane is z = 0.
        let z = [0.0, 0.0, 1.0];
        let axis = match normal[2].abs() {
            along if along < 0.9 => z,
            _ => [1.0, 0.0, 0.0],
        };
        let along = dot(axis, normal);
        let second: [f64; 3] = std::array::from_fn(|k| axis[k] - along * normal[k]);
        let size = length(second);
        let second = second.map(|c| c / size);
        Self {
            normal,
            tangents: [cross(second, normal), second],
        }
    }
}

impl<N: Copy> ContactPoint<N> {
    /// A frictionless point at `position` on side a, where its force acts, opposite an obstacle or nothing yet; its
    /// contact sets its number.
    pub fn new(entries: Vec<(N, f64)>, normal: [f64; 3], position: [f64; 3], tag_a: i64) -> Self {
        Self {
            contact: 0,
            place: 0,
            entries,
            axes: Vec::new(),
            frame: LocalFrame::new(normal),
            gap: 0.0,
            is_gap_given: false,
            since: [0.0; 3],
            is_absolute: false,
            area: 0.0,
            position,
            force_point: position,
            tag_a,
            tag_b: -1,
            law: Law::Frictionless,
            stiffness: [0.0; 2],
            motion: Vec::new(),
            preload: Vec::new(),
        }
    }

    /// True if its sides overlap under pressure, by their force over the contact stiffness.
    pub fn is_compliant(&self) -> bool {
        self.stiffness[0] > 0.0
    }

    /// The overlap of its sides under a normal force (m); 0 for a rigid contact.
    pub fn overclosure(&self, force: f64) -> f64 {
        match self.is_compliant() {
            true => force / self.stiffness[0],
            false => 0.0,
        }
    }

    /// The tag of the node that carries the constraint.
    pub fn tag(&self) -> i64 {
        match self.tag_a {
            -1 => self.tag_b,
            tag => tag,
        }
    }

    /// n.
    pub fn normal(&self) -> [f64; 3] {
        self.frame.normal
    }

    /// True if it is a linear equation between displacements, with a single constraint.
    pub fn is_equation(&self) -> bool {
        !self.axes.is_empty()
    }

    /// The tangents with constraints, in `dim` dimensions; none without friction or tie.
    pub fn tangents(&self, dim: usize) -> &[[f64; 3]] {
        match self.law == Law::Frictionless || self.is_equation() {
            false => &self.frame.tangents[..dim - 1],
            true => &[],
        }
    }

    /// Number of its jumps that are unknowns of the contact problem, in `dim` dimensions: those of a tie are known.
    pub fn unknown_jumps(&self, dim: usize) -> usize {
        match self.law.is_tied() {
            true => 0,
            false => self.directions(dim).count(),
        }
    }

    /// The directions of its constraints: its normal, and its tangents with friction or for a tie.
    pub fn directions(&self, dim: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        std::iter::once(self.normal()).chain(self.tangents(dim).iter().copied())
    }

    /// The directions of its constraints on the displacement of entry i.
    pub fn directions_at(&self, i: usize, dim: usize) -> impl Iterator<Item = [f64; 3]> + '_ {
        let normal = self.axes.get(i).copied().unwrap_or(self.normal());
        std::iter::once(normal).chain(self.tangents(dim).iter().copied())
    }

    /// Row of B: every node with weight·n.
    pub fn row(&self) -> impl Iterator<Item = (N, [f64; 3])> + Clone {
        self.row_along(self.frame.normal)
    }

    /// The row of its jump along a `direction`: every node with weight·direction, or for an equation along the axes of
    /// its entries.
    pub fn row_along(&self, direction: [f64; 3]) -> impl Iterator<Item = (N, [f64; 3])> + Clone {
        let entries = self.entries.iter().enumerate();
        entries.map(move |(i, &(node, weight))| {
            let along = self.axes.get(i).copied().unwrap_or(direction);
            (node, along.map(|n| n * weight))
        })
    }

    /// This point with renamed nodes; entries without a new name are removed.
    pub fn rename<M>(&self, mut name: impl FnMut(N) -> Option<M>) -> ContactPoint<M> {
        let entries = self.entries.iter();
        ContactPoint {
            entries: entries
                .filter_map(|&(node, weight)| Some((name(node)?, weight)))
                .collect(),
            axes: self.axes.clone(),
            contact: self.contact,
            place: self.place,
            frame: self.frame,
            gap: self.gap,
            is_gap_given: self.is_gap_given,
            since: self.since,
            is_absolute: self.is_absolute,
            area: self.area,
            position: self.position,
            force_point: self.force_point,
            tag_a: self.tag_a,
            tag_b: self.tag_b,
            law: self.law,
            stiffness: self.stiffness,
            motion: self.motion.clone(),
            preload: self.preload.clone(),
        }
    }
}

/// A node of the side without constraints, at which a solution is checked for penetration.
///
/// Without penetration the jump along its normal, n·Σ weight·u(node), is at most the gap.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe<N> {
    /// Index of its contact among those of the scene.
    pub contact: u32,
    /// Tag of its node.
    pub tag: i64,
    /// The node with weight 1, and the nodes of the opposite facet, whose weights sum to −1.
    pub entries: Vec<(N, f64)>,
    /// Outward normal of its side.
    pub normal: [f64; 3],
    /// The gap of the undeformed bodies along the normal (m).
    pub gap: f64,
}

impl ContactPoint<u32> {
    /// This point with sides a and b exchanged: weights, normal and tags. `on_a` is true for the nodes of the new side
    /// a, `at` returns their positions (m).
    pub fn turned(self, on_a: impl Fn(u32) -> bool, at: impl Fn(u32) -> [f64; 3]) -> Self {
        let entries: Vec<_> = self
            .entries
            .iter()
            .map(|&(n, weight)| (n, -weight))
            .collect();
        let of_a = entries.iter().filter(|&&(node, _)| on_a(node));
        let force_point = of_a.fold([0.0; 3], |sum, &(node, weight)| {
            advance(sum, weight, at(node))
        });
        Self {
            frame: LocalFrame::new(self.frame.normal.map(|c| -c)),
            tag_a: self.tag_b,
            tag_b: self.tag_a,
            entries,
            force_point,
            ..self
        }
    }

    /// The component along a `direction` of the jump ⟦u⟧ of displacements `u`, given node by node (m).
    pub fn jump_along(&self, direction: [f64; 3], dim: usize, u: &[f64]) -> f64 {
        self.row_along(direction)
            .flat_map(|(node, n)| (0..dim).map(move |k| n[k] * u[node as usize * dim + k]))
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_local_frame_is_orthonormal_and_right_handed() {
        let tilted = [0.36, 0.48, 0.8];
        for normal in [[1.0, 0.0, 0.0], [0.6, -0.8, 0.0], [0.0, 0.0, -1.0], tilted] {
            let LocalFrame { tangents, .. } = LocalFrame::new(normal);
            let [t1, t2] = tangents;
            for (a, b) in [(normal, t1), (normal, t2), (t1, t2)] {
                assert!(dot(a, b).abs() < 1e-15, "{normal:?}: {tangents:?}");
            }
            let third = cross(normal, t1);
            assert!((0..3).all(|k| (third[k] - t2[k]).abs() < 1e-15));
        }
    }

    #[test]
    fn in_the_plane_the_tangent_is_the_normal_turned_counter_clockwise() {
        let frame = LocalFrame::new([0.6, -0.8, 0.0]);
        assert_eq!(frame.tangents, [[0.8, 0.6, 0.0], [0.0, 0.0, 1.0]]);
    }

    #[test]
    fn the_jump_of_a_pair_is_what_its_sides_approach() {
        let normal = [0.0, 1.0, 0.0];
        let point = ContactPoint::new(vec![(0, 1.0), (1, -1.0)], normal, [0.0; 3], 7);
        assert_eq!(
            point.jump_along(normal, 2, &[5.0, 0.3, 5.0, 0.1]),
            0.3 - 0.1
        );
    }
}
