//! A wall of bricks in running bond, every joint of which is a contact, on ground that has sunk under its middle.
//!
//! No two bricks share a node. A course of five bricks alternates with one of four between two halves.

use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};
use super::{Example, Shape};

pub(super) const EXAMPLE: Example = Example {
    name: "wall",
    about: "a wall of 33 bricks on ground that sank, every joint a contact",
    subdomains: 33,
    scene: include_str!("scene.toml"),
    shape: Shape::Squares(squares),
};

/// Length and height of a brick (m).
const LENGTH: f64 = 0.25;
const HEIGHT: f64 = 0.125;

/// Bricks in the length of the wall.
const ALONG: usize = 5;

/// Cells in the height of a brick, and in half its length.
const CELLS: usize = 4;

/// The bricks of each course, from below and from the left.
const COURSES: [&[&str]; 6] = [
    &[
        "brick 1.1",
        "brick 1.2",
        "brick 1.3",
        "brick 1.4",
        "brick 1.5",
    ],
    &[
        "brick 2.1",
        "brick 2.2",
        "brick 2.3",
        "brick 2.4",
        "brick 2.5",
        "brick 2.6",
    ],
    &[
        "brick 3.1",
        "brick 3.2",
        "brick 3.3",
        "brick 3.4",
        "brick 3.5",
    ],
    &[
        "brick 4.1",
        "brick 4.2",
        "brick 4.3",
        "brick 4.4",
        "brick 4.5",
        "brick 4.6",
    ],
    &[
        "brick 5.1",
        "brick 5.2",
        "brick 5.3",
        "brick 5.4",
        "brick 5.5",
    ],
    &[
        "brick 6.1",
        "brick 6.2",
        "brick 6.3",
        "brick 6.4",
        "brick 6.5",
        "brick 6.6",
    ],
];

/// The joints between courses: their sides below and above.
const BEDS: [[&str; 2]; 5] = [
    ["bed joint 1 below", "bed joint 1 above"],
    ["bed joint 2 below", "bed joint 2 above"],
    ["bed joint 3 below", "bed joint 3 above"],
    ["bed joint 4 below", "bed joint 4 above"],
    ["bed joint 5 below", "bed joint 5 above"],
];

/// The joints in each course: their sides on the left and on the right.
const HEADS: [[&str; 2]; 6] = [
    ["head joints 1 left", "head joints 1 right"],
    ["head joints 2 left", "head joints 2 right"],
    ["head joints 3 left", "head joints 3 right"],
    ["head joints 4 left", "head joints 4 right"],
    ["head joints 5 left", "head joints 5 right"],
    ["head joints 6 left", "head joints 6 right"],
];

fn squares() -> Vec<Square> {
    let mut squares = Vec::new();
    for (course, bricks) in COURSES.into_iter().enumerate() {
        let below = match course {
            0 => "foot",
            _ => BEDS[course - 1][1],
        };
        let above = BEDS.get(course).map_or("top", |sides| sides[0]);
        // Ends of bricks in halves of a brick.
        let staggered = course % 2;
        let ends = |brick: usize| (2 * brick - staggered.min(brick)).min(2 * ALONG);
        for (i, body) in bricks.iter().enumerate() {
            let (start, end) = (ends(i), ends(i + 1));
            let is_last = i + 1 == bricks.len();
            let left = if i == 0 { "left end" } else { HEADS[course][1] };
            let right = if is_last {
                "right end"
            } else {
                HEADS[course][0]
            };
            let [x_0, x_1] = [start, end].map(|halves| 0.5 * LENGTH * halves as f64);
            let [y_0, y_1] = [course, course + 1].map(|rows| HEIGHT * rows as f64);
            squares.push(Square {
                body,
                map: quadrilateral([[x_0, y_0], [x_1, y_0], [x_1, y_1], [x_0, y_1]]),
                pattern: Pattern::Grid(CELLS * (end - start), CELLS),
                is_curved: false,
                sides: [Some(below), Some(right), Some(above), Some(left)],
            });
        }
    }
    squares
}
