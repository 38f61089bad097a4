//! Who owns what: subtrees of the hierarchy are handed out by estimated cost.

use contact_dd_partition::problem::tree::Tree;

/// Splits that are tried, for every rank.
const SPLITS: usize = 8;

/// What a further split must gain.
const GAIN: f64 = 0.97;

/// A way to hand out the tree.
struct Share {
    owner: Vec<usize>,
    /// Estimated time until all clusters are condensed.
    end: f64,
}

/// The owner of every node of `tree`, where each node costs `costs` itself; `clusters` are the nodes
/// above which nothing is merged.
///
/// Each rank gets whole subtrees as far as that balances; the largest ones are split first, and
/// what is above a split goes to the owner of its most expensive part.
pub(super) fn assign(tree: &Tree, clusters: &[usize], costs: &[f64], ranks: usize) -> Vec<usize> {
    let of_subtree = tree.sums(costs);
    let mut tasks = clusters.to_vec();
    let mut best = share(tree, &tasks, costs, &of_subtree, ranks);
    for _ in 0..SPLITS * ranks {
        let dividable = (0..tasks.len()).filter(|&t| !tree.nodes[tasks[t]].children.is_empty());
        let costliest = dividable.max_by(|&a, &b| {
            let (a, b) = (tasks[a], tasks[b]);
            of_subtree[a].total_cmp(&of_subtree[b]).then(b.cmp(&a))
        });
        let Some(costliest) = costliest.filter(|_| ranks > 1) else {
            break;
        };
        let node = tasks.swap_remove(costliest);
        tasks.extend(&tree.nodes[node].children);
        tasks.sort_unstable();
        let next = share(tree, &tasks, costs, &of_subtree, ranks);
        if next.end < GAIN * best.end {
            best = next;
        }
    }
    best.owner
}

/// Hands out `tasks`, subtrees, the most expensive first, each to the rank that has least.
fn share(tree: &Tree, tasks: &[usize], costs: &[f64], of_subtree: &[f64], ranks: usize) -> Share {
    const NOBODY: usize = usize::MAX;
    let mut order = tasks.to_vec();
    order.sort_by(|&a, &b| of_subtree[b].total_cmp(&of_subtree[a]).then(a.cmp(&b)));
    let mut owner = vec![NOBODY; tree.nodes.len()];
    let mut busy = vec![0.0f64; ranks];
    for task in order {
        let mut least = 0;
        for rank in 1..ranks {
            if busy[rank] < busy[least] {
                least = rank;
            }
        }
        busy[least] += of_subtree[task];
        owner[task] = least;
    }
    let mut done: Vec<f64> = (owner.iter())
        .map(|&owner| if owner == NOBODY { 0.0 } else { busy[owner] })
        .collect();
    let mut end = done.iter().copied().fold(0.0, f64::max);
    for (v, node) in tree.nodes.iter().enumerate() {
        let above_tasks = owner[v] == NOBODY
            && !node.children.is_empty()
            && node.children.iter().all(|&child| owner[child] != NOBODY);
        if !above_tasks {
            continue;
        }
        let costliest = node
            .children
            .iter()
            .max_by(|&&a, &&b| of_subtree[a].total_cmp(&of_subtree[b]).then(b.cmp(&a)));
        let rank = costliest.map_or(0, |&child| owner[child]);
        let ready = node.children.iter().map(|&child| done[child]);
        done[v] = ready.fold(busy[rank], f64::max) + costs[v];
        busy[rank] = done[v];
        owner[v] = rank;
        end = end.max(done[v]);
    }
    // What lies under a task belongs to its owner.
    for v in (0..tree.nodes.len()).rev() {
        if owner[v] == NOBODY {
            owner[v] = tree.nodes[v].parent.map_or(0, |parent| owner[parent]);
        }
    }
    Share { owner, end }
}
