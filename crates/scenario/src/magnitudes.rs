//! Magnitudes of numbers that are probably in another unit than that of their key.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use flexsc_formats::document::ConfigError;
use flexsc_formats::document::key::bare_or_quoted;
use flexsc_numerics::quantity::shortest;
use toml::{Table, Value};

use super::{Limit, Scenario};

/// Magnitude of numbers above which they are probably in another unit.
struct Magnitude {
    /// Unit of the keys.
    unit: &'static str,
    /// Words of which the last name of a key contains one; any key without.
    keys: &'static [&'static str],
    largest: f64,
    /// Unit in which the number is probably meant.
    meant: &'static str,
}

/// Words in the names of errors of sensors, and of what hides them.
const ERRORS: &[&str] =
    &["noise", "bias", "resolution", "quantum", "misalignment", "dead_zone", "hysteresis"];

/// Magnitudes, of which the first that fits a key counts.
const MAGNITUDES: [Magnitude; 10] = [
    Magnitude { unit: "rad", keys: ERRORS, largest: 1.0, meant: "arcsec" },
    Magnitude { unit: "rad", keys: &[], largest: 2.0 * TAU, meant: "deg" },
    Magnitude { unit: "rad/s", keys: ERRORS, largest: 1.0, meant: "deg/h" },
    Magnitude { unit: "rad/s", keys: &["rate"], largest: 10.0, meant: "deg/s" },
    Magnitude { unit: "rad/s", keys: &[], largest: 1e4, meant: "rpm" },
    Magnitude { unit: "rad/sqrt(s)", keys: &[], largest: 1e-2, meant: "deg/sqrt(h)" },
    Magnitude { unit: "T", keys: &[], largest: 1e-3, meant: "nT" },
    Magnitude { unit: "A m²", keys: &[], largest: 1e4, meant: "mA m²" },
    Magnitude {
        unit: "m",
        keys: &["centre", "at", "position", "offset", "root"],
        largest: 300.0,
        meant: "mm",
    },
    Magnitude { unit: "kg", keys: &[], largest: 1e7, meant: "g" },
];

/// Names of tables without a remark: an appendage's drive makes several turns, and rows are no single numbers.
const SKIPPED: [&str; 4] = ["drive", "ephemeris", "table", "shapes"];

/// Largest speed (rad/s) of a wheel.
const FASTEST_WHEEL: f64 = 1e4;
/// Least and largest radius of gyration (m) of a spacecraft.
const GYRATION: [f64; 2] = [0.01, 100.0];
/// Least and largest mean density (kg/m³) of a planet, and the gravitational constant (m³/kg/s²).
const DENSITY: [f64; 2] = [100.0, 3e4];
const GRAVITATION: f64 = 6.6743e-11;
/// Largest damping ratio of a mode of a structure.
const DAMPING: f64 = 0.3;
/// Pointing error (rad) above which a limit is hardly one, and above which one without a unit probably lacks it.
const POINTING: f64 = 1.0;
const UNITLESS_POINTING: f64 = 0.05;

/// Numbers of a scenario by their keys, with what has been remarked.
pub(super) struct Magnitudes<'a> {
    scenario: &'a Scenario,
    /// Keys without indices that are done: one remark is enough for a list.
    done: BTreeSet<String>,
    remarks: Vec<ConfigError>,
}

impl<'a> Magnitudes<'a> {
    /// Returns the remarks on the numbers of a scenario, which are in SI units.
    pub(super) fn remarks(scenario: &'a Scenario, table: &Table) -> Vec<ConfigError> {
        let mut found = Self { scenario, done: BTreeSet::new(), remarks: Vec::new() };
        for (key, value) in table {
            found.look(&bare_or_quoted(key), key, value);
        }
        found.look_at_gyration(table);
        found.look_at_gravity(table);
        found.look_at_limits();
        found.remarks
    }

    /// Looks at a value and at all within it; `name` is the last name of its key.
    fn look(&mut self, path: &str, name: &str, value: &Value) {
        match value {
            Value::Table(table) => {
                self.look_at_speed(path, table);
                self.look_at_mode(path, table);
                for (key, value) in table {
                    if !SKIPPED.contains(&key.as_str()) {
                        self.look(&format!("{path}.{}", bare_or_quoted(key)), key, value);
                    }
                }
            }
            Value::Array(values) if values.iter().all(|value| number(value).is_some()) => {
                self.look_at_numbers(path, name, values, true);
            }
            Value::Array(values) => {
                for (index, value) in values.iter().enumerate() {
                    self.look(&format!("{path}[{index}]"), name, value);
                }
            }
            _ => self.look_at_numbers(path, name, std::slice::from_ref(value), false),
        }
    }

    /// Looks at a number, or at a list of numbers.
    fn look_at_numbers(&mut self, path: &str, name: &str, values: &[Value], is_list: bool) {
        let least = MAGNITUDES.iter().map(|of| of.largest).fold(f64::INFINITY, f64::min);
        let beyond =
            |most: f64| values.iter().filter_map(number).enumerate().find(|(_, number)| number.abs() > most);
        let key = |index: usize| if is_list { format!("{path}[{index}]") } else { path.to_owned() };
        let Some(unit) = beyond(least).and_then(|_| self.scenario.unit_of(&key(0))) else { return };
        let fits = |of: &&Magnitude| {
            of.unit == unit && (of.keys.is_empty() || of.keys.iter().any(|word| name.contains(word)))
        };
        let Some(of) = MAGNITUDES.iter().find(fits) else { return };
        if let Some((index, number)) = beyond(of.largest) {
            let number = shortest(number);
            let why = format!(
                "is {number} {unit}: is it meant in another unit, such as \"{number} {}\"?",
                of.meant
            );
            self.remark(&key(index), why);
        }
    }

