//! Load steps as a time series.

use contact_dd_mpi::output::vtkhdf::ResultFile;
use contact_dd_mpi::sweep::SweepRecord;
use hdf5::File;

use super::{column, layout, row, strips};

#[test]
fn load_steps_follow_one_another_on_one_mesh() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.vtkhdf");
    let cells = [2, 3];
    let mut layout = layout(&cells, &[2]);
    layout.times = vec![0.5, 0.75, 2.0];
    let mut file = ResultFile::create(&path, &layout).unwrap();
    for k in 0..3 {
        let factor = f64::from(k + 1);
        let mut results = strips(0, &cells);
        let displacement = results.displacement.iter_mut().flatten();
        displacement.for_each(|u| *u *= factor);
        results.von_mises.iter_mut().for_each(|s| *s *= factor);
        file.write_subdomains(&results).unwrap();
        let mut rows = [row(0, 0), row(0, 1)];
        rows.iter_mut().for_each(|(_, state)| state.force *= factor);
        file.write_contacts(&rows).unwrap();
        file.finish_step().unwrap();
    }
    let history = [0, 1].map(|sweep| SweepRecord {
        sweep,
        residual: 0.5,
        active: 7,
        changed: None,
        seconds: 0.25,
    });
    let histories = [&history[..], &history[..1], &history[..1]];
    file.write_convergence(histories.into_iter()).unwrap();
    file.finish("{}").unwrap();

    let file = File::open(&path).unwrap();
    let once = strips(0, &cells);
    let reals = |name: &str| column::<f64>(&file, name);
    let integers = |name: &str| column::<i64>(&file, name);
    assert_eq!(reals("VTKHDF/Points"), once.points.concat());
    assert_eq!(integers("VTKHDF/Connectivity"), once.connectivity);
    let times = |list: &[f64]| -> Vec<f64> {
        let factors = [1.0, 2.0, 3.0].into_iter();
        factors
            .flat_map(|f| list.iter().map(move |x| f * x))
            .collect()
    };
    let displacement = reals("VTKHDF/PointData/Displacement");
    assert_eq!(displacement, times(&once.displacement.concat()));
    assert_eq!(reals("VTKHDF/CellData/VonMises"), times(&once.von_mises));
    assert_eq!(reals("contact/crack 0/force"), times(&[2.0, 2.0]));
    let force = file.dataset("contact/crack 0/force").unwrap();
    assert_eq!(force.shape(), [3, 2]);
    assert_eq!(integers("convergence/step"), [0, 0, 1, 2]);

    let steps = file.group("VTKHDF/Steps").unwrap();
    let count: i64 = steps.attr("NSteps").unwrap().read_scalar().unwrap();
    assert_eq!(count, 3);
    assert_eq!(reals("VTKHDF/Steps/Values"), [0.5, 0.75, 2.0]);
    for (name, expected) in [
        ("NumberOfParts", [2, 2, 2]),
        ("PartOffsets", [0, 0, 0]),
        ("PointOffsets", [0, 0, 0]),
        ("CellOffsets", [0, 0, 0]),
        ("ConnectivityIdOffsets", [0, 0, 0]),
        ("PointDataOffsets/GlobalNodeId", [0, 0, 0]),
        ("PointDataOffsets/Displacement", [0, 9, 18]),
        ("CellDataOffsets/Material", [0, 0, 0]),
        ("CellDataOffsets/VonMises", [0, 5, 10]),
    ] {
        assert_eq!(
            integers(&format!("VTKHDF/Steps/{name}")),
            expected,
            "{name}"
        );
    }
}
