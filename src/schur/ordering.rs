//! Fill-reducing elimination orders.

use super::children::{Children, NO_PARENT};
use super::dissection::{Graph, dissect};
use super::pattern::Cliques;

/// The elimination order of sites at `points` connected by `cliques`: nested dissection, postordered so that the factor
/// has supernodes of consecutive columns.
///
/// Returns the sites in that order.
pub fn nested_dissection(points: &[[f64; 3]], cliques: &Cliques) -> Vec<u32> {
    let graph = Graph::new(points.len(), cliques);
    let order = dissect(&graph, points);
    let parents = elimination_tree(&graph, &order);
    postorder(&parents)
        .into_iter()
        .map(|j| order[j as usize])
        .collect()
}

/// Liu's elimination tree of a graph for this `order`, with path compression.
fn elimination_tree(graph: &Graph, order: &[u32]) -> Vec<u32> {
    let mut place = vec![0; order.len()];
    for (k, &site) in order.iter().enumerate() {
        place[site as usize] = k as u32;
    }
    let mut parents = vec![NO_PARENT; order.len()];
    let mut ancestors = vec![NO_PARENT; order.len()];
    for (k, &site) in order.iter().enumerate() {
        let k = k as u32;
        let earlier = graph.of(site).iter().map(|&i| place[i as usize]);
        for mut i in earlier.filter(|&i| i < k) {
            while i != NO_PARENT && i != k {
                let next = std::mem::replace(&mut ancestors[i as usize], k);
                if next == NO_PARENT {
                    parents[i as usize] = k;
                }
                i = next;
            }
        }
    }
    parents
}

/// The postorder of a tree: children before parents, subtrees together.
fn postorder(parents: &[u32]) -> Vec<u32> {
    let n = parents.len();
    let mut children = Children::new(parents);
    let mut order = Vec::with_capacity(n);
    let mut stack = Vec::new();
    for root in (0..n).filter(|&j| parents[j] == NO_PARENT) {
        stack.push(root);
        while let Some(&j) = stack.last() {
            match children.take(j) {
                Some(child) => stack.push(child),
                None => {
                    order.push(j as u32);
                    stack.pop();
                }
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tree_of_a_path_that_is_eliminated_from_its_ends() {
        let mut cliques = Cliques::default();
        for i in 0..4 {
            cliques.push([i, i + 1]);
        }
        let parents = elimination_tree(&Graph::new(5, &cliques), &[0, 4, 1, 3, 2]);
        assert_eq!(parents, [2, 3, 4, 4, NO_PARENT]);
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
        assert!(nested_dissection(&[], &Cliques::default()).is_empty());
    }
}
