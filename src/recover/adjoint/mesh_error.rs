//! The error of the mesh in a quantity, by the solution w of its transposed problem (dual-weighted residuals; Becker
//! and Rannacher, Acta Numerica 10, 2001).
//!
//! ```text
//! J(u) − J(u_h) = a(u − u_h, w − w_h) ≈ ∫ (σ*(u_h) − σ(u_h)) C⁻¹ (σ*(w_h) − σ(w_h)) dx
//! ```
//!
//! with σ* the stress recovered from σ, as in the estimate of the energy's error (Ródenas, González-Estrada and others,
//! Int. J. Numer. Methods Engrg 101, 2015). As recovery is linear, it follows from the errors E of two states: 4 α a =
//! E(u + α w) − E(u − α w). The energy ½ a(u, u) isn't linear: with w for its derivative at u_h, ½ E(u) is subtracted.
//! Under loads alone w is u and half of the product is left; under gaps and prescribed displacements alone w is 0. At
//! the edges of contact both parts are singular, and cancel: where what gaps add to half of the product is a small part
//! of that, it is noise of these edges, and left out.
//!
//! The estimate lacks the violation of constraints between nodes, the place of the edges of contact, and the change of
//! the quantity's own weights with the mesh. Its bar allows for them. Weights of stresses that vary from cell to cell,
//! as those around a crack tip, make σ(w) as rough as they are: recovery can't estimate its error there.

use contact_dd_partition::element::ElementKind;
use contact_dd_partition::id::{BlockId, OnBlocks};
use contact_dd_partition::problem::Catalog;
use contact_dd_partition::quantity::QuantityKind;

use super::contact_edges::edges;
use super::functional::Functional;
use super::held_ends::HeldEnds;
use super::solved::Solved;
use super::transposed::Transposed;
use crate::context::Context;
use crate::recover::BlockSolution;
use crate::recover::stresses::{Stress, stresses};

/// Share of the error's own energy in the error of an energy.
const OF_ENERGY: f64 = 0.5;
/// What gaps add to the error of an energy, relative to that of loads, below which it is left out.
const OF_GAPS: f64 = 0.25;

/// What linear triangles and tetrahedra, and other linear cells, have as an error relative to its estimate at most, as
/// recovery sees a part of it only where stresses are unbounded, or cells few; in place of `OF_ESTIMATE`.
const OF_TRIANGLES: f64 = 1.75;
const OF_TETRAHEDRA: f64 = 3.0;
const OF_LINEAR: f64 = 1.6;
/// The bar relative to the estimate; to the sum of the sizes of its contributions, which may cancel by chance; and to
/// the products at the edges of contact. The values fit the comparisons with fine meshes in docs/accuracy.md.
const OF_ESTIMATE: f64 = 1.5;
const OF_SIZES: f64 = 0.75;
const OF_EDGES: f64 = 0.1;
/// The bar relative to what forces lack at supports, in addition to its part of the estimate.
const OF_LACK: f64 = 0.5;
/// What a bar is longer by where the nodes of contacts don't match.
const NOT_MATCHING: f64 = 1.5;
/// The least bar relative to the value, for round-off.
const ROUND_OFF: f64 = 1e-9;

/// The estimated error of a quantity: its value less the exact one.
#[derive(Debug, Default)]
pub struct MeshError {
    /// The total error; on the root.
    pub error: f64,
    /// The bar: the size of what the error may be; on the root.
    pub bar: f64,
    /// The contributions of the cells of every block of this rank.
    pub of_cells: OnBlocks<Vec<f64>>,
}

impl MeshError {
    /// The error of a quantity whose transposed problem is solved; `None` without stresses, where nothing changes the
    /// quantity, and for the pressure of a single point or a quantity of a crack tip. Collective.
    pub fn new(
        solved: Solved<'_>,
        (functional, held_ends): (&Functional, &HeldEnds),
        of: &Transposed,
    ) -> Option<Self> {
        let context = &solved.fixed.context;
        let quantity = &context.catalog.quantities[functional.number];
        let has_estimate = match quantity.kind {
            QuantityKind::LargestPressure => quantity.length > 0.0,
            QuantityKind::OpeningIntensity
            | QuantityKind::SlidingIntensity
            | QuantityKind::EnergyReleaseRate => false,
            _ => true,
        };
        let own = solved.solution.stress.as_ref().filter(|_| has_estimate)?;
        // As of the force of a contact that is open on this mesh.
        let w = of.discrete.blocks.values().flat_map(|of_block| &of_block.u);
        let has_weights = context.comm.largest(w) > 0.0;
        if !has_weights && quantity.kind != QuantityKind::Energy {
            return None;
        }
        let mut of_cells = products(solved, of);
        (of_cells.values_mut().flatten()).for_each(|error| *error = -*error);
        let (mut error, mut sizes) = sums(context, &of_cells);
        let mut most = error.abs();
        if quantity.kind == QuantityKind::Energy {
            let of_loads = scaled(&of_cells, OF_ENERGY);
            for (b, errors) in &mut of_cells {
                let own = own.get(b).into_iter().flat_map(|of_block| &of_block.errors);
                (errors.iter_mut().zip(own))
                    .for_each(|(error, own)| *error += OF_ENERGY * own.error);
            }
            (error, sizes) = sums(context, &of_cells);
            most = error.abs();
            let (by_loads, sizes_by_loads) = sums(context, &of_loads);
            let is_noise = (error - by_loads).abs() < OF_GAPS * by_loads.abs();
            if context.comm.decide(is_noise) {
                (error, sizes, of_cells) = (by_loads, sizes.max(sizes_by_loads), of_loads);
            }
        }
        let lack = held_ends.lack(solved, functional);
        error -= lack;
        let of_estimate = of_estimate(context);
        let least = (of_estimate * most.max(error.abs())).max(OF_SIZES * sizes);
        let matching = match nodes_match(context.catalog) {
            true => 1.0,
            false => NOT_MATCHING,
        };
        Some(Self {
            error,
            bar: matching * (least + OF_EDGES * edges(solved, of))
                + OF_LACK * lack.abs()
                + functional.beside
                + ROUND_OFF * functional.value.abs(),
            of_cells,
        })
    }
}

