//! How many subdomains each piece gets.

use super::graph::Graph;

/// Shares `count` subdomains out among pieces: one each, then enough to give every cluster its
/// own, then always one more to the piece whose subdomains are the largest.
///
/// `count` is at least the number of pieces and at most the number of atoms.
pub(super) fn share(pieces: &[&Graph], count: usize) -> Vec<usize> {
    let mut shares = vec![1; pieces.len()];
    let mut left = count - pieces.len();
    while left > 0 {
        let wanting =
            |(piece, share): (&&Graph, &usize)| *share < piece.clusters().min(piece.len());
        let contact_first = pieces.iter().zip(&shares).any(wanting);
        let next = (0..pieces.len())
            .filter(|&i| shares[i] < pieces[i].len())
            .filter(|&i| !contact_first || shares[i] < pieces[i].clusters())
            .max_by(|&i, &j| {
                // Sizes per share, compared without division; of equals the first.
                let (a, b) = (pieces[i].size(), pieces[j].size());
                (a * shares[j] as u64)
                    .cmp(&(b * shares[i] as u64))
                    .then(j.cmp(&i))
            });
        let Some(next) = next else { break };
        shares[next] += 1;
        left -= 1;
    }
    shares
}
