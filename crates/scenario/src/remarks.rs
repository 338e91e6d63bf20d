//! Remarks on values that are accepted but probably mistakes.

use std::f64::consts::{PI, TAU};

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_formats::document::key::bare_or_quoted;
use flexsc_formats::reader_units::ReaderUnits;
use toml::{Table, Value};

use super::Scenario;
use super::magnitudes::Magnitudes;

impl Scenario {
    /// Values that are accepted and probably not meant, each with its key and why.
    pub fn remarks(&self) -> Vec<ConfigError> {
        let mut written = self.written.clone();
        written.inline_files();
        let table = written.to_table();
        let mut remarks = Magnitudes::remarks(self, &table);
        for (key, value) in &table {
            let look = match key.as_str() {
                "sensor" => latency,
                "law" | "mode" => bandwidth,
                _ => continue,
            };
            each_table(key, value, look, &mut remarks);
        }
        for (index, line) in self.line_of_sight.iter().enumerate() {
            let remark = self.model.three_axis().and_then(|body| line.remark(body));
            remarks.extend(remark.map(|own| own.within(&format!("line_of_sight[{index}]"))));
        }
        remarks.extend(self.known_inertia());
        remarks.extend(self.environment_remarks());
        remarks
    }

    /// Returns the remark that modes vibrate faster than the law samples.
    pub fn aliased_modes(&self) -> Option<ConfigError> {
        let (key, period) = self.slowest_law()?;
        let limit = PI / period;
        let above: Vec<f64> = self.model.frequencies().filter(|mode| *mode > limit).collect();
        let fastest = above.iter().copied().reduce(f64::max)?;
        let cycles = fastest * period / TAU;
        let alias = (cycles - libm::round(cycles)).abs() * TAU / period;
        let verb = if above.len() == 1 { "is" } else { "are" };
        let hertz = ReaderUnits::Engineering.frequency();
        let why = format!(
            "shows frequencies up to 1/(2 period) = {}: {} {verb} above it, the fastest of {}, which samples show as {}",
            hertz.quantity(limit),
            counted(above.len(), "mode"),
            hertz.quantity(fastest),
            hertz.quantity(alias)
        );
        Some(ConfigError::new(key, why))
    }

    /// Returns the key and the length (s) of the longest period of a law in closed loop.
    fn slowest_law(&self) -> Option<(String, f64)> {
        let laws = (0..self.axis_count()).flat_map(|axis| self.law.laws_about(axis));
        let closed = laws.filter(|of| !["open", "b_dot"].contains(&of.law.kind()));
        let periods =
            closed.filter_map(|of| Some((format!("{}.period", of.key), of.law.period()?.seconds())));
        periods.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the remark that a law knows an inertia that differs from run to run.
    fn known_inertia(&self) -> Option<ConfigError> {
        let commands_torque = self.law.kind() != "open" && self.law.kind() != "b_dot";
        if self.study.axes.len() != 3 || !commands_torque || self.law.inertia().is_some() {
            return None;
        }
        let changes_inertia = |key: &&String| {
            let is_mass =
                key.split(['.', '[']).any(|name| ["mass", "inertia", "centre", "at"].contains(&name));
            is_mass && ["spacecraft", "body", "appendage"].iter().any(|table| key.starts_with(table))
        };
        let key = self.written.uncertain.keys().find(changes_inertia)?;
        let why = "changes the inertia from run to run, and the law knows that of each run: give an attitude law `inertia` to study its error";
        Some(ConfigError::new(format!("uncertain.{}", bare_or_quoted(key)), why))
    }
}

/// Looks at a table and at all within it.
fn each_table(
    path: &str,
    value: &Value,
    look: fn(&str, &Table, &mut Vec<ConfigError>),
    remarks: &mut Vec<ConfigError>,
) {
    match value {
        Value::Table(table) => {
            look(path, table, remarks);
            for (key, value) in table {
                each_table(&format!("{path}.{}", bare_or_quoted(key)), value, look, remarks);
            }
        }
        Value::Array(values) => {
            for (index, value) in values.iter().enumerate() {
                each_table(&format!("{path}[{index}]"), value, look, remarks);
            }
        }
        _ => {}
    }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// Laws that do not sample their own bandwidth.
fn bandwidth(path: &str, table: &Table, remarks: &mut Vec<ConfigError>) {
    let of = |key: &str| table.get(key).and_then(number);
    if let (Some(bandwidth), Some(period)) = (of("bandwidth"), of("period"))
        && bandwidth * period > PI
    {
        let limit = PI / period;
        let why = format!(
            "is above pi/period = {limit:.3} rad/s, up to which samples show a motion: is {bandwidth} in another unit than rad/s?"
        );
        remarks.push(ConfigError::new(format!("{path}.bandwidth"), why));
    }
}

/// Readings that are older than the next ones.
fn latency(path: &str, table: &Table, remarks: &mut Vec<ConfigError>) {
    let of = |key: &str| table.get(key).and_then(number);
    if let (Some(latency), Some(period)) = (of("latency"), of("period"))
        && latency > period
    {
        let why = format!(
            "is longer than the period of {period} s: each reading comes after the next one was taken, {latency} s late"
        );
        remarks.push(ConfigError::new(format!("{path}.latency"), why));
    }
}
