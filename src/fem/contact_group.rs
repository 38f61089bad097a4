//! A contact group: the contact points that belong to one node of the hierarchy, where all that have one of
//! their nodes come together, and what they need to know of these nodes.

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::element::geometry::{advance, dot, length};
use contact_dd_partition::model::Support;

use super::contact_node::ContactNode;
use super::frame::{Frame, support_frames};
use super::jump_row::{NO_ROW, less, only_direction, product};
use crate::contact::friction::{ForceBound, TangentialCondition};
use crate::contact::jumps::{
    IsTied, JumpRow, Jumps, NoUnknown, OwnJump, Sum, Variable, defining_conditions,
};
use crate::contact::law::PointLaw;
use crate::schur::condensed::InterfaceDof;
use crate::schur::substitution::Replaced;

/// Square of the cosine between a direction and those that supports hold from which on they hold it.
const ALONG: f64 = 0.5;

/// Contact points over nodes of their own numbering.
#[derive(Clone, Debug, Default)]
pub struct ContactGroup {
    /// The points.
    pub points: Vec<ContactPoint<u32>>,
    /// Nodes of the points.
    pub nodes: Vec<ContactNode>,
    /// Number of dofs of a node.
    pub dim: usize,
}

/// The condition on the jump at a point along one direction: a row of B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Number of the point.
    pub point: usize,
    /// The direction: n, or a tangent where friction acts.
    pub direction: [f64; 3],
    /// Whether it is a tangent.
    pub is_tangential: bool,
    /// Whether it is one of a tie.
    pub is_tied: bool,
}

/// The rows of the jumps of a contact group: of those that are unknowns, and of those of ties.
#[derive(Clone, Debug)]
pub struct JumpRows {
    unknown: Vec<JumpRow>,
    tied: Vec<JumpRow>,
}

impl JumpRows {
    /// Number of jumps that are unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknown.len()
    }
}

/// The loads on a contact group in a load step: gaps and prescribed displacements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupLoads {
    /// For every condition the jump that it allows (m): the gap g, or the tangential jump at which the sides stick,
    /// that of the load step before.
    pub gaps: Vec<f64>,
    /// The displacements that the supports of every node prescribe (m).
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

    /// Goes back from these loads to what acts part of the way from those `before` to them; from none to them, if
    /// there are none.
    pub fn go_back(&mut self, before: Option<&Self>, part: f64) {
        for (node, held) in self.held.iter_mut().enumerate() {
            for (i, value) in held.iter_mut().enumerate() {
                let from = before.map_or(0.0, |before| before.held[node][i]);
                *value = from + part * (*value - from);
            }
        }
    }

    /// The largest displacement that is prescribed, gaps among them (m).
    pub fn largest_prescribed(&self) -> f64 {
        let all = self.held.iter().flatten().chain(&self.gaps);
        all.fold(0.0, |m: f64, x| m.max(x.abs()))
    }
}

impl ContactGroup {
    /// The group of these points. Where supports let what has friction slip in but one direction of a plane, that is
    /// the first tangent, so that there is no condition along the second. What the normal jump alone moves along a
    /// tangent, where the normal isn't along what is held, is no slip.
    pub fn new(points: Vec<ContactPoint<u32>>, nodes: Vec<ContactNode>, dim: usize) -> Self {
        let mut group = Self { points, nodes, dim };
        let frames = group.frames();
        for point in 0..group.points.len() {
            let normal = group.points[point].normal();
            let tangents = match group.points[point].law.is_tied() {
                true => &[],
                false => group.points[point].tangents(dim),
            };
            if let [first, second] = *tangents {
                let [n, a, b] = [normal, first, second].map(|direction| {
                    let condition = Condition {
                        point,
                        direction,
                        is_tangential: true,
                        is_tied: false,
                    };
                    group.row(&condition, &frames)
                });
                let turned = |x: f64, y: f64| std::array::from_fn(|k| x * first[k] + y * second[k]);
                if let Some((cos, sin)) = only_direction(&a, &b) {
                    group.points[point].frame.tangents = [turned(cos, sin), turned(-sin, cos)];
                } else if group.is_held_fast(point) {
                    let [of_a, of_b] = [&a, &b].map(|row| product(row, &n) / product(&n, &n));
                    let beside = [less(&a, of_a, &n), less(&b, of_b, &n)];
                    let rest: f64 = beside.iter().map(|row| product(row, row)).sum();
                    if rest <= NO_ROW * (product(&a, &a) + product(&b, &b)) {
                        group.points[point].frame.tangents = [
                            advance(first, -of_a, normal),
                            advance(second, -of_b, normal),
                        ];
                    } else if let Some((cos, sin)) = only_direction(&beside[0], &beside[1]) {
                        let of_normal = cos * of_b - sin * of_a;
                        group.points[point].frame.tangents = [
                            turned(cos, sin),
                            advance(turned(-sin, cos), -of_normal, normal),
                        ];
                    }
                }
            }
        }
        group
    }

