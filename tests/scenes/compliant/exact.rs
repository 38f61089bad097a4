//! Columns on compliant joints settle by pressure over stiffness.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Tetrahedron10};
use contact_dd_partition::mesh::Mesh;

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solver::{Case, solve};
use crate::support::sorts::SORTS;

const YOUNG: f64 = 20e9;
const PRESSURE: f64 = 3e6;
const STIFFNESS: f64 = 5e10;
const GAP: f64 = 2e-5;

/// Material and bodies.
fn bodies(plane: &str) -> String {
    format!(
        "{plane}materials.rock = {{young = {YOUNG:?}, poisson = 0.0}}
bodies.lower.material = 'rock'
bodies.upper.material = 'rock'
"
    )
}

fn column(sides: [&str; 2], top: &str) -> String {
    format!(
        "[[contact]]
name = 'joint'
sides = ['{}', '{}']
gap = {GAP:?}
stiffness = {{ normal = {STIFFNESS:?} }}
[[pressure]]
on = '{top}'
value = {PRESSURE:?}
",
        sides[0], sides[1]
    )
}

/// Fails unless the upper part, above `joint` along an `axis`, settles by gap and overlap more than the lower one.
#[track_caller]
fn sinks(text: &str, mesh: Mesh, axis: usize) {
    let model = model(text, mesh);
    let upper = |body: u32| model.bodies[body as usize] == "upper";
    let mut in_upper = vec![false; model.mesh.points.len()];
    for ((_, nodes), &body) in model.mesh.cells.iter().zip(&model.cell_body) {
        nodes
            .iter()
            .for_each(|&node| in_upper[node as usize] |= upper(body));
    }
    let scale = GAP + PRESSURE / STIFFNESS;
    for count in [2, 5] {
        for interface in ["direct", "iterative"] {
            let case = Case::of(&model, count);
            let solution = case.solve(&["--interface", interface]);
            for (node, (x, tag)) in model
                .mesh
                .points
                .iter()
                .zip(&model.mesh.node_tags)
                .enumerate()
            {
                let rigid = if in_upper[node] { -scale } else { 0.0 };
                let expected = rigid - PRESSURE * x[axis] / YOUNG;
                for (k, u) in solution.displacement[tag].iter().enumerate() {
                    close(*u, if k == axis { expected } else { 0.0 }, 1e-10 * scale);
                }
            }
            assert!(
                solution
                    .points()
                    .all(|point| point.closed && point.gap == 0.0)
            );
            for point in solution.points() {
                close(point.pressure, PRESSURE, 1e-9 * PRESSURE);
            }
            let printed = &solution.report["contacts"][0]["largest_overclosure"];
            close(
                printed.as_f64().unwrap(),
                PRESSURE / STIFFNESS,
                1e-9 * scale,
            );
            let file = hdf5::File::open(case.result()).unwrap();
            let overclosure = file.dataset("contact/joint/overclosure").unwrap();
            for of_point in overclosure.read_raw::<f64>().unwrap() {
                close(of_point, PRESSURE / STIFFNESS, 1e-9 * scale);
            }
        }
    }
}

#[test]
fn in_the_plane_and_around_an_axis_whatever_the_cells_are() {
    let meshes = [[4, 4], [4, 7]].map(|[of_lower, of_upper]| {
        Blocks::new()
            .rectangle("lower", [1.0, 2.0], [0.0, 1.0], [of_lower, 3])
            .rectangle("upper", [1.0, 2.0], [1.0, 2.5], [of_upper, 5])
            .mesh
    });
    for (plane, held) in [("strain", "x = 0.0\n"), ("axisymmetric", "")] {
        let plane = format!("plane = '{plane}'\n");
        let text = format!(
            "{}{}[[displacement]]\non = 'lower bottom'\ny = 0.0\n",
            bodies(&plane),
            column(["upper bottom", "lower top"], "upper top"),
        );
        let text = match held.is_empty() {
            true => text,
            false => format!(
                "{text}{held}[[displacement]]\non = 'upper left'\nx = 0.0\n[[displacement]]\non = 'lower left'\nx = 0.0\n"
            ),
        };
        for mesh in &meshes {
            for sort in SORTS {
                sinks(&text, sort.of(mesh), 1);
            }
        }
    }
}

#[test]
fn in_space() {
    let held = "
[[displacement]]
on = 'lower z0'
z = 0.0
[[displacement]]
on = ['lower x0', 'upper x0']
x = 0.0
[[displacement]]
on = ['lower y0', 'upper y0']
y = 0.0
";
    let text = format!(
        "{}{}{held}",
        bodies(""),
        column(["upper z0", "lower z1"], "upper z1")
    );
    for (kind, of_upper) in [
        (Hexahedron8, [2, 2, 2]),
        (Hexahedron8, [3, 2, 2]),
        (Tetrahedron10, [2, 2, 1]),
    ] {
        let lower = solid("lower", kind, [2, 2, 1], between([0.0; 3], [1.0; 3]));
        let upper = solid(
            "upper",
            kind,
            of_upper,
            between([0.0, 0.0, 1.0], [1.0, 1.0, 2.0]),
        );
        sinks(&text, joined(lower, upper), 2);
    }
}

/// A block pressed into a compliant wall by prescribed displacements, without free nodes.
#[test]
fn what_is_prescribed_on_both_sides_makes_pressures() {
    let mesh = Blocks::new()
        .rectangle("upper", [0.0, 1.0], [0.0, 0.5], [5, 2])
        .mesh;
    let depth = 1e-5;
    let text = format!(
        "plane = 'strain'
materials.rock = {{young = {YOUNG:?}, poisson = 0.3}}
bodies.upper.material = 'rock'
[[contact]]
name = 'wall'
sides = ['upper bottom']
obstacle = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}
stiffness = {{ normal = {STIFFNESS:?} }}
[[displacement]]
on = 'upper bottom'
x = 0.0
y = {:?}
",
        -depth
    );
    for count in [1, 3] {
        let solution = solve(&model(&text, mesh.clone()), count);
        assert_eq!(solution.closed(), 6);
        for point in solution.points() {
            close(point.pressure, STIFFNESS * depth, 1e-10 * STIFFNESS * depth);
        }
        // The support of the bottom carries the whole force.
        let reaction = &solution.report["reactions"][0]["force"][1];
        close(
            reaction.as_f64().unwrap(),
            -STIFFNESS * depth,
            1e-9 * STIFFNESS * depth,
        );
    }
}
