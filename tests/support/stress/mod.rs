//! Random scenes that are hard on a contact solver, and the judges of its answers.
//!
//! A seed determines a scene: its family, geometry, materials, gaps, loads, subdomains, and whether it has an
//! equilibrium. Nothing here depends on the program under test.

mod answer;
mod balance;
mod beams;
mod boxes;
mod cracks;
mod draft;
pub mod friction;
mod inclusions;
pub mod judge;
pub mod manufactured;
mod obstacles;
pub mod record;
pub mod rigid;
pub mod space;
mod towers;
pub mod trial;
mod walls;

use contact_dd_partition::contact_point;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use self::draft::Draft;
use self::friction::{Friction, Law};
use super::random::Random;
use super::scenes::model;
use super::sorts::SORTS;

pub use self::balance::Balance;

/// A family of similar scenes.
#[derive(Clone, Copy)]
pub struct Family {
    pub name: &'static str,
    /// True if nodes of bodies in contact lie opposite each other.
    matching: bool,
    frictional: bool,
    make: fn(&mut Draft),
}

const fn matching(name: &'static str, make: fn(&mut Draft)) -> Family {
    Family {
        name,
        matching: true,
        frictional: false,
        make,
    }
}

/// A family whose bodies are meshed independently.
const fn uneven(name: &'static str, make: fn(&mut Draft)) -> Family {
    Family {
        matching: false,
        ..matching(name, make)
    }
}

/// The families of scenes; from [`FIRST_UNEVEN`] on those with non-matching nodes.
pub const FAMILIES: [Family; 20] = [
    matching("tower", towers::tower),
    matching("packing", boxes::packing),
    matching("bricks", walls::bricks),
    matching("inclusion", inclusions::inclusion),
    matching("punch", obstacles::punched),
    matching("notch", obstacles::notched),
    matching("disk", obstacles::disk),
    matching("beams", beams::beams),
    matching("plank", beams::plank),
    matching("cracks", cracks::cracked),
    matching("wedge", cracks::wedge),
    matching("layers", towers::layers),
    uneven("tower, uneven", towers::tower),
    uneven("packing, uneven", boxes::packing),
    uneven("bricks, uneven", walls::bricks),
    uneven("inclusion, uneven", inclusions::inclusion),
    uneven("beams, uneven", beams::beams),
    uneven("cracks, uneven", cracks::cracked),
    uneven("wedge, uneven", cracks::wedge),
    uneven("layers, uneven", towers::layers),
];
const FIRST_UNEVEN: usize = 12;

/// Number of cells per side from which on some scenes are finer.
const FINE: usize = 10;

/// A random scene.
pub struct Drawn {
    pub seed: u64,
    pub family: &'static str,
    /// The name of its kind of cells.
    pub cells: &'static str,
    /// The scene file.
    pub text: String,
    /// True if its gaps, loads and prescribed displacements were replaced by those of a solution chosen first.
    pub manufactured: bool,
    /// Factor of gaps, loads and prescribed displacements.
    pub factor: f64,
    pub model: Model,
    /// True if an equilibrium exists by construction; `None` if that follows from [`Balance`] only.
    pub equilibrium: Option<bool>,
    /// The wanted number of subdomains, which the scene may not allow.
    pub subdomains: usize,
    /// Number of ranks of a second run, besides the one without a launcher; 0 for none.
    pub ranks: usize,
    /// The laws of friction, if there are any.
    pub friction: Option<Law>,
    /// True if the resultants of all contacts follow from statics, so that elastic bodies with friction balance the
    /// same loads as rigid ones.
    pub determined: bool,
}

impl Drawn {
    /// The scene file, and the changes made after it.
    pub fn described(&self) -> String {
        let mut text = format!("# {} in {}\n{}", self.family, self.cells, self.text);
        if self.manufactured {
            text += "# gaps and loads replaced by those of a known solution\n";
        }
        text + &format!("# gaps and loads × {:e}\n", self.factor)
    }
}

/// The scene of a seed, with blocks of at most `cells` linear cells per side, or half as many quadratic ones; some are
/// several times finer, unless `cells` is small.
#[track_caller]
pub fn draw(seed: u64, cells: usize) -> Drawn {
    draw_from(&FAMILIES, seed, cells)
}

