//! Imports among the files of a crate: `use` and paths, through re-exports to where a name is defined.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// A module by the names that lead to it from the root of its crate, which is the empty one.
pub type Module = Vec<String>;

/// The imports of a crate, module by module; those of its tests are left out.
pub struct Imports {
    /// The modules that each names.
    pub of: BTreeMap<Module, BTreeSet<Module>>,
    /// The code of each, without comments and strings.
    pub code: BTreeMap<Module, String>,
}

/// The paths that a file names.
#[derive(Default)]
struct Paths {
    /// The imports: the name that a path has here, whether others may take it from here, and the path.
    imports: Vec<(String, bool, Module)>,
    /// The paths in its code.
    inline: Vec<Module>,
    /// Modules that are tests.
    tests: Vec<String>,
}

impl Imports {
    /// The imports of the crate called `name`, whose files lie in the folder `src`.
    pub fn new(src: &Path, name: &str) -> Self {
        let mut code = BTreeMap::new();
        let mut folders = vec![src.to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|ending| ending == "rs") {
                    let below = path.strip_prefix(src).unwrap().with_extension("");
                    let names = below.iter().map(|name| name.to_str().unwrap().to_owned());
                    let text = without_comments(&fs::read_to_string(&path).unwrap());
                    code.insert(names.collect::<Module>(), text);
                }
            }
        }
        let paths: BTreeMap<Module, Paths> = (code.iter())
            .map(|(module, code)| (module.clone(), Paths::new(code)))
            .collect();
        let of_tests: Vec<Module> = (paths.iter())
            .flat_map(|(module, of)| {
                of.tests
                    .iter()
                    .map(|test| [&module[..], std::slice::from_ref(test)].concat())
            })
            .collect();
        code.retain(|module, _| !of_tests.iter().any(|test| module.starts_with(test)));
        let resolve = |from: &Module, path: &Module| -> Option<Module> {
            let (mut from, mut path) = (from.clone(), path.clone());
            // A name may be handed on several times.
            for _ in 0..5 {
                let (module, rest) = walk(&code, &from, &path, name)?;
                let item = rest.first()?;
                let handed_on = (paths[&module].imports.iter())
                    .find(|(own, is_public, _)| own == item && *is_public);
                match handed_on {
                    Some((_, _, other)) => (from, path) = (module, [other, &rest[1..]].concat()),
                    None => return Some(module),
                }
            }
            None
        };
        let of = code.keys().map(|module| {
            let Paths {
                imports, inline, ..
            } = &paths[module];
            let own = imports.iter().filter(|(_, is_public, _)| !is_public);
            let own = own.map(|(_, _, path)| path.clone());
            // A path may begin with a module that was imported.
            let inline = inline.iter().map(|path| {
                let imported = imports.iter().find(|(name, ..)| *name == path[0]);
                imported.map_or(path.clone(), |(_, _, prefix)| [prefix, &path[1..]].concat())
            });
            let named = own.chain(inline).filter_map(|path| resolve(module, &path));
            let others = named.filter(|other| other != module);
            (module.clone(), others.collect())
        });
        Self {
            of: of.collect(),
            code: code.clone(),
        }
    }

    /// The layer of every node of a graph from 1, one above all of its successors; nodes in and above cycles have none.
    pub fn floors<T: Ord + Clone>(graph: &BTreeMap<T, BTreeSet<T>>) -> BTreeMap<T, usize> {
        let mut floors: BTreeMap<T, usize> = BTreeMap::new();
        loop {
            let on = |node: &T| Some(floors.get(node).copied());
            let floor = |others: &BTreeSet<T>| -> Option<usize> {
                let below = others.iter().filter(|other| graph.contains_key(other));
                let below = below
                    .map(|other| on(other).flatten())
                    .collect::<Option<Vec<_>>>()?;
                Some(1 + below.into_iter().max().unwrap_or(0))
            };
            let new: Vec<(T, usize)> = (graph.iter())
                .filter(|(node, _)| !floors.contains_key(node))
                .filter_map(|(node, others)| Some((node.clone(), floor(others)?)))
                .collect();
            if new.is_empty() {
                return floors;
            }
            floors.extend(new);
        }
    }
}

