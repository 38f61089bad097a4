//! The tree over the subdomains.

use super::contents::Contents;
use super::slice::Slice;
use crate::error::InputError;
use crate::problem::{Catalog, Hierarchy};

/// Reads and checks the tree.
pub(super) fn read(contents: &Contents, catalog: &Catalog) -> Result<Hierarchy, InputError> {
    let rows = contents.all_integers("/hierarchy/parent")?;
    let subdomains = catalog.subdomains.len();
    let parent = read_parents(&rows, subdomains)?;
    let clusters = contents.all_integers("/hierarchy/cluster")?;
    let hierarchy = Hierarchy {
        clusters: read_clusters(&clusters, &parent, subdomains)?,
        parent,
    };
    check_roots(&hierarchy, catalog)?;
    Ok(hierarchy)
}

fn read_parents(rows: &Slice<i64>, subdomains: usize) -> Result<Vec<Option<u32>>, InputError> {
    let nodes = rows.all().len();
    if nodes < subdomains {
        return Err(InputError::new(format!(
            "dataset /hierarchy/parent: has {nodes} rows; expected one for each of the {subdomains} subdomains and for each inner node"
        )));
    }
    let mut is_parent = vec![false; nodes];
    let mut parents = Vec::with_capacity(nodes);
    for (row, &value) in rows.all().iter().enumerate() {
        let least = subdomains.max(row + 1);
        let parent = u32::try_from(value).ok();
        match parent.filter(|&p| (least..nodes).contains(&(p as usize))) {
            Some(parent) => is_parent[parent as usize] = true,
            None if value == -1 => {}
            None => {
                let inner = match least < nodes {
                    true => format!(" or an inner node, {least} to {}", nodes - 1),
                    false => String::new(),
                };
                return Err(rows.error(
                    row,
                    &format!("{value} is no parent; expected -1 (a root){inner}"),
                ));
            }
        }
        parents.push(parent);
    }
    match (subdomains..nodes).find(|&node| !is_parent[node]) {
        Some(node) => Err(rows.error(node, "the inner node has no child; expected one at least")),
        None => Ok(parents),
    }
}

/// Reads the clusters and checks that every subdomain is a cluster or under exactly one, if there are any.
fn read_clusters(
    rows: &Slice<i64>,
    parents: &[Option<u32>],
    subdomains: usize,
) -> Result<Vec<u32>, InputError> {
    let clusters: Vec<u32> = rows.all().iter().map(|&v| v as u32).collect();
    if let Some(at) = clusters.windows(2).position(|w| w[0] >= w[1]) {
        return Err(rows.error(at + 1, "expected nodes in strictly ascending order"));
    }
    let mut above = vec![0; parents.len()];
    for v in (0..parents.len()).rev() {
        let own = usize::from(clusters.binary_search(&(v as u32)).is_ok());
        above[v] = own + parents[v].map_or(0, |parent| above[parent as usize]);
    }
    let wrong = (0..subdomains).find(|&subdomain| above[subdomain] != 1);
    match wrong.filter(|_| !clusters.is_empty()) {
        Some(subdomain) => Err(InputError::new(format!(
            "dataset /hierarchy/cluster: subdomain {subdomain} is in {} clusters; expected one",
            above[subdomain]
        ))),
        None => Ok(clusters),
    }
}

/// Checks that blocks with a common node of Γ have a common root, as otherwise no front could eliminate the node.
fn check_roots(hierarchy: &Hierarchy, catalog: &Catalog) -> Result<(), InputError> {
    // The members of a group have to be under one root, even where a member is a root itself.
    let mut root: Vec<usize> = (0..hierarchy.parent.len()).collect();
    let mut first = vec![None; catalog.groups.len()];
    for (row, subdomain) in catalog.subdomains.iter().enumerate() {
        if let Some(group) = subdomain.group {
            root[row] = *first[group].get_or_insert(row);
        }
    }
    for node in (0..root.len()).rev() {
        if let Some(parent) = hierarchy.parent[node] {
            root[node] = root[parent as usize];
        }
    }
    let mut under = vec![None; catalog.interface_nodes];
    for (subdomain, list) in catalog.interface.iter().enumerate() {
        for &number in list {
            let (other, expected) =
                *under[number as usize].get_or_insert((subdomain, root[subdomain]));
            if root[subdomain] != expected {
                return Err(InputError::new(format!(
                    "dataset /hierarchy/parent: the subdomains {other} and {subdomain} share the node {number} of Γ, but are under different roots; expected one above both"
                )));
            }
        }
    }
    Ok(())
}
