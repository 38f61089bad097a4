//! The same scene, written differently.

use crate::blocks::Blocks;
use crate::close::close;
use contact_dd_partition::model::Model;

const SCENE: &str = "[[contact]]\nname = 'c'\nsides = ['lower top', 'upper bottom']\n\
    [[displacement]]\non = 'lower bottom'\nx = 0\ny = '0.1*x'\n\
    [[bilateral]]\non = 'upper right'\n\
    [[pressure]]\non = 'upper top'\nvalue = '1+x'\n\
    [[traction]]\non = 'upper left'\nvalue = ['y^2', 1]\n";

fn blocks() -> Blocks {
    Blocks::new()
        .block("lower", [0.0, 2.0], [0.0, 1.0], [4, 3])
        .block("upper", [0.0, 2.0], [1.01, 2.0], [4, 3])
        .moved(|[x, y, z]| [x + 0.03 * (7.0 * x).sin(), y + 0.05 * (5.0 * x).sin(), z])
}

fn tag(model: &Model, node: u32) -> i64 {
    model.mesh.node_tags[node as usize]
}

#[test]
fn numbering_and_orientation_in_the_mesh_file_dont_matter() {
    let (one, other) = (
        blocks().model(SCENE).unwrap(),
        blocks().disguised().model(SCENE).unwrap(),
    );
    let (a, b) = (&one.contacts[0].points, &other.contacts[0].points);
    assert_eq!(a.len(), 5);
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.tag_a, a.tag_b), (b.tag_a, b.tag_b));
        close(a.gap, b.gap, 1e-15);
        close(a.area, b.area, 1e-15);
        (0..3).for_each(|i| close(a.frame.normal[i], b.frame.normal[i], 1e-15));
    }
    let forces = |model: &Model| {
        let mut list: Vec<_> = model
            .forces
            .iter()
            .map(|(n, f)| (tag(model, *n), *f))
            .collect();
        list.sort_by_key(|entry| entry.0);
        list
    };
    let (a, b) = (forces(&one), forces(&other));
    assert_eq!(a.len(), b.len());
    for ((tag_a, a), (tag_b, b)) in a.iter().zip(&b) {
        assert_eq!(tag_a, tag_b);
        (0..3).for_each(|i| close(a[i], b[i], 1e-14));
    }
    // Different support rows of a node are equivalent if their projectors are equal.
    let projector = |model: &Model| {
        let mut sums = std::collections::BTreeMap::new();
        for s in &model.supports {
            let sum: &mut [f64; 5] = sums.entry(tag(model, s.node)).or_default();
            let [x, y, _] = s.direction;
            for (sum, term) in sum
                .iter_mut()
                .zip([x * x, x * y, y * y, x * s.value, y * s.value])
            {
                *sum += term;
            }
        }
        sums
    };
    let (a, b) = (projector(&one), projector(&other));
    assert!(a.keys().eq(b.keys()));
    for (a, b) in a.values().zip(b.values()) {
        (0..5).for_each(|i| close(a[i], b[i], 1e-14));
    }
    for model in [&one, &other] {
        for (kind, nodes) in model.mesh.cells.iter() {
            let at: Vec<_> = nodes
                .iter()
                .map(|&n| model.mesh.points[n as usize])
                .collect();
            assert!(kind.jacobian(&at, [0.0; 3]) > 0.0);
        }
    }
}
