//! `flexsc map`: stability and settling over the frequency of the dominant mode and the period of the samples.

mod figure;

use std::io::Write;
use std::path::PathBuf;

use flexsc_core::analysis::sampled_loop::{Cell, map};
use flexsc_core::whole;
use serde_json::json;

use crate::failure::Failure;
use crate::figure::Drawing;
use crate::grid::Even;
use crate::tune::{Settled, sampled};
use crate::{print, say, scenario};

pub use figure::figure;

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    scenario: scenario::Args,
    #[command(flatten)]
    settled: Settled,
    /// Frequencies of the dominant mode (rad/s)
    #[arg(long, value_name = "LO:HI:N")]
    frequency: Even,
    /// Periods of the samples (s); a delay of the wheel keeps its part of the period
    #[arg(long, value_name = "LO:HI:N")]
    period: Even,
    /// Gain of the extra loop; left out, the scenario's
    #[arg(long, value_name = "GAIN", allow_hyphen_values = true)]
    gain: Option<f64>,
    /// CSV file to write; left out, the table is printed
    #[arg(short, long, value_name = "FILE", conflicts_with = "json")]
    output: Option<PathBuf>,
    #[command(flatten)]
    drawing: Drawing,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = args.scenario.load()?;
    let (of, law) = sampled(&scenario)?;
    let window = args.settled.window(&of, &scenario.name)?;
    if let Some(gain) = args.gain.filter(|gain| !gain.is_finite()) {
        return Err(Failure::Arguments(format!("--gain must be a finite number, got {gain}")));
    }
    let (Even(frequencies), Even(periods)) = (&args.frequency, &args.period);
    let gain = |frequency: f64| args.gain.unwrap_or_else(|| law.extra_gain(frequency));
    let cells = map(&of, frequencies, periods, args.settled.scaling(), gain, window);
    if let Some(directory) = &args.drawing.figures {
        figure::save(&scenario.name, &cells, (of.frequency(), of.period), directory, args.drawing.format)?;
    }
    if args.scenario.json {
        return print(format!("{}\n", json!({"scenario": scenario.name, "rows": cells})).as_bytes());
    }
    let table = csv(&cells);
    let Some(path) = &args.output else { return print(table.as_bytes()) };
    whole::write(path, table.as_bytes()).map_err(Failure::write(path))?;
    let stable = cells.iter().filter(|cell| cell.spectral_radius < 1.0).count();
    say!("{}   {} cells, {stable} of them stable, in {}", scenario.name, cells.len(), path.display());
    Ok(())
}

fn csv(cells: &[Cell]) -> String {
    let head = "frequency_rad_s,period_s,spectral_radius,settling_s,itae_rad_s2\n".to_owned();
    let row = |cell: &Cell| {
        let settling = cell.settling_s.map_or(String::new(), |time| time.to_string());
        let Cell { frequency_rad_s, period_s, spectral_radius, itae_rad_s2, .. } = cell;
        format!("{frequency_rad_s},{period_s},{spectral_radius:e},{settling},{itae_rad_s2:e}\n")
    };
    std::iter::once(head).chain(cells.iter().map(row)).collect()
}
