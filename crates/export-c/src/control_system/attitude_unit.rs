//! Attitude filter of a control system: gyro readings and observations in, attitude and rate out.

use flexsc_core::Scenario;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::control::estimator::attitude::{FilterSetup, SensorRole};
use flexsc_core::control::sensor::SensorKind;
use flexsc_core::numerics::flight_types::{to_matrix3, to_matrix6x3};
use flexsc_core::numerics::time::Span;
use flexsc_flight::attitude_estimator::AttitudeEstimator;
use flexsc_flight::attitude_filter::GyroNoise;
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::attitude_history::{AttitudeHistoryEntry, REFUSAL_COUNTERS};
use flexsc_flight::attitude_observation::{AttitudeObservation, ObservationKind};
use flexsc_flight::delayed_observation::DelayedObservation;
use flexsc_flight::matrix6::Matrix6x3;
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::reading_status::ReadingStatus;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use flexsc_flight_precision::Precision;

use super::{CallLayout, Channel, WordReader};

/// Sensor whose observations correct the filter.
#[derive(Clone, Debug)]
pub struct Corrector {
    /// Index of the sensor in the scenario.
    pub sensor: usize,
    /// Name of its members in C.
    pub name: String,
    /// Time from exposure to reading.
    pub latency: Ticks,
    /// Observation without its numbers: kind, covariance and constant gain.
    pub observation: AttitudeObservation,
}

impl Corrector {
    /// Returns true for a sensor of a vector, whose reference is an input.
    pub fn is_of_vector(&self) -> bool {
        self.observation.kind != ObservationKind::Attitude
    }
}

/// Attitude filter with its storage.
#[derive(Clone, Debug)]
pub struct AttitudeUnit {
    /// Estimator.
    pub estimator: AttitudeEstimator,
    /// Storage of the recent past.
    pub entries: Vec<AttitudeHistoryEntry>,
    /// Storage of observations.
    pub observations: Vec<DelayedObservation>,
    /// Noise of the gyro in the filter's model.
    pub noise: GyroNoise,
    /// Largest delay of an observation.
    pub reach: Ticks,
    /// Limits of the readings.
    pub gate: AttitudeGate,
    /// Standard deviations of attitude (rad) and bias (rad/s) at the start.
    pub deviations: [f64; 2],
    /// Index of the gyro, and its latency.
    pub gyro: (usize, Ticks),
    /// Sensors that correct the filter.
    pub correctors: Vec<Corrector>,
    precision: Precision,
}

