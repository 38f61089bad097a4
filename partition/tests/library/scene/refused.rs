//! Keys and values of scene.toml that are refused.

use contact_dd_partition::scene::Scene;

use super::WHOLE;
use crate::says::says;
use crate::table::cases;

/// The message when `from` in the whole scene is replaced by `to`, with the start of the message.
fn printed(from: &str, to: &str) -> String {
    assert!(WHOLE.contains(from), "{from}");
    match Scene::parse(&WHOLE.replacen(from, to, 1)) {
        Ok(_) => format!("nothing about {to}"),
        Err(error) => error.to_string(),
    }
}

const KEYS: &str = r#"
title => titel
    line 1: … 'title'
[[pressure]] => [[presure]]
    line 28: … 'pressure'
young = => yuong =
    line 7: materials.granite … 'young'
out_of_plane => outofplane
    line 11: materials.wood … 'out_of_plane'
body_force => force
    line 15: bodies.block … 'body_force'
y = "1e => Y = "1e
    line 22: displacement[1] … 'y'
gap => gaps
    line 34: contact[1] 'left crack' … 'gap'
normal => norml
    line 41: contact[2] 'table'.obstacle … 'normal'
"strain" => "strian"
    line 3: plane … 'strain'
= "granite" => = "granit"
    line 14: bodies.block.material … 'granite'
"#;

#[test]
fn unknown_keys_are_named_with_line_and_nearest_known_key() {
    for (from, to, words) in cases(KEYS) {
        let message = printed(&from, &to);
        let (place, near) = words.split_once(" … ").unwrap();
        assert!(message.starts_with(place), "{message}");
        says(&message, &format!("did you mean {near}"));
    }
}

const VALUES: &str = r#"
5.2e9 => 0.0
    line 7: materials.granite.young: Young's modulus is 0
5.2e9 => 1e-300
    line 7: materials.granite.young: Young's modulus is 1e-300; expected more than 0
5.2e9 => -1
    line 7: materials.granite.young
5.2e9 => nan
    line 7: materials.granite.young: NaN isn't a finite number
5.2e9 => "1e9*x"
    line 7: materials.granite.young: '1e9*x' depends on the place
0.18 => 0.5
    line 8: materials.granite.poisson: Poisson's ratio is 0.5
0.18 => -1.0
    line 8: materials.granite.poisson
poisson = 0.18 =>
    line 6: materials.granite: the key 'poisson' is missing
young = 5.2e9\npoisson = 0.18 =>
    materials.granite: keys are missing
poisson = 0.18 => stiffness = [[1,0,0],[0,1,0],[0,0,1]]
    materials.granite: a material has either
poisson = 0.18 => poisson = 0.1\nout_of_plane = [0,0,0]
    'out_of_plane' belongs to 'stiffness'
[2, 5, 0] => [3, 5, 0]
    line 10: materials.wood.stiffness: the stiffness isn't symmetric
[10, 2, 0] => [0.5, 2, 0]
    line 10: materials.wood.stiffness: the stiffness isn't positive definite
[10, 2, 0],  =>
    line 10: materials.wood.stiffness
-25e3 => inf
    line 15: bodies.block.body_force[2]: inf isn't a finite number
-25e3] => -25e3, 0]
    line 15: bodies.block.body_force: a plane scene has vectors of two components; where the mesh is one of space, 'plane' is left out
-25e3] => 1, 2, 3]
    line 15: bodies.block.body_force: a vector of 4
x = 0.0\n => z = 0.0\n
    line 21: displacement[1].z: a plane scene has no 'z'; where the mesh is one of space, 'plane' is left out
x = 0.0\ny = "1e-3*x"\n =>
    displacement[1]: it prescribes nothing
1e-3*x => 1e-3*r
    line 22: displacement[1].y: expression '1e-3*r', character 6: 'r' isn't known
1e-3*x => 1e-3*z
    line 22: displacement[1].y: expression '1e-3*z', character 6: 'z' isn't known
plane = "strain" => plane = "strain"\nunits = 'cm'
    line 4: units: unknown value 'cm'
1e-3*x => 1/0
    line 22: displacement[1].y: '1/0' is inf
on = "bottom" =>
    displacement[1]: the key 'on' is missing
["axis", "side"] => []
    line 24: bilateral[1].on: an empty list
["axis", "side"] => ['a', 'a']
    line 24: bilateral[1].on: 'a' stands here twice
["axis", "side"] => 7
    line 24: bilateral[1].on: it is the number 7; expected the name
