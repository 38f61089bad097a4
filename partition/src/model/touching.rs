//! Automatic contact detection: contacts wherever bodies touch, handled as if the scene declared each of them.
//!
//! Facets of the boundary that face each other within a small distance form a pair. Adjacent pairs form a contact, as
//! long as the facets on both of its sides continue without a corner in the same body. Its sides become groups of the
//! mesh.

mod explicit;
mod nearest;
mod patch;
mod ties;

use std::collections::{BTreeMap, HashSet};

use self::explicit::Explicit;
use self::patch::Patch;
use self::ties::Ties;
use super::bodies::Bodies;
use super::skin::{Facing, ROUND_OFF, STANDING_OFF, Skin};
use crate::error::InputError;
use crate::magnitude::short;
use crate::mesh::topology::{CellFacet, Topology};
use crate::mesh::{Group, Mesh};
use crate::name;
use crate::scene::Scene;
use crate::scene::condition::Names;
use crate::scene::contact::{Between, Contact, Declaration};

/// Distance, relative to their size, up to which facets adjacent to touching ones are considered as possibly coming
/// into contact.
const NEAR: f64 = 0.25;

/// Gap at the centre of facets adjacent to touching ones, relative to their size, that loads may close: the sides open
/// with twice that slope, and closing a slope needs strains of about half of it (Hertz: p_0/E* = a/(2R)), beyond which
/// strains aren't small.
const CLOSING: f64 = 0.1;

/// A contact of the scene, with the description of its facets if it was found.
pub(super) struct Declared {
    pub contact: Contact,
    /// The name of its declaration in the scene.
    pub table: String,
    /// Description of facets and bodies.
    pub words: Option<String>,
}

/// A declaration of the scene that requests contacts wherever bodies touch, and the contacts found for it.
struct Search<'a> {
    between: &'a Between,
    patches: Vec<Patch>,
    /// Number of pairs that already belong to other contacts.
    taken: usize,
}

impl Search<'_> {
    /// The distance up to which facets of a size touch (m).
    fn tolerance(&self, size: f64) -> f64 {
        self.between.within.unwrap_or(STANDING_OFF * size)
    }
}

/// The contacts of a scene in its order, with those found in place of their declaration; their sides are added to the
/// groups of the mesh.
///
/// # Errors
/// A declaration for which nothing is found.
pub(super) fn contacts(
    scene: &Scene,
    bodies: &mut Bodies,
    topology: &Topology,
    warnings: &mut Vec<String>,
) -> Result<Vec<Declared>, InputError> {
    let mut searches: Vec<Search> = Vec::new();
    for declared in &scene.contact {
        if let Declaration::Between(between) = declared {
            searches.push(Search {
                between,
                patches: Vec::new(),
                taken: 0,
            });
        }
    }
    let mut groups = Vec::new();
    let found = match searches.is_empty() {
        true => Vec::new(),
        false => {
            let skin = Skin::new(bodies, topology, scene.plane, |_| true);
            let ties = Ties::new(bodies, topology);
            search(&mut searches, scene, &skin, topology, &ties, warnings)?;
            let sides = Sides { scene, skin: &skin };
            sides.written(&searches, &mut groups)?
        }
    };
    for (name, facets) in groups {
        add_group(&mut bodies.mesh, name, &facets);
    }
    let mut found = found.into_iter();
    let mut contacts = Vec::new();
    for declared in &scene.contact {
        match declared {
            Declaration::Contact(contact) => contacts.push(Declared {
                contact: contact.clone(),
                table: contact.name.clone(),
                words: None,
            }),
            Declaration::Between(_) => contacts.extend(found.next().into_iter().flatten()),
        }
    }
    contacts.extend(scene.tie.iter().map(|tie| Declared {
        contact: tie.contact(),
        table: tie.name.clone(),
        words: None,
    }));
    Ok(contacts)
}

/// The pairs of facets that face each other within every search, without those that belong to an `explicit` contact.
fn facing_sides(
    searches: &mut [Search],
    skin: &Skin,
    names: &[&str],
    explicit: &Explicit,
) -> Vec<Vec<Facing>> {
    let within = searches.iter().filter_map(|search| search.between.within);
    let farthest = within.fold(0.0, f64::max);
    let facing = skin.facing(|size| farthest.max(NEAR * size));
    let mut of_search: Vec<Vec<Facing>> = vec![Vec::new(); searches.len()];
    for pair in facing {
        let [a, b] = pair.facets.map(|facet| &skin.facets[facet]);
        let [first, second] = [a, b].map(|facet| names[facet.body as usize]);
        let wanted = |search: &Search| search.between.bodies.has(first, second);
        let Some((index, search)) =
            (searches.iter_mut().enumerate()).find(|(_, search)| wanted(search))
        else {
            continue;
        };
        match explicit.has(a.place, b.place) {
            true => search.taken += 1,
            false => of_search[index].push(pair),
        }
    }
    of_search
}

