//! A contact group: the contact points of one node of the hierarchy, the lowest one at which all their nodes meet, with
//! the data of these nodes. A point's gap is between side a, the slave, and side b, the master.

use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::element::geometry::dot;

use super::contact_node::ContactNode;
use crate::contact::friction::{ForceBound, TangentialCondition};
use crate::contact::law::PointLaw;

/// Contact points, with nodes numbered within the group.
#[derive(Clone, Debug, Default)]
pub struct ContactGroup {
    /// The contact points.
    pub points: Vec<ContactPoint<u32>>,
    /// The nodes of these points.
    pub nodes: Vec<ContactNode>,
    /// Number of dofs of a node.
    pub dim: usize,
}

/// A contact constraint: the jump at a point along one direction, a row of B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Number of the point.
    pub point: usize,
    /// The direction: the normal n, or a tangent if friction acts.
    pub direction: [f64; 3],
    /// True if the direction is a tangent.
    pub is_tangential: bool,
    /// True if it belongs to a tie.
    pub is_tied: bool,
}

/// The loads on a contact group in a load step: gaps and prescribed displacements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupLoads {
    /// The bound of every constraint's jump (m): the gap g, or for a tangential one the jump at which the sides stick,
    /// that of the load step before.
    pub gaps: Vec<f64>,
    /// The displacements prescribed by the supports of every node (m).
    pub held: Vec<Vec<f64>>,
}

impl GroupLoads {
    /// The loads on `group` in load step k.
    pub fn new(group: &ContactGroup, k: usize) -> Self {
        let held = |node: &ContactNode| node.supports.iter().map(|(_, values)| values[k]).collect();
        let gap = |condition: Condition| match condition.is_tangential {
            true => 0.0,
            false => group.points[condition.point].gap,
        };
        Self {
            gaps: group.conditions().map(gap).collect(),
            held: group.nodes.iter().map(held).collect(),
        }
    }

    /// Reduces these loads to `before` + `part` · (these − `before`); without loads before, to the `part` of these.
    pub fn go_back(&mut self, before: Option<&Self>, part: f64) {
        for (node, held) in self.held.iter_mut().enumerate() {
            for (i, value) in held.iter_mut().enumerate() {
                let from = before.map_or(0.0, |before| before.held[node][i]);
                *value = from + part * (*value - from);
            }
        }
    }

    /// The largest prescribed displacement or gap (m).
    pub fn largest_prescribed(&self) -> f64 {
        let all = self.held.iter().flatten().chain(&self.gaps);
        all.fold(0.0, |m: f64, x| m.max(x.abs()))
    }
}

impl ContactGroup {
    /// The group of these points, with the tangents along which they can slip.
    pub fn new(points: Vec<ContactPoint<u32>>, nodes: Vec<ContactNode>, dim: usize) -> Self {
        let mut group = Self { points, nodes, dim };
        group.take_stiffness_between_sides();
        group.take_slip_directions();
        group
    }

    /// Sets the stiffness of auxiliary nodes between two sides to that of the bodies, as a material's (Pa).
    fn take_stiffness_between_sides(&mut self) {
        for j in 0..self.points.len() {
            let point = &self.points[j];
            if let Some((node, _)) = point.entries.last().filter(|_| point.is_compliant()) {
                self.nodes[*node as usize].stiffness = point.stiffness[0] / self.width_at(j);
            }
        }
    }

    /// The part of the jump at a point, along a direction, due to prescribed displacements that vary with the load
    /// steps and belong to no body (m).
    pub fn moved(&self, point: usize, direction: [f64; 3], loads: &GroupLoads) -> f64 {
        let of_entry = |(node, row): (u32, [f64; 3])| {
            let of_node = &self.nodes[node as usize];
            let held = of_node.supports.iter().zip(&loads.held[node as usize]);
            let along: f64 = held.map(|((d, _), value)| dot(row, *d) * value).sum();
            if of_node.is_auxiliary { along } else { 0.0 }
        };
        self.points[point].row_along(direction).map(of_entry).sum()
    }

