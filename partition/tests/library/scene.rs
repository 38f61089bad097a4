//! Reading scene.toml: every key, and the messages about invalid ones.

mod page;
mod refused;

use contact_dd_partition::model::PlaneState;
use contact_dd_partition::scene::Scene;
use contact_dd_partition::scene::condition::Obstacle;
use contact_dd_partition::scene::contact::{Chosen, Declaration, Partner};
use contact_dd_partition::scene::friction::Friction;
use contact_dd_partition::scene::material::Elasticity;
use contact_dd_partition::scene::number::Number;
use contact_dd_partition::scene::step::Scale;

const WHOLE: &str = r#"title = "Loaded granite block with cracks"
mesh  = "block.msh"
plane = "strain"
subdomains = ["s1", "s2"]

[materials.granite]
young = 5.2e9
poisson = 0.18
[materials.wood]
stiffness = [[10, 2, 0], [2, 5, 0], [0, 0, "1+1"]]
out_of_plane = [1.0, 2.0, 0]

[bodies.block]
material = "granite"
body_force = [0.0, -25e3]
[bodies."left block"]
material = "wood"

[[displacement]]
on = "bottom"
x = 0.0
y = "1e-3*x"
[[bilateral]]
on = ["axis", "side"]
[[traction]]
on = "top"
value = ["0", "-1e6*(1-x^2)"]
[[pressure]]
on = "right"
value = 0.6e7
[[contact]]
name = "left crack"
sides = ["left crack lower", ["left crack upper", "more"]]
gap = 0.0
friction = 0.6
cohesion = "1e5*y"
[[contact]]
name = "table"
sides = ["base"]
tresca = "2e5"
obstacle = { point = [0.0, 0.0], normal = [0.0, 2.0] }
[[contact]]
name = "ring"
sides = ["rim"]
obstacle = { center = [0, 0], radius = "2*pi", inside = true }
[[step]]
name = "first"
time = 0.5
scale = { pressure = 0.25, displacement = "1/8" }
body_force = { "left block" = [1, "2*x"] }
[[step]]
time = "pi"
scale = 2
pressure = []
[[step.traction]]
on = "left"
value = [0, 1]
[[step.displacement]]
on = "bottom"
x = 1
y = 2
"#;

#[test]
fn every_key_is_read() {
    let scene = Scene::parse(WHOLE).unwrap();
    assert_eq!(scene.title, "Loaded granite block with cracks");
    assert_eq!(scene.mesh.to_str(), Some("block.msh"));
    assert_eq!(scene.plane, Some(PlaneState::Strain));
    let subdomains = scene.subdomains.unwrap();
    assert_eq!(subdomains.iter().collect::<Vec<_>>(), ["s1", "s2"]);
    assert_eq!(
        scene.materials["granite"],
        Elasticity::Isotropic {
            young: 5.2e9,
            poisson: 0.18
        }
    );
    assert_eq!(
        scene.materials["wood"],
        Elasticity::Anisotropic {
            stiffness: [[10.0, 2.0, 0.0], [2.0, 5.0, 0.0], [0.0, 0.0, 2.0]].into(),
            out_of_plane: Some([1.0, 2.0, 0.0]),
        }
    );
    let force = scene.bodies["block"].body_force.clone().unwrap();
    assert_eq!(force.at([0.0; 3]), Ok([0.0, -25e3, 0.0]));
    assert_eq!(scene.bodies["left block"].body_force, None);
    let displacement = &scene.displacement[0].components;
    assert_eq!(displacement[0], Some(Number::Constant(0.0)));
    assert_eq!(
        displacement[1].as_ref().unwrap().at([2.0, 0.0, 0.0]),
        Ok(2e-3)
    );
    assert_eq!(displacement[2], None);
    assert_eq!(scene.bilateral[0].on.to_string(), "'axis', 'side'");
    assert_eq!(
        scene.traction[0].value.at([0.5, 9.0, 0.0]),
        Ok([0.0, -0.75e6, 0.0])
    );
    assert_eq!(scene.pressure[0].value, Number::Constant(0.6e7));
    let [
        Declaration::Contact(crack),
        Declaration::Contact(table),
        Declaration::Contact(ring),
    ] = scene.contact.as_slice()
    else {
        panic!("three contacts");
    };
    assert_eq!(crack.name, "left crack");
    assert_eq!(crack.gap, Some(Number::Constant(0.0)));
    assert!(matches!(&crack.partner, Partner::Side(b)
        if b.to_string() == "'left crack upper', 'more'"));
    assert!(
        matches!(&crack.friction, Some(Friction::Coulomb { coefficient, cohesion: Some(cohesion) })
        if *coefficient == Number::Constant(0.6) && cohesion.at([0.0, 2.0, 0.0]) == Ok(2e5))
    );
    let bound = Number::Constant(2e5);
    assert_eq!(table.friction, Some(Friction::Given { bound }));
    assert_eq!(ring.friction, None);
    assert_eq!(table.gap, None);
    assert!(matches!(&table.partner,
        Partner::Obstacle(Obstacle::HalfSpace { point, normal })
            if point.value == [0.0; 3] && normal.value == [0.0, 2.0, 0.0]));
    assert!(matches!(&ring.partner,
        Partner::Obstacle(Obstacle::Ball { radius, inside: true, .. })
            if *radius == 2.0 * std::f64::consts::PI));
}

