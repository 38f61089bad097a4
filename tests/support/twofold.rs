//! Sums with about twice the digits of double precision.

/// A sum of products with about twice the digits: rounding errors are summed separately.
#[derive(Clone, Copy, Default)]
pub struct Twofold {
    sum: f64,
    lost: f64,
}

impl Twofold {
    pub fn add(&mut self, b: f64) {
        let sum = self.sum + b;
        let part = sum - self.sum;
        self.lost += (self.sum - (sum - part)) + (b - part);
        self.sum = sum;
    }

    pub fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.lost += a.mul_add(b, -product);
        self.add(product);
    }

    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}
