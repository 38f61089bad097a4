//! Scenes in space on meshes by Gmsh: a quarter of a hollow cylinder, 1 < r < 2, 0 < z < 1.

use crate::says::says;
use contact_dd_partition::mesh::{Mesh, gmsh};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::close::close;

const MESHES: [&str; 5] = [
    "tetrahedra-4",
    "tetrahedra-10",
    "hexahedra-8",
    "hexahedra-20",
    "hexahedra-27",
];

fn mesh(name: &str) -> Mesh {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/library/gmsh/kinds");
    gmsh::read(format!("{folder}/{name}-4.1-ascii.msh").as_ref()).unwrap()
}

fn made(text: &str, mesh: Mesh) -> Result<Model, String> {
    let text = format!(
        "mesh = 'a.msh'\nmaterials.steel = {{young = 200, poisson = 0.25}}\nbodies.ring.material = 'steel'\n{text}"
    );
    let scene = Scene::parse(&text).map_err(|error| error.to_string())?;
    Model::new(&scene, mesh).map_err(|error| error.to_string())
}

fn sum(model: &Model) -> [f64; 3] {
    let forces = model.forces.iter();
    forces.fold([0.0; 3], |sum, (_, f)| [0, 1, 2].map(|k| sum[k] + f[k]))
}

#[test]
fn a_pressure_on_a_curved_face_pushes_as_on_its_shadow() {
    for name in MESHES {
        for (side, radius, sign) in [("inner", 1.0, 1.0), ("outer", 2.0, -1.0)] {
            let model = made(
                &format!("[[pressure]]\non = '{side}'\nvalue = 3"),
                mesh(name),
            )
            .unwrap();
            let force = sum(&model);
            let expected = [sign * 3.0 * radius, sign * 3.0 * radius, 0.0];
            (0..3).for_each(|k| close(force[k], expected[k], 1e-7));
        }
    }
}

#[test]
fn a_body_force_is_that_of_the_volume_and_a_polynomial_one_is_exact() {
    for name in MESHES {
        let mesh = mesh(name);
        let volume: f64 = (0..mesh.cells.len()).map(|cell| mesh.measure(cell)).sum();
        let weight = |force: &str| {
            let text = format!("bodies.ring.body_force = {force}");
            sum(&made(&text, mesh.clone()).unwrap())
        };
        let constant = weight("[0, 0, -2]");
        close(constant[2], -2.0 * volume, 1e-12);
        // Symmetric about z = 1/2: z³ − 3/2 z² + z/2 is odd there.
        let odd = weight("['0', '0', 'z^3-1.5*z^2+0.5*z']");
        assert!(odd[2].abs() < 1e-12, "{name}: {odd:?}");
    }
}

#[test]
fn what_has_no_place_in_space_is_refused_in_words() {
    let obstacle = |keys: &str| format!("[[contact]]\nname = 'c'\nsides = ['inner']\n{keys}");
    let identity = "[[1,0,0],[0,1,0],[0,0,1]]";
    for (text, words) in [
        ("plane = 'strain'".to_owned(), "'plane' is of plane scenes"),
        (
            "bodies.ring.body_force = [0, 1]".into(),
            "bodies.ring.body_force: a scene in space has vectors of three",
        ),
        (
            "[[traction]]\non = 'inner'\nvalue = [1, 2]".into(),
            "traction[1].value: a scene in space",
        ),
        (
            obstacle("obstacle = {point = [0, 0], normal = [1, 0]}"),
            "contact[1].obstacle: a scene in space",
        ),
        (
            obstacle("obstacle = {center = [0, 0], radius = 1}"),
            "contact[1].obstacle: a scene in space",
        ),
        (
            format!("materials.wood.stiffness = {identity}"),
            "materials.wood.stiffness: expected 6 rows of 6",
        ),
        (
            "[[bilateral]]\non = 'rim'".into(),
            "no physical group 'rim'",
        ),
        (
            "[[pressure]]\non = 'ring'\nvalue = 1".into(),
            "a group of cells",
        ),
    ] {
        let error = made(&text, mesh("hexahedra-8")).unwrap_err();
        assert!(error.contains(words), "{text}: {error}");
    }
    let scene = "mesh = 'a.msh'\nplane = 'strain'\nmaterials.m = {young = 1, poisson = 0}\nbodies.b.material = 'm'\n";
    for (text, words) in [
        (
            "[[pressure]]\non = 'a'\nvalue = 'x+z'",
            "character 3: 'z' isn't known in the plane",
        ),
        (
            "[[contact]]\nname = 'c'\nsides = ['a']\nobstacle = {point = [0, 0], axis = [0, 1], radius = 1}",
            "a plane scene has no cylinder",
        ),
    ] {
        let error = Scene::parse(&format!("{scene}{text}"))
            .unwrap_err()
            .to_string();
        says(&error, words);
    }
}

#[test]
fn degenerate_and_folded_cells_are_refused() {
    for (name, words) in [
        ("tetrahedra-4", "has no volume"),
        ("hexahedra-8", "is folded"),
    ] {
        let mut mesh = mesh(name);
        let nodes = mesh.cells.nodes_of(0).to_vec();
        let at = |i: usize| mesh.points[nodes[i] as usize];
        // Into the plane of the other corners; or beyond the opposite one.
        let place = match name {
            "tetrahedra-4" => [0, 1, 2].map(|k| (at(0)[k] + at(1)[k] + at(2)[k]) / 3.0),
            _ => [0, 1, 2].map(|k| 1.1 * at(6)[k] - 0.1 * at(0)[k]),
        };
        mesh.points[nodes[if name == "tetrahedra-4" { 3 } else { 0 }] as usize] = place;
        let error = made("", mesh).unwrap_err();
        says(&error, words);
    }
}

#[test]
fn an_anisotropic_stiffness_is_used_as_it_stands() {
    let rows: Vec<Vec<f64>> = (0..6)
        .map(|i| {
            (0..6)
                .map(|j| {
                    if i == j {
                        5.0 + i as f64
                    } else {
                        0.1 * (i + j) as f64
                    }
                })
                .collect()
        })
        .collect();
    let text = format!("materials.wood.stiffness = {rows:?}\nbodies.ring.material = 'wood'");
    let text = format!("mesh = 'a.msh'\n{text}");
    let model = Model::new(&Scene::parse(&text).unwrap(), mesh("tetrahedra-10")).unwrap();
    assert_eq!(model.materials[0].stiffness.values(), rows.concat());
    assert_eq!((model.plane, model.materials[0].out_of_plane), (None, None));
}
