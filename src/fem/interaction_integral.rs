//! Interaction integral of a crack tip over the cells of a block.
//!
//! With the near field a of K = 1, its stress s and strain e, the stress σ, and q = 1 around the tip and 0 outside a
//! disc,
//!
//! > M = ∫ (σ_ij a_i,1 + s_ij u_i,1 − σ:e δ_1j) q,_j dx − ∫ e:σ⁰,₁ q dx − Σ f_j · W_j,   M = 2 H K,
//!
//! G = Kᵀ H K. σ⁰ is the initial stress. The last sum is the work of the forces within the disc: body forces, and
//! tractions on the crack faces, including contact and friction. At equilibrium they are f_j = ∫ Bᵀ σ at every node; W
//! = q a,₁, and on the faces, where a,₁ is singular, its mean weighted by the node's shape function.
//!
//! J. F. Yau, S. S. Wang, H. T. Corten, *A mixed-mode crack analysis of isotropic solids using conservation laws of
//! elasticity*, J. Appl. Mech. 47 (1980); J. R. Walters, G. H. Paulino, R. H. Dodds, *Interaction integral procedures
//! for 3-D curved cracks including surface tractions*, Eng. Fract. Mech. 72 (2005).

mod cell;
mod faces;
mod weights;

use std::collections::BTreeMap;

use contact_dd_partition::crack_tip::CrackTip;
use contact_dd_partition::element::quadrature::TabulatedPoint;
use contact_dd_partition::model::Material;
use contact_dd_partition::problem::InitialStress;
use contact_dd_partition::stiffness::Stiffness;
use nalgebra::{Matrix3, Vector3};

use self::cell::{DEGREE, LocalCell, LocalNode, LocalPoint, OfCell, RADII, Work};
use super::block::{Block, BlockCell};
use super::elasticity::amplitudes;
use super::gradients::{has_modes, stiffness_points};
use super::near_field::{Gradient, NearField, strain, turned};

/// Radius within which q = 1, over the radius of the disc.
const INNER: f64 = 0.5;

/// M (Pa √m · m) for discs of every radius and both modes.
pub type Integrals = [[f64; 2]; RADII.len()];

/// The disc around a crack tip.
pub struct TipDisc<'a> {
    tip: &'a CrackTip,
    /// The near fields.
    pub field: NearField,
    /// The material in the frame of the tip.
    material: Material,
    /// W at the nodes of the faces, by their tags.
    on_faces: BTreeMap<i64, [Work; RADII.len()]>,
}

impl<'a> TipDisc<'a> {
    /// The disc around a tip in `material`; `None` if the material has no near fields.
    pub fn new(tip: &'a CrackTip, material: &Material) -> Option<Self> {
        let stiffness = Matrix3::from_row_slice(material.stiffness.values());
        let stiffness = turned(&stiffness, [tip.direction[0], tip.direction[1]]);
        let mut disc = Self {
            tip,
            field: NearField::new(stiffness)?,
            material: Material {
                stiffness: Stiffness::new(3, stiffness.transpose().as_slice()),
                ..material.clone()
            },
            on_faces: BTreeMap::new(),
        };
        disc.on_faces = disc.work_on_faces();
        Some(disc)
    }

    /// The tip.
    pub fn tip(&self) -> &CrackTip {
        self.tip
    }

    /// Components of a plane vector in the frame of the tip.
    fn turn(&self, x: [f64; 2]) -> [f64; 2] {
        let [cos, sin, _] = self.tip.direction;
        [cos * x[0] + sin * x[1], cos * x[1] - sin * x[0]]
    }

    /// A point in the frame of the tip (m).
    fn place(&self, x: &[f64; 3]) -> [f64; 2] {
        let tip = &self.tip.position;
        self.turn([x[0] - tip[0], x[1] - tip[1]])
    }

    /// q for a disc of a given radius, at a distance from the tip.
    fn weight(&self, radius: usize, distance: f64) -> f64 {
        let outer = RADII[radius] * self.tip.radius;
        ((1.0 - distance / outer) / (1.0 - INNER)).clamp(0.0, 1.0)
    }

