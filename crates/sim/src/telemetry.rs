//! Telemetry of a run at an instant: the last reading of each sensor, and what the laws would read, for control by another
//! program.

use flexsc_control::estimator::attitude::SensorRole;
use flexsc_control::quantity::total_width;
use flexsc_control::sensor::{MeasuredQuantity, Reading};
use flexsc_numerics::time::Instant;

use super::quantities::QuantityField;
use super::run_view::RunView;
use super::{Simulation, SimulationError};
use flexsc_scenario::Scenario;

/// Sensor in the telemetry of a run.
#[derive(Clone, Debug)]
pub struct TelemetrySensor {
    /// Group of its fields: the kind of the sensor, numbered from the second of a kind on.
    pub group: String,
    /// Index among the sensors of the scenario.
    pub index: usize,
    /// Quantities that it measures.
    pub fields: Vec<MeasuredQuantity>,
}

/// Quantities of the telemetry of a scenario's run, in their order.
#[derive(Clone, Debug)]
pub struct TelemetryLayout {
    /// Sensors.
    pub sensors: Vec<TelemetrySensor>,
    /// Estimate and reference that the laws read, and speeds of the wheels.
    pub law_inputs: Vec<QuantityField>,
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
            let mut fields = sensor.measured_quantities(scenario.sensor.provides_attitude(index), axes);
            let corrects = scenario.study.attitude.as_ref().and_then(|setup| setup.roles.get(index));
            if sensor.measures_vector() && matches!(corrects, Some(SensorRole::Corrects { .. })) {
                fields.extend(fields.first().map(|vector| MeasuredQuantity::reference(vector.unit)));
            }
            (!fields.is_empty()).then_some(TelemetrySensor { group, index, fields })
        });
        Self { sensors: sensors.collect(), law_inputs: run.quantity_fields(scenario, false) }
    }
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
        let mut telemetry = Telemetry { sensors, law_inputs: run.values(&layout.law_inputs) };
        for (sensor, telemetry) in layout.sensors.iter().zip(&mut telemetry.sensors) {
            if let Some((at, values)) = accelerations.last_accelerations(sensor.index) {
                *telemetry = SensorTelemetry { at: Some(at), values: values.to_vec() };
            }
        }
        Ok(telemetry)
    }
}

impl Simulation {
    /// Returns the absolute momentum stored in the rotors (N m s, body axes).
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
        match self.sensors.latest(sensor.index, self.now, self.plant) {
            Some((at, reading)) => {
                let estimator = &self.estimation.estimator;
                let sight = reading.sight.map(|sight| estimator.with_reference(sensor.index, sight, at));
                let reading = Reading { sight, ..reading };
                let values = sensor.fields.iter().flat_map(|field| field.values(&reading)).collect();
                SensorTelemetry { at: Some(at), values }
            }
            None => SensorTelemetry { at: None, values: vec![0.0; total_width(&sensor.fields)] },
        }
    }
}
