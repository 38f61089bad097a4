//! A sector of a ring, compared with the whole ring.

use std::collections::HashMap;

use contact_dd_partition::element::ElementKind::{self, Hexahedron20, Tetrahedron10};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use crate::support::blocks::{Blocks, glued, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{moved, solid, turned};
use crate::support::solution::Solution;
use crate::support::solver::{Case, solve, solve_steps};

const SECTORS: usize = 5;

/// The position of a point of the unit square in sector k between two radii.
fn around(k: usize, [s, t]: [f64; 2], [inner, outer]: [f64; 2]) -> [f64; 2] {
    let angle = std::f64::consts::TAU * (k as f64 + t) / SECTORS as f64;
    let radius = inner + (outer - inner) * s;
    [radius * angle.cos(), radius * angle.sin()]
}

/// The first `sectors` of a ring.
fn ring(name: &str, radii: [f64; 2], n: [usize; 2], sectors: usize) -> Mesh {
    let sector = |blocks: Blocks, k: usize| blocks.mapped(name, n, |x| around(k, x, radii));
    glued((0..sectors).fold(Blocks::new(), sector).mesh, |_| true)
}

/// A tyre tied to a hub, under centrifugal and circumferential loads, in two steps.
const WHEEL: &str = "
plane = 'stress'
materials.steel = {young = 20e9, poisson = 0.3}
bodies.hub = {material = 'steel'}
[bodies.tyre]
material = 'steel'
body_force = ['4e6*x', '4e6*y']
[[displacement]]
on = 'hub left'
x = 0.0
y = 0.0
[[tie]]
name = 'fit'
sides = ['tyre left', 'hub right']
[[traction]]
on = 'tyre right'
value = ['-4e5*y', '4e5*x']
[[step]]
scale = { traction = 0.0, body_force = 0.0 }
[[step]]
";

fn wheel(sectors: usize) -> Mesh {
    let hub = ring("hub", [0.5, 1.0], [3, 4], sectors);
    joined(hub, ring("tyre", [1.0, 1.6], [4, 4], sectors))
}

const CYCLIC: &str = "
[[cyclic]]
name = 'cut'
sides = [['hub bottom', 'tyre bottom'], ['hub top', 'tyre top']]
point = [0.0, 0.0]
sectors = 5
";

fn with_cyclic(text: &str) -> String {
    text.replacen("[[displacement]]", &format!("{CYCLIC}[[displacement]]"), 1)
}

/// Fails unless every node of the sector moves like the node of the ring at the same position; nodes of two bodies may
/// coincide there.
#[track_caller]
fn is_part(sector: (&Model, &Solution), ring: (&Model, &Solution), slack: f64) {
    let key = |model: &Model, node: usize, body: u32| {
        let x = model.mesh.points[node].map(|c| (c * 1e6).round() as i64);
        (x, body)
    };
    let nodes = |model: &Model| {
        let cells = model.mesh.cells.iter().zip(&model.cell_body);
        let all = cells.flat_map(|((_, nodes), &body)| nodes.iter().map(move |&n| (n, body)));
        all.collect::<Vec<_>>()
    };
    let of_ring: HashMap<_, _> = nodes(ring.0)
        .into_iter()
        .map(|(node, body)| {
            (
                key(ring.0, node as usize, body),
                ring.0.mesh.node_tags[node as usize],
            )
        })
        .collect();
    let scale = ring.1.largest_displacement();
    for (node, body) in nodes(sector.0) {
        let tag = of_ring[&key(sector.0, node as usize, body)];
        let expected = ring.1.displacement[&tag];
        let found = sector.1.displacement[&sector.0.mesh.node_tags[node as usize]];
        (0..3).for_each(|k| close(found[k], expected[k], slack * scale));
    }
}

#[test]
fn a_sector_of_a_wheel_is_the_whole_wheel() {
    let whole = model(WHEEL, wheel(SECTORS));
    let expected = solve_steps(&whole, 6);
    let sector = model(&with_cyclic(WHEEL), wheel(1));
    for count in [2, 5] {
        let found = solve_steps(&sector, count);
        for (found, expected) in found.iter().zip(&expected) {
            is_part((&sector, found), (&whole, expected), 1e-10);
        }
    }
}

/// A tyre shrunk onto its hub with friction: at the ends of the sector, contact forces act along the normals of the
/// ring.
#[test]
fn a_shrunk_sector_is_the_whole_wheel() {
    let joint = |keys: &str| {
        let wheel = WHEEL.replace("[[tie]]", &format!("[[contact]]\n{keys}"));
        wheel.replace("4e5*", "1e4*")
    };
    let soft = "gap = -1e-3\nfriction = 0.4\nstiffness = { normal = 1e11 }";
    for keys in [
        "gap = -1e-3\nfriction = 0.05",
        "gap = -1e-3\nfriction = 0.4",
        soft,
    ] {
        let text = joint(keys);
        let whole = model(&text, wheel(SECTORS));
        let expected = solve_steps(&whole, 6);
        let sector = model(&with_cyclic(&text), wheel(1));
        let found = solve_steps(&sector, 3);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            is_part((&sector, found), (&whole, expected), 1e-9);
        }
    }
}

