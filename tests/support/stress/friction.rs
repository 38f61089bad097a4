//! Scenes with friction: laws, and loads that reverse.
//!
//! The families without friction get laws and load steps; two more are driven along their joints.

use super::super::random::Random;
use super::boxes::{self, wall};
use super::draft::{Draft, rectangle};
use super::{Family, cracks, inclusions, matching, towers, uneven};

/// The laws of a scene's contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Tresca friction.
    Given,
    /// Coulomb's friction with coefficients of this size at most.
    Coulomb(f64),
}

/// Parameters with which laws of friction are drawn.
pub struct Friction {
    random: Random,
    pub law: Law,
    /// Size of the pressures (Pa).
    load: f64,
    /// Orders of magnitude below and above the load of Tresca bounds, or of any cohesion.
    orders: Option<[f64; 2]>,
}

/// A family, with laws of friction added.
pub const fn frictional(family: Family) -> Family {
    Family {
        frictional: true,
        ..family
    }
}

/// The families of scenes with friction.
pub const FAMILIES: [Family; 14] = [
    frictional(matching("stack", stack)),
    frictional(matching("layers", layers)),
    frictional(matching("packing", packing)),
    frictional(matching("wedge", wedge)),
    frictional(matching("inclusion", inclusion)),
    frictional(matching("sheared", sheared)),
    frictional(matching("driven", driven)),
    frictional(uneven("stack, uneven", stack)),
    frictional(uneven("layers, uneven", layers)),
    frictional(uneven("packing, uneven", packing)),
    frictional(uneven("wedge, uneven", wedge)),
    frictional(uneven("inclusion, uneven", inclusion)),
    frictional(uneven("sheared, uneven", sheared)),
    frictional(uneven("driven, uneven", driven)),
];

impl Friction {
    /// The laws of a scene with pressures of this size.
    pub fn new(mut random: Random, load: f64) -> Self {
        let (law, orders) = match random.below(8) {
            0 | 1 => (Law::Given, Some([-10.0, 2.0])),
            2..5 => (Law::Coulomb(random.within(0.0, 0.5)), None),
            5 => (Law::Coulomb(random.within(0.0, 0.5)), Some([-4.0, 0.0])),
            6 => (Law::Coulomb(random.within(0.5, 1.5)), None),
            _ => (Law::Coulomb(random.within(0.0, 1.5)), Some([-4.0, 0.0])),
        };
        Self {
            random,
            law,
            load,
            orders,
        }
    }

    /// The keys of a contact.
    pub fn drawn(&mut self) -> String {
        let random = &mut self.random;
        let size = (self.orders).map(|[low, high]| self.load * random.magnitude(low, high));
        let mut key = |name: &str, value: f64| match random.below(4) {
            // A coefficient between half the largest and the largest.
            0 => {
                let wave = random.within(0.1, 30.0);
                format!("{name} = '({value:e})*(0.75+0.25*sin(({wave})*(x+2*y)))'\n")
            }
            _ => format!("{name} = {value:e}\n"),
        };
        match (self.law, size) {
            (Law::Given, size) => key("tresca", size.unwrap_or(self.load)),
            (Law::Coulomb(most), size) => {
                let cohesion = size.map(|size| key("cohesion", size));
                let coefficient = most * self.random.pick(&[1.0, 1.0, 0.5, 0.0]);
                format!("friction = {coefficient:e}\n") + &cohesion.unwrap_or_default()
            }
        }
    }
}

fn stack(draft: &mut Draft) {
    towers::tower(draft);
    to_and_fro(draft);
}

fn layers(draft: &mut Draft) {
    towers::layers(draft);
    to_and_fro(draft);
}

fn packing(draft: &mut Draft) {
    boxes::packing(draft);
    to_and_fro(draft);
}

fn wedge(draft: &mut Draft) {
    cracks::wedge(draft);
    if draft.random.chance(0.5) {
        let aside = draft.load * draft.random.magnitude(-3.0, -0.5);
        draft.traction("middle top", [&format!("{aside:e}"), "0"]);
    }
    to_and_fro(draft);
}

fn inclusion(draft: &mut Draft) {
    inclusions::inclusion(draft);
    to_and_fro(draft);
}

