//! `flexsc plan`: the plan of a scenario's manoeuvre, and how it stands in the field.

use std::borrow::Cow;
use std::io::Write;

use flexsc_core::body::{Drive, Planar};
use flexsc_core::manoeuvre::{Common, Manoeuvre, Plan, Report, Row, compare};
use flexsc_core::quantity::{Fraction, Positive};
use flexsc_core::{Scenario, ScenarioError};
use serde_json::json;

use crate::failure::Failure;
use crate::{print, say, scenario};

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    scenario: scenario::Args,
    /// Compare with every other command on the same body; JSON lines with --json
    #[arg(long)]
    compare: bool,
    /// How far off the frequencies may be, relative to them
    #[arg(long, default_value_t = 0.1, value_name = "PART")]
    band: f64,
    /// Plan for this peak torque (N m), each command in its own time, instead of the scenario's time
    #[arg(long, value_name = "TORQUE")]
    peak_torque: Option<f64>,
    /// The coordinate whose residuals a comparison shows: `angle` or an output; the last output if left out
    #[arg(long, value_name = "NAME", requires = "compare")]
    output: Option<String>,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = args.scenario.load()?;
    let body = &scenario.model;
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
    if args.compare {
        let common = Common::of(manoeuvre, limit, plan);
        let rows = compare(manoeuvre, common, scenario.planned_for(), args.band);
        return if args.scenario.json {
            lines(&rows)
        } else {
            table(args, &scenario.name, body, common, &rows)
        };
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

fn table(args: &Args, name: &str, body: &Planar, common: Common, rows: &[Row]) -> Result<(), Failure> {
    let last = body.outputs.last().map_or("angle", |output| &output.name);
    let chosen = args.output.as_deref().unwrap_or(last);
    let names: Vec<&str> =
        std::iter::once("angle").chain(body.outputs.iter().map(|output| output.name.as_str())).collect();
    let Some(column) = names.iter().position(|name| *name == chosen) else {
        let why = format!("--output must be one of {}, got {chosen}", names.join(", "));
        return Err(Failure::Arguments(why));
    };
    match common {
        Common::Time(time) => say!("{name}   every command in {} s", time.seconds()),
        Common::PeakTorque(peak) => say!("{name}   every command at a peak of {} N m", peak.get()),
    }
    let (band, hub) = (percent(args.band), "angle");
    say!(
        "  {:<28}{:>10}{:>10}{:>10}{:>10}{:>11}{:>11}{:>11}{:>11}{:>11}",
        "",
        "time",
        "peak",
        "RMS",
        "at 0+",
        chosen,
        "±5 %",
        format!("±{band} %"),
        hub,
        format!("±{band} %")
    );
    say!(
        "  {:<28}{:>10}{:>10}{:>10}{:>10}{:>11}{:>11}{:>11}{:>11}{:>11}",
        "",
        "s",
        "N m",
        "N m",
        "N m",
        "left",
        "worst",
        "worst",
        "left",
        "worst"
    );
    for row in rows {
        match &row.outcome {
            Err((_, why)) => say!("  {:<28}{why}", row.name),
            Ok(outcome) => {
                let (own, hub) = (&outcome.residuals[column], &outcome.residuals[0]);
                say!(
                    "  {:<28}{:>10.4}{:>10.2}{:>10.2}{:>10.2}{:>11.3e}{:>11.3e}{:>11.3e}{:>11.3e}{:>11.3e}",
                    row.name,
                    outcome.plan.time,
                    outcome.torque.peak.value,
                    outcome.torque.rms,
                    outcome.torque.initial,
                    own.nominal,
                    own.near,
                    own.worst,
                    hub.nominal,
                    hub.worst
                );
            }
        }
    }
    Ok(())
}