/// The bar relative to the estimate: the largest for any cell. Collective.
fn of_estimate(context: &Context<'_>) -> f64 {
    let cells = context.blocks.values().flat_map(|block| block.cells());
    let factors = cells.map(|cell| match cell.kind {
        ElementKind::Triangle3 => OF_TRIANGLES,
        ElementKind::Tetrahedron4 => OF_TETRAHEDRA,
        kind if kind.is_linear() => OF_LINEAR,
        _ => OF_ESTIMATE,
    });
    let own = factors.fold(OF_ESTIMATE, f64::max);
    context.comm.largest([&own])
}

/// The sum of contributions, and that of their sizes; on the root. Collective.
fn sums(context: &Context<'_>, of_cells: &OnBlocks<Vec<f64>>) -> (f64, f64) {
    let (mut sum, mut sizes) = (0.0, 0.0);
    context.comm.gather(
        &context.plan.owners(),
        |b: BlockId| {
            let errors = of_cells.get(&b).into_iter().flatten();
            errors.fold([0.0; 2], |[sum, size], x| [sum + x, size + x.abs()])
        },
        |_, [of_block, size]: [f64; 2]| {
            sum += of_block;
            sizes += size;
        },
    );
    (sum, sizes)
}

fn scaled(of_cells: &OnBlocks<Vec<f64>>, factor: f64) -> OnBlocks<Vec<f64>> {
    let of_block = |(&b, errors): (&BlockId, &Vec<f64>)| {
        let errors = errors.iter().map(|error| factor * error);
        (b, errors.collect())
    };
    of_cells.iter().map(of_block).collect()
}

/// a(u − u_h, w − w_h) over every cell; 0 without w. Collective.
fn products(solved: Solved<'_>, of: &Transposed) -> OnBlocks<Vec<f64>> {
    let context = &solved.fixed.context;
    let (u, w) = (&solved.solution.discrete.blocks, &of.discrete.blocks);
    let size = |of: &OnBlocks<BlockSolution>| {
        let all = of.values().flat_map(|of_block| &of_block.u);
        context.comm.largest(all)
    };
    let scale = size(u) / size(w);
    if !scale.is_normal() {
        let cells = |(&b, _): (&BlockId, _)| {
            let count = context.blocks.get(&b)?.cells().count();
            Some((b, vec![0.0; count]))
        };
        return u.iter().filter_map(cells).collect();
    }
    let (ahead, back) = (both(solved, (u, w), scale), both(solved, (u, w), -scale));
    let of_block = |(&b, ahead): (&BlockId, &Stress)| {
        let cells = ahead.errors.iter().zip(&back.get(&b)?.errors);
        let products = cells.map(|(ahead, back)| (ahead.error - back.error) / (4.0 * scale));
        Some((b, products.collect()))
    };
    ahead.iter().filter_map(of_block).collect()
}

/// True if the points of all contacts are pairs of nodes, or nodes against an obstacle.
fn nodes_match(catalog: &Catalog) -> bool {
    (catalog.points.iter())
        .all(|point| point.entries.len() <= 2 || !point.axes.is_empty() || point.is_compliant())
}

/// The stresses of u + factor w. Collective.
fn both(
    solved: Solved<'_>,
    (u, w): (&OnBlocks<BlockSolution>, &OnBlocks<BlockSolution>),
    factor: f64,
) -> OnBlocks<Stress> {
    let of_block = |(&b, of_block): (&BlockId, &BlockSolution)| {
        let all = of_block.u.iter().zip(&w.get(&b)?.u);
        let u = all.map(|(u, w)| u + factor * w).collect();
        let pushes = Vec::new();
        Some((b, BlockSolution { u, pushes }))
    };
    let both = u.iter().filter_map(of_block).collect();
    let Context {
        comm,
        blocks,
        catalog,
        plan,
        ..
    } = solved.fixed.context;
    stresses(comm, blocks, &both, catalog, plan, solved.step)
}
