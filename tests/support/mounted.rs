//! Full or read-only file systems, mounted so that only the program under test sees them.

use std::path::Path;
use std::process::Command;

/// A file system in a folder, containing an older file `output`.
#[derive(Clone, Copy, Debug)]
pub enum Mounted {
    /// A file system of this many bytes, rounded up to pages.
    OfSize(u64),
    /// A read-only file system.
    ReadOnly,
}

impl Mounted {
    /// The command that runs `command` with the file system in `folder`, and then fails unless the older `output` is
    /// unchanged and the only file; otherwise it ends with the exit code of `command`. `None` if nothing may be
    /// mounted.
    pub fn around(self, folder: &Path, command: &Command) -> Option<Command> {
        let privilege = privilege()?;
        let (size, then) = match self {
            Self::OfSize(bytes) => (bytes, "true"),
            Self::ReadOnly => (1 << 20, "mount -o remount,ro \"$0\""),
        };
        let script = format!(
            "mount -t tmpfs -o size={size} none \"$0\" && echo yesterday >\"$0/output\" && {then} || \
             exit 77\n\
             \"$@\"\n\
             code=$?\n\
             [ \"$(ls -A \"$0\")\" = output ] || {{ ls -lA \"$0\"; exit 78; }}\n\
             [ \"$(cat \"$0/output\")\" = yesterday ] || exit 79\n\
             exit $code"
        );
        let mut whole = Command::new("unshare");
        whole.args([privilege, "sh", "-c", &script]).arg(folder);
        whole.arg(command.get_program()).args(command.get_args());
        for (name, value) in command.get_envs() {
            if let Some(value) = value {
                whole.env(name, value);
            }
        }
        Some(whole)
    }
}

/// The command that allows mounting in its own view of file systems: as root, or as one's own root.
pub fn privilege() -> Option<&'static str> {
    ["-m", "-rm"].into_iter().find(|&option| {
        let mut mount = Command::new("unshare");
        mount.args([option, "mount", "-t", "tmpfs", "none", "/mnt"]);
        mount.output().is_ok_and(|output| output.status.success())
    })
}
