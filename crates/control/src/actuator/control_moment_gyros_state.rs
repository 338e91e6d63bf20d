//! Run-time state of control moment gyros: gimbal rates held from command to command, and gimbal angles.
//!
//! While a gimbal rotates at a constant rate, its angle and the momentum of its rotor are known functions of time: the
//! motion evaluates them at its stages. The drives read the exact angles, those of failed gimbals too; estimators and
//! laws are not informed of failures.

use flexsc_dynamics::three_axis::Gimbal;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{self, Report, SteeringRecord};

use super::control_moment_gyros::ControlMomentGyros;
use super::failure::ActiveFailures;
use super::steering::{self, GyroAxes, Robustness};
use super::{
    Actuator, ActuatorEvent, AxisActuatorContext, AxisEffort, AxisResponse, Capabilities, Demand,
    MomentumStorage,
};
use crate::part::{Occasion, Part, ReportContext};

/// Run-time state of the control moment gyros of a body.
#[derive(Clone, Debug)]
pub struct ControlMomentGyrosState {
    axes: Vec<GyroAxes>,
    /// Momentum of each rotor (N m s).
    momentum: f64,
    /// Largest gimbal rate (rad/s).
    limit: f64,
    robust: Option<Robustness>,
    /// Preferred gimbal angles (rad), and the gain towards them (1/s).
    preferred: Option<(Vec<f64>, f64)>,
    settings: Vec<AxisActuatorContext>,
    /// Torque on the body that laws demand, and torque of other sources that the gyros counteract (N m).
    demanded: Vector,
    against: Vector,
    /// Gimbal angles (rad) at the time `since`, and the rates from then on (rad/s).
    since: Instant,
    angles: Vec<f64>,
    rates: Vec<f64>,
    /// Commanded rates of the drives (rad/s), and their failures.
    commanded: Vec<f64>,
    failing: Vec<Option<ActiveFailures>>,
    /// Time of the next update of the rates without a command, and the period of these updates.
    updates: Option<(Instant, Span)>,
    steered: SteeringRecord,
}

/// Returns the largest gimbal rate (rad/s) of a report; `None` without control moment gyros.
pub(super) fn gimbal_rate(report: &Report) -> Option<f64> {
    report.get::<SteeringRecord>().map(|steered| steered.rate_rad_s)
}

impl ControlMomentGyrosState {
    /// Creates the control moment gyros before their first command, on a body with these settings.
    pub fn new(gyros: &ControlMomentGyros, axes: &[GyroAxes], settings: &[AxisActuatorContext]) -> Self {
        let (angles, count) = (gyros.initial_angles(), axes.len());
        let least_measure = steering::singularity_measure(&steering::torque_directions(axes, &angles));
        Self {
            axes: axes.to_vec(),
            momentum: gyros.momentum.get(),
            limit: gyros.rate_limit.map_or(f64::INFINITY, Positive::get),
            robust: gyros.steering_weight(),
            preferred: gyros.null_motion(),
            settings: settings.to_vec(),
            demanded: Vector::zeros(),
            against: Vector::zeros(),
            since: Instant::START,
            angles,
            rates: vec![0.0; count],
            commanded: vec![0.0; count],
            failing: (0..count).map(|gyro| gyros.gimbal_failures(gyro)).collect(),
            updates: gyros.period.map(|period| (Instant::START + period, period)),
            steered: SteeringRecord {
                rate_rad_s: 0.0,
                largest_rate_rad_s: 0.0,
                least_measure,
                largest_error_nm: 0.0,
            },
        }
    }

    fn elapsed(&self, now: Instant) -> f64 {
        now.since(self.since).seconds()
    }

    fn angles_at(&self, now: Instant) -> Vec<f64> {
        let seconds = self.elapsed(now);
        self.angles.iter().zip(&self.rates).map(|(angle, rate)| angle + rate * seconds).collect()
    }

    /// Propagates the angles to `now`.
    fn turn(&mut self, now: Instant) {
        self.angles = self.angles_at(now);
        self.since = now;
    }

    /// Returns the torque on the body (N m) of gimbals with these rates and the columns of their angles.
    fn body_torque(&self, columns: &[Vector], rates: &[f64]) -> Vector {
        columns.iter().zip(rates).fold(Vector::zeros(), |sum, (column, rate)| sum + column * *rate)
            * -self.momentum
    }

    /// Returns the rates that give the body the demanded torque, within the rate limit.
    fn steer(&self, columns: &[Vector], now: Instant) -> Vec<f64> {
        let momentum_rate = (self.against - self.demanded) / self.momentum;
        let mut rates = steering::gimbal_rates(columns, self.robust.as_ref(), &momentum_rate, now.seconds());
        let largest = rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
        if largest > self.limit {
            for rate in &mut rates {
                *rate *= self.limit / largest;
            }
        }
        if let Some((preferred, gain)) = &self.preferred {
            let towards: Vec<f64> =
                preferred.iter().zip(&self.angles).map(|(to, angle)| gain * (to - angle)).collect();
            let more = steering::null_component(columns, &towards);
            // The torque has priority: null motion uses the rest of the limit.
            let part = |(rate, more): (&f64, &f64)| {
                let room = self.limit - libm::copysign(1.0, *more) * rate;
                if more.abs() > room { room.max(0.0) / more.abs() } else { 1.0 }
            };
            let part = rates.iter().zip(&more).map(part).fold(1.0, f64::min);
            rates.iter_mut().zip(more).for_each(|(rate, more)| *rate += part * more);
        }
        rates
    }

