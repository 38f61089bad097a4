//! Scenes without equilibrium, and scenes at the limit of equilibrium.

use contact_dd_partition::model::Model;

use crate::support::blocks::Blocks;
use crate::support::close::close;
use crate::support::statics::reaction;

use super::*;

const ROCK: &str = "
plane = 'strain'
materials.rock = {young = 20e9, poisson = 0.22}
";

/// A unit square under its weight, with `rest` appended to its scene.
fn square(force: [f64; 2], rest: &str) -> Model {
    let [x, y] = force;
    let text = format!(
        "{ROCK}
        bodies.block = {{material = 'rock', body_force = [{x}, {y}]}}
        {rest}"
    );
    let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [8, 8]);
    model(&text, blocks.mesh)
}

/// A contact of the square with an obstacle.
fn obstacle(name: &str, side: &str, obstacle: &str) -> String {
    format!(
        "[[contact]]
        name = '{name}'
        sides = ['block {side}']
        obstacle = {{{obstacle}}}\n"
    )
}

fn ground() -> String {
    obstacle("ground", "bottom", "point = [0, 0], normal = [0, 1]")
}

/// Three blocks on top of each other, each loaded by its weight and the next one, with non-matching meshes.
pub fn uneven() -> Model {
    let mut blocks = Blocks::new();
    let mut text = ROCK.to_owned();
    for (i, (name, n)) in [("low", 11), ("middle", 5), ("high", 8)]
        .into_iter()
        .enumerate()
    {
        let (x, y) = (0.3 * i as f64, i as f64);
        blocks = blocks.rectangle(name, [x, x + 2.0], [y, y + 1.0], [n, 4]);
        text += &format!("bodies.{name} = {{material = 'rock', body_force = [0, -25e3]}}\n");
    }
    for [upper, lower] in [["high", "middle"], ["middle", "low"]] {
        text += &format!(
            "[[bilateral]]
            on = '{upper} left'
            [[contact]]
            name = 'below {upper}'
            sides = ['{upper} bottom', '{lower} top']\n"
        );
    }
    text += "[[displacement]]\non = 'low bottom'\nx = 0.0\ny = 0.0\n";
    model(&text, blocks.mesh)
}

/// Three blocks in a row, the last one with a traction on its right, and the first one held on its left by a rigid wall
/// or by supports.
pub fn row(traction: [f64; 2], wall: bool) -> Model {
    let mut blocks = Blocks::new();
    let mut text = ROCK.to_owned();
    for name in ["first", "second", "third"] {
        text += &format!("bodies.{name}.material = 'rock'\n");
    }
    for (i, name) in ["first", "second", "third"].into_iter().enumerate() {
        let x = i as f64;
        blocks = blocks.rectangle(name, [x, x + 1.0], [0.0, 1.0], [4, 4]);
    }
    text += &match wall {
        true => obstacle("wall", "left", "point = [0, 0], normal = [1, 0]")
            .replace("block left", "first left"),
        false => "[[displacement]]\non = 'first left'\nx = 0.0\ny = 0.0\n".to_owned(),
    };
    let [x, y] = traction;
    text += &format!(
        "[[contact]]
        name = 'first joint'
        sides = ['first right', 'second left']
        [[contact]]
        name = 'second joint'
        sides = ['second right', 'third left']
        [[traction]]
        on = 'third right'
        value = [{x}, {y}]"
    );
    model(&text, blocks.mesh)
}

/// A block that falls 0.3 m and may slide after landing.
pub fn fallen() -> Model {
    let text = obstacle("ground", "bottom", "point = [0, -0.3], normal = [0, 1]");
    square([0.0, -25e3], &text)
}

/// Two blocks on three circles each, where every node of the blocks may touch several circles.
pub fn on_circles() -> Model {
    let mut blocks = Blocks::new();
    let mut text = ROCK.to_owned();
    for (name, x) in [("first", 0.0), ("second", 3.0)] {
        blocks = blocks.rectangle(name, [x, x + 2.0], [0.0, 1.0], [9, 5]);
        text += &format!("bodies.{name} = {{material = 'rock', body_force = [-2e3, -25e3]}}\n");
    }
    for (name, x) in [("first", 0.0), ("second", 3.0)] {
        for at in [0.3, 1.1, 1.8] {
            let circle = format!("center = [{}, -1], radius = 1", x + at);
            let contact = obstacle(&format!("{name} at {at}"), "bottom", &circle);
            text += &contact.replace("block bottom", &format!("{name} bottom"));
        }
    }
    model(&text, blocks.mesh)
}

