//! Decomposition into subdomains: recursive bisection of the mesh, in which contact surfaces are cut like facets.

mod aggregates;
mod bisect;
mod build;
mod dissect;
mod flow;
mod graph;
mod metis;
pub mod summary;
mod ties;

use self::dissect::{Wanted, dissect};
use self::graph::Graph;
use crate::error::InputError;
use crate::model::Model;
use crate::problem::Hierarchy;

/// Average number of dofs of a subdomain where the user gives no number of subdomains: many small subdomains, merged
/// along the hierarchy, take less time than few large ones.
const DOFS: f64 = 2_000.0;

/// A partition of the cells into subdomains, and the tree of cuts that produced it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Decomposition {
    /// Number of subdomains.
    pub count: usize,
    /// The subdomain of every cell.
    pub subdomain: Vec<u32>,
    /// The tree along which Schur complements are merged: an inner node for every cut.
    pub hierarchy: Hierarchy,
}

impl Decomposition {
    /// Splits `model` into exactly `count` subdomains, or by default into a number that suits its size.
    ///
    /// Every subdomain is connected across facets; contact surfaces are cut like everything else. Subdomains are
    /// numbered depth first along the tree. Equal models give equal partitions. A partition prescribed by the scene is
    /// kept, and only gets a tree.
    ///
    /// # Errors
    /// An impossible count, with the range of possible ones; a mesh without cells.
    pub fn new(model: &Model, count: Option<usize>) -> Result<Self, InputError> {
        if model.mesh.cells.is_empty() {
            return Err(InputError::new("the mesh has no cells"));
        }
        if let Some(subdomain) = &model.prescribed_subdomains {
            let found = subdomain.iter().max().map_or(0, |&s| s as usize + 1);
            return match count {
                Some(count) if count != found => Err(InputError::new(format!(
                    "{count} subdomains were asked for, but the partition that the scene prescribes has {found}; expected {found}, or no number"
                ))),
                _ => Ok(Self::of_cells(model, subdomain.clone(), found)),
            };
        }
        let graph = Graph::new(model);
        let wanted = match count {
            // Recursive bisection ends with sets between half of this size and this size.
            None => Wanted::Dofs(std::f64::consts::SQRT_2 * DOFS),
            Some(count) => {
                let (least, most) = (graph.pieces().1, graph.len());
                if !(least..=most).contains(&count) {
                    return Err(InputError::new(format!(
                        "{count} subdomains can't be; expected {least} (the separate pieces of the mesh) to {most} (the cells)"
                    )));
                }
                Wanted::Sets(count)
            }
        };
        let branch = dissect(graph, wanted);
        let mut subdomain = vec![0; model.mesh.cells.len()];
        let mut numbers = 0..;
        let hierarchy = branch.hierarchy(|cells| {
            let number = numbers.next().unwrap_or_default();
            for &cell in cells {
                subdomain[cell as usize] = number;
            }
            number
        });
        Ok(Self {
            count: branch.leaves(),
            subdomain,
            hierarchy,
        })
    }

    /// The partition given by the subdomain, one of `count`, of every cell.
    pub fn of_cells(model: &Model, subdomain: Vec<u32>, count: usize) -> Self {
        let cells = Graph::new(model);
        let graph = cells.contracted(&subdomain, count);
        let branch = dissect(graph, Wanted::Dofs(0.0));
        Self {
            count,
            subdomain,
            hierarchy: branch.hierarchy(|subdomains| subdomains[0]),
        }
    }
}
