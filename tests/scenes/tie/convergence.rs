//! A cantilever of two tied halves with non-matching meshes, compared with a single mesh.

use crate::support::blocks::{Blocks, glued};
use crate::support::scenes::model;
use crate::support::solver::solve;
use crate::support::sorts::sort;

use super::{ROCK, WELD};

const LOADED: &str = "
[[displacement]]
on = ['lower left', 'upper left']
x = 0.0
y = 0.0
[[traction]]
on = ['lower right', 'upper right']
value = [0.0, -1e5]
";

/// The deflection at the middle of the end, with these numbers of cells along the halves.
fn deflection(cells: [usize; 2], kind: &str, tied: bool) -> f64 {
    let blocks = Blocks::new()
        .rectangle(
            "lower",
            [0.0, 4.0],
            [0.0, 0.5],
            [4 * cells[0], cells[0] / 2],
        )
        .rectangle(
            "upper",
            [0.0, 4.0],
            [0.5, 1.0],
            [4 * cells[1], cells[1] / 2],
        )
        .mesh;
    let (mesh, text) = match tied {
        true => (blocks, format!("{ROCK}{LOADED}{WELD}")),
        false => (
            glued(blocks, |[_, y, _]| (y - 0.5).abs() < 1e-9),
            format!("{ROCK}{LOADED}"),
        ),
    };
    let model = model(&text, sort(kind).of(&mesh));
    let solution = solve(&model, 4);
    let mut nodes = model.mesh.points.iter().zip(&model.mesh.node_tags);
    let is_end = |x: &[f64; 3]| (x[0] - 4.0).abs() < 1e-9 && (x[1] - 0.5).abs() < 1e-9;
    let (_, tag) = nodes.find(|(x, _)| is_end(x)).unwrap();
    solution.displacement[tag][1]
}

/// The deflection of tied halves converges at the order of a single mesh: with the square of the size of linear cells,
/// and faster with quadratic ones.
#[test]
fn tied_halves_of_a_cantilever_converge_as_one_mesh_does() {
    let exact = deflection([16, 16], "quad9", false);
    for (kind, order, sizes) in [
        ("quad4", 1.7, [[4, 6], [8, 12], [16, 24]]),
        ("quad8", 1.7, [[2, 4], [4, 8], [8, 16]]),
    ] {
        let errors = sizes.map(|cells| (deflection(cells, kind, true) / exact - 1.0).abs());
        for pair in errors.windows(2) {
            let found = (pair[0] / pair[1]).log2();
            assert!(found > order || pair[1] < 2e-5, "{kind}: {errors:?}");
        }
        // At most the error with both halves as coarse as the coarser one.
        let coarse = sizes.map(|[n, _]| (deflection([n, n], kind, false) / exact - 1.0).abs());
        for (tied, one) in errors.iter().zip(coarse) {
            assert!(
                *tied < 1.1 * one + 2e-5,
                "{kind}: {errors:?}, as one {coarse:?}"
            );
        }
    }
}
