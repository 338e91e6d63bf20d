//! The engine beside a hand-written yardstick of the same mathematics, in one run.
//!
//! `python benches/table.py` runs this and its peers and prints the table of docs/benchmarks.md.

mod reference;

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use flexsc_core::analysis::bound::OutputBound;
use flexsc_core::analysis::sampled_loop::{DiscretePlant, SampledLoop, Scaling, SettlingWindow, map};
use flexsc_core::batch::{BatchJob, simulate_on};
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::control::estimator::kalman::{FilterContext, FrequencyTracking, Prediction};
use flexsc_core::formats::structure::{HubState, Structure};
use flexsc_core::metrics::{Metrics, Selection};
use flexsc_core::numerics::lanes::Processor;
use flexsc_core::numerics::random::Seed;
use flexsc_core::record::{Detail, LogBytes, Record, RunEnd, Trace};
use flexsc_core::{Scenario, Simulation};
use nalgebra::DMatrix;
use reference::{EVENTS, WINDOWS};

/// The body of \[Wheel11, Sukhanov\], with four modes.
const MODES: &str = "duration = 1.0\n[law.open]\n[body.planar]\nangle = 0.01\nmodes = [{ frequency = 0.3, gain = 1.44 }, \
                     { frequency = 0.8, gain = 0.21 }, { frequency = 1.0, gain = 0.165 }, { frequency = 2.0, gain = 0.72 }]";

fn scenario(text: &str) -> Scenario {
    Scenario::parse("bench.toml", text).expect("a valid scenario")
}

fn simulate(scenario: &Scenario, record: &mut impl Record) {
    Simulation::new(scenario, 0).run(record).expect("a run");
}

/// A relay-quiet with the two modes and so many stiffer ones, which hardly move.
fn with_modes(count: usize) -> Scenario {
    let mut table = scenario(EVENTS).to_table();
    let modes = table["body"]["planar"]["modes"].as_array_mut().expect("modes");
    for index in modes.len()..count {
        let mut mode = modes[1].clone();
        let mode_table = mode.as_table_mut().expect("a mode");
        mode_table["frequency"] = (1.0 + 0.05 * index as f64).into();
        mode_table["gain"] = 1e-6.into();
        modes.push(mode);
    }
    scenario(&toml::to_string(&table).expect("TOML"))
}

fn run(c: &mut Criterion) {
    let mut group = c.benchmark_group("run of 20000 s");
    let (events, windows) = (scenario(EVENTS), scenario(&format!("{EVENTS}{WINDOWS}")));
    group.bench_function("yardstick", |b| b.iter(|| reference::exact(black_box(0.3389), 20_000.0)));
    group.bench_function("events only", |b| b.iter(|| simulate(black_box(&events), &mut ())));
    group.bench_function("events in memory", |b| {
        b.iter(|| {
            let mut trace = Trace::new(Detail::Events);
            simulate(black_box(&events), &mut trace);
            trace
        });
    });
    group.bench_function("40 window means", |b| b.iter(|| simulate(black_box(&windows), &mut ())));
    let run = CampaignRun::new(windows.clone(), 0);
    group.bench_function("windows and metrics", |b| b.iter(|| Campaign::simulate(black_box(&run), ())));
    group.bench_function("windows, metrics, log", |b| {
        b.iter(|| {
            let from = Campaign::provenance(&run);
            let mut log = LogBytes::new(&from, Detail::Events).expect("a log");
            let metrics = Campaign::simulate(&run, &mut log).expect("a run");
            log.finish(&metrics, RunEnd::Complete).expect("a log")
        });
    });
    group.finish();

    let mut group = c.benchmark_group("fixed step, 200 s");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    group.bench_function("RK4 at 1e-4 s", |b| b.iter(|| reference::rk4(black_box(0.3389), 200.0, 1e-4)));
    group.finish();
}

