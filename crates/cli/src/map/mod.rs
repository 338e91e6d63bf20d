//! `flexsc map`: stability and settling over the frequency of the dominant mode and the sampling period.

mod figure;

use std::io::Write;
use std::path::PathBuf;

use flexsc_core::Scenario;
use flexsc_core::analysis::sampled_loop::{MapCell, SampledLoop, Scaling, map, spectral_radii};
use flexsc_core::control::law::Pd;
use flexsc_core::formats::count::counted;
use flexsc_figure::{Named, Point};
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::figure_files::{FigureChoice, FigureFormat, FigureOutput};
use crate::grid::{PositiveGrid, grid_in};
use crate::human::{Units, digits};
use crate::out::Out;
use crate::quantity::in_unit;
use crate::results::{Results, show};
use crate::sampled_loop::{SettlingArgs, sampled};
use crate::{files, print, say, scenario};

#[derive(clap::Args)]
pub struct MapArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    #[command(flatten)]
    settled: SettlingArgs,
    /// Frequencies of the dominant mode (rad/s)
    #[arg(long, value_name = "LO:HI:COUNT", value_parser = grid_in("rad/s"))]
    frequency: PositiveGrid,
    /// Sampling periods (s); the delay of the wheel scales with the period
    #[arg(long, value_name = "LO:HI:COUNT", value_parser = grid_in("s"))]
    period: PositiveGrid,
    /// Gain of the extra loop [default: the scenario's]
    #[arg(long, value_name = "GAIN", allow_hyphen_values = true, value_parser = in_unit(""))]
    gain: Option<f64>,
    /// Table as FILE.csv, or the map as FILE.svg, .png or .pdf, or in a directory, created if missing [default: print the table]
    #[arg(short, long, alias = "output", value_name = "FILE|DIR", conflicts_with = "json")]
    out: Option<PathBuf>,
    /// Plot the map: directory, created if missing, or one FILE.svg, .png or .pdf
    #[arg(long, value_name = "DIR|FILE")]
    figures: Option<PathBuf>,
    /// Format of the figures [default: svg and png, or by the extension of FILE]
    #[arg(long, value_enum, requires = "figures")]
    format: Option<FigureFormat>,
    /// Replace a FILE of other content
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    choice: FigureChoice,
}

/// Map of a scenario's sampled loop.
pub struct MapResults {
    /// Name of the scenario.
    name: String,
    cells: Vec<MapCell>,
    /// Frequency (rad/s) and period (s) of the scenario itself.
    own: Point,
    units: Units,
    family: LoopFamily,
}

/// Sampled loops of a scenario over the frequency of the dominant mode and the sampling period.
struct LoopFamily {
    of: SampledLoop,
    law: Pd,
    /// Gain of the extra loop in place of the scenario's.
    gain: Option<f64>,
    scaling: Scaling,
}

impl LoopFamily {
    /// Returns the gain of the extra loop at a frequency of the dominant mode (rad/s).
    fn gain(&self, frequency: f64) -> f64 {
        self.gain.unwrap_or_else(|| self.law.extra_gain(frequency))
    }

    /// Returns the spectral radii, a row for each frequency (rad/s), within it the periods (s).
    fn radii(&self, frequencies: &[f64], periods: &[f64]) -> Vec<f64> {
        spectral_radii(&self.of, frequencies, periods, self.scaling, |frequency| self.gain(frequency))
    }

    /// Returns the number of floating-point operations of about one spectral radius.
    fn cost(&self) -> f64 {
        // Angle and rate of each coordinate, the last measurement, and the commands under way.
        let order = 2.0 * (self.of.body.modes.len() as f64 + 2.0) + (self.of.delay / self.of.period).ceil();
        25.0 * order.powi(3)
    }
}

