//! Splits a model along a decomposition.

mod bodies;
mod groups;
mod owners;
mod points;

use self::bodies::Bodies;
use self::groups::Groups;
use self::owners::Owners;
use super::Decomposition;
use crate::contact_point::{ContactPoint, Probe};
use crate::crack_tip::CrackTip;
use crate::element::Elements;
use crate::error::InputError;
use crate::model::{self, Model};
use crate::problem::{
    Absent, Body, Catalog, ContactKind, ContactSummary, InitialStress, InterfaceNode, LoadStep,
    Problem, StepLoads, Subdomain, SubdomainNode, SubdomainSummary,
};
use crate::quantity::{Goals, LoadForce, NodalShares, NodeWeight, QuantityKind};

impl Problem {
    /// Gives every subdomain its slice of `model`.
    ///
    /// Nodes keep the mesh's order within a subdomain, and on Γ. The force at a shared node goes to the lowest of its
    /// subdomains, its supports to all of them. Subdomains that share a node with a contact constraint, or that a
    /// constraint links, form one group.
    ///
    /// # Errors
    /// A decomposition that doesn't belong to the model, or a subdomain that lies in two bodies.
    pub fn new(model: &Model, decomposition: &Decomposition) -> Result<Self, InputError> {
        let owners = Owners::new(model, decomposition)?;
        let bodies = Bodies::new(model);
        let groups = Groups::new(model, &owners)?;
        let subdomains = cut(model, decomposition, &owners, &bodies)?;
        let points = gather_points(model, &owners, &groups);
        let mut warnings = model.warnings.clone();
        warnings.extend(bodies::scattered(model, decomposition));
        let catalog = Catalog {
            supports: model.support_names.clone(),
            title: model.title.clone(),
            solver: model.solver,
            dim: model.mesh.dim,
            units: model.units,
            plane: model.plane,
            materials: model.materials.clone(),
            bodies: bodies.names.iter().cloned().map(Body::new).collect(),
            contacts: model.contacts.iter().map(summary).collect(),
            steps: load_steps(model, &bodies),
            subdomains: subdomains
                .iter()
                .map(|s| SubdomainSummary {
                    body: s.body,
                    group: groups.of[s.index],
                    nodes: s.points.len(),
                    cells: s.cells.len(),
                })
                .collect(),
            interface: subdomains
                .iter()
                .map(|s| s.interface.iter().map(|on| on.interface).collect())
                .collect(),
            interface_nodes: owners.interface_nodes,
            groups: points.iter().map(Vec::len).collect(),
            points: points.concat(),
            probes: gather_probes(model, &owners),
            tips: (model.tips.iter())
                .map(|(cell, tip)| CrackTip {
                    body: bodies.of_cell[*cell as usize] as u32,
                    ..tip.clone()
                })
                .collect(),
            quantities: model.goals.quantities.clone(),
            parameters: model.goals.parameters.clone(),
            point_nodes: Vec::new(),
            hierarchy: decomposition.hierarchy.clone(),
            warnings,
        };
        let mut problem = Self {
            catalog,
            subdomains,
        };
        problem.describe_points();
        problem.catalog.choose_clusters(None);
        Ok(problem)
    }
}

/// The load steps, with the bodies and contacts that are absent in each.
fn load_steps(model: &Model, bodies: &Bodies) -> Vec<LoadStep> {
    (model.steps.iter())
        .map(|step| LoadStep {
            name: step.name.clone(),
            time: step.time,
            absent: Absent {
                bodies: bodies.among(model, &step.absent_bodies),
                contacts: step.absent_contacts.clone(),
            },
        })
        .collect()
}

fn summary(contact: &model::Contact) -> ContactSummary {
    ContactSummary {
        name: contact.name.clone(),
        conditions: contact.points.len(),
        has_friction: contact.points.iter().any(|point| point.law.has_friction()),
        kind: contact
            .points
            .first()
            .map_or_else(ContactKind::default, ContactKind::of),
        is_compliant: contact.points.iter().any(ContactPoint::is_compliant),
    }
}