/// Finds the patches of every search.
fn search(
    searches: &mut [Search],
    scene: &Scene,
    skin: &Skin,
    topology: &Topology,
    ties: &Ties,
    warnings: &mut Vec<String>,
) -> Result<(), InputError> {
    let names: Vec<&str> = scene.bodies.keys().map(String::as_str).collect();
    let of_search = facing_sides(
        searches,
        skin,
        &names,
        &Explicit::new(scene, skin.mesh, topology),
    );
    let neighbours = skin.neighbours();
    let unit = scene.units.length();
    for (search, pairs) in searches.iter_mut().zip(of_search) {
        let size = |pair: &Facing| {
            let [a, b] = pair.facets.map(|facet| skin.facets[facet].shape.size());
            a.max(b)
        };
        let (mut touching, mut near): (Vec<Facing>, Vec<Facing>) =
            (pairs.into_iter()).partition(|pair| pair.gap.abs() <= search.tolerance(size(pair)));
        if search.between.within.is_none() {
            continue_clearances(&neighbours, &mut touching, &mut near);
        }
        search.patches = patch::patches(skin, &neighbours, &touching);
        let what = &search.between.name;
        if search.between.within.is_none() {
            warnings.extend(parting(skin, &neighbours, &touching, &near, what, unit));
        }
        if search.patches.is_empty() && search.taken == 0 {
            return Err(match ties.of(search.between, &names) {
                Some(tied) => InputError::new(format!(
                    "contact '{what}': no facets face each other between its bodies; {tied}"
                )),
                None => nearest::apart(skin, &names, search.between, &near, unit),
            });
        }
        if let Some(tied) = ties.of(search.between, &names) {
            warnings.push(format!("contact '{what}': {tied}"));
        }
        if search.patches.is_empty() {
            warnings.push(format!(
                "contact '{what}': no new contacts found: all touching facets already belong to one"
            ));
        }
    }
    Ok(())
}

/// Moves pairs from `near` to the adjacent `touching` ones, as long as no gap exceeds the gaps of these: a clearance
/// continues between smaller facets.
fn continue_clearances(
    neighbours: &[Vec<usize>],
    touching: &mut Vec<Facing>,
    near: &mut Vec<Facing>,
) {
    let most = touching
        .iter()
        .map(|pair| pair.gap.abs())
        .fold(0.0, f64::max);
    let mut touch: HashSet<[usize; 2]> = touching.iter().map(|pair| pair.facets).collect();
    loop {
        let is_beside = |pair: &Facing| {
            let mut beside = patch::beside(neighbours, pair.facets);
            pair.gap.abs() <= most && beside.any(|[a, b]| touch.contains(&[a.min(b), a.max(b)]))
        };
        let (found, left): (Vec<Facing>, Vec<Facing>) = near.iter().copied().partition(is_beside);
        if found.is_empty() {
            break;
        }
        touch.extend(found.iter().map(|pair| pair.facets));
        touching.extend(found);
        *near = left;
    }
    touching.sort_by_key(|pair| pair.facets);
}

/// The warning of a gap that opens slowly beside touching facets: loads may close it.
fn parting(
    skin: &Skin,
    neighbours: &[Vec<usize>],
    touching: &[Facing],
    near: &[Facing],
    what: &str,
    unit: &str,
) -> Option<String> {
    let touch: HashSet<[usize; 2]> = touching.iter().map(|pair| pair.facets).collect();
    let goes_on = |pair: &&Facing| {
        let mut beside = patch::beside(neighbours, pair.facets);
        let [a, b] = pair.facets.map(|facet| skin.facets[facet].shape.size());
        pair.gap > 0.0
            && pair.gap <= CLOSING * a.max(b)
            && beside.any(|[a, b]| touch.contains(&[a.min(b), a.max(b)]))
    };
    let first = near.iter().filter(goes_on);
    let first = first.min_by(|a, b| a.gap.total_cmp(&b.gap))?;
    let node = skin.facets[first.facets[0]].shape.nodes[0];
    Some(format!(
        "contact '{what}': beyond its end, as near node {}, the gap opens slowly, to {} {unit} in the middle of the next \
         facets; if loads close it by more, give within = how much, no more: what is beyond adds facets that stay open",
        skin.mesh.node_tags[node as usize],
        short(first.gap)
    ))
}

/// Names and records the contacts found.
struct Sides<'a> {
    scene: &'a Scene,
    skin: &'a Skin<'a>,
}

