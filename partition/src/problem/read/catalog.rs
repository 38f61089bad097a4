//! The catalog, read by every rank.

use std::collections::HashMap;

use super::contents::Contents;
use super::header::Header;
use super::{goals, hierarchy, materials, points, probes, settings, tips};
use crate::disjoint_sets::DisjointSets;
use crate::error::InputError;
use crate::problem::{
    Absent, Body, Catalog, ContactKind, ContactSummary, Hierarchy, LoadStep, SubdomainSummary,
};

/// Reads and checks the catalog.
pub(super) fn read(
    file: &hdf5::File,
    header: Header,
    contents: &Contents,
) -> Result<Catalog, InputError> {
    let materials = materials::read(contents, header.plane)?;
    let bodies = contents.strings("/bodies/name")?;
    let interface = read_interface(contents)?;
    let groups = contents.sizes('R');
    let mut contacts = read_contacts(contents, &groups)?;
    let subdomains = read_subdomains(contents, bodies.len(), groups.len())?;
    let interface_nodes = check_interface(&interface, &subdomains)?;
    let (points, point_nodes) = points::read(contents, &subdomains)?;
    for point in &points {
        let contact = &mut contacts[point.contact as usize];
        contact.has_friction |= point.law.has_friction();
        contact.kind = ContactKind::of(point);
        contact.is_compliant |= point.is_compliant();
    }
    let probes = probes::read(contents, &subdomains)?;
    let mut catalog = Catalog {
        title: header.title,
        dim: header.dim,
        units: header.units,
        plane: header.plane,
        materials,
        bodies: bodies.into_iter().map(Body::new).collect(),
        supports: read_support_names(contents)?,
        contacts,
        steps: read_steps(contents)?,
        subdomains,
        interface,
        interface_nodes,
        groups,
        points,
        probes,
        tips: tips::read(contents)?,
        quantities: goals::quantities(contents)?,
        parameters: goals::parameters(contents)?,
        point_nodes,
        hierarchy: Hierarchy::default(),
        solver: settings::read(file)?,
        warnings: contents.strings("/warnings")?,
    };
    catalog.hierarchy = hierarchy::read(contents, &catalog)?;
    Ok(catalog)
}

/// The numbers on Γ of every subdomain.
fn read_interface(contents: &Contents) -> Result<Vec<Vec<u32>>, InputError> {
    let numbers = contents.all_integers("/interface/interface")?;
    let mut interface = Vec::new();
    for subdomain in 0..contents.count('N') {
        let rows = contents.rows('I', subdomain);
        let list = numbers.of(rows.clone());
        if let Some(at) = list.windows(2).position(|w| w[0] >= w[1]) {
            return Err(numbers.error(
                rows.start + at + 1,
                "expected the numbers on Γ of a subdomain in strictly ascending order",
            ));
        }
        interface.push(list.iter().map(|&number| number as u32).collect());
    }
    Ok(interface)
}

/// Checks that every number on Γ occurs, in two or more subdomains, all of one body, and that the subdomains of a body
/// are connected through Γ. Returns the number of nodes on Γ.
fn check_interface(
    interface: &[Vec<u32>],
    subdomains: &[SubdomainSummary],
) -> Result<usize, InputError> {
    let most = interface.iter().flatten().max();
    let nodes = most.map_or(0, |&number| number as usize + 1);
    let refused = |number: usize, what: String| {
        let place = "dataset /interface/interface: number";
        Err(InputError::new(format!("{place} {number} lies in {what}")))
    };
    let mut owners = vec![(0usize, usize::MAX); nodes];
    let mut pieces = DisjointSets::new(subdomains.len());
    for (subdomain, list) in interface.iter().enumerate() {
        for &number in list {
            let (count, first) = &mut owners[number as usize];
            *count += 1;
            if *count == 1 {
                *first = subdomain;
            } else if subdomains[*first].body != subdomains[subdomain].body {
                let what = format!(
                    "the subdomains {first} and {subdomain}, which belong to different bodies"
                );
                return refused(number as usize, what);
            }
            pieces.unite(*first as u32, subdomain as u32);
        }
    }
    if let Some(number) = owners.iter().position(|&(count, _)| count < 2) {
        let count = owners[number].0;
        return refused(number, format!("{count} subdomains; expected two or more"));
    }
    let mut of_body = HashMap::new();
    for (subdomain, summary) in subdomains.iter().enumerate() {
        let other = *of_body.entry(summary.body).or_insert(subdomain);
        if pieces.find(other as u32) != pieces.find(subdomain as u32) {
            return Err(InputError::new(format!(
                "dataset /subdomains/body: the subdomains {other} and {subdomain} of body {} \
                 aren't connected through /interface; expected a body of its own for each piece",
                summary.body
            )));
        }
    }
    Ok(nodes)
}

