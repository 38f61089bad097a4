//! Bolts that are tightened at a cut through them.

mod refused;

use contact_dd_partition::element::ElementKind::Hexahedron8;
use contact_dd_partition::mesh::{Group, Mesh};
use serde_json::Value;

use crate::support::blocks::{Blocks, joined};
use crate::support::close::close;
use crate::support::scenes::model;
use crate::support::solids::{SOLIDS, between, moved, solid, turned};
use crate::support::solution::{Solution, datasets, difference};
use crate::support::solver::{Case, solve, solve_steps};
use crate::support::sorts::SORTS;

const YOUNG: f64 = 20e9;

/// The mesh with the group `cut` of the cells' facets whose nodes are all at positions where `at` is true.
fn with_cut(mut mesh: Mesh, at: impl Fn([f64; 3]) -> bool) -> Mesh {
    let mut facets: Vec<(_, Vec<u32>)> = Vec::new();
    for (kind, nodes) in mesh.cells.iter() {
        for (facet, local) in kind.facets() {
            let of_facet: Vec<u32> = local.iter().map(|&i| nodes[i]).collect();
            let mut sorted = of_facet.clone();
            sorted.sort_unstable();
            let is_new = facets.iter().all(|(_, known)| {
                let mut known: Vec<u32> = known.clone();
                known.sort_unstable();
                known != sorted
            });
            if is_new && of_facet.iter().all(|&node| at(mesh.points[node as usize])) {
                facets.push((*facet, of_facet));
            }
        }
    }
    let first = mesh.facets.len() as u32;
    for (kind, nodes) in &facets {
        mesh.facets.push(*kind, nodes);
    }
    let group = Group {
        dim: mesh.dim - 1,
        members: (first..mesh.facets.len() as u32).collect(),
    };
    mesh.groups.insert("cut".into(), group);
    mesh
}

fn bar(poisson: f64, ends: [&str; 2]) -> String {
    let [low, high] = ends;
    format!(
        "
materials.steel = {{young = {YOUNG:?}, poisson = {poisson:?}}}
bodies.bar = {{material = 'steel'}}
[[displacement]]
on = '{low}'
x = 0.0
y = 0.0
[[displacement]]
on = '{high}'
x = 0.0
y = 0.0
"
    )
}

fn in_space(poisson: f64) -> String {
    bar(poisson, ["bar z0", "bar z1"]).replace("y = 0.0\n", "y = 0.0\nz = 0.0\n")
}

fn bolt(keys: &str) -> String {
    format!("[[pretension]]\nname = 'bolt'\non = 'cut'\n{keys}\n")
}

/// Force and shortening of the first bolt of a report.
fn tightened(report: &Value) -> [f64; 2] {
    let of = &report["pretensions"][0];
    assert_eq!(of["name"], "bolt");
    ["force", "shortening"].map(|key| of[key].as_f64().unwrap())
}

fn reaction(solution: &Solution, support: usize) -> [f64; 3] {
    let of = &solution.report["reactions"][support]["force"];
    [0, 1, 2].map(|k| of[k].as_f64().unwrap())
}

/// A bar between two walls has the prescribed tension, and is shortened by its elongation.
#[test]
fn a_bar_bears_the_force_and_stretches_by_the_shortening() {
    let (area, length, force) = (0.6 * 0.4, 2.0, 3e6);
    let stretch = force * length / (YOUNG * area);
    for kind in SOLIDS {
        let mesh = solid("bar", kind, [2, 2, 4], between([0.0; 3], [0.6, 0.4, 2.0]));
        let mesh = with_cut(mesh, |x| (x[2] - 1.0).abs() < 1e-9);
        for (count, keys, held) in [
            (2, format!("force = {force:?}"), false),
            (5, format!("force = {force:?}"), false),
            (3, format!("shortening = {stretch:?}"), true),
        ] {
            let solution = solve(&model(&(in_space(0.0) + &bolt(&keys)), mesh.clone()), count);
            let [found, shortening] = tightened(&solution.report);
            close(found, force, 1e-10 * force);
            close(shortening, stretch, 1e-10 * stretch);
            assert_eq!(solution.report["pretensions"][0]["held"], held);
            for (_, stress) in &solution.cells {
                close(stress[2], force / area, 1e-9 * force / area);
            }
            close(reaction(&solution, 0)[2], -force, 1e-10 * force);
            close(reaction(&solution, 1)[2], force, 1e-10 * force);
        }
    }
}

