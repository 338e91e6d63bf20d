//! Telemetry of a run at an instant: the last reading of each sensor, and what the laws would read, for control by another
//! program.

use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::{AttitudeErrorMeasure, ReferenceNeeds};
use flexsc_control::sensor::{MeasuredQuantity, Reading, SensorKind};
use flexsc_control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_numerics::time::Instant;

use super::run_view::RunView;
use super::{Simulation, SimulationError};
use flexsc_scenario::Scenario;

/// Names of the components of vectors and quaternions.
const VECTOR: &[&str] = &["x", "y", "z"];
const QUATERNION: &[&str] = &["w", "x", "y", "z"];

/// Quantity in the telemetry of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TelemetryField {
    /// Name, from its group and the quantity, such as `gyro.rate`.
    pub name: String,
    /// Unit; empty for a dimensionless field.
    pub unit: &'static str,
    /// Names of the components; empty for a scalar.
    pub components: Vec<String>,
    /// Meaning, as a noun phrase.
    pub meaning: &'static str,
}

impl TelemetryField {
    fn new(group: &str, name: &str, unit: &'static str, meaning: &'static str) -> Self {
        Self { name: format!("{group}.{name}"), unit, components: Vec::new(), meaning }
    }

    fn measured(group: &str, quantity: MeasuredQuantity) -> Self {
        let MeasuredQuantity { name, unit, components, meaning } = quantity;
        Self { name: format!("{group}.{name}"), unit, components, meaning }
    }

    fn with(mut self, components: &[&str]) -> Self {
        self.components = components.iter().map(|&name| name.to_owned()).collect();
        self
    }

    fn numbered(mut self, count: usize) -> Self {
        self.components = (1..=count).map(|number| number.to_string()).collect();
        self
    }

    /// Returns the number of values.
    pub fn width(&self) -> usize {
        self.components.len().max(1)
    }
}

/// Sensor in the telemetry of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TelemetrySensor {
    /// Group of its fields: the kind of the sensor, numbered from the second of a kind on.
    pub group: String,
    /// Index among the sensors of the scenario.
    pub index: usize,
    /// Quantities that it measures.
    pub fields: Vec<TelemetryField>,
}

/// Quantities of the telemetry of a scenario's run, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TelemetryLayout {
    /// Sensors.
    pub sensors: Vec<TelemetrySensor>,
    /// Estimate and reference that the laws read, and speeds of the wheels.
    pub law_inputs: Vec<TelemetryField>,
}

/// Last reading of a sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorTelemetry {
    /// Instant at which the reading became available; `None` before the first.
    pub at: Option<Instant>,
    /// Values of the sensor's fields; 0 before the first reading.
    pub values: Vec<f64>,
}

/// Telemetry of a run at an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Telemetry {
    /// Last reading of each sensor of the layout.
    pub sensors: Vec<SensorTelemetry>,
    /// Values of the layout's law inputs.
    pub law_inputs: Vec<f64>,
}

impl TelemetryLayout {
    fn new(run: &RunView<'_>, scenario: &Scenario) -> Self {
        let axes = scenario.axis_count();
        let sensors = scenario.sensor.iter().enumerate().filter_map(|(index, sensor)| {
            let kind = sensor.kind();
            let group = match scenario.sensor.index_in_kind(index) {
                0 => kind.to_owned(),
                earlier => format!("{kind}_{}", earlier + 1),
            };
            let quantities = sensor.measured_quantities(scenario.sensor.provides_attitude(index), axes);
            let fields = quantities.into_iter().map(|measured| TelemetryField::measured(&group, measured));
            let fields: Vec<_> = fields.collect();
            (!fields.is_empty()).then_some(TelemetrySensor { group, index, fields })
        });
        Self { sensors: sensors.collect(), law_inputs: law_inputs(run, scenario, axes) }
    }
}

