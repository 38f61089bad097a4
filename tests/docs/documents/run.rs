//! Runs a page like a reader, block by block, in a separate folder.

use std::env;
use std::ffi::OsString;
use std::fmt::Write as _;
use std::fs;
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Once;
use std::time::Duration;

use tempfile::TempDir;

use super::block::Action;
use super::page::{Page, root};
use super::printed::is_shown;
use crate::process::{Ended, Running};

/// Time limit above that of any block on a busy machine.
const LIMIT: Duration = Duration::from_secs(180);

/// Time limit above that of building the programs.
const BUILD_LIMIT: Duration = Duration::from_secs(1800);

/// Files of the repository available to the commands.
const CHECKOUT: [&str; 3] = ["scripts", "docs", "hostfile.example"];

/// The documents' Python, if available.
pub fn python() -> Option<PathBuf> {
    let named = env::var_os("DOCUMENTS_PYTHON").filter(|name| !name.is_empty())?;
    Some(PathBuf::from(named))
}

/// The folder with both programs. Cargo builds the programs of the other package only along with its tests, so that one
/// of these is built, with the features of all tests; if all tests are run, everything exists already.
pub fn programs() -> &'static Path {
    static BUILT: Once = Once::new();
    let folder = Path::new(env!("CARGO_BIN_EXE_contact-dd-mpi"))
        .parent()
        .unwrap();
    BUILT.call_once(|| {
        let profile = match folder.file_name().and_then(|name| name.to_str()) {
            Some("debug") | None => "dev",
            Some(profile) => profile,
        };
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["test", "--workspace", "--no-run", "--test", "library"]);
        cargo.args(["--profile", profile]);
        let ended = Running::start(cargo.current_dir(root())).wait(BUILD_LIMIT);
        assert_eq!(ended.code(), 0, "{}", ended.stderr);
        let partition = folder.join("contact-dd-partition");
        assert!(partition.exists(), "{} is missing", partition.display());
    });
    folder
}

/// A test: every block of the page is treated as it requests. Returns the folder with the results.
pub fn as_printed(page: &Page) -> Folder {
    let folder = Folder::new();
    let mut printed = String::new();
    for block in &page.blocks {
        let place = format!("{}:{}", page.name, block.line);
        let action = block
            .action()
            .unwrap_or_else(|why| panic!("{place}: {why}"));
        match action {
            Action::Skip(_) | Action::Read => {}
            Action::Write(name) => folder.write(name, &block.text),
            Action::Compare => assert!(
                is_shown(&block.text, &printed),
                "{place}: shown:\n{}\nprinted:\n{printed}",
                block.text
            ),
            Action::Script => printed = folder.script(&place, &block.text),
            Action::Session => folder
                .session(&block.text)
                .unwrap_or_else(|why| panic!("{place}: {why}")),
            Action::Python => {
                let python = python().expect("pages that need Python are ignored without it");
                let mut command = Command::new(python);
                printed = succeeded(&place, folder.run(command.arg("-c").arg(&block.text)));
            }
        }
    }
    folder.keep(page);
    folder
}

/// The folder in which a page is run, with the files and the path of its commands.
pub struct Folder {
    at: TempDir,
    /// Programs that precede those of the system in the path.
    programs: TempDir,
}

impl Folder {
    pub fn new() -> Self {
        let folder = Self {
            at: tempfile::tempdir().unwrap(),
            programs: tempfile::tempdir().unwrap(),
        };
        for name in CHECKOUT {
            symlink(root().join(name), folder.path().join(name)).unwrap();
        }
        // Pages use mpirun; another MPI's launcher is substituted for it.
        let launcher = env::var("MPIEXEC").unwrap_or_default();
        if !["", "mpirun"].contains(&launcher.as_str()) {
            let mpirun = folder.programs.path().join("mpirun");
            fs::write(&mpirun, format!("#!/bin/sh\nexec {launcher} \"$@\"\n")).unwrap();
            fs::set_permissions(&mpirun, fs::Permissions::from_mode(0o755)).unwrap();
        }
        folder
    }

