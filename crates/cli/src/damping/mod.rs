//! `flexsc damping`: the effect of a relay of thrusters on elastic modes, over their natural frequency.

mod figures;

use std::io::Write;

use flexsc_core::analysis::damping::{DampedMode, PulsedDamping};
use flexsc_core::control::actuator::PulseTiming;
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::grid::{PositiveGrid, grid_in};
use crate::human::{Units, digits};
use crate::number_table::NumberTable;
use crate::quantity::in_unit;
use crate::result_files::ResultOutput;
use crate::results::{Results, show};
use crate::row_table::{Column, column, print_rows};
use crate::say;

#[derive(clap::Args)]
#[command(allow_negative_numbers = true)]
pub struct DampingArgs {
    /// Natural frequencies of the modes (rad/s)
    #[arg(long, value_name = "LO:HI:COUNT", value_parser = grid_in("rad/s"))]
    frequency: PositiveGrid,
    /// Elastic acceleration of a push: the thrusters' rigid one times their influence on the mode (rad/s²)
    #[arg(long, value_name = "ACCELERATION", value_parser = in_unit("rad/s²"))]
    acceleration: f64,
    /// Sampling period (s); 0 for a continuous relay
    #[arg(long, value_name = "TIME", default_value_t = 0.2, value_parser = in_unit("s"))]
    period: f64,
    /// Delay from a sample to its push (s)
    #[arg(long, value_name = "TIME", default_value_t = 0.0, value_parser = in_unit("s"))]
    delay: f64,
    /// Duration of a push (s) [default: the whole period]
    #[arg(long, value_name = "TIME", value_parser = in_unit("s"))]
    on_time: Option<f64>,
    /// Damping ratio of the modes
    #[arg(long, value_name = "RATIO", default_value_t = 0.005, value_parser = in_unit(""))]
    damping: f64,
    /// Amplitude of the elastic rate at the start, for the time of its decay (rad/s)
    #[arg(long, value_name = "RATE", value_parser = in_unit("rad/s"))]
    amplitude: Option<f64>,
    /// Amplitude below which no thruster fires (rad/s)
    #[arg(long, value_name = "RATE", default_value_t = 0.0, requires = "amplitude", value_parser = in_unit("rad/s"))]
    threshold: f64,
    #[command(flatten)]
    output: ResultOutput,
    /// Print one JSON object to stdout
    #[arg(long)]
    json: bool,
}

/// Columns of the text.
const COLUMNS: [Column<'_>; 9] = [
    column("frequency_rad_s", "frequency"),
    column("phase_factor", "part"),
    column("slope_rad_s2", "slope"),
    column("delay_limit_s", "delay limit"),
    column("gain_limit_1_s", "gain limit"),
    column("limit_cycle_rate_rad_s", "cycle"),
    column("limit_cycle_frequency_rad_s", "at"),
    column("decay_s", "decay"),
    column("thrust_s", "thrust"),
];

/// Effect of a relay of thrusters on elastic modes.
pub struct DampingResults {
    timing: PulseTiming,
    /// Frequency above which the relay excites the modes (rad/s).
    limit: f64,
    rows: Vec<DampedMode>,
    units: Units,
}

impl DampingArgs {
    /// Computes the effect of the relay on the modes.
    pub fn results(&self) -> Result<DampingResults, CliError> {
        let timing = PulseTiming {
            period: self.period,
            delay: self.delay,
            on_time: self.on_time.unwrap_or(self.period),
        };
        let pulsed = PulsedDamping {
            timing,
            damping: self.damping,
            acceleration: self.acceleration,
            amplitude: self.amplitude.unwrap_or(0.0),
            threshold: self.threshold,
        };
        if let Some((name, why)) = pulsed.inconsistency() {
            return Err(CliError::Arguments(format!("--{} {why}", name.replace('_', "-"))));
        }
        let PositiveGrid(frequencies) = &self.frequency;
        if let Some(why) = pulsed.beyond(frequencies) {
            return Err(CliError::Arguments(format!("a push {why}; see --frequency, --period and --delay")));
        }
        let mut rows = pulsed.table(frequencies);
        if self.amplitude.is_none() {
            for row in &mut rows {
                (row.decay_s, row.thrust_s) = (None, None);
            }
        }
        Ok(DampingResults {
            timing,
            limit: timing.frequency_limit(),
            rows,
            units: self.output.choice.units(),
        })
    }
}

pub fn run(args: &DampingArgs) -> Result<(), CliError> {
    let target = args.output.target(&[])?;
    let results = args.results()?;
    if let Some(target) = target {
        target.save(&results)?;
    }
    show(&results, None, args.json)
}

impl Results for DampingResults {
    fn json(&self) -> Vec<Json> {
        // Infinite values are null in JSON.
        vec![json!({"frequency_limit_rad_s": self.limit, "rows": self.rows})]
    }

    fn figures(&self) -> Vec<Named> {
        vec![("damping".to_owned(), figures::figure(&self.rows, self.limit))]
    }

    fn table(&self) -> Option<NumberTable> {
        Some(NumberTable::from_rows(&self.rows))
    }

    fn print(&self) -> Result<(), CliError> {
        let PulseTiming { period, delay, on_time } = self.timing;
        let (factor, unit) = self.units.frequency();
        let damps = if self.limit.is_finite() {
            format!("damps below {} {unit}", digits(self.limit * factor))
        } else {
            "damps every frequency".to_owned()
        };
        let [period, delay, on_time] = [period, delay, on_time].map(digits);
        if self.timing.period > 0.0 {
            say!("relay   a push of {on_time} s each {period} s, {delay} s after its sample: {damps}");
        } else {
            say!("relay   all the time, {delay} s late: {damps}");
        }
        print_rows(&self.rows, &COLUMNS, self.units);
        Ok(())
    }
}
