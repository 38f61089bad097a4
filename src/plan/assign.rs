//! Owners: distribution of the subtrees of the hierarchy over ranks by estimated cost.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use contact_dd_partition::hierarchy::tree::Tree;
use contact_dd_partition::id::TreeNodeId;
use contact_dd_partition::numbered::Numbered;

/// Most splits for every rank.
const SPLITS: usize = 8;

/// Most distributions tried.
const TRIALS: usize = 512;

/// Ratio of the estimated times after and before a further split above which it isn't worth it.
const GAIN: f64 = 0.97;

/// Estimated time of every node (flops).
type Costs = Numbered<TreeNodeId, f64>;

/// A distribution of the tree.
struct Share {
    owner: Numbered<TreeNodeId, usize>,
    /// Estimated time until all clusters are condensed.
    end: f64,
}

/// The owner of every node of `tree`, where `costs` are those of each node alone; `clusters` are the nodes above which
/// nothing is merged.
///
/// Each rank gets whole subtrees as far as the load stays balanced. The largest ones are split first, and the nodes
/// above a split go to the owner of its most expensive part. Among nearly equal distributions, ranks get clusters that
/// are adjacent in the hierarchy.
pub(super) fn assign(
    tree: &Tree,
    clusters: &[TreeNodeId],
    costs: &Costs,
    ranks: usize,
) -> Numbered<TreeNodeId, usize> {
    let of_subtree = tree.sums(costs);
    let distribution = |tasks: &[TreeNodeId]| {
        share(
            tree,
            by_cost(tasks, &of_subtree, ranks),
            costs,
            &of_subtree,
            ranks,
        )
    };
    let costlier_first =
        |&a: &TreeNodeId, &b: &TreeNodeId| of_subtree[b].total_cmp(&of_subtree[a]).then(a.cmp(&b));
    let mut tasks = clusters.to_vec();
    tasks.sort_by(costlier_first);
    let mut best = distribution(&tasks);
    let splits = if ranks > 1 { SPLITS * ranks } else { 0 };
    // With many ranks a single split changes little.
    let at_a_time = splits.div_ceil(TRIALS).max(1);
    for split in 1..=splits {
        let Some(costliest) = (tasks.iter()).position(|&v| !tree.nodes[v].children.is_empty())
        else {
            break;
        };
        let node = tasks.remove(costliest);
        for &child in &tree.nodes[node].children {
            let at = tasks.partition_point(|task| costlier_first(task, &child).is_lt());
            tasks.insert(at, child);
        }
        if split % at_a_time == 0 {
            let next = distribution(&tasks);
            if next.end < GAIN * best.end {
                best = next;
            }
        }
    }
    let row = in_a_row(tree, clusters, &of_subtree, ranks);
    let neighbours = share(tree, row, costs, &of_subtree, ranks);
    match GAIN * neighbours.end <= best.end {
        true => neighbours.owner,
        false => best.owner,
    }
}

/// The owners of `tasks`, which are subtrees, the most expensive first: each goes to the rank with the smallest load.
fn by_cost(tasks: &[TreeNodeId], of_subtree: &Costs, ranks: usize) -> Vec<(TreeNodeId, usize)> {
    let mut loads: BinaryHeap<Reverse<Load>> = (0..ranks)
        .map(|rank| Reverse(Load { busy: 0.0, rank }))
        .collect();
    let mut owners = Vec::with_capacity(tasks.len());
    for &task in tasks {
        let Some(mut least) = loads.peek_mut() else {
            break;
        };
        owners.push((task, least.0.rank));
        least.0.busy += of_subtree[task];
    }
    owners
}

/// The load of a rank.
#[derive(Clone, Copy, PartialEq)]
struct Load {
    busy: f64,
    rank: usize,
}

impl Eq for Load {}

impl Ord for Load {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_time = self.busy.total_cmp(&other.busy);
        by_time.then(self.rank.cmp(&other.rank))
    }
}

impl PartialOrd for Load {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The owners of `tasks` if each rank gets adjacent ones in the hierarchy, so that the nodes above are distributed as
/// well.
fn in_a_row(
    tree: &Tree,
    tasks: &[TreeNodeId],
    of_subtree: &Costs,
    ranks: usize,
) -> Vec<(TreeNodeId, usize)> {
    let mut is_task = tree.nodes.like(false);
    tasks.iter().for_each(|&task| is_task[task] = true);
    let all = tree.roots().flat_map(|root| tree.subtree(root));
    let row: Vec<TreeNodeId> = all.filter(|&v| is_task[v]).collect();
    let total: f64 = row.iter().map(|&task| of_subtree[task]).sum();
    let mut before = 0.0;
    let owner = |task: TreeNodeId| {
        let middle = before + 0.5 * of_subtree[task];
        before += of_subtree[task];
        let share = ranks as f64 * middle / total.max(f64::MIN_POSITIVE);
        (task, (share as usize).min(ranks - 1))
    };
    row.into_iter().map(owner).collect()
}

/// The distribution in which subtrees, the tasks, have these `owners`.
fn share(
    tree: &Tree,
    owners: Vec<(TreeNodeId, usize)>,
    costs: &Costs,
    of_subtree: &Costs,
    ranks: usize,
) -> Share {
    const NO_OWNER: usize = usize::MAX;
    let mut owner = tree.nodes.like(NO_OWNER);
    let mut busy = vec![0.0f64; ranks];
    for (task, rank) in owners {
        busy[rank] += of_subtree[task];
        owner[task] = rank;
    }
    let mut done: Costs = (owner.iter())
        .map(|&owner| if owner == NO_OWNER { 0.0 } else { busy[owner] })
        .collect();
    let mut end = done.iter().copied().fold(0.0, f64::max);
    for (v, node) in tree.nodes.each() {
        let above_tasks = owner[v] == NO_OWNER
            && !node.children.is_empty()
            && node.children.iter().all(|&child| owner[child] != NO_OWNER);
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
    // Nodes below a task belong to its owner.
    for v in tree.nodes.ids().rev() {
        if owner[v] == NO_OWNER {
            owner[v] = tree.nodes[v].parent.map_or(0, |parent| owner[parent]);
        }
    }
    Share { owner, end }
}