    /// The nodes of a block in the frame of the tip; `None` if all lie outside the disc.
    fn nodes(&self, block: &Block) -> Option<Vec<LocalNode>> {
        let places = block.points().iter().map(|x| self.place(x));
        let nodes = places.zip(&block.subdomain.node_tags);
        let nodes: Vec<LocalNode> = nodes.map(|(place, tag)| self.node(place, *tag)).collect();
        nodes.iter().any(LocalNode::is_near).then_some(nodes)
    }

    /// A node at `place` in the frame of the tip, by its tag.
    fn node(&self, place @ [x, y]: [f64; 2], tag: i64) -> LocalNode {
        let distance = x.hypot(y);
        let q: [f64; RADII.len()] = std::array::from_fn(|radius| self.weight(radius, distance));
        let works = || {
            let fields = match q[0] > 0.0 && distance > 0.0 {
                true => self.field.gradients(distance, y.atan2(x)),
                false => Default::default(),
            };
            q.map(|q| fields.map(|of_mode| of_mode.map(|of| q * of[0])))
        };
        let on_face = self.on_faces.get(&tag).copied();
        LocalNode {
            place,
            q,
            work: on_face.unwrap_or_else(works),
        }
    }

    /// The integrals over the cells of a block for displacements `u`, node by node; `None` if no cell lies in the disc.
    pub fn integrals(
        &self,
        block: &Block,
        u: &[f64],
        initial: &InitialStress,
    ) -> Option<Integrals> {
        let mut sum = None;
        self.each_cell(block, initial, RADII.len(), |cell, found| {
            let of_nodes = cell
                .numbers
                .iter()
                .map(|&n| self.turn([u[2 * n], u[2 * n + 1]]));
            let mut u: Vec<[f64; 2]> = of_nodes.collect();
            self.append_modes(cell, &mut u);
            let sum: &mut Integrals = sum.get_or_insert_default();
            for (sum, found) in sum.iter_mut().zip(found) {
                for (sum, found) in sum.iter_mut().zip(found) {
                    let products = u.iter().zip(&found.slopes);
                    let of_u: f64 = products.map(|(u, l)| u[0] * l[0] + u[1] * l[1]).sum();
                    *sum += of_u + found.constant;
                }
            }
        });
        sum
    }

