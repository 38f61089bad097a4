//! det ∂x/∂ξ > 0: a check that the map of a cell is one-to-one in the whole cell, not only at some points.

use super::definition::Domain;
use super::geometry::{difference, length};
use super::reference::ReferenceElement;

/// Number of bisections in each direction after which a Jacobian that may vanish counts as vanishing.
const HALVINGS: usize = 12;

/// A point at which the map of a cell folds or degenerates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// det ∂x/∂ξ there (m^dim).
    pub jacobian: f64,
    /// The position of that point (m).
    pub position: [f64; 3],
    /// The local node nearest to it.
    pub node: usize,
}

impl ReferenceElement {
    /// A point at which det ∂x/∂ξ of a cell whose dimension is that of space isn't above `floor`; `None` if it is above
    /// it in the whole cell.
    ///
    /// On the unit square or cube the determinant is a polynomial, on a triangle or tetrahedron after the collapse (s,
    /// t) → (s, t(1 − s)). Its Bernstein coefficients bound it from both sides (Johnen, Remacle and Geuzaine, J.
    /// Comput. Phys. 233, 2013); where they aren't conclusive, the square is bisected.
    pub fn fold(&self, at: &[[f64; 3]], floor: f64) -> Option<Fold> {
        let is_simplex = matches!(self.domain(), Domain::Triangle | Domain::Tetrahedron);
        if is_simplex && self.is_linear() {
            let jacobian = self.measure(at) / self.domain().measure();
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

impl ReferenceElement {
    /// True if a cell that [folds](Self::fold) is acceptable all the same: a hexahedron of 8 nodes, whose faces may be
    /// disjoint although its Jacobian changes sign at a corner, with a Jacobian above `floor` at all quadrature points
    /// of its stiffness. Linear displacements are then exact as in other cells. Hexahedra with coincident nodes are
    /// excluded.
    pub fn bears_fold(&self, at: &[[f64; 3]], floor: f64) -> bool {
        let mut points = self.stiffness_points().iter();
        let mut is_sound = || points.all(|point| self.determinant(&point.gradients, at) > floor);
        let is_collapsed = || (1..at.len()).any(|i| at[..i].contains(&at[i]));
        self.domain() == Domain::Cube && self.is_linear() && !is_collapsed() && is_sound()
    }
}

/// A part of the unit square or cube with the Bernstein coefficients of the Jacobian on it.
#[derive(Clone)]
struct Piece {
    coefficients: Vec<f64>,
    dim: usize,
    degree: usize,
    low: [f64; 3],
    high: [f64; 3],
    halvings: usize,
}

impl Piece {
    /// The coefficients on the whole domain from the values on the lattice.
    fn whole(element: &ReferenceElement, at: &[[f64; 3]]) -> Self {
        let lattice = element.lattice();
        let values = lattice.gradients.iter();
        let mut piece = Self {
            coefficients: values
                .map(|gradients| element.determinant(gradients, at))
                .collect(),
            dim: element.dim(),
            degree: lattice.degree,
            low: [0.0; 3],
            high: [1.0; 3],
            halvings: 0,
        };
        let mut values = vec![0.0; lattice.degree + 1];
        for axis in 0..piece.dim {
            piece.change_rows(axis, |row| {
                values.copy_from_slice(row);
                for (i, coefficient) in row.iter_mut().enumerate() {
                    let weights = lattice.to_bernstein.row(i);
                    *coefficient = weights.iter().zip(&values).map(|(w, v)| w * v).sum();
                }
            });
        }
        piece
    }

    /// Transforms all rows of coefficients along an axis.
    fn change_rows(&mut self, axis: usize, mut change: impl FnMut(&mut [f64])) {
        let count = self.degree + 1;
        let stride = count.pow(axis as u32);
        let mut row = vec![0.0; count];
        for start in (0..self.coefficients.len()).filter(|i| (i / stride).is_multiple_of(count)) {
            let places = (start..).step_by(stride);
            for (value, place) in row.iter_mut().zip(places.clone()) {
                *value = self.coefficients[place];
            }
            change(&mut row);
            for (&value, place) in row.iter().zip(places) {
                self.coefficients[place] = value;
            }
        }
    }

    /// A point of the reference cell at which the Jacobian isn't above `floor`.
    fn find(self, element: &ReferenceElement, floor: f64) -> Option<[f64; 3]> {
        let mut open = vec![self];
        while let Some(piece) = open.pop() {
            // This form is also false for NaN.
            if piece.coefficients.iter().all(|&c| c > floor) {
                continue;
            }
            let (value, corner) = piece.least_corner();
            let is_above = value > floor;
            if !is_above || piece.halvings == HALVINGS * piece.dim {
                return Some(element.domain().of_unit_cube(corner));
            }
            open.extend(piece.halves());
        }
        None
    }

    /// The smallest value of the Jacobian at the corners, where coefficients are values, and its position.
    fn least_corner(&self) -> (f64, [f64; 3]) {
        let count = self.degree + 1;
        let mut least = (f64::INFINITY, self.low);
        for corner in 0..1 << self.dim {
            let mut place = self.low;
            let mut index = 0;
            for axis in (0..self.dim).filter(|axis| corner >> axis & 1 == 1) {
                place[axis] = self.high[axis];
                index += self.degree * count.pow(axis as u32);
            }
            let value = self.coefficients[index];
            if value < least.0 || value.is_nan() {
                least = (value, place);
            }
        }
        least
    }

    /// The two halves of a bisection, by de Casteljau's algorithm; directions are bisected in turn.
    fn halves(mut self) -> [Self; 2] {
        let axis = self.halvings % self.dim;
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        self.halvings += 1;
        let (mut near, mut far) = (self.clone(), self);
        near.high[axis] = middle;
        far.low[axis] = middle;
        near.change_rows(axis, |row| {
            for step in 1..row.len() {
                for i in (step..row.len()).rev() {
                    row[i] = 0.5 * (row[i - 1] + row[i]);
                }
            }
        });
        far.change_rows(axis, |row| {
            for step in 1..row.len() {
                for i in 0..row.len() - step {
                    row[i] = 0.5 * (row[i] + row[i + 1]);
                }
            }
        });
        [near, far]
    }
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
        // A bulge of the bottom edge that nearly reaches the opposite corner.
        let kind = ElementKind::Triangle6;
        let mut at = kind.node_coordinates().to_vec();
        at[3][1] = 0.3;
        at[4] = [0.3, 0.3, 0.0];
        let fold = kind.fold(&at, 0.0).unwrap();
        assert!(fold.jacobian <= 0.0);
    }
}
