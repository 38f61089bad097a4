//! Decks as whole models: the scene and the mesh that they mean.

mod couplings;
mod cyclic;
mod laws;
mod lost;
mod parts;
mod pretensions;
mod prints;
mod refused;
mod springs;
mod steps;

use contact_dd_partition::deck::{self, Translation};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;
use contact_dd_partition::scene::number::Number;
use tempfile::TempDir;

/// Two cubes, one on the other, which share no node.
pub const CUBES: &str = "\
*NODE
 1, 0, 0, 0
 2, 1, 0, 0
 3, 1, 1, 0
 4, 0, 1, 0
 5, 0, 0, 1
 6, 1, 0, 1
 7, 1, 1, 1
 8, 0, 1, 1
11, 0, 0, 1
12, 1, 0, 1
13, 1, 1, 1
14, 0, 1, 1
15, 0, 0, 2
16, 1, 0, 2
17, 1, 1, 2
18, 0, 1, 2
*ELEMENT, TYPE=C3D8, ELSET=Lower
1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=Upper
2, 11, 12, 13, 14, 15, 16, 17, 18
*ELSET, ELSET=All
Lower, Upper
*NSET, NSET=Bottom
1, 2, 3, 4
*NSET, NSET=Top
15, 16, 17, 18
*SURFACE, NAME=Low, TYPE=ELEMENT
Lower, S2
*SURFACE, NAME=High, TYPE=ELEMENT
Upper, S1
*MATERIAL, NAME=Steel
*ELASTIC
210e3, 0.3
*DENSITY
7.8e-9
*EXPANSION
1.2e-5
";

/// Sections, contact and supports of the cubes.
pub const MODEL: &str = "\
*SOLID SECTION, ELSET=Lower, MATERIAL=STEEL
*SOLID SECTION, ELSET=Upper, MATERIAL=STEEL
*SURFACE INTERACTION, NAME=Dry
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
*FRICTION
0.2
*CONTACT PAIR, INTERACTION=Dry, TYPE=SURFACE TO SURFACE
High, Low
*BOUNDARY
Bottom, 1, 3
";

/// Part of the cubes' scene above its loads.
const SCENE: &str = "
mesh  = 'mesh.msh'
units = 'mm'
materials.Steel = { young = 210e3, poisson = 0.3 }
bodies.Lower = { material = 'Steel' }
bodies.Upper = { material = 'Steel' }
displacement = [{ on = 'Bottom', x = 0.0, y = 0.0, z = 0.0 }]
contact = [{ name = 'High on Low', sides = ['High', 'Low'], friction = 0.2 }]
";

/// Scene of a deck, or the reason for which it is refused.
pub fn read(deck: &str) -> Result<Translation, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("part.inp");
    std::fs::write(&path, deck).unwrap();
    let shown = format!("{}/", folder.path().display());
    deck::read(&path).map_err(|error| error.to_string().replace(&shown, ""))
}

/// The scene of the cubes with more blocks.
pub fn scene(more: &str) -> Scene {
    let translation = read(&format!("{CUBES}{MODEL}{more}")).unwrap();
    Scene::parse(&translation.scene)
        .unwrap_or_else(|error| panic!("{error}: {}", translation.scene))
}

/// A step of some blocks.
pub fn step(blocks: &str) -> String {
    format!("*STEP\n*STATIC\n{blocks}\n*END STEP\n")
}

/// Fails unless the cubes with some blocks mean the scene with some keys more.
#[track_caller]
pub fn means(more: &str, keys: &str) {
    let expected = Scene::parse(&format!("{SCENE}{keys}")).unwrap();
    assert_eq!(scene(more), expected, "{more}");
}

#[test]
fn a_deck_is_the_scene_that_says_the_same() {
    means(
        &step("*DLOAD\nUpper, P2, 10."),
        "pressure = [{ on = 'pressure 1', value = 10.0 }]",
    );
    means(
        &step("*CLOAD\nTop, 3, -2.5"),
        "force = [{ on = 'Top', each = [0.0, 0.0, -2.5] }]",
    );
    means(
        &step("*DSLOAD\nHigh, TRVEC, 2., 0., 3., 4."),
        "traction = [{ on = 'High', value = [0.0, 1.2, 1.6] }]",
    );
}

#[test]
fn loads_of_a_step_add_up_and_the_last_of_its_displacements_counts() {
    let scene = scene(&step(
        "*CLOAD\n17, 1, 1.\nTop, 1, 2.\n*BOUNDARY\n15, 1, 1, 5.\n15, 1, 1, 1e-3",
    ));
    let forces = (scene.force.iter()).map(|force| (force.on.to_string(), force.amount.clone()));
    let each = |force: &str| {
        let scene = format!("{SCENE}force = [{{ on = 'Top', each = {force} }}]");
        Scene::parse(&scene).unwrap().force[0].amount.clone()
    };
    assert_eq!(
        forces.collect::<Vec<_>>(),
        [
            ("'force 1'".to_owned(), each("[2.0, 0.0, 0.0]")),
            ("'force 2'".to_owned(), each("[3.0, 0.0, 0.0]")),
        ]
    );
    let held = &scene.displacement[1];
    assert_eq!(held.on.to_string(), "'support 1'");
    assert_eq!(held.components, [Some(Number::Constant(1e-3)), None, None]);
}

