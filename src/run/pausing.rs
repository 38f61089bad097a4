//! When sweeps leave a checkpoint, and where a restart finds it.

use std::ffi::OsString;
use std::path::PathBuf;

use crate::checkpoint::{Checkpoint, Digest, digest};
use crate::error::Failure;
use crate::interface::operator::Interface;
use crate::interface::s_con::{ConState, SCon};
use crate::settings::Settings;
use crate::sweep::Pause;
use crate::sweep::progress::Progress;

/// The checkpoints of a run. On the root.
pub struct Checkpoints<'a> {
    settings: &'a Settings,
    path: PathBuf,
    older: PathBuf,
    problem: Option<Digest>,
    /// What an earlier run left, until its load step comes.
    earlier: Option<Checkpoint>,
    /// The load step that the sweeps are of.
    step: usize,
    /// Why the sweeps stopped short.
    stopped: Option<Failure>,
    /// What a user should know.
    pub warnings: Vec<String>,
}

impl<'a> Checkpoints<'a> {
    /// Checkpoints beside the result.
    pub fn new(settings: &'a Settings) -> Self {
        let beside = |suffix: &str| {
            let mut name = OsString::from(&settings.output);
            name.push(suffix);
            PathBuf::from(name)
        };
        Self {
            settings,
            path: beside(".checkpoint"),
            older: beside(".checkpoint.old"),
            problem: None,
            earlier: None,
            step: 0,
            stopped: None,
            warnings: Vec::new(),
        }
    }

    /// Looks for the last good checkpoint, if one is asked for.
    ///
    /// # Errors
    /// It is that of another problem or method, or of another version of the program.
    pub fn look(&mut self) -> Result<(), Failure> {
        if !self.settings.restart {
            return Ok(());
        }
        for path in [self.path.clone(), self.older.clone()] {
            if !path.exists() {
                continue;
            }
            let name = path.display();
            match Checkpoint::read(&path) {
                Ok(checkpoint) => {
                    let accepted = self.accept(checkpoint);
                    let refused = |why| Failure::input(format!("--restart: {name}: {why}"));
                    self.earlier = Some(accepted.map_err(refused)?);
                    return Ok(());
                }
                Err(why) => self.warnings.push(format!("--restart: {name}: {why}")),
            }
        }
        self.warnings.push(format!(
            "--restart: there is no good checkpoint {}: this run begins at the start",
            self.path.display()
        ));
        Ok(())
    }

    /// Begins with the sweeps of load step k; gives back the checkpoint that is of them.
    pub fn begin(&mut self, k: usize) -> Option<Checkpoint> {
        self.step = k;
        self.earlier.take_if(|checkpoint| checkpoint.step == k)
    }

    /// The checkpoint if this run may go on from it; else why it may not.
    fn accept(&mut self, checkpoint: Checkpoint) -> Result<Checkpoint, String> {
        let version = env!("CARGO_PKG_VERSION");
        let method = self.settings.method.name();
        if checkpoint.version != version {
            return Err(format!(
                "it is of version {}; expected one of version {version}",
                checkpoint.version
            ));
        }
        if checkpoint.problem != self.problem().map_err(|failure| failure.message)? {
            return Err(format!(
                "it is that of another problem; expected one of {} as it is now",
                self.settings.problem.display()
            ));
        }
        if checkpoint.method != method {
            return Err(format!(
                "it is of --method {}; expected one of --method {method}",
                checkpoint.method
            ));
        }
        Ok(checkpoint)
    }

    fn problem(&mut self) -> Result<Digest, Failure> {
        if let Some(known) = self.problem {
            return Ok(known);
        }
        let path = &self.settings.problem;
        let found =
            digest(path).map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
        self.problem = Some(found);
        Ok(found)
    }

    /// Brings the pairs to where they were and gives back what the sweeps go on with.
    ///
    /// # Errors
    /// The checkpoint is of a program that divides the problem otherwise.
    pub fn restore(
        &self,
        checkpoint: Option<Checkpoint>,
        interface: &Interface,
        s_con: &mut SCon<'_>,
    ) -> Result<Option<(Progress, ConState)>, Failure> {
        let Some(checkpoint) = checkpoint else {
            return Ok(None);
        };
        if !checkpoint.fits(interface) {
            return Err(Failure::input(format!(
                "--restart: {}: it has other unknowns than {} has with this program",
                self.path.display(),
                self.settings.problem.display()
            )));
        }
        s_con.restore(&checkpoint.state, &checkpoint.memories);
        Ok(Some((checkpoint.progress, checkpoint.state)))
    }

    /// Why the sweeps have no outcome.
    pub fn stopped(&mut self) -> Failure {
        (self.stopped.take()).unwrap_or_else(|| Failure::interrupted("interrupted"))
    }

    /// Removes what a run that converged doesn't need any more.
    pub fn remove(&self) {
        for path in [&self.path, &self.older] {
            // What isn't there needn't go.
            let _ = std::fs::remove_file(path);
        }
    }

    fn write(
        &mut self,
        progress: &Progress,
        state: &ConState,
        s_con: &mut SCon<'_>,
    ) -> Result<(), Failure> {
        let checkpoint = Checkpoint {
            version: env!("CARGO_PKG_VERSION").into(),
            problem: self.problem()?,
            method: self.settings.method.name().into(),
            step: self.step,
            progress: progress.clone(),
            state: state.clone(),
            memories: s_con.memories(),
        };
        checkpoint.write(&self.path, &self.older)?;
        Ok(())
    }
}

impl Pause for Checkpoints<'_> {
    fn pause(&mut self, progress: &Progress, state: &ConState, s_con: &mut SCon<'_>) -> bool {
        let sweeps = progress.records.len() - 1;
        let asked = s_con.is_any_rank_asked_to_stop();
        let due = (self.settings.checkpoint_every)
            .is_some_and(|every| sweeps > 0 && sweeps.is_multiple_of(every.get()));
        if !asked && !due {
            return false;
        }
        let written = self.write(progress, state, s_con);
        if asked {
            self.stopped = Some(match written {
                Ok(()) => Failure::interrupted(format!(
                    "interrupted after {sweeps} sweeps: {} has how far they came; the same command \
                     with --restart goes on from there",
                    self.path.display()
                )),
                Err(failure) => failure,
            });
        } else if let Err(failure) = written
            && !self.warnings.contains(&failure.message)
        {
            self.warnings.push(failure.message);
        }
        asked
    }
}
