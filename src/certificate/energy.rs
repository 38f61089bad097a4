//! The balance of energy of an increment of load with friction.
//!
//! With forces f of loads, r of supports and −Bᵀλ of contacts, K u = f + r − Bᵀλ before the increment, where they have
//! an index n, and after it. As K is symmetric, but for round-off
//!
//! ```text
//! ½ (f_n + f)ᵀ Δu + ½ (r_n + r)ᵀ Δu = ΔE + ½ (λ_n + λ)ᵀ B Δu,    E = ½ uᵀ K u
//! ```
//!
//! Dissipated work of friction, λ_tᵀ Δw, has the force at the end. The rest of the work of contacts is an error of
//! finite increments: forces that change during slip, and pressure while a gap opens or closes. It vanishes as
//! increments become small, except for the energy of an interference fit.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::bytes::Reals;
use crate::fem::balance::Balance;
use crate::fem::block::Block;
use crate::fem::load::BlockLoads;
use crate::vector::{axpy, dot};

/// Smallest error beyond round-off, relative to all terms of forces times displacements.
const NOT_ROUND_OFF: f64 = 1e-12;

/// Balance of energy in a load step, with the mean of the forces at both ends of every increment (J, per metre of
/// thickness in the plane); in a load step that adds or removes bodies or contacts, from unloaded bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EnergyBalance {
    /// Work of loads.
    pub work_of_loads: f64,
    /// Work of supports along prescribed displacements, and of springs, to the ground and in compliant contacts.
    pub work_of_supports: f64,
    /// Change of the elastic energy ½ uᵀ K u.
    pub elastic_energy: f64,
    /// Work of contacts: `dissipated_work` plus an error of finite increments, which vanishes as these become small;
    /// negative where an interference fit supplies energy.
    pub work_of_contacts: f64,
    /// Difference between the sum of the first two and that of the other two, relative to the largest of the four and
    /// of the elastic energy.
    pub imbalance: f64,
    /// True if the imbalance is more than round-off.
    #[serde(skip)]
    pub is_off: bool,
}

/// Data of a block that the energy balance of the next increment needs, on its nodes.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct BlockEnergy {
    /// u.
    displacement: Reals,
    /// f, r and Bᵀλ (N per metre of thickness).
    forces: [Reals; 3],
    /// ½ uᵀ K u; a single block's may have any sign.
    elastic: f64,
    /// Σ |terms of forces| |u|.
    terms: f64,
}

/// Work of f, r and Bᵀλ on a block, its elastic energy before and after, and the size of all terms.
pub type BlockWork = [f64; 6];

impl BlockEnergy {
    /// Data of a block with this `balance` at displacements `u`; `displacement` includes the closing motions of bodies.
    pub fn new(
        block: &Block,
        loads: &BlockLoads,
        balance: &Balance,
        u: &[f64],
        displacement: &[f64],
    ) -> Self {
        let of_loads = loads.nodal_forces(block);
        let mut of_supports = vec![0.0; of_loads.len()];
        for support in &loads.supports {
            for i in (0..block.dim).map(|c| support.node as usize * block.dim + c) {
                of_supports[i] = -balance.residual[i];
            }
        }
        let of_contacts = (of_loads.iter().zip(&balance.external)).zip(&balance.springs);
        let of_contacts = of_contacts.map(|((f, external), spring)| f - (external - spring));
        let of_contacts = of_contacts.collect();
        axpy(1.0, &balance.springs, &mut of_supports);
        let inner = balance.external.iter().zip(&balance.residual);
        let inner: Vec<f64> = inner.map(|(external, left)| external - left).collect();
        let sizes: Vec<f64> = displacement.iter().map(|u| u.abs()).collect();
        Self {
            displacement: Reals(displacement.to_vec()),
            elastic: 0.5 * dot(u, &inner),
            terms: dot(&balance.scale, &sizes),
            forces: [of_loads, of_supports, of_contacts].map(Reals),
        }
    }

