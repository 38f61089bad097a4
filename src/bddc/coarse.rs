//! The coarse problem: what clusters leave to coarse unknowns, added up and factorized at the root.

use faer::{Mat, Par};
use serde::{Deserialize, Serialize};

use crate::bddc::local::Local;
use crate::error::Failure;
use crate::schur::factor::BoundaryLastCholesky;
use crate::schur::pattern::{Cliques, LowerPattern, SparseSymmetric};

/// What a cluster says of its coarse unknowns.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CoarsePart {
    /// Its classes, and how many unknowns each has.
    pub classes: Vec<(usize, usize)>,
    /// What the cluster leaves to them.
    #[serde(with = "crate::bytes::symmetric")]
    pub s: Mat<f64>,
}

impl CoarsePart {
    /// That of a cluster with these classes.
    pub fn of(local: &Local, classes: &[usize]) -> Self {
        let counts = local.bases().iter().map(|basis| basis.coarse);
        Self {
            classes: classes.iter().copied().zip(counts).collect(),
            s: local.coarse.clone(),
        }
    }
}

/// The coarse problem, on the root.
#[derive(Debug)]
pub struct Coarse {
    factor: BoundaryLastCholesky,
    /// The coarse unknowns of every cluster.
    numbers: Vec<Vec<u32>>,
    len: usize,
}

impl Coarse {
    /// Adds up what all clusters say, in their order, and factorizes it; `order` is that in which their classes are
    /// eliminated. The first of `holds`, shares of the diagonal, is added that leaves it definite.
    ///
    /// # Errors
    /// A part of the scene can move.
    pub fn new(
        parts: &[CoarsePart],
        order: &[usize],
        holds: &[f64],
        par: Par,
    ) -> Result<Self, Failure> {
        let mut counts = vec![0; order.len()];
        for &(k, count) in parts.iter().flat_map(|part| &part.classes) {
            counts[k] = count;
        }
        let (mut first, mut n) = (vec![0; order.len()], 0);
        for &k in order {
            first[k] = n as u32;
            n += counts[k];
        }
        let numbers_of = |part: &CoarsePart| -> Vec<u32> {
            let classes = part.classes.iter();
            let numbers = classes.flat_map(|&(k, count)| first[k]..first[k] + count as u32);
            numbers.collect()
        };
        let numbers: Vec<Vec<u32>> = parts.iter().map(numbers_of).collect();
        let mut cliques = Cliques::default();
        for of_cluster in &numbers {
            cliques.push(of_cluster.iter().copied());
        }
        let too_large = || {
            Failure::internal("the coarse problem has more than 2^32 entries: use fewer clusters")
        };
        let pattern = LowerPattern::new(n, &cliques);
        let pattern = pattern.ok_or_else(too_large)?;
        let held_by = |share: f64| {
            let mut sum = SparseSymmetric::zeros(pattern.clone());
            for (part, numbers) in parts.iter().zip(&numbers) {
                let mut s = part.s.clone();
                (0..s.nrows()).for_each(|i| s[(i, i)] *= 1.0 + share);
                sum.add_large(numbers, s.as_ref());
            }
            BoundaryLastCholesky::new(&sum, n, par)
        };
        let mut factor = held_by(0.0);
        for &share in &holds[1..] {
            factor = factor.or_else(|_| held_by(share));
        }
        let factor = factor.map_err(|error| {
            Failure::ill_posed(format!(
                "the coarse problem of the clusters can't be solved ({error}): some part of the scene is held neither \
                 by supports nor by contact"
            ))
        })?;
        Ok(Self {
            factor,
            numbers,
            len: n,
        })
    }

    /// Number of coarse unknowns.
    pub fn len(&self) -> usize {
        self.len
    }

    /// The smallest pivot relative to its diagonal entry.
    pub fn smallest_pivot(&self) -> f64 {
        self.factor.smallest_pivot()
    }

    /// The coarse unknowns of every cluster, for the loads of all.
    pub fn solve(&self, loads: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut x = vec![0.0; self.len];
        for (numbers, load) in self.numbers.iter().zip(loads) {
            for (&i, load) in numbers.iter().zip(load) {
                x[i as usize] += load;
            }
        }
        self.factor.solve(&mut x);
        let of_cluster = |numbers: &Vec<u32>| numbers.iter().map(|&i| x[i as usize]).collect();
        self.numbers.iter().map(of_cluster).collect()
    }
}
