//! det ∂x/∂ξ > 0: whether the map of a cell is one to one, everywhere and not at some points.

use std::array::from_fn;

use super::geometry::{difference, length};
use super::reference::{Domain, ReferenceElement};

/// Degree in each direction of the Jacobian's polynomial on the unit square.
const DEGREE: usize = 3;
/// Coefficients in each direction.
const COUNT: usize = DEGREE + 1;
/// Halvings after which a Jacobian that still may vanish counts as one that does.
const HALVINGS: u32 = 24;

/// A place at which the map of a cell turns over or degenerates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// det ∂x/∂ξ there (m^dim).
    pub jacobian: f64,
    /// Where it is (m).
    pub position: [f64; 3],
    /// The local node nearest to it.
    pub node: usize,
}

impl ReferenceElement {
    /// A place at which det ∂x/∂ξ of a cell of the plane isn't above `floor`; `None` where it is
    /// above it in the whole cell.
    ///
    /// On the unit square the determinant is a polynomial of at most third degree in each
    /// direction, that of a triangle by way of the collapse (s, t) → (s, t(1 − s)). Its
    /// coefficients in Bernstein's basis bound it from both sides (Johnen, Remacle and Geuzaine,
    /// J. Comput. Phys. 233, 2013); where they don't decide, the square is halved.
    pub fn fold(&self, at: &[[f64; 3]], floor: f64) -> Option<Fold> {
        if self.domain() == Domain::Triangle && self.is_linear() {
            let jacobian = 2.0 * self.measure(at);
            let holds = jacobian > floor;
            return (!holds).then_some(Fold {
                jacobian,
                position: at[0],
                node: 0,
            });
        }
        let xi = Piece::whole(self, at).find(self, floor)?;
        let position = self.position(at, xi);
        let away = |node: usize| length(difference(self.node_coordinates()[node], xi));
        let node = (0..self.nodes()).min_by(|&a, &b| away(a).total_cmp(&away(b)));
        Some(Fold {
            jacobian: self.jacobian(at, xi),
            position,
            node: node.unwrap_or_default(),
        })
    }
}

/// A rectangle of the unit square with Bernstein's coefficients of the Jacobian over it.
#[derive(Clone, Copy)]
struct Piece {
    coefficients: [[f64; COUNT]; COUNT],
    low: [f64; 2],
    high: [f64; 2],
    halvings: u32,
}

impl Piece {
    /// The coefficients over the whole square from values at 4 × 4 places.
    fn whole(element: &ReferenceElement, at: &[[f64; 3]]) -> Self {
        let gradients = element.lattice();
        let values: [[f64; COUNT]; COUNT] =
            from_fn(|i| from_fn(|j| element.determinant(&gradients[i * COUNT + j], at)));
        let rows = values.map(bernstein);
        Self {
            coefficients: transposed(transposed(rows).map(bernstein)),
            low: [0.0; 2],
            high: [1.0; 2],
            halvings: 0,
        }
    }

    /// A point of the reference cell at which the Jacobian isn't above `floor`.
    fn find(self, element: &ReferenceElement, floor: f64) -> Option<[f64; 3]> {
        let mut open = vec![self];
        while let Some(piece) = open.pop() {
            // So that NaN isn't above anything.
            if (piece.coefficients.iter().flatten()).all(|&c| c > floor) {
                continue;
            }
            let (value, corner) = piece.least_corner();
            let is_above = value > floor;
            if !is_above || piece.halvings == HALVINGS {
                return Some(element.domain().of_unit_square(corner));
            }
            open.extend(piece.halves());
        }
        None
    }

    /// The least of the Jacobian's values at the corners, where coefficients are values, and its
    /// place.
    fn least_corner(&self) -> (f64, [f64; 2]) {
        let ends = [(0, self.low), (DEGREE, self.high)];
        let mut least = (f64::INFINITY, self.low);
        for (i, s) in ends {
            for (j, t) in ends {
                let value = self.coefficients[i][j];
                if value < least.0 || value.is_nan() {
                    least = (value, [s[0], t[1]]);
                }
            }
        }
        least
    }

    /// Both halves, cut across one direction and the other by turns.
    fn halves(&self) -> [Self; 2] {
        let axis = self.halvings as usize % 2;
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        let rows = match axis {
            0 => transposed(self.coefficients),
            _ => self.coefficients,
        };
        let halves = rows.map(halved);
        [0, 1].map(|side| {
            let half = halves.map(|pair| pair[side]);
            let mut piece = Self {
                coefficients: if axis == 0 { transposed(half) } else { half },
                halvings: self.halvings + 1,
                ..*self
            };
            match side {
                0 => piece.high[axis] = middle,
                _ => piece.low[axis] = middle,
            }
            piece
        })
    }
}

/// Gradients of the shape functions at the 4 × 4 places.
pub(super) fn lattice(element: &ReferenceElement) -> Vec<Vec<[f64; 3]>> {
    let share = |i: usize| i as f64 / DEGREE as f64;
    let places = (0..COUNT).flat_map(|i| (0..COUNT).map(move |j| [share(i), share(j)]));
    places
        .map(|place| element.gradients(element.domain().of_unit_square(place)))
        .collect()
}

/// Bernstein's coefficients of the cubic with these values at 0, 1/3, 2/3, 1.
fn bernstein([a, b, c, d]: [f64; COUNT]) -> [f64; COUNT] {
    [
        a,
        (-5.0 * a + 18.0 * b - 9.0 * c + 2.0 * d) / 6.0,
        (2.0 * a - 9.0 * b + 18.0 * c - 5.0 * d) / 6.0,
        d,
    ]
}

/// The coefficients over both halves, by de Casteljau's scheme.
fn halved(mut row: [f64; COUNT]) -> [[f64; COUNT]; 2] {
    let mut halves = [row; 2];
    for step in 1..COUNT {
        for i in 0..COUNT - step {
            row[i] = 0.5 * (row[i] + row[i + 1]);
        }
        halves[0][step] = row[0];
        halves[1][DEGREE - step] = row[DEGREE - step];
    }
    halves
}

fn transposed(rows: [[f64; COUNT]; COUNT]) -> [[f64; COUNT]; COUNT] {
    from_fn(|i| from_fn(|j| rows[j][i]))
}

#[cfg(test)]
mod tests {
    use super::super::ElementKind;

    #[test]
    fn a_mid_side_node_at_the_quarter_of_its_edge_makes_the_corner_singular() {
        for kind in [ElementKind::Triangle6, ElementKind::Quad8] {
            let mut at = kind.node_coordinates().to_vec();
            let (a, b) = (at[0], at[1]);
            let on_edge = |share: f64| [a[0] + share * (b[0] - a[0]), a[1], 0.0];
            let first_mid = kind.corners();
            at[first_mid] = on_edge(0.26);
            assert_eq!(kind.fold(&at, 0.0), None);
            at[first_mid] = on_edge(0.25);
            assert_eq!(kind.fold(&at, 0.0).unwrap().node, 0);
            at[first_mid] = on_edge(0.76);
            assert_eq!(kind.fold(&at, 0.0).unwrap().node, 1);
        }
    }

    #[test]
    fn a_fold_between_the_nodes_and_off_the_quadrature_points_is_found() {
        // A bump of the bottom edge that nearly reaches the opposite corner.
        let kind = ElementKind::Triangle6;
        let mut at = kind.node_coordinates().to_vec();
        at[3][1] = 0.3;
        at[4] = [0.3, 0.3, 0.0];
        let fold = kind.fold(&at, 0.0).unwrap();
        assert!(fold.jacobian <= 0.0);
    }
}
