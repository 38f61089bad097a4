//! The bounding box of points, along the axes.

/// The box; without points its lower bounds exceed the upper ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingBox {
    /// Least coordinates (m).
    pub low: [f64; 3],
    /// Largest coordinates (m).
    pub high: [f64; 3],
}

impl BoundingBox {
    /// The empty box.
    pub const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// The box around `points`.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a [f64; 3]>) -> Self {
        let mut all = Self::EMPTY;
        for &point in points {
            all.include(&Self {
                low: point,
                high: point,
            });
        }
        all
    }

    /// Enlarges it to contain another box.
    pub fn include(&mut self, other: &Self) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(other.low[axis]);
            self.high[axis] = self.high[axis].max(other.high[axis]);
        }
    }

    /// Largest side (m); 0 without points.
    pub fn extent(&self) -> f64 {
        let sides = (0..3).map(|axis| self.high[axis] - self.low[axis]);
        sides.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_holds_its_points_and_no_more() {
        let all = BoundingBox::around(&[[1.0, -2.0, 0.0], [-0.5, 3.0, 0.0]]);
        assert_eq!((all.low, all.high), ([-0.5, -2.0, 0.0], [1.0, 3.0, 0.0]));
        assert_eq!(all.extent(), 5.0);
        assert_eq!(BoundingBox::EMPTY.extent(), 0.0);
    }
}
