//! The command `flexsc`: one file for each verb. Text goes to stderr, data to stdout.

mod answer;
mod at_rest;
mod axes_in_units;
mod bound;
mod budget;
mod campaign;
mod check;
mod choice;
mod compare;
mod confirm_cost;
mod cubesat;
mod cycle;
mod damping;
mod error;
mod examples;
mod export;
#[cfg_attr(not(feature = "flight-code"), path = "export_c/unavailable.rs")]
mod export_c;
#[cfg_attr(not(feature = "fmu"), path = "export_fmu/unavailable.rs")]
mod export_fmu;
mod figure_files;
pub mod figures;
mod files;
mod grid;
mod help;
mod human;
mod identify;
mod key_axis;
mod layout;
#[cfg_attr(not(feature = "live"), path = "live/unavailable.rs")]
mod live;
mod log;
mod logged_answer;
mod map;
mod margins;
mod memory_log;
mod merge;
mod modes;
mod number;
mod number_table;
mod observer;
mod out;
mod plan;
mod plot;
mod progress;
mod quantity;
mod report;
#[cfg_attr(not(feature = "papers"), path = "reproduce/unavailable.rs")]
mod reproduce;
mod required_limit;
mod requirements;
mod result_files;
mod results;
mod row_table;
mod runs_table;
mod sampled_loop;
mod scenario;
mod schema;
mod serve;
mod simulate;
mod spectrum;
mod stop;
mod success_rate;
mod sweep;
mod terminal;
mod top;
mod tune;
#[cfg(not(all(
    feature = "flight-code",
    feature = "fmu",
    feature = "handover",
    feature = "live",
    feature = "papers",
    feature = "png"
)))]
mod unavailable;
mod worst;

use std::ffi::OsString;
use std::io::Write;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

pub use budget::pointing_budget;
pub use campaign::file::{encode_table, table_ending};
pub use campaign::logs::simulate_to_log;
pub use campaign::part_files::write_statistics_of;
use error::CliError;
pub use error::NotReplaced;
pub use examples::EXAMPLES;
pub use human::Units;
pub use logged_answer::{LoggedRun, answer_of_log, run_of_log};
pub use progress::RunClock;
pub use report::EditableStudy;

