//! Meshes broken at random, in every version and encoding.

use proptest::prelude::*;

use super::{SCENE, breaks, broken, cases, is_said, partition};

/// A scene of the meshes in space in `../library/gmsh/kinds`.
const RING: &str = include_str!("corpus/good-ring.toml");

const IN_SPACE: [&[u8]; 6] = [
    include_bytes!("../library/gmsh/kinds/tetrahedra-4-4.1-binary.msh"),
    include_bytes!("../library/gmsh/kinds/tetrahedra-10-2.2-binary.msh"),
    include_bytes!("../library/gmsh/kinds/hexahedra-8-2.2-ascii.msh"),
    include_bytes!("../library/gmsh/kinds/hexahedra-20-4.1-ascii.msh"),
    include_bytes!("../library/gmsh/kinds/hexahedra-27-4.1-binary.msh"),
    include_bytes!("../library/gmsh/kinds/hexahedra-27-2.2-ascii.msh"),
];

const MESHES: [&[u8]; 8] = [
    include_bytes!("../library/gmsh/files/version4.1-ascii.msh"),
    include_bytes!("../library/gmsh/files/version4.1-binary.msh"),
    include_bytes!("../library/gmsh/files/version4.1-ascii-parametric.msh"),
    include_bytes!("../library/gmsh/files/version4.1-binary-parametric.msh"),
    include_bytes!("../library/gmsh/files/version2.2-ascii.msh"),
    include_bytes!("../library/gmsh/files/version2.2-binary.msh"),
    include_bytes!("../library/gmsh/files/version2.2-ascii-parametric.msh"),
    include_bytes!("../library/gmsh/files/version2.2-binary-parametric.msh"),
];

/// Beginnings of files, which are followed by random bytes.
const STARTS: [&[u8]; 5] = [
    b"",
    b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n",
    b"$MeshFormat\n4.1 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Nodes\n",
    b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n",
    b"$MeshFormat\n2.2 1 8\n\x01\0\0\0\n$EndMeshFormat\n$Nodes\n",
];

#[test]
fn every_mesh_is_good_before_it_is_broken() {
    for mesh in MESHES {
        partition(SCENE, mesh).unwrap();
    }
    for mesh in IN_SPACE {
        partition(RING, mesh).unwrap();
    }
}

proptest! {
    #![proptest_config(cases(2500))]

    #[test]
    fn a_broken_mesh_is_refused_in_words_or_makes_a_problem(
        mesh in 0..MESHES.len(),
        breaks in breaks(),
    ) {
        if let Err(error) = partition(SCENE, &broken(MESHES[mesh], &breaks)) {
            is_said(&error)?;
        }
    }

    #[test]
    fn a_broken_mesh_in_space_is_refused_in_words_or_makes_a_problem(
        mesh in 0..IN_SPACE.len(),
        breaks in breaks(),
    ) {
        if let Err(error) = partition(RING, &broken(IN_SPACE[mesh], &breaks)) {
            is_said(&error)?;
        }
    }

    #[test]
    fn noise_is_no_mesh(
        start in 0..STARTS.len(),
        numbers in prop::collection::vec(-3i64..12, 0..60),
        noise in prop::collection::vec(any::<u8>(), 0..200),
    ) {
        let words: Vec<String> = numbers.iter().map(i64::to_string).collect();
        let bytes = [STARTS[start], words.join(" ").as_bytes(), &noise].concat();
        is_said(&partition(SCENE, &bytes).unwrap_err())?;
    }
}
