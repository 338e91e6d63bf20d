//! A mutation fuzzer of flexsc: files of every kind that it reads, arguments, what viewers and control programs send, and what
//! importers of FMUs call.
//!
//!     cargo run --release -p flexsc-fuzz                         12 s on each surface
//!     cargo run --release -p flexsc-fuzz -- --seconds 3600       an hour on each
//!     cargo run --release -p flexsc-fuzz -- --surface logs --inputs 900       the same 900 inputs on any machine
//!
//! Inputs follow from a seed, a surface and a number. Each runs in a separate process under limits of memory and time;
//! inputs that panic, abort, hang or leave half a file are saved, reduced, and printed with the command that repeats
//! them.
#![cfg(unix)]

mod case;
mod chance;
mod findings;
mod fmu_importer;
mod lockstep_client;
mod mutate;
mod nasty;
mod node;
mod smaller;
mod surface;
mod tally;
mod watch;
mod worker;

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use clap::{Parser, Subcommand, ValueEnum};

use case::Case;
use findings::{Findings, Found};
use surface::{Maker, Surface};
use tally::Tally;
use watch::News;
use worker::Work;

/// Largest number of inputs of a worker, which limits the effects that an input leaves in its process.
const BATCH: u64 = 250;

/// Time limit that no number of inputs reaches.
const A_DAY: Duration = Duration::from_secs(86_400);

/// A mutation fuzzer of flexsc: exits with 1 if it finds anything
#[derive(Parser)]
struct Args {
    #[command(subcommand)]
    within: Option<Within>,
    /// Surfaces, one after another [default: all]
    #[arg(long, value_enum)]
    surface: Vec<Surface>,
    /// How long each surface is fuzzed (s)
    #[arg(long, default_value_t = 12.0)]
    seconds: f64,
    /// How many inputs each surface gets, however long they take
    #[arg(long, conflicts_with = "seconds")]
    inputs: Option<u64>,
    /// Seed of the inputs
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The number of the first input
    #[arg(long, default_value_t = 0)]
    first: u64,
    /// Only this input: run it, and keep it
    #[arg(long, conflicts_with_all = ["seconds", "inputs", "first"])]
    case: Option<u64>,
    /// Only this input, which was kept: a directory
    #[arg(long, value_name = "DIR", conflicts_with_all = ["seconds", "inputs", "first", "surface", "case"])]
    replay: Option<PathBuf>,
    /// Processes at a time
    #[arg(long, default_value_t = 2)]
    jobs: usize,
    /// Where findings are kept
    #[arg(long, value_name = "DIR", default_value = "target/fuzz")]
    keep: PathBuf,
}

#[derive(Subcommand)]
enum Within {
    /// Process that the fuzzer starts to run inputs
    #[command(hide = true)]
    Worker { surface: Surface, seed: u64, from: u64, to: u64 },
    /// Process that the fuzzer starts to run an input again
    #[command(hide = true)]
    Again { directory: PathBuf },
}

/// Writes a line of text.
macro_rules! say {
    ($($text:tt)*) => { { let _ = writeln!(std::io::stderr().lock(), $($text)*); } };
}
pub(crate) use say;

fn main() -> ExitCode {
    let args = Args::parse();
    let done = match &args.within {
        Some(Within::Worker { surface, seed, from, to }) => {
            worker::work(&Work::Numbers(*surface, *seed, *from..*to)).map(|()| true)
        }
        Some(Within::Again { directory }) => worker::work(&Work::Kept(directory)).map(|()| true),
        None => fuzz(&args),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            say!("error: {error}");
            ExitCode::from(2)
        }
    }
}

/// Fuzzes all surfaces as requested, and returns true if there are no findings.
fn fuzz(args: &Args) -> io::Result<bool> {
    let scratch = tempfile::tempdir()?;
    if let Some(directory) = &args.replay {
        let why = again(&std::path::absolute(directory)?, &scratch.path().join("replay"))?;
        say!("{}: {}", directory.display(), why.as_deref().unwrap_or("all is well"));
        return Ok(why.is_none());
    }
    let surfaces = if args.surface.is_empty() { Surface::value_variants() } else { &args.surface };
    let mut clean = true;
    for surface in surfaces {
        let findings = Findings::new(args.keep.join(name(*surface)));
        if let Some(number) = args.case {
            let case = Maker::new(*surface, args.seed)?.make(number);
            let kept = findings.keep(&case, &format!("case-{number}"))?;
            let why = again(&std::path::absolute(&kept)?, &scratch.path().join("case"))?;
            say!("{}: {}", kept.display(), why.as_deref().unwrap_or("all is well"));
            clean &= why.is_none();
        } else {
            clean &= one(args, *surface, findings, scratch.path())?;
        }
    }
    Ok(clean)
}

