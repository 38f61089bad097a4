//! Meshes and scenes in space with one defect each: all are refused with a message that names the defect.

use super::partition;
use super::table::cases;

const MESH: &str = include_str!("corpus/good-in-space.msh");
const SCENE: &str = include_str!("corpus/good-in-space.toml");

/// A text and its replacement, and in the next line the expected message; for the mesh: a hexahedron below six
/// tetrahedra.
const MESHES: &str = r#"
\n15 1.25 1 2\n => \n15 0.25 0 1.5\n
    element 12 has no volume
\n7 1 1 1\n => \n7 -1 -1 -1\n
    element 9 (hexahedron of 8 nodes) is folded
1 2 3 4 5 6 7 8\n => 1 2 3 4 6 5 8 7\n
    element 9 has no volume
1 2 3 4 5 6 7 8\n => 1 2 3 4 5 6 7 7\n
    near node 7: it has the node 7 twice; expected nodes that all differ
2 2 2 9 10 11 15\n => 2 2 2 9 10 10 15\n
    element 10 has no volume
2 2 2 9 10 11 15\n => 2 2 2 9 10 11 99\n
    names node 99, which isn't among $Nodes
\n15 4 2 2 2 9 14 10 15\n => \n15 4 2 2 2 9 14 10\n
    line 51 in $Elements
10 4 2 2 2 9 10 11 15\n => 10 6 2 2 2 9 10 11 13 14 15\n
    is of type 6, a prism
10 4 2 2 2 9 10 11 15\n => 10 7 2 2 2 9 10 11 12 15\n
    is of type 7, a pyramid
10 4 2 2 2 9 10 11 15\n => 10 29 2 2 2 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 1 2 3 4\n
    of third or higher order
10 4 2 2 2 9 10 11 15\n => 10 11 2 2 2 9 10 11 15 9 10 11 15 13 14\n
    element 10 (tetrahedron of 10 nodes) is folded
9 5 2 1 1 1 2 => 9 17 2 1 1 1 2
    line 51 in $Elements
11 4 2 2 2 9 11 12 15\n => 11 4 2 2 2 9 10 11 15\n
    listed twice
11 4 2 2 2 9 11 12 15\n => 11 4 2 1 1 9 10 11 15\n
    is in both
11 4 2 2 2 9 11 12 15\n => 11 4 2 2 2 9 10 11 16\n
    lie on the same side of the face
12 4 2 2 2 9 12 16 15\n => 12 4 2 2 2 5 6 7 15\n
    of a face of element 9 for a face of its own
7 2 2 6 6 13 14 15\n => 7 2 2 6 6 13 14 12\n
    the facet of nodes 13, 14, 12 belongs to no cell
7 2 2 6 6 13 14 15\n => 7 2 2 6 6 9 11 15\n
    lies between two cells
4 3 2 4 4 5 6 7 8\n => 4 2 2 4 4 5 6 7\n
    is only a part of a face
7 2 2 6 6 13 14 15\n => 7 2 2 6 6 13 15 16\n
    the element 7 is listed twice
3 3 2 3 3 1 4 3 2\n => 3 3 2 4 4 1 4 3 2\n
    the group 'bottom' is empty
3 1 "lower body" => 2 1 "lower body"
    'lower body' is a group of facets
2 4 "lower face" => 3 4 "lower face"
    'lower face' is a group of cells
2 6 "top" => 2 5 "top"
    physical group 5 of dimension 2 has two names
\n7 1 1 1\n => \n7 nan 1 1\n
    the x coordinate is NaN
\n7 1 1 1\n => \n7 1 1e300 1\n
    at most 1e120
\n7 1 1 1\n => \n7 1 1e100 1\n
    element 9 has no volume
\n10 1.25 0 1\n => \n10 0.25 0 1\n
    element 10 has no volume
\n10 1.25 0 1\n => \n9 1.25 0 1\n
    the node tag 9 occurs twice
\n10 1.25 0 1\n => \n10 1.25 0\n
    $Nodes
$Elements\n15\n => $Elements\n150\n
    $Elements
$Elements\n15\n => $Elements\n4611686018427387904\n
    $Elements
"#;

/// Of the scene.
const SCENES: &str = r#"
mesh = => plane = 'strain'\nmesh =
    a plane scene has vectors of two components
[0.0, 0.0, -25e3] => [0.0, -25e3]
    a scene in space has vectors of three components
