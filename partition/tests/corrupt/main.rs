//! Randomly damaged scenes and meshes: the result is an error message or a readable problem file, never a panic or an
//! allocation much larger than the file needs.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test that can't go on has failed"
)]

mod corpus;
mod mesh;
mod scene;
mod solid;
#[path = "../library/table.rs"]
mod table;

use std::sync::Once;

use contact_dd_partition::decompose::Decomposition;
use contact_dd_partition::error::InputError;
use contact_dd_partition::mesh::gmsh;
use contact_dd_partition::model::Model;
use contact_dd_partition::problem::Problem;
use contact_dd_partition::problem::read::ProblemFile;
use contact_dd_partition::scene::Scene;
use proptest::prelude::*;
use proptest::sample::Index;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

/// A scene of the meshes in `../library/gmsh/files`.
const SCENE: &str = include_str!("corpus/good.toml");

/// Limit of memory: far above the need of the small meshes, below the sizes that a damaged file may claim (bytes).
const MEMORY: u64 = 16 << 30;

/// A number of cases; failing ones are added to the corpus by hand.
fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(count)
    }
}

/// Limits the memory, so that excessive allocations fail.
fn limit_memory() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let limit = Rlimit {
            current: Some(MEMORY),
            ..getrlimit(Resource::As)
        };
        setrlimit(Resource::As, limit).unwrap();
    });
}

/// The whole path from scene and mesh to a problem file, which is read back.
fn partition(scene: &str, mesh: &[u8]) -> Result<(), InputError> {
    limit_memory();
    let scene = Scene::parse(scene)?;
    let model = Model::new(&scene, gmsh::parse(mesh)?)?;
    let decomposition = Decomposition::new(&model, None)?;
    let problem = Problem::new(&model, &decomposition)?;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("problem.h5");
    problem.write(&path).unwrap();
    let read = ProblemFile::open(&path).and_then(|file| file.problem());
    read.unwrap_or_else(|error| panic!("made a problem file that can't be read: {error}"));
    Ok(())
}

/// Fails unless an error is a message without control characters.
fn is_said(error: &InputError) -> Result<(), TestCaseError> {
    let message = error.to_string();
    prop_assert!(
        message.len() > 10 && !message.contains(|c: char| c.is_control() && c != '\n'),
        "{message}"
    );
    Ok(())
}

/// A change that damages a text.
#[derive(Clone, Debug)]
enum Break {
    DropLine(Index),
    DoubleLine(Index),
    SwapLines(Index, Index),
    /// A word becomes another one of the text.
    SwapWords(Index, Index),
    /// A word becomes one of [`WORDS`].
    Replace(Index, Index),
    Insert(Index, Index),
    Cut(Index),
    Flip(Index, u8),
}

/// Texts that break readers.
const WORDS: [&str; 36] = [
    "",
    "0",
    "-1",
    "1",
    "2",
    "3",
    "7",
    "1e300",
    "-1e300",
    "1e-300",
    "nan",
    "inf",
    "1.5",
    "4611686018427387904",
    "-9223372036854775808",
    "99999999999999999999",
    "2147483648",
    "x",
    "\"x\"",
    "'1/x'",
    "[]",
    "[",
    "]",
    "{",
    "}",
    "=",
    "\"",
    "#",
    "$",
    "$EndNodes",
    "$Elements",
    "\"../x\"",
    "\u{0}",
    "\u{202e}",
    "é",
    "\n",
];

fn breaks() -> impl Strategy<Value = Vec<Break>> {
    let index = any::<Index>;
    let one = prop_oneof![
        1 => index().prop_map(Break::DropLine),
        1 => index().prop_map(Break::DoubleLine),
        1 => (index(), index()).prop_map(|(a, b)| Break::SwapLines(a, b)),
        3 => (index(), index()).prop_map(|(a, b)| Break::SwapWords(a, b)),
        4 => (index(), index()).prop_map(|(a, b)| Break::Replace(a, b)),
        1 => (index(), index()).prop_map(|(a, b)| Break::Insert(a, b)),
        1 => index().prop_map(Break::Cut),
        2 => (index(), any::<u8>()).prop_map(|(a, mask)| Break::Flip(a, mask)),
    ];
    prop::collection::vec(one, 1..4)
}

/// The bytes of a file after all steps.
fn broken(bytes: &[u8], breaks: &[Break]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for step in breaks {
        if bytes.is_empty() {
            break;
        }
        step.apply(&mut bytes);
    }
    bytes
}

impl Break {
    fn apply(&self, bytes: &mut Vec<u8>) {
        let mut lines: Vec<Vec<u8>> = bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
        let words = words(bytes);
        let replace = |bytes: &mut Vec<u8>, at: &Index, by: &[u8]| {
            if !words.is_empty() {
                bytes.splice(words[at.index(words.len())].clone(), by.iter().copied());
            }
        };
        match self {
            Self::DropLine(at) => drop(lines.remove(at.index(lines.len()))),
            Self::DoubleLine(at) => {
                let at = at.index(lines.len());
                lines.insert(at, lines[at].clone());
            }
            Self::SwapLines(a, b) => {
                let (a, b) = (a.index(lines.len()), b.index(lines.len()));
                lines.swap(a, b);
            }
            Self::SwapWords(a, b) if !words.is_empty() => {
                let by = bytes[words[b.index(words.len())].clone()].to_vec();
                return replace(bytes, a, &by);
            }
            Self::SwapWords(..) => return,
            Self::Replace(a, b) => {
                return replace(bytes, a, WORDS[b.index(WORDS.len())].as_bytes());
            }
            Self::Insert(a, b) => {
                let at = a.index(bytes.len());
                bytes.splice(at..at, WORDS[b.index(WORDS.len())].bytes());
                return;
            }
            Self::Cut(at) => return bytes.truncate(at.index(bytes.len())),
            Self::Flip(at, mask) => {
                let at = at.index(bytes.len());
                bytes[at] ^= mask;
                return;
            }
        }
        *bytes = lines.join(&b'\n');
    }
}

/// Places of the words of a text.
fn words(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let mut words = Vec::new();
    let mut start = 0;
    for (at, byte) in bytes.iter().chain(b" ").enumerate() {
        if byte.is_ascii_whitespace() {
            if at > start {
                words.push(start..at);
            }
            start = at + 1;
        }
    }
    words
}
