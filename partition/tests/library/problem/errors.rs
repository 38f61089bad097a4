//! Every defect of a problem file is an error that names the file, the dataset and the row.

mod contradictions;
mod files;
mod settings;

use std::path::Path;

use crate::problem_scenes::stacked;
use crate::says::says;
use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::problem::Problem;
use contact_dd_partition::problem::read::ProblemFile;

fn stack(blocks: usize) -> Problem {
    let model = stacked(blocks, 4, 3);
    let decomposition = Decomposition::new(&model, Some(4)).unwrap();
    Problem::new(&model, &decomposition).unwrap()
}

fn problem() -> Problem {
    stack(2)
}

fn write(path: &Path) {
    problem().write(path).unwrap();
}

/// A file with two contacts.
fn write_two_joints(path: &Path) {
    stack(3).write(path).unwrap();
}

/// Overwrites entry `at` of a dataset (counted through all dimensions).
fn set<T: hdf5::H5Type + Clone>(file: &hdf5::File, name: &str, at: usize, value: T) {
    let dataset = file.dataset(name).unwrap();
    let mut data = dataset.read_raw::<T>().unwrap();
    data[at] = value;
    dataset.write_raw(&data).unwrap();
}

/// Replaces a dataset by one of another shape or type.
fn replace<T: hdf5::H5Type>(file: &hdf5::File, name: &str, shape: &[usize], data: &[T]) {
    file.unlink(name).unwrap();
    let dataset = file.new_dataset::<T>().shape(shape).create(name).unwrap();
    dataset.write_raw(data).unwrap();
}

type Defect = (&'static str, fn(&hdf5::File), &'static str);

/// Fails unless a file that `write` makes is refused as expected once it is damaged.
fn refuse(write: fn(&Path), what: &str, damage: &dyn Fn(&hdf5::File), expected: &str) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    write(&path);
    ProblemFile::open(&path).unwrap().problem().unwrap();
    let file = hdf5::File::open_rw(&path).unwrap();
    damage(&file);
    file.close().unwrap();
    let message = match ProblemFile::open(&path).and_then(|file| file.problem()) {
        Ok(_) => panic!("{what}: accepted"),
        Err(error) => error.to_string(),
    };
    assert!(message.starts_with(path.to_str().unwrap()), "{message}");
    says(&format!("{what}: {message}"), expected);
}

fn refuses(write: fn(&Path), defects: &[Defect]) {
    for (what, damage, expected) in defects {
        refuse(write, what, damage, expected);
    }
}

/// Fails unless a file that `write` makes is refused with a single entry of a dataset changed, or without a dataset: a
/// line of the `table` each, followed by the expected message.
fn refuses_values(write: fn(&Path), table: &str) {
    for [damage, expected] in table.trim().lines().collect::<Vec<_>>().as_chunks().0 {
        let (what, rest) = damage.split_once(": ").unwrap();
        let damage = |file: &hdf5::File| {
            let Some((place, value)) = rest.split_once(" = ") else {
                return file.unlink(rest.trim_start_matches("without ")).unwrap();
            };
            let (name, at) = place.trim_end_matches(']').split_once('[').unwrap();
            let at: usize = at.parse().unwrap();
            match value.parse::<i64>() {
                Ok(integer) => set(file, name, at, integer),
                Err(_) => set(file, name, at, value.parse::<f64>().unwrap()),
            }
        };
        refuse(write, what, &damage, expected.trim());
    }
}

/// Invalid entries of datasets with the expected messages.
const VALUES: &str = "
point that isn't finite: /VTKHDF/Points[3] = nan
    /VTKHDF/Points, row 1 … finite
point beside the plane: /VTKHDF/Points[5] = 1.0
    /VTKHDF/Points, row 1 … expected 0
sizes that don't add up: /VTKHDF/NumberOfPoints[3] = 1
    /VTKHDF/NumberOfPoints, row 3 … that of points
a size beyond all measure: /VTKHDF/NumberOfCells[0] = 9223372036854775807
    /VTKHDF/NumberOfCells, row 0
