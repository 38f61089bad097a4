//! Linear and quadratic triangles and quadrilaterals, uniform and mixed, with straight and curved edges.

use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{Blocks, jittered, joined};
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{BODIES, JOINT, LOAD, SUPPORTS, model, two_block_scene, two_blocks};
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::{SORTS, Sort, sort};

/// Two blocks that meet in an inclined line, in irregular cells; inner edges of quadratic cells are curved, those on
/// the contact and on the outline straight.
fn inclined_blocks(sort: Sort) -> Mesh {
    let blocks = Blocks::new()
        .quadrilateral(
            "lower",
            [[0.0, 0.0], [2.0, 0.0], [2.0, 1.2], [0.0, 0.8]],
            [5, 3],
        )
        .quadrilateral(
            "upper",
            [[0.0, 0.8], [2.0, 1.2], [2.0, 2.0], [0.0, 2.0]],
            [5, 4],
        );
    jittered(sort.of(&jittered(blocks.mesh, 0.04, 11)), 0.015, 12)
}

const COMPRESSION: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.25}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
[[bilateral]]
on = ['lower left', 'upper left']
[[pressure]]
on = ['upper top', 'lower right', 'upper right']
value = 1e6
[[contact]]
name = 'joint'
sides = ['lower top', 'upper bottom']
[[contact]]
name = 'floor'
sides = ['lower bottom']
obstacle = {point = [0, 0], normal = [0, 1]}
";

#[test]
fn uniform_compression_goes_through_a_contact_of_any_cells() {
    let (p, young, poisson) = (1e6, 20e9, 0.25);
    let strain = -p * (1.0 + poisson) * (1.0 - 2.0 * poisson) / young;
    for sort in SORTS {
        let model = model(COMPRESSION, inclined_blocks(sort));
        for count in [2, 3, 6] {
            let solution = solve(&model, count);
            for (tag, x) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                let u = solution.displacement[tag];
                (0..2).for_each(|i| close(u[i], strain * x[i], 1e-12 * strain.abs() * 2.0));
            }
            let uniform = [-p, -p, -2.0 * poisson * p, 0.0, 0.0, 0.0];
            solution.check_stress(uniform, 1e-10 * p);
            solution.check_pressure(p, 1e-10 * p);
            let count = if sort.is_quadratic { 11 } else { 6 };
            for contact in ["joint", "floor"] {
                let points = &solution.contacts[contact];
                assert_eq!(points.len(), count, "{}", sort.name);
            }
        }
    }
}

/// Recovery patches extend across Γ, also where it meets the boundary.
#[test]
fn recovered_stress_and_estimate_are_the_same_in_any_number_of_subdomains() {
    for sort in SORTS {
        let mesh = jittered(sort.of(&two_blocks().mesh), 0.008, 5);
        let model = model(&two_block_scene(), mesh);
        let [few, many] = [2, 23].map(|count| solve(&model, count));
        let error = |of: &Solution| of.report["error_estimate"]["error"].as_f64().unwrap();
        close(error(&many), error(&few), 1e-8 * error(&few));
        let stresses = few.nodal_stress.values().flatten();
        let largest = stresses.fold(0.0_f64, |m, s| m.max(s.abs()));
        for (tag, stress) in &few.nodal_stress {
            for (a, b) in stress.iter().zip(&many.nodal_stress[tag]) {
                close(*a, *b, 1e-8 * largest);
            }
        }
    }
}

/// The two blocks in few irregular cells with curved inner edges.
fn small_blocks(sort: Sort) -> Mesh {
    let blocks = Blocks::new()
        .rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 3])
        .rectangle("upper", [0.5, 1.5], [1.0, 2.0], [4, 4]);
    jittered(sort.of(&blocks.mesh), 0.015, 5)
}

#[test]
fn joints_of_any_cells_are_the_monolithic_solution() {
    for sort in SORTS {
        let model = model(&two_block_scene(), small_blocks(sort));
        let reference = Monolithic::new(&model);
        for count in [2, 7] {
            let solution = solve(&model, count);
            compare(&model, &reference, &solution);
            assert!(0 < solution.closed() && solution.closed() < solution.points().count());
        }
    }
}

/// The result contains the types of its cells.
#[test]
fn results_name_the_types_of_their_cells() {
    let mesh = small_blocks(sort("triangle6, quad8 and quad9"));
    let model = model(&two_block_scene(), mesh);
    let mut expected: Vec<u8> = model
        .mesh
        .cells
        .iter()
        .map(|(kind, _)| kind.vtk())
        .collect();
    expected.sort_unstable();
    assert_eq!([expected[0], expected[expected.len() - 1]], [22, 28]);
    for count in [2, 5] {
        let mut types = solve(&model, count).types;
        types.sort_unstable();
        assert_eq!(types, expected);
    }
}

#[test]
fn rows_of_other_cells_than_a_bodys_own_pass_through_the_same_joint() {
    // Quadratic triangles below, quadrilaterals of nine nodes above.
    let lower = Blocks::new().rectangle("lower", [0.0, 2.0], [0.0, 1.0], [8, 4]);
    let upper = Blocks::new().rectangle("upper", [0.5, 1.5], [1.0, 2.0], [4, 4]);
    let mesh = joined(
        sort("triangle6").of(&lower.mesh),
        sort("quad9").of(&upper.mesh),
    );
    let model = model(&format!("{BODIES}{SUPPORTS}{LOAD}{JOINT}"), mesh);
    compare(&model, &Monolithic::new(&model), &solve(&model, 4));
}
