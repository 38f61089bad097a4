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
fn what_belongs_to_the_plane_or_to_space_is_refused_elsewhere() {
    let error = made("plane = 'strain'", mesh("hexahedra-8")).unwrap_err();
    says(&error, "'plane' is of plane scenes");
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
        let error = made(&format!("plane = 'strain'\n{text}"), mesh("hexahedra-8"));
        says(&error.unwrap_err(), words);
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
