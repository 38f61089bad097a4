//! The interface problem of a load step: its load F, (15), with the operators of all steps.
//!
//! > F = Σ_T R̄_iᵀ f_i

use super::numbering::Numbering;
use super::operator::{Interface, diagonal_of};
use super::rigid_modes::{RigidBasis, RigidModes};
use crate::vector::NOTHING;

/// Scale of a residual of round-off forces, relative to the forces whose round-off they are: times the tolerance of
/// sweeps it is round-off again.
const LEFT: f64 = 1e-3;

/// The load of a cluster.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ClusterLoad {
    /// Condensed load on the interface dofs, with every contact closed.
    #[serde(with = "crate::bytes")]
    pub load: Vec<f64>,
    /// The largest prescribed displacement in a cluster in contact (m).
    pub scale: f64,
}

/// S_0 U + S_CON(U) = F, (14), in a load step, on the root.
#[derive(Debug)]
pub struct InterfaceProblem<'a> {
    /// S_0 and the bilateral operator.
    pub interface: &'a Interface,
    /// F of the linear subdomains.
    f: Vec<f64>,
    f_scale: Vec<f64>,
    /// F of the pairs with every contact closed.
    f_bilateral: Vec<f64>,
    /// The rigid-body motions by their normal jumps, and the load along them.
    pub motions: RigidBasis,
    /// The largest prescribed displacement in a cluster in contact (m).
    pub scale: f64,
    /// The largest force outside Γ, or in a load step before (N/m).
    elsewhere: f64,
}

impl<'a> InterfaceProblem<'a> {
    /// Assembles F from the `loads` of all clusters, in their order; `modes` are the pairs' normal jumps in the
    /// rigid-body motions, and the load along these; `elsewhere` is the largest force in the bodies outside Γ, or
    /// before.
    pub fn new(
        interface: &'a Interface,
        numbering: &Numbering,
        loads: &[ClusterLoad],
        modes: &RigidModes,
        elsewhere: f64,
    ) -> Self {
        let zeros = || vec![0.0; interface.len];
        let (mut f, mut f_bilateral, mut f_scale) = (zeros(), zeros(), zeros());
        let of_clusters = loads.iter().zip(&numbering.interface_dofs);
        for ((of_cluster, interface_dofs), &in_contact) in of_clusters.zip(&interface.in_contact) {
            let f = match in_contact {
                true => &mut f_bilateral,
                false => &mut f,
            };
            for (&dof, load) in interface_dofs.iter().zip(&of_cluster.load) {
                f[dof as usize] += load;
                f_scale[dof as usize] += load.abs();
            }
        }
        Self {
            interface,
            f,
            f_scale,
            f_bilateral,
            motions: RigidBasis::new(modes, &diagonal_of(&interface.laws)),
            scale: loads.iter().fold(0.0, |m, load| m.max(load.scale)),
            elsewhere,
        }
    }

    /// True if there is no load on Γ and the clusters in contact; gaps and slips may still be prescribed.
    pub fn is_unloaded(&self) -> bool {
        let mut all = self.f.iter().chain(&self.f_bilateral);
        all.all(|&f| f == 0.0)
    }

    /// U^0: the solution of the bilateral problem (16)-(17).
    pub fn bilateral_start(&self) -> Vec<f64> {
        let parts = self.f.iter().zip(&self.f_bilateral);
        let mut u: Vec<f64> = parts.map(|(a, b)| a + b).collect();
        self.interface.solver.solve(&mut u);
        u
    }

    /// Scale of a residual whose largest term is `terms`; if this is round-off of forces elsewhere, a fraction of
    /// these.
    pub fn residual_scale(&self, terms: f64) -> f64 {
        match terms < NOTHING * self.elsewhere {
            true => LEFT * self.elsewhere,
            false => terms,
        }
    }

    /// F − S_0 U and the scale of its terms.
    pub fn linear_residual(&self, u: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let s_0 = self.interface.s_0();
        let mut su = vec![0.0; self.interface.len];
        s_0.multiply_add(u, &mut su);
        let mut scale = self.f_scale.clone();
        s_0.multiply_add_absolute(u, &mut scale);
        let r = self.f.iter().zip(&su).map(|(f, su)| f - su).collect();
        (r, scale)
    }
}
