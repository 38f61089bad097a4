//! Contact with rigid obstacles.

use super::contact::{conditions, stack};
use crate::close::close;
use crate::says::says;

#[test]
fn a_straight_obstacle_leaves_the_signed_distance_along_its_normal() {
    let blocks = stack(0.0).moved(|[x, y, z]| [x, y + 0.2 * x, z]);
    let text = "[[contact]]\nname = 't'\nsides = ['lower bottom']\nobstacle = {point = [0, -1], normal = [0, 4]}";
    let rows = conditions(&blocks, text).unwrap();
    assert_eq!(rows.len(), 5);
    for row in &rows {
        assert_eq!((row.tag_b, row.entries.len()), (-1, 1));
        assert_eq!(row.entries[0].1, 1.0);
        assert_eq!(row.frame.normal, [0.0, -1.0, 0.0]);
        close(row.gap, row.position[1] + 1.0, 1e-15);
    }
    close(
        rows.iter().map(|row| row.area).sum(),
        2.0 * 1.04_f64.sqrt(),
        1e-15,
    );
}

#[test]
fn a_circle_keeps_bodies_out_or_in() {
    let text = |side: &str, inside: bool| {
        format!(
            "[[contact]]\nname = 't'\nsides = ['lower {side}']\nobstacle = {{center = [1, -3], radius = 2, inside = {inside}}}"
        )
    };
    for (side, inside, sign) in [("bottom", false, 1.0), ("top", true, -1.0)] {
        let rows = conditions(&stack(0.0), &text(side, inside)).unwrap();
        assert_eq!(rows.len(), 5);
        for row in rows {
            let arm = [row.position[0] - 1.0, row.position[1] + 3.0];
            let far = arm[0].hypot(arm[1]);
            close(row.gap, sign * (far - 2.0), 1e-15);
            close(row.frame.normal[0], -sign * arm[0] / far, 1e-15);
            close(row.frame.normal[1], -sign * arm[1] / far, 1e-15);
            assert_eq!(row.entries[0].1, 1.0);
        }
    }
    let text = text("bottom", false).replace("[1, -3]", "[1, 0]");
    let error = conditions(&stack(0.0), &text).unwrap_err();
    says(&error, "contact 't': node … centre");
}

#[test]
fn only_nodes_that_face_an_obstacle_meet_it() {
    let outline = "['lower bottom', 'lower right', 'lower top', 'lower left']";
    let floor = |sides: &str| {
        let text = format!(
            "[[contact]]\nname = 't'\nsides = [{sides}]\nobstacle = {{point = [0, 0], normal = [0, 1]}}"
        );
        conditions(&stack(0.0), &text)
    };
    let rows = floor(outline).unwrap();
    assert_eq!(rows.len(), 5);
    assert!(rows.iter().all(|row| row.position[1] == 0.0));
    let error = floor("'lower top'").unwrap_err();
    says(&error, "no node of the side faces the obstacle");
}

#[test]
fn round_the_corner_of_an_outline_nothing_is_counted() {
    let text = "[[contact]]\nname = 't'\nsides = [['lower bottom', 'lower left', 'lower right']]\nobstacle = {point = [0, 0], normal = [0, 1]}";
    for blocks in [stack(0.0), stack(0.0).quadratic()] {
        let rows = conditions(&blocks, text).unwrap();
        let bottom: f64 = rows.iter().map(|row| row.area).sum();
        close(bottom, 2.0, 1e-14);
        assert!(rows.iter().all(|row| row.position[1] == 0.0));
    }
}