cell type: /VTKHDF/Types[2] = 10
    /VTKHDF/Types, row 2 … type 10 … expected 5 (triangle of 3 nodes), 22 (triangle of 6 nodes), 9 (
type of a line: /VTKHDF/Types[2] = 21
    /VTKHDF/Types, row 2 … type 21 … expected 5
type of more nodes: /VTKHDF/Types[2] = 9
    /VTKHDF/Offsets, row 2 … expected 6 to 10
node of a cell: /VTKHDF/Connectivity[4] = 999
    /VTKHDF/Connectivity, row 4 … 999
offset of a cell: /VTKHDF/Offsets[1] = 4
    /VTKHDF/Offsets … expected 0 to 3
material of a cell: /VTKHDF/CellData/Material[0] = 7
    /VTKHDF/CellData/Material, row 0 … expected 0 to 1
stiffness that isn't symmetric: /materials/stiffness[1] = 99.0
    /materials/stiffness, row 0 … symmetric
stiffness that isn't positive: /materials/stiffness[9] = -2.0
    /materials/stiffness, row 1 … positive
poisson: /materials/poisson[0] = 0.7
    /materials/poisson, row 0 … 0.7
half a row out of plane: /materials/out_of_plane[0] = nan
    /materials/out_of_plane, row 0
body: /subdomains/body[0] = 5
    /subdomains/body, row 0 … 5 is no body
group: /subdomains/group[0] = -2
    /subdomains/group, row 0 … -1
parent that is a subdomain: /hierarchy/parent[0] = 1
    /hierarchy/parent, row 0 … 1 is no parent … 4 to 6
parent before its child: /hierarchy/parent[4] = 4
    /hierarchy/parent, row 4 … expected -1 … 5 to 6
offsets that fall: /interface/offset[1] = 1000
    /interface/offset, row 1 … 1000
interface in disorder: /interface/interface[0] = 4
    /interface/interface
interface node: /interface/node[0] = -1
    /interface/node, row 0 … -1
direction that isn't a unit vector: /support/direction[0] = 2.0
    /support/direction, row 0 … expected 1
force that isn't finite: /force/value[1] = inf
    /force/value, row 0 … finite
contact: /contact/contact[2] = 3
    /contact/contact, row 2
place that occurs twice: /contact/place[1] = 0
    /contact/place, row 1 … once
normal: /contact/normal[0] = 3.0
    /contact/normal, row 0
entry's node: /contact/entry_node[0] = 12345
    /contact/entry_node, row 0 … 12345
no supports: without /support
    group /support is missing … empty where nothing
no tree: without /hierarchy
    /hierarchy/parent is missing
missing points: without /VTKHDF/Points
    /VTKHDF/Points is missing
";

#[test]
fn every_defect_is_named() {
    let defects: &[Defect] = &[
        (
            "no format",
            |f| f.delete_attr("format").unwrap(),
            "no problem file … attribute format",
        ),
        (
            "another format",
            |f| {
                f.delete_attr("format").unwrap();
                f.new_attr::<i64>().create("format").unwrap();
                f.create_group("ENS_MAA").unwrap();
            },
            "attribute format is … that of a problem file",
        ),
        (
            "another version",
            |f| f.attr("version").unwrap().write_scalar(&9i64).unwrap(),
            "version is 9 … expected 2",
        ),
        (
            "the version before",
            |f| f.attr("version").unwrap().write_scalar(&1i64).unwrap(),
            "version 1 … expected 2 … again with contact-dd-partition",
        ),
        (
            "three dimensions",
            |f| f.attr("dimension").unwrap().write_scalar(&3i64).unwrap(),
            "plane is \"strain\" … none in 3 dimensions",
        ),
        (
            "four dimensions",
            |f| f.attr("dimension").unwrap().write_scalar(&4i64).unwrap(),
            "dimension is 4 … expected 2 or 3",
        ),
        (
            "flat points",
            |f| replace(f, "/VTKHDF/Points", &[2, 2], &[0.0; 4]),
            "/VTKHDF/Points … [2, 2] … [P, 3]",
        ),
        (
            "cell turned over",
            |f| {
                let nodes: Vec<i64> = f
                    .dataset("/VTKHDF/Connectivity")
                    .unwrap()
                    .read_raw()
                    .unwrap();
                set(f, "/VTKHDF/Connectivity", 0, nodes[1]);
                set(f, "/VTKHDF/Connectivity", 1, nodes[0]);
            },
            "/VTKHDF/Connectivity, row 0 … counter-clockwise",
        ),
        (
            "tag that occurs twice",
            |f| {
                let name = "/VTKHDF/PointData/GlobalNodeId";
                let tags: Vec<i64> = f.dataset(name).unwrap().read_raw().unwrap();
                set(f, name, 1, tags[0]);
            },
            "GlobalNodeId, row 1",
        ),
        (
            "tree without a row for each subdomain",
            |f| replace(f, "/hierarchy/parent", &[3], &[-1i64; 3]),
            "/hierarchy/parent … 3 rows … 4 subdomains",
        ),
        (
            "inner node without a child",
            |f| replace(f, "/hierarchy/parent", &[5], &[-1i64; 5]),
            "/hierarchy/parent, row 4 … no child",
        ),
        (
            "subdomain in two clusters",
            |f| replace(f, "/hierarchy/cluster", &[2], &[0i64, 6]),
            "/hierarchy/cluster … subdomain 0 is in 2 clusters",
        ),
        (
            "directions that aren't orthogonal",
            |f| {
                set(f, "/support/direction", 2, 0.6);
                set(f, "/support/direction", 3, 0.8);
            },
            "/support/direction, row 1 … orthogonal",
        ),
        (
            "nodes that aren't integers",
            |f| {
                let rows = f.dataset("/support/node").unwrap().shape()[0];
                replace(f, "/support/node", &[rows], &vec![0.5; rows]);
            },
            "/support/node … expected integers",
        ),
        (
            "entry's subdomain",
            |f| {
                let entries = f.dataset("/contact/entry_subdomain").unwrap();
                let subdomain = entries.read_raw::<i64>().unwrap()[0];
                set(f, "/subdomains/group", subdomain as usize, -1i64);
            },
            "/contact/entry_subdomain, row 0 … isn't in group 0",
        ),
        (
            "zero row",
            |f| {
                set(f, "/contact/entry_weight", 0, 0.0);
                set(f, "/contact/entry_weight", 1, 0.0);
            },
            "/contact/entry_offset, row 0 … zero",
        ),
        (
            "copies of a node that differ",
            |f| {
                let node: Vec<i64> = f.dataset("/interface/node").unwrap().read_raw().unwrap();
                set(
                    f,
                    "/VTKHDF/PointData/GlobalNodeId",
                    node[0] as usize,
                    999_999i64,
                );
            },
            "on Γ … tag",
        ),
        (
            "more declared than stored",
            |f| {
                f.unlink("/VTKHDF/Types").unwrap();
                let shape = 1usize << 50;
                let builder = f.new_dataset::<u8>().chunk(1024).shape(shape);
                builder.create("/VTKHDF/Types").unwrap();
            },
            "/VTKHDF/Types … holds only",
        ),
    ];
    refuses(write, defects);
    refuses_values(write, VALUES);
}
