//! The kernels of a run, each by itself: `cargo bench --bench kernels`.

#![allow(
    missing_docs,
    clippy::unwrap_used,
    reason = "a benchmark that can't go on has failed"
)]

mod scene;

use std::hint::black_box;
use std::time::Duration;

use contact_dd_mpi::certificate::BlockCheck;
use contact_dd_mpi::contact::pair::{ContactPair, Limits};
use contact_dd_mpi::fem::assembly::assemble;
use contact_dd_mpi::fem::balance::Balance;
use contact_dd_mpi::fem::dofs::Dofs;
use contact_dd_mpi::fem::stress::BlockStress;
use contact_dd_mpi::interface::numbering::Numbering;
use contact_dd_mpi::interface::operator::{Contribution, Interface};
use contact_dd_mpi::rigid::energy::RigidDrive;
use contact_dd_mpi::schur::local::{CondensedLoad, LocalSchur};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use faer::Par;

use scene::Scene;

/// One linear subdomain of about 2 000 and of about 20 000 dofs.
fn subdomain(c: &mut Criterion) {
    for (refine, count, size) in [(2, 40, "2k"), (3, 16, "20k")] {
        let scene = Scene::granite(refine, count);
        let b = scene.largest_linear();
        let (block, conditions) = &scene.blocks[b];
        let materials = scene.materials();
        let (dofs, system) = scene.assembled(b);
        let (_, schur, load) = scene.condensed(b);
        let x_b = vec![1e-3; schur.boundary()];
        let u = dofs.displacement(&schur.recover(&load, &x_b));
        let balance = Balance::new(block, conditions, materials, &u, &[]);

        let mut group = c.benchmark_group(format!("subdomain {size}"));
        group.bench_function("number unknowns", |bench| {
            bench.iter(|| Dofs::new(block, conditions, materials).unwrap());
        });
        group.bench_function("assemble", |bench| {
            bench.iter(|| assemble(block, &dofs, materials, &[]).unwrap());
        });
        group.bench_function("factorize and condense", |bench| {
            bench.iter(|| LocalSchur::new(&system, dofs.interior, Par::Seq).unwrap());
        });
        group.bench_function("recover", |bench| {
            bench.iter(|| dofs.displacement(&schur.recover(&load, black_box(&x_b))));
        });
        group.bench_function("certificate", |bench| {
            bench.iter(|| Balance::new(block, conditions, materials, black_box(&u), &[]));
        });
        group.bench_function("certificate, check", |bench| {
            bench.iter(|| BlockCheck::new(block, conditions, &balance, black_box(&u), &[]));
        });
        group.bench_function("stresses", |bench| {
            bench.iter(|| BlockStress::new(block, materials, scene.catalog.plane, black_box(&u)));
        });
        group.finish();
    }
}

/// One evaluation of S_CON by a pair.
fn pair(c: &mut Criterion) {
    let scene = Scene::granite(1, 20);
    let b = scene.plan.pairs[0];
    let (dofs, schur, load) = scene.condensed(b);
    let gaps: Vec<f64> = scene.blocks[b].1.iter().map(|c| c.gap).collect();
    let limits = Limits::new(dofs.approaches, &dofs.approach_of, &gaps, 0.0);
    let mut pair = ContactPair::new(schur, load, limits);
    let u = vec![0.0; dofs.traces.len()];
    c.bench_function("S_CON of a pair", |bench| {
        bench.iter(|| pair.evaluate(black_box(&u), None));
    });
}

/// S_0 of all subdomains with its factor.
fn interface(c: &mut Criterion) {
    let scene = Scene::granite(1, 20);
    let is_pair: Vec<bool> = scene
        .plan
        .blocks
        .iter()
        .map(|b| b.group.is_some())
        .collect();
    let condensed: Vec<_> = (0..is_pair.len()).map(|b| scene.condensed(b)).collect();
    let traces: Vec<_> = condensed
        .iter()
        .map(|(dofs, ..)| dofs.traces.clone())
        .collect();
    let nodes: Vec<_> = (0..is_pair.len())
        .map(|b| scene.plan.shared_nodes(&scene.catalog, b))
        .collect();
    let numbering = Numbering::new(&traces, &nodes, &is_pair).unwrap();
    let contributions = || -> Vec<Contribution> {
        let of_block = |(dofs, schur, load): &(Dofs, LocalSchur, CondensedLoad)| {
            contribution(dofs, schur, load)
        };
        condensed.iter().map(of_block).collect()
    };
    c.bench_function("S_0", |bench| {
        bench.iter_batched(
            contributions,
            |parts| {
                let motions = RigidDrive::default();
                Interface::new(&numbering, parts, &is_pair, &motions, Par::Seq).unwrap()
            },
            BatchSize::LargeInput,
        );
    });
}

/// What a block brings to Γ with its approaches, which come first on its boundary, at 0.
fn contribution(dofs: &Dofs, schur: &LocalSchur, load: &CondensedLoad) -> Contribution {
    let (m, n) = (dofs.approaches, dofs.traces.len());
    Contribution {
        s: schur.s.submatrix(m, m, n, n).to_owned(),
        load: load.boundary()[m..].to_vec(),
        smallest_pivot: schur.smallest_pivot(),
        law: None,
    }
}

criterion_group! {
    name = kernels;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = subdomain, pair, interface
}
criterion_main!(kernels);
