//! The schema of the problem file: every group, dataset and attribute, with its shape, type and meaning. The writer,
//! the reader, the check of unknown names and the tables of docs/problem-file.md follow from it.

mod counts;
mod kind;
mod letters;

use self::Kind::{
    Codes, GroupNames, Indices, Integers, Lines, Names, NotNegative, Numbers, NumbersOrNan,
    Offsets, Positive, Sizes, UnitVectors,
};
pub use self::counts::Counts;
pub use self::kind::Kind;
pub use self::letters::LETTERS;
use crate::model::Formulation;

/// The datasets that mark materials with another formulation than full integration.
pub(super) const FORMULATIONS: [(Formulation, &str); 2] = [
    (
        Formulation::IncompatibleModes,
        "/materials/incompatible_modes",
    ),
    (Formulation::Reduced, "/materials/reduced_integration"),
];

/// A dataset.
#[derive(Debug)]
pub struct Field {
    /// Path in the file.
    pub path: &'static str,
    /// Extents, by letter: "R, d". One with a question mark is left out if it is 0.
    pub shape: &'static str,
    /// The kind of its values.
    pub kind: Kind,
    /// True if it may be missing from a nonempty group.
    pub optional: bool,
    /// The meaning of its values.
    pub meaning: &'static str,
}

/// An attribute.
#[derive(Debug)]
pub struct Attribute {
    /// Its group.
    pub group: &'static str,
    /// Name.
    pub name: &'static str,
    /// Value.
    pub value: &'static str,
}

/// Sets of optional datasets of which a file has either all or none.
pub const TOGETHER: [&[&str]; 3] = [
    &["/support/condition", "/support/name"],
    &["/initial_stress/cell", "/initial_stress/node"],
    &["/contact/law", "/contact/friction", "/contact/shear_bound"],
];

/// Groups that may be empty. All except `/support` may also be missing.
pub const MAY_BE_EMPTY: [&str; 12] = [
    "/interface",
    "/support",
    "/spring",
    "/force",
    "/contact",
    "/probe",
    "/tip",
    "/quantity",
    "/weight",
    "/parameter",
    "/load",
    "/steps",
];

/// Groups that may hold further arrays for ParaView.
pub const FREE: [&str; 3] = ["/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"];

/// All attributes.
#[rustfmt::skip]
pub const ATTRIBUTES: &[Attribute] = &[
    attribute("/", "format", "`\"contact-dd-mpi problem\"`"),
    attribute("/", "version", "2"),
    attribute("/", "title", "a line of text; optional"),
    attribute("/", "units",
        "`\"m\"` (m, N, Pa) or `\"mm\"` (mm, N, MPa), the names of units in messages and pictures; optional"),
    attribute("/", "dimension", "2 or 3"),
    attribute("/", "plane", "`\"strain\"`, `\"stress\"` or `\"axisymmetric\"` (x the radius, y the axis x = 0, zz the hoop); absent in 3 dimensions"),
    attribute("/VTKHDF", "Version", "`[2, 0]`; optional"),
    attribute("/VTKHDF", "Type",
        "`\"UnstructuredGrid\"`: ParaView's reader needs a string of 16 bytes, null-padded, \
         without terminator; optional"),
    attribute("/settings", "method", "`\"newton\"`, `\"anderson\"` or `\"picard\"`"),
    attribute("/settings", "tolerance",
        "residual of the interface problem at which sweeps end, above 0"),
    attribute("/settings", "max_sweeps", "largest number of sweeps, an integer"),
    attribute("/settings", "relaxation", "relaxation of picard, above 0"),
    attribute("/settings", "no_stress",
        "true: stresses are left out. A Boolean as h5py writes it, or 1 or 0"),
];

