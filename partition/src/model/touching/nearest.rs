//! Distance of bodies between which no contact was found.

use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::super::skin::{Facing, STANDING_OFF, Skin};
use crate::element::geometry::{difference, length};
use crate::error::InputError;
use crate::magnitude::short;
use crate::scene::contact::Between;

/// A node and its position (m).
type Leaf = GeomWithData<[f64; 3], u32>;

/// The error that no facets touch, with the smallest distance.
pub(super) fn apart(
    skin: &Skin,
    names: &[&str],
    between: &Between,
    near: &[Facing],
    unit: &str,
) -> InputError {
    let touching = match between.within {
        Some(within) => format!("within {} {unit}", short(within)),
        None => format!("within {STANDING_OFF} of their size"),
    };
    let closest = near.iter().map(|pair| pair.gap.abs()).reduce(f64::min);
    let nodes = nearest_nodes(skin, names, between);
    let is_nearer = |distance: &f64| nodes.as_ref().is_none_or(|found| *distance < found.1);
    let distance = match (closest.filter(is_nearer), nodes) {
        (Some(gap), _) => format!(
            "; the nearest that face each other are {} {unit} apart",
            short(gap)
        ),
        (None, Some((ends, 0.0))) => {
            format!("; {ends} touch at a point or an edge only")
        }
        (None, Some((ends, distance))) => {
            format!(
                "; the nearest nodes, of {ends}, are {} {unit} apart",
                short(distance)
            )
        }
        (None, None) => String::new(),
    };
    InputError::new(format!(
        "contact '{}': no facets face each other {touching} between its bodies{distance}; expected bodies that touch, or \
         a larger 'within'",
        between.name
    ))
}

/// The two bodies with the nearest nodes, in words, and the distance of these (m); `None` within one body.
fn nearest_nodes(skin: &Skin, names: &[&str], between: &Between) -> Option<(String, f64)> {
    let mut of_body: Vec<Vec<Leaf>> = vec![Vec::new(); names.len()];
    for facet in &skin.facets {
        let nodes = facet.shape.nodes.iter().zip(&facet.shape.at);
        of_body[facet.body as usize].extend(nodes.map(|(&node, &at)| Leaf::new(at, node)));
    }
    let trees: Vec<RTree<Leaf>> = of_body.into_iter().map(RTree::bulk_load).collect();
    let pairs = (0..names.len()).flat_map(|a| (a + 1..names.len()).map(move |b| (a, b)));
    let wanted = pairs.filter(|&(a, b)| between.bodies.has(names[a], names[b]));
    let distances = wanted.filter_map(|(a, b)| {
        let to_b = trees[a].iter().filter_map(|leaf| {
            let other = trees[b].nearest_neighbor(*leaf.geom())?;
            Some(length(difference(*leaf.geom(), *other.geom())))
        });
        let distance = to_b.reduce(f64::min)?;
        Some((format!("'{}' and '{}'", names[a], names[b]), distance))
    });
    distances.min_by(|one, other| one.1.total_cmp(&other.1))
}