impl Sides<'_> {
    /// The contacts of every search; their sides are added to `groups`, each with its name.
    fn written(
        &self,
        searches: &[Search],
        groups: &mut Vec<(String, Vec<CellFacet>)>,
    ) -> Result<Vec<Vec<Declared>>, InputError> {
        let names: Vec<&str> = self.scene.bodies.keys().map(String::as_str).collect();
        let mut taken = self.taken_names();
        let mut taken_groups: HashSet<String> = self.skin.mesh.groups.keys().cloned().collect();
        let mut all = Vec::new();
        for search in searches {
            let mut of_search = Vec::new();
            let name_of = |body: u32| names[body as usize];
            let mut counts: BTreeMap<[u32; 2], [usize; 2]> = BTreeMap::new();
            for patch in &search.patches {
                counts.entry(patch.pair()).or_default()[0] += 1;
            }
            for patch in &search.patches {
                let bodies = patch.bodies.map(name_of);
                let [count, place] = counts.entry(patch.pair()).or_default();
                *place += 1;
                let mut name = search.between.name.clone();
                if search.patches.len() > 1 {
                    name = format!(
                        "{name} {}",
                        between(patch.pair().map(name_of)).replace('/', "-")
                    );
                    if *count > 1 {
                        name = format!("{name} {place}");
                    }
                }
                let name = unique(name, &mut taken);
                name::check_contact(&name).map_err(|reason| {
                    InputError::new(format!("contact '{}' {reason}", name::shown(&name)))
                })?;
                let sides = [0, 1].map(|side| {
                    let letter = if bodies[0] == bodies[1] {
                        [" a", " b"][side]
                    } else {
                        ""
                    };
                    let group = format!("{} ({name}){letter}", bodies[side]);
                    let group = unique(group, &mut taken_groups);
                    let facets = patch.sides[side].iter();
                    let facets = facets.map(|&facet| self.skin.facets[facet].place).collect();
                    groups.push((group.clone(), facets));
                    Names::from(group)
                });
                let words = self.words(patch, bodies, &name);
                of_search.push(Declared {
                    contact: search.between.contact(name, sides),
                    table: search.between.name.clone(),
                    words: Some(words),
                });
            }
            all.push(of_search);
        }
        Ok(all)
    }

    /// The names of contacts, ties and equations in the scene.
    fn taken_names(&self) -> HashSet<String> {
        let explicit = self.scene.contact.iter().filter_map(Declaration::contact);
        (explicit.map(|contact| &contact.name))
            .chain(self.scene.tie.iter().map(|tie| &tie.name))
            .chain(self.scene.equation.iter().map(|equation| &equation.name))
            .cloned()
            .collect()
    }

    /// Description of the two sides of a contact.
    fn words(&self, patch: &Patch, bodies: [&str; 2], name: &str) -> String {
        let unit = self.scene.units.length();
        let square = if self.skin.mesh.dim == 3 { "²" } else { "" };
        let [a, b] = [0, 1].map(|side| patch.sides[side].len());
        let facets = match bodies {
            [first, second] if first == second => format!("{a} on {b} facets of '{first}'"),
            [first, second] => {
                let word = if a == 1 { "facet" } else { "facets" };
                format!("{a} {word} of '{first}' on {b} of '{second}'")
            }
        };
        let size = patch.measure / (a.min(b) as f64);
        let size = if self.skin.mesh.dim == 3 {
            size.sqrt()
        } else {
            size
        };
        let seen = |gap: f64| (gap.abs() > ROUND_OFF * size).then(|| short(gap.abs()));
        let [least, most] = patch.gaps;
        let mut words = format!("{name}: {facets}, {} {unit}{square}", short(patch.measure));
        if let Some(overlap) = seen(least.min(0.0)) {
            words += &format!(", overlap up to {overlap} {unit}");
        }
        if let Some(gap) = seen(most.max(0.0)) {
            words += &format!(", gap up to {gap} {unit}");
        }
        words
    }
}

/// The two bodies, joined to a name.
fn between([first, second]: [&str; 2]) -> String {
    match first == second {
        true => first.to_owned(),
        false => format!("{first}-{second}"),
    }
}

/// A name that isn't taken yet; it is added to `taken`.
fn unique(name: String, taken: &mut HashSet<String>) -> String {
    let mut free = name.clone();
    let mut number = 2;
    while !taken.insert(free.clone()) {
        free = format!("{name} ({number})");
        number += 1;
    }
    free
}

/// Adds a group of facets to a mesh.
fn add_group(mesh: &mut Mesh, name: String, facets: &[CellFacet]) {
    let first = mesh.facets.len() as u32;
    for facet in facets {
        let (kind, _) = mesh.cells.kind(facet.cell as usize).facets()[facet.facet as usize];
        let nodes = facet.nodes(&mesh.cells);
        mesh.facets.push(kind, &nodes);
    }
    let group = Group {
        dim: mesh.dim - 1,
        members: (first..mesh.facets.len() as u32).collect(),
    };
    mesh.groups.insert(name, group);
}
