//! Forces and moments of contacts.

use contact_dd_partition::contact_point::Law;

use super::*;

#[test]
fn a_force_has_a_moment_about_the_origin() {
    let mut sum = Resultant::default();
    sum.add([2.0, 1.0, 0.0], [3.0, 5.0, 0.0]);
    sum.add([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]);
    assert_eq!(sum.force, [4.0, 5.0, 0.0]);
    assert_eq!(sum.moment, [0.0, 0.0, 2.0 * 5.0 - 3.0 - 1.0]);
}

#[test]
fn friction_pulls_side_a_and_is_counted_where_there_is_some() {
    let mut contact = ContactResultant {
        friction: Some(Friction::default()),
        ..ContactResultant::default()
    };
    let at = |x: f64, law: Law| ContactPoint {
        area: 0.5,
        law,
        ..ContactPoint::new(Vec::new(), [0.0, -1.0, 0.0], [x, 2.0, 0.0], 1)
    };
    let rough = Law::coulomb(0.5, 0.0);
    let sticks = ContactState {
        force: 10.0,
        closed: true,
        tangential_force: [3.0, 0.0, 0.0],
        ..ContactState::default()
    };
    let slips = ContactState {
        tangential_force: [-5.0, 0.0, 0.0],
        slipping: true,
        dissipated: 0.25,
        ..sticks
    };
    contact.add(&at(0.0, rough), &sticks);
    contact.add(&at(1.0, rough), &slips);
    contact.add(&at(2.0, rough), &ContactState::default());
    contact.add(
        &at(3.0, Law::Frictionless),
        &ContactState {
            tangential_force: [0.0; 3],
            ..sticks
        },
    );
    let Resultant { force, moment } = contact.resultant;
    assert_eq!(force, [3.0 - 5.0, 30.0, 0.0]);
    assert_eq!(moment, [0.0, 0.0, -2.0 * (3.0 - 5.0) + 10.0 + 30.0]);
    assert_eq!((contact.closed, contact.largest_pressure), (3, 20.0));
    let sum = Friction {
        sticking: 1,
        slipping: 1,
        dissipated_work: 0.25,
    };
    assert_eq!(contact.friction, Some(sum));
    assert_eq!(contact.parting, 0);
    let mut all = Resultants::default();
    assert_eq!(all.friction(), None);
    all.contacts = vec![contact.clone(), ContactResultant::default(), contact];
    assert_eq!(all.friction().map(|sum| sum.slipping), Some(2));
    assert_eq!(all.warnings().len(), 0);
}

#[test]
fn what_slips_below_its_bound_is_warned_of() {
    let point = ContactPoint {
        area: 0.5,
        law: Law::coulomb(0.6, 8.0),
        ..ContactPoint::new(Vec::new(), [0.0, -1.0, 0.0], [0.0; 3], 1)
    };
    let slips = |force: f64| ContactState {
        closed: true,
        slipping: true,
        tangential_force: [0.0, force, 0.0],
        ..ContactState::default()
    };
    let mut contact = ContactResultant {
        name: "joint".into(),
        friction: Some(Friction::default()),
        ..ContactResultant::default()
    };
    for force in [4.0, 3.0, 0.0] {
        contact.add(&point, &slips(force));
    }
    assert_eq!(contact.parting, 2);
    let without_cohesion = ContactPoint {
        law: Law::coulomb(0.6, 0.0),
        ..point
    };
    let at_its_bound = ContactState {
        force: 10.0,
        ..slips(0.6 * 10.0 * (1.0 - 1e-15))
    };
    contact.add(&without_cohesion, &at_its_bound);
    assert_eq!(contact.parting, 2);
    let contacts = vec![contact];
    let all = Resultants {
        contacts,
        ..Resultants::default()
    };
    assert!(all.warnings()[0].starts_with("contact 'joint': 2 of its points are"));
}
