//! `flexsc identify`: success rate and speed of an adaptive observer's identification of elastic modes.

mod figures;

use std::f64::consts::TAU;
use std::io::Write;
use std::str::FromStr;

use flexsc_core::analysis::identification::{CYCLE, IdentificationRow, IdentificationTrial};
use flexsc_core::formats::count::counted;
use flexsc_core::numerics::quantity::NonNegative;
use flexsc_figure::Named;
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::human::Units;
use crate::quantity::in_unit;
use crate::results::{Results, show};
use crate::row_table::{Column, column, print_rows};
use crate::{progress, say};

/// Default sets: those of the study behind \[Timakov14\]'s scenarios, in hertz, each with its identification rate.
const SETS: [(&[(f64, f64)], f64); 6] = [
    (&[(0.2476, 2.89)], 0.02),
    (&[(0.2476, 2.89), (0.6, 3.0)], 0.02),
    (&[(0.2, 2.0), (0.5, 3.0), (1.1, 3.0)], 0.02),
    (&[(0.48, 2.0), (0.6, 3.0)], 0.02),
    (&[(0.55, 3.0), (0.605, 3.0)], 0.01),
    (&[(0.6049, 1.5), (0.6096, 1.6)], 0.01),
];

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub struct IdentifyArgs {
    /// A set of modes by frequency (rad/s) and influence, such as 1.556:2.89,3.77:3.0; may be repeated. Left out, those of
    /// the space station's study
    #[arg(long, value_name = "W:MU,...")]
    modes: Vec<ModeSet>,
    /// Relative errors of the frequencies at the start
    #[arg(long, value_delimiter = ',', default_value = "0.05,0.1,0.2,0.3", value_name = "PARTS", value_parser = in_unit(""))]
    off: Vec<f64>,
    /// Relative error of the influences at the start
    #[arg(long, default_value_t = 0.4, value_name = "PART", value_parser = in_unit(""))]
    influence_off: f64,
    /// Runs of each row
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    runs: u64,
    /// Rate of the identification of the given modes
    #[arg(long, default_value = "0.02", requires = "modes", value_parser = in_unit(""))]
    rate: f64,
    /// Cycles of a run, of 0.2 s
    #[arg(long, default_value_t = 1500, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    cycles: u32,
    /// Seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    drawing: FigureOutput,
    /// Print one JSON object on stdout
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    consent: CostConfirmation,
}

/// Frequency and influence of each mode of a set.
#[derive(Clone, Debug)]
struct ModeSet(Vec<(f64, f64)>);

/// Results for a set of modes, with a row for each initial error.
struct ModeSetResults {
    /// Frequency (rad/s) and influence of each mode.
    modes: Vec<(f64, f64)>,
    rows: Vec<IdentificationRow>,
}

impl ModeSetResults {
    /// Returns the frequencies as text, in units of rad/s times a factor.
    fn frequencies(&self, factor: f64) -> String {
        let names: Vec<String> = self.modes.iter().map(|(w, _)| format!("{:.4}", w * factor)).collect();
        names.join(" + ")
    }
}

/// Results for all sets.
pub struct IdentifyResults {
    sets: Vec<ModeSetResults>,
    /// Number of runs in each row.
    runs: u64,
    /// Duration of each run (s).
    whole: f64,
    /// Relative error of the influences.
    influence_off: f64,
    units: Units,
}

impl FromStr for ModeSet {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mode = |part: &str| {
            let form = || format!("must be W:MU,W:MU,... with numbers, got {text}");
            let (w, mu) = part.split_once(':').ok_or_else(form)?;
            Ok((in_unit("rad/s")(w)?, in_unit("")(mu)?))
        };
        text.split(',').map(mode).collect::<Result<_, String>>().map(Self)
    }
}

