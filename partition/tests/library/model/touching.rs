//! Contacts that are found wherever bodies touch.

mod places;

use std::collections::BTreeMap;

use contact_dd_partition::contact_point::{ContactPoint, Law};
use contact_dd_partition::example;
use contact_dd_partition::mesh::{Group, Mesh};
use contact_dd_partition::model::Model;
use contact_dd_partition::scene::Scene;

use super::contact::stack;
use crate::blocks::Blocks;
use crate::close::close;
use crate::says::says;

const ALL: &str = "[[contact]]\nname = 'joints'\nbetween = 'all'\n";

/// A condition, whichever of its sides is side a: the row of B by coordinate of node tags, gap, area and law.
type Row = (Vec<(i64, [f64; 3])>, [f64; 2], Law);

/// The constraints of all contacts of two sides, described independently of the order of the sides.
fn rows(model: &Model) -> Vec<Row> {
    let row = |point: &ContactPoint<u32>| {
        let mut entries: Vec<(i64, [f64; 3])> = (point.row())
            .map(|(node, row)| (model.mesh.node_tags[node as usize], row))
            .collect();
        entries.sort_by_key(|entry| entry.0);
        (entries, [point.gap, point.area], point.law)
    };
    let points = model.contacts.iter().flat_map(|contact| &contact.points);
    let mut rows: Vec<Row> = points.map(row).collect();
    rows.sort_by(|a, b| a.0.iter().map(|e| e.0).cmp(b.0.iter().map(|e| e.0)));
    rows
}

/// Fails unless two models have the same conditions.
#[track_caller]
fn are_same(found: &Model, explicit: &Model) {
    let (found, explicit) = (rows(found), rows(explicit));
    assert_eq!(found.len(), explicit.len());
    for (one, other) in found.iter().zip(&explicit) {
        assert_eq!(one.0.len(), other.0.len());
        for ((tag, row), (expected, vector)) in one.0.iter().zip(&other.0) {
            assert_eq!(tag, expected);
            (row.iter().zip(vector)).for_each(|(a, b)| close(*a, *b, 1e-12));
        }
        (one.1.iter().zip(other.1)).for_each(|(a, b)| close(*a, b, 1e-12));
        assert_eq!(one.2, other.2);
    }
}

fn names(model: &Model) -> Vec<&str> {
    model
        .contacts
        .iter()
        .map(|contact| contact.name.as_str())
        .collect()
}

/// A scene with one table for all contacts of two sides, which have these keys.
fn without_sides(scene: &str, keys: &str) -> String {
    let tables = scene.split("\n[[").enumerate();
    let kept =
        tables.filter(|(_, table)| !table.starts_with("contact") || table.contains("obstacle"));
    let kept: Vec<&str> = kept.map(|(_, table)| table).collect();
    format!("{}\n{ALL}{keys}", kept.join("\n[["))
}

#[test]
fn built_in_scenes_have_the_conditions_of_their_explicit_contacts() {
    for (name, keys, count) in [
        ("granite", "gap = 0", 2),
        ("junction", "gap = 0", 4),
        ("stack", "gap = 0", 2),
        ("wall", "gap = 0", 77),
        ("patch", "gap = 0", 1),
        ("crack", "gap = 0", 1),
        ("cube-crack", "gap = 0", 2),
        ("stack3d", "gap = 0", 2),
    ] {
        let example = example::find(name).unwrap();
        let mesh = example.mesh(0).unwrap();
        let model = |text: &str| Model::new(&Scene::parse(text).unwrap(), mesh.clone()).unwrap();
        let found = model(&without_sides(example.scene, keys));
        are_same(&found, &model(example.scene));
        assert_eq!(found.found.len(), count, "{name}: {:?}", found.found);
        assert_eq!(found.warnings, model(example.scene).warnings, "{name}");
    }
}

#[test]
fn a_found_contact_says_what_it_consists_of() {
    let stack = |gap: f64| stack(gap).model(ALL).unwrap();
    assert_eq!(
        stack(0.0).found,
        ["joints: 4 facets of 'lower' on 4 of 'upper', 2 m"]
    );
    assert_eq!(
        stack(0.01).found,
        ["joints: 4 facets of 'lower' on 4 of 'upper', 2 m, gap up to 0.01 m"]
    );
    assert_eq!(
        stack(-0.01).found,
        ["joints: 4 facets of 'lower' on 4 of 'upper', 2 m, overlap up to 0.01 m"]
    );
    let given = super::contact::stack(0.01).model(&format!("{ALL}gap = 0.5\nfriction = 0.3"));
    let given = given.unwrap();
    let point = &given.contacts[0].points[0];
    assert_eq!((point.gap, point.law), (0.5, Law::coulomb(0.3, 0.0)));
}

/// Blocks that don't match: one on two others, which touch each other.
fn uneven() -> Blocks {
    Blocks::new()
        .block("left", [0.0, 1.0], [0.0, 1.0], [3, 2])
        .block("right", [1.0, 2.5], [0.0, 0.9], [5, 4])
        .block("upper", [0.5, 0.95], [1.0, 2.0], [4, 2])
        .moved(|[x, y, z]| [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y, z])
}

