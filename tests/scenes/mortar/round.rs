//! Round bodies: equilibrium and Lamé's solution.

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solver::solve;
use crate::support::statics::{area, reaction};

/// A disc of n × n cells; its sides are quarters of the circle.
fn disc(blocks: Blocks, name: &str, centre: [f64; 2], radius: f64, n: usize, turn: f64) -> Blocks {
    blocks.mapped(name, [n, n], |[s, t]| {
        let (u, v) = (2.0 * s - 1.0, 2.0 * t - 1.0);
        let out = f64::max(u.abs(), v.abs());
        let round = out / f64::hypot(u, v).max(1e-300);
        let stretch = radius * (1.0 - out * (1.0 - round));
        let (x, y) = (stretch * u, stretch * v);
        let (sin, cos) = turn.sin_cos();
        [centre[0] + cos * x - sin * y, centre[1] + sin * x + cos * y]
    })
}

#[test]
fn rollers_carry_each_other_as_statics_says() {
    let (radius, apart) = (1.0, 1.2);
    let height = f64::sqrt(4.0 * radius * radius - apart * apart);
    let mut blocks = Blocks::new();
    let mut text = "plane = 'strain'
        materials.steel = {young = 210e9, poisson = 0.3}\n"
        .to_owned();
    for (name, centre, n, turn) in [
        ("left", [-apart, 1.0], 12, 0.1),
        ("right", [apart, 1.0], 17, 0.2),
        ("top", [0.0, 1.0 + height], 14, 0.35),
    ] {
        blocks = disc(blocks, name, centre, radius, n, turn);
        text += &format!("bodies.{name} = {{material = 'steel', body_force = [0, -77e3]}}\n");
    }
    let outline = |name: &str| {
        ["bottom", "right", "top", "left"]
            .map(|s| format!("'{name} {s}'"))
            .join(", ")
    };
    for (name, a, b) in [("one", "left", "top"), ("two", "top", "right")] {
        text += &format!(
            "[[contact]]\nname = '{name}'\nsides = [[{}], [{}]]\n",
            outline(a),
            outline(b)
        );
    }
    for (body, name, point, normal) in [
        ("left", "floor left", [0.0, 0.0], [0.0, 1.0]),
        ("right", "floor right", [0.0, 0.0], [0.0, 1.0]),
        ("left", "wall left", [-apart - radius, 0.0], [1.0, 0.0]),
        ("right", "wall right", [apart + radius, 0.0], [-1.0, 0.0]),
    ] {
        text += &format!(
            "[[contact]]\nname = '{name}'\nsides = [[{}]]\nobstacle = {{point = {point:?}, normal = {normal:?}}}\n",
            outline(body)
        );
    }
    let weight = |name: &str| 77e3 * area(&blocks.mesh, name);
    let model = model(&text, blocks.mesh.clone());
    for count in [3, 8] {
        let solution = solve(&model, count);
        let on = |name: &str| reaction(&solution.contacts[name]);
        let ([x, y, _], [x_2, y_2, _]) = (on("one"), on("two"));
        let slack = 1e-10 * weight("top");
        close(x_2, x, slack);
        close(y_2 - y, weight("top"), slack);
        close(on("floor left")[1], weight("left") - y, slack);
        close(on("floor right")[1], weight("right") + y_2, slack);
        close(on("wall left")[0], -x, slack);
        close(on("wall right")[0], x, slack);
        // Two polygons press on each other along a line that is determined to within half a facet.
        let angle = f64::atan2(apart, height);
        close(f64::atan2(x, y).abs(), std::f64::consts::PI - angle, 0.06);
        close(f64::atan2(x_2, y_2).abs(), angle, 0.06);
    }
}

/// A ring of n cells around and 8 across, with its seam at an angle.
fn ring(blocks: Blocks, name: &str, radii: [f64; 2], n: usize, seam: f64) -> Blocks {
    blocks.mapped(name, [n, 8], |[s, t]| {
        let (sin, cos) = (seam - std::f64::consts::TAU * s).sin_cos();
        let radius = radii[0] + t * (radii[1] - radii[0]);
        [radius * cos, radius * sin]
    })
}

#[test]
fn shrunk_rings_press_on_each_other_as_lame_says_and_turn_freely() {
    let (young, poisson, interference) = (200.0, 0.3, 1e-3);
    let [a, b, c] = [1.0_f64, 2.0, 3.0].map(|r| r * r);
    let stiffness = young / (1.0 - poisson * poisson);
    let pressure = stiffness * interference / 2.0 * (b - a) * (c - b) / (2.0 * b * (c - a));
    // Odd numbers, so that no node lies on the other ring's seam.
    let blocks = ring(Blocks::new(), "inner", [1.0, 2.0], 75, 0.0);
    let blocks = ring(blocks, "outer", [2.0, 3.0], 91, std::f64::consts::PI);
    let mesh = blocks.glued(|_, y| y.abs() < 1e-9).mesh;
    // Facets of a finer side a resolve each kink of side b.
    for (sides, slack) in [
        ("'inner top', 'outer bottom'", 0.04),
        ("'outer bottom', 'inner top'", 0.1),
    ] {
        let text = format!(
            "plane = 'strain'
            materials.m = {{young = {young}, poisson = {poisson}}}
            bodies.inner.material = 'm'
            bodies.outer.material = 'm'
            [[contact]]
            name = 'fit'
            sides = [{sides}]
            gap = {}",
            -interference
        );
        let model = model(&text, mesh.clone());
        let solution = solve(&model, 4);
        for point in solution.points() {
            close(point.pressure, pressure, slack * pressure);
        }
        let size = solution.largest_displacement();
        for (tag, &[x, y, _]) in model.mesh.node_tags.iter().zip(&model.mesh.points) {
            let [u, v, _] = solution.displacement[tag];
            close((x * v - y * u) / x.hypot(y), 0.0, 0.01 * size);
        }
        // Three common motions and one relative motion.
        let warnings = solution.report["warnings"].as_array().unwrap();
        let free =
            "unconstrained rigid-body motion, not loaded: 4 rigid motions of 'inner', 'outer';";
        let mut texts = warnings.iter().filter_map(|warning| warning.as_str());
        assert!(texts.any(|text| text.starts_with(free)), "{warnings:#?}");
    }
}
