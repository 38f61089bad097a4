//! What the nodes of the tree cost: their fronts, and estimates of flops and time.

use super::tree::Tree;
use crate::flops::{Front, condensation};
use crate::problem::Catalog;

/// Active sets that it takes, about.
pub const ACTIVE_SETS: f64 = 8.0;
/// Flops that the dense contact problem takes, over the cube of its size: it is condensed some nine times onto what touches.
const AT_ONCE: f64 = 3.0;
/// Contact conditions up to which they are solved for at once, whatever that takes: that is more robust where bodies
/// are held by next to nothing.
const FEW_CONDITIONS: usize = 600;
/// Contact conditions with friction up to which they are solved for at once: active sets that come back find a way
/// out there alone.
const FEW_WITH_FRICTION: usize = 3000;

impl Tree {
    /// The unknowns that node v eliminates and keeps, of a subdomain `dim` at each of its nodes.
    pub fn front(&self, v: usize, dim: usize) -> Front {
        let node = &self.nodes[v];
        let [eliminated, kept] = node.dofs;
        let kept = kept + node.conditions;
        let eliminated = match v < self.subdomains {
            true => (dim * node.of_subdomain).saturating_sub(kept),
            false => eliminated.saturating_sub(self.own_conditions(v)),
        };
        Front { eliminated, kept }
    }

    /// The front of node v where every active set is fixed, so that no jump of what is under the node is kept.
    pub fn frozen_front(&self, v: usize, dim: usize) -> Front {
        let (front, node) = (self.front(v, dim), &self.nodes[v]);
        Front {
            eliminated: front.eliminated,
            kept: front.kept - node.conditions + node.points.len(),
        }
    }

    /// The front of node v, which keeps all normal jumps under it unless active sets are frozen.
    pub fn front_of(&self, v: usize, dim: usize, is_frozen: bool) -> Front {
        let (front, node) = (self.front(v, dim), &self.nodes[v]);
        match is_frozen {
            true => Front {
                eliminated: front.eliminated,
                kept: front.kept - node.conditions + self.own_conditions(v),
            },
            false => front,
        }
    }

    /// Estimated time of node v, in flops: its arithmetic, and what goes with it; over all active sets where these are
    /// frozen.
    pub fn time(&self, v: usize, dim: usize, is_frozen: bool) -> f64 {
        let front = self.front_of(v, dim, is_frozen);
        match v < self.subdomains {
            true => front.time_to_condense(dim),
            false if is_frozen && self.nodes[v].conditions > 0 => ACTIVE_SETS * front.time(),
            false => front.time(),
        }
    }

    /// Estimated flops of condensing a subdomain, or of merging what lies under an inner node.
    pub fn flops(&self, v: usize, dim: usize) -> f64 {
        let front = self.front(v, dim);
        match v < self.subdomains {
            true => condensation(front.eliminated as f64, front.kept as f64, dim),
            false => front.flops(),
        }
    }

    /// Whether it takes fewer flops to eliminate what is above contacts for one active set after the other than to
    /// keep all normal jumps and solve for them at once.
    pub fn freezing_pays(&self, catalog: &Catalog) -> bool {
        let dim = catalog.dim;
        let few = match catalog.has_friction() {
            true => FEW_WITH_FRICTION,
            false => FEW_CONDITIONS,
        };
        let inner = self.subdomains..self.nodes.len();
        let above = inner.filter(|&v| self.nodes[v].conditions > 0);
        let frozen = above.clone().map(|v| self.frozen_front(v, dim).flops());
        let kept = above.map(|v| self.front(v, dim).flops());
        let roots = self.nodes.iter().filter(|node| node.parent.is_none());
        let cubed = roots.clone().map(|root| (root.conditions as f64).powi(3));
        let at_once = AT_ONCE * cubed.sum::<f64>();
        let conditions: usize = roots.map(|root| root.conditions).sum();
        conditions > few && ACTIVE_SETS * frozen.sum::<f64>() < kept.sum::<f64>() + at_once
    }
}