    /// Whether supports hold nodes of a point, and prescribe no displacement but 0.
    fn is_held_fast(&self, point: usize) -> bool {
        let nodes = self.points[point].entries.iter();
        let mut supports = nodes.flat_map(|(node, _)| &self.nodes[*node as usize].supports);
        supports.clone().next().is_some()
            && supports.all(|(_, values)| values.iter().all(|&value| value == 0.0))
    }

    /// Conditions: the normal one of every point, then the tangential ones of the points that have friction or are tied.
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

    /// The nodes of a condition's point with weight·direction.
    pub fn row_of(&self, condition: &Condition) -> impl Iterator<Item = (u32, [f64; 3])> + Clone {
        self.points[condition.point].row_along(condition.direction)
    }

    /// The tangential conditions, each with the normal condition of its point.
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

    /// The laws of the points with friction, with conditions in the place of limits.
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

    /// Stiffness of the bodies against a jump at a point, about (N/m).
    pub fn stiffness_at(&self, point: usize) -> f64 {
        let width = self.width_at(point);
        let of_entry = |&(node, weight): &(u32, f64)| {
            weight * weight / (self.nodes[node as usize].stiffness * width)
        };
        1.0 / self.points[point].entries.iter().map(of_entry).sum::<f64>()
    }

    /// The largest stiffness of the nodes of a point (N/m): the round-off of its force is relative to this times the
    /// displacements.
    pub fn largest_stiffness_at(&self, point: usize) -> f64 {
        let entries = self.points[point].entries.iter();
        let stiffness = entries.map(|(node, _)| self.nodes[*node as usize].stiffness);
        self.width_at(point) * stiffness.fold(0.0, f64::max)
    }

    /// The width of the surface around a point (m), 1 in the plane.
    fn width_at(&self, point: usize) -> f64 {
        match self.dim == 3 {
            true => self.points[point].area.sqrt(),
            false => 1.0,
        }
    }

    /// Slack of conditions under displacements `u`, node by node: the gaps g − n·⟦u⟧, and the
    /// way back to where the sides stick (m).
    pub fn gaps_left(&self, loads: &GroupLoads, u: &[f64]) -> Vec<f64> {
        let left = |(condition, gap): (Condition, &f64)| {
            gap - self.points[condition.point].jump_along(condition.direction, self.dim, u)
        };
        self.conditions().zip(&loads.gaps).map(left).collect()
    }

    /// The gaps that supports leave where what is free doesn't move (m), and ties: the bounds on the normal jumps t = b·x,
    /// the tangential jumps at which the sides stick, and the jumps of ties.
    pub fn bounds(&self, loads: &GroupLoads, jumps: &Jumps) -> Vec<f64> {
        let frames = self.frames();
        let bound = |(condition, gap): (Condition, &f64)| {
            let prescribed = self.row_of(&condition).flat_map(|(node, push)| {
                let (axes, held) = (frames[node as usize].axes, &loads.held[node as usize]);
                (held.iter().zip(axes)).map(move |(value, axis)| dot(push, axis) * value)
            });
            gap - prescribed.sum::<f64>()
        };
        let mut bounds: Vec<f64> = self.conditions().zip(&loads.gaps).map(bound).collect();
        jumps.subtract_known(&mut bounds);
        bounds
    }

