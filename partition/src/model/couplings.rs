//! Couplings: equations by which nodes follow the motion of a reference point.
//!
//! The motion of a point R is that of the corners of a frame, R, R + L e₁ and in space R + L e₂. These are nodes
//! without cells. With their displacements p₀, p₁, p₂
//!
//! ```text
//! u(x) = p₀ + θ × (x − R),   θ = ((p₂ − p₀)·e₃, −(p₁ − p₀)·e₃, (p₁ − p₀)·e₂) / L
//! ```
//!
//! They belong to the body of the coupled side, so that they take part in its rigid-body motions.

mod frame;
mod partial;

use nalgebra::{Matrix3, Vector3};

pub(super) use self::frame::Form;
use self::frame::{Acting, Frame, FrameLoads};
use self::partial::{FollowingNode, NO_INERTIA, Uncoupled};
use super::loads::surface_load;
use super::steps::Loads;
use super::surface::Surface;
use super::{Contact, Support, groups};
use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, difference, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::coupling::{COMPONENTS, Coupling, CouplingKind, CouplingLoads};
use crate::scene::step::{LoadStep, Scale};

/// A coupling on the mesh.
pub(super) struct CoupledFrame {
    frame: Frame,
    /// The components of the point's motion without coupling.
    uncoupled: Option<Uncoupled>,
    /// The equations.
    pub contact: Contact,
    /// A cell of the body that the frame belongs to.
    pub cell: u32,
    /// The loads in every load step, or a single entry without load steps.
    pub loads: Vec<FrameLoads>,
}

impl CoupledFrame {
    /// A component of the point's motion, from 0, as a vector of coefficients for each node.
    ///
    /// # Errors
    /// A component without coupling.
    pub fn component(&self, component: usize) -> Result<Form, String> {
        let unit = std::array::from_fn(|k| f64::from(u8::from(k == component)));
        if let Some(uncoupled) = &self.uncoupled
            && !uncoupled.is_coupled(unit)
        {
            return Err(format!(
                "'{}' of the coupling '{}' isn't coupled to any node; expected a component that is, or more 'directions'",
                COMPONENTS[component], self.contact.name
            ));
        }
        let mut form = Form::new();
        match component {
            0..3 => self.frame.add(&mut form, 0, component, 1.0),
            _ => self.frame.add_rotation(&mut form, component - 3, 1.0),
        }
        Ok(form)
    }

    /// The point (m).
    pub fn point(&self) -> [f64; 3] {
        self.frame.origin
    }
}

/// The couplings of a scene; the nodes of their frames follow those of the mesh.
///
/// # Errors
/// Groups that don't exist, nodes that don't determine the rotation of the point, values of components that aren't
/// prescribed.
pub(super) fn couplings(
    scene: &Scene,
    (mesh, topology): (&Mesh, &Topology),
) -> Result<Vec<CoupledFrame>, InputError> {
    let mut node = mesh.points.len() as u32;
    let mut all = Vec::new();
    let mut absent = scene.absent().into_iter().flatten();
    let comes = absent.find(|name| scene.bodies.contains_key(*name));
    if let (Some(coupling), Some(body)) = (scene.coupling.first(), comes) {
        return Err(InputError::new(format!(
            "coupling '{}': the body '{body}' is added or removed, which isn't supported beside couplings; expected bodies \
             that are active in all steps",
            coupling.name
        )));
    }
    for coupling in &scene.coupling {
        let what = format!("coupling '{}'", coupling.name);
        let of = CouplingOnMesh {
            scene,
            mesh,
            topology,
            coupling,
            what,
        };
        let coupled = of.frame(node)?;
        node += mesh.dim as u32;
        all.push(coupled);
    }
    Ok(all)
}

/// Appends the nodes of the frames to a mesh, their loads and supports to `loads`, and the names of their boundary
/// conditions to `names`; returns the equations, numbered from `number` on, and for every new node a cell of its body.
pub(super) fn attach(
    (frames, number): (Vec<CoupledFrame>, usize),
    mesh: &mut Mesh,
    loads: &mut Loads,
    names: &mut Vec<String>,
) -> (Vec<Contact>, Vec<u32>) {
    let (mut contacts, mut cells) = (Vec::new(), Vec::new());
    for (number, mut frame) in (number as u32..).zip(frames) {
        let first = frame.frame.first;
        for point in &mut frame.contact.points {
            point.contact = number;
        }
        for corner in frame.frame.corners() {
            let tag = mesh.node_tags.iter().max().map_or(1, |last| last + 1);
            mesh.points.push(corner);
            mesh.node_tags.push(tag);
            cells.push(frame.cell);
        }
        let all = &frame.loads;
        for (i, &(corner, axis, value)) in all[0].supports.iter().enumerate() {
            loads.supports.push(Support {
                node: first + corner as u32,
                direction: std::array::from_fn(|k| f64::from(u8::from(k == axis))),
                value,
                condition: names.len() as u32,
            });
            for (step, of_step) in loads.steps.iter_mut().zip(all) {
                step.supports.push(of_step.supports[i].2);
            }
        }
        if !all[0].supports.is_empty() {
            names.push(format!("coupling '{}'", frame.contact.name));
        }
        let is_loaded = |corner: &usize| all.iter().any(|of| of.forces[*corner] != [0.0; 3]);
        for corner in (0..3).filter(is_loaded) {
            loads
                .forces
                .push((first + corner as u32, all[0].forces[corner]));
            for (step, of_step) in loads.steps.iter_mut().zip(all) {
                step.forces.push(of_step.forces[corner]);
            }
        }
        contacts.push(frame.contact);
    }
    (contacts, cells)
}

