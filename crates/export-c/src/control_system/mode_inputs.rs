//! Inputs of a supervisor of modes, and the readings that its conditions compare.

use flexsc_core::Scenario;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::operation::{ModeFormula, ModeQuantity, ModeReading, ModeTables};
use flexsc_core::control::sensor::SensorKind;
use flexsc_flight::mode_condition::ConditionSource;
use flexsc_flight::mode_readings::largest_size;
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use flexsc_flight_precision::Precision;

use super::attitude_unit::{AttitudeUnit, quaternion};
use super::{Channel, StoredMomentum, WordReader};

/// Formula of a reading, with the names of the channels that it reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ReadingFormula {
    /// Value of an input.
    Input(String),
    /// 1 or 0 of an input that is true or false.
    Flag(String),
    /// Quantity of the attitude filter in the code.
    OfFilter(ModeQuantity),
    /// Formula over arrays.
    Known(ModeFormula),
}

/// Inputs of a supervisor.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeInputs {
    /// Inputs.
    pub channels: Vec<Channel>,
    /// Formula of each reading, over inputs, and over `angle` and `rate` of the attitude filter if there is one.
    pub formulas: Vec<ReadingFormula>,
    /// Number of axes.
    pub axes: usize,
    precision: Precision,
}

impl ModeInputs {
    /// Returns the inputs for the readings of modes; `has_filter` is true if an attitude filter gives the estimates.
    pub(super) fn new(
        scenario: &Scenario,
        tables: &ModeTables,
        stored: &StoredMomentum,
        has_filter: bool,
    ) -> Self {
        let (axes, precision) = (scenario.study.axes.len(), scenario.flight_precision);
        let mut inputs = Self { channels: Vec::new(), formulas: Vec::new(), axes, precision };
        if has_filter {
            let about = "Target attitude of the present mode: quaternion w, x, y, z";
            inputs.add(Channel::from_quantity(FlightQuantity::TargetAttitude, 4, 1.0).with_about(about));
        }
        for (index, reading) in tables.readings.iter().enumerate() {
            let steps = tables.steps.iter();
            let own = steps.filter(|step| step.source == ConditionSource::Reading && step.index == index);
            let limit = own.map(|step| step.limit.abs()).fold(0.0, f64::max);
            let scale = if limit > 0.0 { limit } else { 1.0 };
            let formula = match *reading {
                ModeReading::Known(quantity) => inputs.known(scenario, quantity, (scale, stored), has_filter),
                ModeReading::Truth(exit) => inputs.truth(tables, exit),
            };
            inputs.formulas.push(formula);
        }
        inputs
    }

    /// Returns the formula of a quantity that the control system knows, and adds its inputs.
    fn known(
        &mut self,
        scenario: &Scenario,
        quantity: ModeQuantity,
        (scale, stored): (f64, &StoredMomentum),
        has_filter: bool,
    ) -> ReadingFormula {
        let formula = match quantity.formula() {
            ModeFormula::Distance(FlightQuantity::Angle, _) if has_filter => {
                ModeFormula::Norm(FlightQuantity::Angle)
            }
            formula => formula,
        };
        if formula != ModeFormula::Single {
            let given = |vector: &FlightQuantity| {
                !has_filter || !matches!(vector, FlightQuantity::Angle | FlightQuantity::Rate)
            };
            let sources = |vector: FlightQuantity| match (vector, stored) {
                (FlightQuantity::StoredMomentum, StoredMomentum::Wheels { .. }) => {
                    vec![FlightQuantity::WheelSpeed, FlightQuantity::Rate]
                }
                _ => vec![vector],
            };
            let vectors = formula.vectors().flat_map(sources).filter(given);
            vectors.for_each(|vector| self.array(scenario, vector, scale));
            return ReadingFormula::Known(formula);
        }
        let sensor_name = |index: usize| {
            let kinds: Vec<&str> = scenario.sensor.iter().map(SensorKind::kind).collect();
            let kind = kinds.get(index).copied().unwrap_or("sensor");
            let same = kinds.iter().filter(|other| **other == kind).count();
            if same > 1 { format!("{kind}_{index}") } else { kind.to_owned() }
        };
        match quantity {
            ModeQuantity::Silent(sensor) => {
                let about = "Time since the last reading of the sensor, or since it came into use (s)";
                self.scalar(&format!("silent_{}", sensor_name(sensor)), about, scale)
            }
            ModeQuantity::Elevation(mode) => {
                let name = scenario.mode.get(mode).map_or("site", |mode| mode.name.as_str());
                let name = name.to_ascii_lowercase().replace('-', "_");
                let about = "Elevation above the horizon of the site of a mode, by the ephemeris (rad)";
                self.scalar(&format!("elevation_{name}"), about, scale)
            }
            ModeQuantity::FilterAge | ModeQuantity::FilterInnovation | ModeQuantity::FilterDeviation
                if has_filter =>
            {
                ReadingFormula::OfFilter(quantity)
            }
            ModeQuantity::FilterAge => {
                self.scalar("filter_age", "Time since the last correction of the attitude filter (s)", scale)
            }
            ModeQuantity::FilterInnovation => {
                let about = "Size of the innovation of the last correction of the attitude filter (rad)";
                self.scalar("filter_innovation", about, scale)
            }
            ModeQuantity::FilterDeviation => {
                let about = "Standard deviation of the attitude filter about all axes together (rad)";
                self.scalar("filter_deviation", about, scale)
            }
            ModeQuantity::LockLost => {
                let about = "True while a filter has lost lock";
                self.add(Channel::flag("lock_lost", about, 1));
                ReadingFormula::Flag("lock_lost".to_owned())
            }
            // Times and entries are the supervisor's own, and the truth has a flag.
            _ => self.scalar("sunlight", "Part of the Sun's disc in view, by the ephemeris", scale),
        }
    }