0.6e7 => true
    line 30: pressure[1].value: it is true; expected a number or an expression
name = "left crack" => name = "a/b"
    line 32: contact[1].name: 'a/b' holds a '/'
name = "left crack" => name = ""
    line 32: contact[1].name: '' is empty
name = "left crack" => name = "."
    line 32: contact[1].name: '.' means
name = "left crack" =>
    contact[1]: the key 'name' is missing
name = "table" => name = "left crack"
    line 38: contact[2].name: contact[1] has the name 'left crack' already
["base"] => ["base", "top"]
    contact[2] 'table': the number of 'sides' is 2; expected 2, or 1 beside an 'obstacle'
["base"] => []
    contact[2] 'table': the number of 'sides' is 0
obstacle = { point = [0.0, 0.0], normal = [0.0, 2.0] } =>
    contact[2] 'table': the number of 'sides' is 1; expected 2
"more" => "left crack lower"
    contact[1] 'left crack': 'left crack lower' is on both 'sides'
gap = 0.0 => pairing = 'by the way'
    line 34: contact[1] 'left crack'.pairing: unknown value 'by the way'. Known here: nodes, mortar
gap = 0.0 => pairing = 'motar'
    line 34: contact[1] 'left crack'.pairing: unknown value 'motar'; did you mean 'mortar'?
gap = 0.0 => gap = nan
    line 34: contact[1] 'left crack'.gap: NaN
friction = 0.6 => friction = -0.6
    line 35: contact[1] 'left crack'.friction: it is -0.6; expected 0 or more
friction = 0.6 => friction = inf
    line 35: contact[1] 'left crack'.friction: inf isn't a finite number
"1e5*y" => "-1e5"
    line 36: contact[1] 'left crack'.cohesion: it is -100000; expected 0 or more
"2e5" => nan
    line 40: contact[2] 'table'.tresca: NaN isn't a finite number
tresca = "2e5" => tresca = 2e5\nfriction = 0.5
    contact[2] 'table': 'friction' (Coulomb's) and 'tresca' (Tresca's) are both there
tresca = "2e5" => cohesion = 0
    contact[2] 'table': 'cohesion' stands beside 'friction', which is missing
normal = [0.0, 2.0] => normal = [0.0, 0]
    line 41: contact[2] 'table'.obstacle.normal: the zero vector
name = "table" => name = "table"\npairing = 'nodes'
    contact[2] 'table': 'pairing' is of two sides; expected none beside an 'obstacle'
sides = ["base"]\n =>
    contact[2] 'table': expected its two 'sides', or the bodies 'between' which it is
sides = ["base"] => between = "block"
    contact[2] 'table': 'between' is of bodies; expected no 'obstacle'
gap = 0.0 => between = "all"
    contact[1] 'left crack': 'between' finds the sides; expected no 'sides'
gap = 0.0 => within = 1
    contact[1] 'left crack': 'within' stands beside 'between', which is missing
gap = 0.0 => within = 0
    line 34: contact[1] 'left crack'.within: the distance is 0; expected more than 0
gap = 0.0 => adjust = -1
    line 34: contact[1] 'left crack'.adjust: the distance is -1; expected at least 0
gap = 0.0 => gap = 0.0\nadjust = 1
    contact[1] 'left crack': 'adjust' closes gaps of the mesh; expected no 'gap'
sides = ["left crack lower", ["left crack upper", "more"]] => between = ["block", "lft block"]
    line 33: contact[1] 'left crack'.between: there is no body 'lft block'; did you mean 'left block'?
sides = ["left crack lower", ["left crack upper", "more"]] => between = 7
    line 33: contact[1] 'left crack'.between: it is the number 7; expected the name
, normal = [0.0, 2.0] =>
    line 41: contact[2] 'table'.obstacle: expected 'point' and 'normal'
"2*pi" => 0
    line 45: contact[3] 'ring'.obstacle.radius: the radius is 0
mesh  = "block.msh" =>
    the key 'mesh' is missing
mesh  = "block.msh" =>
    line 6: the key 'mesh' is missing; expected mesh = "mesh.msh" above [materials.granite]
poisson = 0.18 => poisson = 0.18\nmesh = "block.msh"
    line 9: materials.granite.mesh: unknown key 'mesh', which isn't of a table but of the scene; expected mesh
poisson = 0.18 => poisson = 0.18\nmu = 0.3
    line 9: materials.granite.mu: unknown key 'mu'; friction is the key 'friction' of a [[contact]]