/// A coupling and its nodes.
struct CouplingOnMesh<'a> {
    scene: &'a Scene,
    mesh: &'a Mesh,
    topology: &'a Topology,
    coupling: &'a Coupling,
    what: String,
}

impl CouplingOnMesh<'_> {
    /// The coupling with its frame, whose nodes are numbered from `first` on.
    fn frame(&self, first: u32) -> Result<CoupledFrame, InputError> {
        let mesh = self.mesh;
        let weights = self.weights()?;
        let origin = self.coupling.point.value;
        let far = |(node, _): &(u32, f64)| length(difference(mesh.points[*node as usize], origin));
        let size = weights.iter().map(far).fold(0.0, f64::max);
        let frame = Frame {
            first,
            origin,
            size,
            dim: mesh.dim,
        };
        let of_first = |(_, nodes): (_, &[u32])| nodes.contains(&weights[0].0);
        let Some(cell) = mesh.cells.iter().position(of_first) else {
            return Err(self.refused("its nodes belong to no cell of a body"));
        };
        let mut steps = self.steps();
        let mut uncoupled = None;
        let mut forms = match (self.coupling.kind, &self.coupling.directions[..]) {
            (CouplingKind::Rigid, []) => self.rigid(&frame, &weights)?,
            (CouplingKind::Rigid, _) => {
                let (forms, others) = self.partial(&frame, &weights, &mut steps)?;
                uncoupled = Some(others);
                forms
            }
            (CouplingKind::Distributing, _) => self.distributing(&frame, &weights)?,
        };
        forms.extend(frame.rigid());
        let mut points: Vec<ContactPoint<u32>> =
            (forms.iter()).map(|form| frame.point(form, &[])).collect();
        points.extend(frame.turned(&steps));
        for (place, point) in (0..).zip(&mut points) {
            point.place = place;
        }
        Ok(CoupledFrame {
            contact: Contact {
                name: self.coupling.name.clone(),
                points,
                probes: Vec::new(),
                prescribed: Vec::new(),
            },
            cell: cell as u32,
            loads: steps.iter().map(|step| frame.loads(step)).collect(),
            frame,
            uncoupled,
        })
    }

    fn refused(&self, why: &str) -> InputError {
        InputError::new(format!("{}: {why}", self.what))
    }

    /// The coupled nodes and their shares of a force: those of a uniform traction on sides, otherwise equal ones.
    fn weights(&self) -> Result<Vec<(u32, f64)>, InputError> {
        let (mesh, what) = (self.mesh, &self.what[..]);
        let nodes = groups::boundary_nodes(mesh, &self.coupling.on, what)?;
        if !groups::are_of_facets(mesh, &self.coupling.on) {
            let share = 1.0 / nodes.len() as f64;
            return Ok(nodes.into_iter().map(|node| (node, share)).collect());
        }
        let facets = groups::facets(mesh, &self.coupling.on, what)?;
        let surface = Surface::new(mesh, self.topology, self.scene.plane, &facets, what)?;
        let mut shares = vec![[0.0; 3]; mesh.points.len()];
        surface_load(&surface, &mut shares, |_, area| {
            Ok([length(area), 0.0, 0.0])
        })
        .map_err(InputError::about(what))?;
        let sum: f64 = nodes.iter().map(|&node| shares[node as usize][0]).sum();
        let share = |node: u32| (node, shares[node as usize][0] / sum);
        Ok(nodes.into_iter().map(share).collect())
    }

    /// Loads of every load step, by default those of the scene.
    fn steps(&self) -> Vec<Acting> {
        let own = &self.coupling.loads;
        let acting = |step: Option<&LoadStep>| {
            let none = CouplingLoads::default();
            let given = step.and_then(|step| step.coupling.get(&self.coupling.name));
            let given = given.unwrap_or(&none);
            let scale = step.map_or_else(Scale::default, |step| step.scale);
            let force = given.force.as_ref().or(own.force.as_ref());
            let moment = given.moment.as_ref().or(own.moment.as_ref());
            let (new, old) = (given.prescribed(), own.prescribed());
            Acting {
                force: force.map_or([0.0; 3], |force| force.value.map(|c| scale.force * c)),
                moment: moment.map_or([0.0; 3], |moment| moment.value().map(|c| scale.force * c)),
                motion: std::array::from_fn(|k| {
                    new[k].or(old[k]).map(|value| scale.displacement * value)
                }),
            }
        };
        match self.scene.step.is_empty() {
            true => vec![acting(None)],
            false => self
                .scene
                .step
                .iter()
                .map(|step| acting(Some(step)))
                .collect(),
        }
    }

    /// Σ w (|r|² I − r rᵀ) of weighted nodes about a point.
    ///
    /// # Errors
    /// Nodes that don't determine a rotation.
    fn inertia(&self, weights: &[(u32, f64)], about: [f64; 3]) -> Result<Matrix3<f64>, InputError> {
        let mut inertia = Matrix3::zeros();
        for &(node, w) in weights {
            let r = Vector3::from(difference(self.mesh.points[node as usize], about));
            inertia += (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * w;
        }
        let (least, most) = match self.mesh.dim {
            2 => (inertia[(2, 2)], inertia[(2, 2)]),
            _ => {
                let all = inertia.symmetric_eigenvalues();
                (all.min(), all.max())
            }
        };
        match most > 0.0 && least > NO_INERTIA * most {
            true => Ok(inertia),
            false => Err(self.refused(
                "its nodes don't determine how the point turns, as they lie on a line with it; expected a side, or nodes that don't",
            )),
        }
    }

    /// The equations of a rigid coupling.
    fn rigid(&self, frame: &Frame, weights: &[(u32, f64)]) -> Result<Vec<Form>, InputError> {
        self.inertia(weights, frame.origin)?;
        let of_node = |&(node, _): &(u32, f64)| {
            (0..frame.dim).map(move |axis| {
                let mut form = Form::new();
                form.entry(node).or_default()[axis] += 1.0;
                frame.add_at(&mut form, self.mesh.points[node as usize], axis, -1.0);
                form
            })
        };
        Ok(weights.iter().flat_map(of_node).collect())
    }

    /// The equations of nodes that follow the point along some directions, and the components without coupling; where
    /// these are prescribed, they are removed from the `steps`.
    fn partial(
        &self,
        frame: &Frame,
        weights: &[(u32, f64)],
        steps: &mut [Acting],
    ) -> Result<(Vec<Form>, Uncoupled), InputError> {
        let mut directions = Vec::new();
        for direction in &self.coupling.directions {
            let size = length(direction.value);
            if size == 0.0 {
                return Err(
                    self.refused("a direction of length 0; expected one along which nodes follow")
                );
            }
            directions.push(direction.value.map(|c| c / size));
        }
        if partial::are_skew(&directions) {
            return Err(self.refused("its directions aren't perpendicular; expected ones that are"));
        }
        let at = |node: u32| self.mesh.points[node as usize];
        let mut nodes = Vec::with_capacity(weights.len());
        for &(node, _) in weights {
            let turned = |direction: &[f64; 3]| match &self.coupling.axis {
                Some(axis) => axis.vector(*direction, at(node)),
                None => Some(*direction),
            };
            // On the axis the radial and the tangential direction don't exist.
            let directions = directions.iter().filter_map(turned).collect();
            nodes.push(FollowingNode {
                node,
                place: at(node),
                directions,
            });
        }
        let uncoupled = Uncoupled::new(frame, &nodes);
        for acting in steps {
            let free = uncoupled.free(frame, acting);
            free.map_err(|why| self.refused(&why))?;
        }
        let mut forms = partial::forms(frame, &nodes);
        let middle = (weights.iter()).fold([0.0; 3], |sum, &(node, w)| advance(sum, w, at(node)));
        let inertia = self.inertia(weights, middle)?;
        let mut means = self.distributing(frame, weights)?;
        let turns = means.split_off(frame.dim);
        let arm = difference(frame.origin, middle);
        let rest = uncoupled.forms(frame, (&means, &turns), &inertia, arm);
        forms.extend(
            rest.ok_or_else(|| self.refused("its nodes don't determine how the point turns"))?,
        );
        Ok((forms, uncoupled))
    }

    /// The equations of a distributing coupling: Σ w u is the displacement of the nodes' centre, and Σ w r × u
    /// determines the rotation.
    fn distributing(&self, frame: &Frame, weights: &[(u32, f64)]) -> Result<Vec<Form>, InputError> {
        let at = |node: u32| self.mesh.points[node as usize];
        let middle = (weights.iter()).fold([0.0; 3], |sum, &(node, w)| advance(sum, w, at(node)));
        let inertia = self.inertia(weights, middle)?;
        let mean = |axis: usize| {
            let mut form = Form::new();
            for &(node, w) in weights {
                form.entry(node).or_default()[axis] += w;
            }
            frame.add_at(&mut form, middle, axis, -1.0);
            form
        };
        let turned = |about: usize| {
            let mut form = Form::new();
            let (p, q) = ((about + 1) % 3, (about + 2) % 3);
            for &(node, w) in weights {
                let r = difference(at(node), middle);
                let of_node = form.entry(node).or_default();
                of_node[q] += w * r[p] / frame.size;
                of_node[p] -= w * r[q] / frame.size;
            }
            for other in frame.rotations() {
                frame.add_rotation(&mut form, other, -inertia[(about, other)] / frame.size);
            }
            form
        };
        let means = (0..frame.dim).map(mean);
        Ok(means.chain(frame.rotations().map(turned)).collect())
    }
}
