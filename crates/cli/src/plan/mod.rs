//! `flexsc plan`: the plan of a scenario's manoeuvre, its figures, and how it stands in the field.

mod family;
mod figures;
mod table;

pub use family::Family;
pub use figures::all as figures;

use std::borrow::Cow;
use std::io::Write;
use std::path::PathBuf;

use flexsc_core::body::{Drive, Planar};
use flexsc_core::manoeuvre::{Common, Manoeuvre, Plan, Report, Row, compare};
use flexsc_core::quantity::{Fraction, Positive};
use flexsc_core::{Scenario, ScenarioError};
use serde_json::json;

use crate::failure::Failure;
use crate::figure::Format;
use crate::{print, say, scenario};

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    scenario: scenario::Args,
    /// Compare with every other command on the same body; JSON lines with --json
    #[arg(long, group = "views")]
    compare: bool,
    /// How far off the frequencies may be, relative to them
    #[arg(long, default_value_t = 0.1, value_name = "PART")]
    band: f64,
    /// Plan for this peak torque (N m), each command in its own time, instead of the scenario's time
    #[arg(long, value_name = "TORQUE")]
    peak_torque: Option<f64>,
    /// Draw the command beside those that suppress fewer modes, or the rigid bang-bang, into this directory, made if it is
    /// not there
    #[arg(long, value_name = "DIR", group = "views")]
    figures: Option<PathBuf>,
    /// Form of the figures
    #[arg(long, value_enum, default_value = "both", requires = "figures")]
    format: Format,
    /// The coordinate that a comparison and figures show: `angle` or an output; the last output if left out
    #[arg(long, value_name = "NAME", requires = "views")]
    output: Option<String>,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = args.scenario.load()?;
    let body = scenario.one_angle()?;
    let (Some(manoeuvre), Some(plan)) = (&scenario.manoeuvre, &scenario.plan) else {
        return Err(Failure::Arguments(format!("{}: there is no `[manoeuvre]` to plan", scenario.name)));
    };
    if Fraction::new(args.band).is_none() {
        return Err(Failure::Arguments(format!("--band must be between 0 and 1, got {}", args.band)));
    }
    let limit = match args.peak_torque.map(|peak| Positive::new(peak).ok_or(peak)) {
        Some(Err(peak)) => {
            return Err(Failure::Arguments(format!("--peak-torque must be a positive number, got {peak}")));
        }
        Some(Ok(limit)) => Some(limit),
        None => None,
    };
    let shown = chosen(args.output.as_deref(), body)?;
    if args.compare {
        let common = Common::of(manoeuvre, limit, plan);
        let rows = compare(manoeuvre, common, scenario.planned_for(), args.band);
        if args.scenario.json {
            return lines(&rows);
        }
        table::tell(&scenario.name, body, args.band, shown, common, &rows);
        return Ok(());
    }
    let plan: Cow<Plan> = match limit {
        None => Cow::Borrowed(plan),
        Some(limit) => {
            let slower = Manoeuvre { time: None, peak_torque: Some(limit), ..manoeuvre.clone() };
            let refused = |(_, why): (String, String)| ScenarioError::Key {
                origin: scenario.name.clone(),
                key: "--peak-torque".to_owned(),
                why,
            };
            Cow::Owned(slower.plan(scenario.planned_for()).map_err(refused)?)
        }
    };
    let report = Report::new(&plan, body, args.band);
    if let Some(directory) = &args.figures {
        let family = Family::new(&scenario.name, body, &plan, manoeuvre, scenario.planned_for(), shown);
        figures::save(&family, args.band, directory, args.format)?;
    }
    if args.scenario.json {
        let mut object = json!({"scenario": scenario.name, "command": manoeuvre.command.kind()});
        if let (Some(object), serde_json::Value::Object(told)) =
            (object.as_object_mut(), report.to_json(&plan, body))
        {
            object.extend(told);
        }
        return print(format!("{object}\n").as_bytes());
    }
    tell(&scenario, manoeuvre, &plan, &report, body);
    Ok(())
}

fn lines(rows: &[Row]) -> Result<(), Failure> {
    let lines: Vec<String> = rows.iter().map(|row| row.to_json().to_string()).collect();
    print(format!("{}\n", lines.join("\n")).as_bytes())
}

fn tell(scenario: &Scenario, manoeuvre: &Manoeuvre, plan: &Plan, report: &Report, body: &Planar) {
    let (angle, time) = (plan.angle, plan.time);
    let kind = manoeuvre.command.kind().replace('_', " ");
    let shaped = if manoeuvre.shaper.is_some() { ", shaped" } else { "" };
    say!("{}   {angle} rad in {time:.9} s by {kind}{shaped}", scenario.name);
    if plan.start_rate != 0.0 || plan.end_rate != 0.0 {
        say!("  rates            {} -> {} rad/s", plan.start_rate, plan.end_rate);
    }
    let unit = if body.drive == Drive::Motion { "rad/s²" } else { "N m" };
    if let Some(c) = &plan.coefficients {
        let list = |c: &[f64]| c.iter().map(|c| format!("{c:.9}")).collect::<Vec<_>>().join(", ");
        say!("  coefficients     {} {unit}", list(&c.odd));
        if !c.even.is_empty() || c.constant != 0.0 {
            say!("  even, constant   {}; {:.9} {unit}", list(&c.even), c.constant);
        }
    }
    let torque = &report.torque;
    say!("  peak torque      {:.6} N m at {:.6} s", torque.peak.value, torque.peak.time);
    say!("  root mean square {:.6} N m", torque.rms);
    say!("  square integral  {:.6e} N² m² s", torque.square);
    say!("  torque at start  {:.6} N m", torque.initial);
    say!("  hub at the end   {:.3e} rad, {:.3e} rad/s off", report.angle_error, report.rate_error);
    say!("  energy left      {:.4e} J", report.energy);
    say!(
        "  {:<16} {:>12}{:>12}{:>12}{:>14}{:>12}",
        "coordinate",
        "left",
        "worst 5 %",
        format!("worst {} %", percent(report.band)),
        "deflection",
        "at"
    );
    for (left, deflection) in report.residuals.iter().zip(&report.deflections) {
        say!(
            "  {:<16} {:>12.3e}{:>12.3e}{:>12.3e}{:>14.6e}{:>10.4} s   {}",
            left.name,
            left.nominal,
            left.near,
            left.worst,
            deflection.value,
            deflection.time,
            left.unit,
        );
    }
    let both = |(below, above): (Option<f64>, f64)| match below {
        Some(below) => format!("{below:.6} or {above:.6} s"),
        None => format!("{above:.6} s"),
    };
    for tuned in &report.tuned {
        let cosine =
            tuned.cosine.map_or(String::new(), |times| format!(", a single cosine in {}", both(times)));
        say!("  mode {} rests after a single sine in {}{cosine}", tuned.mode, both(tuned.sine));
    }
}

fn percent(band: f64) -> f64 {
    // Free of the last digits that the product with 100 brings.
    (band * 1e8).round() / 1e6
}

/// The index of the coordinate that is shown: the chosen one, else the last output, else the hub's angle.
fn chosen(output: Option<&str>, body: &Planar) -> Result<usize, Failure> {
    let names: Vec<&str> =
        std::iter::once("angle").chain(body.outputs.iter().map(|output| output.name.as_str())).collect();
    let Some(chosen) = output else { return Ok(names.len() - 1) };
    names.iter().position(|name| *name == chosen).ok_or_else(|| {
        Failure::Arguments(format!("--output must be one of {}, got {chosen}", names.join(", ")))
    })
}
