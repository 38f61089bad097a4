//! The result file, read back by HDF5 itself.

mod beside;
mod keeping;
mod replacing;
mod time_series;

use std::path::Path;

use contact_dd_mpi::fem::contact_state::{ContactRow, ContactState};
use contact_dd_mpi::output::result::{PartitionSize, SubdomainResults};
use contact_dd_mpi::output::vtkhdf::kept::Kept;
use contact_dd_mpi::output::vtkhdf::{Layout, ResultFile};
use contact_dd_mpi::sweep::SweepRecord;
use contact_dd_partition::contact_point::ContactPoint;
use contact_dd_partition::problem::{ContactKind, ContactSummary};
use contact_dd_partition::scene::units::Units;
use hdf5::File;

/// Strips of triangles, the first of them subdomain `first`, with `cells` cells each; every number
/// encodes its place.
fn strips(first: usize, cells: &[usize]) -> SubdomainResults {
    let mut results = SubdomainResults {
        first,
        ..SubdomainResults::default()
    };
    for (index, &cells) in (first..).zip(cells) {
        let size = size(cells);
        let value = |row: usize, component: usize| (1000 * index + 10 * row + component) as f64;
        let three = |row: usize| std::array::from_fn(|c| value(row, c));
        let six = |row: usize| std::array::from_fn(|c| value(row, c));
        let tag = |node: usize| (100 * index + node) as i64;
        results.sizes.push(size);
        results.points.extend((0..size.points).map(three));
        results.node_tags.extend((0..size.points).map(tag));
        results.displacement.extend((0..size.points).map(three));
        results.nodal_stress.extend((0..size.points).map(six));
        let equivalent = (0..size.points).map(|row| value(row, 2));
        results.nodal_von_mises.extend(equivalent);
        let triangle = |cell: i64| [cell, cell + 1, cell + 2];
        let triangles = (0..cells as i64).flat_map(triangle);
        results.connectivity.extend(triangles);
        let offsets = (0..=cells as i64).map(|cell| 3 * cell);
        results.offsets.extend(offsets);
        results.types.extend(vec![5; cells]);
        results.materials.extend(vec![index as i32 % 2; cells]);
        results.cell_stress.extend((0..cells).map(six));
        results.principal.extend((0..cells).map(three));
        results.von_mises.extend((0..cells).map(|c| value(c, 0)));
        results.energy_error.extend((0..cells).map(|c| value(c, 1)));
    }
    results
}

fn size(cells: usize) -> PartitionSize {
    PartitionSize {
        points: if cells == 0 { 0 } else { cells + 2 },
        cells,
        connectivity: 3 * cells,
    }
}

fn row(contact: usize, place: usize) -> ContactRow {
    let position = [contact as f64, place as f64, 0.0];
    let tag_a = (100 * contact + place) as i64;
    let point = ContactPoint {
        contact: contact as u32,
        place: place as u32,
        area: 2.0 / 3.0,
        ..ContactPoint::new(Vec::new(), [0.0, 1.0, 0.0], position, tag_a)
    };
    let state = ContactState {
        gap: place as f64,
        force: 2.0,
        closed: place % 2 == 1,
        tangential_force: [0.25, place as f64, 0.0],
        slip: [place as f64, 0.5, 0.0],
        slipping: place == 3,
        ..ContactState::default()
    };
    (point, state)
}

fn layout(cells: &[usize], conditions: &[usize]) -> Layout {
    let contact = |(c, &conditions): (usize, &usize)| ContactSummary {
        kind: ContactKind::default(),
        name: format!("crack {c}"),
        conditions,
        has_friction: c == 0,
        is_compliant: false,
    };
    Layout {
        partitions: cells.iter().map(|&cells| size(cells)).collect(),
        contacts: conditions.iter().enumerate().map(contact).collect(),
        times: Vec::new(),
        stress: true,
        presence: false,
        quantities: false,
        title: "Two cracks".to_owned(),
        units: Units::Millimetre,
        plane: None,
    }
}

/// Runs of subdomains (the first one, and how many) in the order of `runs`, contact rows back to
/// front in two portions.
fn write(path: &Path, cells: &[usize], runs: &[(usize, usize)], report: &str) {
    let mut file = ResultFile::create(path, &layout(cells, &[5, 0, 2])).unwrap();
    for &(first, count) in runs {
        file.write_subdomains(&strips(first, &cells[first..first + count]))
            .unwrap();
    }
    file.write_contacts(&[row(2, 1), row(0, 4), row(0, 1), row(0, 0)])
        .unwrap();
    file.write_contacts(&[row(0, 3), row(2, 0), row(0, 2)])
        .unwrap();
    file.finish_step().unwrap();
    let start = SweepRecord {
        sweep: 0,
        residual: 0.5,
        active: 7,
        changed: None,
        seconds: 0.25,
    };
    file.write_convergence([&[start][..]].into_iter()).unwrap();
    file.finish(report).unwrap();
}

