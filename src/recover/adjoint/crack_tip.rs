//! Stress intensity factors and the energy release rate of a crack tip as functionals of the solution.
//!
//! With M = L u + m of both modes, K = ½ H⁻¹ M and J = Kᵀ H K, so that dJ = K·dM. L doesn't depend on the size of the
//! stiffness C; H⁻¹ grows with it as 1/m does: at fixed displacements C ∂K/∂C = ½ H⁻¹ L u, and C ∂J/∂C = J − K·m.

use std::collections::BTreeMap;

use contact_dd_partition::quantity::{Quantity, QuantityKind};
use nalgebra::Vector2;

use super::functional::Functional;
use super::solved::Solved;
use crate::fem::interaction_integral::TipDisc;
use crate::vector::{axpy, dot};

impl Functional {
    /// Adds K_I, K_II or J of a crack tip; 0 if its body is absent. Collective.
    pub(super) fn weigh_tip(&mut self, solved: Solved<'_>, quantity: &Quantity) {
        let context = &solved.fixed.context;
        let catalog = context.catalog;
        let tip = &catalog.tips[quantity.of[0] as usize];
        let disc = TipDisc::new(tip, &catalog.materials[tip.material as usize]);
        let is_there = !catalog.bodies[tip.body as usize].is_absent;
        let Some(disc) = disc.filter(|_| is_there) else {
            return;
        };
        let mut weights = BTreeMap::new();
        for (&b, block) in context.blocks {
            let initial = block.subdomain.initial_stress_in(solved.step);
            let of_block = solved.solution.discrete.blocks.get(&b);
            if let Some((of_block, of_tip)) = of_block.zip(disc.weights(block, initial)) {
                let of_u = of_tip.of_nodes.each_ref().map(|of| dot(of, &of_block.u));
                weights.insert(b, (of_tip, of_u));
            }
        }
        // L u and m.
        let mut sums = [[0.0; 2]; 2];
        (context.comm).gather(
            &context.plan.owners(),
            |b| {
                weights
                    .get(&b)
                    .map(|(of_tip, of_u)| [*of_u, of_tip.constants])
            },
            |_, parts: Option<[[f64; 2]; 2]>| {
                for (sum, part) in sums.iter_mut().zip(parts.into_iter().flatten()) {
                    *sum = [sum[0] + part[0], sum[1] + part[1]];
                }
            },
        );
        context.comm.broadcast(&mut sums);
        let [of_u, constant] = sums.map(Vector2::from);
        let h = disc.field.compliance();
        // H is positive definite, as C is.
        let half_inverse = 0.5 * h.try_inverse().unwrap_or_default();
        let factors = half_inverse * (of_u + constant);
        let half = half_inverse * of_u;
        let share = match quantity.kind {
            QuantityKind::EnergyReleaseRate => {
                self.value = factors.dot(&(h * factors));
                self.of_stiffness = self.value - factors.dot(&constant);
                factors
            }
            kind => {
                let mode = usize::from(kind == QuantityKind::SlidingIntensity);
                (self.value, self.of_stiffness) = (factors[mode], half[mode]);
                half_inverse.column(mode).into_owned()
            }
        };
        for (b, (of_tip, _)) in weights {
            let mut of_nodes = vec![0.0; of_tip.of_nodes[0].len()];
            for (of_mode, share) in of_tip.of_nodes.iter().zip(share.iter()) {
                axpy(*share, of_mode, &mut of_nodes);
            }
            self.of_nodes.insert(b, of_nodes);
        }
    }
}
