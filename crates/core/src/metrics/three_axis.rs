//! Metrics of a run of a three-axis body: propellant, firings, elastic energy, pointing.

use flexsc_control::actuator::JetCycle;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Instant;
use flexsc_record::{
    Accelerations, ModeTargetStart, Report, Sliding, SteeringRecord, ThreeAxisCycle, WheelEvent,
};

use super::goal::GoalMetrics;
use super::limits::LimitMetrics;
use super::mode_bands::ModeBands;
use super::{
    ACCELERATION, BELOW_1, BELOW_10, BURN_IMPULSE, ELASTIC_END, ELASTIC_PEAK, ELASTIC_RATE, FIRING_CYCLES,
    FIRINGS, FRICTION_HEAT, FUEL, FUEL_AXES, FUEL_THRUSTERS, GIMBAL_RATE, GYRO_MOMENTUM_END,
    GYRO_MOMENTUM_PEAK, MOMENTUM_END, MOMENTUM_PEAK, MetricValue, NamedMetric, POINTING_END, POINTING_RMS,
    RATE_END, SINGULARITY, SLEW_PEAK, SLEW_RMS, TORQUE_ERROR, VISIBLE_END, VISIBLE_PEAK, WHEEL_STOPS,
    ZERO_CROSSINGS,
};
use flexsc_scenario::{Pointing, Scenario};

/// Length of the end of a run over which elastic rates are averaged (s).
const LATE: f64 = 200.0;

/// Collector of the cycles of a run.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct ThreeAxisMetrics {
    /// Time from which on a cycle is late (s).
    late: f64,
    /// True if there are jets, whose propellant and pulses are counted.
    jets: bool,
    /// True if wheels have friction; numbers of zero crossings and stictions, last sliding direction of each wheel, and
    /// heat (J).
    has_friction: bool,
    friction_events: (u64, u64),
    /// For each accelerometer its index among the sensors, the sum of the squares of its samples, and their number.
    accelerations: Vec<(u64, f64, u64)>,
    sliding_directions: Vec<Option<Sliding>>,
    heat: f64,
    fuel: f64,
    /// Propellant used (kg) by axis or by thruster, and true if by thruster.
    fuels: (Vec<f64>, bool),
    /// Impulse of the jets in burns (N s), if there are any.
    burn_impulse: Option<f64>,
    /// Number of pulses, and number of cycles with any.
    firings: (u64, u64),
    /// Elastic energy: initial, largest, and last (J).
    energy: (f64, f64, f64),
    /// Elastic energy of the modes that the gyro observes: largest, and last (J).
    visible: (f64, f64),
    /// Times at which this energy was first below a tenth and a hundredth of its initial value (s).
    below: [f64; 2],
    /// Sum of the squared elastic rates of late cycles (rad²/s²), and the number of these cycles.
    square: (f64, u64),
    /// Square of the last error (rad²).
    error: f64,
    /// Whether there are magnetorquers.
    magnetic: bool,
    /// Square of the last rigid rate (rad²/s²).
    rate: f64,
    /// Squares of the largest and the last momentum of wheels and gyros (N² m² s²).
    stored: [f64; 2],
    /// Values of control moment gyros.
    steered: Option<SteeringRecord>,
    limits: LimitMetrics,
    /// Largest and sum of the squared errors during slews (rad²), and the number of these cycles.
    slews: (f64, f64, u64),
    /// True if there are slews.
    has_slews: bool,
    /// Window of the pointing error, sum of the squared errors that count (rad²), and their number.
    pointing_window: Option<Pointing>,
    pointing: (f64, u64),
    verdict: GoalMetrics,
    /// Half width of the band about the target on each axis (rad), and the start of the current time outside (s).
    bands: [f64; 3],
    outside: Option<f64>,
    end: f64,
    modes: ModeBands,
}