#[test]
fn the_groups_of_a_scene_hold_what_the_deck_loads() {
    let blocks = step("*DLOAD\n2, P2, 1.\n*CLOAD\n17, 1, 1.\n18, 1, 1.");
    let mesh = read(&format!("{CUBES}{MODEL}{blocks}")).unwrap().mesh;
    let nodes = |name: &str| {
        let group = &mesh.groups[name];
        let nodes = group.members.iter().flat_map(|&member| match group.dim {
            0 => vec![member],
            _ => mesh.facets.nodes_of(member as usize).to_vec(),
        });
        let mut tags: Vec<i64> = nodes.map(|node| mesh.node_tags[node as usize]).collect();
        tags.sort_unstable();
        tags
    };
    assert_eq!(nodes("pressure 1"), [15, 16, 17, 18]);
    assert_eq!(nodes("force 1"), [17, 18]);
    assert_eq!(nodes("Bottom"), [1, 2, 3, 4]);
}

#[test]
fn loads_on_some_elements_of_a_section_make_bodies_of_them() {
    let sections = MODEL.replacen("*SOLID SECTION, ELSET=Lower, MATERIAL=STEEL\n", "", 1);
    let sections = sections.replace("ELSET=Upper", "ELSET=All");
    let loads = step("*DLOAD\n2, GRAV, 9810., 0., 0., -2.");
    let translation = read(&format!("{CUBES}{sections}{loads}")).unwrap();
    let scene = Scene::parse(&translation.scene).unwrap();
    assert_eq!(scene.bodies.keys().collect::<Vec<_>>(), ["Lower", "Upper"]);
    assert_eq!(scene.bodies["Lower"].body_force, None);
    let force = scene.bodies["Upper"].body_force.as_ref().unwrap();
    assert_eq!(force.at([0.0; 3]).unwrap(), [0.0, 0.0, -9810.0 * 7.8e-9]);
}

#[test]
fn what_is_left_out_is_named_once() {
    let blocks = step("*NODE FILE, NSET=Top\nU\n*EL FILE\nS\n*DLOAD\nUpper, P2, 1.")
        .replace("STEP\n", "STEP, NLGEOM\n");
    let blocks = blocks.replace("END STEP, NLGEOM", "END STEP");
    let deck = format!("{CUBES}{MODEL}{blocks}")
        .replace("OVERCLOSURE=HARD", "OVERCLOSURE=EXPONENTIAL\n1e-3, 5.");
    let warnings = read(&deck).unwrap().mesh.warnings.join("\n");
    for expected in [
        "not needed, and left out: *EL FILE, *NODE FILE",
        "line 50: NLGEOM is left out",
        "line 42: the exponential law of contact (p0 = 5. at no clearance, 0 at 1e-3) is taken as hard contact",
    ] {
        assert!(warnings.contains(expected), "{expected}: {warnings}");
    }
    assert_eq!(warnings.lines().count(), 3, "{warnings}");
}

#[test]
fn linear_pressure_over_overclosure_is_a_stiffness() {
    let deck = format!("{CUBES}{MODEL}{}", step("*DLOAD\nUpper, P2, 1."));
    let of = |law: &str| read(&deck.replace("OVERCLOSURE=HARD", law));
    let translation = of("OVERCLOSURE=LINEAR\n1e7, .2").unwrap();
    assert!(translation.mesh.warnings.is_empty());
    let scene = Scene::parse(&translation.scene).unwrap();
    let stiffness = scene.contact[0].contact().unwrap().stiffness.clone();
    assert_eq!(stiffness.unwrap().at([0.0; 3]).unwrap(), [1e7, 0.0]);
    for law in ["OVERCLOSURE=LINEAR", "OVERCLOSURE=LINEAR\n-1."] {
        let error = of(law).err().unwrap();
        assert!(
            error.contains("slope of pressure over overclosure"),
            "{error}"
        );
    }
}

#[test]
fn gaps_are_closed_up_to_a_distance() {
    let deck = format!("{CUBES}{MODEL}{}", step("*DLOAD\nUpper, P2, 1."));
    let of =
        |key: &str| read(&deck.replace("INTERACTION=Dry,", &format!("INTERACTION=Dry, {key},")));
    let translation = of("ADJUST=0.01").unwrap();
    let scene = Scene::parse(&translation.scene).unwrap();
    assert_eq!(scene.contact[0].contact().unwrap().adjust, Some(0.01));
    assert!(translation.mesh.warnings.is_empty());
    let warnings = of("ADJUST=Top").unwrap().mesh.warnings;
    assert!(
        warnings[0].contains("line 46: ADJUST is left out"),
        "{warnings:?}"
    );
    let error = of("ADJUST=-1.").err().unwrap();
    assert!(
        error.contains("line 45: *CONTACT PAIR: ADJUST is -1; expected a distance"),
        "{error}"
    );
    let clearance = deck.replace(
        "*BOUNDARY",
        "*CLEARANCE, SLAVE=High, MASTER=Low, VALUE=0.02\n*BOUNDARY",
    );
    let both = clearance.replace("INTERACTION=Dry,", "INTERACTION=Dry, ADJUST=0.01,");
    let scenes = [clearance, both].map(|deck| read(&deck).unwrap().scene);
    assert!(
        scenes[0].contains("gap = 0.02") && scenes[0] == scenes[1],
        "{scenes:?}"
    );
}

