//! Blocks on top of each other: towers, stacks, thin layers between thick ones.

use super::draft::{Draft, bilinear, noise, rectangle};

/// The kind of failure of a tower, if it fails.
#[derive(Clone, Copy, PartialEq)]
enum Fall {
    Stands,
    Lifted,
    Toppled,
    Pushed,
}

/// Blocks that get narrower towards the top, with smooth or rough joints, free or supported by rollers on the
/// left.
pub fn tower(draft: &mut Draft) {
    pile(draft, |draft, _| draft.random.magnitude(-3.0, 0.3));
}

/// Thin layers between blocks.
pub fn layers(draft: &mut Draft) {
    let thin = draft.random.magnitude(-4.0, -1.0);
    pile(draft, |_, i| if i % 2 == 1 { thin } else { 1.0 });
}

fn pile(draft: &mut Draft, height: impl Fn(&mut Draft, usize) -> f64) {
    let count = draft.random.count(2, 5);
    let rolled = draft.random.chance(0.4);
    let fall = match draft.random.below(12) {
        0 => Fall::Lifted,
        1 if !rolled => Fall::Toppled,
        2 if !rolled => Fall::Pushed,
        _ => Fall::Stands,
    };
    draft.equilibrium = Some(fall == Fall::Stands);
    draft.determined = !rolled;
    // An uneven surface would hold blocks that are pushed.
    let rough = fall == Fall::Stands && draft.random.chance(0.3);
    if rough && !rolled {
        draft.equilibrium = None;
        draft.determined = false;
    }
    let width = draft.cells.max(2);
    let mut columns = [0, width];
    let mut low = 0.0;
    for i in 0..count {
        if i > 0 && columns[1] - columns[0] > 2 && draft.random.chance(0.4) {
            columns[0] += draft.random.below(2);
            columns[1] -= draft.random.below(2);
        }
        let height = height(draft, i);
        let rows = ((height * width as f64).ceil() as usize).clamp(1, draft.cells);
        let x = columns.map(|c| c as f64 / width as f64);
        let n = [draft.facing(columns[1] - columns[0]), rows];
        let weight = match fall {
            Fall::Lifted | Fall::Toppled => 0.0,
            _ => draft.weight(height),
        };
        let aside = match rolled {
            true => draft.load * draft.random.signed() * 0.1,
            false => 0.0,
        };
        layer(draft, i, x, [low, low + height], n, [aside, weight], rough);
        if i == 0 {
            draft.hold("b0 bottom", Some("0"), Some("0"));
        } else {
            if rolled {
                draft.hold(&format!("b{i} left"), Some("0"), None);
            }
            let gap = (!rough).then(|| draft.drawn_gap("x"));
            let (a, b) = (format!("b{i} bottom"), format!("b{} top", i - 1));
            draft.contact(&[a], &[b], gap.as_deref());
        }
        low += height;
        if i + 1 == count {
            load(draft, &format!("b{i} top"), x, fall);
        }
    }
}

/// A block whose lower and upper surfaces are plane, or uneven by far less than a facet.
fn layer(
    draft: &mut Draft,
    index: usize,
    x: [f64; 2],
    y: [f64; 2],
    n: [usize; 2],
    force: [f64; 2],
    rough: bool,
) {
    let name = format!("b{index}");
    if !rough {
        draft.block(&name, rectangle(x, y), n, force);
        return;
    }
    let facet = (x[1] - x[0]) / n[0] as f64;
    // The load closes gaps in part: if they are larger, the load is less than their round-off.
    let most = 1e4 * draft.compression();
    let size = (y[1] - y[0]).min(facet).min(most) * draft.random.magnitude(-3.0, -1.5);
    let seed = [index as f64 * 7.0, index as f64 * 7.0 + 3.0];
    draft.shape(&name, n, |[s, t]| {
        let [px, py] = bilinear(rectangle(x, y), [s, t]);
        // Joints stay open a little, so that no side lies far behind its partner.
        let below = size * (1.0 + noise(seed[0] + px)) * (1.0 - t);
        let above = size * (1.0 + noise(seed[1] + px)) * t;
        [px, py + below - above]
    });
    draft.body(&name, &[&name], force);
}

fn load(draft: &mut Draft, top: &str, x: [f64; 2], fall: Fall) {
    let size = draft.load;
    match fall {
        Fall::Stands => {
            let pressure = draft.drawn_pressure("x", x);
            draft.pressure(top, &pressure);
        }
        Fall::Lifted => draft.traction(top, ["0", &format!("{size:e}")]),
        Fall::Toppled => {
            let (middle, half) = ((x[0] + x[1]) / 2.0, (x[1] - x[0]) / 2.0);
            let slope = draft.random.within(4.0, 20.0) * draft.random.signed().signum() / half;
            let value = format!("({size:e})*(1+({slope:e})*(x-({middle:e})))");
            draft.pressure(top, &value);
        }
        Fall::Pushed => {
            let aside = size * draft.random.magnitude(-5.0, 0.0);
            draft.traction(top, [&format!("{aside:e}"), &format!("{:e}", -size)]);
        }
    }
}
