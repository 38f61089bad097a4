//! `*MPC`: CalculiX's predefined equations between nodes, linearized for small displacements.

use super::axes::least;
use super::equations::Equation;
use super::loads::item;
use super::place::Places;
use super::reference::NodeAxis;
use crate::element::geometry::{advance, cross, difference, dot, length, unit};
use crate::error::InputError;
use crate::mesh::abaqus::{Block, Data, Of};
use crate::name;

type Vector = [f64; 3];

/// A linear form of displacements: nodes with vectors of coefficients.
type Form = Vec<(u32, Vector)>;

/// The sine of the angle below which nodes are collinear.
const ON_A_LINE: f64 = 1e-6;

/// The equations of a block.
///
/// # Errors
/// An unknown kind, or nodes that determine no distance, line, plane or axis.
pub(super) fn read(places: &mut Places, block: &Block) -> Result<Vec<Equation>, InputError> {
    let source = places.source;
    let mut all = Vec::new();
    let mut open: Option<(String, &Data, Vec<u32>)> = None;
    for data in &block.data {
        let kind = item(source, data, 0).to_uppercase();
        // The list of nodes continues in lines that begin with a node, or with an empty item.
        let goes_on = kind.is_empty() || kind.starts_with(|c: char| c.is_ascii_digit());
        let first = usize::from(!goes_on || kind.is_empty());
        let mut nodes = Vec::new();
        for node in source
            .items(data)
            .skip(first)
            .filter(|item| !item.is_empty())
        {
            nodes.extend(places.members(data.place, Of::Nodes, node)?);
        }
        match &mut open {
            Some((.., known)) if goes_on => known.extend(nodes),
            _ => {
                all.extend(open.take());
                open = Some((kind, data, nodes));
            }
        }
    }
    all.extend(open);
    let mut equations = Vec::new();
    for (kind, data, nodes) in all {
        let forms = forms(places, &kind, nodes).map_err(|why| {
            source.error(
                data.place,
                format!("*MPC of type {}: {why}", name::shown(&kind)),
            )
        })?;
        equations.extend(forms.into_iter().map(|form| Equation {
            place: data.place,
            terms: terms(form, places.dim()),
        }));
    }
    Ok(equations)
}

/// The equations of a kind between nodes.
fn forms(places: &Places, kind: &str, nodes: Vec<u32>) -> Result<Vec<Form>, String> {
    let at = |node: u32| places.deck.points[node as usize];
    let too_few = |least: usize| match nodes.len() < least {
        true => Err(format!(
            "it has {} nodes; expected {least} at least",
            nodes.len()
        )),
        false => Ok(()),
    };
    match kind {
        "BEAM" => {
            too_few(2)?;
            let offset = difference(at(nodes[1]), at(nodes[0]));
            Ok(vec![vec![
                (nodes[1], offset),
                (nodes[0], offset.map(|c| -c)),
            ]])
        }
        "STRAIGHT" => {
            too_few(3)?;
            let (a, b) = (nodes[0], nodes[1]);
            let line = difference(at(b), at(a));
            let across = across(line).ok_or("its first two nodes lie at one place")?;
            let on_line = |&node: &u32| {
                let t = dot(difference(at(node), at(a)), line) / dot(line, line);
                across.map(|d| {
                    vec![
                        (node, d),
                        (a, d.map(|c| (t - 1.0) * c)),
                        (b, d.map(|c| -t * c)),
                    ]
                })
            };
            Ok(nodes[2..].iter().flat_map(on_line).collect())
        }
        "PLANE" => {
            too_few(4)?;
            let corners = corners(&nodes, at);
            let [s, t] = [1, 2].map(|k| difference(at(corners[k]), at(corners[0])));
            let normal = cross(s, t);
            if length(normal) <= ON_A_LINE * length(s) * length(t) {
                return Err("its nodes lie on a line; expected a plane".into());
            }
            let others = nodes.iter().filter(|node| !corners.contains(node));
            let in_plane = |&node: &u32| {
                // Its position as a combination of those of the corners.
                let offset = difference(at(node), at(corners[0]));
                let part = |a, b| dot(cross(a, b), normal) / dot(normal, normal);
                let [u, v] = [part(offset, t), part(s, offset)];
                let weights = [u + v - 1.0, -u, -v];
                let of_corners = corners.into_iter().zip(weights);
                let mut form = vec![(node, normal)];
                form.extend(of_corners.map(|(corner, w)| (corner, normal.map(|c| w * c))));
                form
            };
            Ok(others.map(in_plane).collect())
        }
        "MEANROT" => {
            too_few(3)?;
            mean_rotation(at, nodes).map(|form| vec![form])
        }
        _ => Err("isn't read; expected BEAM, STRAIGHT, PLANE or MEANROT, or an *EQUATION".into()),
    }
}

/// Three of the nodes that span a plane: the first one, the one farthest from it, and the one farthest from their line.
fn corners(nodes: &[u32], at: impl Fn(u32) -> Vector) -> [u32; 3] {
    let farthest = |size: &dyn Fn(u32) -> f64| {
        let others = nodes.iter().copied();
        others
            .max_by(|&a, &b| size(a).total_cmp(&size(b)))
            .unwrap_or(nodes[0])
    };
    let offset = |node: u32| difference(at(node), at(nodes[0]));
    let second = farthest(&|node| length(offset(node)));
    let third = farthest(&|node| length(cross(offset(second), offset(node))));
    [nodes[0], second, third]
}

/// The average rotation of nodes about the axis a from the origin to the last node, whose first degree of freedom is
/// its value: the average of (a × r)·(u − ū)/r², with r the radius vector from the axis parallel to a through their
/// centre.
fn mean_rotation(at: impl Fn(u32) -> Vector, mut nodes: Vec<u32>) -> Result<Form, String> {
    let pilot = nodes.pop().unwrap_or_default();
    // Each node is listed once for every degree of freedom.
    nodes.sort_unstable();
    nodes.dedup();
    let size = length(at(pilot));
    if size == 0.0 {
        return Err("its last node lies at the origin; expected the direction of the axis".into());
    }
    let axis = at(pilot).map(|c| c / size);
    let count = nodes.len() as f64;
    let middle = nodes
        .iter()
        .fold([0.0; 3], |sum, &node| advance(sum, 1.0 / count, at(node)));
    let mut form = Form::new();
    let mut mean = [0.0; 3];
    for &node in &nodes {
        let offset = difference(at(node), middle);
        let radius = advance(offset, -dot(offset, axis), axis);
        let square = dot(radius, radius);
        if square > 0.0 {
            let turn = cross(axis, radius).map(|c| c / square / count);
            mean = advance(mean, 1.0 / count, turn);
            form.push((node, turn));
        }
    }
    if form.is_empty() {
        return Err("its nodes lie on the axis; expected some beside it".into());
    }
    form.extend(nodes.iter().map(|&node| (node, mean.map(|c| -c))));
    form.push((pilot, [-1.0, 0.0, 0.0]));
    Ok(form)
}

/// Two unit vectors perpendicular to a line and to each other; `None` for a line of length zero.
fn across(line: Vector) -> Option<[Vector; 2]> {
    let first = unit(cross(line, least(line)))?;
    Some([first, unit(cross(line, first))?])
}

/// The terms along the coordinate axes.
fn terms(form: Form, dim: usize) -> Vec<(NodeAxis, f64)> {
    let parts = form.into_iter().flat_map(|(node, direction)| {
        (direction.into_iter().enumerate().take(dim))
            .map(move |(axis, factor)| ((node, axis), factor))
    });
    parts.filter(|(_, factor)| *factor != 0.0).collect()
}
