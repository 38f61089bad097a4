//! The condition number in the report.

use contact_dd_partition::model::Model;
use nalgebra::DMatrix;

use crate::support::assembled::Assembled;
use crate::support::blocks::Blocks;
use crate::support::scenes::model;
use crate::support::solver::solve;

/// λ_max / λ_min of the stiffness of a model without contact, scaled to a unit diagonal, on the dofs without supports,
/// which are along axes.
fn condition_number(model: &Model) -> f64 {
    let mut stiffness =
        DMatrix::<f64>::zeros(2 * model.mesh.points.len(), 2 * model.mesh.points.len());
    for t in Assembled::new(model).stiffness {
        stiffness[(t.row, t.col)] += t.val;
    }
    let held: Vec<usize> = (model.supports.iter())
        .map(|s| 2 * s.node as usize + usize::from(s.direction[0] == 0.0))
        .collect();
    let free: Vec<usize> = (0..stiffness.nrows())
        .filter(|dof| !held.contains(dof))
        .collect();
    let scaled = DMatrix::from_fn(free.len(), free.len(), |a, b| {
        let (i, j) = (free[a], free[b]);
        stiffness[(i, j)] / (stiffness[(i, i)] * stiffness[(j, j)]).sqrt()
    });
    let eigenvalues = scaled.symmetric_eigenvalues();
    eigenvalues.max() / eigenvalues.min()
}

#[test]
fn the_condition_number_is_estimated_to_within_a_small_factor() {
    for (length, soft) in [(2.0, 1.0), (30.0, 1.0), (2.0, 1e-4)] {
        let mesh = Blocks::new()
            .rectangle("beam", [0.0, length], [0.0, 1.0], [12, 4])
            .rectangle("end", [length, 1.25 * length], [0.0, 1.0], [3, 4])
            .glued(|_, _| true);
        let text = format!(
            "plane = 'strain'
            materials.steel = {{young = 210e9, poisson = 0.3}}
            materials.soft = {{young = {:e}, poisson = 0.3}}
            bodies.beam.material = 'steel'
            bodies.end.material = 'soft'
            displacement = [{{on = 'beam left', x = 0.0, y = 0.0}}]
            traction = [{{on = 'end right', value = [0.0, 1e6]}}]",
            210e9 * soft
        );
        let model = model(&text, mesh.mesh);
        let exact = condition_number(&model);
        for count in [2, 7] {
            let estimate = solve(&model, count).report["condition_number"]
                .as_f64()
                .unwrap();
            let ratio = estimate / exact;
            assert!((0.5..10.0).contains(&ratio), "{estimate:e} for {exact:e}");
        }
    }
}
