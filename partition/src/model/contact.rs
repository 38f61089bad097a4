//! Γ_c: contacts n·(u_a − u_b) ≤ g as rows of B u ≤ g.

mod given_gap;
mod laws;
mod single_nodes;
mod tie;
mod warnings;

use std::collections::{BTreeMap, HashSet};

use super::held_nodes::{HeldNodes, ROUNDING};
use super::mortar::{self, Mortar};
use super::node_pairs::Unpaired;
use super::sides::{Sides, side_nodes};
use super::surface::{Surface, SurfaceFacet};
use super::{Contact, groups, node_pairs, obstacle};
use crate::contact_point::{ContactPoint, Probe};
use crate::error::InputError;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::condition::{Names, Obstacle};
use crate::scene::contact::{self, Pairing, Partner};
use crate::scene::material::PlaneState;
use crate::scene::units::Units;

/// Relative measured gap in space below which it is set to zero: round-off of coordinates would hold bodies apart, or
/// press them together, and where several contacts meet no displacement could fulfil all their constraints.
const NO_GAP: f64 = 1e-15;

/// The points of a contact before its laws are assigned.
#[derive(Default)]
struct Paired {
    points: Vec<ContactPoint<u32>>,
    /// Points at which the side without constraints is checked for penetration.
    probes: Vec<Probe<u32>>,
    /// Largest distance of straight facets from the curve that they approximate (m).
    off: f64,
    /// The sagitta of facets in the middle of a curve, where the meshes of the sides don't match; else 0 (m).
    sagitta: f64,
    warnings: Vec<String>,
}

impl Paired {
    /// Closes gaps up to a distance, and all overlaps; `None` leaves them unchanged.
    fn close(&mut self, distance: Option<f64>) {
        let gaps = (self.points.iter_mut().map(|point| &mut point.gap))
            .chain(self.probes.iter_mut().map(|probe| &mut probe.gap));
        gaps.filter(|gap| distance.is_some_and(|distance| **gap <= distance))
            .for_each(|gap| *gap = 0.0);
    }
}

/// Data from which contacts are built.
pub(super) struct Contacts<'a> {
    mesh: &'a Mesh,
    topology: &'a Topology,
    held: HeldNodes,
    /// The displacements of obstacles, by the names of their contacts.
    motions: BTreeMap<&'a str, Vec<[f64; 3]>>,
    /// The largest coordinate (m).
    size: f64,
    plane: Option<PlaneState>,
    units: Units,
}

impl<'a> Contacts<'a> {
    pub fn new(mesh: &'a Mesh, topology: &'a Topology, held: HeldNodes, scene: &'a Scene) -> Self {
        let coordinates = mesh.points.iter().flatten();
        Self {
            mesh,
            topology,
            held,
            motions: scene.motions(),
            size: coordinates.map(|c| c.abs()).fold(0.0, f64::max),
            plane: scene.plane,
            units: scene.units,
        }
    }

    /// Builds contact or tie `number` of the scene.
    pub fn declared(
        &self,
        number: u32,
        keys: &contact::Contact,
        warnings: &mut Vec<String>,
    ) -> Result<Contact, InputError> {
        match (keys.tie, &keys.partner) {
            (Some(reach), Partner::Side(names)) => self.tie(number, keys, (names, reach), warnings),
            _ => self.contact(number, keys, warnings),
        }
    }

    /// The points of contact `number` of the scene, along side a.
    fn contact(
        &self,
        number: u32,
        keys: &contact::Contact,
        warnings: &mut Vec<String>,
    ) -> Result<Contact, InputError> {
        let what = format!("contact '{}'", keys.name);
        let (side_a, mut paired) = self.paired(number, keys, &what)?;
        warnings.append(&mut paired.warnings);
        warnings.extend(Self::straight_edges(&what, "a", &side_a));
        let none = if self.mesh.dim == 3 {
            NO_GAP * self.size
        } else {
            0.0
        };
        for point in paired.points.iter_mut().filter(|p| p.gap.abs() < none) {
            point.gap = 0.0;
        }
        paired.close(keys.adjust);
        match &keys.gap {
            Some(gap) => warnings.extend(self.give_gap(gap, &mut paired, &side_a, &what)?),
            None => warnings.extend(self.gaps_of_facets(&paired, &side_a, &what)),
        }
        let Paired {
            mut points,
            mut probes,
            off,
            ..
        } = paired;
        if let Some(friction) = &keys.friction {
            warnings.extend(laws::give_friction(friction, &mut points, &what)?);
        }
        (points.iter_mut()).for_each(|point| point.is_absolute = keys.absolute);
        if let Some(stiffness) = &keys.stiffness {
            laws::give_stiffness(stiffness, &mut points, &what)?;
            // Compliant sides overlap under pressure, which a probe would report as penetration.
            probes.clear();
        }
        if !keys.interference {
            warnings.extend(self.interference(&points, &side_a, off, &what));
        }
        let count = points.len();
        let [kept, prescribed] = self.without_prescribed((number, &what), points)?;
        if kept.is_empty() {
            warnings.push(format!(
                "{what}: all its nodes are prescribed; it has no condition"
            ));
        } else if keys.friction.is_some() && kept.len() < count {
            warnings.push(format!(
                "{what}: {} of its {count} nodes are prescribed along the normal, so that nothing presses there and \
                 there is no friction",
                count - kept.len()
            ));
        }
        Ok(Contact {
            name: keys.name.clone(),
            points: kept,
            probes,
            prescribed,
        })
    }