/// A body that its load moves ends with 4, its name and its motion.
pub fn no_rest(trials: &mut Trials) {
    let down = [0.0, -25e3];
    let incline = obstacle("incline", "bottom", "point = [0, 0], normal = [-1, 10]");
    let lifted = "[[traction]]\non = 'block left'\nvalue = [0.0, 20e3]\n";
    let circle = obstacle("circle", "bottom", "center = [0.45, -1], radius = 1");
    // The walls of a groove that widens to the right.
    let wedge = obstacle("low", "bottom", "point = [0, 0], normal = [-1, 5]")
        + &obstacle("high", "top", "point = [0, 1], normal = [-1, -5]");
    let corner = ground() + &obstacle("wall", "left", "point = [0, 0], normal = [1, 0]");
    type Make = Box<dyn Fn() -> Model + Send + Sync>;
    let squares =
        |force: [f64; 2], rest: String| -> Make { Box::new(move || square(force, &rest)) };
    let scenes: [(&str, Make, [&str; 2]); 7] = [
        (
            "sliding_down_an_incline",
            squares(down, incline),
            ["'block'", "translation along ("],
        ),
        (
            "toppling_over_its_edge",
            squares(down, ground() + lifted),
            ["'block'", "rotation about ("],
        ),
        (
            "off_balance_on_a_circle",
            squares(down, circle),
            ["'block'", "is under-constrained"],
        ),
        (
            "squeezed_out_of_a_wedge",
            squares([-1e3, 0.0], wedge),
            ["'block'", "translation along (-1.0000, 0.0000)"],
        ),
        (
            "pushed_away_from_all_its_contacts",
            squares([3e3, 4e3], corner),
            ["'block'", "translation along (0.6000, 0.8000)"],
        ),
        (
            "the_last_of_a_row_pulled_away",
            Box::new(|| row([1e6, 0.0], false)),
            ["'third'", "translation along (1.0000, 0.0000)"],
        ),
        (
            "the_last_of_a_row_pulled_aside",
            Box::new(|| row([-1e6, 1e3], false)),
            ["'third'", "translation along (0.0000, 1.0000)"],
        ),
    ];
    for (name, make, words) in scenes {
        trials.on_all_ranks(&format!("no_rest::{name}"), move |ranks| {
            let case = Case::of(&make(), 4);
            failed_once(&case.run_on(ranks, &[]), 4, &words);
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}

/// Scenes just within the limit of equilibrium are solved.
pub fn just_rest(trials: &mut Trials) {
    type Make = fn() -> Model;
    let scenes: [(&str, Make, [f64; 3]); 3] = [
        // ∫ 3e3 (6 x − 2) dx = 3e3, and its moment is the same: the resultant passes through the lower right corner.
        (
            "on_its_edge",
            || {
                let load = "[[pressure]]\non = 'block top'\nvalue = '3e3*(6*x - 2)'\n";
                square([0.0, 0.0], &(ground() + load))
            },
            [0.0, 3e3, 3e3],
        ),
        (
            "on_top_of_a_circle",
            || {
                let circle = "center = [0.5, -1], radius = 1";
                square([0.0, -25e3], &obstacle("ground", "bottom", circle))
            },
            [0.0, 25e3, 12.5e3],
        ),
        (
            "on_an_incline_against_a_stop",
            || {
                let incline = obstacle("incline", "bottom", "point = [0, 0], normal = [1, 4]");
                let stop = obstacle("stop", "right", "point = [1, 0], normal = [-1, 0]");
                square([0.0, -25e3], &(incline + &stop))
            },
            [0.0, 25e3, 12.5e3],
        ),
    ];
    for (name, make, expected) in scenes {
        trials.on_all_ranks(&format!("just_rest::{name}"), move |ranks| {
            let case = Case::of(&make(), 1);
            let ended = case.run_on(ranks, &[]);
            assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
            let solution = Solution::read(&case.result());
            solution.check_certificate();
            let found = reaction(solution.points());
            for (found, expected) in found.into_iter().zip(expected) {
                close(found, expected, 1e-6);
            }
        });
    }
}
