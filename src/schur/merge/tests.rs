use faer::Side;
use faer::linalg::solvers::Solve;

use super::*;

fn trace(node: u32) -> InterfaceDof {
    InterfaceDof { node, axis: 0 }
}

/// A symmetric positive definite matrix.
fn spd(n: usize, seed: usize) -> Mat<f64> {
    Mat::from_fn(n, n, |i, j| {
        let (a, b) = (i.max(j), i.min(j));
        let off = ((3 * a + 7 * b + seed) as f64).sin();
        off + if i == j { 2.0 * n as f64 } else { 0.0 }
    })
}

fn child(jumps: usize, nodes: &[u32], seed: usize) -> Condensed {
    let n = jumps + nodes.len();
    let s = spd(n, seed);
    Condensed {
        jumps,
        interface_dofs: nodes.iter().map(|&node| trace(node)).collect(),
        diagonal: (0..n).map(|i| s[(i, i)]).collect(),
        s,
        smallest_pivot: 1.0,
    }
}

/// Two children, their loads, and the sums of both over [0..9 | normal jumps of the first | of the second].
fn example() -> (Vec<Condensed>, [Vec<f64>; 2], Mat<f64>, Vec<f64>) {
    let children = vec![
        child(2, &[0, 2, 3, 5, 7, 8], 1),
        child(1, &[1, 2, 4, 5, 6, 7], 2),
    ];
    let names = |c: &Condensed, first: usize| -> Vec<usize> {
        let jumps = (0..c.jumps).map(move |j| 9 + first + j);
        jumps
            .chain(c.interface_dofs.iter().map(|t| t.node as usize))
            .collect()
    };
    let mut a = Mat::zeros(12, 12);
    let mut f = vec![0.0; 12];
    let load = |seed: usize, n: usize| (0..n).map(|i| ((i + seed) as f64).cos()).collect();
    let loads: [Vec<f64>; 2] = [load(1, 8), load(2, 7)];
    for ((c, first), load) in children.iter().zip([0, 2]).zip(&loads) {
        let name = names(c, first);
        for (i, &to) in name.iter().enumerate() {
            f[to] += load[i];
            for (j, &column) in name.iter().enumerate() {
                a[(to, column)] += c.s[(i, j)];
            }
        }
    }
    (children, loads, a, f)
}

#[test]
fn a_merge_is_the_schur_complement_of_the_sum() {
    let (children, loads, a, f) = example();
    let (merge, condensed) = Merge::new(
        children,
        &[2, 5, 7],
        &[],
        &mut MatrixPool::default(),
        Par::Seq,
    )
    .unwrap();
    let load = merge.condense(&loads.each_ref().map(Vec::as_slice), &[], &[]);
    let gone = [2, 5, 7];
    let kept = [9, 10, 11, 0, 1, 3, 4, 6, 8];
    let part = |rows: &[usize], columns: &[usize]| {
        Mat::from_fn(rows.len(), columns.len(), |i, j| a[(rows[i], columns[j])])
    };
    let solved = part(&gone, &gone).llt(Side::Lower).unwrap();
    let exact = part(&kept, &kept) - part(&kept, &gone) * solved.solve(part(&gone, &kept));
    let f_gone = Mat::from_fn(3, 1, |i, _| f[gone[i]]);
    let taken = part(&kept, &gone) * solved.solve(f_gone);
    assert_eq!((condensed.jumps, condensed.interface_dofs.len()), (3, 6));
    for i in 0..9 {
        assert!((load.boundary()[i] - (f[kept[i]] - taken[(i, 0)])).abs() < 1e-14);
        for j in 0..=i {
            assert!((condensed.s[(i, j)] - exact[(i, j)]).abs() < 1e-13);
        }
    }
}

#[test]
fn what_is_recovered_solves_the_sum() {
    let (children, loads, a, f) = example();
    let exact = a
        .llt(Side::Lower)
        .unwrap()
        .solve(Mat::from_fn(12, 1, |i, _| f[i]));
    let (merge, _) = Merge::new(
        children,
        &[2, 5, 7],
        &[],
        &mut MatrixPool::default(),
        Par::Seq,
    )
    .unwrap();
    let load = merge.condense(&loads.each_ref().map(Vec::as_slice), &[], &[]);
    let kept: Vec<f64> = [9, 10, 11, 0, 1, 3, 4, 6, 8]
        .map(|i| exact[(i, 0)])
        .to_vec();
    let x = merge.recover(&load, &kept);
    for (x, node) in x.children[1].iter().zip([11, 1, 2, 4, 5, 6, 7]) {
        assert!((x - exact[(node, 0)]).abs() < 1e-14);
    }
}