#[test]
fn contacts_may_be_looked_for_between_bodies() {
    let text = "mesh = 'a.msh'\nplane = 'stress'\nmaterials.m = {young = 1, poisson = 0}
        bodies.b.material = 'm'\nbodies.c.material = 'm'\nbodies.all.material = 'm'
        [[contact]]\nname = 'joints'\nbetween = ['b', 'c']\nwithin = '1/2'\nfriction = 0.5
        [[contact]]\nname = 'cracks'\nbetween = 'c'
        [[contact]]\nname = 'others'\nbetween = 'all'\n";
    let scene = Scene::parse(text).unwrap();
    let [joints, cracks, others] = [0, 1, 2].map(|i| match &scene.contact[i] {
        Declaration::Between(between) => between,
        Declaration::Contact(_) => panic!("looked for"),
    });
    assert_eq!((joints.within, cracks.within), (Some(0.5), None));
    assert!(joints.friction.is_some() && cracks.friction.is_none());
    assert_eq!(others.bodies, Chosen::All);
    let has = |chosen: &Chosen| {
        [("b", "c"), ("c", "b"), ("c", "c"), ("b", "b"), ("b", "all")]
            .map(|(a, b)| chosen.has(a, b))
    };
    assert_eq!(has(&joints.bodies), [true, true, false, false, false]);
    assert_eq!(has(&cracks.bodies), [false, false, true, false, false]);
    assert_eq!(has(&others.bodies), [true; 5]);
}

#[test]
fn a_scene_needs_no_more_than_mesh_material_and_body() {
    let scene = Scene::parse(
        "mesh = 'a.msh'\nplane = 'stress'\nmaterials.m = {young = 1, poisson = 0}\nbodies.b.material = 'm'",
    )
    .unwrap();
    assert_eq!(scene.plane, Some(PlaneState::Stress));
    assert!(scene.contact.is_empty() && scene.subdomains.is_none());
}

#[test]
fn the_mesh_lies_beside_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    std::fs::write(&path, WHOLE).unwrap();
    let scene = Scene::read(&path).unwrap();
    assert_eq!(scene.mesh, folder.path().join("block.msh"));
    std::fs::write(&path, WHOLE.replace("block.msh", "/meshes/block.msh")).unwrap();
    let scene = Scene::read(&path).unwrap();
    assert_eq!(scene.mesh.to_str(), Some("/meshes/block.msh"));
}

#[test]
fn files_that_are_no_scene_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    let printed = |path: &std::path::Path| Scene::read(path).unwrap_err().to_string();
    assert!(printed(&path).contains("scene.toml: can't be read"));
    assert!(printed(folder.path()).contains("can't be read"));
    std::fs::write(&path, b"title = 'a'\nmesh = '\xff'").unwrap();
    assert!(printed(&path).contains("scene.toml: line 2: isn't UTF-8"));
    std::fs::write(&path, "mesh = 1").unwrap();
    assert!(printed(&path).contains("scene.toml: line 1: mesh: "));
}

#[test]
fn every_key_of_a_step_is_read() {
    let scene = Scene::parse(WHOLE).unwrap();
    let [first, second] = &scene.step[..] else {
        panic!("{:?}", scene.step);
    };
    assert_eq!(
        [first, second].map(|step| step.time),
        [Some(0.5), Some(std::f64::consts::PI)]
    );
    assert_eq!(first.name_or_number(0), "first");
    assert_eq!(second.name_or_number(1), "2");
    let Scale {
        body_force,
        traction,
        pressure,
        force,
        displacement,
        initial_stress,
        thermal,
    } = first.scale;
    assert_eq!(
        [body_force, traction, pressure, displacement],
        [1.0, 1.0, 0.25, 0.125]
    );
    assert_eq!([force, initial_stress, thermal], [1.0; 3]);
    assert_eq!(second.scale.traction, 2.0);
    assert_eq!(
        first.body_force["left block"].at([3.0, 0.0, 0.0]),
        Ok([1.0, 6.0, 0.0])
    );
    assert_eq!((&first.traction, &first.pressure), (&None, &None));
    assert_eq!(second.pressure, Some(Vec::new()));
    let loadings = scene.loadings();
    assert_eq!(loadings[0].pressure.len(), 1);
    assert_eq!(loadings[0].body_force.iter().flatten().count(), 2);
    assert_eq!(
        (loadings[1].pressure.len(), loadings[1].traction.len()),
        (0, 1)
    );
    assert_eq!(loadings[1].displacement[0].on.to_string(), "'bottom'");
}
