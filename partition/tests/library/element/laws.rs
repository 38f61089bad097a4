//! Laws of every reference element.

use contact_dd_partition::element::definition::CellRules;
use contact_dd_partition::element::definition::Domain;
use contact_dd_partition::element::geometry::{advance, cross, difference, dot, length};
use contact_dd_partition::element::reference::ReferenceElement;

/// Dimension, corners and nodes of the cells that VTK numbers so, from `vtkCellType.h` and the
/// classes of these cells.
const VTK: [(u8, [usize; 3]); 16] = [
    (1, [0, 1, 1]),
    (3, [1, 2, 2]),
    (5, [2, 3, 3]),
    (9, [2, 4, 4]),
    (10, [3, 4, 4]),
    (12, [3, 8, 8]),
    (21, [1, 2, 3]),
    (22, [2, 3, 6]),
    (23, [2, 4, 8]),
    (24, [3, 4, 10]),
    (25, [3, 8, 20]),
    (28, [2, 4, 9]),
    (29, [3, 8, 27]),
    (30, [2, 4, 6]),
    (34, [2, 3, 7]),
    (35, [1, 2, 4]),
];

/// Fails unless `element` keeps them all.
#[track_caller]
pub fn keeps_all(element: &ReferenceElement) {
    is_what_vtk_has_under_its_number(element);
    shape_functions_belong_to_nodes(element);
    linear_fields_are_reproduced(element);
    gradients_are_difference_quotients(element);
    turned_over_it_has_the_opposite_measure(element);
    if element.dim() >= 2 {
        facets_are_those_of_the_cell(element);
        normals_close(element);
        the_jacobian_is_bounded(element);
    }
    if let Some(rules) = element.rules() {
        rules_are_exact(element, rules);
    }
}

/// Round-off of sums, in the plane or in space, which has more and larger terms.
fn rounding(element: &ReferenceElement, in_plane: f64) -> f64 {
    if element.dim() == 3 {
        10.0 * in_plane
    } else {
        in_plane
    }
}

fn is_what_vtk_has_under_its_number(element: &ReferenceElement) {
    let found = VTK.iter().find(|(number, _)| *number == element.vtk());
    let counts = [element.dim(), element.corners(), element.nodes()];
    assert_eq!(found.unwrap().1, counts, "{}", element.name());
}

/// Points all over the reference element.
fn everywhere(domain: Domain, each_way: usize) -> impl Iterator<Item = [f64; 3]> {
    let count = each_way + 1;
    let all = (0..count.pow(domain.dim() as u32)).map(move |i| {
        [i % count, i / count % count, i / (count * count)].map(|i| i as f64 / each_way as f64)
    });
    all.map(move |[s, t, r]| match domain {
        Domain::Point => [0.0; 3],
        Domain::Line => [2.0 * s - 1.0, 0.0, 0.0],
        Domain::Triangle => [s, t * (1.0 - s), 0.0],
        Domain::Square => [2.0 * s - 1.0, 2.0 * t - 1.0, 0.0],
        Domain::Tetrahedron => [s, t * (1.0 - s), r * (1.0 - s) * (1.0 - t)],
        Domain::Cube => [s, t, r].map(|x| 2.0 * x - 1.0),
    })
}

fn shape_functions_belong_to_nodes(element: &ReferenceElement) {
    for (i, &xi) in element.node_coordinates().iter().enumerate() {
        for (j, value) in element.shape(xi).into_iter().enumerate() {
            let expected = if i == j { 1.0 } else { 0.0 };
            assert_eq!(value, expected, "{} {i} {j}", element.name());
        }
    }
}

