//! A lining with friction that is put into a tunnel after the ground has moved, and carries nothing at first.

use std::f64::consts::TAU;

use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{Blocks, glued, joined};
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::Case;

/// A ring between two radii, whose bottom is its inner side.
fn ring(name: &str, [inner, outer]: [f64; 2], n: [usize; 2]) -> Mesh {
    let blocks = Blocks::new().mapped(name, n, |[s, t]| {
        let (sin, cos) = (-TAU * s).sin_cos();
        let radius = inner + (outer - inner) * t;
        [radius * cos, radius * sin]
    });
    glued(blocks.mesh, |_| true)
}

#[test]
fn a_lining_without_load_stays_where_it_is_put() {
    let mesh = joined(
        ring("rock", [1.0, 5.0], [32, 8]),
        ring("lining", [0.85, 1.0], [32, 2]),
    );
    let lining = mesh.groups["lining"].members.iter();
    let nodes: Vec<u32> = lining
        .flat_map(|&cell| mesh.cells.nodes_of(cell as usize).to_vec())
        .collect();
    let text = "plane = 'strain'
        materials.rock = {young = 5e9, poisson = 0.25}
        materials.concrete = {young = 30e9, poisson = 0.2}
        bodies.rock.material = 'rock'
        bodies.lining.material = 'concrete'
        [[displacement]]
        on = 'rock top'
        x = 0
        y = 0
        [[pressure]]
        on = 'rock bottom'
        value = '-1e6*(1+0.3*x)'
        [[contact]]
        name = 'wall'
        sides = ['lining top', 'rock bottom']
        friction = 0.4
        [[step]]
        [[step]]
        add = 'lining'
        [[step]]
        scale = 1.3";
    let model = model(text, mesh);
    let case = Case::of(&model, 3);
    for ranks in 1..=3 {
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        let steps = Solution::steps(&case.result());
        let moved = |solution: &Solution| {
            let tags = nodes
                .iter()
                .map(|&node| model.mesh.node_tags[node as usize]);
            let all = tags.flat_map(|tag| solution.displacement[&tag]);
            all.fold(0.0, |most: f64, u| most.max(u.abs()))
        };
        assert!(moved(&steps[1]) <= 1e-12 * steps[1].largest_displacement());
        for point in steps[1].points() {
            let slip = point
                .slip
                .iter()
                .fold(0.0, |most: f64, w| most.max(w.abs()));
            assert!(slip <= 1e-12 * steps[1].largest_displacement());
        }
        assert!(moved(&steps[2]) > 0.05 * steps[2].largest_displacement());
        std::fs::remove_file(case.result()).unwrap();
    }
}
