//! Plan of a manoeuvre, and its effect on the body.

use std::io::Write;

use flexsc_core::body::Planar;
use flexsc_core::manoeuvre::{Manoeuvre, Plan, PlanReport};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use super::family::CommandFamily;
use super::{figures, percent, trajectory};
use crate::error::CliError;
use crate::number_table::NumberTable;
use crate::results::{Results, of_scenario};
use crate::say;

/// Plan of a scenario's manoeuvre.
pub struct PlanResults {
    /// Name of the scenario.
    pub name: String,
    /// Body of the scenario.
    pub body: Planar,
    /// Body that the manoeuvre is planned for.
    pub model: Planar,
    pub manoeuvre: Manoeuvre,
    pub plan: Plan,
    pub report: PlanReport,
    /// Index of the coordinate in the figures: the hub's angle or an output.
    pub shown: usize,
}

impl Results for PlanResults {
    fn json(&self) -> Vec<Json> {
        let mut object = of_scenario(&self.name, json!({"command": self.manoeuvre.command.kind()}));
        if let (Some(object), Json::Object(told)) =
            (object.as_object_mut(), self.report.to_json(&self.plan, &self.body))
        {
            object.extend(told);
        }
        vec![object]
    }

    fn figures(&self) -> Vec<Named> {
        let Self { name, body, plan, manoeuvre, model, shown, .. } = self;
        let family = CommandFamily::new(name, body, plan, manoeuvre, model, *shown);
        figures::all(&family, self.report.band)
    }

    fn table(&self) -> Option<NumberTable> {
        Some(trajectory::table(&self.body, &self.plan))
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, body, manoeuvre, plan, report, .. } = self;
        let (angle, time) = (plan.angle, plan.time);
        let kind = manoeuvre.command.kind().replace('_', " ");
        let shaped = if manoeuvre.shaper.is_some() { ", shaped" } else { "" };
        say!("{name}   {angle} rad in {time:.9} s by {kind}{shaped}");
        if plan.start_rate != 0.0 || plan.end_rate != 0.0 {
            say!("  rates            {} -> {} rad/s", plan.start_rate, plan.end_rate);
        }
        let (_, unit) = body.commanded();
        if let Some(c) = &plan.coefficients {
            let list = |c: &[f64]| c.iter().map(|c| format!("{c:.9}")).collect::<Vec<_>>().join(", ");
            say!("  coefficients     {} {unit}", list(&c.odd));
            if !c.even.is_empty() || c.constant != 0.0 {
                say!("  even, constant   {}; {:.9} {unit}", list(&c.even), c.constant);
            }
        }
        let torque = &report.torque;
        let unit = body.torque_unit();
        // An acceleration for a body without inertia.
        let (peak, start, square, energy) = if body.has_unit_inertia() {
            ("peak", "at the start", "rad²/s³", "J/(kg m²)")
        } else {
            ("peak torque", "torque at start", "N² m² s", "J")
        };
        say!("  {peak:<16} {:.6} {unit} at {:.6} s", torque.peak.value, torque.peak.time);
        say!("  root mean square {:.6} {unit}", torque.rms);
        say!("  square integral  {:.6e} {square}", torque.square);
        say!("  {start:<16} {:.6} {unit}", torque.initial);
        say!("  hub at the end   {:.3e} rad, {:.3e} rad/s off", report.angle_error, report.rate_error);
        say!("  energy left      {:.4e} {energy}", report.energy);
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
        Ok(())
    }
}