/// For any bar, the walls carry the force normal to its cut, and nothing tangential.
#[test]
fn the_walls_bear_the_force_across_the_cut() {
    let plane = format!("plane = 'stress'\n{}", bar(0.3, ["bar bottom", "bar top"]));
    for sort in SORTS {
        let mesh = Blocks::new()
            .rectangle("bar", [0.0, 0.6], [0.0, 1.5], [4, 6])
            .mesh;
        let mesh = with_cut(sort.of(&mesh), |x| (x[1] - 0.75).abs() < 1e-9);
        let by_force = solve(
            &model(&(plane.clone() + &bolt("force = 2e6")), mesh.clone()),
            4,
        );
        let [force, shortening] = tightened(&by_force.report);
        close(force, 2e6, 1e-12 * 2e6);
        let found = reaction(&by_force, 1);
        close(found[1], 2e6, 1e-12 * 2e7);
        let foot = reaction(&by_force, 0);
        (0..2).for_each(|k| close(found[k], -foot[k], 1e-12 * 2e7));
        // Prescribing its shortening reproduces the force.
        let keys = format!("shortening = {shortening:?}");
        let by_length = solve(&model(&(plane.clone() + &bolt(&keys)), mesh), 3);
        close(tightened(&by_length.report)[0], 2e6, 1e-11 * 2e6);
    }
}

/// A round bar around its axis between smooth walls carries the force of the full circumference, in any cells.
#[test]
fn a_round_bar_bears_the_force_all_around() {
    let (radius, length, force) = (0.4, 1.5, 2e6);
    let area = std::f64::consts::PI * radius * radius;
    let stretch = force * length / (YOUNG * area);
    let ring = bar(0.3, ["bar bottom", "bar top"]).replace("x = 0.0\n", "");
    for sort in SORTS {
        let mesh = Blocks::new()
            .rectangle("bar", [0.0, radius], [0.0, length], [4, 6])
            .mesh;
        let mesh = with_cut(sort.of(&mesh), |x| (x[1] - 0.75).abs() < 1e-9);
        for keys in [
            format!("force = {force:?}"),
            format!("shortening = {stretch:?}"),
        ] {
            let text = format!("plane = 'axisymmetric'\n{ring}{}", bolt(&keys));
            let solution = solve(&model(&text, mesh.clone()), 4);
            let [found, shortening] = tightened(&solution.report);
            close(found, force, 1e-9 * force);
            close(shortening, stretch, 1e-9 * stretch);
            for (_, stress) in &solution.cells {
                close(stress[1], force / area, 1e-8 * force / area);
                close(stress[0], 0.0, 1e-8 * force / area);
            }
            close(reaction(&solution, 1)[1], force, 1e-9 * force);
        }
    }
}

/// A rotated bar in space is tightened along its axis, by the normal of the cut or an equivalent direction.
#[test]
fn a_turned_bar_is_tightened_along_itself() {
    let mesh = solid(
        "bar",
        Hexahedron8,
        [2, 2, 4],
        between([0.0; 3], [0.6, 0.4, 2.0]),
    );
    let mesh = with_cut(mesh, |x| (x[2] - 1.0).abs() < 1e-9);
    let axis = turned([0.0, 0.0, 1.0]);
    let straight = solve(
        &model(&(in_space(0.3) + &bolt("force = 1e6")), mesh.clone()),
        2,
    );
    let expected = tightened(&straight.report);
    for direction in [
        String::new(),
        format!("direction = {:?}", axis.map(|c| -2.0 * c)),
    ] {
        let text = in_space(0.3) + &bolt(&format!("force = 1e6\n{direction}"));
        let solution = solve(&model(&text, moved(mesh.clone(), turned)), 3);
        let found = tightened(&solution.report);
        (0..2).for_each(|k| close(found[k], expected[k], 1e-10 * expected[k]));
        (0..3).for_each(|k| close(reaction(&solution, 1)[k], 1e6 * axis[k], 1e-5));
    }
}

/// A bolt beside a flange, both under a guided plate, which a force lifts: the flange consists of two parts in contact.
fn joint(keys: &str, steps: &str) -> String {
    format!(
        "
plane = 'stress'
materials.steel = {{young = {YOUNG:?}, poisson = 0.0}}
bodies.bolt = {{material = 'steel'}}
bodies.lower = {{material = 'steel'}}
bodies.upper = {{material = 'steel'}}
[[displacement]]
on = ['bolt bottom', 'lower bottom']
x = 0.0
y = 0.0
[[coupling]]
name = 'plate'
on = ['bolt top', 'upper top']
point = [1.0, 4.0]
x = 0.0
rz = 0.0
force = [0.0, 0.0]
[[contact]]
name = 'flange'
sides = ['lower top', 'upper bottom']
{keys}
{}{steps}",
        bolt("force = 6e6")
    )
}

fn joint_mesh() -> Mesh {
    let mesh = Blocks::new()
        .rectangle("bolt", [0.0, 0.5], [0.0, 4.0], [2, 8])
        .rectangle("lower", [1.0, 3.0], [0.0, 2.0], [4, 3])
        .rectangle("upper", [1.0, 3.0], [2.0, 4.0], [4, 3])
        .mesh;
    with_cut(mesh, |x| x[0] < 0.6 && (x[1] - 1.0).abs() < 1e-9)
}