/// A subdomain without nodes and cells in a scene with `steps` load steps.
fn empty(index: usize, steps: usize) -> Subdomain {
    Subdomain {
        index,
        body: usize::MAX,
        points: Vec::new(),
        node_tags: Vec::new(),
        cells: Elements::default(),
        cell_material: Vec::new(),
        supports: Vec::new(),
        springs: Vec::new(),
        forces: Vec::new(),
        initial_stress: InitialStress::default(),
        interface: Vec::new(),
        shares: NodalShares::default(),
        steps: vec![StepLoads::default(); steps],
        reference_nodes: 0,
        auxiliary_nodes: 0,
    }
}

fn cut(
    model: &Model,
    decomposition: &Decomposition,
    owners: &Owners,
    bodies: &Bodies,
) -> Result<Vec<Subdomain>, InputError> {
    let mesh = &model.mesh;
    let mut subdomains: Vec<Subdomain> = (0..owners.count)
        .map(|index| empty(index, model.steps.len()))
        .collect();
    for (node, list) in owners.of.iter().enumerate() {
        for &(owner, local) in list {
            let subdomain = &mut subdomains[owner as usize];
            subdomain.points.push(mesh.points[node]);
            subdomain.reference_nodes += usize::from(model.is_reference(node));
            subdomain.node_tags.push(mesh.node_tags[node]);
            if let Some(interface) = owners.interface[node] {
                subdomain.interface.push(InterfaceNode {
                    node: local,
                    interface,
                });
            }
        }
    }
    let mut local = Vec::new();
    for (cell, (kind, nodes)) in mesh.cells.iter().enumerate() {
        let index = decomposition.subdomain[cell];
        let subdomain = &mut subdomains[index as usize];
        let body = bodies.of_cell[cell];
        if subdomain.body == usize::MAX {
            subdomain.body = body;
        } else if subdomain.body != body {
            return Err(InputError::new(format!(
                "subdomain {index} lies in two disconnected bodies, \"{}\" and \"{}\" (element {}); expected a subdomain of one body",
                bodies.names[subdomain.body], bodies.names[body], mesh.cell_tags[cell]
            )));
        }
        local.clear();
        local.extend(nodes.iter().map(|&node| owners.local(node, index)));
        subdomain.cells.push(kind, &local);
        subdomain.cell_material.push(model.cell_material[cell]);
    }
    give_loads(model, owners, &mut subdomains);
    for &(cell, spring) in &model.springs {
        let index = decomposition.subdomain[cell as usize];
        let nodes = spring.nodes.map(|node| owners.local(node, index));
        let spring = model::SpringBlock { nodes, ..spring };
        subdomains[index as usize].springs.push(spring);
    }
    give_initial_stress(model, decomposition, owners, &mut subdomains);
    give_shares(&model.goals, owners, &mut subdomains);
    Ok(subdomains)
}

/// Gives every subdomain its supports, and the forces at nodes of which it is the lowest subdomain.
fn give_loads(model: &Model, owners: &Owners, subdomains: &mut [Subdomain]) {
    for (i, support) in model.supports.iter().enumerate() {
        for &(owner, node) in owners.of.of(support.node as usize) {
            let subdomain = &mut subdomains[owner as usize];
            let support = model::Support { node, ..*support };
            subdomain.supports.push(support);
            for (of_subdomain, step) in subdomain.steps.iter_mut().zip(&model.steps) {
                of_subdomain.supports.push(step.supports[i]);
            }
        }
    }
    for (i, &(node, force)) in model.forces.iter().enumerate() {
        if let Some(&(owner, node)) = owners.of.of(node as usize).first() {
            let subdomain = &mut subdomains[owner as usize];
            subdomain.forces.push((node, force));
            for (of_subdomain, step) in subdomain.steps.iter_mut().zip(&model.steps) {
                of_subdomain.forces.push(step.forces[i]);
            }
        }
    }
}