/// The module that a path leads to, and the remaining path; `None` outside the crate.
fn walk(
    code: &BTreeMap<Module, String>,
    from: &Module,
    path: &Module,
    name: &str,
) -> Option<(Module, Module)> {
    let is_root = |module: &Module| ["lib", "main"].contains(&&module.join("/")[..]);
    let mut at = if is_root(from) {
        Vec::new()
    } else {
        from.clone()
    };
    let mut rest = &path[..];
    match rest[0].as_str() {
        "crate" => (at, rest) = (Vec::new(), &rest[1..]),
        "self" => rest = &rest[1..],
        first if first == name => (at, rest) = (Vec::new(), &rest[1..]),
        "super" => {
            while rest.first().is_some_and(|word| word == "super") {
                at.pop();
                rest = &rest[1..];
            }
        }
        first if code.contains_key(&[&at[..], &[first.to_owned()]].concat()) => {}
        _ => return None,
    }
    while let Some(first) = rest.first() {
        let below = [&at[..], std::slice::from_ref(first)].concat();
        if !code.contains_key(&below) {
            break;
        }
        (at, rest) = (below, &rest[1..]);
    }
    code.contains_key(&at).then(|| (at, rest.to_vec()))
}

/// A text without comments and string literals.
fn without_comments(text: &str) -> String {
    let mut code = String::new();
    for line in text.lines() {
        let line = line.replace("'\"'", "' '").replace("\\\"", " ");
        let line = line.split("//").next().unwrap_or_default();
        let outside = line.split('"').step_by(2);
        code += &outside.collect::<Vec<_>>().join("\"\"");
        code.push('\n');
    }
    code
}

impl Paths {
    fn new(code: &str) -> Self {
        let words = words(code);
        let mut paths = Self::default();
        let mut at = 0;
        while at < words.len() {
            let rest = &words[at..];
            if rest.starts_with(&["#", "[", "cfg", "(", "test", ")", "]"]) {
                at += 7;
                let end = end_of_item(&words[at..]);
                if let Some(mod_at) = words[at..at + end].iter().position(|word| *word == "mod") {
                    paths.tests.push(words[at + mod_at + 1].to_owned());
                }
                at += end;
            } else if rest[0] == "use" {
                let end = rest.iter().position(|word| *word == ";").unwrap();
                let is_public = at > 0 && ["pub", ")"].contains(&words[at - 1]);
                let mut tree = Vec::new();
                expand(&rest[1..end], &[], &mut tree);
                paths
                    .imports
                    .extend(tree.into_iter().map(|(name, path)| (name, is_public, path)));
                at += end;
            } else if is_name(rest[0])
                && rest.get(1) == Some(&"::")
                && (at == 0 || words[at - 1] != "::")
            {
                let mut path = vec![rest[0].to_owned()];
                let pairs = rest[1..].chunks_exact(2);
                let names = pairs.take_while(|pair| pair[0] == "::" && is_name(pair[1]));
                path.extend(names.map(|pair| pair[1].to_owned()));
                at += 1;
                paths.inline.push(path);
            } else {
                at += 1;
            }
        }
        paths
    }
}

/// The end of an item: behind its semicolon or its braces.
fn end_of_item(words: &[&str]) -> usize {
    let mut depth = 0;
    for (at, word) in words.iter().enumerate() {
        match *word {
            "{" => depth += 1,
            "}" if depth == 1 => return at + 1,
            "}" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    words.len()
}

/// The paths of a tree of imports, each with the name that it has here.
fn expand(tree: &[&str], before: &[String], paths: &mut Vec<(String, Module)>) {
    let open = tree.iter().position(|word| *word == "{");
    let names = |words: &[&str]| -> Module {
        let names = words.iter().filter(|word| is_name(word) || **word == "*");
        names.map(|word| (*word).to_owned()).collect()
    };
    let Some(open) = open else {
        let alias = tree.iter().position(|word| *word == "as");
        let mut path = [before, &names(&tree[..alias.unwrap_or(tree.len())])].concat();
        if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
            path.pop();
        }
        let name = alias.map_or(path.last().cloned(), |alias| {
            Some(tree[alias + 1].to_owned())
        });
        paths.extend(name.map(|name| (name, path)));
        return;
    };
    let before = [before, &names(&tree[..open])].concat();
    let mut depth = 0;
    let branches = tree[open + 1..tree.len() - 1].split(|word| {
        depth += i32::from(*word == "{") - i32::from(*word == "}");
        depth == 0 && *word == ","
    });
    for branch in branches.filter(|branch| !branch.is_empty()) {
        expand(branch, &before, paths);
    }
}

/// Names, `::` and single characters.
fn words(code: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = code.trim_start();
    while let Some(first) = rest.chars().next() {
        let end = match first {
            _ if is_part(first) => rest.find(|c| !is_part(c)).unwrap_or(rest.len()),
            ':' if rest.starts_with("::") => 2,
            _ => first.len_utf8(),
        };
        words.push(&rest[..end]);
        rest = rest[end..].trim_start();
    }
    words
}

fn is_part(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn is_name(word: &str) -> bool {
    word.chars()
        .next()
        .is_some_and(|c| c.is_alphabetic() || c == '_')
}
