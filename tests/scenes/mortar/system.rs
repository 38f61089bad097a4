//! The solution agrees with that of a single system for the whole mesh.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::comparison::compare;
use crate::support::monolithic::Monolithic;
use crate::support::scenes::{model, two_block_scene, two_blocks};
use crate::support::solver::solve;
use crate::support::uneven::{block, materials};

/// Two blocks of different heights that open at one end, with side a above or below.
fn lifting(n: [usize; 2], young: [f64; 2], upside_down: bool, text: &str) -> Model {
    let blocks = block(Blocks::new(), "zero", [0.0, 2.0], [0.0, 1.0], [n[0], 4], 3);
    let blocks = block(blocks, "one", [0.4, 2.5], [1.0, 1.6], [n[1], 4], 4);
    model(&(scene(young, upside_down) + text), blocks.mesh)
}

fn scene(young: [f64; 2], upside_down: bool) -> String {
    let sides = match upside_down {
        true => "'zero top', 'one bottom'",
        false => "'one bottom', 'zero top'",
    };
    format!(
        "plane = 'strain'
        materials.m0 = {{young = {}, poisson = 0.3}}
        materials.m1 = {{young = {}, poisson = 0.22}}
        bodies.zero.material = 'm0'
        bodies.one.material = 'm1'
        [[displacement]]
        on = 'zero bottom'
        x = 0.0
        y = 0.0
        [[bilateral]]
        on = 'one left'
        [[pressure]]
        on = 'one top'
        value = '1e6*(1.6-x)'
        [[contact]]
        name = 'joint'
        sides = [{sides}]\n",
        young[0], young[1]
    )
}

#[test]
fn blocks_that_part_are_as_one_system_for_all_says() {
    for n in [[10, 7], [7, 10], [4, 15], [15, 4]] {
        for upside_down in [false, true] {
            let model = lifting(n, [20e9, 210e9], upside_down, "");
            let reference = Monolithic::new(&model);
            for count in [2, 6] {
                let solution = solve(&model, count);
                assert!(solution.closed() > 0 && solution.closed() < solution.points().count());
                compare(&model, &reference, &solution);
            }
        }
    }
}

#[test]
fn a_stiff_side_a_on_a_soft_side_b_keeps_the_certificate() {
    for young in [[1e6, 1e12], [1e12, 1e6]] {
        for upside_down in [false, true] {
            let model = lifting([9, 7], young, upside_down, "");
            let solution = solve(&model, 4);
            let forces: f64 = solution.points().map(|point| point.force).sum();
            let load = 1e6 * (1.6 * 2.1 - 0.5 * (2.5 * 2.5 - 0.4 * 0.4));
            close(forces, load, 1e-7 * load);
        }
    }
}

/// All of side a is prescribed: none of its unknowns can be eliminated for its constraints.
#[test]
fn a_side_a_that_is_held_presses_all_the_same() {
    for n in [[10, 7], [7, 10], [15, 4]] {
        let held = "[[displacement]]\non = 'zero top'\nx = 0.0\ny = '1e-5*x*x*x'\n";
        let model = lifting(n, [20e9, 210e9], true, held);
        let reference = Monolithic::new(&model);
        for count in [2, 5] {
            compare(&model, &reference, &solve(&model, count));
        }
    }
}

/// A base, two blocks on it that touch each other, and one on both of them; no two meshes match.
#[test]
fn four_blocks_with_nodes_in_several_contacts_are_as_one_system_for_all_says() {
    let blocks = block(Blocks::new(), "zero", [0.0, 4.0], [0.0, 1.0], [13, 4], 1);
    let blocks = block(blocks, "one", [0.0, 1.9], [1.0, 2.0], [5, 3], 2);
    let blocks = block(blocks, "two", [1.9, 4.0], [1.0, 2.0], [8, 5], 3);
    let blocks = block(blocks, "three", [0.3, 3.5], [2.0, 3.0], [7, 3], 4);
    let mesh = blocks.mesh;
    let base = materials(&["zero", "one", "two", "three"])
        + "[[displacement]]\non = 'zero bottom'\nx = 0.0\ny = 0.0\n\
           [[bilateral]]\non = 'one left'\n\
           [[displacement]]\non = 'three left'\nx = 0.0\n\
           [[pressure]]\non = 'three top'\nvalue = '1e6*(1+0.4*x)'\n\
           [[pressure]]\non = 'two right'\nvalue = 3e5\n";
    for turn in [false, true] {
        let contact = |name: &str, a: &str, b: &str| {
            let [a, b] = if turn { [b, a] } else { [a, b] };
            format!("[[contact]]\nname = '{name}'\nsides = ['{a}', '{b}']\n")
        };
        let text = base.clone()
            + &contact("1", "one bottom", "zero top")
            + &contact("2", "two bottom", "zero top")
            + &contact("3", "one right", "two left")
            + &contact("4", "three bottom", "one top")
            + &contact("5", "three bottom", "two top");
        let model = model(&text, mesh.clone());
        let reference = Monolithic::new(&model);
        for count in [4, 9] {
            let solution = solve(&model, count);
            assert!(
                solution
                    .contacts
                    .values()
                    .all(|points| points[0].tags[1] == -1)
            );
            compare(&model, &reference, &solution);
        }
    }
}

/// For matching nodes, both discretizations give the same solution.
#[test]
fn matching_meshes_need_no_mortar_and_lose_nothing_by_it() {
    let scene = two_block_scene();
    let by_nodes = solve(&model(&scene, two_blocks().mesh), 5);
    let text = scene + "pairing = 'mortar'\n";
    let by_mortar = solve(&model(&text, two_blocks().mesh), 5);
    let size = by_nodes.largest_displacement();
    for (tag, u) in &by_nodes.displacement {
        for (u, v) in u.iter().zip(by_mortar.displacement[tag]) {
            close(*u, v, 1e-11 * size);
        }
    }
    let slack = 1e-10 * by_nodes.largest_force();
    for (one, other) in by_nodes.points().zip(by_mortar.points()) {
        assert_eq!((one.tags[0], -1), (other.tags[0], other.tags[1]));
        close(one.force, other.force, slack);
    }
}