/// Flat blocks on a base or a floor, pressed and pushed sideways, by less or by more than friction carries.
fn sheared(draft: &mut Draft) {
    let count = draft.random.count(1, 3);
    let on_floor = draft.random.chance(0.5);
    draft.determined = true;
    let columns = draft.cells.max(2);
    let mut low = 0.0;
    for i in 0..count {
        let height = draft.random.magnitude(-1.5, -0.5);
        let rows = draft.random.count(1, 3);
        let n = [draft.facing(columns), rows];
        let name = format!("b{i}");
        draft.block(
            &name,
            rectangle([0.0, 1.0], [low, low + height]),
            n,
            [0.0, 0.0],
        );
        let bottom = [format!("{name} bottom")];
        if i > 0 {
            draft.contact(&bottom, &[format!("b{} top", i - 1)], Some("0"));
        } else if on_floor {
            draft.obstacle(&bottom, &wall(0.0, 0.0, [0, 1]), Some("0"));
        } else {
            draft.hold(&bottom[0], Some("0"), Some("0"));
        }
        low += height;
    }
    let top = format!("b{} top", count - 1);
    let pressure = draft.load * draft.random.magnitude(-2.0, 0.0);
    draft.pressure(&top, &format!("{pressure:e}"));
    // The weakest joint's strength isn't known, so that some of these slide.
    let most = match draft.friction.as_ref().map(|friction| friction.law) {
        Some(Law::Coulomb(most)) => most,
        _ => 0.5,
    };
    let share = draft.random.within(0.0, 0.8);
    draft.traction(&top, [&format!("{:e}", pressure * most * share), "0"]);
    to_and_fro(draft);
}

/// A block on a base, pressed, its upper side moved forth and back further than it sticks; or it is pressed by that
/// side, too.
fn driven(draft: &mut Draft) {
    let height = draft.random.magnitude(-1.0, 0.0);
    let columns = [0; 2].map(|_: usize| draft.side_cells().max(2));
    let wide = draft.random.within(1.0, 2.0);
    let n = match draft.matching {
        true => [columns[0]; 2],
        false => columns,
    };
    let rows = draft.random.count(1, draft.cells);
    let wide = if draft.matching { 1.0 } else { wide };
    draft.block(
        "base",
        rectangle([1.0 - wide, wide], [-0.5, 0.0]),
        [n[0], rows],
        [0.0; 2],
    );
    draft.block(
        "b",
        rectangle([0.0, 1.0], [0.0, height]),
        [n[1], rows],
        [0.0; 2],
    );
    let gap = draft.drawn_gap("x");
    let gap = if draft.random.chance(0.5) {
        "0".into()
    } else {
        gap
    };
    draft.contact(&["b bottom".into()], &["base top".into()], Some(&gap));
    draft.hold("base bottom", Some("0"), Some("0"));
    let size = draft.compression() * draft.random.magnitude(-1.0, 1.0);
    let pressed = draft.compression() * draft.random.magnitude(-1.0, 0.5);
    let by_load = draft.random.chance(0.5);
    let down = (!by_load).then(|| format!("{:e}", -pressed));
    draft.hold("b top", Some(&format!("{size:e}")), down.as_deref());
    if by_load {
        let pressure = draft.drawn_pressure("x", [0.0, 1.0]);
        draft.pressure("b top", &pressure);
    }
    for _ in 0..draft.random.count(1, 5) {
        let aside = size * draft.random.signed();
        let mut keys = format!("[[step.displacement]]\non = 'b top'\nx = {aside:e}\n");
        if !by_load {
            let down = pressed * draft.random.within(0.2, 1.2);
            keys += &format!("y = {:e}\n", -down);
        }
        // The base stays at rest.
        keys += "[[step.displacement]]\non = 'base bottom'\nx = 0.0\ny = 0.0";
        draft.step(&keys);
    }
}

/// Up to five load steps, whose sideways loads change sign.
fn to_and_fro(draft: &mut Draft) {
    if draft.random.chance(0.3) {
        return;
    }
    for _ in 0..draft.random.count(1, 5) {
        let aside = draft.random.signed();
        let [pressure, weight] = [0; 2].map(|_: usize| draft.random.within(0.3, 1.5));
        draft.step(&format!(
            "scale = {{ traction = {aside}, pressure = {pressure}, body_force = {weight} }}"
        ));
    }
}
