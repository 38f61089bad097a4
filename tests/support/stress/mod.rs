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
    ("layers", towers::layers),
];

/// Those whose blocks may be meshed each for itself.
const UNEVEN: [Family; 3] = [
    ("tower", towers::tower),
    ("packing", boxes::packing),
    ("layers", towers::layers),
];

/// Cells a side from which on some scenes are finer.
const FINE: usize = 10;

/// A random scene.
pub struct Drawn {
    pub seed: u64,
    pub family: &'static str,
    /// Its scene file.
    pub text: String,
    /// Whether its gaps, loads and prescribed displacements were replaced by those of a solution
    /// chosen first.
    pub manufactured: bool,
    /// What gaps, loads and prescribed displacements were multiplied by.
    pub factor: f64,
    pub model: Model,
    /// Whether it was built to have an equilibrium; `None` where only [`Balance`] knows.
    pub equilibrium: Option<bool>,
    /// The wanted number of subdomains, which the scene may not allow.
    pub subdomains: usize,
    /// On how many ranks it runs besides without a launcher, 0 for none.
    pub ranks: usize,
}

impl Drawn {
    /// Its scene file, and what was changed behind it.
    pub fn described(&self) -> String {
        let mut text = self.text.clone();
        if self.manufactured {
            text += "# gaps and loads replaced by those of a known solution\n";
        }
        text + &format!("# gaps and loads × {:e}\n", self.factor)
    }
}

/// The scene of a seed, with blocks of at most `cells` cells a side; where that isn't few, some
/// scenes are several times finer.
#[track_caller]
pub fn draw(seed: u64, cells: usize) -> Drawn {
    let family = FAMILIES[(seed % FAMILIES.len() as u64) as usize];
    draw_of(family, true, seed, cells)
}

/// The same with blocks whose nodes don't match.
#[track_caller]
pub fn draw_uneven(seed: u64, cells: usize) -> Drawn {
    let family = UNEVEN[(seed % UNEVEN.len() as u64) as usize];
    draw_of(family, false, seed, cells)
}

#[track_caller]
fn draw_of((family, make): Family, matching: bool, seed: u64, cells: usize) -> Drawn {
    let mut random = Random::new(seed);
    let cells = match cells >= FINE && random.chance(0.03) {
        true => 3 * cells,
        false => random.count(2.min(cells), cells),
    };
    let mut draft = Draft::new(random.clone(), cells);
    draft.matching = matching;
    make(&mut draft);
    let text = draft.text();
    let mut model = model(&text, draft.blocks.mesh);
    let mut random = draft.random;
    let manufactured = draft.equilibrium == Some(true) && random.chance(0.15);
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
        text,
        manufactured,
        factor,
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
