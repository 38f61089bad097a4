//! The laws of contact points: friction and contact stiffness.

use crate::contact_point::{ContactPoint, Law};
use crate::error::InputError;
use crate::magnitude::short;
use crate::scene::compliance::ContactStiffness;
use crate::scene::friction::Friction;

/// Coefficient of friction above which it is probably an angle in degrees, or meant as infinite, which costs accuracy.
const STEEP: f64 = 10.0;

/// Assigns the law of friction to points; returns a warning for a coefficient that is probably an angle.
///
/// # Errors
/// An invalid value at a point.
pub(super) fn give_friction(
    friction: &Friction,
    points: &mut [ContactPoint<u32>],
    what: &str,
) -> Result<Option<String>, InputError> {
    for point in &mut *points {
        point.law = (friction.at(point.position))
            .map_err(|reason| InputError::new(format!("{what}.{reason} (node {})", point.tag())))?;
    }
    Ok(steep_friction(points, what))
}

/// The warning of a coefficient of friction that is probably an angle.
fn steep_friction(points: &[ContactPoint<u32>], what: &str) -> Option<String> {
    let coefficients = points.iter().map(|point| match point.law {
        Law::Coulomb { coefficient, .. } => coefficient,
        Law::Given { .. } | Law::Frictionless | Law::Tied => 0.0,
    });
    let largest = coefficients.fold(0.0, f64::max);
    (largest > STEEP).then(|| {
        format!(
            "{what}.friction: a coefficient of {}; expected the tangent of the friction angle, a number like 0.6",
            short(largest)
        )
    })
}

/// Assigns the contact stiffness to points.
///
/// # Errors
/// An invalid value at a point.
pub(super) fn give_stiffness(
    stiffness: &ContactStiffness,
    points: &mut [ContactPoint<u32>],
    what: &str,
) -> Result<(), InputError> {
    for point in points {
        let per_area = stiffness.at(point.position).map_err(|reason| {
            let tag = point.tag();
            InputError::new(format!("{what}.stiffness.{reason} (node {tag})"))
        })?;
        point.stiffness = per_area.map(|k| k * point.area);
    }
    Ok(())
}