    /// The jumps of the conditions, for the displacements along the axes of their nodes that supports leave
    /// free. They replace displacements of nodes that are `eliminated` where the points belong.
    ///
    /// # Errors
    /// A point that no displacement can be replaced for.
    pub fn jumps(&self, eliminated: &[u32]) -> Result<Jumps, NoUnknown> {
        let is_tied: Vec<bool> = self.conditions().map(|condition| condition.is_tied).collect();
        self.solve_rows(&self.rows(), &|j| is_tied[j], eliminated)
    }

    /// The rows of B on what is free along the axes of the nodes, a condition each.
    fn rows(&self) -> Vec<JumpRow> {
        let frames = self.frames();
        let conditions = self.conditions();
        conditions
            .map(|condition| self.row(&condition, &frames))
            .collect()
    }

    fn solve_rows(
        &self,
        rows: &[JumpRow],
        is_tied: IsTied<'_>,
        eliminated: &[u32],
    ) -> Result<Jumps, NoUnknown> {
        let node = |v: u32| &self.nodes[v as usize / self.dim];
        let may_go = |v: u32| eliminated.binary_search(&node(v).interface).is_ok();
        Jumps::new(rows, is_tied, may_go, |v| node(v).stiffness)
    }

    /// The rows of jumps, t = b·x.
    pub fn rows_of(&self, jumps: &Jumps) -> JumpRows {
        let rows = self.rows();
        let of = |numbers: Vec<usize>| numbers.into_iter().map(|j| rows[j].clone()).collect();
        JumpRows {
            unknown: of(defining_conditions(&jumps.of, jumps.pivots.len())),
            tied: of(jumps.tied_conditions()),
        }
    }

    /// The unknowns that the `closed` jumps and those of ties replace where all others are none; they keep their numbers among
    /// the `rows` of all, of which those of ties come last.
    ///
    /// # Errors
    /// One that no displacement of a node that is `eliminated` can be replaced for: its number among the closed ones.
    pub fn replaced_by(
        &self,
        rows: &JumpRows,
        closed: &[usize],
        eliminated: &[u32],
    ) -> Result<Vec<Replaced>, NoUnknown> {
        let mut known: Vec<JumpRow> = closed.iter().map(|&t| rows.unknown[t].clone()).collect();
        known.extend(rows.tied.iter().cloned());
        let jumps = self.solve_rows(&known, &|j| j >= closed.len(), eliminated)?;
        let mut defining = defining_conditions(&jumps.of, jumps.pivots.len());
        defining.extend(jumps.tied_conditions());
        let mut replaced = self.replaced(&jumps);
        for (t, _) in replaced.iter_mut().flat_map(|replaced| &mut replaced.jumps) {
            *t = match closed.get(defining[*t]) {
                Some(&number) => number,
                None => rows.unknowns() + defining[*t] - closed.len(),
            };
        }
        Ok(replaced)
    }

    /// The terms of every jump, those of ties last, in the words of Γ.
    pub fn terms_of(&self, rows: &JumpRows) -> Vec<Vec<(InterfaceDof, f64)>> {
        let terms = |row: &JumpRow| row.iter().map(|&(v, c)| (self.dof(v), c)).collect();
        rows.unknown.iter().chain(&rows.tied).map(terms).collect()
    }

    /// An unknown of the group in the words of Γ.
    fn dof(&self, v: u32) -> InterfaceDof {
        InterfaceDof {
            node: self.nodes[v as usize / self.dim].interface,
            axis: v % self.dim as u32,
        }
    }