#[test]
fn gaps_that_are_wider_than_the_distance_stay() {
    let deck = format!("{CUBES}{MODEL}{}", step("*DLOAD\nUpper, P2, 1."));
    let deck = deck.replace("INTERACTION=Dry,", "INTERACTION=Dry, ADJUST=0.02,");
    let [left, right] = ["11, 0, 0, 1\n", "12, 1, 0, 1\n"];
    let deck = deck
        .replace(left, "11, 0, 0, 1.01\n")
        .replace("14, 0, 1, 1\n", "14, 0, 1, 0.99\n");
    let deck = deck
        .replace(right, "12, 1, 0, 1.03\n")
        .replace("13, 1, 1, 1\n", "13, 1, 1, 1.03\n");
    let translation = read(&deck).unwrap();
    let scene = Scene::parse(&translation.scene).unwrap();
    let model = Model::new(&scene, translation.mesh).unwrap();
    let (closed, open): (Vec<_>, Vec<_>) =
        (model.contacts[0].points.iter().map(|point| point.gap)).partition(|&gap| gap == 0.0);
    assert_eq!((closed.len(), open.len()), (2, 2), "{open:?}");
    assert!(open.iter().all(|&gap| gap > 0.02), "{open:?}");
}

#[test]
fn pairs_of_contact_come_and_go() {
    let change = |what: &str| format!("*MODEL CHANGE, TYPE=CONTACT PAIR, {what}\nHigh, Low\n");
    let deck = |changes: [&str; 2]| {
        let steps = changes.map(|changes| step(&format!("{changes}*DLOAD\nUpper, P2, 1.")));
        format!("{CUBES}{MODEL}{}", steps.concat())
    };
    let translation = read(&deck([&change("REMOVE"), &change("ADD")])).unwrap();
    let scene = Scene::parse(&translation.scene).unwrap();
    let name = scene.contact[0].name();
    let absent: Vec<Vec<&str>> = (scene.absent().into_iter())
        .map(|names| names.into_iter().collect())
        .collect();
    assert_eq!(absent, [vec![name], vec![]]);
    for (changes, expected) in [
        (
            change("REMOVE").replace("High", "Nothing"),
            "there is no *CONTACT PAIR",
        ),
        (change("REMOVE, ADD"), "neither or both of ADD and REMOVE"),
        (
            change("REMOVE").replace("CONTACT PAIR", "CRACK"),
            "of TYPE=CRACK isn't read",
        ),
        (
            change("ADD=WITH STRAIN").replace("CONTACT PAIR", "ELEMENT"),
            "with ADD=WITH STRAIN isn't read",
        ),
    ] {
        let error = read(&deck([&changes, ""])).err().unwrap();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn parts_have_their_sections_in_every_instance() {
    let split = CUBES.find("*ELEMENT, TYPE=C3D8, ELSET=Upper").unwrap();
    let nodes = CUBES[..split].split("11, 0, 0, 1\n").next().unwrap();
    let deck = format!(
        "*PART, NAME=Cube\n{nodes}*ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1, 2, 3, 4, 5, 6, 7, 8\n\
         *SURFACE, NAME=Top\nSolid, S2\n*SURFACE, NAME=Foot\nSolid, S1\n\
         *SOLID SECTION, ELSET=Solid, MATERIAL=Steel\n*END PART\n*ASSEMBLY, NAME=A\n\
         *INSTANCE, NAME=One, PART=Cube\n*END INSTANCE\n*INSTANCE, NAME=Two, PART=Cube\n0., 0., 1.\n*END INSTANCE\n\
         *NSET, NSET=Bottom, INSTANCE=One\n1, 2, 3, 4\n*END ASSEMBLY\n\
         *MATERIAL, NAME=Steel\n*ELASTIC\n210e3, 0.3\n*SURFACE INTERACTION, NAME=I\n\
         *CONTACT PAIR, INTERACTION=I\nTwo.Foot, One.Top\n*BOUNDARY\nBottom, ENCASTRE\n{}",
        step("*DLOAD\nTwo.Solid, P2, 1.\n*CLOAD\nTwo.7, 1, 1.")
    );
    let translation = read(&deck).unwrap();
    let scene = Scene::parse(&translation.scene).unwrap();
    // One section is one body, in however many instances.
    assert_eq!(scene.bodies.len(), 1);
    for on in scene
        .pressure
        .iter()
        .map(|load| &load.on)
        .chain(scene.force.iter().map(|load| &load.on))
    {
        let name = on.iter().next().unwrap();
        assert_eq!(translation.mesh.groups[name].members.len(), 1, "{name}");
    }
}