impl MapArgs {
    /// Computes the map of a scenario.
    pub fn results(&self, scenario: &Scenario) -> Result<MapResults, CliError> {
        let (sampled_loop, law) = sampled(scenario)?;
        let window = self.settled.window(&sampled_loop, &scenario.name)?;
        if let Some(gain) = self.gain.filter(|gain| !gain.is_finite()) {
            return Err(CliError::Arguments(format!("--gain must be a finite number, got {gain}")));
        }
        let (PositiveGrid(frequencies), PositiveGrid(periods)) = (&self.frequency, &self.period);
        let shortest = periods.iter().copied().fold(f64::INFINITY, f64::min);
        self.settled.check_cost(&sampled_loop, frequencies.len() * periods.len(), shortest, 0.0)?;
        let (name, own) = (scenario.name.clone(), (sampled_loop.frequency(), sampled_loop.period));
        let family = LoopFamily {
            of: sampled_loop,
            law: law.clone(),
            gain: self.gain,
            scaling: self.settled.scaling(),
        };
        let gain = |frequency: f64| family.gain(frequency);
        let cells = map(&family.of, frequencies, periods, family.scaling, gain, window);
        Ok(MapResults { name, cells, own, units: self.choice.units(), family })
    }
}

impl Results for MapResults {
    fn json(&self) -> Vec<Json> {
        vec![json!({"scenario": self.name, "rows": self.cells})]
    }

    fn figures(&self) -> Vec<Named> {
        vec![(format!("{}-map", self.name), figure::figure(self))]
    }

    fn print(&self) -> Result<(), CliError> {
        print(csv(&self.cells).as_bytes())?;
        self.print_summary("");
        Ok(())
    }
}

impl MapResults {
    /// Prints the ranges of the map and the stable cell that settles first; `place` names the file of the table.
    fn print_summary(&self, place: &str) {
        let Self { name, cells, own, units, .. } = self;
        let stable = || cells.iter().filter(|cell| cell.spectral_radius < 1.0);
        say!("{name}   {}, {} stable{place}", counted(cells.len(), "cell"), stable().count());
        let range = |value: fn(&MapCell) -> f64| {
            let values = || cells.iter().map(value);
            let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max));
            move |factor: f64| format!("{} to {}", digits(low * factor), digits(high * factor))
        };
        let (factor, unit) = units.frequency();
        let loop_at = |frequency: f64, period: f64| {
            format!("at {} {unit} and a period of {} s", digits(frequency * factor), digits(period))
        };
        say!("  frequency      {} {unit}", range(|cell| cell.frequency_rad_s)(factor));
        say!("  period         {} s", range(|cell| cell.period_s)(1.0));
        say!("  scenario       {}", loop_at(own.0, own.1));
        let settled = stable().filter_map(|cell| Some((cell.settling_s?, cell)));
        if let Some((time, cell)) = settled.min_by(|a, b| a.0.total_cmp(&b.0)) {
            say!("  settles first  in {} s {}", digits(time), loop_at(cell.frequency_rad_s, cell.period_s));
        }
    }
}

pub fn run(args: &MapArgs) -> Result<(), CliError> {
    let drawing = |figures: Option<&PathBuf>, format| FigureOutput {
        figures: figures.cloned(),
        format,
        force: args.force,
        choice: args.choice.clone(),
    };
    let also = drawing(args.figures.as_ref(), args.format);
    let input = args.scenario.scenario.as_path();
    if args.out.is_none() || args.figures.is_some() {
        also.check(input)?;
    }
    let Some(out) = &args.out else {
        return show(&args.results(&args.scenario.load()?)?, Some(&also), args.scenario.json);
    };
    let out = Out::new(out, &["csv", "svg", "png", "pdf"], &[input])?;
    let mapped = args.results(&args.scenario.load()?)?;
    also.save(|| mapped.figures())?;
    let path = match &out {
        Out::File(path, "csv") => path,
        Out::File(path, _) | Out::Directory(path) => {
            return drawing(Some(path), None).save(|| mapped.figures());
        }
    };
    files::write(path, csv(&mapped.cells).as_bytes(), args.force)?;
    mapped.print_summary(&format!(", in {}", path.display()));
    Ok(())
}

fn csv(cells: &[MapCell]) -> String {
    let head = "frequency_rad_s,period_s,spectral_radius,settling_s,itae_rad_s2\n".to_owned();
    let row = |cell: &MapCell| {
        let settling = cell.settling_s.map_or(String::new(), |time| time.to_string());
        let MapCell { frequency_rad_s, period_s, spectral_radius, itae_rad_s2, .. } = cell;
        format!("{frequency_rad_s},{period_s},{spectral_radius:e},{settling},{itae_rad_s2:e}\n")
    };
    std::iter::once(head).chain(cells.iter().map(row)).collect()
}