/// Gives every subdomain the weights and forces at nodes of which it is the lowest subdomain; those of reactions to all
/// subdomains of a node, as supports are.
fn give_shares(goals: &Goals, owners: &Owners, subdomains: &mut [Subdomain]) {
    let all = &goals.shares;
    let first = |node: u32| owners.of.of(node as usize).first().copied();
    for weight in &all.weights {
        let quantity = &goals.quantities[weight.quantity as usize];
        let owners = owners.of.of(weight.node as usize);
        let count = match quantity.kind {
            QuantityKind::Reaction => owners.len(),
            _ => owners.len().min(1),
        };
        for &(owner, node) in &owners[..count] {
            let weights = &mut subdomains[owner as usize].shares.weights;
            weights.push(NodeWeight { node, ..*weight });
        }
    }
    for force in &all.forces {
        if let Some((owner, node)) = first(force.node) {
            let forces = force.forces.clone();
            subdomains[owner as usize].shares.forces.push(LoadForce {
                node,
                forces,
                ..*force
            });
        }
    }
}

/// Gives every subdomain its part of the initial stress.
fn give_initial_stress(
    model: &Model,
    decomposition: &Decomposition,
    owners: &Owners,
    subdomains: &mut [Subdomain],
) {
    if model.initial_stress.cells.is_empty() {
        return;
    }
    // The first material of the cells around each node of a subdomain.
    let sizes = subdomains.iter().map(|s| s.points.len());
    let mut material: Vec<Vec<u32>> = sizes.map(|size| vec![u32::MAX; size]).collect();
    for (subdomain, first) in subdomains.iter().zip(&mut material) {
        for ((_, nodes), &of_cell) in subdomain.cells.iter().zip(&subdomain.cell_material) {
            for &node in nodes {
                first[node as usize] = of_cell.min(first[node as usize]);
            }
        }
    }
    let mut give = |stress: &model::InitialStress,
                    of: fn(&mut Subdomain, usize) -> &mut InitialStress,
                    step| {
        for (cell, &s) in decomposition.subdomain.iter().enumerate() {
            of(&mut subdomains[s as usize], step)
                .cells
                .push(stress.cells[cell]);
        }
        for (node, list) in owners.of.iter().enumerate() {
            for &(s, local) in list {
                let key = (node as u32, material[s as usize][local as usize]);
                let value = stress.nodes.get(&key).copied().unwrap_or_default();
                of(&mut subdomains[s as usize], step).nodes.push(value);
            }
        }
    };
    give(
        &model.initial_stress,
        |subdomain, _| &mut subdomain.initial_stress,
        0,
    );
    for (k, step) in model.steps.iter().enumerate() {
        give(
            &step.initial_stress,
            |subdomain, k| &mut subdomain.steps[k].initial_stress,
            k,
        );
    }
}

/// The probes of all contacts, in their order.
fn gather_probes(model: &Model, owners: &Owners) -> Vec<Probe<SubdomainNode>> {
    let place = |node: u32| {
        let &(subdomain, node) = owners.of.of(node as usize).first()?;
        Some(SubdomainNode { subdomain, node })
    };
    let of_contacts = model.contacts.iter().flat_map(|contact| &contact.probes);
    let probes = of_contacts.map(|probe| {
        let entries = probe.entries.iter();
        Probe {
            contact: probe.contact,
            tag: probe.tag,
            entries: entries
                .filter_map(|&(node, weight)| Some((place(node)?, weight)))
                .collect(),
            normal: probe.normal,
            gap: probe.gap,
        }
    });
    probes.collect()
}

/// The contact points of every group, in the order of the scene's contacts.
fn gather_points(
    model: &Model,
    owners: &Owners,
    groups: &Groups,
) -> Vec<Vec<ContactPoint<SubdomainNode>>> {
    let mut of_groups = vec![Vec::new(); groups.count];
    for point in model.contacts.iter().flat_map(|contact| &contact.points) {
        let point = point.rename(|node| {
            let &(subdomain, node) = owners.of.of(node as usize).first()?;
            Some(SubdomainNode { subdomain, node })
        });
        let first = point.entries.first();
        if let Some(group) = first.and_then(|(node, _)| groups.of[node.subdomain as usize]) {
            of_groups[group].push(point);
        }
    }
    of_groups
}