fn linear_fields_are_reproduced(element: &ReferenceElement) {
    for xi in everywhere(element.domain(), 5) {
        let (shape, gradients) = (element.shape(xi), element.gradients(xi));
        assert_eq!([shape.len(), gradients.len()], [element.nodes(); 2]);
        assert!((shape.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        let at = element.position(element.node_coordinates(), xi);
        assert!(length(difference(at, xi)) < 1e-15, "{}", element.name());
        for axis in 0..3 {
            let sum: f64 = gradients.iter().map(|gradient| gradient[axis]).sum();
            assert!(sum.abs() < 1e-14, "{}", element.name());
            let beyond = gradients.iter().all(|gradient| gradient[axis] == 0.0);
            assert_eq!(beyond, axis >= element.dim(), "{}", element.name());
        }
    }
}

fn gradients_are_difference_quotients(element: &ReferenceElement) {
    let (mut xi, step) = ([0.2, 0.3, 0.15], 1e-5);
    xi[element.dim()..].fill(0.0);
    let gradients = element.gradients(xi);
    for axis in 0..element.dim() {
        let (mut ahead, mut behind) = (xi, xi);
        ahead[axis] += step;
        behind[axis] -= step;
        let (ahead, behind) = (element.shape(ahead), element.shape(behind));
        for i in 0..element.nodes() {
            let quotient = (ahead[i] - behind[i]) / (2.0 * step);
            assert!((quotient - gradients[i][axis]).abs() < 1e-9);
        }
    }
}

fn turned_over_it_has_the_opposite_measure(element: &ReferenceElement) {
    let (at, order) = (element.node_coordinates(), element.reversed());
    let mut every = order.to_vec();
    every.sort_unstable();
    assert!(every.into_iter().eq(0..element.nodes()), "{order:?}");
    if element.dim() >= 2 {
        let measure = element.domain().measure();
        assert!((element.measure(at) - measure).abs() < rounding(element, 1e-14));
        let bent = bent(element);
        let turned: Vec<_> = order.iter().map(|&i| bent[i]).collect();
        let sum = element.measure(&bent) + element.measure(&turned);
        assert!(
            sum.abs() < rounding(element, 1e-13),
            "{}: {sum:e}",
            element.name()
        );
    }
}

fn facets_are_those_of_the_cell(element: &ReferenceElement) {
    for (number, (facet, local)) in element.facets().iter().enumerate() {
        assert_eq!(
            [facet.nodes(), facet.dim() + 1],
            [local.len(), element.dim()]
        );
        if element.dim() == 2 {
            assert_eq!(local[..2], [number, (number + 1) % element.corners()]);
        }
        assert!(
            local[..facet.corners()]
                .iter()
                .all(|&corner| corner < element.corners())
        );
        let at: Vec<_> = (local.iter())
            .map(|&i| element.node_coordinates()[i])
            .collect();
        for xi in everywhere(facet.domain(), 4) {
            let on_cell = element.shape(facet.position(&at, xi));
            for (i, value) in on_cell.into_iter().enumerate() {
                let place = local.iter().position(|&n| n == i);
                let on_facet = place.map_or(0.0, |place| facet.shape(xi)[place]);
                assert!((value - on_facet).abs() < 1e-15, "{} {i}", element.name());
            }
        }
    }
}

/// The nodes of a cell of no special shape, its edges curved where they can be.
pub fn bent(element: &ReferenceElement) -> Vec<[f64; 3]> {
    let nodes = element.node_coordinates().iter();
    nodes
        .map(|&[x, y, z]| {
            [
                0.2 + 1.1 * x + 0.3 * y + 0.1 * y * y + 0.2 * z - 0.07 * x * z,
                0.1 + 1.6 * y - 0.2 * x * y + 0.05 * x * x + 0.06 * z * z,
                z * (0.9 + 0.1 * x - 0.05 * y * z),
            ]
        })
        .collect()
}

/// ∮ n dS = 0, and ∮ x·n dS = ∫ div x dx = dim · |cell|.
fn normals_close(element: &ReferenceElement) {
    let at = bent(element);
    let (mut sum, mut moment) = ([0.0; 3], 0.0);
    for (facet, local) in element.facets() {
        let on: Vec<_> = local.iter().map(|&i| at[i]).collect();
        for (xi, weight) in facet.quadrature(7) {
            let normal = facet.area_vector(&on, xi);
            sum = advance(sum, weight, normal);
            moment += weight * dot(normal, facet.position(&on, xi));
        }
    }
    assert!(length(sum) < rounding(element, 1e-14), "{}", element.name());
    let error = moment - element.dim() as f64 * element.measure(&at);
    assert!(
        error.abs() < rounding(element, 1e-13),
        "{}: {error:e}",
        element.name()
    );
}

/// The Jacobian of a cell reported without fold is positive everywhere, and that of a folded one isn't where reported.
fn the_jacobian_is_bounded(element: &ReferenceElement) {
    let mut seed = 5_u64;
    let mut draw = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
    };
    let (floor, mut sound, mut folded) = (1e-3, 0, 0);
    for round in 0..200 {
        let amount = 1e-3 * 1.045_f64.powi(round);
        let at: Vec<[f64; 3]> = (element.node_coordinates().iter())
            .map(|&node| {
                let mut at = node;
                let moved = at.iter_mut().take(element.dim());
                moved.for_each(|x| *x += amount * draw());
                at
            })
            .collect();
        let jacobians = everywhere(element.domain(), [40, 8][element.dim() - 2])
            .map(|xi| element.jacobian(&at, xi));
        let least = jacobians.fold(f64::INFINITY, f64::min);
        match element.fold(&at, floor) {
            None => {
                sound += 1;
                assert!(least > floor, "{}: {least}", element.name());
            }
            // The reported value is that of the Jacobian at the reported position.
            Some(fold) => {
                folded += 1;
                assert!(
                    fold.jacobian <= floor + 1e-6,
                    "{}: {fold:?}",
                    element.name()
                );
            }
        }
    }
    assert!(sound > 20 && folded > 20, "{sound} {folded}");
}

/// Rules are compared with one of far higher degree, cell by cell as they promise.
fn rules_are_exact(element: &ReferenceElement, rules: CellRules) {
    let (bent, stretched) = (bent(element), stretched(element));
    for (degree, at, integrand) in [
        // ∫ ∂N/∂x dx: the cofactors of J times ∂N/∂ξ.
        (rules.stiffness, &bent, slope_along_x as Integrand),
        (rules.constant_load, &bent, constant_load),
        (rules.cubic_load, &stretched, cubic_load),
    ] {
        let integral = |degree: usize| {
            let mut sums = vec![0.0; element.nodes()];
            for point in element.tabulate(degree) {
                let values = integrand(element, at, point.xi);
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += point.weight * value;
                }
            }
            sums
        };
        let most = [16, 11][element.dim() - 2];
        for (sum, exact) in integral(degree).into_iter().zip(integral(most)) {
            let error = (sum - exact).abs();
            assert!(
                error < rounding(element, 1e-13),
                "{}, degree {degree}: {error:e}",
                element.name()
            );
        }
    }
    let area: f64 = (element.stress_points().iter())
        .map(|point| point.weight)
        .sum();
    assert!((area - element.domain().measure()).abs() < rounding(element, 1e-14));
}