impl IdentifyArgs {
    /// Runs the trials of the observer.
    pub fn results(&self) -> Result<IdentifyResults, CliError> {
        let shipped =
            SETS.iter().map(|(modes, rate)| (modes.iter().map(|(f, mu)| (TAU * f, *mu)).collect(), *rate));
        let mode_sets: Vec<(Vec<(f64, f64)>, f64)> = if self.modes.is_empty() {
            shipped.collect()
        } else {
            self.modes.iter().map(|ModeSet(modes)| (modes.clone(), self.rate)).collect()
        };
        let Some(rate) = NonNegative::new(self.rate) else {
            return Err(CliError::Arguments(format!("--rate must be 0 or more, got {}", self.rate)));
        };
        let modes: usize = mode_sets.iter().map(|(modes, _)| modes.len() * modes.len()).sum();
        self.consent.check(&IdentificationTrial::cost(
            self.off.len() as f64 * self.runs as f64,
            self.cycles,
            modes as f64,
        ))?;
        let mut sets = Vec::new();
        let bar = progress::bar((mode_sets.len() * self.off.len()) as u64, "rows");
        for (modes, rate_of_set) in mode_sets {
            let mut rows = Vec::new();
            for off in &self.off {
                let mut trial = IdentificationTrial::published(modes.clone(), *off);
                trial.observer.rate = NonNegative::new(rate_of_set).unwrap_or(rate);
                (trial.off[1], trial.cycles, trial.seed) = (self.influence_off, self.cycles, self.seed);
                if let Some((name, why)) = trial.inconsistency() {
                    return Err(CliError::Arguments(format!(
                        "--{}: the modes {why}",
                        name.replace('_', "-")
                    )));
                }
                rows.push(trial.table(self.runs));
                bar.inc(1);
            }
            sets.push(ModeSetResults { modes, rows });
        }
        bar.finish_and_clear();
        let (runs, whole) = (self.runs, CYCLE * f64::from(self.cycles));
        Ok(IdentifyResults {
            sets,
            runs,
            whole,
            influence_off: self.influence_off,
            units: self.drawing.choice.units(),
        })
    }
}

pub fn run(args: &IdentifyArgs) -> Result<(), CliError> {
    show(&args.results()?, Some(&args.drawing), args.json)
}

/// Row of the trials from one initial error.
#[derive(Serialize)]
struct TrialRow<'a> {
    frequencies_rad_s: Vec<f64>,
    influences: Vec<f64>,
    found: &'a IdentificationRow,
}

/// Columns of the text.
const COLUMNS: [Column<'_>; 9] = [
    column("frequencies_rad_s", "frequencies"),
    column("found.off", "off by").percent(),
    column("found.converged", "found"),
    column("found.runs", "of runs"),
    column("found.time_median_s", "median"),
    column("found.time_longest_s", "longest"),
    column("found.frequency_error", "frequency"),
    column("found.influence_error", "influence"),
    column("found.persistence", "persistence"),
];

impl IdentifyResults {
    /// Returns the rows of all sets.
    fn rows(&self) -> Vec<TrialRow<'_>> {
        let each = self.sets.iter().flat_map(|set| set.rows.iter().map(move |found| (set, found)));
        each.map(|(ModeSetResults { modes, .. }, found)| TrialRow {
            frequencies_rad_s: modes.iter().map(|mode| mode.0).collect(),
            influences: modes.iter().map(|mode| mode.1).collect(),
            found,
        })
        .collect()
    }
}

impl Results for IdentifyResults {
    fn json(&self) -> Vec<Json> {
        vec![json!({"rows": self.rows()})]
    }

    fn figures(&self) -> Vec<Named> {
        vec![("identification".to_owned(), figures::figure(&self.sets, self.whole))]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { runs, whole, influence_off, units, .. } = self;
        say!(
            "identification   {} of {whole:.0} s a row; influences off by {} %; found is within 2 %",
            counted(runs, "run"),
            100.0 * influence_off
        );
        print_rows(&self.rows(), &COLUMNS, *units);
        Ok(())
    }
}
