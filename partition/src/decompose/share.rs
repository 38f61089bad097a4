//! How many subdomains each region gets.

use super::graph::Graph;

/// Shares `count` subdomains out among regions: one each, then enough to give every contact patch its
/// own, then always one more to the region whose subdomains are the largest.
///
/// `count` is at least the number of regions and at most the number of vertices.
pub(super) fn share(regions: &[Graph], count: usize) -> Vec<usize> {
    let sizes: Vec<u64> = regions.iter().map(Graph::size).collect();
    let contact_patches: Vec<usize> = regions.iter().map(Graph::contact_patches).collect();
    let mut shares = vec![1; regions.len()];
    for _ in regions.len()..count {
        let contact_first = (0..regions.len()).any(|i| shares[i] < contact_patches[i]);
        let next = (0..regions.len())
            .filter(|&i| shares[i] < regions[i].len())
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
