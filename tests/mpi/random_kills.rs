//! Ranks that are killed at any time. `KILLS` says how often; `scripts/kills` does it hundreds of times.

use std::env;

use super::*;
use support::random::Random;

/// Within this time a rank's end has to be that of all.
const SOON: Duration = Duration::from_secs(10);

/// What became of so many kills.
#[derive(Debug, Default)]
struct Tally {
    /// The run ended with another code than 0.
    failed: usize,
    /// It was whole before the kill could change that.
    whole: usize,
    /// The program's own message named the rank and what it was doing.
    named: usize,
    /// It named another one, which fell over the memory of the killed one before the system had closed
    /// the latter's files.
    of_another: usize,
    /// Longest time from a kill to the launcher's end.
    slowest: Duration,
}

/// Whenever a rank is killed, all end soon, nothing lives on, and under the result's name there is the
/// older result or the whole new one.
pub fn random_kills(trials: &mut Trials) {
    trials.once("random_kills", || {
        let kills = env::var("KILLS").map_or(6, |kills| kills.parse().unwrap());
        let seed = env::var("SEED").map_or(1, |seed| seed.parse().unwrap());
        let mut random = Random::new(seed);
        let case = Case::of(&built_in_model("granite", 0), 8);
        let began = Instant::now();
        assert_eq!(case.run_on(2, &[]).code(), 0);
        let whole_run = began.elapsed();
        let expected = datasets(&case.result());
        let mut tally = Tally::default();
        for kill in 0..kills {
            let ranks = 2 + kill % 3;
            let older = fs::read(case.result()).unwrap();
            let after = whole_run.mul_f64(random.within(0.0, 1.0));
            let (ended, victim) = killed_run(&case, ranks, after, &mut random, &mut tally);
            let said = format!("kill {kill}\n{}{}", ended.stdout, ended.stderr);
            ended.leaves_no_process(SOON);
            let named: Vec<&str> = ended.errors();
            assert!(named.len() <= 1, "{said}");
            if let Some((message, rank)) = named.first().zip(victim) {
                match message.contains(&format!("rank {rank} of {ranks}")) {
                    true => tally.named += 1,
                    false => tally.of_another += 1,
                }
            }
            match ended.code() {
                0 => tally.whole += 1,
                _ => tally.failed += 1,
            }
            if ended.code() == 0 || fs::read(case.result()).unwrap() != older {
                assert!(datasets(&case.result()) == expected, "damaged by {said}");
            }
        }
        assert_eq!(case.run(&[]).code(), 0);
        assert_eq!(case.files(), ["problem.h5", "problem.vtkhdf"]);
        eprintln!("random_kills: {kills} of a run of {whole_run:?}, seed {seed}: {tally:?}");
    });
}

/// A run of which a rank is killed some time after all are there, and which rank it was.
///
/// Before that it is the launcher's affair: mpirun of Open MPI 4.1.4 has been seen to wait for ever, with
/// no rank left, when one died while MPI was connecting it.
fn killed_run(
    case: &Case,
    ranks: usize,
    after: Duration,
    random: &mut Random,
    tally: &mut Tally,
) -> (Ended, Option<usize>) {
    let mut running = Running::start(program(ranks).arg(case.problem()));
    while running.descendants("rank-watcher").is_empty() && running.is_running() {
        thread::sleep(Duration::from_millis(1));
    }
    thread::sleep(after);
    let victims = running.descendants("contact-dd-mpi");
    let victim = (!victims.is_empty()).then(|| random.pick(&victims));
    let rank = victim.and_then(rank_of);
    let killed = Instant::now();
    if let Some(victim) = victim {
        kill(victim);
    }
    let ended = running.wait(LIMIT);
    let took = killed.elapsed();
    assert!(took < SOON, "{took:?} until the end of {}", ended.stderr);
    tally.slowest = tally.slowest.max(took);
    (ended, rank)
}

/// The rank of a process, as its launcher has told it.
fn rank_of(process: u32) -> Option<usize> {
    let environment = fs::read(format!("/proc/{process}/environ")).ok()?;
    let mut entries = environment.split(|&byte| byte == 0);
    entries.find_map(|entry| {
        let entry = str::from_utf8(entry).ok()?;
        let (name, value) = entry.split_once('=')?;
        let is_rank = ["OMPI_COMM_WORLD_RANK", "PMI_RANK"].contains(&name);
        is_rank.then(|| value.parse().ok()).flatten()
    })
}