/// Returns the quantities that the laws read.
fn law_inputs(run: &RunView<'_>, scenario: &Scenario, axes: usize) -> Vec<TelemetryField> {
    let field = |group: &str, name, unit, meaning| {
        let field = TelemetryField::new(group, name, unit, meaning);
        if axes > 1 { field.with(VECTOR) } else { field }
    };
    let angle = if axes > 1 {
        "rotation vector from the reference attitude to the estimated one"
    } else {
        "estimated angle"
    };
    let mut fields = vec![
        field("estimate", "angle", "rad", angle),
        field("estimate", "rate", "rad/s", "estimated rate in body axes"),
    ];
    if axes > 1 {
        let meaning =
            "twice the vector part of the quaternion from the reference attitude to the estimated one";
        fields.push(field("estimate", "error", "rad", meaning));
    }
    if scenario.sensor.iter().any(SensorKind::measures_field) {
        fields.push(field("estimate", "field_rate", "T/s", "rate of change of the measured magnetic field"));
    }
    if has_dominant_mode(scenario) {
        fields.push(field("estimate", "mode_displacement", "rad", "displacement of the dominant mode"));
        fields.push(field("estimate", "mode_rate", "rad/s", "rate of the dominant mode"));
        fields.push(field("estimate", "mode_frequency", "rad/s", "frequency of the dominant mode"));
    }
    if axes > 1 {
        let meaning = "rotation from the axes of the reference to inertial axes";
        fields.push(TelemetryField::new("reference", "attitude", "", meaning).with(QUATERNION));
    }
    fields.push(field("reference", "angle", "rad", "reference of `estimate.angle`"));
    fields.push(field("reference", "rate", "rad/s", "reference of `estimate.rate`"));
    fields.push(field("reference", "acceleration", "rad/s²", "acceleration of the reference"));
    let wheels = wheel_speeds(run).len();
    if wheels > 0 {
        let meaning = "speeds of the wheels, as available to their drives";
        fields.push(TelemetryField::new("wheels", "speed", "rad/s", meaning).numbered(wheels));
    }
    fields
}

/// Returns true if the law reads the dominant mode.
fn has_dominant_mode(scenario: &Scenario) -> bool {
    let is_own = matches!(scenario.estimator, Some(EstimatorKind::Own(_)));
    scenario.law.needs() == EstimateNeeds::DominantMode && !is_own
}

/// Returns the speeds of the wheels (rad/s), as available to their drives.
fn wheel_speeds(run: &RunView<'_>) -> Vec<f64> {
    let truth = run.plant.truth();
    if run.estimation.axis_count() > 1 {
        return run.loads.wheel_speeds(run.now, truth.rigid_rate);
    }
    let response = run.loads.actuator.response(run.now, 0, [truth.rate[0], truth.rigid_rate[0]]);
    response.rotor.iter().map(|wheel| wheel.speed_rad_s).collect()
}

/// Returns the values of a sensor's fields in a reading; `None` if the reading has other quantities.
fn reading_values(reading: &Reading, fields: &[TelemetryField], axes: usize) -> Vec<f64> {
    let mut values = Vec::new();
    for field in fields {
        match field.name.rsplit('.').next() {
            Some("rate") => values.extend_from_slice(&reading.rate.unwrap_or_default()[..axes]),
            Some("attitude") => {
                let attitude = reading.at.attitude().unwrap_or_default();
                values.extend([attitude.w, attitude.i, attitude.j, attitude.k]);
            }
            Some("angle") => values.push(reading.at.error_from(&reading.at.difference_origin())[0]),
            _ => {
                let vector = reading.sight.map(|measured| measured.vector).unwrap_or_default();
                values.extend(vector.iter());
            }
        }
    }
    values
}

impl Simulation {
    /// Returns the quantities of the telemetry of this scenario's run, which [`Simulation::telemetry`] gives.
    pub fn telemetry_layout(&self, scenario: &Scenario) -> TelemetryLayout {
        TelemetryLayout::new(&self.read_view(), scenario)
    }

    /// Returns the telemetry at the current instant: readings, and the inputs of the laws as a decision now would have them,
    /// with estimates predicted to this instant. A run that is controlled from outside does not change by this.
    ///
    /// # Errors
    /// Fails if the state is no longer finite.
    pub fn telemetry(&mut self, layout: &TelemetryLayout) -> Result<Telemetry, SimulationError> {
        let now = self.clock.now();
        self.plant.evaluate(now)?;
        // An external command at this instant does the same, before the actuator takes it.
        self.estimation.update_angle_origin(now, &mut self.guidance);
        let run = self.read_view();
        let sensors = layout.sensors.iter().map(|sensor| run.sensor_telemetry(sensor)).collect();
        let accelerations = &self.recorder;
        let mut telemetry = Telemetry { sensors, law_inputs: run.law_inputs(layout) };
        for (sensor, telemetry) in layout.sensors.iter().zip(&mut telemetry.sensors) {
            if let Some((at, values)) = accelerations.last_accelerations(sensor.index) {
                *telemetry = SensorTelemetry { at: Some(at), values: values.to_vec() };
            }
        }
        Ok(telemetry)
    }
}

