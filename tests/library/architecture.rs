//! Data flows one way: who imports whom, checked against what ARCHITECTURE.md says.

use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A source file and its path below `src` of its crate.
struct Source {
    below: PathBuf,
    /// Its text without comments.
    code: String,
}

impl Source {
    /// The module at the top of the crate that it belongs to.
    fn module(&self) -> &str {
        let first = self.below.iter().next().unwrap().to_str().unwrap();
        first.trim_end_matches(".rs")
    }

    /// The modules of its crate that it names: `crate::name`, `crate::{name, …}`, and by as many
    /// `super` as lead there.
    fn imports(&self) -> Vec<&str> {
        let up = "super::".repeat(self.below.iter().count());
        let paths = ["crate::", &up].map(|path| self.code.split(path).skip(1));
        let mut names = Vec::new();
        for rest in paths.into_iter().flatten() {
            match rest.strip_prefix('{') {
                None => names.push(word(rest)),
                Some(group) => {
                    let mut depth = 0;
                    let group = group.split(|c| {
                        depth += i32::from(c == '{') - i32::from(c == '}');
                        depth == 0 && c == ','
                    });
                    names.extend(group.map(|name| word(name.trim())));
                }
            }
        }
        names
    }
}

/// The identifier that `text` begins with.
fn word(text: &str) -> &str {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_');
    &text[..end.unwrap_or(text.len())]
}

/// The files of a crate's library.
fn sources(src: &str) -> Vec<Source> {
    let top = root().join(src);
    let (mut folders, mut found) = (vec![top.clone()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if path.extension().is_none_or(|ending| ending != "rs") {
                continue;
            }
            let text = fs::read_to_string(&path).unwrap();
            let lines = text.lines();
            let code = lines.map(|line| line.split("//").next().unwrap_or_default());
            found.push(Source {
                below: path.strip_prefix(&top).unwrap().to_path_buf(),
                code: code.collect::<Vec<_>>().join("\n"),
            });
        }
    }
    assert!(found.len() > 50, "{} files", found.len());
    found
}

/// The order of modules that ARCHITECTURE.md gives for a crate, on lines that begin with `src`.
fn order(src: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    let lines = text.lines();
    let start = format!("    {src}:");
    let named = lines
        .skip_while(|line| !line.starts_with(&start))
        .take_while(|line| line.starts_with("    "))
        .enumerate()
        .take_while(|(i, line)| *i == 0 || !line.trim().contains(':'));
    let words = named.flat_map(|(_, line)| line.trim_start_matches(&start).split_whitespace());
    let order: Vec<String> = words.map(String::from).collect();
    assert!(order.len() > 5, "{src}: {order:?}");
    order
}

#[test]
fn a_module_imports_only_those_before_it() {
    for src in ["partition/src", "src"] {
        let order = order(src);
        let place = |module: &str| order.iter().position(|name| name == module);
        for source in sources(src) {
            if ["main", "lib"].contains(&source.module()) {
                continue;
            }
            let at = source.below.display();
            let Some(own) = place(source.module()) else {
                panic!("{src}/{at}: the order in ARCHITECTURE.md lacks its module");
            };
            for import in source.imports() {
                let Some(other) = place(import) else { continue };
                assert!(
                    other <= own,
                    "{src}/{at} imports {import}, which comes after it"
                );
            }
        }
    }
}

#[test]
fn a_foreign_library_has_one_importer() {
    for (library, homes) in [
        ("mpi", &["src/comm"][..]),
        ("hdf5", &["src/output", "partition/src/problem"]),
        ("metis", &["partition/src/decompose"]),
        ("faer::sparse", &[]),
    ] {
        let mut importers = 0;
        for src in ["partition/src", "src"] {
            for source in sources(src) {
                let uses = ["use ", " ", "(", "<", "&"]
                    .iter()
                    .any(|before| source.code.contains(&format!("{before}{library}::")));
                if uses {
                    importers += 1;
                    let module = format!("{src}/{}", source.module());
                    let at = source.below.display();
                    assert!(homes.contains(&&module[..]), "{src}/{at} imports {library}");
                }
            }
        }
        assert_eq!(importers == 0, homes.is_empty(), "nobody imports {library}");
    }
}
