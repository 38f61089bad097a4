//! The catalog: what every rank reads.

use std::collections::HashMap;

use super::header::Header;
use super::sizes::Sizes;
use super::{Offsets, hierarchy, materials, settings};
use crate::disjoint_sets::DisjointSets;
use crate::error::InputError;
use crate::problem::dataset::Dataset;
use crate::problem::{Body, Catalog, ContactSummary, Hierarchy, LoadStep, SubdomainSummary};

/// Reads and checks the catalog, and where the slices lie.
pub(super) fn read(file: &hdf5::File) -> Result<(Catalog, Offsets), InputError> {
    let header = Header::read(file)?;
    let sizes = Sizes::read(file)?;
    let count = sizes.points.len();
    let materials = materials::read(file)?;
    let bodies = Dataset::column(file, "/bodies/name", None)?.names()?;
    let (interface_offsets, interface) = read_interface(file, count)?;
    if !file.link_exists("support") {
        return Err(InputError::new(
            "group /support is missing; expected one, empty where nothing is supported",
        ));
    }
    let supports = section(
        file,
        "support",
        count,
        &["/support/offset", "/support/node"],
    )?;
    let support_names = read_support_names(file)?;
    let forces = section(file, "force", count, &["/force/offset", "/force/node"])?;
    let (contacts, groups) = read_contacts(file)?;
    let subdomains = read_subdomains(file, &sizes, bodies.len(), groups.len() - 1)?;
    let interface_nodes = check_interface(&interface, &subdomains)?;
    check_bodies(&interface, &subdomains)?;
    let warnings = match file.link_exists("warnings") {
        true => Dataset::column(file, "/warnings", None)?.strings()?,
        false => Vec::new(),
    };
    let mut catalog = Catalog {
        title: header.title,
        dim: header.dim,
        units: header.units,
        plane: header.plane,
        materials,
        bodies: bodies.into_iter().map(|name| Body { name }).collect(),
        supports: support_names,
        contacts,
        steps: read_steps(file)?,
        subdomains,
        interface,
        interface_nodes,
        groups: groups.windows(2).map(|w| w[1] - w[0]).collect(),
        hierarchy: Hierarchy::default(),
        solver: settings::read(file)?,
        warnings,
    };
    catalog.hierarchy = hierarchy::read(file, &catalog)?;
    let offsets = Offsets {
        points: running_sum(&sizes.points),
        cells: running_sum(&sizes.cells),
        connectivity: running_sum(&sizes.connectivity),
        interface: interface_offsets,
        supports,
        forces,
        groups,
    };
    Ok((catalog, offsets))
}

fn running_sum(counts: &[usize]) -> Vec<usize> {
    let mut offsets = vec![0];
    offsets.extend(counts.iter().scan(0, |sum, n| {
        *sum += n;
        Some(*sum)
    }));
    offsets
}

fn read_interface(
    file: &hdf5::File,
    count: usize,
) -> Result<(Vec<usize>, Vec<Vec<u32>>), InputError> {
    let offsets = section(
        file,
        "interface",
        count,
        &["/interface/offset", "/interface/node"],
    )?;
    let total = offsets[count];
    if total == 0 {
        return Ok((offsets, vec![Vec::new(); count]));
    }
    let dataset = Dataset::column(file, "/interface/interface", Some(total))?;
    let numbers = dataset.indices(0..total, total, "number on Γ")?;
    let mut interface = Vec::with_capacity(count);
    for slice in offsets.windows(2) {
        let list = &numbers[slice[0]..slice[1]];
        if let Some(at) = list.windows(2).position(|w| w[0] >= w[1]) {
            return Err(dataset.row_error(
                slice[0] + at + 1,
                "expected the numbers on Γ of a subdomain in strictly ascending order",
            ));
        }
        interface.push(list.to_vec());
    }
    Ok((offsets, interface))
}

/// Every number on Γ occurs, in two or more subdomains, all of one body.
fn check_interface(
    interface: &[Vec<u32>],
    subdomains: &[SubdomainSummary],
) -> Result<usize, InputError> {
    let nodes = interface
        .iter()
        .flatten()
        .max()
        .map_or(0, |&n| n as usize + 1);
    let mut owners = vec![(0usize, usize::MAX); nodes];
    for (subdomain, list) in interface.iter().enumerate() {
        for &number in list {
            let (count, first) = &mut owners[number as usize];
            *count += 1;
            if *count == 1 {
                *first = subdomain;
            } else if subdomains[*first].body != subdomains[subdomain].body {
                return Err(InputError::new(format!(
                    "dataset /interface/interface: number {number} lies in the subdomains {first} and {subdomain}, which belong to different bodies"
                )));
            }
        }
    }
    match owners.iter().position(|&(count, _)| count < 2) {
        Some(number) => Err(InputError::new(format!(
            "dataset /interface/interface: number {number} lies in {} subdomains; expected two or more",
            owners[number].0
        ))),
        None => Ok(nodes),
    }
}

/// The subdomains of a body hang together through Γ.
fn check_bodies(interface: &[Vec<u32>], subdomains: &[SubdomainSummary]) -> Result<(), InputError> {
    let mut pieces = DisjointSets::new(subdomains.len());
    let mut first: HashMap<u32, usize> = HashMap::new();
    for (subdomain, list) in interface.iter().enumerate() {
        for &number in list {
            let other = *first.entry(number).or_insert(subdomain);
            pieces.unite(other as u32, subdomain as u32);
        }
    }
    let mut of_body = HashMap::new();
    for (subdomain, summary) in subdomains.iter().enumerate() {
        let other = *of_body.entry(summary.body).or_insert(subdomain);
        if pieces.find(other as u32) != pieces.find(subdomain as u32) {
            return Err(InputError::new(format!(
                "dataset /subdomains/body: the subdomains {other} and {subdomain} of body {} \
                 don't hang together through /interface; expected a body of its own for each piece",
                summary.body
            )));
        }
    }
    Ok(())
}