    pub fn path(&self) -> &Path {
        self.at.path()
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// Runs a command here, in the environment of `source scripts/environment`.
    pub fn run(&self, command: &mut Command) -> Ended {
        let python = python().and_then(|python| Some(python.parent()?.to_path_buf()));
        let mut places = vec![self.programs.path().to_path_buf(), programs().to_path_buf()];
        places.extend(python);
        places.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
        let path: OsString = env::join_paths(places).unwrap();
        command
            .current_dir(self.path())
            .env("PATH", path)
            .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
            .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
            .env("OMPI_MCA_pml", "ob1")
            .env("MPLBACKEND", "Agg")
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .env("PYTHONPATH", root().join("python"));
        Running::start(command).wait(LIMIT)
    }

    /// Runs a shell script, which has to succeed, and returns its output.
    fn script(&self, place: &str, text: &str) -> String {
        let mut shell = Command::new("bash");
        succeeded(
            place,
            self.run(shell.args(["-euo", "pipefail", "-c", text])),
        )
    }

    /// Runs the commands after `$ ` in one shell and compares their output.
    fn session(&self, text: &str) -> Result<(), String> {
        let exchanges = exchanges(text)?;
        let mut script = "exec 2>&1\nstatus=0\n".to_owned();
        for (index, (command, _)) in exchanges.iter().enumerate() {
            // Each command gets the exit code of the previous one as $?.
            let _ = writeln!(
                script,
                "(exit $status)\n{command}\nstatus=$?\nprintf '\\036%s\\036' {index}:$status"
            );
        }
        let mut shell = Command::new("bash");
        let ended = self.run(shell.arg("-c").arg(script));
        if ended.code() != 0 {
            return Err(format!(
                "the shell ended with {}\n{}",
                ended.code(),
                ended.stdout
            ));
        }
        let mut pieces = ended.stdout.split('\u{1e}');
        for (index, (command, shown)) in exchanges.iter().enumerate() {
            let printed = pieces.next().unwrap_or_default();
            let status = pieces
                .next()
                .and_then(|piece| piece.strip_prefix(&format!("{index}:")));
            let is_asked = exchanges
                .get(index + 1)
                .is_some_and(|(next, _)| next == "echo $?");
            match status {
                Some("0") => {}
                Some(_) if is_asked => {}
                _ => {
                    return Err(format!(
                        "$ {command}\n{printed}ended with {status:?}, and the page doesn't show it by $ echo $?"
                    ));
                }
            }
            if !is_shown(shown, printed) {
                return Err(format!("$ {command}\nshown:\n{shown}\nprinted:\n{printed}"));
            }
        }
        Ok(())
    }

    /// Copies the results for inspection, if requested.
    fn keep(&self, page: &Page) {
        let Some(kept) = env::var_os("DOCUMENTS_KEEP") else {
            return;
        };
        let place = Path::new(&kept).join(page.name.replace('/', "-"));
        fs::create_dir_all(&place).unwrap();
        let copied = Command::new("cp")
            .arg("-rP")
            .arg(self.path().join("."))
            .arg(place)
            .status();
        assert!(copied.unwrap().success());
    }
}

/// Fails unless a block ended with 0; returns its output.
fn succeeded(place: &str, ended: Ended) -> String {
    assert_eq!(
        ended.code(),
        0,
        "{place}:\n{}{}",
        ended.stdout,
        ended.stderr
    );
    ended.stdout
}

/// The commands of a session, each with the output shown below it.
fn exchanges(text: &str) -> Result<Vec<(String, String)>, String> {
    let mut exchanges: Vec<(String, String)> = Vec::new();
    for line in text.lines() {
        match (line.strip_prefix("$ "), exchanges.last_mut()) {
            (Some(command), _) => exchanges.push((command.to_owned(), String::new())),
            (None, Some((_, shown))) => {
                shown.push_str(line);
                shown.push('\n');
            }
            (None, None) => {
                return Err("a console's first line has to be a command behind '$ '".to_owned());
            }
        }
    }
    Ok(exchanges)
}

/// A test: a failing command is reported, with its output.
pub fn show_failures() {
    let folder = Folder::new();
    for honest in [
        "$ echo a\na\n",
        "$ ls nowhere\nls: …nowhere…\n$ echo $?\n2\n$ true\n",
        "$ x=1\n$ echo $x\n1\n",
    ] {
        folder.session(honest).unwrap();
    }
    for dishonest in [
        "$ echo a\nb\n",
        "$ false\n",
        "$ false\n$ echo $?\n2\n",
        "echo a\n",
        "$ exit 3\n$ echo $?\n3\n",
    ] {
        assert!(folder.session(dishonest).is_err(), "{dishonest}");
    }
}
