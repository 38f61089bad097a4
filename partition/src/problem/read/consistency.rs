//! Whether what a contact row says twice is the same, and fits the mesh of its group.

use std::collections::BTreeMap;

use crate::element::geometry::{advance, difference, dot, length};
use crate::error::InputError;
use crate::mesh::bounding_box::BoundingBox;
use crate::problem::{ContactRow, RowEntry, Subdomain};

/// How far coefficients may be from what the normal says, relative to the largest of them.
const COEFFICIENT: f64 = 1e-8;

/// How far positions may be from the node that they belong to, relative to the group's extent.
const PLACE: f64 = 1e-8;

/// Largest share relative to the group's extent: no curved side around a node is longer.
const LARGEST_SHARE: f64 = 10.0;

/// The subdomains of a group in contact.
pub(super) struct Members<'a> {
    by_index: BTreeMap<u32, &'a Subdomain>,
    /// The largest extent of their bounding box (m).
    extent: f64,
}

impl<'a> Members<'a> {
    pub fn new(members: &[&'a Subdomain]) -> Self {
        let points = members.iter().flat_map(|member| &member.points);
        Self {
            by_index: members.iter().map(|&m| (m.index as u32, m)).collect(),
            extent: BoundingBox::around(points).extent(),
        }
    }

    /// Checks one row, which stands in row `at` of the datasets.
    pub fn check(&self, row: &ContactRow, at: usize) -> Result<(), InputError> {
        self.fault(row).map_or(Ok(()), |(dataset, what)| {
            Err(InputError::new(format!(
                "dataset /contact/{dataset}, row {at}: {what}"
            )))
        })
    }

    /// What is wrong with a row, and in which dataset.
    fn fault(&self, row: &ContactRow) -> Option<(&'static str, String)> {
        let extent = self.extent;
        if row.share > LARGEST_SHARE * extent {
            let what = format!(
                "{:e}; expected a share of a side of the group, whose extent is {extent:e}",
                row.share
            );
            return Some(("share", what));
        }
        let along = |c: [f64; 3]| dot(c, row.normal);
        let scale = (row.entries.iter()).fold(0.0, |m, e| f64::max(m, length(e.coefficient)));
        let is_along =
            |c: [f64; 3]| length(advance(c, -along(c), row.normal)) <= COEFFICIENT * scale;
        if !row.entries.iter().all(|e| is_along(e.coefficient)) {
            let what =
                "the coefficients of the row aren't along its normal; expected multiples of it";
            return Some(("normal", what.into()));
        }
        let sum: f64 = row.entries.iter().map(|e| along(e.coefficient)).sum();
        let expected = f64::from(u8::from(row.entries.len() == 1));
        if (sum - expected).abs() > COEFFICIENT * scale {
            let what = format!(
                "the coefficients of the row sum to {sum} times its normal; expected {}",
                match row.entries.len() {
                    1 => "1, that of a node against an obstacle",
                    _ => "0: those of side a to the normal, those of side b to its opposite",
                }
            );
            return Some(("entry_coefficient", what));
        }
        self.fault_of_names(row)
    }

    /// The same of the nodes that a row names.
    fn fault_of_names(&self, row: &ContactRow) -> Option<(&'static str, String)> {
        for (dataset, tag, sign, side) in [
            ("node_a", row.tag_a, 1.0, "towards side b"),
            ("node_b", row.tag_b, -1.0, "towards side a"),
        ] {
            if tag == -1 {
                continue;
            }
            let found = row.entries.iter().find(|e| {
                let own = self.by_index.get(&e.subdomain);
                own.is_some_and(|member| member.node_tags[e.node as usize] == tag)
            });
            let Some(entry) = found.filter(|e| sign * dot(e.coefficient, row.normal) > 0.0) else {
                let what = format!(
                    "{tag}; expected -1 or the tag (GlobalNodeId) of a node of the row whose \
                     coefficient points {side}"
                );
                return Some((dataset, what));
            };
            if sign > 0.0 {
                let point = self.by_index[&entry.subdomain].points[entry.node as usize];
                let is_there =
                    |place: [f64; 3]| length(difference(place, point)) <= PLACE * self.extent;
                if !is_there(row.position) {
                    return Some(("position", displaced(row.position, point, tag)));
                }
                if !self.acts_there(row, entry) {
                    let [x, y, _] = row.acts_at;
                    let what = format!(
                        "({x}, {y}); expected the sum of (normal · coefficient) position over the \
                         nodes of side a"
                    );
                    return Some(("acts_at", what));
                }
            }
        }
        None
    }

    /// Whether the force of a row acts where its coefficients of side a, among them `own`, say.
    fn acts_there(&self, row: &ContactRow, own: &RowEntry) -> bool {
        let body = |e: &RowEntry| self.by_index.get(&e.subdomain).map(|member| member.body);
        let is_pair = row.entries.len() == 1 || row.tag_b != -1;
        // Where both sides belong to one body the nodes don't tell on which they are.
        if !is_pair && row.entries.iter().all(|e| body(e) == body(own)) {
            return true;
        }
        let on_a = |e: &&RowEntry| match is_pair {
            true => *e == own,
            false => body(e) == body(own),
        };
        let (mut place, mut scale) = ([0.0; 3], 0.0);
        for entry in row.entries.iter().filter(on_a) {
            let weight = dot(entry.coefficient, row.normal);
            let member = self.by_index[&entry.subdomain];
            let way = difference(member.points[entry.node as usize], row.position);
            place = advance(place, weight, way);
            scale += weight.abs();
        }
        let acts_at = difference(row.acts_at, row.position);
        length(difference(acts_at, place)) <= PLACE * self.extent * scale.max(1.0)
    }
}

fn displaced(place: [f64; 3], node: [f64; 3], tag: i64) -> String {
    let [x, y, _] = place;
    let [a, b, _] = node;
    format!("({x}, {y}); expected ({a}, {b}), where node {tag} is")
}
