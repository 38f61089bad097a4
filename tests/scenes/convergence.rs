//! Exact displacements, and orders of convergence of energy and stresses, in cells of all kinds.

use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::support::blocks::{Blocks, jittered, moved};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solution::Solution;
use crate::support::solver::solve;
use crate::support::sorts::{SORTS, Sort, sort};

/// A unit square of irregular cells, with curved inner edges where possible.
fn block(sort: Sort, n: usize) -> Mesh {
    let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [n, n]);
    moved(sort.of(&blocks.mesh), |[s, t]| {
        let bump = s * (1.0 - s) * t * (1.0 - t);
        [s + 0.9 * bump, t - 0.6 * bump]
    })
}

const STEEL: [f64; 2] = [200e9, 0.3];

/// A scene of the unit square with the displacement prescribed at its bottom and left side, and the loads of a
/// displacement field elsewhere: traction on the right and on top, and body force.
fn clamped(u: [&str; 2], right: [&str; 2], top: [&str; 2], body: [&str; 2]) -> String {
    let [young, poisson] = STEEL;
    format!(
        "plane = 'strain'
        materials.steel = {{young = {young}, poisson = {poisson}}}
        bodies.block = {{material = 'steel', body_force = ['{}', '{}']}}
        [[displacement]]
        on = ['block bottom', 'block left']
        x = '{}'
        y = '{}'
        [[traction]]
        on = 'block right'
        value = ['{}', '{}']
        [[traction]]
        on = 'block top'
        value = ['{}', '{}']
        ",
        body[0], body[1], u[0], u[1], right[0], right[1], top[0], top[1],
    )
}

/// λ and μ of [`STEEL`].
fn lame() -> [f64; 2] {
    let [young, poisson] = STEEL;
    [
        young * poisson / (1.0 + poisson) / (1.0 - 2.0 * poisson),
        young / 2.0 / (1.0 + poisson),
    ]
}

/// u = 1e-3·(x² + 2xy − y², 3x² − xy + 2y²), with ε = 1e-3·(2x + 2y, −x + 4y, γ), γ = 8x − 3y.
#[test]
fn quadratic_displacements_are_exact_in_quadratic_cells_with_straight_edges() {
    let [l, m] = lame().map(|c| 1e-3 * c);
    let trace = "(x + 6*y)";
    let xx = format!("{l}*{trace} + {}*(2*x + 2*y)", 2.0 * m);
    let yy = format!("{l}*{trace} + {}*(4*y - x)", 2.0 * m);
    let xy = format!("{m}*(8*x - 3*y)");
    // The body force is −div σ.
    let body = [
        format!("{}", -(l + 4.0 * m - 3.0 * m)),
        format!("{}", -(8.0 * m + 6.0 * l + 8.0 * m)),
    ];
    let text = clamped(
        ["1e-3*(x^2 + 2*x*y - y^2)", "1e-3*(3*x^2 - x*y + 2*y^2)"],
        [&xx, &xy],
        [&xy, &yy],
        [&body[0], &body[1]],
    );
    for name in ["triangle6", "quad8", "quad9", "triangle6, quad8 and quad9"] {
        // Quadrilaterals of eight nodes represent all quadratic fields on parallelograms only.
        let amount = if name.contains("quad8") { 0.0 } else { 0.03 };
        let linear = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [4, 4]);
        let model = model(&text, sort(name).of(&jittered(linear.mesh, amount, 3)));
        for count in [1, 3] {
            let solution = solve(&model, count);
            for (tag, &[x, y, _]) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                let [u, v, _] = solution.displacement[tag];
                close(u, 1e-3 * (x * x + 2.0 * x * y - y * y), 1e-14);
                close(v, 1e-3 * (3.0 * x * x - x * y + 2.0 * y * y), 1e-14);
            }
            if name == "triangle6" {
                for (tag, &[x, y, _]) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
                    let exact = l * (x + 6.0 * y) + 2.0 * m * (2.0 * x + 2.0 * y);
                    close(solution.nodal_stress[tag][0], exact, 1e-9 * l);
                }
            }
        }
    }
}