#[test]
fn ranks_and_solvers_make_no_difference() {
    let case = Case::in_clusters(&model(&with_cyclic(WHEEL), wheel(1)), 6, 3);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    case.is_the_same_on_all_ranks_and_by_iteration(1e-8);
}

/// Two meshes combined; groups with the same name are merged.
fn grown(first: Mesh, second: Mesh) -> Mesh {
    let before = first.groups.clone();
    let mut mesh = joined(first, second);
    for (name, group) in before {
        let own = mesh.groups.get_mut(&name).map(|own| &mut own.members);
        own.unwrap().splice(0..0, group.members);
    }
    mesh
}

/// A ring in space under centrifugal and circumferential loads, with a general axis.
fn disc(kind: ElementKind, sectors: usize) -> Mesh {
    let sector = |k: usize| {
        solid("disc", kind, [2, 2, 2], move |[s, t, z]| {
            let [x, y] = around(k, [s, t], [0.5, 1.5]);
            [x, y, 0.4 * z]
        })
    };
    glued((1..sectors).map(sector).fold(sector(0), grown), |_| true)
}

#[test]
fn a_sector_in_space_is_the_whole_ring_about_any_axis() {
    let text = "
materials.steel = {young = 20e9, poisson = 0.3}
[bodies.disc]
material = 'steel'
body_force = ['4e6*x', '4e6*y', '1e6']
[[displacement]]
on = 'disc z0'
x = 0.0
y = 0.0
z = 0.0
[[traction]]
on = 'disc x1'
value = ['-4e6*y', '4e6*x', '2e6*z']
";
    let cyclic = |axis: [f64; 3]| {
        format!(
            "[[cyclic]]\nname = 'cut'\nsides = ['disc y0', 'disc y1']\npoint = [0.0, 0.0, 0.0]\naxis = {axis:?}\nsectors = 5\n"
        )
    };
    for kind in [Hexahedron20, Tetrahedron10] {
        let whole = model(text, disc(kind, SECTORS));
        let expected = solve(&whole, 5);
        let sector = model(
            &(text.to_owned() + &cyclic([0.0, 0.0, -2.0])),
            disc(kind, 1),
        );
        is_part((&sector, &solve(&sector, 3)), (&whole, &expected), 1e-10);
    }
    // Loads independent of the position, rotated with everything else.
    let axis = turned([0.0, 0.0, 1.0]);
    let text = text
        .replace(
            "['4e6*x', '4e6*y', '1e6']",
            &format!("{:?}", axis.map(|c| 1e6 * c)),
        )
        .replace(
            "['-4e6*y', '4e6*x', '2e6*z']",
            &format!("{:?}", axis.map(|c| -3e6 * c)),
        );
    let whole = model(&text, moved(disc(Hexahedron20, SECTORS), turned));
    let expected = solve(&whole, 5);
    let sector = model(
        &(text + &cyclic(axis)),
        moved(disc(Hexahedron20, 1), turned),
    );
    is_part((&sector, &solve(&sector, 3)), (&whole, &expected), 1e-10);
}

/// Nodes on both sides of a cut slip in rotated directions, and share the force and the strength of one node of the ring.
#[test]
fn friction_on_a_flat_side_is_that_of_the_whole_ring() {
    let text = "
materials.steel = {young = 20e9, poisson = 0.3}
bodies.disc.material = 'steel'
[[pressure]]
on = 'disc z1'
value = 1e6
[[traction]]
on = 'disc z1'
value = ['-@twist@*y', '@twist@*x', 0]
[[contact]]
name = 'rests'
";
    let (wall, below) = (
        "sides = ['disc z0']\nobstacle = {point = [0, 0, 0], normal = [0, 0, 1]}\n",
        "sides = ['disc z0', 'low z1']\n[[displacement]]\non = 'low z0'\nx = 0\ny = 0\nz = 0\n[bodies.low]\nmaterial = 'steel'\n",
    );
    let cut = |sides: [&str; 2]| {
        format!(
            "[[cyclic]]\nname = 'cut'\nsides = [{}, {}]\npoint = [0.0, 0.0, 0.0]\naxis = [0.0, 0.0, 1.0]\nsectors = 5\n",
            sides[0], sides[1]
        )
    };
    let ends = [
        cut(["'disc y0'", "'disc y1'"]),
        cut(["['disc y0', 'low y0']", "['disc y1', 'low y1']"]),
    ];
    let kind = ElementKind::Hexahedron8;
    for (law, twist) in [
        ("friction = 0.3", "2.55e5"),
        ("friction = 0.1\ncohesion = 3e5", "3.3e5"),
        ("tresca = 4e5", "3.3e5"),
    ] {
        for (sides, cut) in [wall, below].into_iter().zip(&ends) {
            let sides = sides.replacen('\n', &format!("\n{law}\n"), 1);
            let text = text.replace("@twist@", twist) + &sides;
            let mesh = |sectors: usize| match sides.contains("low") {
                true => joined(disc(kind, sectors), named_low(disc(kind, sectors))),
                false => disc(kind, sectors),
            };
            let whole = model(&text, mesh(SECTORS));
            let sector = model(&format!("{text}{cut}"), mesh(1));
            let (found, expected) = (solve(&sector, 2), solve(&whole, 5));
            is_part((&sector, &found), (&whole, &expected), 1e-8);
            let slipping = expected.slipping();
            assert!(slipping > 0 && slipping < expected.contacts["rests"].len());
        }
    }
}

