//! Reports of a run: the rows of the plant and of all parts at one instant.

use std::borrow::Cow;

use flexsc_control::part::{Occasion, Part, ReportContext, TrueState};
use flexsc_control::sensor::Orientation;
use flexsc_control::state_estimate::DampingStatus;
use flexsc_dynamics::AxisState;
use flexsc_dynamics::three_axis::RotorObservation;
use flexsc_record::{
    AxisRate, GoalMotion, Rates, Record, RecordError, Report, Sample, ThreeAxisCycle, Torque, Torques,
};

use crate::plant::{FlowQuantities, OneAxisQuantities, ThreeAxisQuantities};
use crate::run_view::RunView;
use flexsc_scenario::Scenario;

/// Rows of the torques that a scenario's logs have.
#[derive(Copy, Clone, Debug)]
pub struct TorqueRows {
    /// True if the torque about one axis consists of more than the switchings of a law.
    is_detailed: bool,
    /// True if jets are the only actuator of three axes.
    jets_only: bool,
}

impl TorqueRows {
    /// Returns the rows of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self { is_detailed: scenario.has_torque_rows(), jets_only: scenario.study.jets_alone }
    }
}

impl TrueState for RunView<'_> {
    fn orientation(&self) -> Orientation {
        self.plant.truth().orientation
    }

    fn rates(&self) -> [[f64; 3]; 2] {
        let truth = self.plant.truth();
        [truth.rate, truth.rigid_rate]
    }

    fn about_axis(&self, axis: usize) -> Cow<'_, AxisState> {
        self.plant.about_axis(axis, self.estimation.origin())
    }

    fn mode_rates(&self) -> Vec<f64> {
        match self.plant.quantities() {
            FlowQuantities::OneAxis(motion) => motion.body().mode_rates().collect(),
            FlowQuantities::ThreeAxis(motion) => motion.body().mode_rates().collect(),
        }
    }

    fn rotors(&self) -> Vec<RotorObservation> {
        self.plant.rotor_observations()
    }

    fn gyro_bias(&self) -> [f64; 3] {
        self.sensors.gyro_bias()
    }
}

