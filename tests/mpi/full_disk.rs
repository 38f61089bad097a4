//! Outputs whose place is full, read-only, or gone by the time they are whole.

use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::process::Command;

use super::*;

/// A folder in a file system of its own, mounted where only the program under test sees it, and what is
/// in it after the run.
struct Mounted<'a> {
    folder: &'a Path,
    /// How it is mounted; `$0` is the folder.
    mount: &'a str,
}

impl Mounted<'_> {
    /// The command that runs `command` with the folder mounted and prints names and contents of its
    /// files afterwards.
    fn around(&self, command: &Command) -> Command {
        let script = format!(
            "{} && echo yesterday >$0/output && {{ \"$@\"; code=$?; cd $0; ls -A; cat output; exit \
             $code; }}",
            self.mount
        );
        let mut whole = Command::new("unshare");
        whole.args(privileges()).args(["sh", "-c", &script]);
        whole.arg(self.folder).arg(command.get_program());
        whole.args(command.get_args());
        for (name, value) in command.get_envs() {
            whole.env(name, value.unwrap_or_default());
        }
        whole
    }
}
