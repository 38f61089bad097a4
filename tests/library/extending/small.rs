//! A scene so small that its solution is found by trying every set of closed contacts.

use std::rc::Rc;

use contact_dd_mpi::contact::jumps::JumpOf;
use contact_dd_mpi::contact::limits::Limits;
use contact_dd_mpi::contact::pair::{CondensedContact, ContactPair};
use contact_dd_mpi::interface::numbering::Numbering;
use contact_dd_mpi::interface::operator::{Contribution, Interface};
use contact_dd_mpi::interface::problem::ClusterLoad;
use contact_dd_mpi::schur::condensed::{Condensed, InterfaceDof};
use faer::{Mat, Par};
use nalgebra::{DMatrix, DVector};

use super::layer::Layer;
use crate::support::random::Random;

/// Normal jumps of a pair.
pub const APPROACHES: usize = 3;

/// A cluster, condensed by hand.
pub struct Cluster {
    /// Nodes of Γ.
    nodes: Vec<u32>,
    /// S on [t | U], both triangles.
    pub condensed: Condensed,
    /// The load on both.
    pub load: Vec<f64>,
    /// g of every normal jump.
    pub gaps: Vec<f64>,
    /// What the layer between the sides gives way.
    pub compliances: Vec<f64>,
}

/// What is found.
#[derive(Clone, Debug)]
pub struct Exact {
    /// t of all pairs, then U, its dofs ascending.
    pub x: Vec<f64>,
    /// λ of all pairs.
    pub forces: Vec<f64>,
}

impl Cluster {
    /// Any symmetric positive definite S on `normal jumps` and two traces of each node.
    fn random(random: &mut Random, nodes: &[u32], jumps: usize) -> Self {
        let n = jumps + 2 * nodes.len();
        let root = DMatrix::from_fn(n, n, |_, _| random.signed());
        let s = &root * root.transpose() + DMatrix::identity(n, n);
        Self {
            nodes: nodes.to_vec(),
            condensed: Condensed {
                jumps,
                interface_dofs: dofs(nodes),
                s: Mat::from_fn(n, n, |i, j| s[(i, j)]),
                diagonal: (0..n).map(|i| s[(i, i)]).collect(),
                smallest_pivot: 1.0,
            },
            load: (0..n).map(|_| 3.0 * random.signed()).collect(),
            gaps: (0..jumps).map(|_| 0.3 * random.signed()).collect(),
            compliances: vec![0.0; jumps],
        }
    }

    /// The pair that it is.
    pub fn pair(&self) -> ContactPair {
        let of: Vec<JumpOf> = (0..self.gaps.len())
            .map(|number| JumpOf::Unknown {
                number,
                factor: 1.0,
            })
            .collect();
        let limits = Limits::new(of.len(), &of, &self.gaps, &[], 0.0);
        let layer = Layer::new(&self.condensed, &self.compliances);
        let condensed = Rc::new(layer.before(&self.condensed));
        ContactPair::new(condensed, limits, layer.load(&self.load), None)
    }
}

/// Both components of every node.
fn dofs(nodes: &[u32]) -> Vec<InterfaceDof> {
    let of_node = |&node: &u32| [0, 1].map(|axis| InterfaceDof { node, axis });
    nodes.iter().flat_map(of_node).collect()
}

/// A linear subdomain and two pairs that share four nodes.
pub struct Small {
    pub linear: Cluster,
    pub pairs: [Cluster; 2],
}