poisson = 0.18 => poisson = 0,18
    expected a decimal point: poisson = 0.18
poisson = 0.18 => poisson = "0,18"
    found ','; numbers have a decimal point
friction = 0.6 => mu = 0.6
    did you mean 'friction'?
mesh  = "block.msh" => mesh = ''
    line 2: mesh: expected the name of a file
young = 5.2e9 => young = 5.2e9\nyoung = 1
    line 8: duplicate key
[[traction]] => [[traction]
    line 25:
"#;

#[test]
fn values_that_cannot_be_are_refused_at_their_line_and_key() {
    for (from, to, expected) in cases(VALUES) {
        let message = printed(&from, &to);
        assert!(message.contains(&expected), "{to}: {message}");
    }
}

const TYPES: &str = r#"
title = "Loaded granite block with cracks" => title = 7
    line 1: title: it is the number 7; expected a text in quotes
mesh  = "block.msh" => mesh = 7
    line 2: mesh: it is the number 7; expected the name of a file in quotes
mesh  = "block.msh" => mesh = ["block.msh"]
    line 2: mesh: it is a list; expected the name of a file in quotes
plane = "strain" => plane = 2
    line 3: plane: expected a word in quotes
plane = "strain" => plane = "strain"\nlarge_strains = 1
    line 4: large_strains: it is the number 1; expected true or false
plane = "strain" => plane = "strain"\nsolver.max_sweeps = -1
    line 4: solver.max_sweeps: it is the number -1; expected a whole number, 0 or more
plane = "strain" => plane = "strain"\nsolver.max_sweeps = "many"
    line 4: solver.max_sweeps: it is the text "many"; expected a whole number, 0 or more
plane = "strain" => plane = "strain"\nsolver.tolerance = "small"
    line 4: solver.tolerance: it is the text "small"; expected a number
plane = "strain" => plane = "strain"\nsolver.method = 3
    line 4: solver.method: expected a word in quotes
out_of_plane = [1.0, 2.0, 0] => out_of_plane = 1
    line 11: materials.wood.out_of_plane: it is the number 1; expected a list
out_of_plane = [1.0, 2.0, 0] => out_of_plane = [1.0]
    line 11: materials.wood.out_of_plane: the number of entries is 1; expected 3
out_of_plane = [1.0, 2.0, 0] => out_of_plane = [1, 2, 3, 4]
    line 11: materials.wood.out_of_plane: the number of entries is 4; expected 3
material = "granite" => material = 1
    line 14: bodies.block.material: it is the number 1; expected a text in quotes
body_force = [0.0, -25e3] => body_force = -25e3
    line 15: bodies.block.body_force: it is the number -25000.0; expected a list
["axis", "side"] => ["axis", 7]
    line 24: bilateral[1].on[2]: it is the number 7; expected a text in quotes
sides = ["base"] => sides = "base"
    line 39: contact[2] 'table'.sides: it is the text "base"; expected a list
, normal = [0.0, 2.0] } => , normal = [0.0, 2.0], inside = "no" }
    line 41: contact[2] 'table'.obstacle.inside: it is the text "no"; expected true or false
gap = 0.0 => gap = [0.0]
    line 34: contact[1] 'left crack'.gap: it is a list; expected a number or an expression
[[bilateral]] => [[spring]]\nbetween = ["a", "b", "c"]\naxial = 1\n[[bilateral]]
    line 24: spring[1].between: the number of entries is 3; expected 2
[[bilateral]] => [[equation]]\nterms = [{ at = "a", component = "x", factor = "one" }]\n[[bilateral]]
    line 24: equation[1].terms[1].factor: it is the text "one"; expected a number
"#;

#[test]
fn a_value_of_another_type_is_refused_in_plain_words_at_its_line_and_key() {
    for (from, to, expected) in cases(TYPES) {
        let message = printed(&from, &to);
        assert!(message.starts_with(&expected), "{to}: {message}");
    }
}

const STEPS: &str = r#"
time = "pi" => time = 0.5
    line 52: step[2].time: 0.5 comes after 0.5; expected times that ascend
time = "pi"\n =>
    line 51: step[2]: expected a 'time' in every step or in none
time = 0.5\n =>
    line 51: step[2].time: expected a 'time' in every step or in none
time = 0.5 => time = "x"
    line 48: step[1] 'first'.time: 'x' depends on the place
"first" => "a\tb"
    line 47: step[1].name: 'a\tb' holds a control character
scale = 2\n => scale = [2]\n
    line 53: step[2].scale
