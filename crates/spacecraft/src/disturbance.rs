//! Disturbances from one time to another: torques, constant, random and over time, and forces at a point, steady, in pulses,
//! over time or random.

use std::path::Path;

use flexsc_dynamics::sine::SineTorque;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::{ForceEffect, Wrench};
use flexsc_formats::document::ConfigError;
use flexsc_formats::load_table::LoadTable;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Time};
use flexsc_numerics::random::Stream;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::axes::Axis;
use crate::held_lines::HeldLines;
use crate::load_density::LoadDensity;
use crate::load_lines::LoadLines;
use crate::machine_load::MachineLoad;
use crate::shaped_load::ShapedLoad;
use crate::sine::Sine;

/// A disturbance: a torque about an axis, or a force at a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disturbance {
    /// Axis about which it acts at the first point, on a body with three, where a torque must have one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about: Option<Axis>,
    /// Torque (N m).
    #[serde(default)]
    pub torque: Finite,
    /// Sine terms added to the torque, on a `[spacecraft]`: amplitude sin(frequency t + phase), t from the start of
    /// the run.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sines: Vec<Sine>,
    /// Force in the body's axes (N) in place of a torque, on a body with three axes: a leak, a stuck jet, a push.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<[Finite; 3]>,
    /// Name of the point at which the force, the density or the lines act; default: the first.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Spectral density of white noise added to the torque ((N m)² s); each draw is held for `period`.
    #[serde(default)]
    pub noise: NonNegative,
    /// Pulses in place of a steady torque or force, each at the start of a period.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pulse: Option<Pulses>,
    /// Time for which a draw of the noise is held (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// Torques (s, N m) or forces in the body's axes (s, N, N, N) over time, or the path of a .csv file, in place of
    /// constant ones; times are from the start of the run. Each is held until the next, the last until `to`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<LoadTable>,
    /// Broadband force and torque at the point in place of a steady force, by their spectral densities.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<LoadDensity>,
    /// Sinusoidal force and torque at the point in place of a steady force: the lines of a machine.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lines: Option<LoadLines>,
    /// Start time (s).
    #[serde(default)]
    pub from: Time,
    /// End time (s); default: the end of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
}

/// A train of pulses: on from the start of each period.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pulses {
    /// Time from the start of one pulse to the start of the next (s).
    pub period: Span,
    /// Duration of each pulse (s).
    pub on: Span,
}

impl Disturbance {
    /// Returns the instants at which the disturbance begins and ends.
    pub fn change_times(&self) -> impl Iterator<Item = Instant> {
        [Some(self.from), self.to].into_iter().flatten().map(at)
    }

    /// Returns the effect of the force on a body, of a table of forces that of the row that is largest; `None` for a torque.
    pub fn force_effect(&self, body: &ThreeAxisModel) -> Option<ForceEffect> {
        let largest = || {
            let forces = self.rows().iter().filter(|row| row.len() == 4).map(|row| force(row));
            forces.max_by(|one, other| one.norm().total_cmp(&other.norm()))
        };
        let force = self.force.as_ref().map(vector).or_else(largest)?;
        Some(self.effect(body, &force))
    }

    /// Returns the effect of a force (N) at the point of the disturbance.
    fn effect(&self, body: &ThreeAxisModel, force: &Vector) -> ForceEffect {
        let mut push = ForceEffect::default();
        push.add(body, self.place(body), &Vector::zeros(), force);
        push
    }

    /// Returns the name of the point at which it acts.
    pub fn place<'a>(&'a self, body: &'a ThreeAxisModel) -> &'a str {
        let first = body.points.first().map_or("", |point| &point.name);
        self.point.as_deref().unwrap_or(first)
    }

    /// Returns the rows of the table; empty without one.
    pub fn rows(&self) -> &[Vec<f64>] {
        self.table.as_ref().map_or(&[], |table| table.rows())
    }

    /// Returns true if the disturbance is a force.
    pub fn is_force(&self) -> bool {
        let is_table = self.rows().first().is_some_and(|row| row.len() == 4);
        self.force.is_some() || self.density.is_some() || self.lines.is_some() || is_table
    }