/// Runs of many gains, one by one and side by side, all metrics included.
fn lanes(c: &mut Criterion) {
    let mut group = c.benchmark_group("64 runs of 20000 s");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let gains = even(0.28, 0.4, 64);
    let variant = |k_t: &f64| scenario(&format!("{EVENTS}{WINDOWS}").replace("0.3389", &k_t.to_string()));
    let scenarios: Vec<Scenario> = gains.iter().map(variant).collect();
    group.bench_function("yardstick", |b| {
        b.iter(|| gains.iter().map(|k_t| reference::exact(black_box(*k_t), 20_000.0).0).sum::<u32>());
    });
    let runs: Vec<CampaignRun> =
        scenarios.iter().map(|scenario| CampaignRun::new(scenario.clone(), 0)).collect();
    group.bench_function("one by one", |b| {
        b.iter(|| runs.iter().map(|run| Campaign::simulate(run, ()).expect("a run")).collect::<Vec<_>>());
    });
    let jobs: Vec<BatchJob<'_>> = scenarios
        .iter()
        .map(|scenario| BatchJob { number: 0, scenario, selection: &Selection::ALL })
        .collect();
    for processor in Processor::all() {
        group.bench_function(processor.name(), |b| b.iter(|| simulate_on(processor, black_box(&jobs))));
    }
    group.finish();
}

fn modes(c: &mut Criterion) {
    let mut group = c.benchmark_group("modes");
    group.sample_size(20);
    for count in [2_usize, 20, 50, 100, 200] {
        let scenario = with_modes(count);
        group.throughput(Throughput::Elements(count as u64));
        group.bench_with_input(BenchmarkId::from_parameter(count), &scenario, |b, scenario| {
            b.iter(|| simulate(black_box(scenario), &mut ()));
        });
    }
    group.finish();
}

/// One sample of each filter of twelve states, prediction over a period and update; whole runs with drifting frequencies.
fn filters(c: &mut Criterion) {
    let mut group = c.benchmark_group("filter");
    for (name, prediction) in [("ekf step", Prediction::Extended), ("ukf step", Prediction::Unscented)] {
        let body = scenario(MODES).model;
        let setting = FilterContext {
            body: body.one_axis().expect("a body with one angle"),
            back_emf: (1e-4, true),
            period: 0.3,
            angle_noise: 1e-5,
            rate_noise: None,
        };
        let draws = &mut Seed { scenario: 0, run: 0 }.stream("prior");
        let mut filter = FrequencyTracking::default().filter(&setting, prediction, draws);
        let mut sample = 0.0;
        group.bench_function(name, |b| {
            b.iter(|| {
                sample += 1.0;
                filter.predict(black_box(1e-6 * libm::cos(0.03 * sample)));
                filter.update(Some((black_box(0.01 + 2e-3 * libm::cos(0.09 * sample)), 0.0)))
            });
        });
    }
    for (name, text) in [
        ("run of 600 s, mode known", include_str!("../scenarios/wheel-scheduled-gain.toml")),
        ("run of 600 s, extended filter", include_str!("../scenarios/wheel-ekf.toml")),
    ] {
        let run = CampaignRun::new(scenario(text), 0);
        group.bench_function(name, |b| b.iter(|| Campaign::simulate(black_box(&run), ())));
    }
    group.finish();
}

fn log(c: &mut Criterion) {
    let mut group = c.benchmark_group("log");
    // 2000 s at 0.01 s: 200 000 instants with four messages each.
    let text = format!("{EVENTS}{WINDOWS}[log]\nperiod = 0.01\n").replace("20000.0", "2000.0");
    let full = scenario(&text);
    let run = CampaignRun::new(full.clone(), 0);
    group.sample_size(10).throughput(Throughput::Elements(4 * 200_000));
    group.bench_function("dense MCAP", |b| {
        b.iter(|| {
            let from = Campaign::provenance(&run);
            let mut log = LogBytes::new(&from, Detail::Full).expect("a log");
            simulate(&full, &mut log);
            log.finish(&Metrics::default(), RunEnd::Complete).expect("a log")
        });
    });
    group.finish();
}

/// A hub with a chain of springs whose masses all couple; benches/table.py solves the same matrices.
fn chain(order: usize) -> Structure {
    let mass = DMatrix::from_fn(order, order, |i, j| match (i, j) {
        (0, 0) => 1e9,
        (0, _) | (_, 0) => (i + j) as f64,
        _ => 1.0 / (1.0 + i.abs_diff(j) as f64),
    });
    let stiffness = DMatrix::from_fn(order, order, |i, j| match (i, j) {
        (0, _) | (_, 0) => 0.0,
        _ if i == j => 2000.0,
        _ if i.abs_diff(j) == 1 => -1000.0,
        _ => 0.0,
    });
    Structure::new(mass, stiffness, 0, None).expect("a structure")
}