/// The joint diagram: a locked bolt carries its share of a load by the ratio of stiffnesses, and all of it once the
/// flange has opened.
#[test]
fn a_locked_joint_follows_its_diagram_up_to_separation_and_back() {
    let (preload, [bolt, flange]) = (6e6, [0.5, 2.0].map(|width| YOUNG * width / 4.0));
    let parts_at = preload * (bolt + flange) / flange;
    let loads = [
        0.0,
        0.5 * parts_at,
        0.99 * parts_at,
        1.5 * parts_at,
        0.25 * parts_at,
    ];
    let mut steps = "[[step]]\n".to_owned();
    for load in loads {
        steps += &format!(
            "[[step]]\npretension.bolt = {{ lock = true }}\ncoupling.plate = {{ force = [0.0, {load:?}] }}\n"
        );
    }
    // After unlocking it has the prescribed force again.
    steps += "[[step]]\npretension.bolt = { force = 3e6 }\n";
    for (count, keys) in [(4, ""), (7, "friction = 0.2")] {
        let solutions = solve_steps(&model(&joint(keys, &steps), joint_mesh()), count);
        let found = |k: usize| tightened(&solutions[k].report);
        let pressed = |k: usize| {
            let points = &solutions[k].contacts["flange"];
            points.iter().map(|point| point.force).sum::<f64>()
        };
        let shortening = preload / bolt + preload / flange;
        close(found(0)[0], preload, 1e-12 * preload);
        close(found(0)[1], shortening, 1e-10 * shortening);
        for (k, load) in (1..).zip(loads) {
            let expected = match load < parts_at {
                true => [
                    preload + load * bolt / (bolt + flange),
                    preload - load * flange / (bolt + flange),
                ],
                false => [load, 0.0],
            };
            close(found(k)[0], expected[0], 1e-10 * preload);
            close(pressed(k), expected[1], 1e-10 * preload);
            close(found(k)[1], shortening, 1e-10 * shortening);
            assert_eq!(solutions[k].report["pretensions"][0]["held"], true);
        }
        let last = loads.len() + 1;
        close(found(last)[0], 3e6, 1e-12 * preload);
        close(pressed(last), 3e6, 1e-10 * preload);
        assert_eq!(solutions[last].report["pretensions"][0]["held"], false);
    }
}

/// Two plates with friction clamped by a bolt between them, sheared once it is locked.
#[test]
fn ranks_and_solvers_make_no_difference() {
    let lower = solid(
        "lower",
        Hexahedron8,
        [4, 3, 2],
        between([0.0; 3], [2.0, 1.0, 0.5]),
    );
    let upper = solid(
        "upper",
        Hexahedron8,
        [4, 3, 2],
        between([0.0, 0.0, 0.5], [2.0, 1.0, 1.0]),
    );
    let bolt_mesh = solid(
        "bolt",
        Hexahedron8,
        [2, 2, 4],
        between([3.0, 0.0, 0.0], [3.5, 0.5, 1.0]),
    );
    let mesh = joined(joined(lower, upper), bolt_mesh);
    let mesh = with_cut(mesh, |x| x[0] > 2.5 && (x[2] - 0.5).abs() < 1e-9);
    let text = "
materials.steel = {young = 20e9, poisson = 0.3}
bodies = {lower = {material = 'steel'}, upper = {material = 'steel'}, bolt = {material = 'steel'}}
[[displacement]]
on = ['lower z0', 'bolt z0']
x = 0.0
y = 0.0
z = 0.0
[[coupling]]
name = 'head'
on = ['bolt z1', 'upper z1']
point = [1.5, 0.5, 1.0]
rx = 0.0
ry = 0.0
rz = 0.0
force = [0.0, 0.0, 0.0]
[[contact]]
name = 'joint'
sides = ['lower z1', 'upper z0']
friction = 0.3
[[pretension]]
name = 'bolt'
on = 'cut'
force = 4e6
[[step]]
[[step]]
pretension.bolt = { lock = true }
coupling.head = { force = [2e6, 1e6, 5e5] }
";
    let case = Case::in_clusters(&model(text, mesh), 7, 3);
    let ended = case.run(&[]);
    assert_eq!(ended.code(), 0, "{}{}", ended.stdout, ended.stderr);
    assert!(ended.stdout.contains("shortening"), "{}", ended.stdout);
    let steps = Solution::steps(&case.result());
    steps.iter().for_each(Solution::check_certificate);
    assert!(steps[1].slipping() > 0);
    let [first, last] = [&steps[0], &steps[1]].map(|step| tightened(&step.report));
    close(first[0], 4e6, 1e-12 * 4e6);
    close(last[1], first[1], 1e-12 * first[1]);
    let direct = case.folder().join("direct.vtkhdf");
    std::fs::rename(case.result(), &direct).unwrap();
    let expected = datasets(&direct);
    for ranks in [2, 3, 4] {
        let ended = case.run_on(ranks, &[]);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        assert!(datasets(&case.result()) == expected, "{ranks} ranks");
        let again = Solution::steps(&case.result());
        assert_eq!(tightened(&again[1].report), last);
    }
    let ended = case.run(&["--interface", "iterative"]);
    assert_eq!(ended.code(), 0, "{}", ended.stderr);
    let (apart, at) = difference(&direct, &case.result());
    assert!(apart < 1e-8, "{apart:e} in {at}");
}
