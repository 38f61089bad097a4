//! The crack tips.

use super::contents::Contents;
use crate::crack_tip::{CrackTip, FaceFacet};
use crate::error::InputError;

/// Reads all crack tips.
pub(super) fn read(contents: &Contents) -> Result<Vec<CrackTip>, InputError> {
    let rows = 0..contents.count('A');
    if rows.is_empty() {
        return Ok(Vec::new());
    }
    let names = contents.strings("/tip/name")?;
    let tag = contents.integers("/tip/node", rows.clone())?;
    let body = contents.integers("/tip/body", rows.clone())?;
    let material = contents.integers("/tip/material", rows.clone())?;
    let vectors = |path: &str| -> Result<Vec<[f64; 3]>, InputError> {
        Ok(contents.numbers(path, rows.clone())?.vectors(rows.clone()))
    };
    let (position, direction) = (vectors("/tip/position")?, vectors("/tip/direction")?);
    let radius = contents.numbers("/tip/radius", rows)?;
    let all = 0..contents.count('X');
    let face = contents.integers("/tip/facet_face", all.clone())?;
    let node = contents.integers("/tip/facet_node", all.clone())?;
    let distance = contents.numbers("/tip/facet_distance", all)?;
    let (nodes, _) = node.all().as_chunks::<3>();
    let (distances, _) = distance.all().as_chunks::<3>();
    let facet = |row: usize| {
        let [near, far, _] = distances[row];
        match near < far {
            true => Ok(FaceFacet {
                is_upper: face.all()[row] == 1,
                nodes: nodes[row],
                distances: distances[row],
            }),
            false => {
                let what = format!("{near} comes before {far}; expected distances that rise");
                Err(distance.error(row, &what))
            }
        }
    };
    let tips = names.into_iter().enumerate().map(|(row, name)| {
        Ok(CrackTip {
            name,
            tag: tag.all()[row],
            body: body.all()[row] as u32,
            material: material.all()[row] as u32,
            position: position[row],
            direction: direction[row],
            radius: radius.all()[row],
            facets: contents
                .rows('X', row)
                .map(facet)
                .collect::<Result<_, _>>()?,
        })
    });
    tips.collect()
}
