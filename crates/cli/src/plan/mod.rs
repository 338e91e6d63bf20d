//! `flexsc plan`: the plan of a scenario's manoeuvre, its figures, and its comparison with all other commands.

mod alternatives;
mod family;
mod figures;
mod planned;
mod trajectory;

use std::path::PathBuf;

use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::numerics::quantity::{Fraction, Positive};
use flexsc_core::spacecraft::manoeuvre::{ComparisonBasis, Manoeuvre, PlanReport, compare};
use flexsc_core::{Scenario, ScenarioError};

use crate::error::CliError;
use crate::figure_files::{FigureChoice, FigureFormat};
use crate::quantity::in_unit;
use crate::result_files::{ResultOutput, ResultTarget};
use crate::results::{Results, show};
use crate::scenario;
use alternatives::AlternativesResults;
use planned::PlanResults;

#[derive(clap::Args)]
pub struct PlanArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Compare with all other commands for the same body; JSON lines with --json
    #[arg(long, group = "views")]
    compare: bool,
    /// Largest relative error of the frequencies to allow for
    #[arg(long, default_value_t = 0.1, value_name = "PART", value_parser = in_unit(""))]
    band: f64,
    /// Plan for this peak torque (N m) instead of the scenario's time
    #[arg(long, value_name = "TORQUE", value_parser = in_unit("N m"))]
    peak_torque: Option<f64>,
    /// Plot the command with those that suppress fewer modes, or with the rigid bang-bang: directory, created if missing, or
    /// one FILE.svg, .png or .pdf. FILE.csv: write the planned trajectory as a table
    #[arg(short = 'o', long = "out", visible_alias = "figures", value_name = "DIR|FILE", group = "views")]
    out: Option<PathBuf>,
    /// Format of the figures [default: svg and png, or by the extension of FILE]
    #[arg(long, value_enum, requires = "out")]
    format: Option<FigureFormat>,
    /// Replace a FILE of other content
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    choice: FigureChoice,
    /// Coordinate to compare and to plot: `angle` or an output [default: the last output]
    #[arg(long, alias = "output", value_name = "NAME", requires = "views")]
    coordinate: Option<String>,
}

impl PlanArgs {
    /// Computes the plan of a scenario's manoeuvre, or its comparison with all other commands.
    pub fn results(&self, scenario: Scenario) -> Result<Box<dyn Results>, CliError> {
        let body = scenario.one_angle()?.clone();
        let (Some(manoeuvre), Some(plan)) = (scenario.manoeuvre.clone(), scenario.plan.clone()) else {
            return Err(CliError::Arguments(format!("{}: there is no `[manoeuvre]` to plan", scenario.name)));
        };
        let band = self.band;
        if Fraction::new(band).is_none() {
            return Err(CliError::Arguments(format!("--band must be between 0 and 1, got {band}")));
        }
        let limit = self.limit()?;
        let shown = chosen(self.coordinate.as_deref(), &body)?;
        let model = manoeuvre.planned_for(&body).into_owned();
        let name = scenario.written.name;
        let units = self.choice.units();
        if self.compare {
            let common = ComparisonBasis::from_manoeuvre(&manoeuvre, limit, &plan);
            let rows = compare(&manoeuvre, common, &model, band);
            return Ok(Box::new(AlternativesResults { name, body, band, shown, common, rows, units }));
        }
        let plan = if limit.is_some() {
            let slower = Manoeuvre { time: None, peak_torque: limit, ..manoeuvre.clone() };
            let refused = |fault: ConfigError| ScenarioError::Key {
                origin: name.clone(),
                key: "--peak-torque".to_owned(),
                why: fault.why,
            };
            slower.plan(&model).map_err(refused)?
        } else {
            plan
        };
        let report = PlanReport::new(&plan, &body, band);
        Ok(Box::new(PlanResults { name, body, model, manoeuvre, plan, report, shown, units }))
    }

    /// Returns the peak torque that is planned for, if given.
    fn limit(&self) -> Result<Option<Positive>, CliError> {
        let Some(peak) = self.peak_torque else { return Ok(None) };
        let limit = Positive::new(peak).ok_or_else(|| {
            CliError::Arguments(format!("--peak-torque must be a positive number, got {peak}"))
        })?;
        Ok(Some(limit))
    }
}

pub fn run(args: &PlanArgs) -> Result<(), CliError> {
    let output = ResultOutput {
        out: args.out.clone(),
        format: args.format,
        force: args.force,
        choice: args.choice.clone(),
    };
    let target = output.target(&[args.scenario.scenario.as_path()])?;
    if args.coordinate.is_some() && matches!(target, Some(ResultTarget::Table { .. })) {
        let why = "--coordinate: the table has every coordinate\n\nhint: leave out --coordinate";
        return Err(CliError::Arguments(why.to_owned()));
    }
    let results = args.results(args.scenario.load()?)?;
    if let Some(target) = target {
        target.save(&*results)?;
    }
    show(&*results, None, args.scenario.json)
}

fn percent(band: f64) -> f64 {
    // Rounded, to remove the last digits of the product with 100.
    (band * 1e8).round() / 1e6
}

/// Returns the index of the shown coordinate: the chosen one, else the last output, else the hub's angle.
fn chosen(coordinate: Option<&str>, body: &AxisModel) -> Result<usize, CliError> {
    let names: Vec<&str> =
        std::iter::once("angle").chain(body.outputs.iter().map(|output| output.name.as_str())).collect();
    let Some(chosen) = coordinate else { return Ok(names.len() - 1) };
    names.iter().position(|name| *name == chosen).ok_or_else(|| {
        CliError::Arguments(format!("--coordinate must be one of {}, got {chosen}", names.join(", ")))
    })
}
