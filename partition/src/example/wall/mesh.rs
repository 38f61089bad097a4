//! A wall of bricks in running bond, with a contact in every joint, on ground that has subsided under its middle.
//!
//! No two bricks share a node. A course of five bricks alternates with one of four bricks between two halves.

use super::Shape;
use super::pattern::Pattern;
use super::squares::{Square, quadrilateral};

pub(super) const ABOUT: &str = "a wall of 33 bricks on ground that sank, every joint a contact";
pub(super) const SUBDOMAINS: usize = 33;
pub(super) const SHAPE: Shape = Shape::Squares(squares);

/// Length and height of a brick (m).
const LENGTH: f64 = 0.25;
const HEIGHT: f64 = 0.125;

/// Bricks in the length of the wall.
const ALONG: usize = 5;

/// Cells in the height of a brick, and in half its length.
const CELLS: usize = 4;

/// Courses; every other one has an additional brick, with halves at both ends.
const COURSES: usize = 6;

fn squares() -> Vec<Square> {
    let mut squares = Vec::new();
    for course in 0..COURSES {
        let below = match course {
            0 => "foot".to_owned(),
            _ => format!("bed joint {course} above"),
        };
        let above = match course + 1 {
            COURSES => "top".to_owned(),
            next => format!("bed joint {next} below"),
        };
        // Ends of bricks, in units of half a brick.
        let staggered = course % 2;
        let ends = |brick: usize| (2 * brick - staggered.min(brick)).min(2 * ALONG);
        let bricks = ALONG + staggered;
        for brick in 0..bricks {
            let (start, end) = (ends(brick), ends(brick + 1));
            let left = match brick {
                0 => "left end".to_owned(),
                _ => format!("head joints {} right", course + 1),
            };
            let right = match brick + 1 {
                last if last == bricks => "right end".to_owned(),
                _ => format!("head joints {} left", course + 1),
            };
            let [x_0, x_1] = [start, end].map(|halves| 0.5 * LENGTH * halves as f64);
            let [y_0, y_1] = [course, course + 1].map(|rows| HEIGHT * rows as f64);
            squares.push(Square::new(
                &format!("brick {}.{}", course + 1, brick + 1),
                Pattern::Grid(CELLS * (end - start), CELLS),
                quadrilateral([[x_0, y_0], [x_1, y_0], [x_1, y_1], [x_0, y_1]]),
                [&below, &right, &above, &left].map(|name| Some(name.as_str())),
            ));
        }
    }
    squares
}
