//! Pretensions of bolts: equations across a cut of the mesh.
//!
//! The mesh is cut along facets inside the bolt, so that every node of them is duplicated, on side a and on side b.
//! With n the outward normal of side a, or the direction given by the scene, and a pair (a₀, b₀) of these nodes near
//! the centre
//!
//! ```text
//! n·(u_a − u_b) − n·(u_a₀ − u_b₀) = 0,   t·(u_a − u_b) = 0,   δ = n·(u_a₀ − u_b₀)
//! ```
//!
//! for all pairs: the sides overlap by the shortening δ of the bolt. A force F is applied to a₀ along n and to b₀ in
//! the opposite direction, with the work F δ. A shortening that is given, or locked at the current value, is one more
//! equation. When locked, it is activated in a load step like any contact, at the current jump of its nodes. With its
//! multiplier λ, 0 while it is inactive, the force across the cut is F − λ.
//!
//! So a pretension needs no extra unknown, which rigid-body motions would have to leave out, and fronts, clusters, the
//! certificate and the refinement treat it like any equation.

mod cut;

pub(super) use self::cut::{cut, other_side};
use super::bodies::Bodies;
use super::held_nodes::HeldNodes;
use super::steps::Loads;
use super::surface::Surface;
use super::{Contact, groups};
use crate::contact_point::{ContactPoint, Law, LocalFrame};
use crate::element::geometry::{advance, difference, dot, length};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::pretension::{Pretension, Tightening};

/// Area of a cut projected along its bolt, relative to the cut's area, above which the cut counts as transverse.
const ACROSS: f64 = 0.5;

/// The pretensions of a scene on the mesh.
#[derive(Default)]
pub(super) struct Pretensions {
    /// The equations of each cut, followed by the equation that holds its shortening if any step does.
    pub contacts: Vec<Contact>,
    /// The numbers of inactive equations, step by step.
    pub absent: Vec<Vec<u32>>,
}

impl Pretensions {
    /// The pretensions across the opened cuts, the contacts numbered from `first` on; their forces are added to
    /// `loads`.
    ///
    /// # Errors
    /// A direction along the cut, a bolt that a step adds or removes.
    pub fn new(
        scene: &Scene,
        (bodies, topology): (&Bodies, &Topology),
        cuts: &[Vec<[u32; 2]>],
        loads: &mut Loads,
        first: usize,
    ) -> Result<Self, InputError> {
        let mut all = Self {
            contacts: Vec::new(),
            absent: vec![Vec::new(); scene.step.len()],
        };
        let held = HeldNodes::new(loads);
        for (pretension, pairs) in scene.pretension.iter().zip(cuts) {
            check_presence(scene, bodies, pretension, pairs)?;
            let bolt = Bolt::new(scene, (&bodies.mesh, topology), pretension, pairs)?;
            let given = pretension.in_steps(&scene.step);
            let number = (first + all.contacts.len()) as u32;
            let points = bolt.equations(&given);
            let slack = 0.0;
            let [points, _] =
                held.without_prescribed((number, &bolt.what), points, slack, scene.units)?;
            all.contacts.push(contact(pretension.name.clone(), points));
            let is_free = |given: &Tightening| matches!(given, Tightening::Force(_));
            if !given.iter().all(is_free) {
                let point = ContactPoint {
                    contact: number + 1,
                    ..bolt.hold(&given)
                };
                all.contacts.push(contact(pretension.hold(), vec![point]));
                let steps = all.absent.iter_mut().zip(&given);
                for (absent, _) in steps.filter(|(_, given)| is_free(given)) {
                    absent.push(number + 1);
                }
            }
            bolt.add_forces(&given, loads);
        }
        Ok(all)
    }
}

fn contact(name: String, points: Vec<ContactPoint<u32>>) -> Contact {
    Contact {
        name,
        points,
        probes: Vec::new(),
        prescribed: Vec::new(),
    }
}

/// Refuses a bolt that a step adds or removes.
fn check_presence(
    scene: &Scene,
    bodies: &Bodies,
    pretension: &Pretension,
    pairs: &[[u32; 2]],
) -> Result<(), InputError> {
    let absent = super::activation::bodies(scene);
    let is_on_cut = |nodes: &[u32]| {
        pairs
            .iter()
            .any(|[a, b]| nodes.contains(a) || nodes.contains(b))
    };
    let cells = bodies.mesh.cells.iter().zip(&bodies.cell_body);
    let goes = |body: &u32| absent.iter().any(|absent| absent.contains(body));
    let mut going = cells.filter(|(_, body)| goes(body));
    match going.find(|((_, nodes), _)| is_on_cut(nodes)) {
        None => Ok(()),
        Some(_) => Err(InputError::new(format!(
            "pretension '{}': its body is added or removed, which isn't supported; expected a body that is active in all steps",
            pretension.name
        ))),
    }
}

/// A cut and the direction in which it is tightened.
struct Bolt<'a> {
    mesh: &'a Mesh,
    what: String,
    /// Pairs of nodes of sides a and b, the central pair first.
    pairs: Vec<[u32; 2]>,
    frame: LocalFrame,
}

