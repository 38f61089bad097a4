//! Load steps on the mesh.

use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;
use contact_dd_partition::mesh::Group;
use contact_dd_partition::model::Model;

/// A block that is held at its bottom and loaded in every way.
fn model(steps: &str) -> Result<Model, String> {
    let text = format!(
        "bodies.b = {{material = 'steel', body_force = [0, -5]}}
        [[displacement]]
        on = 'b bottom'
        x = 0.25
        y = 'x'
        [[pressure]]
        on = 'b top'
        value = 3
        [[traction]]
        on = 'b right'
        value = [2, 'y']
        {steps}"
    );
    let blocks = Blocks::new().block("b", [0.0, 2.0], [0.0, 1.0], [4, 3]);
    blocks.model(&text)
}

/// The sum of the forces of step k.
fn resultant(model: &Model, k: usize) -> [f64; 2] {
    let forces = model.steps[k].forces.iter();
    forces.fold([0.0; 2], |[x, y], f| [x + f[0], y + f[1]])
}

#[track_caller]
fn same(found: [f64; 2], expected: [f64; 2]) {
    for (a, b) in found.into_iter().zip(expected) {
        close(a, b, 1e-13);
    }
}

#[test]
fn factors_scale_each_kind_of_load() {
    let steps = "
        [[step]]
        [[step]]
        name = 'twice'
        scale = 2
        [[step]]
        scale = { body_force = 3, pressure = -1, traction = 0.5, displacement = '1/2' }";
    let model = model(steps).unwrap();
    let names: Vec<&str> = model.steps.iter().map(|step| step.name.as_str()).collect();
    assert_eq!(names, ["1", "twice", "3"]);
    same(resultant(&model, 0), [2.0, -10.0 - 6.0 + 0.5]);
    same(resultant(&model, 1), [4.0, -20.0 - 12.0 + 1.0]);
    same(resultant(&model, 2), [1.0, -30.0 + 6.0 + 0.25]);
    for (i, support) in model.supports.iter().enumerate() {
        let values = model
            .steps
            .iter()
            .map(|step| step.supports[i] / support.value);
        if support.value != 0.0 {
            assert_eq!(values.collect::<Vec<_>>(), [1.0, 2.0, 0.5]);
        }
    }
    let first: Vec<[f64; 3]> = model.forces.iter().map(|&(_, force)| force).collect();
    assert_eq!(first, model.steps[0].forces);
}

#[test]
fn what_a_step_gives_stands_in_the_place_of_the_scenes_loads() {
    let steps = "
        [[step]]
        pressure = []
        body_force = { b = ['1', 0] }
        [[step]]
        traction = []
        [[step.pressure]]
        on = 'b left'
        value = 7
        [[step.displacement]]
        on = 'b bottom'
        x = -1
        y = 0.5";
    let model = model(steps).unwrap();
    same(resultant(&model, 0), [2.0 + 2.0, 0.5]);
    same(resultant(&model, 1), [7.0, -10.0]);
    for (i, support) in model.supports.iter().enumerate() {
        let expected = if support.direction[0] == 1.0 {
            -1.0
        } else {
            0.5
        };
        assert_eq!(model.steps[1].supports[i], expected);
    }
}

#[test]
fn steps_hold_the_same_nodes() {
    let mesh = model("").unwrap().mesh;
    let at = |x: f64, y: f64| {
        let place = mesh
            .points
            .iter()
            .position(|p| (p[0] - x).hypot(p[1] - y) < 1e-9);
        mesh.node_tags[place.unwrap()]
    };
    for (displacement, node) in [
        ("on = 'b top'\nx = 0\ny = 0", at(0.0, 0.0)),
        ("on = 'b bottom'\nx = 0", at(0.0, 0.0)),
        (
            "on = ['b bottom', 'b left']\nx = 0\ny = 0",
            at(0.0, 1.0 / 3.0),
        ),
    ] {
        let steps = format!("[[step]]\n[[step]]\n[[step.displacement]]\n{displacement}");
        let refused = model(&steps).unwrap_err();
        let start = format!("step[2].displacement: node {node} isn't held in the same directions");
        assert!(refused.starts_with(&start), "{refused}");
    }
}

/// Two blocks that share a side, and one beside them.
fn three_blocks(steps: &str) -> Result<Model, String> {
    let text = format!(
        "bodies.b = {{material = 'steel', body_force = [0, -5]}}
        bodies.c = {{material = 'steel', body_force = [0, -7], initial_stress = [1, 2, 3, 4]}}
        bodies.d = {{material = 'steel', body_force = [0, -9]}}
        [[displacement]]
        on = ['b and c bottom', 'd bottom']
        x = 0.25
        y = 'x'
        [[contact]]
        name = 'joint'
        sides = ['d left', 'b and c right']
        {steps}"
    );
    let mut blocks = Blocks::new()
        .block("b and c", [0.0, 2.0], [0.0, 1.0], [4, 2])
        .block("d", [2.0, 3.0], [0.0, 1.0], [2, 2]);
    let Blocks { mesh } = &mut blocks;
    let is_left = |&cell: &u32| {
        let mut nodes = mesh.cells.nodes_of(cell as usize).iter();
        nodes.all(|&node| mesh.points[node as usize][0] <= 1.0)
    };
    let both = mesh.groups["b and c"].members.clone();
    let (b, c) = both.into_iter().partition(is_left);
    for (name, members) in [("b", b), ("c", c)] {
        mesh.groups.insert(name.into(), Group { dim: 2, members });
    }
    blocks.model(&text)
}