    /// Traces that jumps replace, by the numbers of Γ, those that jumps of ties replace last.
    pub fn replaced(&self, jumps: &Jumps) -> Vec<Replaced> {
        let unknowns = jumps.pivots.len();
        let replaced = |(pivot, is_tied): (&u32, bool)| {
            let Sum { terms } = &jumps.replaced[pivot];
            let staying = terms.iter().filter_map(|(&variable, &c)| match variable {
                Variable::Displacement(v) => Some((self.dof(v), c)),
                Variable::Jump(_) => None,
            });
            let of_jumps = terms.iter().filter_map(|(&variable, &c)| match variable {
                Variable::Displacement(_) => None,
                Variable::Jump(t) => Some(match jumps.own(t) {
                    OwnJump::Unknown(number) => (number, c),
                    OwnJump::Tied(number) => (unknowns + number, c),
                }),
            });
            Replaced {
                dof: self.dof(*pivot),
                staying: staying.collect(),
                jumps: of_jumps.collect(),
                is_tied,
            }
        };
        let unknown = jumps.pivots.iter().map(|pivot| (pivot, false));
        let tied = jumps.tied.iter().map(|pivot| (pivot, true));
        unknown.chain(tied).map(replaced).collect()
    }

    /// Bᵀλ of contact `forces`, one a condition: on every node its parts.
    pub fn pushes(&self, forces: &[f64]) -> Vec<Vec<[f64; 3]>> {
        let mut pushes = vec![Vec::new(); self.nodes.len()];
        for (condition, force) in self.conditions().zip(forces) {
            for (node, row) in self.row_of(&condition) {
                pushes[node as usize].push(row.map(|n| n * force));
            }
        }
        pushes
    }

    /// The frames of the nodes; what supports prescribe in the first load step stands for all.
    fn frames(&self) -> Vec<Frame> {
        let of_node = |node: &ContactNode| {
            let support = |(direction, values): &([f64; 3], Vec<f64>)| Support {
                node: 0,
                direction: *direction,
                value: values[0],
                condition: 0,
            };
            let supports: Vec<Support> = node.supports.iter().map(support).collect();
            let frame = support_frames(&supports, self.dim).remove(&0);
            let along = node.slides.map(|normal| Frame::along(&[normal], self.dim));
            frame.or(along).unwrap_or(Frame::CARTESIAN)
        };
        self.nodes.iter().map(of_node).collect()
    }

    /// Whether a condition of a tie is left out, as a support has its place.
    pub fn is_left_out(&self, condition: &Condition) -> bool {
        condition.is_tied && self.is_dropped(condition, &self.frames())
    }

    /// Whether a condition of a tie is left to the support of the node that has it: of several nodes opposite, which lie beside
    /// it, it would ask what the support asks of it alone.
    fn is_dropped(&self, condition: &Condition, frames: &[Frame]) -> bool {
        let point = &self.points[condition.point];
        let own = point.entries.iter().find(|(node, _)| {
            let tag = self.nodes[*node as usize].tag;
            tag == point.tag()
        });
        let is_held = |node: u32| {
            let Frame { axes, prescribed } = frames[node as usize];
            let held = axes.iter().zip(prescribed);
            let along = held.filter_map(|(axis, held)| held.map(|_| dot(*axis, condition.direction)));
            along.map(|c| c * c).sum::<f64>() > ALONG
        };
        point.entries.len() > 2 && !point.is_equation() && own.is_some_and(|&(node, _)| is_held(node))
    }

    /// The jump of a condition in terms of what is free along the axes of its nodes' frames.
    fn row(&self, condition: &Condition, frames: &[Frame]) -> JumpRow {
        let mut row: BTreeMap<u32, f64> = BTreeMap::new();
        if condition.is_tied && self.is_dropped(condition, frames) {
            return JumpRow::new();
        }
        for (node, push) in self.row_of(condition) {
            let frame = &frames[node as usize];
            for axis in (0..self.dim).filter(|&axis| frame.prescribed[axis].is_none()) {
                let v = node * self.dim as u32 + axis as u32;
                *row.entry(v).or_default() += dot(push, frame.axes[axis]);
            }
        }
        // A frame along the point's own normal leaves round-off on its other axes.
        let sizes = self.row_of(condition).map(|(_, push)| length(push));
        let scale = sizes.fold(0.0, f64::max);
        row.retain(|_, c| c.abs() > 1e-14 * scale);
        row.into_iter().collect()
    }
}