impl<'a> Bolt<'a> {
    fn new(
        scene: &Scene,
        (mesh, topology): (&'a Mesh, &Topology),
        pretension: &Pretension,
        pairs: &[[u32; 2]],
    ) -> Result<Self, InputError> {
        let what = format!("pretension '{}'", pretension.name);
        let facets = groups::facets(mesh, &pretension.on, &what)?;
        let surface = Surface::new(mesh, topology, scene.plane, &facets, &what)?;
        let areas = surface.facets.iter().map(|facet| facet.measure);
        let area: f64 = areas.sum();
        let sum = (surface.facets.iter()).fold([0.0; 3], |sum, facet| {
            let size = length(facet.normal);
            advance(sum, facet.measure / size, facet.normal)
        });
        let given = pretension
            .direction
            .as_ref()
            .map_or(sum, |direction| direction.value);
        let along = dot(sum, given) / length(given);
        if along.abs() < ACROSS * area {
            return Err(InputError::new(format!(
                "{what}: its facets lie along the direction of the bolt, or back and forth; expected a cut across it"
            )));
        }
        let normal = given.map(|c| c * along.signum() / length(given));
        let at = |pair: &[u32; 2]| mesh.points[pair[0] as usize];
        let middle = pairs.iter().fold([0.0; 3], |sum, pair| {
            advance(sum, 1.0 / pairs.len() as f64, at(pair))
        });
        let far = |pair: &[u32; 2]| length(difference(at(pair), middle));
        let mut pairs = pairs.to_vec();
        let places = 0..pairs.len();
        if let Some(nearest) = places.min_by(|&i, &j| far(&pairs[i]).total_cmp(&far(&pairs[j]))) {
            pairs.swap(0, nearest);
        }
        Ok(Self {
            mesh,
            what,
            pairs,
            frame: LocalFrame::new(normal),
        })
    }

    /// The equation Σ sign·(axis·u(node)) = 0 of `entries` (node, sign, axis).
    fn point(&self, entries: &[(u32, f64, [f64; 3])]) -> ContactPoint<u32> {
        let (node, _, normal) = entries[0];
        let all = entries.iter();
        let axes = all.clone().map(|(_, sign, axis)| axis.map(|c| sign * c));
        ContactPoint {
            area: 1.0,
            law: Law::Tied,
            axes: axes.collect(),
            tag_b: self.mesh.node_tags[entries[1].0 as usize],
            ..ContactPoint::new(
                all.map(|(node, ..)| (*node, 1.0)).collect(),
                normal,
                self.mesh.points[node as usize],
                self.mesh.node_tags[node as usize],
            )
        }
    }

    /// The equations of the cut; the first one carries the given forces.
    fn equations(&self, given: &[Tightening]) -> Vec<ContactPoint<u32>> {
        let n = self.frame.normal;
        let [a_0, b_0] = self.pairs[0];
        let along = self.pairs[1..]
            .iter()
            .map(|&[a, b]| self.point(&[(a, 1.0, n), (b, -1.0, n), (a_0, -1.0, n), (b_0, 1.0, n)]));
        let across = self.pairs.iter().flat_map(|&[a, b]| {
            let tangents = self.frame.tangents[..self.mesh.dim - 1].iter();
            tangents.map(move |&t| self.point(&[(a, 1.0, t), (b, -1.0, t)]))
        });
        let mut points: Vec<_> = along.chain(across).collect();
        points[0].preload = given.iter().map(|given| given.force()).collect();
        points
    }

    /// The equation that holds the shortening, distinguished from those of the cut by its two tags.
    fn hold(&self, given: &[Tightening]) -> ContactPoint<u32> {
        let n = self.frame.normal;
        let [a, b] = self.pairs[0];
        let length = |given: &Tightening| match given {
            Tightening::Shortening(length) => *length,
            Tightening::Force(_) | Tightening::Locked(_) => 0.0,
        };
        let gap = length(&given[0]);
        let motion = given
            .iter()
            .map(|given| n.map(|c| (length(given) - gap) * c));
        let is_still = given.iter().all(|given| length(given) == gap);
        ContactPoint {
            gap,
            motion: if is_still {
                Vec::new()
            } else {
                motion.collect()
            },
            tag_a: -1,
            ..self.point(&[(a, 1.0, n), (b, -1.0, n)])
        }
    }

    /// Adds the given forces to the loads of all steps.
    fn add_forces(&self, given: &[Tightening], loads: &mut Loads) {
        if given.iter().all(|given| given.force() == 0.0) {
            return;
        }
        let [a, b] = self.pairs[0];
        let n = self.frame.normal;
        for (node, sign) in [(a, 1.0), (b, -1.0)] {
            let forces = &mut loads.forces;
            let place = match forces.binary_search_by_key(&node, |&(node, _)| node) {
                Ok(place) => place,
                Err(place) => {
                    forces.insert(place, (node, [0.0; 3]));
                    let steps = loads.steps.iter_mut();
                    steps.for_each(|step| step.forces.insert(place, [0.0; 3]));
                    place
                }
            };
            let add = |force: &mut [f64; 3], given: &Tightening| {
                *force = advance(*force, sign * given.force(), n);
            };
            add(&mut forces[place].1, &given[0]);
            for (step, given) in loads.steps.iter_mut().zip(given) {
                add(&mut step.forces[place], given);
            }
        }
    }
}

impl Tightening {
    /// The force on the two sides of the cut (N).
    fn force(&self) -> f64 {
        match *self {
            Self::Force(force) | Self::Locked(force) => force,
            Self::Shortening(_) => 0.0,
        }
    }
}
