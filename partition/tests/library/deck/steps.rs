//! Steps: conditions that continue, conditions that are replaced, and amplitudes.

use super::{means, scene, step};
use contact_dd_partition::scene::Scene;

const FIRST: &str = "*DLOAD\nUpper, P2, 10.\n*CLOAD\nTop, 1, 1.";

#[test]
fn loads_go_on_until_they_are_replaced() {
    let steps = [
        step(FIRST),
        step("*DLOAD\nUpper, P2, 20."),
        step("*CLOAD, OP=NEW\nTop, 2, 3."),
        step("*DLOAD, OP=NEW"),
    ];
    let pressure = |value: &str| format!("{{ on = 'pressure 1', value = {value} }}");
    let force = |each: &str| format!("{{ on = 'Top', each = {each} }}");
    let held = "{ on = 'Bottom', x = 0.0, y = 0.0, z = 0.0 }";
    let of_step = |time: usize, pressure: &str, force: &str| {
        format!(
            "[[step]]\ntime = {time}\npressure = [{pressure}]\nforce = [{force}]\ndisplacement = [{held}]\n"
        )
    };
    let (first, second) = (pressure("10.0"), pressure("20.0"));
    let (along_x, along_y) = (force("[1.0, 0.0, 0.0]"), force("[0.0, 3.0, 0.0]"));
    let keys = format!(
        "pressure = [{first}]\nforce = [{along_x}]\n{}{}{}{}",
        of_step(1, &first, &along_x),
        of_step(2, &second, &along_x),
        of_step(3, &second, &along_y),
        of_step(4, "", &along_y),
    );
    means(&steps.concat(), &keys);
}

/// The value of the pressure at the end of each step.
fn pressures(scene: &Scene) -> Vec<f64> {
    let of_step = scene.step.iter().map(|step| {
        let first = step.pressure.as_ref().and_then(|list| list.first());
        first.map_or(0.0, |load| load.value.at([0.0; 3]).unwrap())
    });
    of_step.collect()
}

#[test]
fn an_amplitude_counts_at_the_end_of_the_step() {
    let amplitudes = "*AMPLITUDE, NAME=Own\n0., 0., 2., 1.\n*AMPLITUDE, NAME=Whole, TIME=TOTAL TIME\n0., 0., 4., 2.\n";
    for (amplitude, expected) in [("Own", [0.5, 0.5, 5.0]), ("Whole", [0.5, 1.5, 5.0])] {
        let steps = format!(
            "*STEP\n*STATIC\n0.1, 1.\n*DLOAD, AMPLITUDE={amplitude}\nUpper, P2, 1.\n*END STEP\n\
             *STEP\n*STATIC\n0.1, 2.\n*END STEP\n\
             *STEP\n*STATIC\n*DLOAD\nUpper, P2, 5.\n*END STEP\n"
        );
        let scene = scene(&format!("{amplitudes}{steps}"));
        assert_eq!(pressures(&scene), expected, "{amplitude}");
        let times: Vec<_> = scene.step.iter().map(|step| step.time).collect();
        assert_eq!(times, [Some(1.0), Some(3.0), Some(4.0)]);
    }
}

#[test]
fn temperatures_count_from_those_at_the_beginning() {
    let initial = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n15, 20.\nTop, 20.\n11, 20.\n12, 20.\n13, 20.\n14, 20.\n";
    let hot = "*NSET, NSET=Hot\nTop, 11, 12, 13, 14\n";
    let steps = [step("*TEMPERATURE\nHot, 70."), step("*TEMPERATURE, OP=NEW")];
    let scene = scene(&format!("{hot}{initial}{}", steps.concat()));
    assert_eq!(scene.bodies["Lower"].thermal, None);
    let thermal = scene.bodies["Upper"].thermal.as_ref().unwrap();
    assert_eq!(thermal.expansion.0, 1.2e-5);
    let warmth: Vec<f64> = (scene.step.iter())
        .map(|step| step.temperature["Upper"].at([0.0; 3]).unwrap())
        .collect();
    assert_eq!(warmth, [50.0, 0.0]);
}

#[test]
fn loads_of_several_directions_add_up_and_in_a_later_step_the_same_direction_is_replaced() {
    let steps = [
        step(
            "*DLOAD\nUpper, BX, 1.\nUpper, GRAV, 1e9, 0., 0., -1.\nUpper, GRAV, 1e9, 0., 1., 0.\n*DSLOAD\nHigh, TRVEC, 2., 1., 0., 0.",
        ),
        step(
            "*DLOAD\nUpper, GRAV, 2e9, 1., 0., 0.\nUpper, GRAV, 3e9, 0., 2., 0.\n*DSLOAD\nHigh, TRVEC, 3., 0., 1., 0.",
        ),
    ];
    let scene = scene(&steps.concat());
    let weight = 1e9 * 7.8e-9;
    let forces: Vec<[f64; 3]> = (scene.step.iter())
        .map(|step| step.body_force["Upper"].at([0.0; 3]).unwrap())
        .collect();
    assert_eq!(
        forces,
        [
            [1.0, weight, -weight],
            [1.0 + 2.0 * weight, 3e9 * 7.8e-9, -weight]
        ]
    );
    let tractions = scene.step.iter().map(|step| {
        let list = step.traction.as_ref().unwrap();
        let values = list.iter().map(|load| load.value.at([0.0; 3]).unwrap());
        values.collect::<Vec<_>>()
    });
    assert_eq!(
        tractions.collect::<Vec<_>>(),
        [[[2.0, 0.0, 0.0]], [[0.0, 3.0, 0.0]]]
    );
}
