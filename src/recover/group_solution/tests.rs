use contact_dd_partition::contact_point::{ContactPoint, Law, LocalFrame};

use super::*;
use crate::certificate::check::not_opposed;
use crate::certificate::scales::SlipScales;
use crate::fem::contact_node::ContactNode;

/// A point in space with this law, on a node.
pub fn group(law: Law) -> ContactGroup {
    let node = ContactNode {
        is_auxiliary: false,
        interface: 0,
        tag: 1,
        body: 0,
        at: [0.0; 3],
        stiffness: 7.0,
        supports: Vec::new(),
        slides: None,
    };
    let point = ContactPoint {
        axes: Vec::new(),
        contact: 0,
        place: 0,
        entries: vec![(0, 1.0)],
        frame: LocalFrame::new([0.0, 0.0, 1.0]),
        gap: 0.0,
        is_gap_given: false,
        since: [0.0; 3],
        is_absolute: false,
        area: 4.0,
        position: [0.0; 3],
        force_point: [0.0; 3],
        tag_a: 1,
        tag_b: -1,
        stiffness: [0.0; 2],
        motion: Vec::new(),
        preload: Vec::new(),
        law,
    };
    ContactGroup::new(vec![point], vec![node], 3)
}

pub const COULOMB: Law = Law::Coulomb {
    coefficient: 0.5,
    cohesion: 0.0,
};

/// A point under a pressure of 4 with these forces and gaps along its tangents.
pub fn pressed(forces: [f64; 2], gaps: [f64; 2], sticks: bool) -> GroupSolution {
    GroupSolution {
        forces: vec![4.0, forces[0], forces[1]],
        closed: vec![true, sticks, sticks],
        gaps: vec![0.0, gaps[0], gaps[1]],
    }
}

#[test]
fn a_point_sticks_or_slips_as_its_law_says() {
    let none = [0.0; 2];
    for (forces, gaps, sticks, after, sticks_then) in [
        ([3.0, 4.0], none, true, [1.2, 1.6], false),
        ([0.6, 0.8], none, true, [0.6, 0.8], true),
        ([1.2, 1.6], [-0.3, -0.4], false, [1.2, 1.6], false),
        ([1.2, 1.6], [0.3, 0.4], false, [1.2, 1.6], true),
        (none, [-0.3, -0.4], false, [1.2, 1.6], false),
    ] {
        let mut point = pressed(forces, gaps, sticks);
        let changed = point.correct_statuses(&group(COULOMB));
        assert_eq!(
            changed,
            sticks != sticks_then || forces == none,
            "{forces:?}"
        );
        assert_eq!(point.closed, [true, sticks_then, sticks_then], "{forces:?}");
        for (force, after) in point.forces[1..].iter().zip(after) {
            assert!((force - after).abs() < 1e-15, "{forces:?} {force}");
        }
    }
}

#[test]
fn a_point_that_opens_keeps_given_friction_alone() {
    for (law, left) in [(COULOMB, 0.0), (Law::Given { bound: 1.0 }, 1.2)] {
        let mut point = pressed([1.2, 1.6], [0.0; 2], true);
        point.forces[0] = -0.1;
        assert!(point.open_or_close(&group(law)));
        assert!(!point.closed[0]);
        assert_eq!(point.forces[1], left);
        assert_eq!(point.closed[1], left != 0.0);
    }
}

#[test]
fn the_certificate_sees_a_small_slip_that_a_small_force_drives() {
    let scales = SlipScales {
        force: 2.0,
        displacement: 10.0,
    };
    let group = group(COULOMB);
    for (forces, gaps, expected) in [
        // At its bound, against the slip.
        ([1.2, 1.6], [-0.3, -0.4], 0.0),
        // Both 1e-6 of their scales, whose product would be far below any limit.
        ([2.0 - 2e-6, 0.0], [-1e-6, 0.0], 1e-6),
        // The lesser of both counts: a slip of no size may have any force.
        ([-2.0, 0.0], [-1e-15, 0.0], 1e-15),
    ] {
        let point = pressed(forces, gaps, false);
        let numbers = [&point.gaps[..], &point.forces];
        let found = not_opposed(&group, numbers, &point.closed, scales);
        assert!(
            (found - expected).abs() < 1e-16 + 1e-9 * expected,
            "{found:e}"
        );
    }
}

#[test]
fn a_slip_that_nothing_presses_lacks_no_force() {
    let open = GroupSolution {
        forces: vec![0.0; 3],
        closed: vec![false; 3],
        gaps: vec![0.1, -1.0, 0.0],
    };
    let numbers = [&open.gaps[..], &open.forces];
    let scales = SlipScales {
        force: 0.0,
        displacement: 1.0,
    };
    let found = not_opposed(&group(COULOMB), numbers, &open.closed, scales);
    assert_eq!(found, 0.0);
}
