//! Scenario of a CubeSat from its size, mass, wheels and orbit, with typical values for the rest.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write};
use std::ops::RangeInclusive;

use flexsc_core::Scenario;
use flexsc_core::formats::reader_units::{ReaderUnits, number};
use flexsc_core::spacecraft::environment::{LocalTime, earth_gravity, earth_radius};

use crate::error::CliError;
use crate::quantity::in_unit;

/// The file with a name in braces for each value.
const TEMPLATE: &str = include_str!("cubesat.toml");

/// Sizes in units, with the sides along x, y and z (m).
const SIZES: [(u8, [f64; 3]); 7] = [
    (1, [0.1135, 0.1, 0.1]),
    (2, [0.227, 0.1, 0.1]),
    (3, [0.3405, 0.1, 0.1]),
    (6, [0.366, 0.2263, 0.1]),
    (12, [0.366, 0.2263, 0.2263]),
    (16, [0.454, 0.2263, 0.2263]),
    (27, [0.36, 0.34, 0.34]),
];
/// Typical mass of a unit (kg).
const UNIT_MASS: f64 = 1.6;
/// Smallest size with wings (units).
const WINGED: u8 = 3;
/// Mass of a wing by its area (kg/m²), and its first frequency (Hz).
const WING: [f64; 2] = [4.5, 2.3];
/// Largest speed of the wheels (rad/s): 6000 rpm.
const WHEEL_SPEED: f64 = 200.0 * PI;
/// Field at which the gain of the detumbling law is chosen (T).
const FIELD: f64 = 4e-5;
/// Altitudes of the orbit (m).
const LOW_ORBIT: RangeInclusive<f64> = 150e3..=2000e3;
/// Local time of the node by default (s).
const LTAN: f64 = 10.5 * 3600.0;

/// Size, mass, wheels and orbit of `flexsc new --cubesat`.
#[derive(clap::Args)]
#[command(next_help_heading = "CubeSats")]
#[group(skip)]
pub struct CubesatArgs {
    /// Write the scenario of a CubeSat: detumbling, Sun, Earth pointing; asks on a terminal for what is not given here
    #[arg(long, conflicts_with = "like")]
    pub cubesat: bool,
    /// Size in units: 1, 2, 3, 6, 12, 16 or 27 [default: 6]
    #[arg(long, value_name = "UNITS", requires = "cubesat", value_parser = size)]
    size: Option<u8>,
    /// Mass (kg) [default: 1.6 kg a unit]
    #[arg(long, value_name = "MASS", requires = "cubesat", value_parser = in_unit("kg"))]
    mass: Option<f64>,
    /// Momentum that each wheel stores (N m s) [default: 0.6 mN m s a unit]
    #[arg(long, value_name = "MOMENTUM", requires = "cubesat", value_parser = in_unit("N m s"))]
    wheel_momentum: Option<f64>,
    /// Torque of each wheel (N m) [default: that which gives the momentum in 1.5 s]
    #[arg(long, value_name = "TORQUE", requires = "cubesat", value_parser = in_unit("N m"))]
    wheel_torque: Option<f64>,
    /// Altitude of the orbit (m) [default: 525 km]
    #[arg(long, value_name = "ALTITUDE", requires = "cubesat", value_parser = in_unit("m"))]
    altitude: Option<f64>,
    /// Mean local time of the ascending node [default: 10:30]
    #[arg(long, value_name = "TIME", requires = "cubesat")]
    ltan: Option<LocalTime>,
}

/// Reads a size: `6` or `6U`.
fn size(text: &str) -> Result<u8, String> {
    let digits = text.trim().trim_end_matches(['U', 'u']);
    let size = digits.parse().ok().filter(|size| SIZES.iter().any(|(units, _)| units == size));
    size.ok_or_else(|| format!("must be 1, 2, 3, 6, 12, 16 or 27 units, got `{text}`"))
}

