//! Walls of bricks in running bond.

use super::boxes::wall;
use super::draft::{Draft, rectangle};

/// A brick: its course, and where it begins and ends, in half bricks.
#[derive(Clone, Copy)]
struct Brick {
    course: usize,
    halves: [usize; 2],
}

impl Brick {
    fn name(self) -> String {
        format!("b{}_{}", self.course, self.halves[0])
    }

    fn side(self, side: &str) -> String {
        format!("{} {side}", self.name())
    }
}

/// Bricks that overlap by half; bed joints always, head joints and walls at the ends sometimes.
pub fn bricks(draft: &mut Draft) {
    let (courses, length) = (draft.random.count(2, 4), 2 * draft.random.count(1, 3));
    let n = [0; 2].map(|_: usize| draft.random.count(1, draft.cells.div_ceil(3)));
    let (width, height) = (1.0, draft.random.magnitude(-1.0, 0.5));
    let head_joints = draft.random.chance(0.7);
    let ends = head_joints && draft.random.chance(0.5);
    let lifted = draft.random.chance(0.08);
    draft.equilibrium = Some(!lifted);
    let even = draft.random.chance(0.5);
    let weight = draft.weight(height) - draft.load * 1e-2;
    let all: Vec<Vec<Brick>> = (0..courses).map(|c| course(c, length)).collect();
    for brick in all.iter().flatten() {
        let x = brick.halves.map(|h| h as f64 * width);
        let y = [0, 1].map(|k| (brick.course + k) as f64 * height);
        let n = [n[0] * (brick.halves[1] - brick.halves[0]), n[1]];
        let n = n.map(|n| draft.facing(n));
        let aside = match ends && draft.random.chance(0.5) {
            true => draft.load * 0.3 * draft.random.signed(),
            false => 0.0,
        };
        draft.block(&brick.name(), rectangle(x, y), n, [aside, weight]);
    }
    for (c, bricks) in all.iter().enumerate() {
        for (i, brick) in bricks.iter().enumerate() {
            let mut gap = |axis: &str| match even {
                true => "0".to_owned(),
                false => draft.drawn_gap(axis),
            };
            let (bed, head) = (gap("x"), gap("y"));
            let bottom = [brick.side("bottom")];
            if c == 0 {
                draft.obstacle(&bottom, &wall(0.0, 0.0, [0, 1]), Some(&bed));
            } else {
                let below: Vec<String> = (all[c - 1].iter())
                    .filter(|b| b.halves[0] < brick.halves[1] && brick.halves[0] < b.halves[1])
                    .map(|b| b.side("top"))
                    .collect();
                draft.contact(&bottom, &below, Some(&bed));
            }
            if head_joints && i + 1 < bricks.len() {
                let right = [bricks[i + 1].side("left")];
                draft.contact(&[brick.side("right")], &right, Some(&head));
            }
            if ends && i == 0 {
                draft.obstacle(&[brick.side("left")], &wall(0.0, 0.0, [1, 0]), Some("0"));
            }
            if ends && i + 1 == bricks.len() {
                let at = length as f64 * width;
                draft.obstacle(&[brick.side("right")], &wall(at, 0.0, [-1, 0]), Some("0"));
            }
        }
    }
    for brick in &all[courses - 1] {
        match lifted {
            // A load above the weight of the whole wall.
            true => {
                let pull = draft.load * 20.0 * (1.0 + height) * courses as f64;
                draft.traction(&brick.side("top"), ["0", &format!("{pull:e}")]);
            }
            false => {
                let pressure = draft.drawn_pressure("x", brick.halves.map(|h| h as f64 * width));
                draft.pressure(&brick.side("top"), &pressure);
            }
        }
    }
}

fn course(course: usize, length: usize) -> Vec<Brick> {
    let mut cuts: Vec<usize> = (0..=length)
        .filter(|half| (half + course).is_multiple_of(2))
        .chain([0, length])
        .collect();
    cuts.sort_unstable();
    cuts.dedup();
    (cuts.windows(2))
        .map(|ends| Brick {
            course,
            halves: [ends[0], ends[1]],
        })
        .collect()
}