/// All datasets, starting with those whose shapes define the count of a letter.
#[rustfmt::skip]
pub const FIELDS: &[Field] = &[
    field("/steps/name", "L", Names, "at least one"),
    field("/steps/time", "L", Numbers, "ascending"),
    optional("/steps/body", "L, B", Codes("presence", 2),
        "1 where the body is active, 0 where it is inactive: then neither a force nor an initial stress nor a prescribed \
         displacement other than 0 may act on it, and its contact points are inactive, too; without this dataset all \
         bodies are active"),
    optional("/steps/contact", "L, Q", Codes("presence", 2),
        "1 where the contact is active if its bodies are, 0 where it is inactive; without this dataset all contacts are \
         active. Gap and slip of an activated contact count from the displacements at the end of the previous step"),
    field("/VTKHDF/NumberOfPoints", "N", Sizes('P'), "points of each subdomain"),
    field("/VTKHDF/NumberOfCells", "N", Sizes('C'), "cells of each subdomain"),
    field("/VTKHDF/NumberOfConnectivityIds", "N", Sizes('K'),
        "connectivity entries of each subdomain"),
    field("/VTKHDF/Points", "P, 3", Numbers, "coordinates [m]; in the plane z = 0"),
    field("/VTKHDF/Types", "C", Integers,
        "VTK's cell type: 5 or 22, triangle of 3 or 6 nodes; 9, 23 or 28, quadrilateral of 4, 8 \
         or 9; in space 10 or 24, tetrahedron of 4 or 10 nodes; 12, 25 or 29, hexahedron of 8, 20 or 27"),
    field("/VTKHDF/Offsets", "C + N", Integers,
        "start of each cell in the subdomain's connectivity, and its end: cells + 1 entries for \
         every subdomain, each starting with 0"),
    field("/VTKHDF/Connectivity", "K", Integers,
        "nodes of the cells, counted within the subdomain: corners counter-clockwise, then the \
         node on each edge, the first between the first two corners, then the one in the middle; in space in the \
         order of VTK"),
    field("/VTKHDF/PointData/GlobalNodeId", "P", Integers,
        "a number ≥ 0 that names the node: equal for copies of one node on Γ, different for all \
         others, such as those on the two sides of a contact"),
    field("/VTKHDF/CellData/Material", "C", Indices("material", 'M'), "index of the material"),
    optional("/VTKHDF/CellData/Subdomain", "C", Integers, "for ParaView; not read"),
    field("/materials/name", "M", Names, ""),
    field("/materials/stiffness", "M, v, v", Numbers,
        "maps (ε_xx, ε_yy, γ_xy) to (σ_xx, σ_yy, σ_xy) for the plane state of the file [Pa], around an axis in the \
         order xx, yy, zz, xy, in space xx, yy, zz, yz, xz, xy; symmetric positive definite"),
    optional("/materials/out_of_plane", "M, v", NumbersOrNan,
        "in plane strain and stress: maps the same strains to σ_zz; rows of NaN where it isn't known"),
    optional("/materials/poisson", "M", NumbersOrNan, "Poisson's ratio; NaN where it isn't known"),
    optional("/materials/incompatible_modes", "M", Codes("formulation", 2),
        "1 where the 4-node quadrilaterals and 8-node hexahedra of the material have incompatible modes, 0 where they don't; \
         without it none have"),
    optional("/materials/reduced_integration", "M", Codes("formulation", 2),
        "1 where the 8-node quadrilaterals and 20-node hexahedra of the material are integrated at two points in each direction, \
         0 where at three; without it all are at three"),
    field("/bodies/name", "B", Names,
        "names of the bodies; a body is connected through shared nodes, its subdomains through Γ"),
    field("/subdomains/body", "N", Indices("body", 'B'), "body of each subdomain"),
    field("/subdomains/group", "N", Integers, "contact group of each subdomain, −1 for none"),
    optional("/subdomains/reference", "N", Integers,
        "number of the last points of each subdomain, which belong to no cell: corners of the frames of reference points \
         of couplings, which move with its body; without this dataset there are none"),
    field("/hierarchy/parent", "T", Integers, "parent of each node, −1 for a root"),
    optional("/hierarchy/cluster", "Z", Indices("node of the hierarchy", 'T'),
        "the nodes between which `--interface iterative` works, strictly ascending: each subdomain is one of them or \
         under exactly one"),
    field("/interface/offset", "N + 1", Offsets('I'), "slices of the two datasets below"),
    field("/interface/node", "I", Integers, "node, counted within the subdomain"),
    field("/interface/interface", "I", Indices("number on Γ", 'I'),
        "its number on Γ, equal in all subdomains that share it; strictly ascending within a \
         subdomain. All numbers from 0 up occur, each in two or more subdomains of one body"),
    field("/support/offset", "N + 1", Offsets('S'), "slices of the datasets below but for `name`"),
    field("/support/node", "S", Integers, "node, ascending within a subdomain"),
    field("/support/direction", "S, d", UnitVectors,
        "unit vector; those of one node are orthogonal"),
    field("/support/value", "S, L?", Numbers,
        "prescribed displacement along it [m], in every load step"),
    optional("/support/condition", "S", Indices("condition", 'U'),
        "the condition that it comes from, an index into `name`: the report sums up reactions by \
         condition"),
    optional("/support/name", "U", Lines,
        "names of the conditions; with `condition` or not at all"),
    field("/spring/offset", "N + 1", Offsets('Y'), "slices of the datasets below"),
    field("/spring/node", "Y, 2", Integers,
        "two nodes of one cell, or one node twice: row and column of a block of the stiffness K_s of springs to the ground, \
         which exert −K_s u; K_s is positive semidefinite"),
    field("/spring/stiffness", "Y, d, d", Numbers,
        "the block [N/m], row by row; of two nodes the transposed one isn't listed"),
    field("/spring/condition", "Y", Indices("condition", 'U'),
        "the condition that it comes from, an index into `/support/name`"),
    field("/force/offset", "N + 1", Offsets('F'), "slices of the two datasets below"),
    field("/force/node", "F", Integers, "node, strictly ascending within a subdomain"),
    field("/force/value", "F, L?, d", Numbers, "nodal force [N], in every load step"),
    optional("/initial_stress/cell", "C, L?, 6", Numbers,
        "initial stress of the cell, its mean, in every load step: XX, YY, ZZ, XY, YZ, XZ [Pa]. Results add it to C ε; \
         its nodal forces are in `/force`"),
    optional("/initial_stress/node", "P, L?, 6", Numbers,
        "the same at the node, in the first of the materials that the subdomain has around it; with `cell` or not at all"),
    field("/contact/name", "Q", GroupNames, "names of the contacts"),
    field("/contact/contact", "R", Indices("contact", 'Q'), "index of the contact"),
    field("/contact/group_offset", "G + 1", Offsets('R'),
        "contact points of each contact group, at least one"),
    field("/contact/place", "R", Indices("place", 'R'),
        "place in the contact's results: 0 up to the number of its points, each once"),
    field("/contact/gap", "R", Numbers, "g [m]; negative for an interference fit"),
    field("/contact/area", "R", Positive,
        "tributary area on side a, the integral of the point's weight [m, in space m²], above 0; pressure is \
         force over area"),
    field("/contact/position", "R, d", Numbers,
        "undeformed position of the node that has the condition, `node_a` or `node_b` [m]"),
    field("/contact/force_point", "R, d", Numbers,
        "where the force on side a acts [m], Σ weight · position over its nodes of side a: the \
         report's moments follow from it"),
    field("/contact/normal", "R, d", UnitVectors, "unit vector, outward of side a"),
    field("/contact/node_a", "R", Integers,
        "name (`GlobalNodeId`) of the node on side a, −1 for mortar whose nodes of side b have the conditions"),
    field("/contact/node_b", "R", Integers,
        "the same on side b; −1 for an obstacle, which has none, and for mortar whose nodes of side a have \
         the conditions"),
    field("/contact/entry_subdomain", "E", Indices("subdomain", 'N'),
        "subdomain of the entry; one of the point's group"),
    field("/contact/entry_offset", "R + 1", Offsets('E'),
        "entries of each contact point, at least one"),
    field("/contact/entry_node", "E", Integers, "node, counted within that subdomain"),
    field("/contact/entry_weight", "E", Numbers,
        "weight w of the node's displacement: w n is its coefficient"),
    optional("/contact/law", "R", Codes("law", 4),
        "law of the point: 0 without friction; 1 Tresca friction, bounded by `shear_bound`, closed or open; 2 Coulomb \
         friction, bounded by `friction` times the normal force and by `shear_bound` as cohesion, where it is closed; 3 \
         a tie, whose jump is 0 along the normal and the tangents, whatever the gap, and whose forces have no bound"),
    optional("/contact/tangent", "R, d", UnitVectors,
        "t₁, one of the unit vectors along which jumps and friction are measured, perpendicular to the normal n; in space the \
         other is n × t₁. Without it t₂ is the part of z perpendicular to n, of x where n is within 26° of z, and t₁ is t₂ × n"),
    optional("/contact/entry_axis", "E, d", Numbers,
        "of an equation, a point of law 3 in which every entry has a direction of its own, a unit vector: w times the displacement \
         along it, summed over the entries, is `gap`; zeros at the entries of other points"),
    optional("/contact/friction", "R", NotNegative,
        "coefficient of Coulomb friction; 0 for other laws; with `law` and `shear_bound` or not at all"),
    optional("/contact/shear_bound", "R", NotNegative,
        "bound of the tangential force over `area` [Pa]; 0 where there is no friction"),
    optional("/contact/stiffness", "R, 2", NotNegative,
        "contact stiffness along the normal and along the tangents, `area` times the stiffness per area [N/m]; 0 where \
         the contact is rigid. Along the normal the sides overlap by force over stiffness, along the tangents sticking \
         points are displaced by it. An equation with a stiffness along the normal is a spring between points, whose \
         force is its multiplier"),
    optional("/contact/given_gap", "R", Codes("origin", 2),
        "1 where the scene gives `gap`, 0 where it is measured on the mesh, so that gaps of points with one displacement may \
         differ by the round-off of coordinates; without this dataset all are 0"),
    optional("/contact/absolute", "R", Codes("start", 2),
        "1 where `gap` is that of the undeformed bodies even if the contact is activated in a later load step, 0 where \
         it is relative to the position of the bodies then; without this dataset all are 0"),
    optional("/contact/motion", "R, L?, d", Numbers,
        "displacement of the obstacle that the point faces, in every load step [m]; of an equation the increment of its \
         value beyond `gap`, along the axis of its first entry; zeros at other points"),
    optional("/contact/preload", "R, L?", Numbers,
        "of the first point of a pretension the force that `/force` exerts across its cut, in every load step [N]; zeros \
         at other points. Points of a pretension are equations with `node_a` and `node_b`; entries 0 and 1 of the first \
         are a node of the cut on both sides. A point with `node_b` alone holds the shortening, and comes after these"),
    field("/probe/contact", "V", Indices("contact", 'Q'),
        "index of the contact whose sides the probe checks for penetration at a node without condition"),
    field("/probe/node", "V", Integers, "name (`GlobalNodeId`) of its node, on the side without conditions"),
    field("/probe/normal", "V, d", UnitVectors, "unit vector n, outward of its side"),
    field("/probe/gap", "V", Numbers, "gap along n [m]; n · Σ weight · u beyond it is penetration"),
    field("/probe/entry_offset", "V + 1", Offsets('H'), "entries of each probe, at least one"),
    field("/probe/entry_subdomain", "H", Indices("subdomain", 'N'), "subdomain of the entry"),
    field("/probe/entry_node", "H", Integers, "node, counted within that subdomain"),
    field("/probe/entry_weight", "H", Numbers, "weight of the node's displacement"),
    field("/tip/name", "A", Names, "names of crack tips, of which the report has the stress intensity factors"),
    field("/tip/node", "A", Integers, "name (`GlobalNodeId`) of the node at which both faces of the crack end"),
    field("/tip/body", "A", Indices("body", 'B'), "index of its body"),
    field("/tip/material", "A", Indices("material", 'M'), "index of the only material within the radius"),
    field("/tip/position", "A, d", Numbers, "undeformed position [m]"),
    field("/tip/direction", "A, d", UnitVectors, "unit vector along which the crack would grow straight on"),
    field("/tip/radius", "A", Positive,
        "radius of the evaluated disc around it [m], which contains only the straight faces of this crack"),
    field("/tip/facet_offset", "A + 1", Offsets('X'), "facets of the crack faces in each disc"),
    field("/tip/facet_face", "X", Codes("face", 2), "0 for the lower face, 1 for the upper one, to whose left of `direction` the body lies"),
    field("/tip/facet_node", "X, 3", Integers,
        "names of the facet's nodes: the end nearer to the tip, the other end, the node between them or −1"),
    field("/tip/facet_distance", "X, 3", NotNegative,
        "distances of these from the tip [m]; without a node between them the last one isn't used"),
    field("/quantity/name", "J", Names, "names of the requested quantities, all different"),
    field("/quantity/kind", "J", Codes("kind of quantity", 12),
        "0 displacement of a node, 1 mean stress of a body, 2 reaction, 3 force of a contact on side a, 4 its mean pressure, 5 its \
         largest pressure, 6 gap that is left at one of its points, 7 elastic energy, 8 K_I of a crack tip, 9 its K_II, 10 its J, 11 \
         moment of the forces of a contact on side a"),
    field("/quantity/direction", "J, d", Numbers,
        "direction of a reaction or a contact's force, in space axis of a moment; zeros for the sum of the normal forces, and for other kinds but \
         displacements, whose direction `/weight` has, too"),
    field("/quantity/point", "J, d", Numbers, "reference point of a moment [m]; zeros for other kinds"),
    field("/quantity/length", "J", NotNegative,
        "length over which a largest pressure is smoothed [m], 0 for that of a point; for forces of a contact (3, 4, 11) the area of \
         the nodes that both sides share, or that supports hold [m, in space m²]; 0 for other kinds"),
    field("/quantity/constant", "J, L?", Numbers,
        "constant added to the sum of weights times displacements, in every load step: the mean of the initial stress"),
    field("/quantity/node", "J", Integers, "name (`GlobalNodeId`) of the node of a displacement or a gap; −1 for other kinds"),
    field("/quantity/of_offset", "J + 1", Offsets('D'), "slices of `of`"),
    field("/quantity/of", "D", Integers,
        "by kind: 1 the materials of the body; 2 the conditions, indices into `/support/name`; 3 to 5 and 11 the contact, followed \
         by the places in it of the points beside such nodes (not 5); 6 the contact \
         and the point's place in it; 8 to 10 the crack tip; none for others"),
    field("/weight/offset", "N + 1", Offsets('w'), "slices of the datasets below"),
    field("/weight/quantity", "w", Indices("quantity", 'J'),
        "index of a quantity of kind 0 or 1, or of kind 2 for the nodes whose reactions count, in all subdomains \
         that have them; without any all nodes of its conditions count"),
    field("/weight/node", "w", Integers, "node, counted within the subdomain"),
    field("/weight/value", "w, d", Numbers,
        "factors of its displacement in the quantity; the parts of several subdomains add up"),
    field("/parameter/name", "O", Names, "names of parameters, with respect to which quantities have derivatives"),
    field("/parameter/kind", "O", Codes("kind of parameter", 5),
        "0 factor of a load, 1 Young's modulus or a factor to which the stiffness of materials is proportional, 2 \
         increment of the gap of a contact, 3 increment of the displacements that a condition prescribes along an axis, \
         4 coefficient of friction"),
    field("/parameter/value", "O", NumbersOrNan, "its value; NaN where it isn't the same everywhere"),
    field("/parameter/of_offset", "O + 1", Offsets('p'), "slices of `of`"),
    field("/parameter/of", "p", Integers,
        "by kind: 1 the materials; 2 and 4 the contact; 3 the condition, an index into `/support/name`, and the axis, 0 to 2"),
    field("/load/offset", "N + 1", Offsets('f'), "slices of the datasets below"),
    field("/load/parameter", "f", Indices("parameter", 'O'), "index of a parameter of kind 0"),
    field("/load/node", "f", Integers, "node, counted within the subdomain"),
    field("/load/force", "f, L?, d", Numbers,
        "nodal force of that load alone [N], in every load step; it is a part of `/force`"),
    optional("/warnings", "W", Lines, "repeated in the solver's report"),
];

