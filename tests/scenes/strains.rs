//! Large strains are reported, with their position.

use contact_dd_partition::element::ElementKind::{Hexahedron8, Hexahedron20, Tetrahedron10};

use crate::support::blocks::Blocks;
use crate::support::scenes::model;
use crate::support::solids::{between, solid};
use crate::support::solution::Solution;
use crate::support::solver::Case;
use crate::support::sorts::{SORTS, sort};

/// The warnings of strains of the last load step.
fn printed(text: &str, mesh: contact_dd_partition::mesh::Mesh, args: &[&str]) -> Vec<String> {
    let case = Case::of(&model(text, mesh), 3);
    let ended = case.run(args);
    assert_eq!(ended.code(), 0, "{}{}\n{text}", ended.stdout, ended.stderr);
    let report = Solution::read_report(&case.result());
    let warnings = report["warnings"].as_array().unwrap().iter();
    let words = warnings.map(|words| words.as_str().unwrap().to_owned());
    words
        .filter(|words| words.contains("strains of up to"))
        .collect()
}

/// u_x = s (x + x²/2) at all nodes, so that the largest strain, of about s (1 + x), is in the cells at x = 1.
fn stretched(strain: f64, others: &str) -> String {
    format!(
        "materials.rubber = {{young = 1e6, poisson = 0.3}}
        bodies.block.material = 'rubber'
        large_strains = true
        [[displacement]]
        on = ['block left', 'block right', 'block bottom', 'block top']
        x = '{strain}*(x+x^2/2)'
        {others}"
    )
}

#[test]
fn the_largest_strain_is_said_with_its_place() {
    for (strain, is_said) in [(0.04, true), (-0.03, true), (0.02, false)] {
        for name in SORTS.map(|sort| sort.name) {
            let blocks = Blocks::new().rectangle("block", [0.0, 1.0], [0.0, 0.05], [20, 1]);
            let text = format!("plane = 'strain'\n{}", stretched(strain, "y = 0"));
            let words = printed(&text, sort(name).of(&blocks.mesh), &[]);
            assert_eq!(words.len(), usize::from(is_said), "{name}: {words:?}");
            let Some(words) = words.first() else { continue };
            let number = |from: &str, to: &str| -> f64 {
                let (_, rest) = words.split_once(from).unwrap();
                rest.split_once(to).unwrap().0.parse().unwrap()
            };
            let (found, x) = (number("strains of up to ", " at"), number("at (", ","));
            assert!((found / strain.abs() - 1.975).abs() < 0.03, "{words}");
            assert!(x > 0.95, "{words}");
            assert!(words.starts_with("body 'block': "), "{words}");
        }
    }
}

#[test]
fn strains_of_space_and_around_an_axis_are_said_in_their_load_step_alone() {
    let steps = "[[step]]\nscale = 0.5\n[[step]]\nname = 'far'\n";
    for kind in [Hexahedron8, Hexahedron20, Tetrahedron10] {
        // Pure shear: half of γ.
        let text = format!(
            "materials.rubber = {{young = 1e6, poisson = 0.3}}
            bodies.block.material = 'rubber'
            [[displacement]]
            on = ['block x0', 'block x1', 'block y0', 'block y1', 'block z0', 'block z1']
            x = '0.16*z'
            y = 0
            z = 0
            {steps}"
        );
        let mesh = solid("block", kind, [2, 2, 2], between([0.0; 3], [1.0; 3]));
        let words = printed(&text, mesh, &[]);
        assert_eq!(words.len(), 1, "{words:?}");
        assert!(
            words[0].starts_with("step 'far': body 'block': strains of up to 0.08 at ("),
            "{words:?}"
        );
    }
    // Hoop strain of a ring displaced outwards by 0.1 m: 0.1/(1 + 0.1/3) in its innermost triangle.
    let blocks = Blocks::new().rectangle("block", [1.0, 2.0], [0.0, 0.1], [10, 1]);
    let text = "plane = 'axisymmetric'\nmaterials.rubber = {young = 1e6, poisson = 0.3}
        bodies.block.material = 'rubber'
        [[displacement]]
        on = ['block left', 'block right', 'block bottom', 'block top']
        x = 0.1
        y = 0";
    let words = printed(text, blocks.mesh.clone(), &[]);
    assert!(
        words[0].contains("strains of up to 0.09677 at (1.033,"),
        "{words:?}"
    );
    // Without stresses, strains aren't computed.
    assert!(printed(text, blocks.mesh, &["--no-stress"]).is_empty());
}