impl AttitudeUnit {
    /// Returns the attitude filter that the laws of a scenario read; `None` if they read something else, or if the filter
    /// estimates modes too: then the estimates are inputs.
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let Some(EstimatorKind::Attitude(spec)) = &scenario.estimator else { return None };
        let setup = scenario.study.attitude.as_ref()?;
        if spec.watch_only || spec.elastic.is_some() {
            return None;
        }
        let sensors = &scenario.sensor[..];
        let (mut gyro, mut correctors) = (None, Vec::new());
        for (sensor, (role, kind)) in setup.roles.iter().zip(sensors).enumerate() {
            match role {
                SensorRole::Gyro { latency } => gyro = Some((sensor, latency.ticks())),
                SensorRole::Corrects { latency, noise, gain } => {
                    let same = sensors.iter().filter(|other| other.kind() == kind.kind()).count();
                    let name =
                        if same > 1 { format!("{}_{sensor}", kind.kind()) } else { kind.kind().to_owned() };
                    correctors.push(Corrector {
                        sensor,
                        name,
                        latency: latency.ticks(),
                        observation: AttitudeObservation {
                            kind: observation_kind(kind),
                            noise: to_matrix3(noise),
                            has_gain: gain.is_some(),
                            gain: gain.as_deref().map_or(Matrix6x3::ZERO, to_matrix6x3),
                            ..AttitudeObservation::NONE
                        },
                    });
                }
                SensorRole::None => {}
            }
        }
        let deviations = [spec.initial.angle.get(), spec.initial.bias.get()];
        let (entries, observations) = storage(scenario, setup, sensors);
        Some(Self::started(setup, deviations, gyro?, correctors, entries, observations))
    }

    /// Returns the filter at the identity, with storage of these sizes.
    fn started(
        setup: &FilterSetup,
        deviations: [f64; 2],
        gyro: (usize, Ticks),
        correctors: Vec<Corrector>,
        entries: usize,
        observations: usize,
    ) -> Self {
        let mut entries = vec![AttitudeHistoryEntry::NONE; entries];
        let precision = setup.precision;
        let filter = precision.filter(Quaternion::IDENTITY, Vector3::ZERO, deviations);
        let (noise, reach, gate) = (setup.noise, setup.reach.ticks(), setup.gate);
        Self {
            estimator: precision.start_estimator(Ticks::default(), filter, noise, reach, gate, &mut entries),
            entries,
            observations: vec![DelayedObservation::NONE; observations],
            noise,
            reach,
            gate,
            deviations,
            gyro,
            correctors,
            precision,
        }
    }

    /// Returns the functions: the start of the estimate, and a sample of the sensors.
    pub(super) fn calls(&self) -> [CallLayout; 2] {
        let attitude = || Channel::unit("attitude", "Estimated attitude: quaternion w, x, y, z", 4);
        let start = CallLayout {
            is_start: true,
            inputs: vec![attitude(), Channel::real("bias", "Estimated gyro bias (rad/s)", 3, 1e-5)],
            outputs: vec![attitude()],
            ..CallLayout::new(
                "start",
                "Starts the attitude filter at this time with an attitude and a gyro bias; at any time, and again after a fault.",
            )
        };
        let mut inputs = vec![
            Channel::flag("gyro_is_valid", "True if there is a gyro reading", 1),
            Channel::real("gyro_rate", "Gyro reading (rad/s)", 3, 1e-2).within(self.gate.most_rate),
        ];
        for corrector in &self.correctors {
            let name = &corrector.name;
            inputs.push(Channel::flag(&format!("{name}_is_valid"), "True if there is a measurement", 1));
            if corrector.observation.kind == ObservationKind::Attitude {
                let about = "Measured attitude: quaternion w, x, y, z";
                inputs.push(Channel::unit(&format!("{name}_attitude"), about, 4));
            } else {
                let is_unit = corrector.observation.kind == ObservationKind::Direction;
                let mut vector = |name: String, about: &str| {
                    inputs.push(Channel { is_unit, ..Channel::real(&name, about, 3, 1.0) });
                };
                vector(format!("{name}_vector"), "Measured vector, body axes");
                let about = "Reference of the vector at its exposure, inertial axes";
                vector(format!("{name}_reference"), about);
            }
        }
        let status = |name: &str| {
            let about = "Outcome of the reading: 0 there was none, 1 accepted, 2 accepted after refusals, 3 waits for a gyro \
                         reading; refused: 4 not sound, 5 improbable, 6 too old";
            Channel::integer(&format!("{name}_status"), about, 1, 7)
        };
        let mut outputs =
            vec![attitude(), Channel::real("rate", "Estimated rate (rad/s)", 3, 1.0), status("gyro")];
        outputs.extend(self.correctors.iter().map(|corrector| status(&corrector.name)));
        let refused =
            |name: String| Channel::integer(&name, "Number of readings refused since the start", 1, 0);
        outputs.extend([
            refused("refused".to_owned()),
            refused("gyro_refused".to_owned()),
            Channel::real("age", "Time since the last correction, or since the start (s)", 1, 1.0),
            Channel::real("innovation", "Innovation of the last correction, body axes (rad)", 3, 1.0),
            Channel::real(
                "nis",
                "Its normalised square over its dimension: about 1 of sound readings",
                1,
                1.0,
            ),
            Channel::real("deviation", "Standard deviation of the attitude about each axis (rad)", 3, 1.0),
        ]);
        outputs
            .extend(self.correctors.iter().map(|corrector| refused(format!("{}_refused", corrector.name))));
        let sample =
            CallLayout { inputs, outputs, ..CallLayout::new("sample", "Takes a sample of the sensors.") };
        [start, sample]
    }

    /// Starts the filter at the identity.
    pub(super) fn start_at_identity(&mut self, now: Ticks) {
        self.start_with(now, Quaternion::IDENTITY, Vector3::ZERO);
    }

    /// Starts the filter, and returns the words of the outputs.
    pub(super) fn start(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let mut words = WordReader::new(inputs);
        let (attitude, bias) = (quaternion(&mut words), vector(&mut words));
        self.start_with(now, attitude, bias);
        quaternion_words(&self.attitude(now)).to_vec()
    }

    /// Starts the filter with an attitude and a bias (rad/s).
    fn start_with(&mut self, now: Ticks, attitude: Quaternion, bias: Vector3) {
        let Self { precision, noise, reach, gate, .. } = *self;
        let filter = precision.filter(attitude, bias, self.deviations);
        self.estimator = precision.start_estimator(now, filter, noise, reach, gate, &mut self.entries);
    }

    /// Takes a sample, and returns the words of the outputs.
    pub(super) fn sample(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let mut words = WordReader::new(inputs);
        let (is_valid, rate) = (words.flag(), vector(&mut words));
        let Self { estimator, entries, observations, precision, .. } = self;
        let mut statuses = vec![ReadingStatus::None; 1 + self.correctors.len()];
        if is_valid {
            statuses[0] = precision.take_gyro(estimator, [now, self.gyro.1], rate, entries, observations);
        }
        for (sensor, (corrector, status)) in (1..).zip(self.correctors.iter().zip(&mut statuses[1..])) {
            let is_valid = words.flag();
            let mut observation = corrector.observation;
            if observation.kind == ObservationKind::Attitude {
                observation.attitude = quaternion(&mut words);
            } else {
                observation.vector = vector(&mut words);
                observation.inertial = vector(&mut words);
            }
            if is_valid {
                let times = [now, corrector.latency];
                *status =
                    precision.take_observation(estimator, sensor, times, &observation, entries, observations);
            }
        }
        let own = precision.output(estimator, now, entries);
        let counters = &estimator.history.refused;
        let mut outputs = quaternion_words(&own.attitude).to_vec();
        outputs.extend(vector_words(&own.rate));
        outputs.extend(statuses.into_iter().map(|status| status as u64));
        outputs.extend([own.refused, counters[0], own.age.to_bits()]);
        outputs.extend(vector_words(&own.innovation));
        outputs.push(own.nis.to_bits());
        outputs.extend(vector_words(&own.deviation));
        outputs.extend((1..).zip(&self.correctors).map(|(sensor, _)| counters[counter(sensor)]));
        outputs
    }

    /// Returns the attitude.
    pub(super) fn attitude(&self, now: Ticks) -> Quaternion {
        self.precision.attitude(&self.estimator, now, &self.entries)
    }

    /// Returns the rate (rad/s).
    pub(super) fn rate(&self) -> Vector3 {
        self.precision.rate(&self.estimator, &self.entries)
    }

    /// Returns the rotation vector (rad) from a target attitude.
    pub(super) fn angle_from(&self, target: &Quaternion, now: Ticks) -> Vector3 {
        self.precision.rotation(target, &self.attitude(now))
    }

    /// Returns the time since the last correction (s).
    pub(super) fn age(&self, now: Ticks) -> f64 {
        self.precision.seconds(now.since(self.estimator.history.corrected))
    }

    /// Returns the size of the last innovation (rad).
    pub(super) fn innovation_size(&self) -> f64 {
        self.precision.innovation_size(&self.estimator.correction.innovation)
    }

    /// Returns the standard deviation of the attitude about all axes together (rad).
    pub(super) fn deviation_size(&self) -> f64 {
        self.precision.deviation_size(&self.entries[self.estimator.history.latest()].filter)
    }
}

