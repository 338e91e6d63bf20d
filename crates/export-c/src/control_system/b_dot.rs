//! B-dot laws: samples of the magnetic field in, magnetic moments along the axes out.

use flexsc_core::Scenario;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::law::LawKind;
use flexsc_core::numerics::time::Span;
use flexsc_flight::b_dot::FieldRate;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use flexsc_flight_precision::Precision;

use super::attitude_unit::{vector, vector_words};
use super::{CallLayout, Channel, NotExportable, WordReader, all_of_kind};

/// Rate of change of the magnetic field that B-dot laws read.
#[derive(Clone, Debug)]
pub struct FieldUnit {
    /// Index of the magnetometer in the scenario.
    pub sensor: usize,
    /// Rate of change.
    pub field: FieldRate,
    precision: Precision,
}

impl FieldUnit {
    /// Returns the rate of change by the magnetometer of a scenario.
    pub(super) fn new(scenario: &Scenario) -> Result<Self, NotExportable> {
        let missing = || NotExportable::new("law.b_dot", "needs a `[sensor.magnetometer]`");
        let (sensor, most_age) =
            scenario.sensor.field_source(scenario.study.law_period).ok_or_else(missing)?;
        Ok(Self { sensor, field: FieldRate::new(most_age), precision: scenario.flight_precision })
    }

    /// Returns the function: a sample of the field.
    pub(super) fn layout() -> CallLayout {
        CallLayout {
            inputs: vec![Channel::from_quantity(FlightQuantity::Field, 3, 3e-5)],
            outputs: vec![Channel::from_quantity(FlightQuantity::FieldRate, 3, 1.0)],
            ..CallLayout::new(
                "field",
                "Takes a sample of the magnetic field; its rate of change is 0 before the second one.",
            )
        }
    }

    /// Takes a sample, and returns the words of the outputs.
    pub(super) fn take(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        self.precision.take_field(&mut self.field, now, &vector(&mut WordReader::new(inputs)));
        vector_words(&self.field.rate).to_vec()
    }
}

/// B-dot law along each axis.
#[derive(Clone, Debug)]
pub struct BDotLaws {
    /// Period (s).
    pub period: f64,
    /// Gain of the law along each axis (A m² s/T).
    pub gains: [f64; 3],
    /// Largest moment along each axis (A m²).
    pub limits: [f64; 3],
    precision: Precision,
}

impl BDotLaws {
    /// Returns the laws of a scenario.
    pub(super) fn new(scenario: &Scenario, laws: &[&LawKind]) -> Result<Self, NotExportable> {
        let all = all_of_kind(laws, |law| if let LawKind::BDot(law) = law { Some(*law) } else { None })?;
        let [roll, pitch, yaw] = &all[..] else {
            return Err(NotExportable::new("law.b_dot", "needs a body with three axes"));
        };
        let each = [roll, pitch, yaw];
        if each.iter().any(|law| law.period != roll.period) {
            let reason = "has laws with different periods: give them one period";
            return Err(NotExportable::new("law.per_axis", reason));
        }
        let torquers = scenario.actuator.magnetorquers().map(|(torquers, _)| torquers);
        Ok(Self {
            period: Span::seconds(roll.period),
            gains: each.map(|law| law.gain.get()),
            limits: [0, 1, 2].map(|axis| {
                let limit = torquers.map_or(f64::INFINITY, |of| of.moment.about(axis).get());
                scenario.flight_precision.rounded(limit)
            }),
            precision: scenario.flight_precision,
        })
    }

    /// Returns the precision in which the laws compute.
    pub(super) fn precision(&self) -> Precision {
        self.precision
    }

    /// Returns the function: a step of the laws.
    pub(super) fn layout() -> CallLayout {
        CallLayout {
            outputs: vec![moment_channel()],
            ..CallLayout::new("step", "Decides on the magnetic moments of a period.")
        }
    }

    /// Returns the moments (A m²) for a rate of change of the field (T/s).
    pub fn moment(&self, rate: &Vector3) -> Vector3 {
        let [gains, limits] = [self.gains, self.limits].map(|[x, y, z]| Vector3 { x, y, z });
        self.precision.moments(rate, &gains, &limits)
    }
}

/// Returns the output of magnetic moments.
pub(super) fn moment_channel() -> Channel {
    Channel::real("moment", "Magnetic moment along each axis (A m\u{b2})", 3, 1.0)
}

/// Control system of B-dot laws alone.
#[derive(Clone, Debug)]
pub struct BDotSystem {
    /// Rate of change of the field.
    pub field: FieldUnit,
    /// Laws.
    pub laws: BDotLaws,
}

impl BDotSystem {
    /// Returns the control system of a scenario.
    pub(super) fn new(scenario: &Scenario, laws: &[&LawKind]) -> Result<Self, NotExportable> {
        Ok(Self { field: FieldUnit::new(scenario)?, laws: BDotLaws::new(scenario, laws)? })
    }

    /// Calls a function, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        if call == 0 {
            return self.field.take(now, inputs);
        }
        vector_words(&self.laws.moment(&self.field.field.rate_at(now))).to_vec()
    }
}
