//! Clock of a model machine, where each rank has its own core and messages take the time of a known network, whatever
//! else the real machine does. Work is the measured thread time; waiting follows from the messages.

use std::cell::Cell;
use std::ops::{AddAssign, Sub};
use std::time::Instant;

use rustix::time::{ClockId, clock_gettime};

/// Bandwidth of the model network (bytes per second).
pub const BANDWIDTH: f64 = 12.5e9;

/// Latency of the model network: time of an empty message (s).
pub const LATENCY: f64 = 2e-6;

/// Fraction of the latency during which each end is busy.
const BUSY: f64 = 0.25;

/// Times of a rank since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Wall-clock time (s).
    pub elapsed: f64,
    /// Processor time, without messages and waiting (s).
    pub work: f64,
    /// Modelled time, on a core of its own and with the model network (s).
    pub modelled: f64,
}

impl Sub for Times {
    type Output = Self;

    fn sub(self, earlier: Self) -> Self {
        Self {
            elapsed: self.elapsed - earlier.elapsed,
            work: self.work - earlier.work,
            modelled: self.modelled - earlier.modelled,
        }
    }
}

impl AddAssign for Times {
    fn add_assign(&mut self, more: Self) {
        self.elapsed += more.elapsed;
        self.work += more.work;
        self.modelled += more.modelled;
    }
}

/// The sender's clock, which is sent with a message.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stamp {
    /// The sender's modelled time (s).
    pub modelled: f64,
    /// Length of the longest chain of messages up to this one, inclusive.
    pub chain: f64,
}

/// The times of this rank.
#[derive(Debug)]
pub struct Clock {
    began: Instant,
    /// Thread time at the end of the last message (s).
    resumed: Cell<f64>,
    work: Cell<f64>,
    stamp: Cell<Stamp>,
}

impl Clock {
    /// A clock that starts at zero.
    pub fn start() -> Self {
        Self {
            began: Instant::now(),
            resumed: Cell::new(thread_seconds()),
            work: Cell::new(0.0),
            stamp: Cell::default(),
        }
    }

    /// The times of this rank so far.
    pub fn times(&self) -> Times {
        let since = thread_seconds() - self.resumed.get();
        Times {
            elapsed: self.began.elapsed().as_secs_f64(),
            work: self.work.get() + since,
            modelled: self.stamp.get().modelled + since,
        }
    }

    /// Length of the longest chain of messages up to now.
    pub fn chain(&self) -> u64 {
        self.stamp.get().chain as u64
    }

    /// Ends the work before a message: thread time until the clock resumes counts for the message.
    pub fn pause(&self) -> Stamp {
        let times = self.times();
        self.work.set(times.work);
        let Stamp { chain, .. } = self.stamp.get();
        let now = Stamp {
            modelled: times.modelled,
            chain,
        };
        self.stamp.set(now);
        now
    }

    /// Resumes after a message was sent `times` times in succession.
    pub fn resume_sender(&self, bytes: usize, times: u32) {
        let mut stamp = self.stamp.get();
        stamp.modelled += f64::from(times) * (BUSY * LATENCY + bytes as f64 / BANDWIDTH);
        self.resume(stamp);
    }

    /// Resumes after a message arrived that was sent at `sent` and passed over `hops` successive messages.
    pub fn resume_receiver(&self, sent: Stamp, bytes: usize, hops: u32) {
        let (mine, hops) = (self.stamp.get(), f64::from(hops));
        let on_the_way = hops * LATENCY + (hops - 1.0) * bytes as f64 / BANDWIDTH;
        let busy = BUSY * LATENCY;
        // Messages arrive one after another.
        let begin = (mine.modelled + busy).max(sent.modelled + on_the_way);
        self.resume(Stamp {
            modelled: begin + bytes as f64 / BANDWIDTH,
            chain: mine.chain.max(sent.chain + hops),
        });
    }

    /// Resumes simultaneously on all ranks, of which the last arrived at `latest`.
    pub fn resume_all(&self, latest: Stamp, hops: u32) {
        self.resume(Stamp {
            modelled: latest.modelled + f64::from(hops) * LATENCY,
            chain: latest.chain + f64::from(hops),
        });
    }

    fn resume(&self, stamp: Stamp) {
        self.stamp.set(stamp);
        self.resumed.set(thread_seconds());
    }
}

/// The processor time of this thread (s).
fn thread_seconds() -> f64 {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn at(modelled: f64, chain: f64) -> Stamp {
        Stamp { modelled, chain }
    }

    #[test]
    fn waiting_is_no_work() {
        let clock = Clock::start();
        std::thread::sleep(Duration::from_millis(50));
        let times = clock.times();
        assert!(times.elapsed >= 0.05 && times.work < 0.02, "{times:?}");
    }

    #[test]
    fn a_message_comes_when_it_was_sent_and_the_network_has_brought_it() {
        let clock = Clock::start();
        clock.pause();
        clock.resume_receiver(at(3.0, 4.0), 12_500_000_000, 1);
        let Stamp { modelled, chain } = clock.pause();
        assert!((modelled - 4.0).abs() < 1e-2 && chain == 5.0, "{modelled}");
        // A message that has arrived already takes only the time to read it.
        clock.resume_receiver(at(0.0, 0.0), 12_500_000_000, 1);
        let Stamp { modelled, chain } = clock.pause();
        assert!((modelled - 5.0).abs() < 1e-2 && chain == 5.0, "{modelled}");
    }

    #[test]
    fn what_is_done_during_a_message_is_no_work() {
        let clock = Clock::start();
        let before = clock.pause();
        let busy = Instant::now();
        while busy.elapsed() < Duration::from_millis(30) {
            std::hint::spin_loop();
        }
        clock.resume_sender(0, 1);
        let after = clock.pause();
        assert!(after.modelled - before.modelled < 0.01);
        assert!(clock.times().work < 0.01);
    }
}
