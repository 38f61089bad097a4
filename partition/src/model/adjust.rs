//! Adjustment of ties: nodes are moved onto the other side, so that no gap is left, across which forces would have a
//! moment.

use super::bodies::Bodies;
use super::contact::Contacts;
use super::held_nodes::HeldNodes;
use crate::contact_point::ContactPoint;
use crate::element::geometry::{advance, length};
use crate::error::InputError;
use crate::magnitude::short;
use crate::mesh::topology::Topology;
use crate::scene::Scene;
use crate::scene::contact::Partner;

/// Number of times that sides are paired again after moving nodes: each time the remaining gap is squared.
const PAIRINGS: usize = 4;
/// Largest number of rounds in which points with common nodes are moved one after the other.
const ROUNDS: usize = 50;
/// Distance of a node, relative to the size of facets, that is round-off.
const NOTHING: f64 = 1e-14;
/// Distance, relative to the size of facets, below which no one asks for where nodes are: the round-off of a mesh file.
const NEGLIGIBLE: f64 = 1e-9;

/// Moves the nodes of ties for which the scene requests it.
///
/// # Errors
/// Sides that don't face each other, or are apart.
pub(super) fn adjust(
    scene: &Scene,
    bodies: &mut Bodies,
    topology: &Topology,
    warnings: &mut Vec<String>,
) -> Result<(), InputError> {
    for tie in scene.tie.iter().filter(|tie| tie.reach.adjust) {
        let (keys, what) = (tie.contact(), format!("tie '{}'", tie.name));
        let Partner::Side(names) = &keys.partner else {
            continue;
        };
        let before = bodies.mesh.points.clone();
        let mut size = 0.0;
        for _ in 0..PAIRINGS {
            let sides = Contacts::new(&bodies.mesh, topology, HeldNodes::default(), scene);
            let tied = sides.tied(&keys, (names, tie.reach), &what)?;
            size = tied.size;
            if !close(&mut bodies.mesh.points, &tied.points, NOTHING * tied.size) {
                break;
            }
        }
        let distances = before.iter().zip(&bodies.mesh.points);
        let distances = distances.map(|(before, after)| length(advance(*after, -1.0, *before)));
        let (moved, farthest) = distances
            .filter(|&distance| distance > 0.0)
            .fold((0, 0.0), |(n, most), distance| {
                (n + 1, f64::max(most, distance))
            });
        if farthest > NEGLIGIBLE * size {
            warnings.push(format!(
                "{what}: {moved} nodes are moved by up to {} {} onto the other side",
                short(farthest),
                scene.units.length()
            ));
        }
    }
    Ok(())
}

/// Moves the nodes of `points`, the first entry of each, until all gaps are closed, Σ weight · position = 0; returns
/// whether any node was farther away than `nothing`.
fn close(positions: &mut [[f64; 3]], points: &[ContactPoint<u32>], nothing: f64) -> bool {
    let mut was_apart = false;
    for _ in 0..ROUNDS {
        let mut farthest: f64 = 0.0;
        for point in points {
            let Some(&(node, weight)) = point.entries.first() else {
                continue;
            };
            let at =
                |sum, &(node, weight): &(u32, f64)| advance(sum, weight, positions[node as usize]);
            let apart = point.entries.iter().fold([0.0; 3], at);
            let offset = apart.map(|c| -c / weight);
            farthest = farthest.max(length(offset));
            positions[node as usize] = advance(positions[node as usize], 1.0, offset);
        }
        if farthest <= nothing {
            break;
        }
        was_apart = true;
    }
    was_apart
}