    /// Reads the files of the tables relative to `directory`; returns a key within the disturbance and the reason.
    pub fn read(&mut self, directory: &Path) -> Option<ConfigError> {
        let densities = self.density.as_mut().and_then(|density| density.table.as_mut());
        if let Some(why) = densities.and_then(|table| table.read(directory).err()) {
            return Some(ConfigError::new("density.table", why));
        }
        let why = self.table.as_mut()?.read(directory).err()?;
        Some(ConfigError::new("table", why))
    }

    /// Keeps the rows of the tables inline, and removes the references to their files.
    pub fn inline(&mut self) {
        if let Some(table) = &mut self.table {
            table.inline();
        }
        if let Some(table) = self.density.as_mut().and_then(|density| density.table.as_mut()) {
            table.inline();
        }
    }

    /// Returns a key that is inconsistent on a three-axis body, with the reason.
    pub fn validate_three_axis(&self) -> Option<ConfigError> {
        let refused = |key: &str, why: &str| Some(ConfigError::new(key, why));
        let noisy = self.noise.get() > 0.0;
        if self.table.is_some() && self.force.is_some() {
            return refused("table", "takes the place of a constant `force`: give one of them");
        }
        let machine = self.density.as_ref().map(|density| ("density", density.validate()));
        let machine = machine.or_else(|| Some(("lines", self.lines.as_ref()?.validate())));
        if let Some((key, fault)) = machine {
            let given = [
                self.force.is_some(),
                self.table.is_some(),
                self.pulse.is_some(),
                self.lines.is_some() && key != "lines",
            ];
            if given.contains(&true) || noisy || self.torque.get() != 0.0 || !self.sines.is_empty() {
                return refused(key, "must be alone: give other loads as a `[[disturbance]]` of their own");
            }
            if let Some(fault) = fault {
                return Some(fault.within(key));
            }
        }
        match (self.is_force(), self.about) {
            (false, None) => refused(
                "about",
                "must be given for a torque on a body with three axes: `roll`, `pitch` or `yaw`; or give a `force`, a `density` or `lines`",
            ),
            (false, Some(_)) if self.point.is_some() => {
                refused("point", "applies only to a `force`: a torque acts at the body's first point")
            }
            (true, Some(_)) => {
                refused("about", "applies only to a torque: a `force` has a direction of its own")
            }
            (true, None) if !self.sines.is_empty() => {
                refused("sines", "apply only to a torque: give `about`, without a `force`")
            }
            (true, None) if self.torque.get() != 0.0 || noisy => refused(
                "force",
                "must be alone: give a `torque`, or `noise`, as a `[[disturbance]]` of its own",
            ),
            _ => None,
        }
    }

    /// Checks that the disturbance of a one-axis body is a torque without an axis; returns the inconsistent key and the reason.
    pub fn validate_one_axis(&self) -> Option<ConfigError> {
        if self.is_force() || self.point.is_some() {
            let why = "acts on a body with three axes: use a `torque` for a body with one angle";
            let keys = [
                ("force", self.force.is_some()),
                ("density", self.density.is_some()),
                ("lines", self.lines.is_some()),
            ];
            let key = keys.iter().find(|(_, is_given)| *is_given).map_or("table", |(key, _)| key);
            return Some(ConfigError::new(key, why));
        }
        let why = "names one of three axes, and the body has one angle";
        self.about.map(|_| ConfigError::new("about", why))
    }

