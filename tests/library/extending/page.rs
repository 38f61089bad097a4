//! The page that tells how.

use std::fs;
use std::path::Path;

/// What docs/extending.md shows stands in these files, but for white space.
#[test]
fn the_page_shows_what_is_tested() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &str| fs::read_to_string(root.join(path)).unwrap();
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let tested: String = ["quad6", "layer", "sweep_method"]
        .map(|file| plain(&read(&format!("tests/library/extending/{file}.rs"))))
        .concat();
    let page = read("docs/extending.md");
    let blocks: Vec<&str> = (page.split("```rust").skip(1))
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    assert!(blocks.len() >= 3, "{}", blocks.len());
    for block in blocks {
        assert!(tested.contains(&plain(block)), "isn't tested:{block}");
    }
}