impl CubesatArgs {
    /// Returns the text of the scenario; asks for values that are not given if a person can answer.
    pub fn text(&self, name: &str) -> Result<String, CliError> {
        let units = asked("Size, units", self.size, 6, size, u8::to_string)?;
        let quantity = |unit: &'static str| {
            let written = move |value: &f64| ReaderUnits::Engineering.quantity(*value, unit);
            (in_unit(unit), written)
        };
        let (read, written) = quantity("kg");
        let mass = asked("Mass", self.mass, UNIT_MASS * f64::from(units), read, written)?;
        let (read, written) = quantity("N m s");
        let momentum =
            asked("Momentum of a wheel", self.wheel_momentum, 0.6e-3 * f64::from(units), read, written)?;
        let (read, written) = quantity("N m");
        let torque = asked("Torque of a wheel", self.wheel_torque, momentum / 1.5, read, written)?;
        let altitude = asked("Altitude", self.altitude, 525e3, in_unit("m"), |value| {
            format!("{} km", number(value / 1e3))
        })?;
        let ltan = LocalTime::from_seconds(LTAN).expect("it is below a day");
        let read = |text: &str| text.parse();
        let ltan = asked("Local time of the ascending node", self.ltan, ltan, read, LocalTime::to_string)?;
        for (name, value) in
            [("mass", mass), ("wheel-momentum", momentum), ("wheel-torque", torque), ("altitude", altitude)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(CliError::Arguments(format!("--{name} must be above 0, got {value}")));
            }
        }
        if !LOW_ORBIT.contains(&altitude) {
            let shown = ReaderUnits::Si.quantity(altitude, "m");
            return Err(CliError::Arguments(format!(
                "--altitude must be from 150 km to 2000 km, got {shown}"
            )));
        }
        let text = Cubesat { units, mass, momentum, torque, altitude, ltan }.scenario(name);
        // Values that do not go together are refused before a file is written.
        Scenario::parse(&format!("{name}.toml"), &text)?;
        Ok(text)
    }
}

/// Returns a value that is given, else the answer of a person on a terminal, else the default.
fn asked<T>(
    question: &str,
    given: Option<T>,
    default: T,
    read: impl Fn(&str) -> Result<T, String>,
    written: impl Fn(&T) -> String,
) -> Result<T, CliError> {
    if let Some(given) = given {
        return Ok(given);
    }
    if !(std::io::stdin().is_terminal() && std::io::stderr().is_terminal()) {
        return Ok(default);
    }
    loop {
        let _ = write!(anstream::stderr(), "{question} [{}]: ", written(&default));
        let _ = anstream::stderr().flush();
        let mut line = String::new();
        let read_bytes = std::io::stdin().read_line(&mut line);
        if read_bytes.is_err() || line.trim().is_empty() {
            return Ok(default);
        }
        match read(line.trim()) {
            Ok(value) => return Ok(value),
            Err(why) => crate::say!("  {why}"),
        }
    }
}

/// A CubeSat of which size, mass (kg), wheels (N m s, N m) and orbit (m) are known.
struct Cubesat {
    units: u8,
    mass: f64,
    momentum: f64,
    torque: f64,
    altitude: f64,
    ltan: LocalTime,
}