fn column<T: hdf5::H5Type>(file: &File, name: &str) -> Vec<T> {
    file.dataset(name).unwrap().read_raw().unwrap()
}

/// Every single subdomain, in their order.
fn one_by_one(cells: &[usize]) -> Vec<(usize, usize)> {
    (0..cells.len()).map(|s| (s, 1)).collect()
}

#[test]
fn neither_the_order_of_arrival_nor_the_cuts_leave_a_trace() {
    let folder = tempfile::tempdir().unwrap();
    let cells = [3, 0, 1, 2];
    let first = folder.path().join("first");
    write(&first, &cells, &one_by_one(&cells), "{}");
    let first = File::open(first).unwrap();
    for (name, runs) in [
        ("backward", vec![(3, 1), (1, 1), (0, 1), (2, 1)]),
        ("two runs", vec![(2, 2), (0, 2)]),
        ("nothing in a run", vec![(1, 1), (4, 0), (2, 2), (0, 1)]),
        ("at once", vec![(0, 4)]),
    ] {
        let other = folder.path().join(name);
        write(&other, &cells, &runs, "{}");
        let other = File::open(other).unwrap();
        for array in [
            "Points",
            "PointData/Displacement",
            "PointData/Stress",
            "PointData/VonMises",
            "CellData/Stress",
            "CellData/PrincipalStress",
            "CellData/VonMises",
        ] {
            let array = format!("VTKHDF/{array}");
            let (first, other) = (column::<f64>(&first, &array), column::<f64>(&other, &array));
            assert_eq!(first, other, "{array} of '{name}'");
        }
        for array in [
            "Connectivity",
            "Offsets",
            "Types",
            "PointData/GlobalNodeId",
            "CellData/Subdomain",
            "CellData/Material",
        ] {
            let array = format!("VTKHDF/{array}");
            let (first, other) = (column::<i64>(&first, &array), column::<i64>(&other, &array));
            assert_eq!(first, other, "{array} of '{name}'");
        }
    }
}

#[test]
fn slabs_hold_all_subdomains_in_order_and_none_holds_many_nodes_of_several() {
    let folder = tempfile::tempdir().unwrap();
    let cells = [0, 100, 20_000, 7, 0, 5_000, 5_000, 5_000, 5_000, 50, 50];
    let path = folder.path().join("result.vtkhdf");
    let file = ResultFile::create(&path, &layout(&cells, &[])).unwrap();
    let slabs = file.slabs();
    let held: Vec<usize> = slabs.iter().cloned().flatten().collect();
    assert_eq!(held, (0..cells.len()).collect::<Vec<_>>());
    assert!(slabs.contains(&(2..3)), "{slabs:?}");
    assert_eq!(slabs.len(), 4, "{slabs:?}");
}

#[test]
fn numbers_have_the_same_types_in_the_file_as_in_memory() {
    use hdf5::types::{FloatSize, IntSize, TypeDescriptor};
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    write(&path, &[2], &[(0, 1)], "{}");
    let grid = File::open(&path).unwrap().group("VTKHDF").unwrap();
    for (array, kind) in [
        ("Points", TypeDescriptor::Float(FloatSize::U8)),
        ("Connectivity", TypeDescriptor::Integer(IntSize::U8)),
        ("Offsets", TypeDescriptor::Integer(IntSize::U8)),
        ("Types", TypeDescriptor::Unsigned(IntSize::U1)),
        (
            "PointData/GlobalNodeId",
            TypeDescriptor::Integer(IntSize::U8),
        ),
        ("PointData/Stress", TypeDescriptor::Float(FloatSize::U8)),
        ("PointData/VonMises", TypeDescriptor::Float(FloatSize::U8)),
        ("CellData/Subdomain", TypeDescriptor::Integer(IntSize::U4)),
        ("CellData/Material", TypeDescriptor::Integer(IntSize::U4)),
        ("CellData/VonMises", TypeDescriptor::Float(FloatSize::U8)),
    ] {
        let stored = grid.dataset(array).unwrap().dtype().unwrap();
        assert_eq!(stored.to_descriptor().unwrap(), kind, "{array}");
    }
}