#[test]
fn nothing_acts_on_what_is_not_there() {
    let model =
        three_blocks("[[step]]\nadd = 'd'\n[[step]]\nremove = ['b', 'c', 'joint']").unwrap();
    let absent = |k: usize| {
        let step = &model.steps[k];
        (&step.absent_bodies[..], &step.absent_contacts[..])
    };
    assert_eq!(absent(0), (&[][..], &[][..]));
    assert_eq!(absent(1), (&[0, 1][..], &[0][..]));
    same(resultant(&model, 1), [0.0, -9.0]);
    let is_of_d = |node: u32| model.mesh.points[node as usize][0] >= 2.0;
    let tags = |cell: usize| model.mesh.cells.nodes_of(cell).to_vec();
    let of_d: Vec<u32> = (0..model.mesh.cells.len())
        .filter(|&cell| model.cell_body[cell] == 2)
        .flat_map(tags)
        .collect();
    for (support, value) in model.supports.iter().zip(&model.steps[1].supports) {
        let is_there = is_of_d(support.node) && of_d.contains(&support.node);
        assert_eq!(*value, if is_there { support.value } else { 0.0 });
    }
    assert!(
        model.steps[0]
            .initial_stress
            .cells
            .iter()
            .any(|s| *s != [0.0; 6])
    );
    assert!(
        model.steps[1]
            .initial_stress
            .cells
            .iter()
            .all(|s| *s == [0.0; 6])
    );
}

#[test]
fn what_comes_or_goes_has_its_nodes_to_itself() {
    let refused = three_blocks("[[step]]\n[[step]]\nremove = 'c'").unwrap_err();
    says(
        &refused,
        "step[2]: the bodies 'c' and 'b' share nodes, such as",
    );
}

#[test]
fn a_wrong_place_in_a_step_is_named() {
    let refused = model("[[step]]\n[[step.pressure]]\non = 'b tpo'\nvalue = 1").unwrap_err();
    says(&refused, "step[1].pressure[1] on 'b tpo'");
}

#[test]
fn sides_that_only_a_later_step_pushes_into_each_other_are_refused() {
    let blocks = Blocks::new()
        .block("low", [0.0, 2.0], [0.0, 1.0], [4, 3])
        .block("high", [0.0, 2.0], [1.5, 2.5], [4, 3]);
    let held = |y: f64| {
        format!(
            "[[step.displacement]]
            on = 'low top'
            x = 0
            y = {y}
            [[step.displacement]]
            on = 'high bottom'
            x = 0
            y = 0"
        )
    };
    let scene = |y: f64| {
        let text = format!(
            "[[contact]]
            name = 'joint'
            sides = ['low top', 'high bottom']
            [[step]]
            {}
            [[step]]
            {}",
            held(0.0),
            held(y)
        );
        blocks.model(&text)
    };
    assert_eq!(scene(0.5).unwrap().contacts[0].points.len(), 0);
    let refused = scene(0.6).unwrap_err();
    says(
        &refused,
        "close the gap of 0.5 m by 0.6 m; expected no penetration",
    );
}

#[test]
fn a_group_that_only_a_step_loads_must_not_lose_facets() {
    let mut blocks = Blocks::new()
        .block("b", [0.0, 2.0], [0.0, 1.0], [4, 3])
        .block("spare", [2.0, 4.0], [0.0, 1.0], [4, 3]);
    let spare = blocks.mesh.groups["spare top"].members.clone();
    let top = blocks.mesh.groups.get_mut("b top").unwrap();
    top.members.extend(spare);
    let condition = |kind: &str| match kind {
        "displacement" => "x = 0",
        "traction" => "value = [1, 0]",
        _ => "value = 1",
    };
    for kind in ["displacement", "traction", "pressure"] {
        let text = format!(
            "bodies.b = {{material = 'steel'}}
            [[displacement]]
            on = 'b top'
            x = 0
            [[step]]
            [[step.{kind}]]
            on = 'b top'
            {}",
            condition(kind)
        );
        let only_in_step = text.replacen("'b top'", "'b bottom'", 1);
        for text in [text, only_in_step] {
            let refused = blocks.model(&text).unwrap_err();
            assert!(
                refused.starts_with("group 'b top': the facet of nodes")
                    && refused.contains("belongs to no body; the group 'spare' isn't among"),
                "{refused}"
            );
        }
    }
}