/// Returns the name of a surface.
pub fn name(surface: Surface) -> String {
    surface.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

/// Fuzzes one surface, and returns true if there are no findings.
fn one(args: &Args, surface: Surface, findings: Findings, scratch: &Path) -> io::Result<bool> {
    let began = Instant::now();
    let deadline = began + args.inputs.map_or(Duration::from_secs_f64(args.seconds), |_| A_DAY);
    let end = args.inputs.map_or(u64::MAX, |inputs| args.first.saturating_add(inputs));
    let maker = Maker::new(surface, args.seed)?;
    let (tally, findings) = (Mutex::new(Tally::default()), Mutex::new(findings));
    // Viewers, control programs and their runs wait for each other most of the time.
    let several = if matches!(surface, Surface::Live | Surface::Lockstep) { 4 } else { 1 };
    let jobs = several * args.jobs.max(1);
    // Every job gets inputs.
    let batch = args.inputs.map_or(BATCH, |inputs| inputs.div_ceil(jobs as u64).clamp(1, BATCH));
    let next = AtomicU64::new(args.first);
    // If one job fails, the others stop early too.
    let failed = AtomicBool::new(false);
    let goes_on = || Instant::now() < deadline && !failed.load(Ordering::Relaxed);
    let job = |job: usize| -> io::Result<()> {
        let directory = scratch.join(format!("{}-{job}", name(surface)));
        while goes_on() {
            let from = next.fetch_add(batch, Ordering::Relaxed);
            if from >= end {
                break;
            }
            let (mut at, to) = (from, end.min(from + batch));
            while at < to && goes_on() {
                let (seed, mut broken) = (args.seed.to_string(), Vec::new());
                let arguments = ["worker".to_owned(), name(surface), seed, at.to_string(), to.to_string()];
                let was = at;
                watch::watch(&arguments, &directory, deadline, |news| {
                    let mut tally = tally.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                    let (number, why) = tally.take(news);
                    at = number + 1;
                    broken.extend(why.map(|why| (number, why)));
                })?;
                for (number, why) in broken {
                    let found = Found { surface, seed: args.seed, number, since: was, why };
                    let known =
                        findings.lock().unwrap_or_else(std::sync::PoisonError::into_inner).is_known(&found);
                    if !known {
                        let made = !found.why.starts_with(watch::BETWEEN);
                        let case = if made { maker.make(number) } else { Case::default() };
                        let (case, alone) =
                            smaller::smaller(&case, &found, &directory.with_extension("again"))?;
                        findings
                            .lock()
                            .unwrap_or_else(std::sync::PoisonError::into_inner)
                            .report(&found, &case, alone)?;
                    }
                }
                if at == was {
                    break;
                }
            }
        }
        Ok(())
    };
    let job = |number: usize| {
        let done = job(number);
        failed.fetch_or(done.is_err(), Ordering::Relaxed);
        done
    };
    let done = std::thread::scope(|scope| {
        let jobs: Vec<_> = (0..jobs).map(|n| scope.spawn(move || job(n))).collect();
        jobs.into_iter()
            .try_for_each(|job| job.join().unwrap_or_else(|_| Err(io::Error::other("a thread panicked"))))
    });
    let findings = findings.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    let tally = tally.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    say!("{}", tally.summary(surface, args.seed, began.elapsed(), &findings));
    done?;
    Ok(findings.none())
}

/// Runs a saved input, and returns its fault.
pub fn again(case: &Path, scratch: &Path) -> io::Result<Option<String>> {
    let mut wrong = None;
    let arguments = ["again".to_owned(), case.display().to_string()];
    let late = Instant::now() + Duration::from_secs(120);
    watch::watch(&arguments, scratch, late, |news| {
        wrong = match news {
            News::Done { wrong, .. } => wrong,
            News::Ended { .. } => None,
            News::Broken { why, .. } => Some(why),
        };
    })?;
    Ok(wrong)
}
