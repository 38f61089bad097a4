//! Rows of conditions over the unknowns of a contact group.

use std::collections::BTreeMap;

use crate::contact::jumps::JumpRow;

/// Square of a row, relative to that of another one, that is round-off.
pub(super) const NO_ROW: f64 = 1e-28;

/// Cosine and sine of the angle by which rows are to be turned so that the second is nothing; `None` where both are
/// needed or nothing already, or one is.
pub(super) fn only_direction(a: &JumpRow, b: &JumpRow) -> Option<(f64, f64)> {
    if a.is_empty() || b.is_empty() {
        return None;
    }
    let product = product(a, b);
    let (of_a, of_b) = (self::product(a, a), self::product(b, b));
    let (sin, cos) = (0.5 * (2.0 * product).atan2(of_a - of_b)).sin_cos();
    let rest = less(&scaled(b, cos), sin, a);
    (self::product(&rest, &rest) <= NO_ROW * (of_a + of_b)).then_some((cos, sin))
}

/// Σ a_v b_v.
pub(super) fn product(a: &JumpRow, b: &JumpRow) -> f64 {
    let at = |v: &u32| b.iter().find(|(w, _)| w == v).map_or(0.0, |(_, c)| *c);
    a.iter().map(|(v, c)| c * at(v)).sum()
}

pub(super) fn scaled(row: &JumpRow, factor: f64) -> JumpRow {
    row.iter().map(|&(v, c)| (v, factor * c)).collect()
}

/// a − factor·b.
pub(super) fn less(a: &JumpRow, factor: f64, b: &JumpRow) -> JumpRow {
    let mut sum: BTreeMap<u32, f64> = a.iter().copied().collect();
    for &(v, c) in b {
        *sum.entry(v).or_default() -= factor * c;
    }
    sum.into_iter().collect()
}