/// The scene of a seed, with blocks whose nodes don't match.
#[track_caller]
pub fn draw_uneven(seed: u64, cells: usize) -> Drawn {
    draw_from(&FAMILIES[FIRST_UNEVEN..], seed, cells)
}

/// A scene with friction, from families of its own; only [`Balance`] can tell whether it has an equilibrium.
#[track_caller]
pub fn draw_frictional(seed: u64, cells: usize) -> Drawn {
    draw_from(&friction::FAMILIES, seed, cells)
}

#[track_caller]
fn draw_from(families: &[Family], seed: u64, cells: usize) -> Drawn {
    let family = families[(seed % families.len() as u64) as usize];
    let mut random = Random::new(seed);
    let sort = random.pick(&SORTS);
    let cells = match sort.is_quadratic {
        true => cells.div_ceil(2),
        false => cells,
    };
    let cells = match cells >= FINE && random.chance(0.03) {
        true => 3 * cells,
        false => random.count(2.min(cells), cells),
    };
    let mut draft = Draft::new(random.clone(), cells);
    draft.matching = family.matching;
    if family.frictional {
        // Separate random numbers leave the rest of the scene as without friction.
        draft.friction = Some(Friction::new(Random::new(!seed), draft.load));
    }
    (family.make)(&mut draft);
    if family.frictional {
        draft.equilibrium = None;
    }
    let mesh = sort.of(&draft.blocks.mesh);
    drawn(seed, family.name, sort.name, draft, mesh)
}

/// The scene of a draft on its mesh.
#[track_caller]
fn drawn(seed: u64, family: &'static str, cells: &'static str, draft: Draft, mesh: Mesh) -> Drawn {
    // The judge's criteria don't depend on the size of strains, which is often unrealistic here.
    let text = format!("large_strains = true\n{}", draft.text());
    let mut model = model(&text, mesh);
    let mut random = draft.random;
    let may_be = draft.equilibrium == Some(true) || model.mesh.dim == 3;
    let may_be = may_be && draft.friction.is_none();
    let manufactured = may_be && random.chance(0.15);
    if manufactured {
        manufactured::manufacture(&mut model, &mut random);
    }
    let factor = match random.chance(0.12) {
        true => random.pick(&[1e-100, 1e-30, 1e-8, 1e8, 1e30, 1e100]),
        false => 1.0,
    };
    scale(&mut model, factor);
    let most = random.pick(&[4, 10, 30]);
    let subdomains = random.count(1, most);
    let ranks = match random.below(5) {
        0 => random.count(2, 4),
        _ => 0,
    };
    Drawn {
        seed,
        family,
        cells,
        text,
        manufactured,
        factor,
        model,
        equilibrium: draft.equilibrium,
        subdomains,
        ranks,
        friction: draft.friction.map(|friction| friction.law),
        determined: draft.determined,
    }
}

/// Multiplies forces, gaps, prescribed displacements and bounds of friction, and thereby the solution.
pub fn scale(model: &mut Model, factor: f64) {
    for step in &mut model.steps {
        step.supports.iter_mut().for_each(|value| *value *= factor);
        for force in &mut step.forces {
            *force = force.map(|f| f * factor);
        }
    }
    for (_, force) in &mut model.forces {
        *force = force.map(|f| f * factor);
    }
    for support in &mut model.supports {
        support.value *= factor;
    }
    for condition in model.contacts.iter_mut().flat_map(|c| &mut c.points) {
        condition.gap *= factor;
        condition.is_gap_given = true;
        match &mut condition.law {
            contact_point::Law::Frictionless | contact_point::Law::Tied => {}
            contact_point::Law::Given { bound } => *bound *= factor,
            contact_point::Law::Coulomb { cohesion, .. } => *cohesion *= factor,
        }
    }
}

/// The partition into the wanted number of subdomains, or the nearest possible one.
pub fn decomposed(model: &Model, wanted: usize) -> Result<Decomposition, String> {
    let error = match Decomposition::new(model, Some(wanted)) {
        Ok(decomposition) => return Ok(decomposition),
        Err(error) => error.to_string(),
    };
    let numbers: Vec<usize> = error
        .split(|c: char| !c.is_ascii_digit())
        .filter_map(|digits| digits.parse().ok())
        .collect();
    let &[_, least, most] = numbers.as_slice() else {
        return Err(error);
    };
    Decomposition::new(model, Some(wanted.clamp(least, most))).map_err(|error| error.to_string())
}
