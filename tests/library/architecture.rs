//! Layers: the imports of modules, checked against ARCHITECTURE.md.

mod functions;
mod imports;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use self::functions::functions;
use self::imports::{Imports, Module};

/// The crates: their folder of files, their name in paths.
const CRATES: [(&str, &str); 2] = [
    ("partition/src", "contact_dd_partition"),
    ("src", "contact_dd_mpi"),
];

/// Largest number of layers of folders; a folder is one layer above the highest that it imports.
const MOST_FLOORS: usize = 9;

/// Numbers of lines and of arguments above which a function is large, each with the largest number of such functions.
const MANY_LINES: (usize, usize) = (60, 10);
const MANY_ARGUMENTS: (usize, usize) = (6, 5);

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn imports_of((src, name): (&str, &str)) -> Imports {
    let imports = Imports::new(&root().join(src), name);
    assert!(imports.of.len() > 50, "{} files", imports.of.len());
    imports
}

/// The module at the top of the crate that a module belongs to.
fn room(module: &Module) -> &str {
    &module[0]
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
    for of_crate in CRATES {
        let src = of_crate.0;
        let order = order(src);
        let place = |module: &str| order.iter().position(|name| name == module);
        for (module, others) in imports_of(of_crate).of {
            if ["main", "lib"].contains(&room(&module)) {
                continue;
            }
            let at = module.join("/");
            let Some(own) = place(room(&module)) else {
                panic!("{src}/{at}.rs: the order in ARCHITECTURE.md lacks its module");
            };
            for import in others {
                let Some(other) = place(room(&import)) else {
                    continue;
                };
                assert!(
                    other <= own,
                    "{src}/{at}.rs imports {}, which comes after it",
                    import.join("::")
                );
            }
        }
    }
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    for of_crate in CRATES {
        let imports = imports_of(of_crate).of;
        let floors = Imports::floors(&imports);
        let Some(above) = imports.keys().find(|module| !floors.contains_key(*module)) else {
            continue;
        };
        // From a module above a cycle down the imports until one recurs.
        let mut way = vec![above];
        let circle = loop {
            let below =
                |other: &&Module| !floors.contains_key(*other) && imports.contains_key(*other);
            let next = imports[way[way.len() - 1]].iter().find(below).unwrap();
            if let Some(first) = way.iter().position(|module| *module == next) {
                break way.split_off(first);
            }
            way.push(next);
        };
        let names: Vec<String> = circle.iter().map(|module| module.join("/")).collect();
        panic!(
            "{}: {} import each other in a circle",
            of_crate.0,
            names.join(" → ")
        );
    }
}

#[test]
fn the_house_has_few_floors() {
    for of_crate in CRATES {
        let mut rooms: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (module, others) in imports_of(of_crate).of {
            let own = rooms.entry(room(&module).to_owned()).or_default();
            let others = others
                .iter()
                .map(room)
                .filter(|other| *other != room(&module));
            own.extend(others.map(str::to_owned));
        }
        let floors = Imports::floors(&rooms);
        assert_eq!(
            floors.len(),
            rooms.len(),
            "{}: circles of rooms",
            of_crate.0
        );
        let most = floors.values().max().unwrap();
        assert!(
            *most <= MOST_FLOORS,
            "{}: {most} floors, {floors:?}",
            of_crate.0
        );
    }
}

#[test]
fn few_functions_are_long_or_have_many_arguments() {
    let (mut long, mut wide) = (Vec::new(), Vec::new());
    for of_crate in CRATES {
        for (module, code) in imports_of(of_crate).code {
            let at = format!("{}/{}", of_crate.0, module.join("/"));
            for function in functions(&code) {
                let name = format!("{at}: {}", function.name);
                if function.lines > MANY_LINES.0 {
                    long.push(format!("{name} has {} lines", function.lines));
                }
                if function.arguments > MANY_ARGUMENTS.0 {
                    wide.push(format!("{name} has {} arguments", function.arguments));
                }
            }
        }
    }
    assert!(long.len() <= MANY_LINES.1, "{long:#?}");
    assert!(wide.len() <= MANY_ARGUMENTS.1, "{wide:#?}");
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
        for of_crate in CRATES {
            for (module, code) in imports_of(of_crate).code {
                let uses = ["use ", " ", "(", "<", "&"]
                    .iter()
                    .any(|before| code.contains(&format!("{before}{library}::")));
                if uses {
                    importers += 1;
                    let own = format!("{}/{}", of_crate.0, room(&module));
                    assert!(
                        homes.contains(&&own[..]),
                        "{}.rs imports {library}",
                        module.join("/")
                    );
                }
            }
        }
        assert_eq!(
            importers == 0,
            homes.is_empty(),
            "no file imports {library}"
        );
    }
}