fn read_subdomains(
    file: &hdf5::File,
    sizes: &Sizes,
    bodies: usize,
    groups: usize,
) -> Result<Vec<SubdomainSummary>, InputError> {
    let count = sizes.points.len();
    let body = Dataset::column(file, "/subdomains/body", Some(count))?;
    let body_of = body.indices(0..count, bodies, "body")?;
    if let Some(empty) = first_missing(bodies, body_of.iter().map(|&b| b as usize)) {
        return Err(body.error(&format!("no subdomain belongs to body {empty}")));
    }
    let group = Dataset::column(file, "/subdomains/group", Some(count))?;
    let group_of = group
        .all_integers()?
        .into_iter()
        .enumerate()
        .map(|(row, value)| match usize::try_from(value) {
            Ok(g) if g < groups => Ok(Some(g)),
            _ if value == -1 => Ok(None),
            _ => Err(group.row_error(
                row,
                &format!(
                    "{value} is no group; expected -1 (no contact) or a number below {groups}"
                ),
            )),
        })
        .collect::<Result<Vec<_>, _>>()?;
    if let Some(empty) = first_missing(groups, group_of.iter().copied().flatten()) {
        return Err(group.error(&format!("no subdomain belongs to group {empty}")));
    }
    Ok((0..count)
        .map(|i| SubdomainSummary {
            body: body_of[i] as usize,
            group: group_of[i],
            nodes: sizes.points[i],
            cells: sizes.cells[i],
        })
        .collect())
}

/// The first number below `count` that isn't among the `named` ones.
fn first_missing(count: usize, named: impl Iterator<Item = usize>) -> Option<usize> {
    let mut is_named = vec![false; count];
    for number in named {
        is_named[number] = true;
    }
    is_named.iter().position(|named| !named)
}

/// Names of the conditions that prescribe displacements; one for all where the file doesn't tell.
fn read_support_names(file: &hdf5::File) -> Result<Vec<String>, InputError> {
    // Each of the two says nothing without the other.
    if file.link_exists("support/condition") || file.link_exists("support/name") {
        Dataset::column(file, "/support/condition", None)?;
        return Dataset::column(file, "/support/name", None)?.strings();
    }
    Ok(vec!["supports".into()])
}

/// Load steps; none where the file has none.
fn read_steps(file: &hdf5::File) -> Result<Vec<LoadStep>, InputError> {
    if !file.link_exists("steps") {
        return Ok(Vec::new());
    }
    let names = Dataset::column(file, "/steps/name", None)?.names()?;
    let time = Dataset::column(file, "/steps/time", Some(names.len()))?;
    let times = time.floats(0..names.len())?;
    if let Some(row) = times.windows(2).position(|w| w[0] >= w[1]) {
        return Err(time.row_error(
            row + 1,
            &format!(
                "{} comes after {}; expected times that ascend",
                times[row + 1],
                times[row]
            ),
        ));
    }
    let steps = names.into_iter().zip(times);
    Ok(steps.map(|(name, time)| LoadStep { name, time }).collect())
}

/// Contacts, and the offsets of the groups' rows.
fn read_contacts(file: &hdf5::File) -> Result<(Vec<ContactSummary>, Vec<usize>), InputError> {
    if !is_filled(file, "contact") {
        return Ok((Vec::new(), vec![0]));
    }
    let names = Dataset::column(file, "/contact/name", None)?.contact_names()?;
    let contact = Dataset::column(file, "/contact/contact", None)?;
    let rows = contact.rows();
    let place = Dataset::column(file, "/contact/place", Some(rows))?;
    let groups = Dataset::column(file, "/contact/group_offset", None)?;
    let offsets = groups.offsets(rows)?;
    if let Some(empty) = offsets.windows(2).position(|w| w[0] == w[1]) {
        return Err(groups.row_error(empty, &format!("group {empty} has no rows")));
    }
    let contact_of = contact.indices(0..rows, names.len(), "contact")?;
    let mut conditions = vec![0; names.len()];
    for &c in &contact_of {
        conditions[c as usize] += 1;
    }
    let starts = running_sum(&conditions);
    let mut seen = vec![false; rows];
    let places = place.indices(0..rows, rows, "place")?;
    for (row, (&c, &p)) in contact_of.iter().zip(&places).enumerate() {
        let (c, p) = (c as usize, p as usize);
        if p >= conditions[c] || std::mem::replace(&mut seen[starts[c] + p], true) {
            return Err(place.row_error(
                row,
                &format!(
                    "place {p} of contact {c}; expected each of 0 to {} once",
                    conditions[c] - 1
                ),
            ));
        }
    }
    let contacts = names
        .into_iter()
        .zip(conditions)
        .map(|(name, conditions)| ContactSummary { name, conditions })
        .collect();
    Ok((contacts, offsets))
}

/// The offsets of a section that may be absent; `datasets` are its table of offsets and a column
/// with a row for each entry.
fn section(
    file: &hdf5::File,
    group: &str,
    count: usize,
    datasets: &[&'static str; 2],
) -> Result<Vec<usize>, InputError> {
    if !is_filled(file, group) {
        return Ok(vec![0; count + 1]);
    }
    let rows = Dataset::column(file, datasets[1], None)?.rows();
    Dataset::column(file, datasets[0], Some(count + 1))?.offsets(rows)
}

/// Whether the file has a group with something in it.
fn is_filled(file: &hdf5::File, group: &str) -> bool {
    file.link_exists(group) && !file.group(group).is_ok_and(|group| group.is_empty())
}