/// Returns the index of the counter of refused readings of a sensor.
pub fn counter(sensor: usize) -> usize {
    sensor.min(REFUSAL_COUNTERS - 1)
}

/// Returns the quantity that a sensor measures.
fn observation_kind(kind: &SensorKind) -> ObservationKind {
    if kind.measures_field() {
        ObservationKind::Vector
    } else if kind.measures_vector() {
        ObservationKind::Direction
    } else {
        ObservationKind::Attitude
    }
}

/// Returns the numbers of entries and observations that the recent past may need, twice over, so that it is seldom moved.
fn storage(scenario: &Scenario, setup: &FilterSetup, sensors: &[SensorKind]) -> (usize, usize) {
    let cycle = scenario.law.period();
    let within = |kind: &SensorKind| {
        let period = kind.period(cycle).map_or(1.0, Span::seconds);
        (setup.reach.seconds() / period).ceil() as usize + 2
    };
    let each = setup.roles.iter().zip(sensors);
    let corrections: usize = each
        .clone()
        .filter(|(role, _)| matches!(role, SensorRole::Corrects { .. }))
        .map(|(_, kind)| within(kind))
        .sum();
    let gyro: usize =
        each.filter(|(role, _)| matches!(role, SensorRole::Gyro { .. })).map(|(_, kind)| within(kind)).sum();
    (2 * (gyro + corrections + 1), 2 * (corrections + 1))
}

pub(super) fn quaternion(words: &mut WordReader<'_>) -> Quaternion {
    let [w, x, y, z] = words.reals();
    Quaternion { w, x, y, z }
}

pub(super) fn vector(words: &mut WordReader<'_>) -> Vector3 {
    let [x, y, z] = words.reals();
    Vector3 { x, y, z }
}

pub(super) fn vector_words(v: &Vector3) -> [u64; 3] {
    [v.x, v.y, v.z].map(f64::to_bits)
}

fn quaternion_words(q: &Quaternion) -> [u64; 4] {
    [q.w, q.x, q.y, q.z].map(f64::to_bits)
}
