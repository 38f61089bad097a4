//! The result file, read back by HDF5 itself.

#![expect(clippy::unwrap_used, reason = "a test that can't go on has failed")]

use std::fs;
use std::path::Path;

use contact_dd_mpi::output::result::{ContactResult, ConvergenceRow, SubdomainResult};
use contact_dd_mpi::output::vtkhdf::{Layout, PartitionSize, ResultFile};
use contact_dd_partition::element::{ElementKind, Elements};
use contact_dd_partition::problem::ContactSummary;
use hdf5::File;

/// A strip of `cells` triangles whose every number tells where it belongs.
fn subdomain(index: usize, cells: usize) -> SubdomainResult {
    let nodes = if cells == 0 { 0 } else { cells + 2 };
    let value = |node: usize, component: usize| (1000 * index + 10 * node + component) as f64;
    let six = |i: usize| std::array::from_fn(|c| value(i, c));
    let three = |i: usize| std::array::from_fn(|c| value(i, c));
    let mut elements = Elements::default();
    for cell in 0..cells as u32 {
        elements.push(ElementKind::Triangle3, &[cell, cell + 1, cell + 2]);
    }
    SubdomainResult {
        index,
        points: (0..nodes).map(three).collect(),
        node_tags: (0..nodes).map(|n| (100 * index + n) as i64).collect(),
        cells: elements,
        cell_material: vec![index as u32 % 2; cells],
        displacement: (0..nodes).map(three).collect(),
        nodal_stress: (0..nodes).map(six).collect(),
        cell_stress: (0..cells).map(six).collect(),
        principal: (0..cells).map(three).collect(),
        von_mises: (0..cells).map(|c| value(c, 0)).collect(),
    }
}

fn row(contact: usize, place: usize) -> ContactResult {
    ContactResult {
        contact,
        place,
        tag_a: (100 * contact + place) as i64,
        tag_b: -1,
        position: [contact as f64, place as f64, 0.0],
        normal: [0.0, 1.0, 0.0],
        gap: place as f64,
        force: 2.0,
        pressure: 3.0,
        closed: place % 2 == 1,
    }
}

fn layout(subdomains: &[SubdomainResult], conditions: &[usize]) -> Layout {
    let size = |subdomain: &SubdomainResult| PartitionSize {
        points: subdomain.points.len(),
        cells: subdomain.cells.len(),
        connectivity: subdomain.cells.connectivity().len(),
    };
    let contact = |(c, &conditions): (usize, &usize)| ContactSummary {
        name: format!("crack {c}"),
        conditions,
    };
    Layout {
        partitions: subdomains.iter().map(size).collect(),
        contacts: conditions.iter().enumerate().map(contact).collect(),
    }
}

/// Subdomains in the order of `order`, contact rows back to front in two portions.
fn write(path: &Path, cells: &[usize], order: &[usize], report: &str) {
    let subdomains: Vec<_> = cells
        .iter()
        .enumerate()
        .map(|(i, &c)| subdomain(i, c))
        .collect();
    let mut file = ResultFile::create(path, &layout(&subdomains, &[5, 0, 2])).unwrap();
    for &index in order {
        file.write_subdomain(&subdomains[index]).unwrap();
    }
    file.write_contacts(&[row(2, 1), row(0, 4), row(0, 1), row(0, 0)])
        .unwrap();
    file.write_contacts(&[row(0, 3), row(2, 0), row(0, 2)])
        .unwrap();
    file.write_convergence(&[ConvergenceRow {
        residual: 0.5,
        active: 7,
        seconds: 0.25,
    }])
    .unwrap();
    file.finish(report).unwrap();
}

fn column<T: hdf5::H5Type>(file: &File, name: &str) -> Vec<T> {
    file.dataset(name).unwrap().read_raw().unwrap()
}

#[test]
fn the_order_of_arrival_leaves_no_trace() {
    let folder = tempfile::tempdir().unwrap();
    let cells = [3, 0, 1, 2];
    let (forward, backward) = (
        folder.path().join("forward"),
        folder.path().join("backward"),
    );
    write(&forward, &cells, &[0, 1, 2, 3], "{}");
    write(&backward, &cells, &[3, 1, 0, 2], "{}");
    let (forward, backward) = (File::open(forward).unwrap(), File::open(backward).unwrap());
    for name in [
        "Points",
        "PointData/Displacement",
        "PointData/Stress",
        "CellData/Stress",
    ] {
        let name = format!("VTKHDF/{name}");
        assert_eq!(
            column::<f64>(&forward, &name),
            column::<f64>(&backward, &name)
        );
    }
    for name in [
        "Connectivity",
        "Offsets",
        "PointData/GlobalNodeId",
        "CellData/Subdomain",
    ] {
        let name = format!("VTKHDF/{name}");
        assert_eq!(
            column::<i64>(&forward, &name),
            column::<i64>(&backward, &name)
        );
    }
}

#[test]
fn every_partition_is_a_slice_that_stands_for_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let cells = [3, 0, 1, 2];
    write(&path, &cells, &[2, 0, 3, 1], "{}");
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
    write(&path, &[1], &[0], "{}");
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
        [0, 1, 0, 1, 0]
    );
    assert_eq!(
        file.dataset("contact/crack 1/normal").unwrap().shape(),
        [0, 3]
    );
    assert_eq!(column::<i64>(&file, "convergence/active"), [7]);
}

#[test]
fn the_type_attribute_leaves_no_room_for_a_terminator() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    write(&path, &[1], &[0], "{}");
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
    write(&path, &[1], &[0], &report);
    let file = File::open(&path).unwrap();
    let read: hdf5::types::VarLenUnicode = file.attr("report").unwrap().read_scalar().unwrap();
    assert_eq!(read.as_str(), report);
}

#[test]
fn what_is_not_whole_replaces_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    fs::write(&path, "the result of yesterday").unwrap();
    let subdomains = [subdomain(0, 1), subdomain(1, 2)];

    let mut file = ResultFile::create(&path, &layout(&subdomains, &[])).unwrap();
    file.write_subdomain(&subdomains[1]).unwrap();
    let error = file.finish("{}").unwrap_err().to_string();
    assert!(
        error.contains("result.vtkhdf") && error.contains("subdomain 0 is missing"),
        "{error}"
    );

    let mut file = ResultFile::create(&path, &layout(&[], &[2])).unwrap();
    file.write_contacts(&[row(0, 1)]).unwrap();
    let error = file.finish("{}").unwrap_err().to_string();
    assert!(
        error.contains("'crack 0': condition 0 is missing"),
        "{error}"
    );

    drop(ResultFile::create(&path, &layout(&subdomains, &[])).unwrap());
    assert_eq!(
        fs::read_to_string(&path).unwrap(),
        "the result of yesterday"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn what_has_no_place_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let mut file = ResultFile::create(&path, &layout(&[subdomain(0, 2)], &[2])).unwrap();
    assert!(file.write_subdomain(&subdomain(1, 2)).is_err());
    let mut short = subdomain(0, 2);
    short.displacement.pop();
    let error = file.write_subdomain(&short).unwrap_err().to_string();
    assert!(error.contains("3 displacements; expected 4"), "{error}");
    assert!(file.write_contacts(&[row(1, 0)]).is_err());
    assert!(file.write_contacts(&[row(0, 1), row(0, 2)]).is_err());
}

#[test]
fn a_finished_file_replaces_the_one_before() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    write(&path, &[1], &[0], "{}");
    write(&path, &[4], &[0], "{}");
    let file = File::open(&path).unwrap();
    assert_eq!(column::<i64>(&file, "VTKHDF/NumberOfCells"), [4]);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
