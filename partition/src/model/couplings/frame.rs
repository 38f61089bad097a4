//! The frame of a reference point: three nodes, in the plane two, whose displacements represent its motion.

use std::collections::BTreeMap;

use crate::contact_point::{ContactPoint, Law};
use crate::element::geometry::{difference, length};

/// Prescribed displacements and forces of the nodes of a frame in a load step.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::model) struct FrameLoads {
    /// Prescribed displacements: node of the frame, axis, value (m).
    pub supports: Vec<(usize, usize, f64)>,
    /// Forces on its nodes (N).
    pub forces: [[f64; 3]; 3],
}

/// A linear form of displacements: a vector of coefficients for each node.
pub(in crate::model) type Form = BTreeMap<u32, [f64; 3]>;

/// The frame of a coupling.
pub(super) struct Frame {
    /// The first node.
    pub first: u32,
    /// The reference point (m).
    pub origin: [f64; 3],
    /// L (m).
    pub size: f64,
    /// Dimension of space.
    pub dim: usize,
}

impl Frame {
    /// Positions of the nodes, starting with the origin.
    pub fn corners(&self) -> Vec<[f64; 3]> {
        let corner = |k: usize| {
            let mut x = self.origin;
            x[k] += self.size;
            x
        };
        std::iter::once(self.origin)
            .chain((0..self.dim - 1).map(corner))
            .collect()
    }

    /// Adds a multiple of the displacement of a corner along an axis.
    pub fn add(&self, form: &mut Form, corner: u32, axis: usize, factor: f64) {
        form.entry(self.first + corner).or_default()[axis] += factor;
    }

    /// The corner, besides the first, and the axis of the displacement that represents a rotation, and its sign.
    fn of_rotation(about: usize) -> (u32, usize, f64) {
        match about {
            0 => (2, 2, 1.0),
            1 => (1, 2, -1.0),
            _ => (1, 1, 1.0),
        }
    }

    /// Adds a multiple of the rotation about an axis.
    pub fn add_rotation(&self, form: &mut Form, about: usize, factor: f64) {
        let (corner, axis, sign) = Self::of_rotation(about);
        self.add(form, corner, axis, sign * factor / self.size);
        self.add(form, 0, axis, -sign * factor / self.size);
    }

    /// The axes of its rotations.
    pub fn rotations(&self) -> std::ops::Range<usize> {
        if self.dim == 2 { 2..3 } else { 0..3 }
    }

    /// Adds a multiple of the displacement along an axis of a point x that moves rigidly with the frame.
    pub fn add_at(&self, form: &mut Form, x: [f64; 3], axis: usize, factor: f64) {
        self.add(form, 0, axis, factor);
        let r = difference(x, self.origin);
        for about in self.rotations() {
            // e_about × r along the axis.
            let turned = match (axis + 3 - about) % 3 {
                1 => -r[(axis + 1) % 3],
                2 => r[(axis + 2) % 3],
                _ => 0.0,
            };
            if turned != 0.0 {
                self.add_rotation(form, about, factor * turned);
            }
        }
    }

    /// The equations that keep the frame rigid.
    pub fn rigid(&self) -> Vec<Form> {
        let mut forms = vec![Form::new(); if self.dim == 2 { 1 } else { 3 }];
        let corners = self.corners();
        let places = [(1, 0), (2, 0), (2, 1)];
        for (form, (corner, axis)) in forms.iter_mut().zip(places) {
            self.add(form, corner, axis, 1.0);
            self.add_at(form, corners[corner as usize], axis, -1.0);
        }
        forms
    }
}

/// Loads and prescribed motions of a reference point in a load step.
pub(super) struct Acting {
    /// Force (N).
    pub force: [f64; 3],
    /// Moment (N m).
    pub moment: [f64; 3],
    /// Prescribed motion, in the order of the scene's components (m, rad).
    pub motion: [Option<f64>; 6],
}

impl Acting {
    /// The rotation about an axis, if it is prescribed and the displacement that represents it isn't.
    fn turned_alone(&self, about: usize) -> Option<f64> {
        let (_, axis, _) = Frame::of_rotation(about);
        self.motion[3 + about].filter(|_| self.motion[axis].is_none())
    }
}

impl Frame {
    /// The point of an equation; `values` are its values in load steps, omitted if all are 0.
    pub fn point(&self, form: &Form, values: &[f64]) -> ContactPoint<u32> {
        let terms = form.iter().filter(|(_, c)| length(**c) > 0.0);
        let (entries, axes): (Vec<_>, Vec<_>) = terms
            .map(|(&node, &c)| ((node, length(c)), c.map(|x| x / length(c))))
            .unzip();
        let gap = values.first().copied().unwrap_or(0.0);
        let axis: [f64; 3] = axes[0];
        let moves = values.iter().any(|&value| value != gap);
        let motion = values.iter().filter(|_| moves);
        ContactPoint {
            gap,
            motion: motion
                .map(|value| axis.map(|c| (value - gap) * c))
                .collect(),
            area: 1.0,
            law: Law::Tied,
            axes,
            ..ContactPoint::new(entries, axis, self.origin, -1)
        }
    }

    /// The equations of rotations that are prescribed without the displacements.
    pub fn turned(&self, steps: &[Acting]) -> Vec<ContactPoint<u32>> {
        let of_rotation = |about: usize| {
            let values: Option<Vec<f64>> =
                steps.iter().map(|step| step.turned_alone(about)).collect();
            let values: Vec<f64> = values?.iter().map(|value| self.size * value).collect();
            let mut form = Form::new();
            self.add_rotation(&mut form, about, self.size);
            Some(self.point(&form, &values))
        };
        self.rotations().filter_map(of_rotation).collect()
    }

    /// Forces and prescribed displacements of its corners.
    pub fn loads(&self, acting: &Acting) -> FrameLoads {
        let mut loads = FrameLoads::default();
        loads.forces[0] = acting.force;
        for about in self.rotations() {
            let (corner, axis, sign) = Self::of_rotation(about);
            let couple = sign * acting.moment[about] / self.size;
            loads.forces[corner as usize][axis] += couple;
            loads.forces[0][axis] -= couple;
            if let (Some(turn), Some(start)) = (acting.motion[3 + about], acting.motion[axis]) {
                let value = start + sign * self.size * turn;
                loads.supports.push((corner as usize, axis, value));
            }
        }
        let held = acting.motion[..self.dim].iter().enumerate();
        let held = held.filter_map(|(axis, value)| Some((0, axis, (*value)?)));
        loads.supports.extend(held);
        loads
            .supports
            .sort_by_key(|&(corner, axis, _)| (corner, axis));
        loads
    }
}
