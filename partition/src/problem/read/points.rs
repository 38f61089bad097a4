//! The contact points.

use std::collections::HashSet;

use super::contents::Contents;
use super::entries::Entries;
use crate::contact_point::{ContactPoint, Law, LocalFrame};
use crate::element::geometry::{cross, dot, length, padded};
use crate::error::InputError;
use crate::problem::law::LawRow;
use crate::problem::{PointNode, SubdomainNode, SubdomainSummary};

/// Largest deviation of a unit vector's length from 1.
const UNIT: f64 = 1e-9;

/// Reads all contact points, and the data of their nodes.
#[allow(clippy::type_complexity)]
pub(super) fn read(
    contents: &Contents,
    subdomains: &[SubdomainSummary],
) -> Result<(Vec<ContactPoint<SubdomainNode>>, Vec<Vec<PointNode>>), InputError> {
    let rows = 0..contents.count('R');
    let integers = |path| contents.integers(path, rows.clone());
    let numbers = |path| contents.numbers(path, rows.clone());
    let contact = integers("/contact/contact")?;
    let place = integers("/contact/place")?;
    let gap = numbers("/contact/gap")?;
    let area = numbers("/contact/area")?;
    let position = numbers("/contact/position")?.vectors(rows.clone());
    let force_point = numbers("/contact/force_point")?.vectors(rows.clone());
    let normal = numbers("/contact/normal")?.vectors(rows.clone());
    let frames = read_frames(contents, &normal)?;
    let tag_a = integers("/contact/node_a")?;
    let tag_b = integers("/contact/node_b")?;
    let given_gap = integers("/contact/given_gap")?;
    let absolute = integers("/contact/absolute")?;
    let laws = read_laws(contents)?;
    let mut motion = read_motion(contents)?;
    let mut preload = read_preload(contents)?;
    let entries = read_entries(contents, subdomains)?;
    let mut axes = read_axes(contents, &laws)?;
    let stiffness = read_stiffness(contents, &laws, &axes)?;
    let point = |(i, entries): (usize, _)| ContactPoint {
        // Checked when the file was opened: the index of a contact, and that of a point in it.
        contact: contact.all()[i] as u32,
        place: place.all()[i] as u32,
        gap: gap.all()[i],
        area: area.all()[i],
        force_point: force_point[i],
        tag_b: tag_b.all()[i],
        is_gap_given: given_gap.all().get(i) == Some(&1),
        is_absolute: absolute.all().get(i) == Some(&1),
        law: laws[i],
        stiffness: stiffness[i],
        motion: std::mem::take(&mut motion[i]),
        preload: std::mem::take(&mut preload[i]),
        axes: std::mem::take(&mut axes[i]),
        frame: frames[i],
        ..ContactPoint::new(entries, normal[i], position[i], tag_a.all()[i])
    };
    let points: Vec<_> = entries.into_iter().enumerate().map(point).collect();
    let nodes = read_nodes(contents, &points)?;
    Ok((points, nodes))
}

/// The frame of every point with this normal; tangents follow from it by default.
fn read_frames(contents: &Contents, normal: &[[f64; 3]]) -> Result<Vec<LocalFrame>, InputError> {
    if !contents.has("/contact/tangent") {
        return Ok(normal.iter().map(|&n| LocalFrame::new(n)).collect());
    }
    let all = contents.numbers("/contact/tangent", 0..normal.len())?;
    let tangents = all.vectors(0..normal.len()).into_iter().zip(normal);
    let frame = |(row, (first, &normal)): (usize, ([f64; 3], &[f64; 3]))| {
        if dot(first, normal).abs() > UNIT {
            return Err(all.error(row, "expected a vector perpendicular to the normal"));
        }
        Ok(LocalFrame {
            normal,
            tangents: [first, cross(normal, first)],
        })
    };
    tangents.enumerate().map(frame).collect()
}

/// The law of every point; frictionless by default.
fn read_laws(contents: &Contents) -> Result<Vec<Law>, InputError> {
    let rows = 0..contents.count('R');
    if !contents.has("/contact/law") {
        return Ok(vec![Law::Frictionless; rows.len()]);
    }
    let law = contents.integers("/contact/law", rows.clone())?;
    let friction = contents.numbers("/contact/friction", rows.clone())?;
    let bound = contents.numbers("/contact/shear_bound", rows.clone())?;
    let of_row = |row: usize| {
        let values = LawRow {
            law: law.all()[row],
            friction: friction.all()[row],
            shear_bound: bound.all()[row],
        };
        let wrong = |(path, what)| InputError::new(format!("dataset {path}, row {row}: {what}"));
        values.law().map_err(wrong)
    };
    rows.map(of_row).collect()
}

/// Motion of the obstacle of every point in all load steps; empty if none moves.
fn read_motion(contents: &Contents) -> Result<Vec<Vec<[f64; 3]>>, InputError> {
    let rows = contents.count('R');
    if !contents.has("/contact/motion") {
        return Ok(vec![Vec::new(); rows]);
    }
    let (dim, steps) = (contents.count('d'), contents.count('L').max(1));
    let all = contents.numbers("/contact/motion", 0..rows)?;
    let of_point = |of_point: &[f64]| {
        let motion: Vec<[f64; 3]> = of_point.chunks_exact(dim).map(padded).collect();
        match motion.iter().any(|m| *m != [0.0; 3]) {
            true => motion,
            false => Vec::new(),
        }
    };
    Ok(all.all().chunks_exact(steps * dim).map(of_point).collect())
}

