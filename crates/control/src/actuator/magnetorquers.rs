//! Magnetorquers along the body's axes: magnetic moments whose torque is moment times field at every instant.
//!
//! A demanded torque T gives the moment B x T/B², whose torque m x B is the part of T perpendicular to the field
//! (\[Wertz78\]).

use flexsc_dynamics::wrench::Wrench;
use flexsc_flight::b_dot::limited_moment;
use flexsc_flight::magnetorquers::moment_of_torque;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::flight_types::{from_vector3, to_vector3};
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Instant;
use flexsc_record::{self, Report};
use flexsc_spacecraft::axes::PerAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::failure::{ActiveFailures, FailureScope};
use super::{
    Actuator, ActuatorAuthority, ActuatorEvent, ActuatorPlacement, ActuatorSpec, AxisActuatorContext,
    AxisEffort, AxisResponse, Demand, Failure,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers};
use crate::part::{Occasion, Part, ReportContext};
use crate::requirement::Requirements;

/// Magnetorquers along the body's axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Magnetorquers {
    /// Largest magnetic moment along each axis (A m²): one number for all axes, or a list of three.
    pub moment: PerAxis<Positive>,
    /// Intervals in which the magnetorquers fail.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

impl Magnetorquers {
    /// Returns the length of the largest magnetic moment (A m²).
    pub fn largest_moment(&self) -> f64 {
        Vector::from_fn(|axis, _| self.moment.about(axis).get()).norm()
    }
}

impl ActuatorSpec for Magnetorquers {
    fn start(&self, settings: &[AxisActuatorContext], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        Box::new(MagnetorquersState::new(self, settings))
    }

    /// Returns the authority in the largest field.
    fn authority(&self, _: usize, inertia: f64, on: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        ActuatorAuthority::constant(self.largest_moment() * on.field / inertia)
    }

    fn offers(&self) -> ActuatorOffers {
        ActuatorOffers { turns_with_field: true, ..ActuatorOffers::default() }
    }

    fn requires(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        // With wheels about three axes, the wheels are reported.
        if !offers.lists_actuator(|actuator| actuator.has_reaction_wheels) {
            offers.require_three_axes(needs, "", "");
        }
        place.require_single(needs, "they act along all three axes: write one `magnetorquers`");
        needs.require(
            offers.environment.magnetic_field,
            "",
            "need the field of `[environment.magnetic_field]`, and there is none",
        );
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }
}

/// Run-time state of the magnetorquers.
#[derive(Clone, Debug)]
pub struct MagnetorquersState {
    limits: [f64; 3],
    settings: Vec<AxisActuatorContext>,
    /// Magnetic field in the body's axes (T), as last measured; `None` before that.
    field: Option<Vector>,
    /// Demanded torque (N m).
    demanded: Vector,
    /// Commanded magnetic moment, in the body's axes (A m²).
    moment: Vector,
    /// Failures of each torquer.
    failing: [Option<ActiveFailures>; 3],
}

impl MagnetorquersState {
    /// Creates the torquers before their first command.
    fn new(torquers: &Magnetorquers, settings: &[AxisActuatorContext]) -> Self {
        Self {
            limits: [0, 1, 2].map(|axis| torquers.moment.about(axis).get()),
            settings: settings.to_vec(),
            field: None,
            demanded: Vector::zeros(),
            moment: Vector::zeros(),
            failing: [0, 1, 2].map(|axis| {
                let own = |scope: &FailureScope<'_>| {
                    scope.axis.is_none_or(|failing_axis| failing_axis.index() == axis)
                };
                ActiveFailures::new(&torquers.faults, own)
            }),
        }
    }

    /// Returns the actual moments (A m²), subject to failures.
    fn held(&self) -> Vector {
        let coil = |axis: usize| {
            let commanded = self.moment[axis];
            self.failing[axis].as_ref().map_or(commanded, |failing| failing.output(commanded))
        };
        Vector::from_fn(|axis, _| coil(axis))
    }

    /// Commands the moment whose torque is the part of `torque` (N m) perpendicular to the field, scaled down as a
    /// whole if a limit is exceeded.
    fn give(&mut self, torque: Vector) {
        self.demanded = torque;
        let field = self.field.unwrap_or_default();
        let [torque, field, limits] = [torque, field, self.limits.into()].map(|v: Vector| to_vector3(&v));
        self.moment = from_vector3(&moment_of_torque(&torque, &field, &limits));
    }

    /// Returns the torque in the measured field (N m).
    fn torque_in_field(&self) -> Vector {
        self.field.map_or_else(Vector::zeros, |field| self.moment.cross(&field))
    }

    /// Commands the demanded moments (A m²), each limited separately.
    fn hold(&mut self, demands: &[Demand]) {
        for (axis, demand) in demands.iter().enumerate().take(3) {
            let demanded = if let Demand::Moment(moment) = demand { *moment } else { 0.0 };
            self.moment[axis] = limited_moment(demanded, self.limits[axis]);
        }
        self.demanded = self.torque_in_field();
    }
}

