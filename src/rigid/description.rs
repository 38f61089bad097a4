//! Descriptions of rigid-body motions.

use std::collections::BTreeSet;

use faer::Mat;

use super::free_motion::FreeMotion;
use super::kinematics::Kinematics;
use super::scene::BodyState;
use crate::fem::body_frame::BodyFrame;

/// Number of motions up to which each is described; a larger set has no natural basis.
const MOTIONS: usize = 3;
/// Bodies up to which all are named.
const BODIES: usize = 6;
/// Part of a motion, relative to the whole, that is left out of its description.
const NO_PART: f64 = 1e-6;

impl Kinematics {
    /// Descriptions of the parts of the scene that move in `motions`, a clause for each warning.
    pub(super) fn described(
        &self,
        bodies: &[BodyState],
        names: &[String],
        motions: &[FreeMotion],
    ) -> Vec<String> {
        if motions.len() > MOTIONS {
            let parts: BTreeSet<usize> = motions.iter().flat_map(taking_part).collect();
            let quoted = parts.iter().map(|&b| format!("'{}'", names[b])).collect();
            return vec![format!(
                "{} rigid motions of {}",
                motions.len(),
                listed(quoted)
            )];
        }
        let one = |motion: &FreeMotion| {
            let of_body = |b: usize| {
                let own = motion.bodies.iter().find(|(body, _)| *body == b);
                let how = own.map(|(_, z)| bodies[b].describe(self.dim, z));
                format!("'{}' ({})", names[b], how.unwrap_or_default())
            };
            listed(taking_part(motion).map(of_body).collect())
        };
        simplest(motions, self.dim).iter().map(one).collect()
    }
}

/// A basis of the span of motions with as few rotations as possible and each of few bodies.
fn simplest(motions: &[FreeMotion], dim: usize) -> Vec<FreeMotion> {
    let bodies: BTreeSet<usize> = motions.iter().flat_map(taking_part).collect();
    let bodies: Vec<usize> = bodies.into_iter().collect();
    let rigid = BodyFrame::count(dim);
    let mut rows = Mat::<f64>::zeros(motions.len(), rigid * bodies.len());
    for (i, motion) in motions.iter().enumerate() {
        for (b, z) in &motion.bodies {
            if let Ok(place) = bodies.binary_search(b) {
                (z.iter().enumerate()).for_each(|(k, z)| rows[(i, rigid * place + k)] = *z);
            }
        }
    }
    // Rotations are eliminated first: the motions left without one are translations.
    let columns = (dim..rigid).chain(0..dim);
    let columns = columns.flat_map(|k| (0..bodies.len()).map(move |place| rigid * place + k));
    let (mut done, mut rotations) = (0, 0);
    for column in columns {
        let left = done..rows.nrows();
        let size = |i: usize| rows[(i, column)].abs();
        let Some(largest) = left.max_by(|&a, &b| size(a).total_cmp(&size(b))) else {
            break;
        };
        if size(largest) < NO_PART {
            continue;
        }
        for j in 0..rows.ncols() {
            let pivot = rows[(largest, j)];
            rows[(largest, j)] = rows[(done, j)];
            rows[(done, j)] = pivot;
        }
        let pivot = rows[(done, column)];
        (0..rows.ncols()).for_each(|j| rows[(done, j)] /= pivot);
        for i in (0..rows.nrows()).filter(|&i| i != done) {
            let factor = rows[(i, column)];
            for j in 0..rows.ncols() {
                let change = factor * rows[(done, j)];
                rows[(i, j)] -= change;
            }
        }
        done += 1;
        rotations += usize::from(column % rigid >= dim);
    }
    let motion = |i: usize| {
        let z = |place: usize| (0..rigid).map(|k| rows[(i, rigid * place + k)]).collect();
        let bodies = bodies.iter().enumerate();
        FreeMotion {
            bodies: bodies.map(|(place, &b)| (b, z(place))).collect(),
        }
    };
    (rotations..rows.nrows())
        .chain(0..rotations)
        .map(motion)
        .collect()
}

fn taking_part(motion: &FreeMotion) -> impl Iterator<Item = usize> + '_ {
    let moves = |z: &[f64]| z.iter().any(|z| z.abs() > NO_PART);
    (motion.bodies.iter()).filter_map(move |(b, z)| moves(z).then_some(*b))
}

/// The first of many names, and the number of the others.
fn listed(mut names: Vec<String>) -> String {
    let more = names.len().saturating_sub(BODIES);
    if more == 0 {
        return names.join(", ");
    }
    names.truncate(BODIES);
    format!("{} and {more} more bodies", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rigid::scene::Scene;
    use crate::rigid::squares::{body, scene};

    /// Descriptions for `n` squares in a row, each with one free motion along x.
    fn described(n: usize, motions: Vec<FreeMotion>) -> Vec<String> {
        let state = |b: f64| body([b, 0.0, 0.0], [b + 1.0, 1.0, 0.0], &[0.0; 3]);
        let bodies = (0..n).map(|b| state(b as f64)).collect();
        let Scene { bodies, names, .. } = scene(2, bodies, Vec::new());
        Kinematics::new(2, &bodies).described(&bodies, &names, &motions)
    }

    fn along_x(bodies: impl Iterator<Item = usize>) -> FreeMotion {
        FreeMotion {
            bodies: bodies.map(|b| (b, vec![1.0, 0.0, 0.0])).collect(),
        }
    }

    #[test]
    fn a_few_motions_are_described_each() {
        let words = described(2, vec![along_x(0..1), along_x(0..2)]);
        assert_eq!(words.len(), 2);
        assert_eq!(words[0], "'brick 0' (translation along (1.0000, 0.0000))");
        assert!(words[1].contains("'brick 1'"), "{}", words[1]);
    }

    #[test]
    fn what_slides_and_turns_is_told_in_the_simplest_motions() {
        let motion = |z: [f64; 3]| FreeMotion {
            bodies: vec![(1, z.to_vec())],
        };
        let words = described(2, vec![motion([0.6, 0.8, 0.4]), motion([0.8, -0.6, 0.8])]);
        let slides = "'brick 1' (translation along (0.1789, 0.9839))";
        let turns = "'brick 1' (rotation about (5.91942, 0.50000) m)";
        assert_eq!(words, [slides, turns]);
    }

    #[test]
    fn many_motions_are_one_clause_with_the_first_of_their_bodies() {
        let words = described(9, (0..9).map(|b| along_x(b..b + 1)).collect());
        let expected = "9 rigid motions of 'brick 0', 'brick 1', 'brick 2', 'brick 3', 'brick 4', \
                        'brick 5' and 3 more bodies";
        assert_eq!(words, [expected]);
    }
}
