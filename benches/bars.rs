//! CPU time of runs over that of the hand-written yardstick: kinds of runs in turn, pass by pass, the minimum of each.
//!
//! `cargo bench -p flexsc-bench --bench bars -- 9 'one run'` prints the table; both arguments may be left out: the number of passes,
//! and a part of the names of the kinds beside the yardstick.

#![allow(clippy::print_stdout, reason = "it prints a table")]

#[allow(dead_code, reason = "the other benchmark has the rest")]
mod reference;

use std::hint::black_box;
use std::time::{Duration, Instant};

use flexsc_core::batch::{BatchJob, simulate_on};
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Selection;
use flexsc_core::numerics::lanes::Processor;
use flexsc_core::{Scenario, Simulation};
use reference::{EVENTS, WINDOWS};

/// Five modes with damping.
const DAMPED: &str = "    { frequency = 0.44, gain = 0.0213, damping = 0.002, displacement = 2.75e-6 },
    { frequency = 0.755, gain = 0.0216, damping = 0.002 },
    { frequency = 1.3, gain = 0.01, damping = 0.003 },
    { frequency = 2.1, gain = 0.01, damping = 0.004 },
    { frequency = 3.4, gain = 0.01, damping = 0.005 },
";

/// Runs of many gains.
const RUNS: usize = 128;

/// Seconds of CPU time of this thread, or of wall time where that is not known.
fn seconds(since: Instant) -> f64 {
    // The kernel counts them when another thread has its turn.
    std::thread::sleep(Duration::from_micros(50));
    let schedule = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let cpu_time = schedule.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    cpu_time.map_or_else(|| since.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

fn scenario(text: &str, k_t: f64) -> Scenario {
    Scenario::parse("bars.toml", &text.replace("0.3389", &k_t.to_string())).expect("a valid scenario")
}

fn gains() -> impl Iterator<Item = f64> {
    (0..RUNS).map(|index| 0.28 + 0.12 * index as f64 / (RUNS - 1) as f64)
}

fn even(text: &str) -> Vec<CampaignRun> {
    let run = |k_t| CampaignRun::new(scenario(text, k_t), 0);
    gains().map(run).collect()
}

/// One kind of runs: its name, what makes them, and how many at once.
struct Kind<'a> {
    name: String,
    runs: usize,
    make: Box<dyn Fn() + 'a>,
}

/// All kinds.
struct Kinds<'a>(Vec<Kind<'a>>);

impl<'a> Kinds<'a> {
    fn add(&mut self, name: String, runs: usize, make: Box<dyn Fn() + 'a>) {
        self.0.push(Kind { name, runs, make });
    }
}

fn main() {
    let passes = std::env::args().find_map(|argument| argument.parse().ok()).unwrap_or(7);
    let windows = format!("{EVENTS}{WINDOWS}");
    let (start, rest) = EVENTS.split_once("modes = [\n").expect("modes");
    let damped = format!("{start}modes = [\n{DAMPED}]{}", rest.split_once(']').expect("modes").1);
    let damped_windows = format!("{damped}{WINDOWS}");
    let texts = [
        ("events only", EVENTS),
        ("40 window means", &windows),
        ("five damped modes, events only", &damped),
        ("five damped modes, 40 window means", &damped_windows),
    ];
    let (none, all) = (Selection::from_names::<&str>([]).expect("no names"), Selection::ALL);
    let many: Vec<Vec<CampaignRun>> = texts.iter().map(|(_, text)| even(text)).collect();
    let one: Vec<CampaignRun> =
        texts.iter().map(|(_, text)| CampaignRun::new(scenario(text, 0.3389), 0)).collect();
    let mut kinds = Kinds(Vec::new());
    kinds.add(
        "yardstick".to_owned(),
        8,
        Box::new(|| {
            (0..8).for_each(|_| {
                black_box(reference::exact(black_box(0.3389), 20_000.0));
            });
        }),
    );
    for ((name, _), run) in texts.iter().zip(&one) {
        kinds.add(
            format!("one run, {name}"),
            8,
            Box::new(move || {
                (0..8).for_each(|_| {
                    Simulation::new(black_box(&run.scenario), 0).run(&mut ()).expect("a run");
                });
            }),
        );
        kinds.add(
            format!("one run, {name}, all metrics"),
            8,
            Box::new(move || {
                (0..8).for_each(|_| {
                    black_box(Campaign::simulate(black_box(run), ()).expect("a run"));
                });
            }),
        );
    }
    kinds.add(
        format!("yardstick, {RUNS} gains"),
        RUNS,
        Box::new(|| {
            gains().for_each(|k_t| {
                black_box(reference::exact(black_box(k_t), 20_000.0));
            });
        }),
    );
    for ((name, _), runs) in texts.iter().zip(&many) {
        for (suffix, selection) in [("", &none), (", all metrics", &all)] {
            let job_for = |run| BatchJob { number: 0, scenario: run, selection };
            let jobs: Vec<BatchJob<'_>> = runs.iter().map(|run| job_for(&run.scenario)).collect();
            for processor in Processor::all() {
                let jobs = jobs.clone();
                kinds.add(
                    format!("{}, {name}{suffix}", processor.name()),
                    RUNS,
                    Box::new(move || {
                        black_box(simulate_on(processor, black_box(&jobs)));
                    }),
                );
            }
        }
    }
    let started = Instant::now();
    let Kinds(mut kinds) = kinds;
    let named = std::env::args()
        .skip(1)
        .find(|argument| argument.parse::<u32>().is_err() && !argument.starts_with('-'));
    kinds.retain(|kind| {
        kind.name.starts_with("yardstick") || named.as_ref().is_none_or(|part| kind.name.contains(part))
    });
    let mut least = vec![f64::INFINITY; kinds.len()];
    for _ in 0..passes {
        for (least, kind) in least.iter_mut().zip(&kinds) {
            let before = seconds(started);
            (kind.make)();
            *least = least.min((seconds(started) - before) / kind.runs as f64);
        }
    }
    println!("| CPU time of a run | us | to the yardstick |\n|---|---|---|");
    let mut yardstick = f64::NAN;
    for (kind, least) in kinds.iter().zip(least) {
        if kind.name.starts_with("yardstick") {
            yardstick = least;
        }
        // What no lanes take goes alone.
        if least < 1e-6 {
            continue;
        }
        println!("| {} | {:.1} | {:.3} |", kind.name, 1e6 * least, least / yardstick);
    }
}
