//! Running programs that may hang, and ending all of their processes.

use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use tempfile::TempDir;

/// The end of a program, and its output.
#[derive(Debug)]
pub struct Ended {
    /// The exit status; `None` if the program was killed because its time was up.
    pub status: Option<ExitStatus>,
    pub stdout: String,
    pub stderr: String,
    pub took: Duration,
    temporary: PathBuf,
}

impl Ended {
    /// The exit code.
    ///
    /// # Panics
    /// The program hung or was killed, so that it has none.
    #[track_caller]
    pub fn code(&self) -> i32 {
        let Some(status) = self.status else {
            panic!(
                "hung, and was ended after {:?}\n{}\n{}",
                self.took, self.stdout, self.stderr
            );
        };
        status
            .code()
            .unwrap_or_else(|| panic!("ended by a signal: {status}\n{}", self.stderr))
    }

    /// Lines that begin with `error:`, the program's form of failure.
    pub fn errors(&self) -> Vec<&str> {
        let lines = self.stderr.lines().chain(self.stdout.lines());
        lines.filter(|line| line.starts_with("error:")).collect()
    }

    /// Fails unless all processes that it started end within `limit`: a launcher doesn't wait for the system to remove
    /// its ranks.
    #[track_caller]
    pub fn leaves_no_process(&self, limit: Duration) {
        let deadline = Instant::now() + limit;
        let mark = format!("TMPDIR={}", self.temporary.display()).into_bytes();
        loop {
            let is_left = |id: &u32| {
                let environment = fs::read(format!("/proc/{id}/environ")).unwrap_or_default();
                environment
                    .split(|&byte| byte == 0)
                    .any(|entry| entry == mark)
            };
            let all = processes().into_iter().map(|process| process.id);
            let left: Vec<u32> = all.filter(is_left).collect();
            if left.is_empty() {
                return;
            }
            assert!(Instant::now() < deadline, "processes {left:?} live on");
            thread::sleep(Duration::from_millis(20));
        }
    }
}

/// A running program.
pub struct Running {
    child: Child,
    temporary: TempDir,
    began: Instant,
    stdout: thread::JoinHandle<String>,
    stderr: thread::JoinHandle<String>,
}

impl Running {
    /// Starts the program with its own folder for temporary files: launchers that end at the same time remove the
    /// folder that they share.
    pub fn start(command: &mut Command) -> Self {
        let temporary = tempfile::tempdir().unwrap();
        let mut child = command
            .env("TMPDIR", temporary.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("{command:?} can't be started: {error}"));
        let stdout = collect(child.stdout.take());
        let stderr = collect(child.stderr.take());
        Self {
            child,
            temporary,
            began: Instant::now(),
            stdout,
            stderr,
        }
    }

    /// The processes named `name` among its children and their descendants.
    pub fn descendants(&self, name: &str) -> Vec<u32> {
        let processes = processes();
        let mut tree = vec![self.child.id()];
        let mut next = 0;
        while next < tree.len() {
            let parent = tree[next];
            tree.extend(
                processes
                    .iter()
                    .filter(|p| p.parent == parent)
                    .map(|p| p.id),
            );
            next += 1;
        }
        processes
            .iter()
            .filter(|p| tree[1..].contains(&p.id) && p.name == name)
            .map(|p| p.id)
            .collect()
    }

    /// Waits until the program or one of its processes is stopped, and returns which.
    #[track_caller]
    pub fn stopped(&self, limit: Duration) -> u32 {
        let deadline = Instant::now() + limit;
        loop {
            let all = processes();
            let own = |p: &&Process| p.id == self.child.id() || p.parent == self.child.id();
            if let Some(process) = all.iter().filter(own).find(|p| p.state == "T") {
                return process.id;
            }
            assert!(Instant::now() < deadline, "nothing was stopped");
            thread::sleep(Duration::from_millis(5));
        }
    }

    pub fn is_running(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }

    /// Waits for its end, at most for `limit`; then kills it and all that it started.
    pub fn wait(mut self, limit: Duration) -> Ended {
        let deadline = Instant::now() + limit;
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break Some(status);
            }
            if Instant::now() > deadline {
                self.kill();
                break None;
            }
            thread::sleep(Duration::from_millis(5));
        };
        Ended {
            status,
            took: self.began.elapsed(),
            stdout: self.stdout.join().unwrap(),
            stderr: self.stderr.join().unwrap(),
            temporary: self.temporary.path().to_path_buf(),
        }
    }

    /// The launcher's ranks have their own process groups, so that they are looked up one by one.
    fn kill(&mut self) {
        let mut doomed = Vec::new();
        for process in processes() {
            if process.parent == self.child.id() || doomed.contains(&process.parent) {
                doomed.push(process.id);
            }
        }
        // The launcher goes first, as it would report the end of a rank.
        self.child.kill().unwrap();
        self.child.wait().unwrap();
        for process in doomed {
            send(process, Signal::KILL);
        }
    }
}

/// Sends a signal; a process that has already ended is fine.
pub fn send(id: u32, signal: Signal) {
    if let Some(id) = Pid::from_raw(id as i32) {
        let _ = kill_process(id, signal);
    }
}

struct Process {
    id: u32,
    parent: u32,
    name: String,
    state: String,
}

/// All processes but zombies, by ascending id, from /proc.
fn processes() -> Vec<Process> {
    let mut all: Vec<Process> = fs::read_dir("/proc")
        .unwrap()
        .filter_map(|entry| {
            let id = entry.ok()?.file_name().to_str()?.parse().ok()?;
            // "id (name) state parent …", where the name may hold anything.
            let stat = fs::read_to_string(format!("/proc/{id}/stat")).ok()?;
            let (head, tail) = stat.rsplit_once(") ")?;
            let (_, name) = head.split_once('(')?;
            let mut fields = tail.split(' ');
            let state = fields.next()?;
            let parent = fields.next()?.parse().ok()?;
            (state != "Z").then(|| Process {
                id,
                parent,
                name: name.to_owned(),
                state: state.to_owned(),
            })
        })
        .collect();
    all.sort_by_key(|process| process.id);
    all
}

fn collect(stream: Option<impl Read + Send + 'static>) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut stream) = stream {
            let _ = stream.read_to_end(&mut bytes);
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}