#[test]
fn every_partition_is_a_slice_that_stands_for_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let cells = [3, 0, 1, 2];
    write(&path, &cells, &[(2, 1), (0, 2), (3, 1)], "{}");
    let file = File::open(&path).unwrap();
    let grid = |name: &str| column::<i64>(&file, &format!("VTKHDF/{name}"));
    assert_eq!(grid("NumberOfPoints"), [5, 0, 3, 4]);
    assert_eq!(grid("NumberOfCells"), [3, 0, 1, 2]);
    assert_eq!(grid("NumberOfConnectivityIds"), [9, 0, 3, 6]);
    assert_eq!(grid("Offsets"), [0, 3, 6, 9, 0, 0, 3, 0, 3, 6]);
    assert_eq!(grid("Connectivity")[9..], [0, 1, 2, 0, 1, 2, 1, 2, 3]);
    assert_eq!(grid("CellData/Subdomain"), [0, 0, 0, 2, 3, 3]);
    assert_eq!(grid("CellData/Material"), [0, 0, 0, 0, 1, 1]);
    assert_eq!(grid("PointData/GlobalNodeId")[5..8], [200, 201, 202]);
    assert_eq!(column::<u8>(&file, "VTKHDF/Types"), [5; 6]);
    let stress = file.dataset("VTKHDF/CellData/Stress").unwrap();
    assert_eq!(stress.shape(), [6, 6]);
    assert_eq!(
        stress.read_2d::<f64>().unwrap().row(3).to_vec(),
        [2000.0, 2001.0, 2002.0, 2003.0, 2004.0, 2005.0]
    );
}

#[test]
fn contact_rows_find_their_places() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    write(&path, &[1], &[(0, 1)], "{}");
    let file = File::open(&path).unwrap();
    assert_eq!(
        column::<i64>(&file, "contact/crack 0/node_a"),
        [0, 1, 2, 3, 4]
    );
    assert_eq!(column::<i64>(&file, "contact/crack 2/node_a"), [200, 201]);
    assert_eq!(
        column::<f64>(&file, "contact/crack 0/gap"),
        [0.0, 1.0, 2.0, 3.0, 4.0]
    );
    assert_eq!(
        column::<u8>(&file, "contact/crack 0/status"),
        [0, 1, 0, 2, 0]
    );
    assert_eq!(
        file.dataset("contact/crack 1/normal").unwrap().shape(),
        [0, 3]
    );
    assert_eq!(column::<i64>(&file, "convergence/active"), [7]);
}

#[test]
fn contacts_with_friction_have_tangential_forces_and_slip_in_every_load_step() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let mut in_steps = layout(&[], &[2, 1]);
    in_steps.times = vec![0.5, 0.75];
    let mut file = ResultFile::create(&path, &in_steps).unwrap();
    for step in 0..2 {
        if step == 1 {
            // As after a run that was stopped.
            file.keep(b"state").unwrap();
            drop(file);
            file =
                ResultFile::resume(&path, &in_steps, Kept::read(&path).unwrap().unwrap()).unwrap();
        }
        let moved = |(point, mut state): ContactRow| {
            state.slip[1] += f64::from(step);
            (point, state)
        };
        file.write_contacts(&[row(0, 0), row(1, 0), row(0, 1)].map(moved))
            .unwrap();
        file.finish_step().unwrap();
    }
    file.finish("{}").unwrap();
    let file = File::open(&path).unwrap();
    let frictionless = file.group("contact/crack 1").unwrap();
    assert!(!frictionless.link_exists("slip") && !frictionless.link_exists("tangential_force"));
    let slip = file.dataset("contact/crack 0/slip").unwrap();
    assert_eq!(slip.shape(), [2, 2, 3]);
    let of_step = |y: f64| [0.0, y, 0.0, 1.0, y, 0.0];
    assert_eq!(
        slip.read_raw::<f64>().unwrap(),
        [of_step(0.5), of_step(1.5)].concat()
    );
    let forces = column::<f64>(&file, "contact/crack 0/tangential_force");
    assert_eq!(forces[..6], [0.25, 0.0, 0.0, 0.25, 1.0, 0.0]);
}

#[test]
fn the_type_attribute_leaves_no_room_for_a_terminator() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    write(&path, &[1], &[(0, 1)], "{}");
    let grid = File::open(&path).unwrap().group("VTKHDF").unwrap();
    let kind = grid.attr("Type").unwrap();
    assert_eq!(kind.dtype().unwrap().size(), "UnstructuredGrid".len());
    let text: hdf5::types::FixedAscii<16> = kind.read_scalar().unwrap();
    assert_eq!(text.as_str(), "UnstructuredGrid");
    assert_eq!(
        grid.attr("Version").unwrap().read_raw::<i64>().unwrap(),
        [2, 0]
    );
}

#[test]
fn a_report_may_be_longer_than_an_attribute_of_fixed_length() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let report = format!("{{\"warnings\": [\"{}\"]}}", "Γ".repeat(100_000));
    write(&path, &[1], &[(0, 1)], &report);
    let file = File::open(&path).unwrap();
    let read: hdf5::types::VarLenUnicode = file.attr("report").unwrap().read_scalar().unwrap();
    assert_eq!(read.as_str(), report);
}