impl Cubesat {
    fn scenario(&self, name: &str) -> String {
        let [x, y, z] =
            SIZES.iter().find(|(units, _)| *units == self.units).map_or([0.1; 3], |(_, sides)| *sides);
        let wing = (self.units >= WINGED).then(|| Wing::new([x, y, z], self.mass));
        let hub = self.mass - wing.as_ref().map_or(0.0, |wing| 2.0 * wing.mass);
        let box_inertia = |a: f64, b: f64| hub * (a * a + b * b) / 12.0;
        let [jx, jy, jz] = [box_inertia(y, z), box_inertia(x, z), box_inertia(x, y)];
        let semi_major_axis = earth_radius().get() + self.altitude;
        let rate = f64::sqrt(earth_gravity().get() / semi_major_axis) / semi_major_axis;
        let orbit = 2.0 * PI / rate;
        let least = jx.min(jy).min(jz);
        let wings = wing.as_ref().map_or_else(String::new, |wing| wing.tables(y));
        let cells = x * y + wing.as_ref().map_or(0.0, |wing| 2.0 * wing.sides[0] * wing.sides[1]);
        let uncertain = wing.map_or_else(String::new, |_| {
            let key =
                |index: u8| format!("\"appendage[{index}].frequency_factor\" = {{ uniform = [0.8, 1.2] }}");
            format!("{}\n{}", key(0), key(1))
        });
        let plain = |value: f64| three_digits(value);
        let values = [
            ("units", self.units.to_string()),
            ("mass", plain(self.mass)),
            ("name", name.to_owned()),
            ("duration", format!("{:.0}", 5.0 * orbit)),
            ("x", plain(x)),
            ("y", plain(y)),
            ("z", plain(z)),
            ("half_x", plain(0.5 * x)),
            ("half_z", plain(0.5 * z)),
            ("hub_mass", plain(hub)),
            ("jx", plain(jx)),
            ("jy", plain(jy)),
            ("jz", plain(jz)),
            ("wings", wings),
            ("altitude", plain(self.altitude / 1e3)),
            ("ltan", self.ltan.to_string()),
            ("shade", if self.ltan.from_sun() > 0.0 { "1" } else { "-1" }.to_owned()),
            ("dipole", plain(2e-3 * f64::from(self.units))),
            ("sail", plain(cells)),
            ("front", plain(y * z)),
            ("brake_gain", format!("{:.1e}", 4.0 * rate * least / (FIELD * FIELD))),
            ("rotor", format!("{:.2e}", self.momentum / WHEEL_SPEED)),
            ("wheel_torque", plain(1e3 * self.torque)),
            ("wheel_momentum", plain(1e3 * self.momentum)),
            ("rods", plain(0.04 * f64::from(self.units))),
            ("above", format!("{:.1e}", 0.3 * self.momentum)),
            ("below", format!("{:.1e}", 0.1 * self.momentum)),
            ("three_orbits", format!("{:.0}", 3.0 * orbit)),
            ("late", format!("{:.0}", 4.0 * orbit)),
            ("uncertain_wings", uncertain),
        ];
        let filled =
            |text: String, (place, value): (&str, String)| text.replace(&format!("{{{place}}}"), &value);
        values.into_iter().fold(TEMPLATE.to_owned(), filled)
    }
}

/// Wing of cells on each side, clamped at the edge towards z.
struct Wing {
    /// Length outwards and width along x (m).
    sides: [f64; 2],
    /// Mass (kg).
    mass: f64,
}

impl Wing {
    /// Creates the wing of a body with these sides (m) and this mass (kg): as wide as the body is long.
    fn new([x, y, _]: [f64; 3], mass: f64) -> Self {
        let sides = [1.5 * y, 0.9 * x];
        Self { sides, mass: (WING[0] * sides[0] * sides[1]).min(0.1 * mass) }
    }

    /// Returns the tables of both wings of a body of this width (m).
    fn tables(&self, y: f64) -> String {
        let mut text = String::new();
        let [length, width, mass, at] = [self.sides[0], self.sides[1], self.mass, 0.5 * y].map(three_digits);
        for (name, side, turned) in
            [("+y", "", ""), ("-y", "-", "turned = { about = [0, 0, 1], by = \"180 deg\" }\n")]
        {
            let _ = write!(
                text,
                "\n[[appendage]]\nname = \"wing {name}\"\nmass = {mass}\nat = [0, {side}{at}, 0]\n{turned}\
                 plate = {{ length = {length}, width = {width}, frequency = \"{} Hz\", damping = \"0.5 %\" }}\n",
                WING[1]
            );
        }
        text
    }
}

/// Returns a number in three significant digits, as TOML.
fn three_digits(value: f64) -> String {
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_size_is_a_scenario() {
        for (units, _) in SIZES {
            let momentum = 0.6e-3 * f64::from(units);
            let mass = UNIT_MASS * f64::from(units);
            let own = Cubesat {
                units,
                mass,
                momentum,
                torque: momentum / 1.5,
                altitude: 5e5,
                ltan: "6 h".parse().expect("a time"),
            };
            let text = own.scenario("mine");
            assert!(!text.contains("{x}") && !text.contains("{}U"), "{text}");
            let scenario =
                Scenario::parse("mine.toml", &text).unwrap_or_else(|why| panic!("{units}: {why}\n{text}"));
            // The wings are taken from the mass that was given.
            let total: f64 = scenario.appendage.iter().map(|own| own.mass.get()).sum::<f64>()
                + scenario.spacecraft.as_ref().expect("a spacecraft").mass.get();
            assert!((total / mass - 1.0).abs() < 5e-3, "{units}: {total}");
        }
    }
}
