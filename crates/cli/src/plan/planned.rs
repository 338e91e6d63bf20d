//! Plan of a manoeuvre, and its effect on the body.

use std::io::Write;

use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::spacecraft::manoeuvre::{Manoeuvre, Plan, PlanReport};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use super::family::CommandFamily;
use super::{figures, percent, trajectory};
use crate::error::CliError;
use crate::human::{Units, columns, digits};
use crate::number_table::NumberTable;
use crate::results::{Results, with_scenario_name};
use crate::say;

/// Plan of a scenario's manoeuvre.
pub struct PlanResults {
    /// Name of the scenario.
    pub name: String,
    /// Body of the scenario.
    pub body: AxisModel,
    /// Body that the manoeuvre is planned for.
    pub model: AxisModel,
    pub manoeuvre: Manoeuvre,
    pub plan: Plan,
    pub report: PlanReport,
    /// Index of the coordinate in the figures: the hub's angle or an output.
    pub shown: usize,
    /// Units of the text.
    pub units: Units,
}

impl Results for PlanResults {
    fn json(&self) -> Vec<Json> {
        let mut object = with_scenario_name(&self.name, json!({"command": self.manoeuvre.command.kind()}));
        if let (Some(object), Json::Object(report)) =
            (object.as_object_mut(), self.report.to_json(&self.plan, &self.body))
        {
            if let Some(load) = &self.manoeuvre.load {
                object.insert("load".to_owned(), json!(load));
            }
            object.extend(report);
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
        let Self { name, body, manoeuvre, plan, report, units, .. } = self;
        let (angle, time) = (units.quantity(plan.angle, "rad"), plan.time);
        let kind = manoeuvre.command.kind().replace('_', " ");
        let shaped = if manoeuvre.shaper.is_some() { ", shaped" } else { "" };
        say!("{name}   {angle} in {} s by {kind}{shaped}", digits(time));
        if let Some(load) = &manoeuvre.load {
            say!("  load             {load}");
        }
        if plan.start_rate != 0.0 || plan.end_rate != 0.0 {
            let rates = units.list(&[plan.start_rate, plan.end_rate], " -> ", "rad/s");
            say!("  rates            {rates}");
        }
        let (_, unit) = body.commanded();
        if let Some(c) = &plan.coefficients {
            let all: Vec<f64> = c.odd.iter().chain(&c.even).copied().chain([c.constant]).collect();
            let (factor, unit) = units.common(&all, unit);
            // More digits than of other numbers: the coefficients define the command.
            let text = |coefficient: f64| format!("{:.9}", coefficient * factor);
            let list = |c: &[f64]| c.iter().map(|c| text(*c)).collect::<Vec<_>>().join(", ");
            say!("  coefficients     {} {unit}", list(&c.odd));
            if !c.even.is_empty() || c.constant != 0.0 {
                say!("  even, constant   {}; {} {unit}", list(&c.even), text(c.constant));
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
        let peak_time = digits(torque.peak.time);
        say!("  {peak:<16} {} at {peak_time} s", units.quantity(torque.peak.value, unit));
        say!("  root mean square {}", units.quantity(torque.rms, unit));
        say!("  square integral  {}", units.quantity(torque.square, square));
        say!("  {start:<16} {}", units.quantity(torque.initial, unit));
        let errors = [(report.angle_error, "rad"), (report.rate_error, "rad/s")];
        let [angle, rate] = errors.map(|(error, unit)| units.quantity(error, unit));
        say!("  hub at the end   {angle}, {rate} off");
        say!("  energy left      {}", units.quantity(report.energy, energy));
        self.print_coordinates();
        let both = |(below, above): (Option<f64>, f64)| match below {
            Some(below) => format!("{} or {} s", digits(below), digits(above)),
            None => format!("{} s", digits(above)),
        };
        for tuned in &report.tuned {
            let cosine =
                tuned.cosine.map_or(String::new(), |times| format!(", a single cosine in {}", both(times)));
            say!("  mode {} rests after a single sine in {}{cosine}", tuned.mode, both(tuned.sine));
        }
        Ok(())
    }
}

impl PlanResults {
    /// Prints the residual and the deflection of each coordinate.
    fn print_coordinates(&self) {
        let Self { report, units, .. } = self;
        let worst = format!("worst {} %", percent(report.band));
        let head: [&str; 7] = ["coordinate      ", "left", "worst 5 %", &worst, "", "deflection", "at"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        for (residual, deflection) in report.residuals.iter().zip(&report.deflections) {
            let residuals = [residual.nominal, residual.near, residual.worst];
            let (factor, unit) = units.common(&residuals, &residual.unit);
            let mut row = vec![format!("{:<16}", residual.name)];
            row.extend(residuals.map(|residual| digits(residual * factor)));
            row.extend([unit, units.quantity(deflection.value, &residual.unit)]);
            row.push(format!("{} s", digits(deflection.time)));
            rows.push(row);
        }
        for line in columns(&rows, 0) {
            say!("  {line}");
        }
    }
}
