//! The conditions z of slipping points in a transposed problem, z = G w(z), by generalized conjugate residuals.

use super::slipping::{Direction, OnConditions};
use super::transposed::TransposedProblem;
use crate::context::Loads;
use crate::fem::contact_group::GroupLoads;
use crate::fem::load::BlockLoads;
use crate::recover::BlockSolution;
use crate::recover::fixed_active_set::FixedActiveSet;
use crate::vector::{add_multiple, multiple};

/// Most products in a round.
const PRODUCTS: usize = 60;

impl TransposedProblem<'_> {
    /// W (I − G) z for a change z of these conditions. Collective.
    fn product(&self, z: &OnConditions) -> OnConditions {
        let context = &self.solved.fixed.context;
        let blocks = self.solved.solution.discrete.blocks.iter();
        let zeros = blocks
            .filter(|(b, _)| self.around_contact[(**b).into()])
            .map(|(&b, of_block)| {
                let (u, pushes) = (vec![0.0; of_block.u.len()], Vec::new());
                (b, BlockSolution { u, pushes })
            });
        let mut state = self.at_rest(zeros.collect());
        let mut loads = Loads::default();
        for &b in self.loads.blocks.keys() {
            loads.blocks.insert(b, BlockLoads::default());
        }
        for (&g, points) in self.slipping {
            let (gaps, forces) = points.split(&z[&g]);
            if let Some(of_group) = state.groups.get_mut(&g) {
                points.set_forces(&forces, of_group);
            }
            let held = Vec::new();
            loads.groups.insert(g, GroupLoads { gaps, held });
        }
        state.share(context, &loads);
        let fixed = FixedActiveSet {
            only: Some(&self.around_contact),
            ..*self.solved.fixed
        };
        self.correct_by(&fixed, &loads, &mut state);
        let mut product = z.clone();
        add_multiple(-1.0, &self.wanted(&state), &mut product);
        self.weighted(product)
    }

    /// W times a vector on conditions.
    pub(super) fn weighted(&self, mut of: OnConditions) -> OnConditions {
        for (g, points) in self.slipping {
            if let Some(of) = of.get_mut(g) {
                points.weigh(of);
            }
        }
        of
    }

    /// z with W (I − G) z = `missing`, to a relative accuracy `reduction`. Collective.
    pub(super) fn conditions_of_slips(
        &self,
        missing: &OnConditions,
        reduction: f64,
    ) -> OnConditions {
        let mut directions = self.directions.borrow_mut();
        let (mut sum, mut rest) = (self.zeros(), missing.clone());
        let enough = reduction * self.norm(missing);
        let mut products = 0;
        for k in 0.. {
            if k == directions.len() {
                if self.norm(&rest) <= enough || products == PRODUCTS {
                    break;
                }
                products += 1;
                let next = self.direction(rest.clone(), &directions);
                directions.push(next);
            }
            let (z, product) = &directions[k];
            let share = self.dot(&rest, product);
            add_multiple(share, z, &mut sum);
            add_multiple(-share, product, &mut rest);
        }
        sum
    }

    /// A direction z for which W (I − G) z is a unit vector orthogonal to those `before`, and that vector. Collective.
    fn direction(&self, mut z: OnConditions, before: &[Direction]) -> Direction {
        let mut product = self.product(&z);
        // Two passes suffice for orthogonality to round-off.
        for _ in 0..2 {
            for (known, of_known) in before {
                let share = self.dot(&product, of_known);
                add_multiple(-share, known, &mut z);
                add_multiple(-share, of_known, &mut product);
            }
        }
        let size = self.norm(&product);
        (multiple(1.0 / size, &z), multiple(1.0 / size, &product))
    }
}