#[test]
fn sides_that_do_not_match_have_the_conditions_of_their_explicit_contacts() {
    let explicit = "[[contact]]\nname = 'b'\nsides = ['left top', 'upper bottom']
        [[contact]]\nname = 'h'\nsides = ['left right', 'right left']\n";
    for blocks in [uneven(), uneven().quadratic()] {
        // Like those of a contact found automatically, which has no facets beyond the touching part on side a.
        let found = blocks.model(ALL).unwrap();
        assert_eq!(names(&found), ["joints left-right", "joints left-upper"]);
        are_same(&found, &blocks.model(explicit).unwrap());
        let again = blocks.disguised().model(ALL).unwrap();
        assert_eq!((names(&found), &found.found), (names(&again), &again.found));
        are_same(&found, &again);
    }
}

/// The group that holds the members of all groups of cells.
fn as_one_body(mut mesh: Mesh) -> Mesh {
    let cells = mesh.cells.len() as u32;
    mesh.groups.retain(|_, group| group.dim != mesh.dim);
    let members = (0..cells).collect();
    let dim = mesh.dim;
    mesh.groups.insert("rock".into(), Group { dim, members });
    mesh
}

/// Rock cut by joints into blocks, and the scene with an explicit contact for every joint.
fn joints() -> (Blocks, String) {
    let mut blocks = Blocks::new();
    let mut text = String::new();
    let (columns, rows) = (4, 3);
    for j in 0..rows {
        for i in 0..columns {
            let [x, y] = [i, j].map(f64::from);
            blocks = blocks.block(&format!("{i}{j}"), [x, x + 1.0], [y, y + 1.0], [3, 2]);
            let mut contact = |name: &str, other: String, sides: [&str; 2]| {
                text += &format!(
                    "[[contact]]\nname = '{name}{i}{j}'\nsides = ['{i}{j} {}', '{other} {}']\nfriction = 0.4\n",
                    sides[0], sides[1]
                );
            };
            if i + 1 < columns {
                contact("v", format!("{}{j}", i + 1), ["right", "left"]);
            }
            if j + 1 < rows {
                contact("h", format!("{i}{}", j + 1), ["top", "bottom"]);
            }
        }
    }
    let moved = |[x, y, z]: [f64; 3]| [x + 0.1 * (2.0 * y).sin(), y + 0.2 * x + 0.05 * x * y, z];
    (blocks.moved(moved), text)
}

#[test]
fn a_network_of_joints_needs_one_table() {
    let (blocks, explicit) = joints();
    let table = format!("{ALL}friction = 0.4");
    let explicit = blocks.model(&explicit).unwrap();
    let found = blocks.model(&table).unwrap();
    assert_eq!(found.contacts.len(), 17);
    are_same(&found, &explicit);
    // The same of one body, which consists of twelve pieces.
    let rock = Blocks {
        mesh: as_one_body(blocks.mesh),
    };
    for table in [table.clone(), table.replace("'all'", "'rock'")] {
        let found = rock.model(&table).unwrap();
        assert_eq!(found.contacts.len(), 17);
        assert_eq!(names(&found)[..2], ["joints rock 1", "joints rock 2"]);
        are_same(&found, &explicit);
        let again = rock.disguised().model(&table).unwrap();
        assert_eq!(found.found, again.found);
    }
}

#[test]
fn tables_take_what_the_ones_before_have_left() {
    let (blocks, _) = joints();
    let table = |bodies: &str, friction: &str| {
        ALL.replace("'all'", bodies)
            .replace("joints", &format!("mu {friction}"))
            + &format!("friction = {friction}\n")
    };
    let text = table("['00', '01', '10']", "0.1") + &table("'all'", "0.2");
    let model = blocks.model(&text).unwrap();
    let laws: BTreeMap<&str, Law> = (model.contacts.iter())
        .map(|contact| (contact.name.as_str(), contact.points[0].law))
        .collect();
    assert_eq!(laws.len(), 17);
    for (name, law) in laws {
        let between = ["00-01", "00-10"].iter().any(|pair| name.ends_with(pair));
        assert_eq!(
            law,
            Law::coulomb(if between { 0.1 } else { 0.2 }, 0.0),
            "{name}"
        );
    }
}

#[test]
fn contacts_of_the_scene_come_first() {
    let explicit =
        "[[contact]]\nname = 'given'\nsides = ['upper bottom', 'left top']\ngap = 0.25\n";
    let blocks = uneven();
    let model = blocks.model(&format!("{explicit}{ALL}")).unwrap();
    assert_eq!(names(&model), ["given", "joints"]);
    assert!(
        model.contacts[0]
            .points
            .iter()
            .all(|point| point.gap == 0.25)
    );
    says(&model.found[0], "'left' on … of 'right'");
    let only = ALL.replace("'all'", "['left', 'upper']");
    let model = blocks.model(&format!("{explicit}{only}")).unwrap();
    assert_eq!(names(&model), ["given"]);
    says(
        &model.warnings[0],
        "contact 'joints': no new contacts found",
    );
}