    /// Sets the rates to the commanded ones, subject to failures.
    fn drive(&mut self) {
        for (rate, (commanded, failing)) in
            self.rates.iter_mut().zip(self.commanded.iter().zip(&self.failing))
        {
            *rate = failing.as_ref().map_or(*commanded, |failing| failing.output(*commanded));
        }
    }

    /// Updates the rates for the demanded torque and the current angles.
    fn steer_now(&mut self, now: Instant) {
        let columns = steering::torque_directions(&self.axes, &self.angles);
        self.commanded = self.steer(&columns, now);
        self.drive();
        self.update_extremes(&columns);
    }

    /// Updates the extreme values with the rates from now on.
    fn update_extremes(&mut self, columns: &[Vector]) {
        let error = self.body_torque(columns, &self.rates) - (self.demanded - self.against);
        let SteeringRecord { rate_rad_s, largest_rate_rad_s, least_measure, largest_error_nm } =
            &mut self.steered;
        *rate_rad_s = self.rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
        *largest_rate_rad_s = largest_rate_rad_s.max(*rate_rad_s);
        *least_measure = least_measure.min(steering::singularity_measure(columns));
        *largest_error_nm = largest_error_nm.max(error.norm());
    }

    /// Returns the rotors of the body with their motion from `now` on.
    fn rotors(&self, now: Instant) -> impl Iterator<Item = Gimbal> {
        let each = self.axes.iter().zip(self.angles_at(now)).zip(&self.rates);
        each.map(|((axes, angle), rate)| Gimbal {
            spin: axes.spin,
            across: axes.across,
            momentum: self.momentum,
            angle,
            rate: *rate,
        })
    }
}

impl ControlMomentGyrosState {
    /// Starts and ends failures, and updates the rates.
    fn serve(&mut self, now: Instant) {
        let mut any = false;
        for (failing, commanded) in self.failing.iter_mut().zip(&self.commanded) {
            any |= failing.as_mut().is_some_and(|failing| failing.update(now, *commanded));
        }
        let due = self.updates.filter(|(next, _)| *next <= now);
        if let Some((next, period)) = due {
            self.updates = Some((next + period, period));
        }
        if due.is_some() {
            self.turn(now);
            self.steer_now(now);
        } else if any {
            self.turn(now);
            self.drive();
            self.update_extremes(&steering::torque_directions(&self.axes, &self.angles));
        }
    }
}

impl Part for ControlMomentGyrosState {
    fn due(&self) -> Option<Instant> {
        let failing = self.failing.iter().flatten().filter_map(ActiveFailures::due);
        failing.chain(self.updates.map(|(next, _)| next)).min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        match at.occasion {
            Occasion::Period => self.gyros(at.now).into_iter().for_each(|row| report.add(row)),
            Occasion::Cycle => report.add_value(self.steered),
            Occasion::Sample => {}
        }
    }
}

impl MomentumStorage for ControlMomentGyrosState {
    fn stored_momentum(&self, now: Instant) -> [f64; 3] {
        self.rotors(now).fold(Vector::zeros(), |sum, rotor| sum + rotor.at(0.0).0).into()
    }

    fn gyros(&self, now: Instant) -> Option<flexsc_record::ControlMomentGyros> {
        let angles = self.angles_at(now);
        let [x, y, z] = self.stored_momentum(now);
        Some(flexsc_record::ControlMomentGyros {
            singularity: steering::singularity_measure(&steering::torque_directions(&self.axes, &angles)),
            momentum_x_nm_s: x,
            momentum_y_nm_s: y,
            momentum_z_nm_s: z,
            gyros: angles
                .into_iter()
                .zip(&self.rates)
                .map(|(angle_rad, rate)| flexsc_record::ControlMomentGyro { angle_rad, rate_rad_s: *rate })
                .collect(),
        })
    }
}

impl Actuator for ControlMomentGyrosState {
    fn command(&mut self, now: Instant, demands: &[Demand], _: [f64; 3]) {
        self.turn(now);
        for (axis, (demand, setting)) in demands.iter().zip(&self.settings).enumerate().take(3) {
            self.demanded[axis] = setting.demanded_torque(demand);
        }
        self.steer_now(now);
    }

    fn apply(&self, now: Instant, onto: &mut Wrench) {
        onto.gimbals.extend(self.rotors(now));
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        match event {
            ActuatorEvent::CounterTorque(torque) => self.against = torque,
            ActuatorEvent::Due(_) => self.serve(now),
            ActuatorEvent::MagneticField(_)
            | ActuatorEvent::EstimatedRate(_)
            | ActuatorEvent::Rotors(_)
            | ActuatorEvent::Mode(_) => {}
        }
    }

    /// Returns the effort at the last change of the gimbal rates. The reduced moment is that without failures.
    fn effort(&self, axis: usize) -> AxisEffort {
        let columns = steering::torque_directions(&self.axes, &self.angles);
        AxisEffort {
            demanded: self.demanded[axis],
            held: self.body_torque(&columns, &self.rates)[axis],
            firing: 0.0,
            reduced_moment: self.body_torque(&columns, &self.commanded)[axis] / self.settings[axis].inertia,
        }
    }

    fn response(&self, now: Instant, axis: usize, _: [f64; 2]) -> AxisResponse {
        let columns = steering::torque_directions(&self.axes, &self.angles_at(now));
        AxisResponse { applied: self.body_torque(&columns, &self.rates)[axis], rotor: None }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { momentum: Some(self), ..Capabilities::default() }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests;