fn structure(c: &mut Criterion) {
    let mut group = c.benchmark_group("structure");
    group.sample_size(10).measurement_time(Duration::from_secs(8));
    for order in [100, 1000] {
        let structure = chain(order);
        group.bench_with_input(BenchmarkId::from_parameter(order), &structure, |b, structure| {
            b.iter(|| black_box(structure).modes(HubState::Free, &[]).expect("modes"));
        });
    }
    group.finish();
}

/// The fitted set of \[Wheel11, Sukhanov\], figure 2.
const WHEEL: &str = include_str!("../scenarios/wheel-fast-mode.toml");

fn sampled_loop(c: &mut Criterion) {
    let mut group = c.benchmark_group("sampled loop");
    let window = SettlingWindow { band: 0.003, horizon: 400.0 };
    let looped = |text: &str| SampledLoop::from_scenario(&scenario(text)).expect("a loop").0;
    let (linear, shaped) = (looped(WHEEL), looped(&WHEEL.replace("back_emf", "dead_zone = 1e-3\nback_emf")));
    let ratios = [1.0; 4];
    group.bench_function("400 s", |b| {
        b.iter(|| DiscretePlant::new(black_box(&linear), &ratios).closed(0.0).settle(window));
    });
    let held = DiscretePlant::new(&linear, &ratios);
    group.bench_function("400 s, another gain", |b| b.iter(|| held.closed(black_box(1.2)).settle(window)));
    let held = DiscretePlant::new(&shaped, &ratios);
    group.bench_function("400 s, shaped command", |b| b.iter(|| held.closed(black_box(0.0)).settle(window)));
    group.bench_function("spectral radius", |b| b.iter(|| held.closed(black_box(0.0)).spectral_radius()));
    group.sample_size(10).measurement_time(Duration::from_secs(10));
    let (frequencies, periods) = (even(0.05, 0.5, 96), even(0.1, 2.0, 200));
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    group.bench_function("map of 96 x 200", |b| {
        b.iter(|| one.install(|| map(&linear, &frequencies, &periods, Scaling::All, |_| 0.0, window)));
    });
    // As the papers sample: every cell has the 1333 samples of 400 s.
    let periods = even(0.299, 0.301, 200);
    group.bench_function("map of 96 x 200, 0.3 s", |b| {
        b.iter(|| one.install(|| map(&linear, &frequencies, &periods, Scaling::All, |_| 0.0, window)));
    });
    group.finish();
}

/// The manoeuvre of the space station: 3500 cycles of its loop.
fn station(c: &mut Criterion) {
    let mut group = c.benchmark_group("station, 700 s");
    group.sample_size(20);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/iss-manoeuvre-off.toml");
    let shipped = Scenario::load(path.as_ref()).expect("shipped");
    for count in [12_usize, 135] {
        let mut table = shipped.to_table();
        let modes = table["body"]["spatial"]["modes"].as_array_mut().expect("modes");
        for index in modes.len()..count {
            let mut mode = modes[index % 12].clone();
            mode.as_table_mut().expect("a mode")["frequency"] = (8.0 + 0.1 * index as f64).into();
            modes.push(mode);
        }
        let scenario = scenario(&toml::to_string(&table).expect("TOML"));
        group.bench_with_input(BenchmarkId::from_parameter(count), &scenario, |b, scenario| {
            b.iter(|| simulate(black_box(scenario), &mut ()));
        });
    }
    let damped = scenario(include_str!("../scenarios/iss-manoeuvre.toml"));
    group.bench_function("damped", |b| b.iter(|| simulate(black_box(&damped), &mut ())));
    group.finish();
}