impl ThreeAxisMetrics {
    /// Creates an empty collector for runs of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let end = Instant::START + scenario.duration;
        let own: [f64; 3] = std::array::from_fn(|axis| {
            scenario.study.expected_bands.get(axis).copied().flatten().unwrap_or(f64::NAN)
        });
        let modes = ModeBands::new(scenario);
        let own = modes.first().unwrap_or(own);
        let bands = scenario.reference.band.map_or(own, |band| [Positive::get(band); 3]);
        let from = scenario.last_target_start(end).seconds();
        Self {
            verdict: GoalMetrics::new(from, bands.into_iter().fold(0.0, f64::max)),
            bands,
            outside: None,
            end: end.seconds(),
            late: scenario.duration.seconds() - LATE,
            jets: scenario.study.fires(),
            burn_impulse: scenario.actuator.jets().filter(|(jets, _)| !jets.burns.is_empty()).map(|_| 0.0),
            has_friction: scenario
                .study
                .bearings
                .iter()
                .any(|bearing| bearing.viscous + bearing.breakaway > 0.0),
            friction_events: (0, 0),
            accelerations: scenario
                .sensor
                .accelerometers()
                .map(|(index, _)| (index as u64, 0.0, 0))
                .collect(),
            sliding_directions: vec![None; scenario.study.bearings.len()],
            heat: 0.0,
            fuel: 0.0,
            fuels: (Vec::new(), scenario.actuator.jets().is_some_and(|(jets, _)| jets.is_by_thruster())),
            firings: (0, 0),
            energy: (f64::NAN, 0.0, f64::NAN),
            visible: (0.0, f64::NAN),
            below: [f64::NAN; 2],
            square: (0.0, 0),
            error: f64::NAN,
            magnetic: scenario.actuator.magnetorquers().is_some(),
            limits: LimitMetrics::new(scenario),
            slews: (f64::NAN, 0.0, 0),
            has_slews: scenario.study.profile.has_slews() || slews_to_mode(scenario),
            modes,
            rate: f64::NAN,
            stored: [0.0, f64::NAN],
            steered: (!scenario.study.gimbals.is_empty()).then(SteeringRecord::unknown),
            pointing_window: scenario.reference.pointing.clone(),
            pointing: (0.0, 0),
        }
    }

    /// Observes the start of a mode of operation with a target: the goal begins with it.
    fn observe_target(&mut self, now: Instant, start: ModeTargetStart) {
        if let Some(bands) = self.modes.bands(start) {
            self.bands = bands;
        }
        self.verdict = GoalMetrics::new(now.seconds(), self.bands.into_iter().fold(0.0, f64::max));
        self.outside = None;
    }

    /// Observes the report of a cycle; other reports have no cycle.
    pub fn observe_cycle(&mut self, now: Instant, report: &Report) {
        let Some(cycle) = report.get::<ThreeAxisCycle>() else {
            report.get::<ModeTargetStart>().into_iter().for_each(|start| self.observe_target(now, *start));
            return;
        };
        let (t, energy) = (now.seconds(), cycle.elastic_energy_j);
        let norm = |vector: [f64; 3]| vector.iter().map(|value| value * value).sum::<f64>();
        if self.jets || self.burn_impulse.is_some() {
            report.get().into_iter().for_each(|jets| self.observe_jets(jets));
        }
        self.limits.observe(now, report);
        if cycle.slewing {
            let square = norm(cycle.error_rad);
            self.slews = (self.slews.0.max(square), self.slews.1 + square, self.slews.2 + 1);
        }
        self.heat = cycle.friction_heat_j;
        if self.energy.0.is_nan() {
            self.energy.0 = energy;
        }
        self.energy = (self.energy.0, self.energy.1.max(energy), energy);
        self.visible = (self.visible.0.max(cycle.visible_energy_j), cycle.visible_energy_j);
        for (below, part) in self.below.iter_mut().zip([0.1, 0.01]) {
            if below.is_nan() && energy < part * self.energy.0 {
                *below = t;
            }
        }
        if t >= self.late {
            self.square.0 += norm(cycle.elastic_rate_rad_s);
            self.square.1 += 1;
        }
        self.error = norm(cycle.error_rad);
        self.rate = norm(cycle.rigid_rate_rad_s);
        let stored = norm(cycle.stored_momentum_nm_s);
        self.stored = [self.stored[0].max(stored), stored];
        if self.steered.is_some() {
            self.steered = report.get().copied();
        }
        if self.pointing_window.as_ref().is_some_and(|pointing| pointing.includes(t)) {
            self.pointing.0 += norm(cycle.error_rad);
            self.pointing.1 += 1;
        }
        if let Some(since) = self.outside.take() {
            self.verdict.add_outside(since, t);
        }
        let is_outside = cycle.error_rad.iter().zip(self.bands).any(|(error, band)| error.abs() > band);
        self.outside = is_outside.then_some(t);
    }

    /// Observes the jets of a cycle, which may have cycles of their own.
    fn observe_jets(&mut self, jets: &JetCycle) {
        self.fuel = jets.fuel;
        self.fuels.0.clone_from(&jets.fuels);
        self.burn_impulse.iter_mut().for_each(|impulse| *impulse = jets.burn_impulse);
        self.firings.1 += u64::from(jets.pulses > self.firings.0);
        self.firings.0 = jets.pulses;
    }

    /// Records a sample of an accelerometer.
    pub fn observe_acceleration(&mut self, row: &Accelerations) {
        if let Some((_, square, count)) =
            self.accelerations.iter_mut().find(|(sensor, ..)| *sensor == row.sensor)
        {
            *square += row.axes.iter().map(|axis| axis.measured_m_s2 * axis.measured_m_s2).sum::<f64>();
            *count += 1;
        }
    }

    /// Records a wheel's transition between sliding and sticking.
    pub fn observe_bearing_event(&mut self, event: &WheelEvent) {
        let Some(direction) = self.sliding_directions.get_mut(event.wheel as usize) else { return };
        if event.after == Sliding::Stuck {
            self.friction_events.1 += 1;
            *direction = Some(event.before);
        } else {
            let previous = if event.before == Sliding::Stuck { direction.take() } else { Some(event.before) };
            self.friction_events.0 += u64::from(previous.is_some_and(|previous| previous != event.after));
        }
    }

    /// Returns the metrics of the run that has ended.
    pub fn finish(mut self) -> Vec<NamedMetric> {
        if let Some(since) = self.outside {
            self.verdict.add_outside(since, self.end);
        }
        let [tenth, hundredth] = self.below;
        let jets = [
            (&FUEL, MetricValue::Number(self.fuel)),
            (&FIRINGS, MetricValue::Count(self.firings.0)),
            (&FIRING_CYCLES, MetricValue::Count(self.firings.1)),
        ];
        let friction = [
            (&ZERO_CROSSINGS, MetricValue::Count(self.friction_events.0)),
            (&WHEEL_STOPS, MetricValue::Count(self.friction_events.1)),
            (&FRICTION_HEAT, MetricValue::Number(self.heat)),
        ];
        let metrics = [
            (&ELASTIC_PEAK, MetricValue::Number(self.energy.1)),
            (&ELASTIC_END, MetricValue::Number(self.energy.2)),
            (&VISIBLE_PEAK, MetricValue::Number(self.visible.0)),
            (&VISIBLE_END, MetricValue::Number(self.visible.1)),
            (&BELOW_10, MetricValue::Number(tenth)),
            (&BELOW_1, MetricValue::Number(hundredth)),
            (&ELASTIC_RATE, MetricValue::Number(f64::sqrt(self.square.0 / self.square.1 as f64))),
            (&POINTING_END, MetricValue::Number(f64::sqrt(self.error))),
        ];
        let fuels = if self.fuels.1 { &FUEL_THRUSTERS } else { &FUEL_AXES };
        let fuels = (fuels, MetricValue::Numbers(self.fuels.0));
        let burn = self.burn_impulse.map(|impulse| (&BURN_IMPULSE, MetricValue::Number(impulse)));
        let jets = jets.into_iter().chain([fuels]).filter(|_| self.jets).chain(burn);
        let friction = friction.into_iter().filter(|_| self.has_friction);
        let rate =
            [(&RATE_END, MetricValue::Number(f64::sqrt(self.rate)))].into_iter().filter(|_| self.magnetic);
        let [momentum_peak, momentum_end] = self.stored.map(f64::sqrt);
        let stored = [
            (&MOMENTUM_PEAK, MetricValue::Number(momentum_peak)),
            (&MOMENTUM_END, MetricValue::Number(momentum_end)),
        ];
        let has_wheels = self.limits.has_wheels();
        let stored = stored.into_iter().filter(|_| has_wheels);
        let slews = [
            (&SLEW_PEAK, MetricValue::Number(f64::sqrt(self.slews.0))),
            // 0/0 of no cycles: no number.
            (&SLEW_RMS, MetricValue::Number(f64::sqrt(self.slews.1 / self.slews.2 as f64))),
        ];
        let slews = slews.into_iter().filter(|_| self.has_slews);
        let steered = self.steered.map(|steered| {
            [
                (&GIMBAL_RATE, MetricValue::Number(steered.largest_rate_rad_s)),
                (&SINGULARITY, MetricValue::Number(steered.least_measure)),
                (&TORQUE_ERROR, MetricValue::Number(steered.largest_error_nm)),
                (&GYRO_MOMENTUM_PEAK, MetricValue::Number(momentum_peak)),
                (&GYRO_MOMENTUM_END, MetricValue::Number(momentum_end)),
            ]
        });
        let mut pointing: Vec<NamedMetric> = Vec::new();
        if self.pointing_window.is_some() {
            // Without cycles the mean is 0/0: NaN.
            let rms = f64::sqrt(self.pointing.0 / self.pointing.1 as f64);
            pointing.push((&POINTING_RMS, MetricValue::Number(rms)));
        }
        let displacement =
            self.accelerations.iter().map(|(_, square, count)| f64::sqrt(square / *count as f64));
        let mean_displacement = (!self.accelerations.is_empty())
            .then(|| (&ACCELERATION, MetricValue::Numbers(displacement.collect())));
        jets.chain(friction)
            .chain(metrics)
            .chain(mean_displacement)
            .chain(rate)
            .chain(stored)
            .chain(self.limits.finish())
            .chain(steered.into_iter().flatten())
            .chain(slews)
            .chain(pointing)
            .chain(self.verdict.finish(self.end))
            .collect()
    }
}

/// Returns true if a mode of operation has a target that is reached by a slew.
fn slews_to_mode(scenario: &Scenario) -> bool {
    scenario.mode.iter().any(|mode| mode.target.as_ref().is_some_and(|target| target.acceleration.is_some()))
}
