//! B-dot laws: samples of the magnetic field in, magnetic moments along the axes out.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::ActuatorKind;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::law::LawKind;
use flexsc_core::numerics::time::Span;
use flexsc_flight::b_dot::{FieldRate, limited_moment, opposing_moment};
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;

use super::{CallLayout, Channel, NotExportable, WordReader, all_of_kind};

/// B-dot law along each axis, and the rate of change of the field that they read.
#[derive(Clone, Debug)]
pub struct BDotLaws {
    /// Period (s).
    pub period: f64,
    /// Gain of the law along each axis (A m² s/T).
    pub gains: [f64; 3],
    /// Largest moment along each axis (A m²).
    pub limits: [f64; 3],
    /// Index of the magnetometer in the scenario.
    pub magnetometer: usize,
    /// Rate of change of the field.
    pub field: FieldRate,
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
        let Some(magnetometer) = scenario.sensor.iter().position(|sensor| sensor.measures_field()) else {
            return Err(NotExportable::new("law.b_dot", "needs a `[sensor.magnetometer]`"));
        };
        Ok(Self {
            period: Span::seconds(roll.period),
            gains: each.map(|law| law.gain.get()),
            limits: limits(scenario),
            magnetometer,
            field: FieldRate::NONE,
        })
    }

    /// Returns the functions: a sample of the field, and a step of the laws.
    pub(super) fn calls(&self) -> Vec<CallLayout> {
        let rate = |scale| Channel::from_quantity(FlightQuantity::FieldRate, 3, scale);
        let field = Channel::from_quantity(FlightQuantity::Field, 3, 3e-5);
        let typical = self.limits[0].min(1e6) / self.gains[0];
        let moment = Channel::real("moment", "Magnetic moment along each axis (A m\u{b2})", 3, 1.0);
        vec![
            CallLayout {
                name: "sample",
                about: "Takes a sample of the magnetic field; its rate of change is 0 before the second one.",
                is_start: false,
                inputs: vec![field],
                outputs: vec![rate(1.0)],
            },
            CallLayout {
                name: "step",
                about: "Decides on the magnetic moments of a period.",
                is_start: false,
                inputs: vec![rate(typical)],
                outputs: vec![moment],
            },
        ]
    }

    /// Calls a function, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let [x, y, z] = WordReader::new(inputs).reals();
        let outputs = if call == 0 {
            self.field.take(now, &Vector3 { x, y, z });
            let rate = self.field.rate;
            [rate.x, rate.y, rate.z]
        } else {
            let rates = [x, y, z];
            [0, 1, 2]
                .map(|axis| limited_moment(opposing_moment(self.gains[axis], rates[axis]), self.limits[axis]))
        };
        outputs.map(f64::to_bits).to_vec()
    }
}

/// Returns the largest moment of the magnetorquers along each axis (A m²); infinite without magnetorquers.
fn limits(scenario: &Scenario) -> [f64; 3] {
    let members = scenario.actuator.members();
    let torquers = members.iter().find_map(|member| match &*member.kind {
        ActuatorKind::Magnetorquers(torquers) => Some(torquers.clone()),
        _ => None,
    });
    [0, 1, 2].map(|axis| torquers.as_ref().map_or(f64::INFINITY, |of| of.moment.about(axis).get()))
}