    /// Checks that the times are in order, and within their periods; returns the inconsistent key and the reason.
    pub fn validate_times(&self) -> Option<ConfigError> {
        if let Some(why) = self.table.as_ref().and_then(LoadTable::fault) {
            return Some(ConfigError::new("table", why));
        }
        if self.table.is_some() && self.torque.get() != 0.0 {
            let why = "takes the place of a constant `torque`: give one of them";
            return Some(ConfigError::new("table", why));
        }
        if self.table.is_some() && self.pulse.is_some() {
            let why = "applies to a constant torque or force: leave the `table` out";
            return Some(ConfigError::new("pulse", why));
        }
        if let Some(to) = self.to.filter(|to| self.from >= *to) {
            let why = format!("must be later than `from`, {} s, got {}", self.from.get(), to.get());
            return Some(ConfigError::new("to", why));
        }
        if self.noise.get() > 0.0 && self.period.is_none() {
            let why = "must be given: how long (s) each draw of the noise is held";
            return Some(ConfigError::new("period", why));
        }
        let Pulses { period, on } = self.pulse.filter(|pulse| pulse.on >= pulse.period)?;
        let (period, on) = (period.seconds(), on.seconds());
        let why = format!("must be shorter than the period of {period} s, got {on}");
        Some(ConfigError::new("pulse.on", why))
    }

    /// Returns true if `now` is between the start and the end of the disturbance.
    fn acts(&self, now: Instant) -> bool {
        at(self.from) <= now && self.to.is_none_or(|to| now < at(to))
    }
}

/// Run-time state of a disturbance.
#[derive(Clone, Debug)]
pub struct DisturbanceState {
    disturbance: Disturbance,
    sines: Vec<SineTorque>,
    push: Option<ForceEffect>,
    /// Effects of unit forces along the axes, for a table of forces; otherwise empty.
    units: Vec<ForceEffect>,
    /// Number of rows of the table whose times have come.
    row: usize,
    /// Pulse train: start of the last pulse, true if the pulse is on, and instant of the next switching.
    beat: Option<(Instant, bool, Instant)>,
    draws: Stream,
    /// Load of a machine, and the instant at which it changes next.
    machine: Option<(MachineLoad, Instant)>,
    /// Draw of the noise that is held now (N m); `next` is the instant of the next draw.
    drawn: f64,
    next: Option<Instant>,
}

impl DisturbanceState {
    /// Creates a disturbance before its start, with a random stream of its own; `body` is given if it has three axes.
    pub fn new(disturbance: &Disturbance, body: Option<&ThreeAxisModel>, mut draws: Stream) -> Self {
        let noisy = disturbance.noise.get() > 0.0 && disturbance.period.is_some();
        let machine = body.and_then(|body| {
            let unit = |part| ForceEffect::unit(body, disturbance.place(body), part);
            match (&disturbance.density, &disturbance.lines) {
                (Some(density), _) if density.table.is_some() => {
                    Some(MachineLoad::Lines(HeldLines::of_table(density, unit, &mut draws)))
                }
                (Some(density), _) => ShapedLoad::new(density, unit, &mut draws).map(MachineLoad::Shaped),
                (None, Some(lines)) => {
                    Some(MachineLoad::Lines(HeldLines::of_machine(lines, unit, &mut draws)))
                }
                (None, None) => None,
            }
        });
        Self {
            push: match &machine {
                Some(machine) => Some(machine.effect()),
                None => body.and_then(|body| disturbance.force_effect(body)),
            },
            machine: machine.map(|machine| (machine, at(disturbance.from))),
            next: noisy.then(|| at(disturbance.from)),
            beat: disturbance.pulse.map(|_| (at(disturbance.from), false, at(disturbance.from))),
            units: match body.filter(|_| disturbance.table.is_some() && disturbance.is_force()) {
                Some(body) => {
                    (0..3).map(|axis| ForceEffect::unit(body, disturbance.place(body), axis)).collect()
                }
                None => Vec::new(),
            },
            row: 0,
            sines: disturbance.sines.iter().map(Into::into).collect(),
            disturbance: disturbance.clone(),
            draws,
            drawn: 0.0,
        }
    }

    /// Returns the instant of the next noise draw or pulse edge.
    pub fn due(&self) -> Option<Instant> {
        let ends = |next: &Instant| self.disturbance.to.is_none_or(|to| *next < at(to));
        let beat = self.beat.map(|(_, _, next)| next).filter(ends);
        let row = self.disturbance.rows().get(self.row).map(|row| instant(row[0])).filter(ends);
        let machine = self.machine.as_ref().map(|(_, next)| *next).filter(ends);
        [self.next, beat, row, machine].into_iter().flatten().min()
    }