const fn attribute(group: &'static str, name: &'static str, value: &'static str) -> Attribute {
    Attribute { group, name, value }
}

const fn field(
    path: &'static str,
    shape: &'static str,
    kind: Kind,
    meaning: &'static str,
) -> Field {
    Field {
        path,
        shape,
        kind,
        optional: false,
        meaning,
    }
}

const fn optional(
    path: &'static str,
    shape: &'static str,
    kind: Kind,
    meaning: &'static str,
) -> Field {
    Field {
        optional: true,
        ..field(path, shape, kind, meaning)
    }
}

impl Field {
    /// Its group.
    pub fn group(&self) -> &'static str {
        match self.path.rsplit_once('/') {
            Some((group, _)) if !group.is_empty() => group,
            _ => "/",
        }
    }
}

/// All groups, parents first.
pub fn groups() -> Vec<&'static str> {
    let mut groups = vec!["/", "/settings"];
    let parents = FIELDS.iter().map(Field::group).chain(FREE);
    for group in parents {
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    groups.sort_unstable();
    groups
}

/// The names allowed in a group.
pub fn names_in(group: &str) -> Vec<&'static str> {
    let mut names = Vec::new();
    let paths = FIELDS.iter().map(|field| field.path).chain(groups());
    let inside = paths.filter_map(|path| path.strip_prefix(group.trim_end_matches('/')));
    for rest in inside {
        let name = rest
            .trim_start_matches('/')
            .split('/')
            .next()
            .unwrap_or_default();
        if rest.starts_with('/') && !name.is_empty() && !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// The attributes of a group.
pub fn attributes_of(group: &str) -> impl Iterator<Item = &'static Attribute> {
    (ATTRIBUTES.iter()).filter(move |attribute| attribute.group == group)
}

/// The noun that a letter counts.
pub fn noun(letter: char) -> &'static str {
    let known = LETTERS.iter().find(|&&(known, _)| known == letter);
    let noun = known.map_or("", |&(_, noun)| noun);
    noun.split(',').next().unwrap_or_default()
}
