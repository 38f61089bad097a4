//! Random scenes that are hard on a contact solver, and what to say of its answers.
//!
//! A seed is a scene: its family, geometry, materials, gaps, loads, subdomains, and whether it has
//! an equilibrium. Nothing here looks into the program under test.

mod balance;
mod beams;
mod boxes;
mod cracks;
mod draft;
mod inclusions;
pub mod judge;
pub mod manufactured;
mod obstacles;
pub mod rigid;
mod towers;
pub mod trial;
mod walls;

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::model::Model;

use self::draft::Draft;
use super::random::Random;
use super::scenes::model;

pub use self::balance::Balance;

type Family = (&'static str, fn(&mut Draft));

/// The families of scenes.
pub const FAMILIES: [Family; 12] = [
    ("tower", towers::tower),
    ("packing", boxes::packing),
    ("bricks", walls::bricks),
    ("inclusion", inclusions::inclusion),
    ("punch", obstacles::punched),
    ("notch", obstacles::notched),
    ("disk", obstacles::disk),
    ("beams", beams::beams),
    ("plank", beams::plank),
    ("cracks", cracks::cracked),
    ("wedge", cracks::wedge),
    ("layers", towers::tower),
];

/// A random scene.
pub struct Drawn {
    pub seed: u64,
    pub family: &'static str,
    /// Its scene file; what was changed behind it stands in `remarks`.
    pub text: String,
    pub remarks: Vec<String>,
    pub model: Model,
    /// Whether it was built to have an equilibrium; `None` where only [`Balance`] knows.
    pub equilibrium: Option<bool>,
    /// The wanted number of subdomains, which the scene may not allow.
    pub subdomains: usize,
    /// On how many ranks it runs besides without a launcher, 0 for none.
    pub ranks: usize,
}

/// The scene of a seed, with blocks of at most `cells` cells a side.
#[track_caller]
pub fn draw(seed: u64, cells: usize) -> Drawn {
    let (family, make) = FAMILIES[(seed % FAMILIES.len() as u64) as usize];
    let mut random = Random::new(seed);
    let cells = random.count(2.min(cells), cells);
    let mut draft = Draft::new(random.clone(), cells);
    make(&mut draft);
    let text = draft.text();
    let mut model = model(&text, draft.blocks.mesh);
    let mut remarks = Vec::new();
    let mut random = draft.random;
    if draft.equilibrium == Some(true) && random.chance(0.15) {
        manufactured::manufacture(&mut model, &mut random);
        remarks.push("gaps and forces of a known solution".to_owned());
    }
    if random.chance(0.12) {
        let factor = random.pick(&[1e-100, 1e-30, 1e-8, 1e8, 1e30, 1e100]);
        scale(&mut model, factor);
        remarks.push(format!("loads and gaps × {factor:e}"));
    }
    let most = random.pick(&[4, 10, 30]);
    let subdomains = random.count(1, most);
    let ranks = match random.below(5) {
        0 => random.count(2, 4),
        _ => 0,
    };
    Drawn {
        seed,
        family,
        text,
        remarks,
        model,
        equilibrium: draft.equilibrium,
        subdomains,
        ranks,
    }
}

/// Multiplies forces, gaps and prescribed displacements, and so the solution.
pub fn scale(model: &mut Model, factor: f64) {
    for (_, force) in &mut model.forces {
        *force = force.map(|f| f * factor);
    }
    for support in &mut model.supports {
        support.value *= factor;
    }
    for condition in model.contacts.iter_mut().flat_map(|c| &mut c.conditions) {
        condition.gap *= factor;
    }
}

/// The partition into the wanted number of subdomains, or the nearest that can be.
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