    /// Contact constraints: the normal one of every point, then the tangential ones of points with friction or ties.
    pub fn conditions(&self) -> impl Iterator<Item = Condition> + '_ {
        let normal = |(point, of_point): (usize, &ContactPoint<u32>)| Condition {
            point,
            direction: of_point.normal(),
            is_tangential: false,
            is_tied: of_point.law.is_tied(),
        };
        let tangential = |(point, of_point): (usize, &ContactPoint<u32>)| {
            let tangents = of_point.tangents(self.dim).to_vec().into_iter();
            let is_tied = of_point.law.is_tied();
            tangents.map(move |direction| Condition {
                point,
                direction,
                is_tangential: true,
                is_tied,
            })
        };
        let points = self.points.iter().enumerate();
        points
            .clone()
            .map(normal)
            .chain(points.flat_map(tangential))
    }

    /// The row of a constraint: each node of its point, and weight·direction.
    pub fn row_of(&self, condition: &Condition) -> impl Iterator<Item = (u32, [f64; 3])> + Clone {
        self.points[condition.point].row_along(condition.direction)
    }

    /// The round-off of the bound of every constraint (m): `of_displacements`, those prescribed, and that of coordinates, a
    /// share `of_coordinates` of the largest, where the gap is measured.
    pub fn round_off(&self, of_displacements: f64, of_coordinates: f64) -> Vec<f64> {
        let coordinates = self.points.iter().flat_map(|point| &point.position);
        let largest = coordinates.fold(0.0, |m: f64, x| m.max(x.abs()));
        let of_constraint = |constraint: Condition| {
            let is_given = self.points[constraint.point].is_gap_given;
            of_displacements
                + if is_given {
                    0.0
                } else {
                    of_coordinates * largest
                }
        };
        self.conditions().map(of_constraint).collect()
    }

    /// The area of the point of every constraint (m, in space m²).
    pub fn areas(&self) -> Vec<f64> {
        let area = |condition: Condition| self.points[condition.point].area;
        self.conditions().map(area).collect()
    }

    /// The tangential constraints, each with the normal one of its point.
    pub fn friction(&self) -> Vec<TangentialCondition> {
        let of_condition = |(number, condition): (usize, Condition)| {
            let point = &self.points[condition.point];
            let (coefficient, bound, only_closed) = match point.law {
                Law::Frictionless | Law::Tied => return None,
                Law::Given { bound } => (0.0, bound, false),
                Law::Coulomb {
                    coefficient,
                    cohesion,
                } => (coefficient, cohesion, true),
            };
            condition.is_tangential.then_some(TangentialCondition {
                number,
                normal: condition.point,
                bound: ForceBound {
                    coefficient,
                    cohesion: bound * point.area,
                    only_closed,
                },
            })
        };
        let conditions = self.conditions().enumerate();
        conditions.filter_map(of_condition).collect()
    }

    /// The contact laws of the points with friction; they refer to constraints in place of limits.
    pub fn point_laws(&self) -> Vec<PointLaw> {
        let friction = self.friction();
        let law = |of_point: &[TangentialCondition]| PointLaw {
            normal: Some(of_point[0].normal),
            first: of_point[0].number,
            tangents: [0, 1].map(|k| of_point.get(k).map(|one| one.number)),
            prescribed: 0.0,
            bound: of_point[0].bound,
            stiffness: self.stiffness_at(of_point[0].normal),
        };
        let points = friction.chunk_by(|a, b| a.normal == b.normal);
        points.map(law).collect()
    }

    /// Approximate stiffness of the bodies against a jump at a point (N/m).
    pub fn stiffness_at(&self, point: usize) -> f64 {
        let width = self.width_at(point);
        let of_entry = |&(node, weight): &(u32, f64)| {
            weight * weight / (self.nodes[node as usize].stiffness * width)
        };
        1.0 / self.points[point].entries.iter().map(of_entry).sum::<f64>()
    }

    /// The largest stiffness of the nodes of a point (N/m): times the displacements it is the scale of the round-off of
    /// contact forces.
    pub fn largest_stiffness_at(&self, point: usize) -> f64 {
        let entries = self.points[point].entries.iter();
        let stiffness = entries.map(|(node, _)| self.nodes[*node as usize].stiffness);
        self.width_at(point) * stiffness.fold(0.0, f64::max)
    }

    /// The width of the contact surface around a point (m), 1 in the plane.
    fn width_at(&self, point: usize) -> f64 {
        match self.dim == 3 {
            true => self.points[point].area.sqrt(),
            false => 1.0,
        }
    }

    /// Slack of constraints for displacements `u`, node by node (m): the gaps g − n·⟦u⟧, and for tangential ones minus
    /// the slip since the sides last stuck.
    pub fn gaps_left(&self, loads: &GroupLoads, u: &[f64]) -> Vec<f64> {
        let left = |(condition, gap): (Condition, &f64)| {
            gap - self.points[condition.point].jump_along(condition.direction, self.dim, u)
        };
        self.conditions().zip(&loads.gaps).map(left).collect()
    }

    /// Bᵀλ of contact `forces`, one for each constraint: the contributions to every node.
    pub fn pushes(&self, forces: &[f64]) -> Vec<Vec<[f64; 3]>> {
        let mut pushes = vec![Vec::new(); self.nodes.len()];
        for (condition, force) in self.conditions().zip(forces) {
            for (node, row) in self.row_of(&condition) {
                pushes[node as usize].push(row.map(|n| n * force));
            }
        }
        pushes
    }
}