    /// The points of contact `number` according to its sides or its obstacle, and the side by whose size they are
    /// checked.
    fn paired(
        &self,
        number: u32,
        keys: &contact::Contact,
        what: &str,
    ) -> Result<(Surface, Paired), InputError> {
        if let (true, Partner::Side(names)) = (
            groups::are_of_points(self.mesh, &keys.side_a),
            &keys.partner,
        ) {
            return self.single_nodes(keys, names, what);
        }
        let (facets, side_a) = self.side(&keys.side_a, what)?;
        let paired = match &keys.partner {
            Partner::Obstacle(obstacle) => {
                let motion = self.motions.get(&keys.name[..]).cloned();
                self.of_obstacle((obstacle, motion.unwrap_or_default()), &side_a, what)?
            }
            Partner::Side(names) => {
                let on_a = facets.into_iter().collect();
                self.sides(number, (&on_a, &side_a), names, keys.pairing, what)?
            }
        };
        Ok((side_a, paired))
    }

    /// The points whose normal jump is free, and those of which supports prescribe it.
    fn without_prescribed(
        &self,
        of: (u32, &str),
        points: Vec<ContactPoint<u32>>,
    ) -> Result<[Vec<ContactPoint<u32>>; 2], InputError> {
        let slack = ROUNDING * self.size;
        (self.held).without_prescribed(of, points, slack, self.units)
    }

    /// The points of side a that face an obstacle, and the obstacle's motion.
    fn of_obstacle(
        &self,
        obstacle: (&Obstacle, Vec<[f64; 3]>),
        side_a: &Surface,
        what: &str,
    ) -> Result<Paired, InputError> {
        let nodes = side_nodes(self.mesh, side_a, what, &HashSet::new())?;
        let points = obstacle::points(self.mesh, obstacle, side_a, nodes);
        Ok(Paired {
            points: points.map_err(InputError::about(what))?,
            ..Paired::default()
        })
    }

    /// The points of contact `number` between side a, whose facets are `on_a`, and the side of these `names`.
    ///
    /// # Errors
    /// A facet on both sides, or sides that don't match.
    fn sides(
        &self,
        number: u32,
        (on_a, side_a): (&HashSet<u32>, &Surface),
        names: &Names,
        pairing: Option<Pairing>,
        what: &str,
    ) -> Result<Paired, InputError> {
        let (facets_b, side_b) = self.side(names, what)?;
        if let Some(&both) = facets_b.iter().find(|facet| on_a.contains(facet)) {
            return Err(InputError::new(format!(
                "{what}: the facet of nodes {} is on both sides",
                self.mesh.tags_of(self.mesh.facets.nodes_of(both as usize))
            )));
        }
        let paired = self.pairs(side_a, &side_b, pairing, what)?;
        let corner = self.corner(side_a, &paired.points, what);
        let straight = Self::straight_edges(what, "b", &side_b);
        let mut probes = paired.probes;
        let slack = 2.0 * side_a.kinks().max(side_b.kinks());
        for probe in &mut probes {
            probe.contact = number;
            // Straight facets that approximate the same curve overlap without load.
            if probe.gap < 0.0 {
                probe.gap = (probe.gap + slack).min(0.0);
            }
        }
        // Opposite nodes lie on the curve, whatever facets are between them.
        let are_nodes = paired.points.iter().all(|point| point.entries.len() == 2);
        let sagitta = match are_nodes {
            true => 0.0,
            false => side_a.sagitta_of_curve().max(side_b.sagitta_of_curve()),
        };
        Ok(Paired {
            points: paired.points,
            probes,
            off: side_a.sagitta().max(side_b.sagitta()),
            sagitta,
            warnings: (corner.into_iter().chain(straight))
                .chain(paired.warning)
                .collect(),
        })
    }

    fn side(&self, names: &Names, what: &str) -> Result<(Vec<u32>, Surface), InputError> {
        let facets = groups::facets(self.mesh, names, what)?;
        let what = format!("{what}, side {names}");
        let surface = Surface::new(self.mesh, self.topology, self.plane, &facets, &what)?;
        let on_axis = |facet: &&SurfaceFacet| facet.area() == 0.0;
        if let Some(facet) = surface.facets.iter().find(on_axis) {
            return Err(InputError::new(format!(
                "{what}: the facet of nodes {} lies on the axis; expected sides off it",
                self.mesh.tags_of(&facet.nodes)
            )));
        }
        Ok((facets, surface))
    }

    /// The points of two sides, with the discretization given in the scene or the one that their nodes allow.
    fn pairs(
        &self,
        side_a: &Surface,
        side_b: &Surface,
        pairing: Option<Pairing>,
        what: &str,
    ) -> Result<Mortar, InputError> {
        let refused = InputError::about(what);
        let sides = Sides::new(self.mesh, side_a, side_b, what)?;
        let are_weightless = (side_a.facets.iter()).any(|facet| !facet.blending().is_none());
        let matched = match pairing {
            Some(Pairing::Nodes) if are_weightless => {
                return Err(refused(
                    "nodes can't be paired on quadratic faces without a node in the middle, whose corners would pull, nor \
                     on quadratic cells at an axis, where one would carry nothing; expected pairing = \"mortar\", or none"
                        .into(),
                ));
            }
            None if are_weightless => return mortar::pair(&sides, what).map_err(refused),
            Some(Pairing::Mortar) => return mortar::pair(&sides, what).map_err(refused),
            Some(Pairing::Nodes) | None => node_pairs::points(&sides),
        };
        match (matched, pairing) {
            (Ok(points), _) => Ok(Mortar {
                points,
                probes: Vec::new(),
                warning: None,
            }),
            (Err(Unpaired::Unmatched(_)), None) => mortar::pair(&sides, what).map_err(refused),
            (Err(Unpaired::Unmatched(reason) | Unpaired::Apart(reason)), _) => Err(refused(reason)),
        }
    }
}