/// The given force at every point in all load steps; empty without pretensions.
fn read_preload(contents: &Contents) -> Result<Vec<Vec<f64>>, InputError> {
    let rows = contents.count('R');
    if !contents.has("/contact/preload") {
        return Ok(vec![Vec::new(); rows]);
    }
    let steps = contents.count('L').max(1);
    let all = contents.numbers("/contact/preload", 0..rows)?;
    let of_point = |of_point: &[f64]| match of_point.iter().any(|&force| force != 0.0) {
        true => of_point.to_vec(),
        false => Vec::new(),
    };
    Ok(all.all().chunks_exact(steps).map(of_point).collect())
}

/// The contact stiffness at every point; rigid by default.
fn read_stiffness(
    contents: &Contents,
    laws: &[Law],
    axes: &[Vec<[f64; 3]>],
) -> Result<Vec<[f64; 2]>, InputError> {
    if !contents.has("/contact/stiffness") {
        return Ok(vec![[0.0; 2]; laws.len()]);
    }
    let all = contents.numbers("/contact/stiffness", 0..laws.len())?;
    let (rows, _) = all.all().as_chunks::<2>();
    for (row, (&[normal, tangential], law)) in rows.iter().zip(laws).enumerate() {
        if law.is_tied() && axes[row].is_empty() && normal > 0.0 {
            return Err(all.error(
                row,
                "expected 0 at a point of law 3, unless its entries have directions",
            ));
        }
        if tangential > 0.0 && (normal == 0.0 || !law.has_friction()) {
            let what = "expected a stiffness along tangents only beside one along the normal, of a point with friction";
            return Err(all.error(row, what));
        }
    }
    Ok(rows.to_vec())
}

/// The directions of the entries of every point; only equations have any.
fn read_axes(contents: &Contents, laws: &[Law]) -> Result<Vec<Vec<[f64; 3]>>, InputError> {
    if !contents.has("/contact/entry_axis") {
        return Ok(vec![Vec::new(); laws.len()]);
    }
    let all = contents.numbers("/contact/entry_axis", 0..contents.count('E'))?;
    let of_row = |(row, law): (usize, &Law)| {
        let axes = all.vectors(contents.rows('E', row));
        if axes.iter().all(|axis| *axis == [0.0; 3]) {
            return Ok(Vec::new());
        }
        let is_unit = |axis: &[f64; 3]| (length(*axis) - 1.0).abs() <= UNIT;
        match law.is_tied() && axes.iter().all(is_unit) {
            true => Ok(axes),
            false => Err(InputError::new(format!(
                "dataset /contact/entry_axis, point {row}: expected unit vectors at all entries of a point of law 3, or zeros"
            ))),
        }
    };
    laws.iter().enumerate().map(of_row).collect()
}

/// The nodes and weights of every point.
fn read_entries(
    contents: &Contents,
    subdomains: &[SubdomainSummary],
) -> Result<Vec<Vec<(SubdomainNode, f64)>>, InputError> {
    let all = Entries::read(contents, "/contact", 'E', subdomains)?;
    let mut entries = Vec::with_capacity(contents.count('R'));
    let mut named = HashSet::new();
    for group in 0..contents.count('G') {
        for row in contents.rows('R', group) {
            let mut list = Vec::new();
            named.clear();
            for at in contents.rows('E', row) {
                let owner = all.owner(at);
                if subdomains[owner as usize].group != Some(group) {
                    let what = format!("subdomain {owner} isn't in group {group}");
                    return Err(all.subdomain.error(at, &what));
                }
                let entry = all.entry(at)?;
                if !named.insert(entry.0) {
                    return Err(all.node.error(at, "the point named the node before"));
                }
                list.push(entry);
            }
            if list.iter().all(|&(_, weight)| weight == 0.0) {
                return Err(InputError::new(format!(
                    "dataset /contact/entry_offset, row {row}: expected weights that aren't all zero"
                )));
            }
            entries.push(list);
        }
    }
    Ok(entries)
}

/// The nodes of the points, with data from the datasets of Γ and of supports, whose errors are found when subdomains
/// are read.
fn read_nodes(
    contents: &Contents,
    points: &[ContactPoint<SubdomainNode>],
) -> Result<Vec<Vec<PointNode>>, InputError> {
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let shared = contents.all_integers("/interface/node")?;
    let numbers = contents.all_integers("/interface/interface")?;
    let supports = 0..contents.count('S');
    let held = contents.integers("/support/node", supports.clone())?;
    let directions = contents.numbers("/support/direction", supports)?;
    let of_node = |at: SubdomainNode, i: usize, point: &ContactPoint<SubdomainNode>| {
        let (subdomain, node) = (at.subdomain as usize, i64::from(at.node));
        let rows = contents.rows('I', subdomain);
        let place = shared.of(rows.clone()).iter().position(|&n| n == node);
        let interface = place.map(|place| numbers.all()[rows.start + place] as u32);
        let rows = contents.rows('S', subdomain);
        let rows = rows.filter(|&row| held.all()[row] == node);
        PointNode::new(
            interface,
            point.directions_at(i, contents.count('d')),
            rows.map(|row| directions.vectors(row..row + 1)[0]),
        )
    };
    let of_point = |point: &ContactPoint<SubdomainNode>| {
        let nodes = point.entries.iter().enumerate();
        nodes.map(|(i, &(at, _))| of_node(at, i, point)).collect()
    };
    Ok(points.iter().map(of_point).collect())
}