impl Simulation {
    /// Returns the momentum stored in the rotors, as available to the drives (N m s, body axes).
    pub fn stored_momentum(&self) -> [f64; 3] {
        self.loads.actuator.capabilities().stored_momentum(self.clock.now())
    }

    /// Returns the attitude (w, x, y, z) by the estimate of the last sample, or of now with a continuous sensor; `None` for
    /// one axis.
    ///
    /// # Errors
    /// Fails if the state is no longer finite.
    pub fn estimated_attitude(&mut self) -> Result<Option<[f64; 4]>, SimulationError> {
        self.plant.evaluate(self.clock.now())?;
        let origin = self.estimation.origin();
        let mut angles = [0.0; 3];
        if self.sensors.is_continuous() {
            angles = self.plant.sensed_angles(origin);
        } else {
            let estimates = self.estimation.estimates.iter();
            angles.iter_mut().zip(estimates).for_each(|(angle, estimate)| *angle = estimate.angle);
        }
        let attitude = origin.rotated_by(angles).attitude();
        Ok(attitude.map(|attitude| [attitude.w, attitude.i, attitude.j, attitude.k]))
    }
}

impl RunView<'_> {
    fn sensor_telemetry(&self, sensor: &TelemetrySensor) -> SensorTelemetry {
        let latest = self.sensors.latest(sensor.index, self.now, self.plant);
        let axes = self.estimation.axis_count();
        match latest {
            Some((at, reading)) => {
                SensorTelemetry { at: Some(at), values: reading_values(&reading, &sensor.fields, axes) }
            }
            None => SensorTelemetry {
                at: None,
                values: vec![0.0; sensor.fields.iter().map(TelemetryField::width).sum()],
            },
        }
    }

    fn law_inputs(&self, layout: &TelemetryLayout) -> Vec<f64> {
        let now = self.now;
        let mut estimates = self.estimation.estimates.clone();
        self.estimation.predict_into(now, self.plant, self.sensors, &mut estimates);
        let square: f64 = estimates.iter().map(|estimate| estimate.angle * estimate.angle).sum();
        for estimate in &mut estimates {
            estimate.total_angle = f64::sqrt(square);
        }
        let led = self.guidance.reference_motion(now, &estimates);
        let needs = ReferenceNeeds { tracks_manoeuvre: true, ..ReferenceNeeds::default() };
        let setpoint =
            |axis: usize| self.guidance.setpoint_for(needs, now, led.map(|setpoints| setpoints[axis]));
        let mut values = Vec::new();
        for field in &layout.law_inputs {
            let of_estimate: &dyn Fn(&StateEstimate) -> f64 = match field.name.as_str() {
                "estimate.angle" => &|estimate| estimate.angle,
                "estimate.rate" => &|estimate| estimate.rate,
                "estimate.error" => &|estimate| AttitudeErrorMeasure::Quaternion.error(estimate),
                "estimate.field_rate" => &|estimate| estimate.field_rate,
                "estimate.mode_displacement" => &|estimate| estimate.dominant.displacement,
                "estimate.mode_rate" => &|estimate| estimate.dominant.rate,
                "estimate.mode_frequency" => &|estimate| estimate.dominant.frequency,
                "reference.attitude" => {
                    let attitude = self.estimation.origin().attitude().unwrap_or_default();
                    values.extend([attitude.w, attitude.i, attitude.j, attitude.k]);
                    continue;
                }
                "wheels.speed" => {
                    values.extend(wheel_speeds(self));
                    continue;
                }
                name => {
                    values.extend((0..estimates.len()).map(setpoint).map(|setpoint| match name {
                        "reference.angle" => setpoint.at(now).0,
                        "reference.rate" => setpoint.at(now).1,
                        _ => setpoint.acceleration,
                    }));
                    continue;
                }
            };
            values.extend(estimates.iter().map(of_estimate));
        }
        values
    }
}
