//! S of a cluster on the unknowns left by closed contact constraints.

use std::ops::Range;

use faer::Mat;

use crate::schur::symmetric::PackedSymmetric;

/// Most terms of a row of T that are processed one by one.
const FEW_TERMS: usize = 8;
/// Columns of S that are transposed together.
const AT_A_TIME: usize = 16;

/// The lower triangle of Tᵀ S T, for S with `springs` on its diagonal; T has a row of terms for every unknown of S.
pub fn transformed(
    s: &PackedSymmetric,
    springs: &[f64],
    terms: &[Vec<(usize, f64)>],
    n: usize,
) -> Mat<f64> {
    let mut new = Mat::<f64>::zeros(n, n);
    // Most unknowns only change their positions.
    let place = |terms: &Vec<(usize, f64)>| match terms[..] {
        [(place, 1.0)] => Some(place),
        _ => None,
    };
    let places: Vec<Option<usize>> = terms.iter().map(place).collect();
    if springs.is_empty()
        && let Some(places) = places.iter().copied().collect::<Option<Vec<usize>>>()
        && is_permutation(&places, n)
    {
        return permuted(s, &places);
    }
    let (of_many, many) = numbers_of_many(terms);
    // With the rows of T with many terms, T_D, and the others, T_F, T_Dᵀ multiplies S_DF T_F + ½ S_DD T_D, from both
    // sides.
    let mut s_many = Mat::<f64>::zeros(many, many);
    let mut product = Mat::<f64>::zeros(many, n);
    for j in 0..s.size() {
        let column = s.column(j);
        let diagonal = column[0] + springs.get(j).unwrap_or(&0.0);
        match of_many[j] {
            Some(d) => s_many[(d, d)] = 0.5 * diagonal,
            None => add_diagonal(&mut new, &terms[j], diagonal),
        }
        for (i, &s) in (j + 1..terms.len()).zip(&column[1..]) {
            if let (Some(a), Some(b)) = (places[i], places[j]) {
                add(&mut new, a, b, s);
                continue;
            }
            match (of_many[i], of_many[j]) {
                (Some(c), Some(d)) => {
                    s_many[(c, d)] = 0.5 * s;
                    s_many[(d, c)] = 0.5 * s;
                }
                (Some(d), None) => terms[j].iter().for_each(|&(b, c)| product[(d, b)] += c * s),
                (None, Some(d)) => terms[i].iter().for_each(|&(b, c)| product[(d, b)] += c * s),
                (None, None) => {
                    for &(b, d) in &terms[j] {
                        terms[i]
                            .iter()
                            .for_each(|&(a, c)| add(&mut new, a, b, c * d * s));
                    }
                }
            }
        }
    }
    if many > 0 {
        add_many(&mut new, terms, &of_many, s_many, product);
    }
    new
}

/// Adds the part of Tᵀ S T due to an entry on the diagonal of S with the `terms` of its row.
fn add_diagonal(new: &mut Mat<f64>, terms: &[(usize, f64)], diagonal: f64) {
    for (at, &(b, d)) in terms.iter().enumerate() {
        new[(b, b)] += d * d * diagonal;
        for &(a, c) in &terms[at + 1..] {
            add(new, a, b, c * d * diagonal);
        }
    }
}

/// The numbers of the rows with many terms among such rows, and their count.
fn numbers_of_many(terms: &[Vec<(usize, f64)>]) -> (Vec<Option<usize>>, usize) {
    let mut many = 0;
    let number = |terms: &Vec<(usize, f64)>| {
        let is_one = terms.len() > FEW_TERMS;
        many += usize::from(is_one);
        is_one.then(|| many - 1)
    };
    let numbers = terms.iter().map(number).collect();
    (numbers, many)
}

/// Adds T_Dᵀ (S_DF T_F + ½ S_DD T_D) and its transpose, where `product` is S_DF T_F and `s_many` is ½ S_DD; T_D has the
/// rows of `terms` with a number in `of_many`.
fn add_many(
    new: &mut Mat<f64>,
    terms: &[Vec<(usize, f64)>],
    of_many: &[Option<usize>],
    s_many: Mat<f64>,
    mut product: Mat<f64>,
) {
    let n = new.ncols();
    let mut t = Mat::<f64>::zeros(s_many.nrows(), n);
    for (terms, d) in terms.iter().zip(of_many) {
        if let Some(d) = *d {
            terms.iter().for_each(|&(a, c)| t[(d, a)] += c);
        }
    }
    product += s_many * &t;
    let half = t.transpose() * product;
    for b in 0..n {
        for a in b..n {
            new[(a, b)] += half[(a, b)] + half[(b, a)];
        }
    }
}

