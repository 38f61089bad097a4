//! Linear equations between displacements.

use contact_dd_partition::mesh::{Group, Mesh};

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::model;
use crate::support::solver::{Case, solve, solve_steps};

use super::ROCK;

/// A block beside another one, with points at corners.
fn mesh() -> Mesh {
    let mut mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 3])
        .rectangle("upper", [0.0, 1.0], [1.5, 2.5], [3, 4])
        .mesh;
    for (name, at) in [("A", [1.0, 1.0]), ("B", [0.0, 1.5]), ("C", [1.0, 2.5])] {
        let is_there = |x: &[f64; 3]| (x[0] - at[0]).abs() + (x[1] - at[1]).abs() < 1e-9;
        let node = mesh.points.iter().position(is_there).unwrap() as u32;
        mesh.groups.insert(
            name.into(),
            Group {
                dim: 0,
                members: vec![node],
            },
        );
    }
    mesh
}

const TEXT: &str = "
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[displacement]]
on = 'upper bottom'
y = 0.0
[[traction]]
on = 'upper top'
value = [1e6, 0.0]
[[equation]]
terms = [
    {at = 'A', component = 'x', factor = 1.0},
    {at = 'B', component = 'x', factor = -1.0},
]
[[equation]]
terms = [
    {at = 'A', component = 'y'},
    {at = 'C', component = 'x', factor = -2.0},
]
";

/// Equations between several components, of several bodies, are equivalent to Lagrange multipliers in the whole system.
#[test]
fn equations_are_what_lagrange_multipliers_make_of_the_whole_mesh() {
    let model = model(&format!("{ROCK}{TEXT}"), mesh());
    let node = |name: &str| model.mesh.groups[name].members[0] as usize;
    let [a, b, c] = ["A", "B", "C"].map(node);
    let mut free = model.clone();
    free.contacts.clear();
    let rows = vec![
        vec![(2 * a, 1.0), (2 * b, -1.0)],
        vec![(2 * a + 1, 1.0), (2 * c, -2.0)],
    ];
    let expected = Monolithic::with(&free, rows);
    for count in [2, 5] {
        let solution = solve(&model, count);
        let scale = solution.largest_displacement();
        for (u, v) in solution.dofs(&model).iter().zip(&expected.u) {
            close(*u, *v, 1e-11 * scale);
        }
    }
}

/// A value prescribes the sum, and the equation has the required force: a block stretched by its average displacement
/// has the solution of the corresponding pressure.
#[test]
fn a_value_prescribes_the_mean_of_a_side() {
    let mesh = Blocks::new()
        .rectangle("lower", [0.0, 1.0], [0.0, 1.0], [4, 3])
        .mesh;
    let drawn = 1e-4;
    let text = format!(
        "plane = 'stress'
materials.rock = {{young = 20e9, poisson = 0.0}}
bodies.lower.material = 'rock'
[[displacement]]
on = 'lower bottom'
x = 0.0
y = 0.0
[[equation]]
name = 'draw'
terms = [{{at = 'lower top', component = 'y', factor = 2.0}}]
value = {}
",
        2.0 * drawn
    );
    let model = model(&text, mesh);
    let solution = solve(&model, 3);
    let top = model.mesh.points.iter().zip(&model.mesh.node_tags);
    let top = top.filter(|(x, _)| (x[1] - 1.0).abs() < 1e-9);
    let (sum, count) = top.fold((0.0, 0), |(sum, n), (_, tag)| {
        (sum + solution.displacement[tag][1], n + 1)
    });
    close(sum / f64::from(count), drawn, 1e-13 * drawn);
    let force = solution.contacts["draw"][0].force;
    let reaction = solution.report["reactions"][0]["force"][1]
        .as_f64()
        .unwrap();
    close(2.0 * force, reaction, 1e-9 * reaction.abs());
}

#[test]
fn ranks_and_solvers_make_no_difference_to_equations() {
    let case = Case::in_clusters(&model(&format!("{ROCK}{TEXT}"), mesh()), 6, 3);
    case.solve(&[]);
    case.is_the_same_on_all_ranks_and_by_iteration(1e-9);
}

/// Every step has its own value, independent of the other steps.
#[test]
fn a_value_goes_with_the_steps() {
    let named = TEXT.replace(
        "terms = [\n    {at = 'A', component = 'y'}",
        "name = 'lever'\nterms = [\n    {at = 'A', component = 'y'}",
    );
    let values = [0.0, 3e-5, 3e-5, -1e-5];
    let given = [None, Some(3e-5), Some(3e-5), Some(-1e-5)];
    let step = |value: &Option<f64>| match value {
        Some(value) => format!("[[step]]\nequation.lever = {value:?}\n"),
        None => "[[step]]\n".into(),
    };
    let steps: String = given.iter().map(step).collect();
    let solutions = solve_steps(&model(&format!("{ROCK}{named}{steps}"), mesh()), 4);
    for (solution, value) in solutions.iter().zip(values) {
        let text = named.replace(
            "factor = -2.0},\n]",
            &format!("factor = -2.0}},\n]\nvalue = {value:?}"),
        );
        let expected = solve(&model(&format!("{ROCK}{text}"), mesh()), 4);
        let scale = expected.largest_displacement();
        for (tag, u) in &solution.displacement {
            let v = expected.displacement[tag];
            (0..2).for_each(|k| close(u[k], v[k], 1e-10 * scale));
        }
        let [found, other] = [solution, &expected].map(|of| of.contacts["lever"][0].force);
        close(found, other, 1e-9 * other.abs());
    }
}