scale = 2\n => scale = inf\n
    line 53: step[2].scale: inf isn't a finite number
pressure = 0.25 => presure = 0.25
    line 49: step[1] 'first'.scale.presure: unknown key 'presure'; did you mean 'pressure'?
"left block" = [1 => "lft block" = [1
    line 50: step[1] 'first'.body_force."lft block": there is no body 'lft block'; did you mean 'left block'?
"left block" = [1,  => "left block" = [1, 2,
    line 50: step[1] 'first'.body_force."left block": a plane scene
value = [0, 1] => value = [0, 1, 2]
    step[2].traction[1].value: a plane scene
x = 1\ny = 2 => x = 1\nz = 2
    step[2].displacement[1].z: a plane scene has no 'z'
pressure = [] => add = "ring"\nremove = "ring"
    step[2].remove: 'ring' is added and removed
pressure = [] => remove = "left blok"
    line 54: step[2].remove: there is no body or contact 'left blok'; did you mean 'left block'?
pressure = [] => remove = ["block", "left block"]
    line 54: step[2].remove: no body is left
time = 0.5 => time = 0.5\nadd = "table"\n[[step]]\ntime = 0.6\nadd = "table"
    line 52: step[2].add: 'table' is there already
time = 0.5 => time = 0.5\nremove = "table"\n[[step]]\ntime = 0.6\nremove = "table"
    line 52: step[2].remove: 'table' isn't there
pressure = [] => presure = []
    step[2].presure: unknown key 'presure'; did you mean 'pressure'?
"#;

#[test]
fn stress_and_heat_that_cannot_be_are_refused_at_their_key() {
    let body = "body_force = [0.0, -25e3]";
    for (key, expected) in [
        (
            "initial_stress = [0, 1, 2]",
            "line 15: bodies.block.initial_stress: expected 4 numbers, xx, yy, zz, xy",
        ),
        (
            "initial_stress = [0, 1, 2, 'z']",
            "bodies.block.initial_stress: expression 'z', character 1: 'z' isn't known in the plane",
        ),
        (
            "thermal = {expansion = 'x', temperature = 80}",
            "bodies.block.thermal.expansion: 'x' depends on the place",
        ),
        (
            "thermal = {expansion = 1e-5}",
            "the key 'temperature' is missing",
        ),
        (
            "thermal = {expansion = 1e-5, temperature = 'z'}",
            "bodies.block.thermal.temperature: expression 'z'",
        ),
    ] {
        let message = printed(body, key);
        assert!(message.contains(expected), "{key}: {message}");
    }
    let message = printed("pressure = []", "temperature = {block = 20}");
    let expected = "step[2].temperature.block: the body 'block' has no 'thermal', so no expansion";
    assert!(message.contains(expected), "{message}");
    let message = printed("pressure = []", "temperature = {blok = 20}");
    assert!(
        message.contains("there is no body 'blok'; did you mean 'block'?"),
        "{message}"
    );
}

#[test]
fn steps_that_cannot_be_are_refused_at_their_line_and_key() {
    for (from, to, expected) in cases(STEPS) {
        let message = printed(&from, &to);
        assert!(
            message.starts_with(&expected)
                || (!expected.starts_with("line") && message.contains(&expected)),
            "{message}\n{expected}"
        );
    }
}

#[test]
fn a_table_that_should_be_a_list_is_answered_with_double_brackets() {
    for (from, to, expected) in [
        (
            "[[pressure]]",
            "[pressure]",
            "line 28: pressure: it is a table; expected [[pressure]] in double",
        ),
        (
            "[[bilateral]]",
            "[[step]]\n[step.pressure]\non = 'top'\nvalue = 1\n[[bilateral]]",
            "; expected [[step.pressure]] in double",
        ),
    ] {
        says(&printed(from, to), expected);
    }
}

#[test]
fn what_is_no_toml_is_shown_with_advice() {
    for (from, to, expected) in [
        ("5.2e9", "5.2e9Pa", "a number has no unit: young = 5.2e9\n"),
        ("5.2e9", "\"5.2 GPa\"", "a number has no unit"),
        (
            "5.2e9",
            "5,2e9",
            "expected a decimal point: young = 5.2e9\n  |\n7 | young = 5,2e9\n  |",
        ),
        ("on = \"top\"", "on = top", "expected quotes: on = \"top\""),
    ] {
        let message = printed(from, to);
        assert!(message.starts_with("line "), "{message}");
        says(&message, expected);
    }
}
