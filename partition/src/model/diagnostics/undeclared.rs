//! Bodies that touch where no contact keeps them from passing through each other.

use std::collections::{BTreeMap, HashSet};

use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, RTree};

use super::Diagnostics;
use crate::magnitude::short;
use crate::mesh::topology::CellFacet;
use crate::model::groups;
use crate::scene::condition::Contact;

/// Distance up to which facets touch, relative to their length.
const TOUCHING: f64 = 1e-6;
/// Cosine up to which they face each other.
const OPPOSITE: f64 = -0.99;

/// A facet of the boundary from end to end, with its body to the left, and that body.
struct Chord {
    start: [f64; 2],
    end: [f64; 2],
    body: u32,
}

impl Chord {
    fn along(&self) -> [f64; 2] {
        [self.end[0] - self.start[0], self.end[1] - self.start[1]]
    }

    fn middle(&self) -> [f64; 2] {
        [0, 1].map(|axis| 0.5 * (self.start[axis] + self.end[axis]))
    }

    fn length(&self) -> f64 {
        let [x, y] = self.along();
        x.hypot(y)
    }

    /// Whether `other` faces it and goes through its middle.
    fn is_touched_by(&self, other: &Self) -> bool {
        let ([x, y], [u, v]) = (self.along(), other.along());
        let lengths = self.length() * other.length();
        if x * u + y * v > OPPOSITE * lengths {
            return false;
        }
        let middle = self.middle();
        let [s, t] = [0, 1].map(|axis| middle[axis] - other.start[axis]);
        let part = (s * u + t * v) / (u * u + v * v);
        let aside = (s * v - t * u).abs() / other.length();
        (0.0..=1.0).contains(&part) && aside <= TOUCHING * self.length()
    }
}

impl Diagnostics<'_> {
    /// In the plane: facets that lie on each other, neither of which is on a side of a contact: body by body.
    pub(super) fn undeclared(&self) -> Vec<String> {
        if self.bodies.mesh.dim != 2 {
            return Vec::new();
        }
        let chords = self.free_chords();
        let leaf = |(index, chord): (usize, &Chord)| {
            GeomWithData::new(Line::new(chord.start, chord.end), index)
        };
        let tree = RTree::bulk_load(chords.iter().enumerate().map(leaf).collect());
        let mut found: BTreeMap<(u32, u32), Vec<[f64; 2]>> = BTreeMap::new();
        for chord in &chords {
            let middle = chord.middle();
            let margin = TOUCHING * chord.length();
            let near = AABB::from_corners(middle.map(|c| c - margin), middle.map(|c| c + margin));
            let touching = (tree.locate_in_envelope_intersecting(near))
                .map(|leaf| &chords[leaf.data])
                .filter(|other| chord.is_touched_by(other));
            if let Some(body) = touching.map(|other| other.body).min() {
                let pair = (chord.body.min(body), chord.body.max(body));
                found.entry(pair).or_default().push(middle);
            }
        }
        let name = |body: u32| self.scene.bodies.keys().nth(body as usize);
        let warnings = found.into_iter().filter_map(|((a, b), places)| {
            let who = match a == b {
                true => format!("body '{}' touches itself", name(a)?),
                false => format!("bodies '{}' and '{}' touch", name(a)?, name(b)?),
            };
            let [x, y] = places[0].map(short);
            Some(format!(
                "{who} without a contact, as at ({x}, {y}): nothing keeps them from passing through each other"
            ))
        });
        warnings.collect()
    }

    /// The boundary but for the sides of contacts.
    fn free_chords(&self) -> Vec<Chord> {
        let mesh = &self.bodies.mesh;
        let mut on_sides = HashSet::new();
        for names in self.scene.contact.iter().flat_map(Contact::sides) {
            let facets = groups::facets(mesh, names, "").unwrap_or_default();
            let nodes = facets.into_iter().map(|f| mesh.facets.nodes_of(f as usize));
            on_sides.extend(nodes.flat_map(|nodes| self.topology.cells_at(nodes)));
        }
        let free = self
            .topology
            .boundary()
            .filter(|facet| !on_sides.contains(facet));
        let chord = |facet: CellFacet| {
            let cell = facet.cell as usize;
            let (_, local) = mesh.cells.kind(cell).facets()[facet.facet as usize];
            let nodes = mesh.cells.nodes_of(cell);
            let at = |i: usize| {
                let [x, y, _] = mesh.points[nodes[local[i]] as usize];
                [x, y]
            };
            Chord {
                start: at(0),
                end: at(1),
                body: self.bodies.cell_body[cell],
            }
        };
        free.map(chord).collect()
    }
}
