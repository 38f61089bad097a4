//! Load steps on several ranks.

use crate::support::blocks::Blocks;

use super::*;

/// The two blocks with loads that open and close their joint.
pub fn two_blocks_in_steps() -> Model {
    posed_in_steps(&two_block_scene())
}

/// The two blocks with friction in their joint, in these load steps.
pub fn two_blocks_with_friction() -> Model {
    posed_in_steps(&rubbing())
}

/// The two blocks with friction in quadratic cells: the lower block has 1122 dofs.
pub fn two_fine_blocks_with_friction() -> Model {
    let mesh = sort("quad9").of(&two_blocks().mesh);
    model(&format!("{}{STEPS}", rubbing()), mesh)
}

/// The two blocks with friction, unloaded in the middle step.
pub fn two_blocks_unloaded() -> Model {
    let steps = "[[step]]\n[[step]]\nscale = 0\n[[step]]\n";
    model(&format!("{}{steps}", rubbing()), two_blocks().mesh)
}

/// The scene of the two blocks with friction in their joint.
fn rubbing() -> String {
    let scene = two_block_scene();
    assert!(scene.contains("[[contact]]\n"));
    scene.replacen("[[contact]]\n", "[[contact]]\nfriction = '0.1+0.2*x'\n", 1)
}

/// The two blocks with friction, and another block that is placed on the upper one after the first step, and removed
/// after the second.
pub fn two_blocks_in_stages() -> Model {
    let scene = two_block_scene().replacen("[[contact]]\n", "[[contact]]\nfriction = 0.1\n", 1);
    let other = "
        bodies.other = {material = 'rock', body_force = [0.0, -1e6]}
        [[contact]]
        name = 'on top'
        sides = ['other bottom', 'upper top']
        friction = 0.3
        [[displacement]]
        on = 'other top'
        x = 1e-6
        [[step]]
        [[step]]
        add = 'other'
        [[step]]
        remove = 'other'";
    let (bodies, rest) = other.split_once("[[contact]]").unwrap();
    let scene = scene.replacen(BODIES, &format!("{BODIES}{bodies}"), 1);
    let blocks = two_blocks().rectangle("other", [0.6, 1.4], [2.0, 2.5], [4, 4]);
    model(&format!("{scene}[[contact]]{rest}"), blocks.mesh)
}

/// Two solids, the upper one of which is moved back and forth on the lower one.
pub fn two_solids_with_friction() -> Model {
    let block = |name, z| {
        solid(
            name,
            Hexahedron8,
            [3, 3, 2],
            between([0.0, 0.0, z], [1.0, 1.0, z + 0.5]),
        )
    };
    let mut text = "materials.rock = {young = 20e9, poisson = 0.2}
        bodies.lower.material = 'rock'
        bodies.upper.material = 'rock'
        [[contact]]
        name = 'joint'
        sides = ['upper z0', 'lower z1']
        gap = 0.0
        friction = 0.2\n"
        .to_owned();
    for [x, y] in [[1e-4, 0.0], [1e-4, 1e-4], [-1e-4, 0.5e-4]] {
        text += &format!(
            "[[step]]
            [[step.displacement]]
            on = 'lower z0'
            x = 0
            y = 0
            z = 0
            [[step.displacement]]
            on = 'upper z1'
            x = {x:e}
            y = {y:e}
            z = -1e-4\n"
        );
    }
    model(&text, joined(block("lower", 0.0), block("upper", 0.5)))
}

fn posed_in_steps(scene: &str) -> Model {
    model(&format!("{scene}{STEPS}"), two_blocks().mesh)
}

/// Three load steps of the two blocks.
const STEPS: &str = "
    [[step]]
    scale = 0.5
    [[step]]
    [[step.pressure]]
    on = 'upper top'
    value = '1e6*(0.1+1.9*x)'
    [[step]]
    scale = { pressure = 2, displacement = 3 }
    body_force = { upper = [0.0, -1e6] }";

/// A step without equilibrium ends the run before anything is solved, and the message names the step.
pub fn no_equilibrium(trials: &mut Trials) {
    trials.on_all_ranks("steps::lifted", |ranks| {
        let lift =
            "[[step]]\n[[step]]\nname = 'lift'\n[[step.pressure]]\non = 'upper top'\nvalue = -1e6";
        let scene = format!("{}{lift}", two_block_scene());
        let case = Case::of(&model(&scene, two_blocks().mesh), 6);
        let words = ["step 'lift'", "'upper' is under-constrained"];
        failed_once(&case.run_on(ranks, &[]), 4, &words);
        assert_eq!(case.files(), ["problem.h5"]);
    });
}

/// A step in which supports and obstacles leave no admissible position of a node is refused by name, whichever it is.
pub fn squeezed(trials: &mut Trials) {
    let factors = [("first", [1, 0]), ("last", [0, 1])];
    for (name, [first, last]) in factors {
        trials.on_all_ranks(&format!("steps::squeezed_in_the_{name}"), move |ranks| {
            let scene = format!(
                "plane = 'strain'
                materials.rock = {{young = 20e9, poisson = 0.22}}
                bodies.block = {{material = 'rock', body_force = [0, -25e3]}}
                [[displacement]]
                on = 'block left'
                x = -0.01
                [[contact]]
                name = 'ground'
                sides = ['block bottom']
                obstacle = {{point = [0, 0], normal = [0, 1]}}
                [[contact]]
                name = 'slope'
                sides = ['block left']
                obstacle = {{point = [0, 0], normal = [1, -1]}}
                gap = 0
                [[step]]
                name = 'first'
                scale = {{displacement = {first}}}
                [[step]]
                name = 'last'
                scale = {{displacement = {last}}}"
            );
            let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 1.0], [8, 8]);
            let case = Case::of(&model(&scene, blocks.mesh), 4);
            let step = format!("step '{name}': contact 'ground' and 'slope': supports");
            failed_once(
                &case.run_on(ranks, &[]),
                2,
                &[&step, "contradict each other"],
            );
            assert_eq!(case.files(), ["problem.h5"]);
        });
    }
}

/// A step that doesn't converge is marked, and the next ones are solved all the same.
pub fn not_converged(trials: &mut Trials) {
    trials.on_all_ranks("steps::not_converged", |ranks| {
        let case = Case::of(&two_blocks_in_steps(), 6);
        let ended = case.run_on(ranks, &["--max-sweeps", "0"]);
        assert_eq!(ended.code(), 3, "{}{}", ended.stdout, ended.stderr);
        let steps = Solution::steps(&case.result());
        let [error] = ended.errors()[..] else {
            panic!("{}", ended.stderr);
        };
        let mut named = 0;
        for (k, step) in (1..).zip(&steps) {
            let is_named = error.contains(&format!("step '{k}': "));
            assert_eq!(
                step.report["status"] == "not_converged",
                is_named,
                "{error}"
            );
            named += usize::from(is_named);
        }
        assert!(named > 1, "{error}");
    });
}