fn read_subdomains(
    contents: &Contents,
    bodies: usize,
    groups: usize,
) -> Result<Vec<SubdomainSummary>, InputError> {
    let body = contents.all_integers("/subdomains/body")?;
    let group = contents.all_integers("/subdomains/group")?;
    let mut group_of = Vec::with_capacity(contents.count('N'));
    for (row, &value) in group.all().iter().enumerate() {
        let number = usize::try_from(value)
            .ok()
            .filter(|&number| number < groups);
        if number.is_none() && value != -1 {
            let what = format!(
                "{value} is no contact group; expected -1 (no contact) or a number below {groups}"
            );
            return Err(group.error(row, &what));
        }
        group_of.push(number);
    }
    let bodies_of = body.all().iter().map(|&body| body as usize);
    check_each_occurs("/subdomains/body", "body", bodies, bodies_of)?;
    let groups_of = group_of.iter().copied().flatten();
    check_each_occurs("/subdomains/group", "contact group", groups, groups_of)?;
    let sizes = contents.sizes('P').into_iter().zip(contents.sizes('C'));
    let rows = body.all().iter().zip(group_of).zip(sizes);
    let summary = |((&body, group), (nodes, cells))| SubdomainSummary {
        body: body as usize,
        group,
        nodes,
        cells,
    };
    Ok(rows.map(summary).collect())
}

/// Checks that each number below `count` is among the `named` ones.
fn check_each_occurs(
    path: &str,
    what: &str,
    count: usize,
    named: impl Iterator<Item = usize>,
) -> Result<(), InputError> {
    let mut is_named = vec![false; count];
    for number in named {
        is_named[number] = true;
    }
    match is_named.iter().position(|named| !named) {
        Some(number) => Err(InputError::new(format!(
            "dataset {path}: no subdomain belongs to {what} {number}"
        ))),
        None => Ok(()),
    }
}

/// Names of the boundary conditions that prescribe displacements; a single one for all if the file has none.
fn read_support_names(contents: &Contents) -> Result<Vec<String>, InputError> {
    match contents.has("/support/name") {
        true => contents.strings("/support/name"),
        false => Ok(vec!["supports".into()]),
    }
}

/// Load steps; none where the file has none.
fn read_steps(contents: &Contents) -> Result<Vec<LoadStep>, InputError> {
    let names = contents.strings("/steps/name")?;
    let time = contents.numbers("/steps/time", 0..names.len())?;
    if let Some(row) = time.all().windows(2).position(|w| w[0] >= w[1]) {
        let [before, after] = [row, row + 1].map(|row| time.all()[row]);
        let what = format!("{after} comes after {before}; expected times that ascend");
        return Err(time.error(row + 1, &what));
    }
    let bodies = read_absent(contents, "/steps/body", 'B')?;
    let contacts = read_absent(contents, "/steps/contact", 'Q')?;
    let absent = |k: usize| Absent {
        bodies: bodies.get(k).cloned().unwrap_or_default(),
        contacts: contacts.get(k).cloned().unwrap_or_default(),
    };
    let steps = names.into_iter().zip(time.all()).enumerate();
    Ok(steps
        .map(|(k, (name, &time))| LoadStep {
            name,
            time,
            absent: absent(k),
        })
        .collect())
}

/// The absent items of the kind counted by a letter, load step by load step; empty if the file has none.
fn read_absent(contents: &Contents, path: &str, letter: char) -> Result<Vec<Vec<u32>>, InputError> {
    let is_there = contents.all_integers(path)?;
    let of_step = |of_step: &[i64]| {
        let absent = (0..).zip(of_step).filter(|(_, value)| **value == 0);
        absent.map(|(number, _)| number).collect()
    };
    let steps = is_there.all().chunks(contents.count(letter).max(1));
    Ok(steps.map(of_step).collect())
}

/// Contacts with the numbers of their points.
fn read_contacts(contents: &Contents, groups: &[usize]) -> Result<Vec<ContactSummary>, InputError> {
    if let Some(empty) = groups.iter().position(|&rows| rows == 0) {
        return Err(InputError::new(format!(
            "dataset /contact/group_offset, row {empty}: group {empty} has no rows"
        )));
    }
    let names = contents.strings("/contact/name")?;
    let contact_of = contents.all_integers("/contact/contact")?;
    let mut conditions = vec![0; names.len()];
    for &contact in contact_of.all() {
        conditions[contact as usize] += 1;
    }
    let places = contents.all_integers("/contact/place")?;
    let mut seen: Vec<Vec<bool>> = conditions.iter().map(|&n| vec![false; n]).collect();
    for (row, (&c, &p)) in contact_of.all().iter().zip(places.all()).enumerate() {
        let of_contact = &mut seen[c as usize];
        let free = of_contact.get_mut(p as usize).filter(|taken| !**taken);
        let Some(free) = free else {
            let last = of_contact.len() - 1;
            let what = format!("place {p} of contact {c}; expected each of 0 to {last} once");
            return Err(places.error(row, &what));
        };
        *free = true;
    }
    let contacts = names.into_iter().zip(conditions);
    Ok(contacts
        .map(|(name, conditions)| ContactSummary {
            name,
            conditions,
            has_friction: false,
            kind: ContactKind::default(),
            is_compliant: false,
        })
        .collect())
}