impl Small {
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        Self {
            linear: Cluster::random(&mut random, &[0, 1, 2, 3], 0),
            pairs: [&[0, 1][..], &[1, 2, 3]]
                .map(|nodes| Cluster::random(&mut random, nodes, APPROACHES)),
        }
    }

    /// The same with a layer between the sides of all contacts but one.
    pub fn with_layers(seed: u64) -> Self {
        let mut small = Self::new(seed);
        for pair in &mut small.pairs {
            pair.compliances = vec![0.4, 0.05, 0.1];
        }
        small.pairs[0].compliances[1] = 0.0;
        small
    }

    fn clusters(&self) -> [&Cluster; 3] {
        [&self.linear, &self.pairs[0], &self.pairs[1]]
    }

    /// The operators on Γ with these `pairs`, its numbering, and what loads the clusters.
    pub fn interface(&self, pairs: &[ContactPair]) -> (Interface, Numbering, Vec<ClusterLoad>) {
        let clusters = self.clusters();
        let interface_dofs = clusters.map(|cluster| &cluster.condensed.interface_dofs[..]);
        let nodes = clusters.map(|cluster| &cluster.nodes[..]);
        let in_contact = [false, true, true];
        let numbering = Numbering::new(&interface_dofs, &nodes, &in_contact).unwrap();
        let mut contributions = vec![Contribution {
            s: self.linear.condensed.s.clone(),
            smallest_pivot: 1.0,
            law: None,
        }];
        contributions.extend(pairs.iter().map(|pair| Contribution {
            s: pair.condensed().bilateral().to_owned(),
            smallest_pivot: 1.0,
            law: Some(CondensedContact::new(pair.condensed(), pair.limits())),
        }));
        let interface = Interface::new(&numbering, contributions, &in_contact, Par::Seq).unwrap();
        let of_pairs = pairs.iter().map(|pair| pair.bilateral_load());
        let loads = [&self.linear.load[..]].into_iter().chain(of_pairs);
        let loads: Vec<ClusterLoad> = loads
            .map(|load| ClusterLoad {
                load: load.to_vec(),
                scale: 0.0,
            })
            .collect();
        (interface, numbering, loads)
    }

    /// The solution of the whole.
    pub fn exact(&self) -> Exact {
        let jumps = 2 * APPROACHES;
        let n = jumps + self.linear.condensed.interface_dofs.len();
        let (mut k, mut f) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for (c, cluster) in self.clusters().into_iter().enumerate() {
            let own = (0..cluster.gaps.len()).map(|i| (c.max(1) - 1) * APPROACHES + i);
            let dof = |dof: &InterfaceDof| jumps + (2 * dof.node + dof.axis) as usize;
            let places: Vec<usize> = own
                .chain(cluster.condensed.interface_dofs.iter().map(dof))
                .collect();
            for (i, &row) in places.iter().enumerate() {
                for (j, &column) in places.iter().enumerate() {
                    k[(row, column)] += cluster.condensed.s[(i, j)];
                }
                f[row] += cluster.load[i];
            }
        }
        exact(
            &k,
            &f,
            &self.pairs.each_ref().map(|pair| &pair.gaps[..]).concat(),
            &(self.pairs.each_ref())
                .map(|pair| &pair.compliances[..])
                .concat(),
        )
    }
}

/// min ½ xᵀ K x − fᵀ x + Σ max(0, t − g)² / 2e, t the first of x: the one set of closed contacts with
/// no force that pulls and no gap that is negative. Where e = 0, t ≤ g.
pub fn exact(k: &DMatrix<f64>, f: &DVector<f64>, gaps: &[f64], compliances: &[f64]) -> Exact {
    let (n, m) = (k.nrows(), gaps.len());
    let found = (0..1_u32 << m).find_map(|set| {
        let closed: Vec<usize> = (0..m).filter(|i| set >> i & 1 == 1).collect();
        // K x + Σ λ = f, t − e λ = g.
        let size = n + closed.len();
        let mut system = DMatrix::zeros(size, size);
        system.view_mut((0, 0), (n, n)).copy_from(k);
        let mut right = DVector::zeros(size);
        right.rows_mut(0, n).copy_from(f);
        for (row, &i) in closed.iter().enumerate() {
            system[(n + row, i)] = 1.0;
            system[(i, n + row)] = 1.0;
            system[(n + row, n + row)] = -compliances[i];
            right[n + row] = gaps[i];
        }
        let x = system.lu().solve(&right)?;
        let mut forces = vec![0.0; m];
        for (row, &i) in closed.iter().enumerate() {
            forces[i] = x[n + row];
        }
        let right_signs = (0..m).all(|i| match closed.contains(&i) {
            true => forces[i] >= 0.0,
            false => x[i] <= gaps[i],
        });
        right_signs.then(|| Exact {
            x: x.as_slice()[..n].to_vec(),
            forces,
        })
    });
    found.unwrap()
}
