//! The rigid way to rest, taken out of the problem before it is solved and added to its solution.

use std::collections::BTreeMap;

use contact_dd_partition::element::geometry::{dot, length};

use crate::context::Context;
use crate::context::Loads;
use crate::fem::owned::OwnedBlock;
use crate::rigid::survey::Survey;

/// What is left of a length after a motion, relative to both, that is round-off: a body is stiff
/// enough to make forces of it.
const ROUND_OFF: f64 = 1e-14;

/// What acts on the blocks once the bodies' descent is taken out of gaps and supports.
pub fn without_descent(context: &Context<'_>, mut loads: Loads, survey: &Survey) -> Loads {
    if survey.longest_descent() == 0.0 {
        return loads;
    }
    let dim = context.catalog.dim;
    for (b, loads) in &mut loads {
        let Some(OwnedBlock { block, points }) = context.blocks.get(b) else {
            continue;
        };
        let moved = |node: u32| {
            let node = node as usize;
            moved(
                survey,
                dim,
                block.bodies[node] as usize,
                &block.points[node],
            )
        };
        for (point, gap) in points.iter().zip(&mut loads.gaps) {
            for (node, row) in point.row() {
                reduce(gap, &row, &moved(node));
            }
        }
        for support in &mut loads.supports {
            reduce(&mut support.value, &support.direction, &moved(support.node));
        }
    }
    loads
}

/// Takes the part of a motion along `row` out of a length.
fn reduce(whole: &mut f64, row: &[f64; 3], moved: &[f64; 3]) {
    let given = whole.abs() + length(*row) * length(*moved);
    *whole -= dot(*row, *moved);
    if whole.abs() <= ROUND_OFF * given {
        *whole = 0.0;
    }
}

/// The displacement of every block, node by node: that of its solution and the bodies' descent.
pub fn with_descent<'a>(
    context: &Context<'_>,
    solutions: impl Iterator<Item = (usize, &'a [f64])>,
    survey: &Survey,
) -> BTreeMap<usize, Vec<f64>> {
    let (dim, stays) = (context.catalog.dim, survey.longest_descent() == 0.0);
    let of_block = |(b, u): (usize, &[f64])| {
        let block = &context.blocks.get(&b)?.block;
        let mut u = u.to_vec();
        if stays {
            return Some((b, u));
        }
        let nodes = block.points.iter().zip(&block.bodies);
        for ((x, &body), u) in nodes.zip(u.chunks_exact_mut(dim)) {
            let moved = moved(survey, dim, body as usize, x);
            u.iter_mut().zip(moved).for_each(|(u, m)| *u += m);
        }
        Some((b, u))
    };
    solutions.filter_map(of_block).collect()
}

fn moved(survey: &Survey, dim: usize, body: usize, x: &[f64; 3]) -> [f64; 3] {
    survey.frames[body].displacement(dim, x, &survey.descent[body])
}
