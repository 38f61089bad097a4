//! Punches on blocks with non-matching meshes, a quarter of each in space and a half in the plane.

use contact_dd_partition::element::ElementKind::{
    self, Hexahedron8, Hexahedron20, Quad4, Quad8, Tetrahedron4, Tetrahedron10, Triangle3,
    Triangle6,
};
use contact_dd_partition::mesh::Mesh;
use contact_dd_partition::model::Model;

use crate::blocks::{self, Blocks, joined};
use crate::random::Random;
use crate::scenes::model;
use crate::solids::{between, moved, solid};
use crate::sorts::sort;

/// Height and width of a block.
pub const BLOCK: f64 = 10.0;

/// A punch pressed on a block by 100 Pa on its top, held along x and y by symmetry only.
#[derive(Clone, Debug)]
pub struct Punch {
    /// The kind of cells.
    pub kind: ElementKind,
    /// Cells along the edges of the block.
    pub block: usize,
    /// Cells across the punch.
    pub across: usize,
    /// The half-width (m).
    pub width: f64,
    /// The radius of its lower face; infinite where that is flat (m).
    pub radius: f64,
}

impl Punch {
    /// A punch of random size and radius on random meshes: its cells measure 0.1 to 6 times those of the block.
    pub fn random(random: &mut Random) -> Self {
        let (kind, most) = random.pick(&[
            (Triangle3, 20),
            (Quad4, 20),
            (Triangle6, 10),
            (Quad8, 10),
            (Hexahedron8, 8),
            (Tetrahedron4, 7),
            (Hexahedron20, 4),
            (Tetrahedron10, 4),
        ]);
        Self {
            kind,
            block: random.count(2, most),
            across: random.count(1, 6),
            width: random.within(0.5, 5.0),
            radius: random.pick(&[5.0, 10.0, 30.0, 100.0, f64::INFINITY]),
        }
    }

    /// True if it is in the plane.
    fn is_plane(&self) -> bool {
        self.kind.dim() == 2
    }

    /// The mesh.
    pub fn mesh(&self) -> Mesh {
        let Self {
            kind,
            width,
            radius,
            ..
        } = *self;
        let height = 1.5 * width;
        let rounded =
            move |far: f64, up: f64| (BLOCK + height - up) / height * far / (2.0 * radius);
        if self.is_plane() {
            let cells = sort(match kind {
                Quad4 => "quad4",
                Quad8 => "quad8",
                Triangle6 => "triangle6",
                _ => "triangle3",
            });
            let [n, m] = [self.block, self.across];
            let block = Blocks::new().rectangle("block", [0.0, BLOCK], [0.0, BLOCK], [n, n]);
            let sides = ([0.0, width], [BLOCK, BLOCK + height]);
            let punch = Blocks::new().rectangle("punch", sides.0, sides.1, [m, 3]);
            let [block, punch] = [block, punch].map(|part| cells.of(&part.mesh));
            return joined(
                block,
                blocks::moved(punch, |[x, y]| [x, y + rounded(x * x, y)]),
            );
        }
        let block = solid(
            "block",
            kind,
            [self.block; 3],
            between([0.0; 3], [BLOCK; 3]),
        );
        let low = [0.0, 0.0, BLOCK];
        let high = [width, width, BLOCK + height];
        let punch = solid(
            "punch",
            kind,
            [self.across, self.across, 3],
            between(low, high),
        );
        let punch = moved(punch, |[x, y, z]| [x, y, z + rounded(x * x + y * y, z)]);
        joined(block, punch)
    }

    /// The names of the sides in contact: of the block, of the punch.
    pub fn sides(&self) -> [&'static str; 2] {
        match self.is_plane() {
            true => ["block top", "punch bottom"],
            false => ["block z1", "punch z0"],
        }
    }

    /// The model with these two contact sides in this order.
    pub fn model(&self, [a, b]: [&str; 2]) -> Model {
        let (held, top, plane) = match self.is_plane() {
            true => (
                "['block left', 'punch left', 'block bottom']",
                "punch top",
                "plane = 'strain'",
            ),
            false => (
                "['block x0', 'block y0', 'punch x0', 'punch y0', 'block z0']",
                "punch z1",
                "",
            ),
        };
        let text = format!(
            "{plane}
materials.steel = {{young = 210e3, poisson = 0.3}}
bodies.block.material = 'steel'
bodies.punch.material = 'steel'
[[bilateral]]
on = {held}
[[pressure]]
on = '{top}'
value = 100
[[contact]]
name = 'c'
sides = ['{a}', '{b}']
"
        );
        model(&text, self.mesh())
    }
}