/// For u = v = 1e-3·sin(x)·sin(y): the relative error in the energy norm, the largest error of the stress at nodes, and
/// the ratio of the estimated to the true error. As only zero is prescribed, ‖u − u_h‖² = ‖u‖² − ‖u_h‖², and ‖u_h‖² is
/// the work of the loads.
fn errors(sort: Sort, n: usize) -> [f64; 3] {
    let [l, m] = lame().map(|c| 1e-3 * c);
    let (ux, uy) = ("cos(x)*sin(y)", "sin(x)*cos(y)");
    let xx = format!("{}*{ux} + {l}*{uy}", l + 2.0 * m);
    let yy = format!("{}*{uy} + {l}*{ux}", l + 2.0 * m);
    let xy = format!("{m}*({ux} + {uy})");
    // σ_xx,x + σ_xy,y = −(λ + 2μ + μ) s + (λ + μ) c, s = sin·sin, c = cos·cos.
    let body = format!("{}*sin(x)*sin(y) - {}*cos(x)*cos(y)", l + 3.0 * m, l + m);
    let text = clamped(["0", "0"], [&xx, &xy], [&xy, &yy], [&body, &body]);
    let model = model(&text, block(sort, n));
    let solution = solve(&model, 2);
    let work: f64 = (model.forces.iter())
        .map(|(node, force)| {
            let u = solution.displacement[&model.mesh.node_tags[*node as usize]];
            force[0] * u[0] + force[1] * u[1]
        })
        .sum();
    // ∫ (λ + 2μ)(ux² + uy²) + 2λ ux uy + μ (ux + uy)² over the unit square, ux and uy as above.
    let (s, c) = (0.5 - 0.25 * 2.0_f64.sin(), 0.5 + 0.25 * 2.0_f64.sin());
    let product = 0.25 * (1.0_f64.sin().powi(4));
    let exact = 1e-3 * ((l + 3.0 * m) * 2.0 * s * c + 2.0 * (l + m) * product);
    let of_stress = (model.mesh.node_tags.iter().zip(&model.mesh.points)).map(|(tag, at)| {
        let [sin, cos] = [[at[0].sin(), at[1].sin()], [at[0].cos(), at[1].cos()]];
        let (ux, uy) = (cos[0] * sin[1], sin[0] * cos[1]);
        let axial = l + 2.0 * m;
        let exact = [axial * ux + l * uy, axial * uy + l * ux, m * (ux + uy)];
        let found = solution.nodal_stress[tag];
        let error = [0, 1, 3]
            .into_iter()
            .zip(exact)
            .map(|(k, e)| (found[k] - e).abs());
        error.fold(0.0, f64::max)
    });
    let error = (exact - work).abs().sqrt();
    let estimate = &solution.report["error_estimate"];
    let number = |key: &str| estimate[key].as_f64().unwrap();
    close(number("energy_norm"), work.sqrt(), 1e-9 * work.sqrt());
    let relative = number("error") / work.sqrt();
    close(number("relative"), relative, 0.01 * relative);
    [
        error / exact.sqrt(),
        of_stress.fold(0.0, f64::max) / l,
        number("error") / error,
    ]
}

#[test]
fn energy_and_nodal_stresses_converge_with_the_order_of_the_cells() {
    for sort in SORTS {
        let [coarse, fine] = [4, 8].map(|n| errors(sort, n));
        let [energy, stress] = [0, 1].map(|k| (coarse[k] / fine[k]).log2());
        let order = if sort.is_quadratic { 2.0 } else { 1.0 };
        let at = format!("{}: {coarse:?}, {fine:?}", sort.name);
        assert!((energy - order).abs() < 0.15, "{at}, order {energy}");
        assert!(stress > order - 0.15, "{at}, order {stress}");
        for effectivity in [coarse[2], fine[2]] {
            assert!((0.9..1.15).contains(&effectivity), "{at}");
        }
    }
}

#[test]
fn a_block_free_of_load_stays_as_it_was_moved() {
    // A rigid-body motion prescribed at the bottom moves the whole body, without stress.
    let text = "plane = 'strain'
        materials.steel = {young = 200e9, poisson = 0.3}
        bodies.block.material = 'steel'
        [[displacement]]
        on = 'block bottom'
        x = '1e-3 - 2e-3*y'
        y = '-2e-3 + 2e-3*x'";
    for sort in SORTS {
        let model: Model = model(text, block(sort, 4));
        let solution: Solution = solve(&model, 3);
        for (tag, &[x, y, _]) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            let [u, v, _] = solution.displacement[tag];
            close(u, 1e-3 - 2e-3 * y, 1e-15);
            close(v, -2e-3 + 2e-3 * x, 1e-15);
        }
        for stress in solution.nodal_stress.values().flatten() {
            close(*stress, 0.0, 1e-3);
        }
    }
}