    /// Adds the input of an array.
    fn array(&mut self, scenario: &Scenario, quantity: FlightQuantity, scale: f64) {
        let (count, about) = match quantity {
            FlightQuantity::Angle => {
                (self.axes, "Estimated angle from the target of the present mode about each axis (rad)")
            }
            FlightQuantity::Field => (3, "Last measured magnetic field (T); NaN before"),
            FlightQuantity::FieldRate => {
                (3, "Change of the field by the last two readings (T/s); NaN before, and when none is recent")
            }
            FlightQuantity::StoredMomentum => (3, ""),
            FlightQuantity::WheelSpeed => {
                let wheels = scenario.study.wheels.as_ref();
                (wheels.map_or(1, |wheels| wheels.flight_wheels().len()), "")
            }
            _ => (self.axes, ""),
        };
        let channel = Channel::from_quantity(quantity, count, scale);
        self.add(if about.is_empty() { channel } else { channel.with_about(about) });
    }

    fn scalar(&mut self, name: &str, about: &str, scale: f64) -> ReadingFormula {
        self.add(Channel::real(name, about, 1, scale));
        ReadingFormula::Input(name.to_owned())
    }

    /// Returns the formula of a condition on the truth: a flag from another part of the flight software.
    fn truth(&mut self, tables: &ModeTables, exit: usize) -> ReadingFormula {
        let Some(written) = tables.written.get(exit) else { return ReadingFormula::Flag(String::new()) };
        let mode = tables.names.get(written.mode).map_or("", String::as_str);
        let name = format!("truth_{exit}");
        let about =
            format!("True while `{}` of the mode `{mode}` is met, from its exact instant on", written.text);
        self.add(Channel::flag(&name, &about, 1));
        ReadingFormula::Flag(name)
    }

    /// Returns the index of the reading that has the value of an input.
    pub fn index_of(&self, name: &str) -> Option<usize> {
        let is_own = |formula: &ReadingFormula| matches!(formula, ReadingFormula::Input(own) | ReadingFormula::Flag(own) if own == name);
        self.formulas.iter().position(is_own)
    }

    /// Returns true if an input is a boolean.
    pub fn is_boolean(&self, name: &str) -> bool {
        let flag = ReadingFormula::Flag(name.to_owned());
        self.formulas.contains(&flag)
    }

    /// Adds an input, if there is none of its name.
    fn add(&mut self, channel: Channel) {
        if !self.channels.iter().any(|known| known.name == channel.name) {
            self.channels.push(channel);
        }
    }

    /// Returns the target attitude of the present mode, the first of the inputs with an attitude filter.
    pub(super) fn target(inputs: &[u64]) -> Quaternion {
        quaternion(&mut WordReader::new(inputs))
    }

    /// Returns the readings.
    pub(super) fn readings(
        &self,
        now: Ticks,
        inputs: &[u64],
        stored: &StoredMomentum,
        filter: Option<&AttitudeUnit>,
    ) -> Vec<f64> {
        let given = |name: &str| -> Vec<f64> {
            let mut words = WordReader::new(inputs);
            for channel in &self.channels {
                let values = words.list(channel.count);
                if channel.name == name {
                    return values;
                }
            }
            Vec::new()
        };
        let estimate = |quantity: FlightQuantity| match (filter, quantity) {
            (Some(unit), FlightQuantity::Rate) => {
                let rate = unit.rate();
                vec![rate.x, rate.y, rate.z]
            }
            (Some(unit), FlightQuantity::Angle) => {
                let angle = unit.angle_from(&Self::target(inputs), now);
                vec![angle.x, angle.y, angle.z]
            }
            _ => given(quantity.channel()),
        };
        let array = |quantity: FlightQuantity| match (quantity, stored) {
            (FlightQuantity::StoredMomentum, StoredMomentum::Wheels { .. }) => {
                let rate = vector_of(&estimate(FlightQuantity::Rate));
                let momentum = stored.momentum(&given(FlightQuantity::WheelSpeed.channel()), &rate);
                vec![momentum.x, momentum.y, momentum.z]
            }
            _ => estimate(quantity),
        };
        let value = |formula: &ReadingFormula| match formula {
            ReadingFormula::Flag(name) => {
                let is_set = given(name).first().is_some_and(|value| value.to_bits() != 0);
                f64::from(u8::from(is_set))
            }
            ReadingFormula::Input(name) => given(name).first().copied().unwrap_or(f64::NAN),
            ReadingFormula::OfFilter(quantity) => filter.map_or(f64::NAN, |unit| match quantity {
                ModeQuantity::FilterAge => unit.age(now),
                ModeQuantity::FilterInnovation => unit.innovation_size(),
                _ => unit.deviation_size(),
            }),
            ReadingFormula::Known(ModeFormula::Norm(vector)) => self.precision.norm(&array(*vector)),
            ReadingFormula::Known(ModeFormula::Distance(one, other)) => {
                self.precision.distance(&array(*one), &array(*other))
            }
            ReadingFormula::Known(ModeFormula::LargestSize(list)) => largest_size(&array(*list)),
            ReadingFormula::Known(ModeFormula::Single) => f64::NAN,
        };
        self.formulas.iter().map(value).collect()
    }
}

/// Returns a list of three numbers as a vector.
fn vector_of(list: &[f64]) -> Vector3 {
    let [x, y, z] = [0, 1, 2].map(|axis| list.get(axis).copied().unwrap_or(0.0));
    Vector3 { x, y, z }
}