    /// Calls `take` with the integral over every cell in the disc, for the first `radii` discs.
    fn each_cell(
        &self,
        block: &Block,
        initial: &InitialStress,
        radii: usize,
        mut take: impl FnMut(&LocalCell<'_>, &[[OfCell; 2]]),
    ) {
        let mut rules: BTreeMap<(u8, usize), Vec<TabulatedPoint>> = BTreeMap::new();
        // Most blocks of a scene lie outside the disc.
        let Some(nodes) = self.nodes(block) else {
            return;
        };
        let is_near = |cell: &BlockCell<'_>| cell.nodes().any(|n| nodes[n as usize].is_near());
        let mut found: Vec<[OfCell; 2]> = (0..radii).map(|_| Default::default()).collect();
        for cell in block.cells().filter(is_near) {
            let local = self.cell(&cell, &nodes, initial);
            let places = local.nodes.len() + if local.has_modes { 2 } else { 0 };
            for of_cell in found.as_flattened_mut() {
                of_cell.clear(places);
            }
            for point in stiffness_points(&cell.kind, &self.material) {
                self.add_forces(&local, point, &mut found);
            }
            if !local.is_flat(radii) {
                let degree = local.degree();
                let rule = (rules.entry((cell.kind.vtk(), degree)))
                    .or_insert_with(|| cell.kind.tabulate(degree));
                for point in rule {
                    self.add_fields(&local, point, &mut found);
                }
            }
            take(&local, &found);
        }
    }

    fn cell<'n>(
        &self,
        cell: &BlockCell<'_>,
        all: &'n [LocalNode],
        initial: &InitialStress,
    ) -> LocalCell<'n> {
        let numbers: Vec<usize> = cell.nodes().map(|node| node as usize).collect();
        let nodes: Vec<&LocalNode> = numbers.iter().map(|&node| &all[node]).collect();
        let stress = |&node: &usize| initial.nodes.get(node).map(|stress| self.turned(stress));
        let points = nodes.iter().map(|of| [of.place[0], of.place[1], 0.0]);
        LocalCell {
            kind: cell.kind,
            has_modes: has_modes(&cell.kind, &self.material),
            points: points.collect(),
            initial: numbers.iter().filter_map(stress).collect(),
            numbers,
            nodes,
        }
    }

    /// Appends the amplitudes of a cell's incompatible modes, if any, to its displacements.
    fn append_modes(&self, cell: &LocalCell<'_>, u: &mut Vec<[f64; 2]>) {
        if cell.has_modes {
            let of_nodes = u.concat();
            let modes = amplitudes(&cell.kind, &cell.points, &self.material, &of_nodes);
            u.extend(modes.as_chunks().0);
        }
    }

    /// A stress (XX, YY, ZZ, XY, YZ, XZ) in the frame of the tip, (xx, yy, xy).
    fn turned(&self, stress: &[f64; 6]) -> Vector3<f64> {
        let [c, s, _] = self.tip.direction;
        let [xx, yy, _, xy, ..] = *stress;
        Vector3::new(
            c * c * xx + s * s * yy + 2.0 * c * s * xy,
            s * s * xx + c * c * yy - 2.0 * c * s * xy,
            c * s * (yy - xx) + (c * c - s * s) * xy,
        )
    }

    /// Subtracts Σ f_j · W_j at a point, which is ∫ σ : ∇W.
    fn add_forces(
        &self,
        cell: &LocalCell<'_>,
        reference: &TabulatedPoint,
        found: &mut [[OfCell; 2]],
    ) {
        let point = LocalPoint::new(cell, reference);
        for (radius, found) in found.iter_mut().enumerate() {
            for (mode, found) in found.iter_mut().enumerate() {
                let mut slope = Gradient::default();
                for (g, node) in point.at.gradients.iter().zip(&cell.nodes) {
                    for (slope, work) in slope.iter_mut().zip(node.work[radius][mode]) {
                        *slope = [slope[0] + work * g[0], slope[1] + work * g[1]];
                    }
                }
                let stress = tensor(&self.field.stress(&slope));
                point.add(-1.0, &stress, found);
                found.constant -= point.at.weight * point.initial.dot(&strain(&slope));
            }
        }
    }

    /// Adds ∫ (σ_ij a_i,1 + s_ij u_i,1 − σ:e δ_1j) q,_j − ∫ e:σ⁰,₁ q at a point.
    fn add_fields(
        &self,
        cell: &LocalCell<'_>,
        reference: &TabulatedPoint,
        found: &mut [[OfCell; 2]],
    ) {
        let point = LocalPoint::new(cell, reference);
        let shape = || reference.shape.iter();
        let [x, y] =
            [0, 1].map(|d| -> f64 { shape().zip(&cell.points).map(|(n, x)| n * x[d]).sum() });
        let fields = self.field.gradients(x.hypot(y), y.atan2(x));
        for (mode, near) in fields.into_iter().enumerate() {
            let (stress, near_strain) = (self.field.stress(&near), strain(&near));
            let s = tensor(&stress);
            for (radius, found) in found.iter_mut().enumerate() {
                let found = &mut found[mode];
                let mut q = [0.0; 2];
                for (g, node) in point.at.gradients.iter().zip(&cell.nodes) {
                    let of_node = node.q[radius];
                    q = [q[0] + of_node * g[0], q[1] + of_node * g[1]];
                }
                // The displacement gradient whose work with σ is σ_ij a_i,1 q,_j.
                let grown = near.map(|of| q.map(|q| of[0] * q));
                let of_stress = tensor(&self.field.stress(&grown));
                let factor: Gradient = std::array::from_fn(|i| {
                    let flux = s[i][0] * q[0] + s[i][1] * q[1];
                    [
                        of_stress[i][0] + flux - s[i][0] * q[0],
                        of_stress[i][1] - s[i][1] * q[0],
                    ]
                });
                point.add(1.0, &factor, found);
                let q_here: f64 = shape()
                    .zip(&cell.nodes)
                    .map(|(n, node)| n * node.q[radius])
                    .sum();
                let of_initial = point.initial.dot(&(strain(&grown) - q[0] * near_strain));
                let of_slope = q_here * near_strain.dot(&point.initial_slope);
                found.constant += point.at.weight * (of_initial - of_slope);
            }
        }
    }
}

fn tensor(stress: &Vector3<f64>) -> Gradient {
    [[stress[0], stress[2]], [stress[2], stress[1]]]
}

#[cfg(test)]
mod tests;
