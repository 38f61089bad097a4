//! Fill-reducing elimination orders.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use super::pattern::{Cliques, LowerPattern};

/// The order in which `n` sites that are connected by `cliques` are eliminated: approximate
/// minimum degree, postordered so that the factor falls into supernodes.
///
/// Returns site by site what comes first; `None` where the graph is too large for 32-bit indices.
pub fn minimum_degree(n: usize, cliques: &Cliques) -> Option<Vec<u32>> {
    let pattern = LowerPattern::new(n, cliques)?;
    let (columns, rows) = pattern.upper();
    let graph = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &rows);
    let mut order = vec![0u32; n];
    let mut place = vec![0u32; n];
    let mut memory = MemBuffer::try_new(amd::order_scratch::<u32>(n, rows.len())).ok()?;
    amd::order(
        &mut order,
        &mut place,
        graph,
        amd::Control::default(),
        MemStack::new(&mut memory),
    )
    .ok()?;
    let parents = elimination_tree(&pattern, &order, &place);
    Some(
        postorder(&parents)
            .into_iter()
            .map(|j| order[j as usize])
            .collect(),
    )
}

const NO_PARENT: u32 = u32::MAX;

/// Liu's elimination tree of the permuted graph, by path compression.
fn elimination_tree(pattern: &LowerPattern, order: &[u32], place: &[u32]) -> Vec<u32> {
    let n = pattern.n();
    let mut earlier: Vec<Vec<u32>> = vec![Vec::new(); n];
    for j in 0..n {
        for &i in &pattern.rows_of(j)[1..] {
            let (a, b) = (place[i as usize], place[j]);
            earlier[a.max(b) as usize].push(a.min(b));
        }
    }
    debug_assert_eq!(order.len(), n);
    let mut parents = vec![NO_PARENT; n];
    let mut ancestors = vec![NO_PARENT; n];
    for (k, list) in earlier.iter().enumerate() {
        for &start in list {
            let mut i = start;
            while i != NO_PARENT && i != k as u32 {
                let next = ancestors[i as usize];
                ancestors[i as usize] = k as u32;
                if next == NO_PARENT {
                    parents[i as usize] = k as u32;
                }
                i = next;
            }
        }
    }
    parents
}

/// Children before parents, subtrees together.
fn postorder(parents: &[u32]) -> Vec<u32> {
    let n = parents.len();
    let mut first_child = vec![NO_PARENT; n];
    let mut next_sibling = vec![NO_PARENT; n];
    for j in (0..n).rev() {
        if parents[j] != NO_PARENT {
            next_sibling[j] = first_child[parents[j] as usize];
            first_child[parents[j] as usize] = j as u32;
        }
    }
    let mut order = Vec::with_capacity(n);
    let mut stack = Vec::new();
    for root in (0..n as u32).filter(|&j| parents[j as usize] == NO_PARENT) {
        stack.push(root);
        while let Some(&j) = stack.last() {
            let child = first_child[j as usize];
            if child == NO_PARENT {
                order.push(j);
                stack.pop();
            } else {
                first_child[j as usize] = next_sibling[child as usize];
                stack.push(child);
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(n: usize) -> Cliques {
        let mut cliques = Cliques::default();
        for i in 0..n as u32 - 1 {
            cliques.push([i, i + 1]);
        }
        cliques
    }

    #[test]
    fn an_order_holds_every_site_once() {
        let mut order = minimum_degree(50, &path(50)).unwrap();
        order.sort_unstable();
        assert_eq!(order, (0..50).collect::<Vec<u32>>());
    }

    #[test]
    fn children_come_directly_before_their_parent() {
        // A parent's subtree is contiguous in a postorder.
        let parents = [4, 3, 3, 4, NO_PARENT, NO_PARENT];
        assert_eq!(postorder(&parents), vec![0, 1, 2, 3, 4, 5]);
        let shuffled = [2, NO_PARENT, 1, 2, 1];
        let order = postorder(&shuffled);
        assert_eq!(order.last(), Some(&1));
        let place = |j: u32| order.iter().position(|&k| k == j).unwrap();
        assert_eq!(place(2), 2);
    }

    #[test]
    fn an_empty_graph_has_an_empty_order() {
        assert_eq!(minimum_degree(0, &Cliques::default()), Some(vec![]));
    }
}
