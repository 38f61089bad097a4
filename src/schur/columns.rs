//! Products of a vector with the columns of a matrix, several at a time.

use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Mul, Neg, SubAssign};

use pulp::Simd;

/// Number of columns multiplied together, so that the vector is read once for all of them.
pub(super) const WIDTH: usize = 4;

/// Floating-point numbers of single or double precision.
pub trait Number:
    Copy + Debug + Default + Neg<Output = Self> + Mul<Output = Self> + SubAssign + Sum + 'static
{
    /// The nearest number of this precision.
    fn of(value: f64) -> Self;

    /// The number in double precision.
    fn value(self) -> f64;

    /// The products of x with the columns that `column` returns, each as long as x.
    fn dot<'a, S: Simd, const N: usize>(
        simd: S,
        x: &[Self],
        column: impl Fn(usize) -> &'a [Self],
    ) -> [Self; N];

    /// y ← y + Σ_p a_p c_p with the factors a_p and the columns c_p that `column` returns, each as long as y.
    fn add<'a, S: Simd, const N: usize>(
        simd: S,
        y: &mut [Self],
        column: impl Fn(usize) -> (Self, &'a [Self]),
    );
}

macro_rules! number {
    ($t:ident, $reg:ident, $as_simd:ident, $as_mut_simd:ident, $splat:ident, $mul_add:ident, $reduce:ident, $load:ident, $store:ident) => {
        impl Number for $t {
            fn of(value: f64) -> Self {
                value as $t
            }

            fn value(self) -> f64 {
                self.into()
            }

            #[inline(always)]
            fn dot<'a, S: Simd, const N: usize>(
                simd: S,
                x: &[$t],
                column: impl Fn(usize) -> &'a [$t],
            ) -> [$t; N] {
                let (head, tail) = S::$as_simd(x);
                let columns: [&[$t]; N] = std::array::from_fn(column);
                let parts = columns.map(|column| S::$as_simd(column));
                let heads: [&[S::$reg]; N] = parts.map(|(part, _)| &part[..head.len()]);
                let mut sums = [simd.$splat(0.0); N];
                for (i, &x) in head.iter().enumerate() {
                    for p in 0..N {
                        sums[p] = simd.$mul_add(heads[p][i], x, sums[p]);
                    }
                }
                if !tail.is_empty() {
                    let x = simd.$load(tail);
                    for p in 0..N {
                        sums[p] = simd.$mul_add(simd.$load(parts[p].1), x, sums[p]);
                    }
                }
                sums.map(|sum| simd.$reduce(sum))
            }

            #[inline(always)]
            fn add<'a, S: Simd, const N: usize>(
                simd: S,
                y: &mut [$t],
                column: impl Fn(usize) -> ($t, &'a [$t]),
            ) {
                let columns: [($t, &[$t]); N] = std::array::from_fn(column);
                let factors = columns.map(|(x, _)| simd.$splat(x));
                let parts = columns.map(|(_, column)| S::$as_simd(column));
                let (head, tail) = S::$as_mut_simd(y);
                let heads: [&[S::$reg]; N] = parts.map(|(part, _)| &part[..head.len()]);
                for (i, y) in head.iter_mut().enumerate() {
                    let mut sum = *y;
                    for p in 0..N {
                        sum = simd.$mul_add(factors[p], heads[p][i], sum);
                    }
                    *y = sum;
                }
                if !tail.is_empty() {
                    let mut sum = simd.$load(tail);
                    for p in 0..N {
                        sum = simd.$mul_add(factors[p], simd.$load(parts[p].1), sum);
                    }
                    simd.$store(tail, sum);
                }
            }
        }
    };
}

number!(
    f64,
    f64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    splat_f64s,
    mul_add_e_f64s,
    reduce_sum_f64s,
    partial_load_f64s,
    partial_store_f64s
);
number!(
    f32,
    f32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    splat_f32s,
    mul_add_e_f32s,
    reduce_sum_f32s,
    partial_load_f32s,
    partial_store_f32s
);