/// The Earth observer of four wheels, gyro, star tracker and attitude filter: fine pointing, its slew, and more modes.
fn observer(c: &mut Criterion) {
    let mut group = c.benchmark_group("spacecraft, 600 s");
    group.sample_size(20);
    let slew = scenario(include_str!("../scenarios/earth-observer.toml"));
    let mut table = slew.to_table();
    table.insert("duration".to_owned(), 600.0.into());
    let slew = scenario(&toml::to_string(&table).expect("TOML"));
    table.remove("target").expect("targets");
    let pointing = scenario(&toml::to_string(&table).expect("TOML"));
    group.bench_function("slew", |b| b.iter(|| simulate(black_box(&slew), &mut ())));
    group.bench_function("fine pointing", |b| b.iter(|| simulate(black_box(&pointing), &mut ())));
    for count in [8, 32, 128, 200] {
        let panel = |lowest: f64| -> toml::Value {
            let mode = |index: u32| {
                let (frequency, part) =
                    (lowest * (1.0 + 0.35 * f64::from(index)), 1.0 / f64::from(1 + index));
                let mode = format!(
                    "{{ frequency = {frequency}, damping = 0.005, translation = [0, 0, {}], rotation = [{}, 0, 0] }}",
                    2.2 * part,
                    3.2 * part
                );
                toml::from_str::<toml::Table>(&format!("mode = {mode}")).expect("a mode")["mode"].clone()
            };
            toml::Value::Array((0..count / 2).map(mode).collect())
        };
        let appendages = table["appendage"].as_array_mut().expect("appendages");
        for (appendage, lowest) in appendages.iter_mut().zip([1.1, 1.13]) {
            appendage.as_table_mut().expect("a table").insert("modes".to_owned(), panel(lowest));
        }
        let pointing = scenario(&toml::to_string(&table).expect("TOML"));
        group.bench_function(format!("fine pointing with {count} modes"), |b| {
            b.iter(|| simulate(black_box(&pointing), &mut ()));
        });
    }
    group.finish();
}

fn even(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low + (high - low) * i as f64 / (count - 1) as f64).collect()
}

/// Four claims about a body of the size of the space station's first Russian module: 135 modes from 0.62 to 61.3 rad/s.
fn bounded(inputs: &str, limit: f64) -> Scenario {
    let mode = |index: u32| {
        let part = f64::from(index) / 134.0;
        let (frequency, turn) = (0.62 * 98.9_f64.powf(part), f64::from(index) * 2.4);
        let shape = |phase: f64, size: f64| {
            let [x, y, z] = [0.0, 1.0, 2.0].map(|axis| size * (turn * (1.0 + axis) + phase).sin());
            format!("[{x:e}, {y:e}, {z:e}]")
        };
        format!(
            "{{ frequency = {frequency}, damping = 0.005, shapes = {{ jets = {{ rotation = {} }}, gyro = {{ rotation = {} }} }} }}",
            shape(0.3, 0.02),
            shape(1.1, 5e-6),
        )
    };
    let modes: Vec<String> = (0..135).map(mode).collect();
    scenario(&format!(
        "duration = 20.0\n[law.open]\n[sensor.gyro]\npoint = \"gyro\"\nperiod = 0.1\n[body.spatial]\n\
         inertia = [[1e8, 0, 0], [0, 1e8, 0], [0, 0, 1e8]]\npoints = [{{ name = \"jets\" }}, {{ name = \"gyro\" }}]\n\
         modes = [{}]\n[[bound]]\noutput = \"yaw_rate\"\nelastic = true\nlimits = [-{limit}, {limit}]\n\
         start = {{ displacements = [-1e-4, 1e-4], rates = [-1e-4, 1e-4] }}\n\
         {inputs} = {{ torque_roll = [0, 0.1], torque_pitch = [0.8, 1.0], torque_yaw = [0.9, 1.0] }}\n",
        modes.join(", ")
    ))
}

fn bound(c: &mut Criterion) {
    let mut group = c.benchmark_group("guaranteed range of 270 states over 20 s");
    for inputs in ["constant_inputs", "varying_inputs"] {
        for (limit, verdict) in [(1.0, "proved"), (1e-7, "violated")] {
            let scenario = bounded(inputs, limit);
            group.bench_function(BenchmarkId::new(inputs, verdict), |b| {
                b.iter(|| OutputBound::from_scenario(black_box(&scenario)).expect("a modal form"));
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    targets = run, lanes, modes, filters, log, structure, sampled_loop, station, observer, bound
}
criterion_main!(benches);