impl RunView<'_> {
    /// Returns the rows of a dense record: of the plant, and of every part.
    pub fn period_report(&self, torques: TorqueRows) -> Report {
        let mut report = Report::new();
        match self.plant.quantities() {
            FlowQuantities::OneAxis(motion) => self.add_one_axis_rows(motion, torques, &mut report),
            FlowQuantities::ThreeAxis(motion) => self.add_three_axis_rows(motion, torques, &mut report),
        }
        if let Some(monitor) = &self.estimation.monitor {
            report.add(monitor.envelope(self.now));
        }
        let adaptation = self.estimation.search().or(self.laws.objective.search());
        let parts: [&dyn Part; 4] =
            [self.sensors, &*self.estimation.estimator, self.laws, &*self.loads.actuator];
        self.add_reports(Occasion::Period, &[], &parts, &mut report);
        let disturbances = self.loads.own.iter().map(|own| &*own.run as &dyn Part);
        let own: Vec<_> =
            disturbances.chain(self.guidance.own(self.now).map(|own| own as &dyn Part)).collect();
        self.add_reports(Occasion::Period, &[], &own, &mut report);
        if let Some(search) = adaptation {
            self.add_reports(Occasion::Period, &[], &[search.part()], &mut report);
        }
        report
    }

    /// Adds the rows of the estimator after a sample.
    pub fn add_sample(&self, report: &mut Report) {
        self.add_reports(Occasion::Sample, &[], &[&*self.estimation.estimator], report);
    }

    /// Adds the rows of the estimator at the start of a cycle, with this status of active damping about each axis.
    pub fn add_estimator_cycle(&self, damping: &[DampingStatus], report: &mut Report) {
        self.add_reports(Occasion::Cycle, damping, &[&*self.estimation.estimator], report);
    }

    /// Adds the values of a three-axis body and the rows of its actuator at the start of a cycle.
    pub fn add_actuator_cycle(&self, motion: &dyn ThreeAxisQuantities, report: &mut Report) {
        let (rigid, elastic) = motion.body().rates;
        let (elastic_energy_j, visible_energy_j) = motion.elastic_energies();
        let actuator = &*self.loads.actuator;
        report.add_value(ThreeAxisCycle {
            visit: self.guidance.visit(self.now),
            elastic_energy_j,
            visible_energy_j,
            rigid_rate_rad_s: rigid.into(),
            elastic_rate_rad_s: elastic.into(),
            error_rad: self.sensors.angles_of(&self.plant.truth().orientation, self.estimation.origin()),
            slewing: self.guidance.slews(self.now),
            friction_heat_j: motion.friction_heat(),
            stored_momentum_nm_s: actuator.capabilities().stored_momentum(self.now),
        });
        self.add_reports(Occasion::Cycle, &[], &[actuator], report);
    }

    /// Adds the rows of some parts at the current instant to a report.
    fn add_reports(
        &self,
        occasion: Occasion,
        damping: &[DampingStatus],
        parts: &[&dyn Part],
        report: &mut Report,
    ) {
        let axes = self.estimation.axis_count();
        let at = ReportContext { now: self.now, occasion, axes, truth: self, damping };
        for part in parts {
            part.report(&at, report);
        }
    }

    /// Adds the rows of a one-axis plant, of the manoeuvre, and of the torques.
    fn add_one_axis_rows(&self, motion: &dyn OneAxisQuantities, torques: TorqueRows, report: &mut Report) {
        let now = self.now;
        let measured = self.sensors.reading.map_or(0.0, |_| self.sensors.measured[0][0]);
        let (attitude, rate, modes) =
            motion.body().motion_rows((!self.sensors.is_continuous()).then_some(measured));
        if torques.is_detailed {
            let rates = [rate.rate_rad_s, rate.rigid_rad_s];
            let (angle_rad, rate_rad_s) = self.guidance.manoeuvre_state(now);
            report.add(GoalMotion { angle_rad, rate_rad_s });
            report.add(Torque {
                feedforward_nm: self.guidance.feedforward(now),
                feedback_nm: self.loads.actuator.effort(0).demanded,
                applied_nm: self.loads.actuator.response(now, 0, rates).applied,
                disturbance_nm: self.loads.disturbance(now, 0),
            });
        }
        report.add(attitude);
        report.add(rate);
        report.add(modes);
        motion.output_row().into_iter().for_each(|row| report.add(row));
    }

    /// Adds the rows of a three-axis plant and of the torques.
    fn add_three_axis_rows(
        &self,
        motion: &dyn ThreeAxisQuantities,
        torques: TorqueRows,
        report: &mut Report,
    ) {
        let now = self.now;
        let (rigid, elastic) = motion.body().rates;
        let axis = |axis: usize| AxisRate {
            rate_rad_s: rigid[axis] + elastic[axis],
            rigid_rad_s: rigid[axis],
            elastic_rad_s: elastic[axis],
            measured_rad_s: self.sensors.measured[axis][1],
            believed_rad_s: self.estimation.estimates[axis].rate,
        };
        let actuator = &self.loads.actuator;
        let (around, magnetic) = (motion.environment_torque(), motion.magnetic_torque());
        let torque = |axis: usize| {
            let rates = [rigid[axis] + elastic[axis], rigid[axis]];
            Torque {
                feedforward_nm: 0.0,
                feedback_nm: actuator.effort(axis).demanded,
                applied_nm: magnetic[axis] + actuator.response(now, axis, rates).applied,
                disturbance_nm: {
                    let others = self.loads.disturbance(now, axis);
                    around.map_or(others, |around| others + around[axis])
                },
            }
        };
        // If only jets act, the torques follow from the recorded pulses.
        if !torques.jets_only || motion.surroundings().is_some() {
            report.add(Torques { axes: [0, 1, 2].map(torque).into() });
        }
        let error = self.plant.truth().orientation.error_from(&self.guidance.origin(now));
        report.add(motion.pointing(error));
        report.add(Rates { axes: [0, 1, 2].map(axis).into() });
        motion.add_rows(report);
    }

    /// Records a report of the current instant, unless it is empty.
    pub fn record_report(&self, report: &Report, record: &mut dyn Record) -> Result<(), RecordError> {
        if report.is_empty() { Ok(()) } else { record.record(self.now, Sample::Report(report)) }
    }
}
