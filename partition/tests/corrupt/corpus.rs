//! Invalid files that were once accepted or caused a crash: each is refused with the text after `expected:` in it.

use std::fs;
use std::path::Path;

use super::{SCENE, partition};

const MESH: &[u8] = include_bytes!("../library/gmsh/files/version2.2-ascii.msh");

#[test]
fn what_once_went_wrong_is_refused_in_words() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corrupt/corpus");
    let mut count = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path
            .file_name()
            .unwrap()
            .to_str()
            .unwrap()
            .starts_with("good")
        {
            continue;
        }
        let bytes = fs::read(&path).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let (_, expected) = text.split_once("expected: ").unwrap();
        let words = expected.lines().next().unwrap();
        let result = match path.extension().unwrap().to_str() {
            Some("toml") => partition(&text, MESH),
            _ => partition(SCENE, &bytes),
        };
        let message = match result {
            Ok(()) => panic!("{}: taken for good", path.display()),
            Err(error) => error.to_string(),
        };
        assert!(message.contains(words), "{}: {message}", path.display());
        count += 1;
    }
    assert!(count >= 14, "{count} files");
}