    /// Work in the increment from the state `before`, or from unloaded bodies.
    pub fn work(&self, before: Option<&Self>) -> BlockWork {
        let mut increment = self.displacement.0.clone();
        if let Some(before) = before {
            let earlier = before.displacement.0.iter();
            increment
                .iter_mut()
                .zip(earlier)
                .for_each(|(u, was)| *u -= was);
        }
        let [loads, supports, contacts] = [0, 1, 2].map(|k| {
            let earlier = before.map_or(0.0, |before| dot(&before.forces[k].0, &increment));
            0.5 * (dot(&self.forces[k].0, &increment) + earlier)
        });
        let (elastic, terms) = before.map_or((0.0, 0.0), |b| (b.elastic, b.terms));
        let terms = self.terms + terms;
        [loads, supports, contacts, elastic, self.elastic, terms]
    }
}

impl EnergyBalance {
    /// True if all are finite numbers.
    pub fn is_finite(&self) -> bool {
        let works = [
            self.work_of_loads,
            self.work_of_supports,
            self.elastic_energy,
            self.work_of_contacts,
            self.imbalance,
        ];
        works.into_iter().all(f64::is_finite)
    }

    /// Balance of all blocks, in their order.
    pub fn new(blocks: &[BlockWork]) -> Self {
        let sum = |k: usize| blocks.iter().map(|work| work[k]).sum::<f64>();
        let [loads, supports, contacts, before, after, terms] = [0, 1, 2, 3, 4, 5].map(sum);
        let off = (loads + supports - (after - before) - contacts).abs();
        let sizes = [loads, supports, contacts, before, after].map(f64::abs);
        let largest = sizes.into_iter().fold(0.0, f64::max);
        Self {
            work_of_loads: loads,
            work_of_supports: supports,
            elastic_energy: after - before,
            work_of_contacts: contacts,
            imbalance: if off == 0.0 { 0.0 } else { off / largest },
            is_off: off > NOT_ROUND_OFF * terms || off.is_nan(),
        }
    }

    /// Balance of an `earlier` increment together with this one.
    pub fn since(self, earlier: Self) -> Self {
        Self {
            work_of_loads: earlier.work_of_loads + self.work_of_loads,
            work_of_supports: earlier.work_of_supports + self.work_of_supports,
            elastic_energy: earlier.elastic_energy + self.elastic_energy,
            work_of_contacts: earlier.work_of_contacts + self.work_of_contacts,
            imbalance: earlier.imbalance.max(self.imbalance),
            is_off: earlier.is_off || self.is_off,
        }
    }

    /// Warning of a balance that is off by more than round-off.
    pub fn warning(&self) -> Option<String> {
        self.is_off.then(|| {
            format!(
                "energy balance violated by {:.1e} of the work of loads and supports: the forces on the nodes aren't \
                 balanced",
                self.imbalance
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A spring of stiffness 2 under this force.
    fn spring(u: f64, force: f64) -> BlockEnergy {
        BlockEnergy {
            displacement: Reals(vec![u]),
            forces: [vec![force], vec![0.0], vec![0.0]].map(Reals),
            elastic: u * u,
            terms: 2.0 * (force * u).abs(),
        }
    }

    #[test]
    fn what_a_spring_stores_is_what_its_load_does_or_there_is_a_warning() {
        let of =
            |force: f64| EnergyBalance::new(&[spring(3.0, force).work(Some(&spring(1.0, 2.0)))]);
        let balance = of(6.0);
        assert_eq!((balance.work_of_loads, balance.elastic_energy), (8.0, 8.0));
        assert_eq!((balance.imbalance, balance.warning()), (0.0, None));
        let first = EnergyBalance::new(&[spring(1.0, 2.0).work(None)]);
        assert_eq!(balance.since(first).elastic_energy, 9.0);
        let off = of(6.0 + 1e-9);
        assert!(off.warning().is_some() && balance.since(off).warning().is_some());
        assert!(of(f64::NAN).warning().is_some());
    }
}