[0.0, 0.0, -25e3] => [0.0, 0.0, 0.0, -25e3]
    a vector of 4 components
young = 20e9\npoisson = 0.25 => stiffness = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    expected 6 rows of 6 numbers
young = 20e9\npoisson = 0.25 => stiffness = [[1,2,0,0,0,0],[2,1,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]
    isn't positive definite
young = 20e9\npoisson = 0.25 => stiffness = [[3,2,0,0,0,0],[1,3,0,0,0,0],[0,0,1,0,0,0],[0,0,0,1,0,0],[0,0,0,0,1,0],[0,0,0,0,0,1]]
    isn't symmetric
poisson = 0.25 => poisson = 0.25\nout_of_plane = [1, 2, 3]
    'out_of_plane' belongs to 'stiffness'
poisson = 0.25 => poisson = 0.5
    poisson
[bodies."upper body"]\nmaterial = "rock"\n =>
    the group 'upper body' isn't among [bodies]
[bodies."upper body"] => [bodies.top]
    'top' is a group of facets; expected one of cells
z = "1e-4*x" => z = "1e-4*w"
    'w' isn't known
z = "1e-4*x" => w = 0.0
    'w'
on = "bottom" => on = "botom"
    did you mean 'bottom'?
on = "top" => on = "corner"
    'corner' is a group of points; expected one of facets
on = "top" => on = "edge"
    'edge' is a group of curves; expected one of facets
on = "top" => on = "upper body"
    'upper body' is a group of cells; expected one of facets
on = "top"\nvalue = "1e6*(1-x*y)" => on = "top"\nvalue = "1/(x-x)"
    finite number
["upper face", "lower face"] => ["upper face", "upper face"]
    is on both 'sides'
["upper face", "lower face"] => ["upper face", "top"]
    expected sides that face each other
["upper face", "lower face"] => ["top", "bottom"]
    expected sides that face each other
friction = 0.4 => friction = -0.4
    it is -0.4; expected 0 or more
friction = 0.4 => friction = "1/(x-x)"
    expected a finite number
friction = 0.4 => friction = 0.4\ntresca = 1e5
    tresca
[0.5, 0.5, 5.0] => [0.5, 5.0]
    a scene in space has vectors of three components
[0.5, 0.5, 5.0] => [0.5, 0.5, 2.0]
    no node of the side faces the obstacle
radius = 3.0 => radius = 0.0
    the radius is 0; expected more than 0
radius = 3.0 => radius = -3.0
    the radius is -3; expected more than 0
radius = 3.0 => radius = 3.0, normal = [0, 0, 1]
    expected 'point' and 'normal'
center = [0.5, 0.5, 5.0], radius = 3.0 => point = [0, 0, 5], normal = [0, 0, 0]
    has no direction
center = [0.5, 0.5, 5.0], radius = 3.0 => point = [0, 0, 5], axis = [0, 0, 0], radius = 1
    has no direction
center = [0.5, 0.5, 5.0], radius = 3.0 => axis = [0, 0, 1], radius = 1
    'point', 'axis', 'radius'
center = [0.5, 0.5, 5.0], radius = 3.0 => point = [0, 0, nan], normal = [0, 0, -1]
    NaN
gap = 0.1 => gap = nan
    NaN isn't a finite number
name = "ball" => name = "joint"
    joint
"#;

/// The rows of a table of defects whose message isn't the expected one.
fn faults(text: &str, table: &str, refused: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let fault = |(from, to, words): (String, String, String)| {
        assert_eq!(text.matches(&from).count(), 1, "{from}");
        let message = refused(&text.replace(&from, &to)).unwrap_or("taken for good".into());
        (!message.contains(&words)).then(|| format!("{to:?}: {message}"))
    };
    cases(table).filter_map(fault).collect()
}

#[test]
fn what_is_broken_in_space_is_refused_in_words() {
    let refused = |scene: &str, mesh: &str| {
        let error = partition(scene, mesh.as_bytes()).err();
        error.map(|error| error.to_string())
    };
    assert_eq!(refused(SCENE, MESH), None);
    let of_meshes = faults(MESH, MESHES, |mesh| refused(SCENE, mesh));
    let of_scenes = faults(SCENE, SCENES, |scene| refused(scene, MESH));
    let faults = [of_meshes, of_scenes].concat();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