/// Exact, fast and reproducible simulation of the attitude control of flexible spacecraft
#[derive(Parser)]
#[command(name = "flexsc", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Run scenarios, once each or as a Monte Carlo campaign
    Simulate(simulate::SimulateArgs),
    /// Run a scenario in lockstep with a control program
    ///
    /// At each sample of the law, the program gets a packet with the sensors and answers with the commands, over UDP or TCP. The log is that of the same commands in one process, byte for byte.
    Serve(serve::ServeArgs),
    /// Run a scenario over a grid or a sample of key values
    Sweep(sweep::SweepArgs),
    /// Merge parts of a campaign into one directory
    Merge(merge::MergeArgs),
    /// Show the progress and the statistics of a running campaign
    Top(top::TopArgs),
    /// Print the elastic modes of a spacecraft
    Modes(modes::ModesArgs),
    /// Print the limit cycles and resonances of a relay law
    ///
    /// In closed form, for the rigid body. A resonance is a gain at which an odd harmonic of the limit cycle matches a mode.
    Cycle(cycle::CycleArgs),
    /// Plan a manoeuvre without residual vibration, or compare plans
    Plan(plan::PlanArgs),
    /// Find keys with the largest margins, or gains of a sampled loop
    ///
    /// With --vary: keys of any linear law, for its margins, settling time or noise. Without: gains of the extra loop of a `pd` law about one axis, over the frequency of the dominant mode: a region, a schedule, or robust gains.
    Tune(tune::TuneArgs),
    /// Map the stability of a sampled loop
    ///
    /// Spectral radius and settling time over the frequency of the dominant mode and the sampling period.
    Map(map::MapArgs),
    /// Print the stability margins of a loop
    ///
    /// Gain, phase and delay at every crossing, modulus and disk margins, of each loop with the others closed and of all together.
    Margins(margins::MarginsArgs),
    /// Write a page for a design review
    ///
    /// Conclusions, requirements, spacecraft, time line, margins, noise and a campaign on one HTML page, with the command that repeats each.
    Report(report::ReportArgs),
    /// Print the noise of a loop: rms, density, pointing indices
    ///
    /// Exact from the closed loop, without a simulation: by source, over frequency, over windows, and the lines of unbalanced wheels over their speed.
    Spectrum(spectrum::SpectrumArgs),
    /// Print the pointing budget of a scenario's requirements
    ///
    /// Levels of each pointing index by a campaign, by convolution of the error sources, and by the rule of k sigma.
    Budget(budget::BudgetArgs),
    /// Prove that outputs of a body stay within limits
    ///
    /// Over sets of initial states, inputs in time, natural frequencies and damping ratios: guaranteed ranges, the first possible violation, and a witness, which `-o FILE.toml` writes as a scenario. The exit code is 3 if a claim is not proved.
    Bound(bound::BoundArgs),
    /// Search for the worst case over the uncertain keys
    ///
    /// Of the requirements, a metric or a stability margin: points spread over the ranges of `[uncertain]`, then a search from the worst of them. `-o FILE.toml` writes the worst point as a scenario. The exit code is 3 if a requirement is not met there.
    Worst(worst::WorstArgs),
    /// Analyse active damping by thrusters
    ///
    /// Which modes a thruster relay damps, how fast, and the limit cycle that a delay causes.
    Damping(damping::DampingArgs),
    /// Measure how well an adaptive observer identifies modes
    ///
    /// Success rate and time over many runs.
    Identify(identify::IdentifyArgs),
    /// Find the weights for which a modal observer converges
    Observer(observer::ObserverArgs),
    /// Plot a log, a campaign or a sweep
    Plot(plot::PlotArgs),
    /// Compare two scenarios, logs or campaigns: keys and answers
    ///
    /// The keys in which they differ, the answers side by side and, with -o, their figures one over the other.
    Compare(compare::CompareArgs),
    /// Reproduce the results of the papers on one HTML page
    Reproduce(reproduce::ReproduceArgs),
    /// Export a topic of a log as CSV or JSON
    Export(export::ExportArgs),
    /// Write the control system of a scenario as C99 or Rust
    ///
    /// Translated from the Rust code that runs call, with a driver, vectors of a run, and a Makefile that compares them by bits: relays, PD, phase-plane and attitude laws.
    ExportC(export_c::ExportCArgs),
    /// Record the calls of the control system in a run
    ///
    /// Inputs and outputs of each call, which the driver of `flexsc export-c` replays.
    Vectors(export_c::VectorsArgs),
    /// Export a scenario as an FMU for other simulators
    ///
    /// A Functional Mock-up Unit for co-simulation, FMI 3.0 with exact events or FMI 2.0: the closed loop, or the plant alone with torque commands as inputs.
    ExportFmu(export_fmu::ExportFmuArgs),
    /// Inspect a log, or recover an incomplete one
    Log(log::LogArgs),
    /// Write a viewer layout for a log or a scenario
    Layout(layout::LayoutArgs),
    /// Check scenario files without running them
    Check(check::CheckArgs),
    /// Create a scenario from a commented example
    New(examples::NewArgs),
    /// List the example scenarios, or copy some
    Examples(examples::ExamplesArgs),
    /// Print the JSON Schema of scenarios, or the list of metrics
    Schema(schema::SchemaArgs),
    /// Print a shell completion script
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// Returns the parser of the command line, for completions and tests.
pub fn command() -> clap::Command {
    help::completed(Cli::command())
}

