//! Links between the documents, and to files of the repository.

use std::path::{Component, Path, PathBuf};

use super::page::{Page, root};

/// A test: linked files and headings exist.
pub fn lead_somewhere(page: &Page, pages: &[Page]) {
    let wrong: Vec<String> = page
        .links
        .iter()
        .filter_map(|link| {
            let file = in_repository(page, &link.file);
            let place = format!("{}:{}", page.name, link.line);
            if !root().join(&file).exists() {
                return Some(format!("{place}: there is no {}", file.display()));
            }
            let anchor = link.anchor.as_ref()?;
            let target = pages.iter().find(|other| Path::new(&other.name) == file)?;
            let is_there = target
                .headings
                .iter()
                .any(|heading| anchor_of(heading) == *anchor);
            (!is_there).then(|| format!("{place}: {} has no heading #{anchor}", target.name))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The path of a link's target, relative to the root.
pub fn in_repository(page: &Page, file: &str) -> PathBuf {
    if file.is_empty() {
        return PathBuf::from(&page.name);
    }
    let mut path = Path::new(&page.name).parent().unwrap().to_path_buf();
    for component in Path::new(file).components() {
        match component {
            Component::ParentDir => assert!(path.pop(), "{}: {file} is outside", page.name),
            other => path.push(other),
        }
    }
    path
}

/// GitHub's anchor of a heading: lower case, blanks as hyphens, no other punctuation.
pub fn anchor_of(heading: &str) -> String {
    let kept = heading
        .trim()
        .chars()
        .filter(|c| c.is_alphanumeric() || "-_ ".contains(*c));
    kept.flat_map(char::to_lowercase)
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}