    /// Looks at the speed that wheels reach.
    fn look_at_speed(&mut self, path: &str, table: &Table) {
        let of = |key: &str| table.get(key).and_then(number);
        if let (Some(momentum), Some(inertia)) = (of("momentum"), of("inertia"))
            && momentum > FASTEST_WHEEL * inertia
        {
            let why = format!(
                "is that of a wheel at {:.3e} rpm, with its inertia of {} kg m²: is it meant as \"{2} mN m s\"?",
                momentum / inertia * 60.0 / TAU,
                shortest(inertia),
                shortest(momentum)
            );
            self.remark(&format!("{path}.momentum"), why);
        }
    }

    /// Looks at modes that do not vibrate, hardly vibrate, or do not act on anything.
    fn look_at_mode(&mut self, path: &str, table: &Table) {
        if let Some(damping) = table.get("damping") {
            let ratios = damping.as_array().map_or(std::slice::from_ref(damping), Vec::as_slice);
            let largest = ratios.iter().filter_map(number).fold(0.0, f64::max);
            let key = format!("{path}.damping");
            let is_ratio = ["body", "appendage"].iter().any(|table| path.starts_with(table))
                && self.scenario.unit_of(&key).is_none();
            if is_ratio && largest > DAMPING {
                let effect = if largest > 1.0 {
                    "above 1 a mode does not vibrate"
                } else {
                    "structures have 0.001 to 0.05"
                };
                let why = format!(
                    "is a ratio, and {effect}: is {largest} a percentage, which is written \"{largest} %\"?"
                );
                self.remark(&key, why);
            }
        }
        let acts = |key: &&str| table.get(*key).is_some_and(is_nonzero);
        if table.contains_key("frequency")
            && path.starts_with("appendage")
            && path.contains("modes")
            && !["translation", "along", "rotation", "moments", "shapes"].iter().any(acts)
        {
            let why = "takes part in no translation and no rotation: it acts on nothing, and nothing excites it; give `translation` and \
                       `rotation`";
            self.remark(path, why.to_owned());
        }
    }

    /// Looks at the radius of gyration of the spacecraft.
    fn look_at_gyration(&mut self, table: &Table) {
        let Some(craft) = table.get("spacecraft").and_then(Value::as_table) else { return };
        let Some(mass) = craft.get("mass").and_then(number) else { return };
        let moment = |axis: usize| number(craft.get("inertia")?.get(axis)?.get(axis)?);
        let trace: Option<f64> = (0..3).map(moment).sum();
        let Some(radius) = trace.map(|trace| f64::sqrt(0.5 * trace / mass)) else { return };
        if !(GYRATION[0]..=GYRATION[1]).contains(&radius) {
            let why = format!(
                "is that of a mass of {} kg about {} m from its centre: is it in another unit than kg m²?",
                shortest(mass),
                digits(radius)
            );
            self.remark("spacecraft.inertia", why);
        }
    }

    /// Looks at the density of the orbit's planet.
    fn look_at_gravity(&mut self, table: &Table) {
        let orbit = table.get("environment").and_then(|around| around.get("orbit"));
        let of = |key: &str| orbit?.get(key).and_then(number);
        let (Some(gravity), Some(radius)) = (of("gravity"), of("planet_radius")) else { return };
        let density = gravity / GRAVITATION / (4.0 / 3.0 * PI * radius * radius * radius);
        if !(DENSITY[0]..=DENSITY[1]).contains(&density) {
            let why = format!(
                "is that of a planet of {} kg/m³, with its radius of {} m: is it in another unit than m³/s²?",
                digits(density),
                shortest(radius)
            );
            self.remark("environment.orbit.gravity", why);
        }
    }

    /// Looks at the limits of pointing requirements.
    fn look_at_limits(&mut self) {
        let scenario = self.scenario;
        let written = &scenario.written.requirement;
        for of in scenario.study.requirements.iter().filter(|of| of.unit == "rad") {
            let own = written.iter().position(|own| own.name == of.name);
            if own.is_some_and(|index| written[index].limit.is_none()) {
                continue;
            }
            let lacks_unit = own.is_some_and(|index| matches!(written[index].limit, Some(Limit::Number(_))));
            let most = if lacks_unit { UNITLESS_POINTING } else { POINTING };
            if of.limit > most {
                let (limit, angle) = (shortest(of.limit), digits(of.limit.to_degrees()));
                let why = format!(
                    "is {limit} rad, {angle} deg: is it meant in another unit, such as \"{limit} deg\"?"
                );
                let key = own.map(|index| format!("requirement[{index}].limit"));
                self.remark(&key.unwrap_or_else(|| "reference.pointing.rms".to_owned()), why);
            }
        }
    }

    /// Adds a remark at a key, once for all elements of a list.
    fn remark(&mut self, path: &str, why: String) {
        let plain: String = path.chars().filter(|character| !character.is_ascii_digit()).collect();
        if self.done.insert(plain) {
            self.remarks.push(ConfigError::new(path, why));
        }
    }
}

/// Returns a number to three digits.
fn digits(value: f64) -> String {
    if (0.01..1e4).contains(&value) { format!("{value:.3}") } else { format!("{value:.2e}") }
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// Returns true if some number in a value is not zero.
fn is_nonzero(value: &Value) -> bool {
    match value {
        Value::Array(values) => values.iter().any(is_nonzero),
        Value::Table(table) => table.values().any(is_nonzero),
        _ => number(value).is_some_and(|number| number != 0.0),
    }
}