impl Part for MagnetorquersState {
    fn due(&self) -> Option<Instant> {
        self.failing.iter().flatten().filter_map(ActiveFailures::due).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        let held = self.held();
        let axis = |axis: usize| flexsc_record::Magnetorquer { moment_am2: held[axis] };
        let row = flexsc_record::Magnetorquers { axes: [0, 1, 2].map(axis).into() };
        match at.occasion {
            Occasion::Period => report.add(row),
            Occasion::Cycle => report.add_value(row),
            Occasion::Sample => {}
        }
    }
}

impl Actuator for MagnetorquersState {
    fn command(&mut self, _: Instant, demands: &[Demand], _: [f64; 3]) {
        if demands.iter().any(|demand| matches!(demand, Demand::Moment(_))) {
            return self.hold(demands);
        }
        let torque = |(demand, setting): (&Demand, &AxisActuatorContext)| setting.demanded_torque(demand);
        let mut demanded = Vector::zeros();
        demanded
            .iter_mut()
            .zip(demands.iter().zip(&self.settings).map(torque))
            .for_each(|(total, torque)| *total = torque);
        self.give(demanded);
    }

    fn apply(&self, _: Instant, onto: &mut Wrench) {
        onto.moment += self.held();
    }

    fn ignores(&self, _: Instant, axis: usize, demands: &[Demand]) -> bool {
        // Beside moments, torques about the other axes are not given.
        let has_moments = demands.iter().any(|demand| matches!(demand, Demand::Moment(_)));
        has_moments && !matches!(demands[axis], Demand::Moment(_) | Demand::Torque(0.0) | Demand::Change(0.0))
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        match event {
            ActuatorEvent::MagneticField(field) => self.field = Some(field),
            ActuatorEvent::Due(_) => {
                for (failing, moment) in self.failing.iter_mut().zip(&self.moment) {
                    if let Some(failing) = failing {
                        failing.update(now, *moment);
                    }
                }
            }
            ActuatorEvent::EstimatedRate(_)
            | ActuatorEvent::CounterTorque(_)
            | ActuatorEvent::Rotors(_)
            | ActuatorEvent::Mode(_) => {}
        }
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        let held = self.torque_in_field()[axis];
        AxisEffort {
            demanded: self.demanded[axis],
            held,
            firing: 0.0,
            reduced_moment: held / self.settings[axis].inertia,
        }
    }

    /// Returns -0: the torque depends on the current field and is computed by the plant; -0 leaves every sum unchanged.
    fn response(&self, _: Instant, _: usize, _: [f64; 2]) -> AxisResponse {
        AxisResponse { applied: -0.0, rotor: None }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::time::Span;

    fn start(text: &str) -> MagnetorquersState {
        let torquers: Magnetorquers = flexsc_formats::document::from_text(text).unwrap();
        let setting = |axis| AxisActuatorContext {
            axis,
            inertia: 10.0,
            planned_inertia: 10.0,
            rate: 0.0,
            cycle: Some(Span::from_seconds(0.5)),
            waveform: None,
            share: 1.0,
        };
        MagnetorquersState::new(&torquers, &[0, 1, 2].map(setting))
    }

    #[test]
    fn they_give_what_is_across_the_field() {
        let mut torquers = start("moment = 100.0");
        let (field, torque) = (Vector::new(2e-5, -1e-5, 3e-5), Vector::new(1e-4, 2e-4, -1e-4));
        torquers.command(Instant::START, &torque.data.0[0].map(Demand::Torque), [0.0; 3]);
        assert_eq!(torquers.torque_in_field(), Vector::zeros(), "no field is known");
        torquers.update(Instant::START, ActuatorEvent::MagneticField(field));
        torquers.command(Instant::START, &torque.data.0[0].map(Demand::Torque), [0.0; 3]);
        let along = field.normalize();
        let exact = torque - along * along.dot(&torque);
        assert!((torquers.torque_in_field() - exact).norm() < 1e-18);
        // Ten times the torque exceeds the limit: all of it is scaled down.
        let mut weak = start("moment = [4.0, 100.0, 100.0]");
        weak.update(Instant::START, ActuatorEvent::MagneticField(field));
        weak.command(Instant::START, &(torque * 10.0).data.0[0].map(Demand::Torque), [0.0; 3]);
        assert!((weak.moment.x.abs() - 4.0).abs() < 1e-14);
        assert!(
            weak.torque_in_field().cross(&exact).norm() < 1e-18 && weak.torque_in_field().dot(&exact) > 0.0
        );
        let mut wrench = Wrench::default();
        weak.apply(Instant::START, &mut wrench);
        assert_eq!(wrench.moment, weak.moment);
    }

    #[test]
    fn moments_that_are_demanded_are_held_axis_by_axis() {
        let mut torquers = start("moment = [4.0, 5.0, 6.0]");
        torquers.command(Instant::START, &[9.0, -1.0, -7.0].map(Demand::Moment), [0.0; 3]);
        assert_eq!(torquers.moment, Vector::new(4.0, -1.0, -6.0));
    }
}
