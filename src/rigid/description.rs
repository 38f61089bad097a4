//! Rigid motions in words.

use std::collections::BTreeSet;

use super::analysis::BodyState;
use super::free_motion::FreeMotion;
use super::kinematics::Kinematics;

/// Motions up to which each is described: more are any basis of what bodies can do together.
const MOTIONS: usize = 3;
/// Bodies up to which all are named.
const BODIES: usize = 6;
/// Part of a motion that isn't worth a word.
const NO_PART: f64 = 1e-6;

impl Kinematics {
    /// What moves in `motions`, a clause for each warning.
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
                let how = own.map(|(_, z)| bodies[b].frame.describe(self.dim, z));
                format!("'{}' ({})", names[b], how.unwrap_or_default())
            };
            listed(taking_part(motion).map(of_body).collect())
        };
        motions.iter().map(one).collect()
    }
}

fn taking_part(motion: &FreeMotion) -> impl Iterator<Item = usize> + '_ {
    let moves = |z: &[f64]| z.iter().any(|z| z.abs() > NO_PART);
    (motion.bodies.iter()).filter_map(move |(b, z)| moves(z).then_some(*b))
}

/// The first of many names, and how many there are besides.
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
    use crate::rigid::motion::BodyFrame;

    /// `n` squares in a row, and one free motion of each, along x.
    fn described(n: usize, motions: Vec<FreeMotion>) -> Vec<String> {
        let state = |b: usize| BodyState {
            frame: BodyFrame::new([b as f64, 0.0, 0.0], [b as f64 + 1.0, 1.0, 0.0]),
            supports: Vec::new(),
            load: vec![0.0; 3],
            load_scale: 0.0,
            candidates: Vec::new(),
        };
        let bodies: Vec<BodyState> = (0..n).map(state).collect();
        let names: Vec<String> = (0..n).map(|b| format!("brick {b}")).collect();
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
    fn many_motions_are_one_clause_with_the_first_of_their_bodies() {
        let words = described(9, (0..9).map(|b| along_x(b..b + 1)).collect());
        let expected = "9 rigid motions of 'brick 0', 'brick 1', 'brick 2', 'brick 3', 'brick 4', \
                        'brick 5' and 3 more bodies";
        assert_eq!(words, [expected]);
    }
}
