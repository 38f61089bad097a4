//! The sections of MSH 2.2.
//!
//! An element in several physical groups is listed once for each.

use super::content::{Content, groups};
use super::cursor::{Cursor, Encoding, shown};
use super::element_type;
use crate::element::ElementKind;
use crate::error::InputError;

/// Reads the body of `$Nodes` or `$ParametricNodes`.
pub(super) fn nodes(
    cursor: &mut Cursor,
    content: &mut Content,
    parametric: bool,
) -> Result<(), InputError> {
    let count = count_line(cursor, "the number of nodes", 4)?;
    content.nodes.reserve(count);
    for _ in 0..count {
        let tag = cursor.int("a node tag")?;
        let point = cursor.point()?;
        content.nodes.push(cursor, tag, point)?;
        if parametric {
            skip_parameters(cursor)?;
        }
    }
    Ok(())
}

/// Skips the entity of a node and its parametric coordinates: one on a curve, two on a surface.
fn skip_parameters(cursor: &mut Cursor) -> Result<(), InputError> {
    if cursor.encoding() == Encoding::Ascii {
        cursor.skip_line();
        return Ok(());
    }
    let parameters = match cursor.int("the dimension of an entity")? {
        dim @ 0..=2 => dim,
        dim => {
            return Err(cursor.error(format!(
                "parametric nodes on an entity of dimension {dim} aren't supported"
            )));
        }
    };
    cursor.int("the tag of an entity")?;
    for _ in 0..parameters {
        cursor.real("a parametric coordinate")?;
    }
    Ok(())
}

/// Reads the body of `$Elements`.
pub(super) fn elements(cursor: &mut Cursor, content: &mut Content) -> Result<(), InputError> {
    let count = count_line(cursor, "the number of elements", 2)?;
    match cursor.encoding() {
        Encoding::Ascii => {
            for _ in 0..count {
                let tag = cursor.int("an element tag")?;
                let code = cursor.int("an element type")?;
                let kind = element_type::kind(tag, code).map_err(|why| cursor.error(why))?;
                let tags = cursor.int_count("the number of tags of an element", 1)?;
                element(cursor, content, tag, kind, tags)?;
            }
        }
        Encoding::Binary { .. } => {
            let mut found = 0;
            while found < count {
                let code = cursor.int("an element type")?;
                let follow = cursor.int_count("the number of elements of a block", 2)?;
                let tags = cursor.int_count("the number of tags of an element", 1)?;
                if follow == 0 || follow > count - found {
                    return Err(cursor.error(format!(
                        "expected a block of 1 to {} elements, found {follow}",
                        count - found
                    )));
                }
                for _ in 0..follow {
                    let tag = cursor.int("an element tag")?;
                    let kind = element_type::kind(tag, code).map_err(|why| cursor.error(why))?;
                    element(cursor, content, tag, kind, tags)?;
                }
                found += follow;
            }
        }
    }
    Ok(())
}

/// Reads an element from its tags on: the first one is the physical group.
fn element(
    cursor: &mut Cursor,
    content: &mut Content,
    tag: i64,
    kind: ElementKind,
    tags: usize,
) -> Result<(), InputError> {
    let mut group = 0;
    for place in 0..tags {
        let value = cursor.int("a tag of an element")?;
        if place == 0 {
            group = value;
        }
    }
    let mut nodes = Vec::with_capacity(kind.nodes());
    for _ in 0..kind.nodes() {
        let node = cursor.int("a node tag")?;
        nodes.push(content.nodes.find(cursor, tag, node)?);
    }
    content.push(kind, &groups(vec![group]), tag, &nodes);
    Ok(())
}

/// Reads a count, which is a line of text even in binary files.
fn count_line(cursor: &mut Cursor, what: &str, values: usize) -> Result<usize, InputError> {
    let line = cursor.line(what)?;
    match line.parse() {
        Ok(count) => cursor.checked(what, count, values),
        Err(_) => Err(cursor.error(format!(
            "expected {what}, found `{}`",
            shown(line.as_bytes())
        ))),
    }
}