/// A disc below the plane z = 0 with the name `low`.
fn named_low(disc: Mesh) -> Mesh {
    let mut low = moved(disc, |[x, y, z]| [x, y, z - 0.4]);
    let groups = std::mem::take(&mut low.groups).into_iter();
    low.groups = groups
        .map(|(name, of)| (name.replace("disc", "low"), of))
        .collect();
    low
}

/// A full disc includes its axis, whose nodes stay there.
#[test]
fn nodes_on_the_axis_stay_on_it() {
    let pie = |sectors: usize| {
        let sector = |k: usize| {
            solid(
                "disc",
                ElementKind::Hexahedron8,
                [2, 2, 2],
                move |[s, t, z]| {
                    // A kite: one of its four corners is on the axis.
                    let angle = |t: f64| std::f64::consts::TAU * (k as f64 + t) / SECTORS as f64;
                    let (p, q) = (angle(0.0), angle(1.0));
                    let middle = angle(0.5);
                    let at = |r: f64, a: f64| [r * a.cos(), r * a.sin()];
                    let corners = [[0.0, 0.0], at(1.0, p), at(1.2, middle), at(1.0, q)];
                    let shares = [(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t];
                    let sum = |i: usize| (0..4).map(|c| shares[c] * corners[c][i]).sum();
                    [sum(0), sum(1), 0.4 * z]
                },
            )
        };
        glued((1..sectors).map(sector).fold(sector(0), grown), |_| true)
    };
    let text = "
materials.steel = {young = 20e9, poisson = 0.3}
[bodies.disc]
material = 'steel'
body_force = ['4e6*x - 1e6*y', '4e6*y + 1e6*x', '1e6*z']
[[displacement]]
on = 'disc z0'
x = 0.0
y = 0.0
z = 0.0
";
    let cut = "[[cyclic]]\nname = 'cut'\nsides = ['disc y0', 'disc x0']\npoint = [0.0, 0.0, 3.0]\naxis = [0.0, 0.0, 1.0]\nsectors = 5\n";
    let whole = model(text, pie(SECTORS));
    let sector = model(&format!("{text}{cut}"), pie(1));
    is_part(
        (&sector, &solve(&sector, 3)),
        (&whole, &solve(&whole, 4)),
        1e-10,
    );
}

#[test]
fn what_is_no_sector_is_refused() {
    let with = |from: &str, to: &str| with_cyclic(WHEEL).replace(from, to);
    for (text, expected) in [
        (
            with("sectors = 5", "sectors = 6"),
            "has no partner on side b",
        ),
        (with("sectors = 5", "sectors = 1"), "expected at least 2"),
        (
            with("'tyre top']", "]").replace("top', ]", "top']"),
            "side b",
        ),
        (
            with("point = [0.0, 0.0]", "point = [0.0, 0.0, 1.0]"),
            "two components",
        ),
        (
            with("sectors = 5", "sectors = 5\naxis = [0.0, 1.0]"),
            "no 'axis' but z",
        ),
        (
            with("name = 'cut'", "name = 'fit'"),
            "there is another 'fit' already",
        ),
        (with("'stress'", "'axisymmetric'"), "has no sectors"),
        (with("[[tie]]", "[[contact]]"), "are curved where they meet"),
    ] {
        let uneven = joined(
            ring("hub", [0.5, 1.0], [3, 4], 1),
            ring("tyre", [1.0, 1.6], [4, 5], 1),
        );
        let text = format!("mesh = 'm'\n{text}");
        let error = match Scene::parse(&text) {
            Err(error) => error.to_string(),
            Ok(scene) => Model::new(&scene, uneven).unwrap_err().to_string(),
        };
        assert!(error.contains(expected), "{error}");
    }
}
