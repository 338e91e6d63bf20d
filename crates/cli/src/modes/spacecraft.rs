//! Modes of a spacecraft: of its appendages with fixed roots, and of the whole with a free hub.

use std::io::Write;

use flexsc_core::analysis::body_poles::WhirlPoles;
use flexsc_core::analysis::spacecraft_modes::{ResidualMass, SpacecraftModes};
use flexsc_core::formats::count::counted;
use flexsc_core::numerics::attitude::AXES;
use serde_json::{Value as Json, json};

use super::{SMALL, Style, frequency, print_influences, texts};
use crate::error::CliError;
use crate::human::digits;
use crate::number::unsigned_zero;
use crate::results::{Results, with_scenario_name};
use crate::row_table::print_table;
use crate::say;

/// Modes of a spacecraft, and the influence of its actuator on them.
pub struct Spacecraft {
    /// Name of the scenario.
    pub name: String,
    pub parts: SpacecraftModes,
    /// Poles with the wheels that points of the structure carry at a speed, if there are such wheels.
    pub whirl: Option<WhirlPoles>,
    /// True for each axis with jets; for the other axes the influence of a torque of 1 N m is printed.
    pub jets: [bool; 3],
    pub style: Style,
}

impl Results for Spacecraft {
    fn json(&self) -> Vec<Json> {
        let mut object = json!(self.parts);
        if let Some(whirl) = &self.whirl {
            object["whirl"] = json!(whirl);
        }
        vec![with_scenario_name(&self.name, object)]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, parts, jets, style, .. } = self;
        let [x, y, z] = parts.centre_m.map(digits);
        say!("{name}   {} kg, centre of mass at {x}, {y}, {z} m", digits(parts.mass_kg));
        let inertia = parts.inertia_kg_m2.iter().enumerate().map(|(row, moments)| {
            let mut cells = vec![if row == 0 { "inertia, kg m²".to_owned() } else { String::new() }];
            cells.extend(moments.map(|moment| unsigned_zero(moment, 4)));
            cells
        });
        print_table(&inertia.collect::<Vec<_>>(), 0);
        let is_flexible = !parts.clamped.is_empty();
        if is_flexible {
            self.print_clamped();
            say!(
                "  modes of the complete spacecraft, hub free; off-diagonal damping {}: {}",
                digits(parts.damping_coupling),
                if parts.whole_damping { "kept" } else { "kept in linear loops, left out in runs" }
            );
        }
        print_influences(&parts.free, *jets, *style);
        if !is_flexible {
            return Ok(());
        }
        self.print_points();
        self.print_whirl();
        if !parts.turned.is_empty() {
            let drives = parts.turned[0].angles_rad.len();
            let (factor, unit) = style.units.frequency();
            say!("  frequencies as drives turn, increasing, {unit}");
            let mut rows = vec![texts(&["s"])];
            rows[0].extend((0..drives).map(|drive| format!("angle {}, rad", drive + 1)));
            for at in &parts.turned {
                let frequencies = at.frequencies_rad_s.iter().map(|frequency| frequency * factor);
                let numbers = [at.time_s].into_iter().chain(at.angles_rad.iter().copied()).chain(frequencies);
                rows.push(numbers.map(digits).collect());
            }
            print_table(&rows, 0);
        }
        Ok(())
    }
}

impl Spacecraft {
    /// Prints the modes of the appendages with their roots held.
    fn print_clamped(&self) {
        let Self { parts, style, .. } = self;
        say!(
            "  modes of the appendages, clamped, with effective masses and inertias in their own axes about the root"
        );
        let mut rows = vec![texts(&[
            "mode",
            &style.units.frequency().1,
            "period, s",
            "damping",
            "kg x",
            "y",
            "z",
            "kg m² x",
            "y",
            "z",
            "appendage",
        ])];
        for (index, mode) in parts.clamped.iter().enumerate() {
            let mut row = vec![index.to_string()];
            row.extend(frequency(style.units, mode.frequency_rad_s, mode.damping));
            let effective = mode.effective_mass_kg.into_iter().chain(mode.effective_inertia_kg_m2);
            row.extend(effective.map(|value| unsigned_zero(value, 4)));
            let unknown = if mode.first_moments { "" } else { ", without first moments" };
            row.push(format!("{}{unknown}", mode.appendage));
            rows.push(row);
        }
        print_table(&rows, 1);
        for ResidualMass { appendage, mass_kg, share } in &parts.residual {
            let [x, y, z] = share.map(|part| unsigned_zero(100.0 * part, 1));
            say!(
                "  {appendage}: {x} % of {} kg along x, {y} % along y and {z} % along z are in no mode, and follow the root as if rigid",
                digits(*mass_kg)
            );
        }
    }

    /// Prints the poles with whirl.
    fn print_whirl(&self) {
        let Some(WhirlPoles { wheel_speed_rad_s: speed, poles }) = &self.whirl else { return };
        let units = self.style.units;
        let at = speed.map_or_else(|| "their speeds at the start".to_owned(), |speed| units.speed(speed));
        say!("  poles of the body with its wheels at {at}, hub free, without the loop");
        let mut rows = vec![texts(&[&units.frequency().1, "period, s", "damping"])];
        rows.extend(poles.iter().map(|pole| frequency(units, pole.frequency_rad_s, pole.damping).to_vec()));
        print_table(&rows, 0);
    }

    /// Prints the effect of a torque on the hub at the points of the spacecraft.
    fn print_points(&self) {
        let parts = &self.parts;
        let (mut hub, ends): (Vec<_>, Vec<_>) =
            parts.points.iter().partition(|point| point.appendage.is_none());
        hub.truncate(1);
        let points = || hub.iter().chain(&ends);
        let largest = points().flat_map(|point| point.influences.iter().flatten());
        let largest = largest.fold(0.0, |most: f64, influence| most.max(influence.abs()));
        let least = if self.style.all { 0.0 } else { SMALL * largest };
        say!("  influence of a torque, on the hub (the same at all its points) and at points of appendages");
        let (mut rows, mut omitted) = (vec![texts(&["mode"])], 0);
        rows[0].extend(AXES.map(str::to_owned));
        rows[0].push("point".to_owned());
        for point in points() {
            let place = point.appendage.as_ref().map_or("hub", |_| &point.point);
            for index in 0..parts.clamped.len() {
                let influences = [0, 1, 2].map(|axis: usize| point.influences[axis][index]);
                if influences.iter().all(|influence| influence.abs() < least) {
                    omitted += 1;
                    continue;
                }
                let mut row = vec![index.to_string()];
                row.extend(influences.map(|influence| unsigned_zero(influence, 5)));
                row.push(place.to_owned());
                rows.push(row);
            }
        }
        print_table(&rows, 1);
        if omitted > 0 {
            say!(
                "  {} below 1e-3 of the largest influence left out (--all prints them)",
                counted(omitted, "line")
            );
        }
    }
}
