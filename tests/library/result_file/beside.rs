//! Parallel writing of a result file by several ranks.

use contact_dd_mpi::output::vtkhdf::ResultFile;
use contact_dd_mpi::output::vtkhdf::beside::FileBeside;

use super::*;

#[test]
fn what_ranks_write_beside_each_other_is_what_the_root_writes_alone() {
    let folder = tempfile::tempdir().unwrap();
    let cells = [3, 0, 1, 2];
    let mut in_steps = layout(&cells, &[]);
    in_steps.times = vec![0.5, 1.0];
    let moved = |run: &std::ops::Range<usize>, step: usize| {
        let mut results = strips(run.start, &cells[run.clone()]);
        results
            .displacement
            .iter_mut()
            .for_each(|u| u[0] += step as f64);
        results
    };
    let runs = [2..4, 0..1, 1..2];

    let alone = folder.path().join("alone");
    let mut file = ResultFile::create(&alone, &in_steps).unwrap();
    for step in 0..2 {
        for run in &runs {
            file.write_subdomains(&moved(run, step)).unwrap();
        }
        file.finish_step().unwrap();
    }
    file.finish("{}").unwrap();

    let path = folder.path().join("together");
    let mut file = ResultFile::create(&path, &in_steps).unwrap();
    let places = file.places().unwrap();
    let open = || FileBeside::open(&places, &path, &in_steps, 1).unwrap();
    let mut ranks = [open(), open()];
    for step in 0..2 {
        for (k, run) in runs.iter().enumerate() {
            ranks[k % 2].write(&moved(run, step)).unwrap();
        }
        let digests = ranks.each_mut().map(|rank| rank.finish_step(1).unwrap());
        file.take_as_written(&digests);
        file.finish_step().unwrap();
        if step == 0 {
            // As between steps of a run that may be stopped, whose file gets another name.
            file.keep(b"state").unwrap();
        }
    }
    file.finish("{}").unwrap();

    let [alone, together] = [alone, path].map(|path| File::open(path).unwrap());
    let grid = alone.group("VTKHDF").unwrap();
    let groups = [grid.group("PointData"), grid.group("CellData"), Ok(grid)];
    for dataset in groups
        .into_iter()
        .flat_map(|g| g.unwrap().datasets().unwrap())
    {
        let name = dataset.name();
        let [a, b] = [&alone, &together].map(|file| column::<f64>(file, &name));
        assert_eq!(a, b, "{name}");
    }
}

#[test]
fn a_file_that_isnt_the_roots_or_several_hosts_may_not_write_at_once_isnt_opened() {
    let folder = tempfile::tempdir().unwrap();
    let layout = layout(&[1], &[]);
    let path = folder.path().join("result");
    let file = ResultFile::create(&path, &layout).unwrap();
    let places = file.places().unwrap();
    assert!(FileBeside::open(&places, &path, &layout, 1).is_some());
    // That of another host under the same name; a folder for temporary files is no parallel file system.
    let temporary = std::fs::read_dir(folder.path()).unwrap().next().unwrap();
    let temporary = temporary.unwrap().path();
    assert!(FileBeside::open(&places, &path, &layout, 2).is_none());
    std::fs::rename(&temporary, folder.path().join("elsewhere")).unwrap();
    assert!(FileBeside::open(&places, &path, &layout, 1).is_none());
    std::fs::write(&temporary, "another").unwrap();
    assert!(FileBeside::open(&places, &path, &layout, 1).is_none());
}
