//! The modes of a spacecraft: of its appendages with their roots held, of the whole with its hub free.

use std::io::Write;

use flexsc_core::analysis::parts::ModalParts;
use serde_json::{Value as Json, json};

use super::tell_influences;
use crate::failure::Failure;
use crate::number::unsigned_zero;
use crate::results::{Results, of_scenario};
use crate::say;

/// The modes of a spacecraft, and what its actuator does to them.
pub struct Spacecraft {
    /// Name of the scenario.
    pub name: String,
    pub parts: ModalParts,
    /// About which axes jets act; about others a torque of 1 N m is told.
    pub jets: [bool; 3],
}

impl Results for Spacecraft {
    fn json(&self) -> Vec<Json> {
        vec![of_scenario(&self.name, json!(self.parts))]
    }

    fn tell(&self) -> Result<(), Failure> {
        let Self { name, parts, jets } = self;
        let [x, y, z] = parts.centre_m.map(|of| unsigned_zero(of, 5));
        say!("{name}   {} kg, centre of mass at {x} {y} {z} m", parts.mass_kg);
        for (row, of) in parts.inertia_kg_m2.iter().enumerate() {
            let [x, y, z] = of.map(|of| unsigned_zero(of, 4));
            say!("  {:>22}{x:>12}{y:>12}{z:>12}", if row == 0 { "inertia, kg m²" } else { "" });
        }
        say!(
            "  modes of the appendages, clamped, with effective masses and inertias in their own axes about the root"
        );
        say!(
            "  {:>5}{:>14}{:>10}{:>10}{:>10}{:>10}{:>12}{:>10}{:>10}  appendage",
            "mode",
            "rad/s",
            "damping",
            "kg x",
            "y",
            "z",
            "kg m² x",
            "y",
            "z"
        );
        for (index, mode) in parts.clamped.iter().enumerate() {
            let [mx, my, mz] = mode.effective_mass_kg;
            let [x, y, z] = mode.effective_inertia_kg_m2;
            let unknown = if mode.first_moments { "" } else { ", without first moments" };
            say!(
                "  {index:>5}{:>14.6}{:>10.5}{mx:>10.4}{my:>10.4}{mz:>10.4}{x:>12.4}{y:>10.4}{z:>10.4}  {}{unknown}",
                mode.frequency_rad_s,
                mode.damping,
                mode.appendage
            );
        }
        say!(
            "  modes of the complete spacecraft, hub free; off-diagonal damping {:.2e}",
            parts.damping_coupling
        );
        tell_influences(&parts.free, *jets);
        say!("  influence of a torque, on the hub (the same at all its points) and at points of appendages");
        let (mut hub, ends): (Vec<_>, Vec<_>) =
            parts.points.iter().partition(|point| point.appendage.is_none());
        hub.truncate(1);
        for point in hub.into_iter().chain(ends) {
            let place = point.appendage.as_ref().map_or("hub", |_| &point.point);
            for index in 0..parts.clamped.len() {
                let [roll, pitch, yaw] =
                    [0, 1, 2].map(|axis: usize| unsigned_zero(point.influences[axis][index], 5));
                say!("  {index:>5}{roll:>14}{pitch:>12}{yaw:>12}  {place}");
            }
        }
        if !parts.turned.is_empty() {
            let drives = parts.turned[0].angles_rad.len();
            say!("  frequencies as drives turn, increasing, rad/s");
            say!("  {:>10}{:>width$}", "s", "angles, rad", width = 12 * drives);
            for at in &parts.turned {
                let row = |of: &[f64], digits: usize| -> String {
                    let values: Vec<_> = of.iter().map(|value| format!("{value:>12.digits$}")).collect();
                    values.concat()
                };
                say!("  {:>10.1}{}{}", at.time_s, row(&at.angles_rad, 4), row(&at.frequencies_rad_s, 6));
            }
        }
        Ok(())
    }
}