/// True if every number below n is one of the `places`, once.
fn is_permutation(places: &[usize], n: usize) -> bool {
    let mut is_there = vec![false; n];
    places.iter().for_each(|&place| is_there[place] = true);
    places.len() == n && is_there.iter().all(|there| *there)
}

/// The lower triangle of S with its unknowns at the positions `places`.
fn permuted(s: &PackedSymmetric, places: &[usize]) -> Mat<f64> {
    let mut new = Mat::<f64>::zeros(s.size(), s.size());
    let runs = runs(places);
    for (k, columns) in runs.iter().enumerate() {
        for rows in &runs[k..] {
            if places[rows.start] >= places[columns.start] {
                for j in columns.clone() {
                    let first = rows.start.max(j);
                    let from = &s.column(j)[first - j..rows.end - j];
                    let to = &mut new.col_as_slice_mut(places[j])[places[first]..];
                    to[..from.len()].copy_from_slice(from);
                }
                continue;
            }
            // Transposed, some columns at a time, so that what is written is contiguous.
            for first in columns.clone().step_by(AT_A_TIME) {
                let of = first..columns.end.min(first + AT_A_TIME);
                let from: Vec<&[f64]> = of.map(|j| &s.column(j)[rows.start - j..]).collect();
                for (i, &a) in places[rows.clone()].iter().enumerate() {
                    let to = &mut new.col_as_slice_mut(a)[places[first]..];
                    to.iter_mut()
                        .zip(&from)
                        .for_each(|(to, from)| *to = from[i]);
                }
            }
        }
    }
    new
}

/// The runs of unknowns whose positions follow one another.
fn runs(places: &[usize]) -> Vec<Range<usize>> {
    let mut first = 0;
    let of_run = |run: &[usize]| {
        first += run.len();
        first - run.len()..first
    };
    places.chunk_by(|a, b| a + 1 == *b).map(of_run).collect()
}

/// Adds `value` at (a, b) and (b, a), of which only the lower one is stored.
fn add(s: &mut Mat<f64>, a: usize, b: usize, value: f64) {
    let both = if a == b { 2.0 * value } else { value };
    s[(a.max(b), a.min(b))] += both;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknowns_of_few_and_of_many_terms_are_replaced_alike() {
        let (m, n) = (15, 19);
        let entry = |i: usize, j: usize| ((i.max(j) * 31 + i.min(j) * 7) % 17) as f64 - 8.0;
        let full = Mat::from_fn(m, m, entry);
        let terms_of = |i: usize| -> Vec<(usize, f64)> {
            match i % 5 {
                0..3 => vec![(i, 1.0)],
                3 => vec![(i, 0.5), (18, 2.0), (0, -1.0)],
                _ => (0..12).map(|k| (k + 5, (i + k) as f64 - 9.0)).collect(),
            }
        };
        let terms: Vec<_> = (0..m).map(terms_of).collect();
        let springs: Vec<f64> = (0..m).map(|i| i as f64).collect();
        let mut t = Mat::<f64>::zeros(m, n);
        let mut sprung = full.clone();
        for (i, terms) in terms.iter().enumerate() {
            terms.iter().for_each(|&(a, c)| t[(i, a)] += c);
            sprung[(i, i)] += springs[i];
        }
        let expected = t.transpose() * sprung * &t;
        let found = transformed(&PackedSymmetric::new(&full), &springs, &terms, n);
        for j in 0..n {
            (j..n).for_each(|i| assert_eq!(found[(i, j)], expected[(i, j)], "{i}, {j}"));
        }
    }

    #[test]
    fn a_permutation_is_what_terms_of_one_unknown_each_are() {
        let with_runs = (20..39).chain(0..7).chain((7..20).rev()).chain([39]);
        for places in [vec![3, 0, 6, 1, 5, 2, 4], with_runs.collect()] {
            let n = places.len();
            let full = Mat::from_fn(n, n, |i, j| (i.max(j) * 31 + i.min(j) * 7) as f64);
            let s = PackedSymmetric::new(&full);
            let terms: Vec<_> = places.iter().map(|&place| vec![(place, 1.0)]).collect();
            let by_place = transformed(&s, &[], &terms, n);
            let by_terms = transformed(&s, &vec![0.0; n], &terms, n);
            for j in 0..n {
                (j..n).for_each(|i| assert_eq!(by_place[(i, j)], by_terms[(i, j)], "{i}, {j}"));
            }
        }
    }
}
