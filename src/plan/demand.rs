//! What a run will cost: memory and arithmetic of every rank, before either is spent.
//!
//! The constants are measured: on 45 peaks of 1 and 2 ranks, from 20 thousand to 2 million dofs, in 8
//! to 1000 subdomains, with up to 5000 contact conditions, the estimate is within a quarter of each.

use contact_dd_partition::flops::condensation;
use contact_dd_partition::problem::Catalog;

use super::Plan;
use super::size::Size;

/// What a program needs that does nothing yet (bytes).
const AT_REST: f64 = 2.8e7;
/// A block of n dofs, by nested dissection n log n, in bytes: its factor and its mesh.
const PER_DOF: f64 = 50.0;
/// That of other cells over that of triangles of three nodes: a constant, and for each node by cell.
const PER_NODE_OF_CELL: [f64; 2] = [0.82, 0.4];
/// The part of a block's factor that its boundary adds, by its size times √n (bytes).
const PER_BOUNDARY: f64 = 165.0;
/// An entry of the largest matrix that blocks are merged in (bytes): it and its children.
const PER_ENTRY: f64 = 16.0;
/// An entry of the contact problem of all pairs, at the root (bytes).
const PER_PAIR_OF_CONDITIONS: f64 = 33.0;

/// What a rank needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Memory at its peak (bytes).
    pub bytes: f64,
    /// Arithmetic of its factorizations (flops).
    pub flops: f64,
}

/// What a run needs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demands {
    /// On all ranks together.
    pub all: Demand,
    /// On the rank that needs most memory, and on the one that needs most arithmetic.
    pub most: Demand,
}

impl Demands {
    /// Of ranks that need these.
    pub fn of(ranks: &[Demand]) -> Self {
        let of = |part: fn(&Demand) -> f64| ranks.iter().map(part);
        let (bytes, flops) = (of(|demand| demand.bytes), of(|demand| demand.flops));
        Self {
            all: Demand {
                bytes: bytes.clone().sum(),
                flops: flops.clone().sum(),
            },
            most: Demand {
                bytes: bytes.fold(0.0, f64::max),
                flops: flops.fold(0.0, f64::max),
            },
        }
    }
}

impl Plan {
    /// What every one of `ranks` ranks needs.
    pub fn demands(&self, catalog: &Catalog, ranks: usize) -> Vec<Demand> {
        let mut demands = vec![Demand::default(); ranks];
        let mut largest = vec![0.0f64; ranks];
        for (v, &owner) in self.node_owners.iter().enumerate() {
            let demand = &mut demands[owner];
            match self.size(catalog, v) {
                Size::Block {
                    nodes,
                    cells,
                    interior,
                    kept,
                } => {
                    let (n, kept) = (interior.max(1) as f64, kept as f64);
                    let [least, more] = PER_NODE_OF_CELL;
                    let of_kind = least + more * nodes as f64 / cells.max(1) as f64;
                    demand.bytes +=
                        PER_DOF * of_kind * n * n.log2() + PER_BOUNDARY * kept * n.sqrt();
                    demand.flops += condensation(n, kept);
                }
                Size::Merge(front) => {
                    let size = (front.eliminated + front.kept) as f64;
                    largest[owner] = largest[owner].max(size);
                    demand.flops += front.flops();
                }
            }
        }
        for (demand, largest) in demands.iter_mut().zip(largest) {
            demand.bytes += AT_REST + PER_ENTRY * largest * largest;
        }
        if let Some(root) = demands.first_mut() {
            root.bytes += PER_PAIR_OF_CONDITIONS * (catalog.conditions() as f64).powi(2);
        }
        demands
    }
}
