//! Round bodies.

use std::f64::consts::{FRAC_PI_4, TAU};

use super::blocks::Blocks;

impl Blocks {
    /// Adds a disc whose boundary has 4`n` facets of equal length. Its groups of facets are the quarters below, on the
    /// right, above and on the left; there are nodes in between them and, for an even `n`, in their middles.
    pub fn disc(self, name: &str, center: [f64; 2], radius: f64, n: usize) -> Self {
        self.mapped(name, [n, n], |at| {
            // Squares around the centre become circles.
            let [p, q] = at.map(|c| 2.0 * c - 1.0);
            let (r, quarter) = if p.abs() >= q.abs() { (p, q) } else { (q, p) };
            let angle = if r == 0.0 {
                0.0
            } else {
                FRAC_PI_4 * quarter / r
            };
            let (along, across) = (radius * r * angle.cos(), radius * r * angle.sin());
            match p.abs() >= q.abs() {
                true => [center[0] + along, center[1] + across],
                false => [center[0] + across, center[1] + along],
            }
        })
    }

    /// Adds a ring around the origin of `n` cells through its thickness and around; `right` is its outer boundary,
    /// `left` the inner one.
    pub fn ring(self, name: &str, radii: [f64; 2], n: [usize; 2]) -> Self {
        let [inner, outer] = radii;
        self.mapped(name, n, |[s, t]| {
            let (sin, cos) = (TAU * t).sin_cos();
            [cos, sin].map(|c| (inner + (outer - inner) * s) * c)
        })
        .glued(|x, y| x > 0.0 && y.abs() < 1e-9 * outer)
    }
}
