//! Rigid couplings of some displacements: along directions d of every node, d·u(x) = d·(p + θ × (x − R)).
//!
//! Components of the point's motion q = (p, L θ) that occur in none of these equations follow the nodes' average
//! motion: they carry no load, and take part in the body's rigid-body motions.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::frame::{Acting, Form, Frame};
use crate::element::geometry::{cross, difference, dot, length};

/// Inertia about an axis, relative to the largest, below which it is zero.
pub(super) const NO_INERTIA: f64 = 1e-12;

/// Part of a load or of a prescribed motion along uncoupled components, relative to the whole, that counts as
/// round-off.
const NOTHING: f64 = 1e-9;

/// The components of a point's motion that occur in no equation.
pub(super) struct Uncoupled {
    /// An orthonormal basis of these motions: translations, then L times rotations.
    pub motions: Vec<[f64; 6]>,
}

/// A node that is coupled to the point along some directions only.
pub(super) struct FollowingNode {
    pub node: u32,
    /// The position (m).
    pub place: [f64; 3],
    /// Orthonormal directions.
    pub directions: Vec<[f64; 3]>,
}

/// The coupling equations of the nodes.
pub(super) fn forms(frame: &Frame, nodes: &[FollowingNode]) -> Vec<Form> {
    let mut all = Vec::new();
    for of in nodes {
        for d in &of.directions {
            let mut form = Form::new();
            form.insert(of.node, *d);
            for (axis, component) in d.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                frame.add_at(&mut form, of.place, axis, -component);
            }
            all.push(form);
        }
    }
    all
}

impl Uncoupled {
    /// The uncoupled components for these nodes.
    pub fn new(frame: &Frame, nodes: &[FollowingNode]) -> Self {
        let components = components(frame.dim);
        let mut sum = DMatrix::zeros(components.len(), components.len());
        for of in nodes {
            let arm = difference(of.place, frame.origin).map(|r| r / frame.size);
            for d in &of.directions {
                let turn = cross(arm, *d);
                let row = [d[0], d[1], d[2], turn[0], turn[1], turn[2]];
                let row =
                    DVector::from_iterator(components.len(), components.iter().map(|&k| row[k]));
                sum += &row * row.transpose();
            }
        }
        let eigen = sum.symmetric_eigen();
        let most = eigen.eigenvalues.max();
        let values = eigen.eigenvalues.iter().enumerate();
        let none = values.filter(|(_, value)| **value <= NO_INERTIA * most);
        let motion = |(column, _): (usize, &f64)| {
            let mut motion = [0.0; 6];
            for (&k, value) in components
                .iter()
                .zip(eigen.eigenvectors.column(column).iter())
            {
                motion[k] = *value;
            }
            motion
        };
        Self {
            motions: none.map(motion).collect(),
        }
    }

    /// The equations that set the uncoupled components to the average motion of the nodes. `means` are the forms of the
    /// average displacement Σ w u along all axes, `turns` those of Σ w r × u / L = J θ / L for all rotations; `arm`
    /// leads from the nodes' centre to the point.
    pub fn forms(
        &self,
        frame: &Frame,
        (means, turns): (&[Form], &[Form]),
        inertia: &Matrix3<f64>,
        arm: [f64; 3],
    ) -> Option<Vec<Form>> {
        let first = frame.rotations().start;
        let of_motion = |motion: &[f64; 6]| {
            let [x, y, z, a, b, c] = *motion;
            let lever = cross(arm, [x, y, z]);
            let mut turn = Vector3::from([a, b, c]) * frame.size + Vector3::from(lever);
            if frame.dim == 2 {
                turn = Vector3::new(0.0, 0.0, turn[2] / inertia[(2, 2)]);
            } else {
                turn = inertia.lu().solve(&turn)?;
            }
            let mut sum = Form::new();
            let parts = (means.iter().zip([x, y, z])).chain(
                (turns.iter().enumerate()).map(|(k, form)| (form, frame.size * turn[first + k])),
            );
            for (form, factor) in parts {
                for (&node, of_node) in form {
                    let sum = sum.entry(node).or_insert([0.0; 3]);
                    (0..3).for_each(|k| sum[k] += factor * of_node[k]);
                }
            }
            // Coefficients that cancel are round-off.
            let largest = sum.values().map(|c| length(*c)).fold(0.0, f64::max);
            sum.retain(|_, c| length(*c) > 1e-13 * largest);
            Some(sum)
        };
        self.motions.iter().map(of_motion).collect()
    }

    /// The norm of a vector's projection onto these motions.
    fn part(&self, of: [f64; 6]) -> f64 {
        let along = |motion: &[f64; 6]| (0..6).map(|k| motion[k] * of[k]).sum::<f64>();
        let squares = self.motions.iter().map(|motion| along(motion).powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// True if a unit motion has no part without coupling.
    pub fn is_coupled(&self, motion: [f64; 6]) -> bool {
        self.part(motion) < NOTHING
    }

    /// Removes prescribed components without coupling from the loads of the point.
    ///
    /// # Errors
    /// A load along an uncoupled component, or a prescribed component that is coupled in part; the message says which.
    pub fn free(&self, frame: &Frame, acting: &mut Acting) -> Result<(), String> {
        let [force, moment] = [acting.force, acting.moment.map(|m| m / frame.size)];
        let load = [
            force[0], force[1], force[2], moment[0], moment[1], moment[2],
        ];
        let size = load.iter().map(|c| c * c).sum::<f64>().sqrt();
        if self.part(load) > NOTHING * size {
            return Err(
                "its load is along a displacement or a rotation that isn't coupled; expected one along 'directions', or more of these"
                    .into(),
            );
        }
        for (k, value) in acting.motion.iter_mut().enumerate() {
            let part = self.part(std::array::from_fn(|i| f64::from(u8::from(i == k))));
            if value.is_none() || part < NOTHING {
                continue;
            }
            if part < 1.0 - NOTHING {
                let key = crate::scene::coupling::COMPONENTS[k];
                return Err(format!(
                    "its nodes don't tell '{key}' from other components, some of which aren't coupled; expected a 'point' in the \
                     plane or on the axis of the nodes, or more 'directions'"
                ));
            }
            *value = None;
        }
        Ok(())
    }
}

/// The indices of the components of a motion in `dim` dimensions.
fn components(dim: usize) -> &'static [usize] {
    match dim {
        2 => &[0, 1, 5],
        _ => &[0, 1, 2, 3, 4, 5],
    }
}

/// True if two of the unit vectors aren't perpendicular.
pub(super) fn are_skew(directions: &[[f64; 3]]) -> bool {
    (0..directions.len())
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .any(|(i, j)| dot(directions[i], directions[j]).abs() > NOTHING)
}
