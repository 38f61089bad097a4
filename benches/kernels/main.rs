//! The kernels of a run, each by itself: `cargo bench --bench kernels`.

#![allow(
    missing_docs,
    clippy::unwrap_used,
    reason = "a benchmark that can't go on has failed"
)]

mod scene;

use std::hint::black_box;
use std::time::Duration;

use contact_dd_mpi::certificate::check::BlockCheck;
use contact_dd_mpi::fem::assembly::assemble;
use contact_dd_mpi::fem::balance::Balance;
use contact_dd_mpi::fem::dofs::Dofs;
use contact_dd_mpi::fem::stress::BlockStress;
use contact_dd_mpi::interface::numbering::Numbering;
use contact_dd_mpi::interface::operator::{Contribution, Interface};
use contact_dd_mpi::schur::condensed::Condensed;
use contact_dd_mpi::schur::local::LocalSchur;
use contact_dd_mpi::schur::merge::{MatrixPool, Merge};
use contact_dd_partition::id::TreeNodeId;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use faer::Par;

use scene::Scene;

/// One linear subdomain of about 2 000 and of about 20 000 dofs.
fn subdomain(c: &mut Criterion) {
    for (refine, count, size) in [(2, 40, "2k"), (3, 16, "20k")] {
        let scene = Scene::granite(refine, count);
        let b = scene.largest_linear();
        let (block, loads) = (&scene.blocks[b], scene.loads(b));
        let materials = scene.materials();
        let (dofs, stiffness) = scene.assembled(b);
        let (_, schur, _, load) = scene.condensed(b);
        let x_b = vec![1e-3; load.boundary().len()];
        let prescribed = scene.prescribed(b);
        let u = prescribed.displacement(&dofs, &schur.recover(&load, &x_b));
        let balance = Balance::new(block, &loads, materials, &u, &[]);

        let mut group = c.benchmark_group(format!("subdomain {size}"));
        group.bench_function("number unknowns", |bench| {
            bench.iter(|| Dofs::new(block, &loads).unwrap());
        });
        group.bench_function("assemble", |bench| {
            bench.iter(|| assemble(block, &dofs, materials, &[]).unwrap());
        });
        group.bench_function("factorize and condense", |bench| {
            bench.iter(|| LocalSchur::new(&stiffness, dofs.interior, Par::Seq).unwrap());
        });
        group.bench_function("recover", |bench| {
            bench.iter(|| prescribed.displacement(&dofs, &schur.recover(&load, black_box(&x_b))));
        });
        group.bench_function("certificate", |bench| {
            bench.iter(|| Balance::new(block, &loads, materials, black_box(&u), &[]));
        });
        group.bench_function("certificate, check", |bench| {
            bench.iter(|| BlockCheck::new(block, &loads, &balance, black_box(&u)));
        });
        let mut patches = Vec::new();
        group.bench_function("stresses", |bench| {
            bench.iter(|| {
                let u = black_box(&u);
                BlockStress::new(block, materials, scene.catalog.plane, u, &mut patches)
            });
        });
        group.finish();
    }
}

/// The merge with most unknowns of a hierarchy of 40 subdomains.
fn merge(c: &mut Criterion) {
    let scene = Scene::granite(2, 40);
    let blocks = scene.blocks.len();
    let tree = &scene.plan.tree;
    let nodes = &tree.nodes;
    let of_blocks = |v: &TreeNodeId| {
        let node = &nodes[*v];
        node.points.is_empty()
            && node
                .children
                .iter()
                .all(|&child| tree.block(child).is_some())
    };
    let inner = nodes.ids().skip(blocks).filter(of_blocks);
    let v = inner.max_by_key(|&v| nodes[v].kept.len()).unwrap();
    let children = || -> Vec<Condensed> {
        let children = nodes[v].children.iter();
        children
            .map(|child| scene.of_block(child.index()))
            .collect()
    };
    let mut spare = MatrixPool::default();
    c.bench_function("merge", |bench| {
        bench.iter_batched(
            children,
            |children| {
                let eliminated = &nodes[v].eliminated;
                Merge::new(children, eliminated, &[], &mut spare, Par::Seq).unwrap()
            },
            BatchSize::LargeInput,
        );
    });
}

/// S_0 of all subdomains with its factor.
fn interface(c: &mut Criterion) {
    let scene = Scene::granite(1, 20);
    let blocks = scene.blocks.len();
    let in_contact = vec![false; blocks];
    let condensed: Vec<Condensed> = (0..blocks).map(|b| scene.of_block(b)).collect();
    let interface_dofs: Vec<_> = condensed.iter().map(|c| &c.interface_dofs[..]).collect();
    let nodes = scene.plan.tree.nodes.iter().take(blocks);
    let nodes: Vec<_> = nodes.map(|node| &node.kept[..]).collect();
    let numbering = Numbering::new(&interface_dofs, &nodes, &in_contact).unwrap();
    c.bench_function("S_0", |bench| {
        bench.iter_batched(
            || condensed.iter().map(contribution).collect(),
            |parts| Interface::new(&numbering, parts, &in_contact, Par::Seq).unwrap(),
            BatchSize::LargeInput,
        );
    });
}

/// The part of a block in Γ.
fn contribution(condensed: &Condensed) -> Contribution {
    let mut condensed = condensed.clone();
    condensed.fill_upper_triangle();
    Contribution {
        s: condensed.s,
        smallest_pivot: condensed.smallest_pivot,
        law: None,
    }
}

criterion_group! {
    name = kernels;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = subdomain, merge, interface
}
criterion_main!(kernels);
