//! Jumps of a contact group as unknowns in place of displacements of its nodes.

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::{dot, length};
use contact_dd_partition::model::Support;

use super::contact_group::{Condition, ContactGroup, GroupLoads};
use super::contact_node::ContactNode;
use super::frame::{Frame, support_frames};
use crate::contact::jumps::{
    IsTied, JumpRow, Jumps, NoUnknown, OwnJump, Sum, Variable, defining_conditions,
};
use crate::contact::limits::Limits;
use crate::schur::condensed::InterfaceDof;
use crate::schur::substitution::Replaced;

/// Squared cosine between a direction and those of the supports above which the supports constrain it.
const ALONG: f64 = 0.5;

/// The rows of a contact group: those of its limits, and those of the jumps of its ties.
#[derive(Clone, Debug)]
pub struct JumpRows {
    limits: Vec<JumpRow>,
    tied: Vec<JumpRow>,
}

impl JumpRows {
    /// Number of limits.
    pub fn limits(&self) -> usize {
        self.limits.len()
    }
}

impl ContactGroup {
    /// Bounds of the normal jumps t = b·x, which are gaps reduced by prescribed displacements; the tangential jumps at
    /// which the sides stick; and the jumps of ties (m).
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

    /// The jumps of the constraints as functions of the free displacements along the axes of their nodes. They replace
    /// displacements at `eliminated` nodes, those of Γ that are eliminated at the group's node of the hierarchy.
    ///
    /// # Errors
    /// A point none of whose displacements can be replaced by its jump.
    pub fn jumps(&self, eliminated: &[u32]) -> Result<Jumps, NoUnknown> {
        let is_tied: Vec<bool> = self
            .conditions()
            .map(|condition| condition.is_tied)
            .collect();
        self.solve_rows(&self.rows(), &|j| is_tied[j], eliminated)
    }

    /// The rows of B on the free displacements along the axes of the nodes, one for each constraint.
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

    /// The rows of `limits`, t = b·x and D t = b·x, and of the jumps of ties.
    pub fn rows_of(&self, limits: &Limits) -> JumpRows {
        let rows = self.rows();
        let dependent = limits.conditions_of_limits().split_off(limits.jumps());
        let conditions = limits.defining.iter().copied().chain(dependent);
        let tied = limits.tied.iter();
        JumpRows {
            limits: conditions.map(|j| rows[j].clone()).collect(),
            tied: tied.map(|&(j, _)| rows[j].clone()).collect(),
        }
    }

    /// The unknowns replaced by the `closed` limits and the jumps of ties, if all other limits are open. They are
    /// numbered as in the `rows` of all, of which those of ties come last.
    ///
    /// # Errors
    /// A jump that can't replace any displacement of an `eliminated` node: its number among the closed ones.
    pub fn replaced_by(
        &self,
        rows: &JumpRows,
        closed: &[usize],
        eliminated: &[u32],
    ) -> Result<Vec<Replaced>, NoUnknown> {
        let mut known: Vec<JumpRow> = closed.iter().map(|&t| rows.limits[t].clone()).collect();
        known.extend(rows.tied.iter().cloned());
        let jumps = self.solve_rows(&known, &|j| j >= closed.len(), eliminated)?;
        let mut defining = defining_conditions(&jumps.of, jumps.pivots.len());
        defining.extend(jumps.tied_conditions());
        let mut replaced = self.replaced(&jumps);
        for (t, _) in replaced.iter_mut().flat_map(|replaced| &mut replaced.jumps) {
            *t = match closed.get(defining[*t]) {
                Some(&number) => number,
                None => rows.limits() + defining[*t] - closed.len(),
            };
        }
        Ok(replaced)
    }

    /// The terms of every limit, then of the jumps of ties, by unknowns on Γ.
    pub fn terms_of(&self, rows: &JumpRows) -> Vec<Vec<(InterfaceDof, f64)>> {
        let terms = |row: &JumpRow| row.iter().map(|&(v, c)| (self.dof(v), c)).collect();
        rows.limits.iter().chain(&rows.tied).map(terms).collect()
    }

    /// An unknown of the group as an unknown on Γ.
    fn dof(&self, v: u32) -> InterfaceDof {
        InterfaceDof {
            node: self.nodes[v as usize / self.dim].interface,
            axis: v % self.dim as u32,
        }
    }

    /// Traces that jumps replace, by unknowns on Γ; those replaced by jumps of ties come last.
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

    /// The frames of the nodes, with the prescribed displacements of the first load step; their axes are the same in
    /// all steps.
    pub(super) fn frames(&self) -> Vec<Frame> {
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

    /// True if a constraint of a tie is dropped because a support constrains the same displacement.
    pub fn is_left_out(&self, condition: &Condition) -> bool {
        condition.is_tied && self.is_dropped(condition, &self.frames())
    }

    /// Flags of the constraints of ties whose jump supports prescribe.
    pub fn prescribed_ties(&self) -> Vec<bool> {
        let frames = self.frames();
        let of_tie =
            |condition: Condition| condition.is_tied && self.row(&condition, &frames).is_empty();
        self.conditions().map(of_tie).collect()
    }

    /// True if a constraint of a tie is dropped in favour of the support of its slave node: the opposite nodes lie
    /// beside that node, and the constraint would repeat on them what the support prescribes.
    fn is_dropped(&self, condition: &Condition, frames: &[Frame]) -> bool {
        let point = &self.points[condition.point];
        let own = point.entries.iter().find(|(node, _)| {
            let tag = self.nodes[*node as usize].tag;
            tag == point.tag()
        });
        let is_held = |node: u32| {
            let Frame { axes, prescribed } = frames[node as usize];
            let held = axes.iter().zip(prescribed);
            let along =
                held.filter_map(|(axis, held)| held.map(|_| dot(*axis, condition.direction)));
            along.map(|c| c * c).sum::<f64>() > ALONG
        };
        point.entries.len() > 2
            && !point.is_equation()
            && own.is_some_and(|&(node, _)| is_held(node))
    }

    /// The jump of a constraint in terms of the free displacements along the axes of its nodes.
    pub(super) fn row(&self, condition: &Condition, frames: &[Frame]) -> JumpRow {
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
        // Along the other axes of a frame that contains the point's normal, the coefficients are round-off.
        let sizes = self.row_of(condition).map(|(_, push)| length(push));
        let scale = sizes.fold(0.0, f64::max);
        row.retain(|_, c| c.abs() > 1e-14 * scale);
        row.into_iter().collect()
    }
}