/// Runs the command with these arguments, the program's name first, and returns its exit code: 0 done, 1 a run
/// failed or a file could not be written, 2 bad input, 3 a requirement is not met or a claim not proved, 130 interrupted.
pub fn main(args: impl IntoIterator<Item = OsString>) -> u8 {
    terminal::configure_colours();
    let parsed = command().try_get_matches_from(args);
    let cli = match parsed.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => cli,
        Err(mut error) => {
            help::suggest(&mut error);
            // A failure to write to stderr cannot be reported.
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    stop::run_watched(move || match execute(cli.verb) {
        Ok(()) => 0,
        Err(failure) => failure.print(),
    })
}

impl Verb {
    /// Returns the name of a verb that may take long and shows no progress of its own: a bar only on a terminal, or nothing.
    fn silent_name(&self) -> Option<&'static str> {
        match self {
            Self::Plan(_) => Some("plan"),
            Self::Tune(_) => Some("tune"),
            Self::Map(_) => Some("map"),
            Self::Margins(_) => Some("margins"),
            Self::Report(_) => Some("report"),
            Self::Spectrum(_) => Some("spectrum"),
            Self::Budget(_) => Some("budget"),
            Self::Bound(_) => Some("bound"),
            Self::Worst(_) => Some("worst"),
            Self::Damping(_) => Some("damping"),
            Self::Identify(_) if terminal::is_plain() => Some("identify"),
            Self::Observer(_) => Some("observer"),
            Self::Compare(_) => Some("compare"),
            Self::Plot(_) if terminal::is_plain() => Some("plot"),
            Self::Reproduce(_) if terminal::is_plain() => Some("reproduce"),
            Self::Export(_) => Some("export"),
            Self::ExportC(_) => Some("export-c"),
            Self::Vectors(_) => Some("vectors"),
            _ => None,
        }
    }
}

fn execute(verb: Verb) -> Result<(), CliError> {
    let _lines = verb.silent_name().map(progress::Heartbeat::start);
    match verb {
        Verb::Simulate(args) => simulate::run(&args),
        Verb::Serve(args) => serve::run(&args),
        Verb::Sweep(args) => sweep::run(&args),
        Verb::Merge(args) => merge::run(&args),
        Verb::Top(args) => top::run(&args),
        Verb::Modes(args) => modes::run(&args),
        Verb::Cycle(args) => cycle::run(&args),
        Verb::Plan(args) => plan::run(&args),
        Verb::Tune(args) => tune::run(&args),
        Verb::Map(args) => map::run(&args),
        Verb::Margins(args) => margins::run(&args),
        Verb::Report(args) => report::run(&args),
        Verb::Spectrum(args) => spectrum::run(&args),
        Verb::Budget(args) => budget::run(&args),
        Verb::Bound(args) => bound::run(&args),
        Verb::Worst(args) => worst::run(&args),
        Verb::Damping(args) => damping::run(&args),
        Verb::Identify(args) => identify::run(&args),
        Verb::Observer(args) => observer::run(&args),
        Verb::Plot(args) => plot::run(&args),
        Verb::Compare(args) => compare::run(&args),
        Verb::Reproduce(args) => reproduce::run(&args),
        Verb::Export(args) => export::run(&args),
        Verb::ExportC(args) => export_c::run(&args),
        Verb::Vectors(args) => export_c::run_vectors(&args),
        Verb::ExportFmu(args) => export_fmu::run(&args),
        Verb::Log(args) => log::run(&args),
        Verb::Layout(args) => layout::run(&args),
        Verb::Check(args) => check::run(&args),
        Verb::New(args) => examples::new(&args),
        Verb::Examples(args) => examples::run(&args),
        Verb::Schema(args) => schema::run(&args),
        Verb::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut command(), "flexsc", &mut script);
            print(&script)
        }
    }
}

/// Writes data to stdout.
fn print(data: &[u8]) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    out.write_all(data).and_then(|()| out.flush()).map_err(CliError::Stdout)
}

/// Writes a line of text to stderr.
macro_rules! say {
    ($($text:tt)*) => {
        // stderr may be closed; results go to stdout and to files.
        { let _ = writeln!(std::io::stderr().lock(), $($text)*); }
    };
}
pub(crate) use say;
