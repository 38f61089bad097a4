//! How many subdomains each unit gets.

use super::graph::Graph;

/// Shares `count` subdomains out among units: one each, then enough to give every contact patch its
/// own, then always one more to the unit whose subdomains are the largest.
///
/// `count` is at least the number of units and at most the number of atoms.
pub(super) fn share(units: &[Graph], count: usize) -> Vec<usize> {
    let sizes: Vec<u64> = units.iter().map(Graph::size).collect();
    let contact_patches: Vec<usize> = units.iter().map(Graph::contact_patches).collect();
    let mut shares = vec![1; units.len()];
    for _ in units.len()..count {
        let contact_first = (0..units.len()).any(|i| shares[i] < contact_patches[i]);
        let next = (0..units.len())
            .filter(|&i| shares[i] < units[i].len())
            .filter(|&i| !contact_first || shares[i] < contact_patches[i])
            .max_by(|&i, &j| {
                // Sizes per share, compared without division; of equals the first.
                (sizes[i] * shares[j] as u64)
                    .cmp(&(sizes[j] * shares[i] as u64))
                    .then(j.cmp(&i))
            });
        let Some(next) = next else { break };
        shares[next] += 1;
    }
    shares
}