/// The integrand over the reference element, for each node.
type Integrand = fn(&ReferenceElement, &[[f64; 3]], [f64; 3]) -> Vec<f64>;

/// The nodes of a cell with straight edges and nodes in their middle, whose map is affine.
fn stretched(element: &ReferenceElement) -> Vec<[f64; 3]> {
    let nodes = element.node_coordinates().iter();
    nodes
        .map(|&[x, y, z]| {
            [
                0.3 + x + 0.4 * y + 0.2 * z,
                0.8 * y - 0.1 * x,
                0.7 * z + 0.1 * y,
            ]
        })
        .collect()
}

fn slope_along_x(element: &ReferenceElement, at: &[[f64; 3]], xi: [f64; 3]) -> Vec<f64> {
    let gradients = element.gradients(xi);
    let [mut y, mut z] = [[0.0; 3]; 2];
    for (&gradient, x) in gradients.iter().zip(at) {
        y = advance(y, x[1], gradient);
        z = advance(z, x[2], gradient);
    }
    if element.dim() == 2 {
        z = [0.0, 0.0, 1.0];
    }
    gradients.iter().map(|&g| dot(g, cross(y, z))).collect()
}

fn constant_load(element: &ReferenceElement, at: &[[f64; 3]], xi: [f64; 3]) -> Vec<f64> {
    let det = element.jacobian(at, xi);
    element.shape(xi).into_iter().map(|n| n * det).collect()
}

fn cubic_load(element: &ReferenceElement, at: &[[f64; 3]], xi: [f64; 3]) -> Vec<f64> {
    let [x, y, z] = element.position(at, xi);
    let load = x * x * y - y * y * y + x * x * x + x * y * z - z * z * z;
    let values = constant_load(element, at, xi);
    values.into_iter().map(|value| value * load).collect()
}
