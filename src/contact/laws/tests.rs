//! The past of points that part, in the residual of their laws.

use super::*;
use crate::contact::tangent::{ForceBound, OtherTangent};

const PARTS: PointStatus = PointStatus::Parts {
    direction: [1.0, 0.0],
    turning: 0.0,
};

/// A point without pressure that slips under this force, with a cohesion of 1 while it is closed.
fn after_parting(force: f64, past: Past) -> (PointStatus, Past) {
    let tangent = TangentialLimit {
        limit: 1,
        normal: Some(0),
        bound: ForceBound {
            coefficient: 0.5,
            cohesion: 1.0,
            only_closed: true,
        },
        other: OtherTangent::Nothing,
    };
    let rows = DependentConstraints::default();
    let laws = ContactLaws::new(&[0.0; 2], &rows, &[tangent], vec![1.0; 2]);
    let at = Iterate {
        jumps: vec![0.0, 0.1],
        forces: vec![0.0, force],
    };
    let before = Statuses {
        closed: vec![true, false],
        points: vec![PARTS],
        past: vec![past],
    };
    let Statuses { points, past, .. } =
        laws.residual(&at, Some((&before, &[1.0; 2])), 0.0).statuses;
    (points[0], past[0])
}

#[test]
fn a_point_that_parts_beyond_its_cohesion_slips_once_and_then_opens() {
    assert_eq!(after_parting(0.7, Past::Opened), (PARTS, Past::Opened));
    let (status, past) = after_parting(1.5, Past::Opened);
    assert!(matches!(status, PointStatus::Slips { .. }));
    assert_eq!(past, Past::Exceeded);
    assert_eq!(after_parting(0.7, past), (PARTS, Past::Exceeded));
    assert_eq!(after_parting(1.5, past), (PointStatus::Open, Past::Opened));
}