/// A normal jump replaces a kept displacement with kept neighbours, u_5 = ½ u_6 + 2 t.
#[test]
fn a_normal_jump_takes_the_place_of_a_displacement() {
    let (children, loads, a, f) = example();
    let mut t = Mat::<f64>::identity(12, 12);
    (t[(5, 5)], t[(5, 6)]) = (2.0, 0.5);
    let (a, f) = (
        t.transpose() * a * &t,
        t.transpose() * Mat::from_fn(12, 1, |i, _| f[i]),
    );
    let exact = a.llt(Side::Lower).unwrap().solve(&f);
    let replaced = Replaced {
        dof: trace(5),
        staying: vec![(trace(6), 0.5)],
        jumps: vec![(0, 2.0)],
        is_tied: false,
    };
    let (merge, condensed) = Merge::new(
        children,
        &[2, 5, 7],
        &[replaced],
        &mut MatrixPool::default(),
        Par::Seq,
    )
    .unwrap();
    assert_eq!((condensed.jumps, condensed.interface_dofs.len()), (4, 6));
    let (gone, kept) = ([2, 7], [9, 10, 11, 5, 0, 1, 3, 4, 6, 8]);
    let part = |rows: &[usize], columns: &[usize]| {
        Mat::from_fn(rows.len(), columns.len(), |i, j| a[(rows[i], columns[j])])
    };
    let solved = part(&gone, &gone).llt(Side::Lower).unwrap();
    let s = part(&kept, &kept) - part(&kept, &gone) * solved.solve(part(&gone, &kept));
    for i in 0..10 {
        for j in 0..=i {
            assert!((condensed.s[(i, j)] - s[(i, j)]).abs() < 1e-12);
        }
    }
    let load = merge.condense(&loads.each_ref().map(Vec::as_slice), &[], &[]);
    let x = merge.recover(&load, &kept.map(|i| exact[(i, 0)]));
    let u = &t * &exact;
    for (x, node) in x.children[1].iter().zip([11, 1, 2, 4, 5, 6, 7]) {
        assert!((x - u[(node, 0)]).abs() < 1e-14);
    }
}

#[test]
fn an_unknown_that_nothing_holds_is_named() {
    let mut children = vec![child(0, &[1, 2], 3), child(0, &[2, 4], 4)];
    for c in &mut children {
        c.s[(
            usize::from(c.interface_dofs[0] == trace(1)),
            usize::from(c.interface_dofs[0] == trace(1)),
        )] = -50.0;
    }
    let error = Merge::new(children, &[2], &[], &mut MatrixPool::default(), Par::Seq).unwrap_err();
    assert_eq!(error, FreeInterfaceDof(trace(2)));
}

/// The same where the jump is that of a tie, 0.3: of it only the constraint force is recovered.
#[test]
fn a_known_jump_takes_the_place_of_a_displacement_and_has_no_row() {
    let (children, loads, a, f) = example();
    let mut t = Mat::<f64>::identity(12, 12);
    (t[(5, 5)], t[(5, 6)]) = (2.0, 0.5);
    let (a, f) = (
        t.transpose() * a * &t,
        t.transpose() * Mat::from_fn(12, 1, |i, _| f[i]),
    );
    let known = 0.3;
    let free = [0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11];
    let part = |rows: &[usize], columns: &[usize]| {
        Mat::from_fn(rows.len(), columns.len(), |i, j| a[(rows[i], columns[j])])
    };
    let load = Mat::from_fn(11, 1, |i, _| f[(free[i], 0)] - a[(free[i], 5)] * known);
    let solved = part(&free, &free).llt(Side::Lower).unwrap().solve(load);
    let mut exact = Mat::<f64>::zeros(12, 1);
    exact[(5, 0)] = known;
    (free.iter().enumerate()).for_each(|(i, &place)| exact[(place, 0)] = solved[(i, 0)]);
    let replaced = Replaced {
        dof: trace(5),
        staying: vec![(trace(6), 0.5)],
        jumps: vec![(0, 2.0)],
        is_tied: true,
    };
    let spare = &mut MatrixPool::default();
    let (merge, condensed) =
        Merge::new(children, &[2, 5, 7], &[replaced], spare, Par::Seq).unwrap();
    let (gone, kept) = ([2, 7], [9, 10, 11, 0, 1, 3, 4, 6, 8]);
    assert_eq!((condensed.jumps, condensed.interface_dofs.len()), (3, 6));
    let within = part(&gone, &gone).llt(Side::Lower).unwrap();
    let s = part(&kept, &kept) - part(&kept, &gone) * within.solve(part(&gone, &kept));
    for i in 0..9 {
        for j in 0..=i {
            assert!((condensed.s[(i, j)] - s[(i, j)]).abs() < 1e-12);
        }
    }
    let load = merge.condense(&loads.each_ref().map(Vec::as_slice), &[], &[known]);
    let x = merge.recover(&load, &kept.map(|i| exact[(i, 0)]));
    let u = &t * &exact;
    for (x, node) in x.children[1].iter().zip([11, 1, 2, 4, 5, 6, 7]) {
        assert!((x - u[(node, 0)]).abs() < 1e-13);
    }
    let force = f[(5, 0)] - (0..12).map(|i| a[(5, i)] * exact[(i, 0)]).sum::<f64>();
    assert_eq!(x.forces.len(), 1);
    assert!((x.forces[0] - force).abs() < 1e-12 && force.abs() > 1e-3);
    assert!(x.jumps.is_empty());
}