    /// Returns true if the disturbance acts at `now`, within a pulse if it is pulsed.
    fn acts(&self, now: Instant) -> bool {
        let is_before = self.disturbance.table.is_some() && self.row == 0 && self.push.is_some();
        self.disturbance.acts(now) && !is_before && self.beat.is_none_or(|(_, on, _)| on)
    }

    /// Draws the noise anew and starts or ends pulses, if that is due by `now`.
    pub fn update(&mut self, now: Instant) {
        if let (Some(pulses), Some((began, on, next))) = (self.disturbance.pulse, &mut self.beat) {
            while *next <= now {
                *on = !*on;
                if *on {
                    (*began, *next) = (*next, *next + pulses.on);
                } else {
                    *next = *began + pulses.period;
                }
            }
        }
        let rows = self.disturbance.rows();
        let past = rows[self.row..].iter().take_while(|row| instant(row[0]) <= now).count();
        if past > 0 {
            self.row += past;
            if let (Some(push), Some(row)) = (&mut self.push, rows.get(self.row - 1)) {
                *push = ForceEffect::default();
                self.units.iter().zip(&row[1..]).for_each(|(unit, size)| push.add_scaled(unit, *size));
            }
        }
        if let Some((machine, next)) = &mut self.machine {
            while *next <= now {
                machine.advance(&mut self.draws);
                *next += machine.step();
            }
            self.push = Some(machine.effect());
        }
        let Some(period) = self.disturbance.period else { return };
        while let Some(next) = self.next.filter(|next| *next <= now) {
            // A draw held for a period has the part of the white noise's power that falls into this period.
            self.drawn = f64::sqrt(self.disturbance.noise.get() / period.seconds()) * self.draws.normal();
            let next = next + period;
            self.next = self.disturbance.to.is_none_or(|to| next < at(to)).then_some(next);
        }
    }

    /// Returns the torque on the hub about an axis at an instant (N m), right-continuous.
    pub fn torque_on_hub(&self, now: Instant, axis: usize) -> f64 {
        let body_axis = self.disturbance.about.map_or(0, Axis::index);
        let acts = self.push.is_none() && body_axis == axis && self.acts(now);
        if !acts {
            return 0.0;
        }
        let constant = self.disturbance.torque.get() + self.drawn;
        match self.row.checked_sub(1).and_then(|row| self.disturbance.rows().get(row)) {
            Some(row) => constant + row[1],
            None => constant,
        }
    }

    /// Returns the torque of the sine terms about an axis at an instant (N m).
    fn sine_torque(&self, now: Instant, axis: usize) -> f64 {
        let own = self.disturbance.about.map_or(0, Axis::index) == axis && self.acts(now);
        let sines = self.sines.iter().filter(|_| own);
        sines.map(|sine| sine.at(now.seconds())).sum()
    }

    /// Returns the torque about an axis at an instant (N m); that of a force is about the centre of mass.
    pub fn torque(&self, now: Instant, axis: usize) -> f64 {
        match &self.push {
            Some(push) if self.acts(now) => push.torque[axis],
            _ => self.torque_on_hub(now, axis) + self.sine_torque(now, axis),
        }
    }

    /// Adds the effect of a force, or the sine terms of a torque, to `onto` from `now` on.
    pub fn force_effect(&self, now: Instant, onto: &mut Wrench) {
        if !self.sines.is_empty() && self.acts(now) {
            let axis = self.disturbance.about.map_or(0, Axis::index);
            let direction = Vector::ith(axis, 1.0);
            onto.sines.extend(self.sines.iter().map(|sine| (direction, *sine)));
        }
        if let Some(push) = self.push.as_ref().filter(|_| self.acts(now)) {
            onto.add_force_effect(push);
        }
    }
}

fn at(time: Time) -> Instant {
    instant(time.get())
}

/// Returns the instant at a time (s) from the start of a run.
fn instant(time: f64) -> Instant {
    Instant::START + Span::from_seconds(time)
}

/// Returns the force (N) in a row of a table.
fn force(row: &[f64]) -> Vector {
    Vector::from_column_slice(&row[1..4])
}
