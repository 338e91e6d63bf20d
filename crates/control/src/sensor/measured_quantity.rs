//! Quantities that a sensor measures, with their units and components, for programs outside the run.

use super::SensorKind;

/// Names of the components of vectors and quaternions.
const VECTOR: &[&str] = &["x", "y", "z"];
const QUATERNION: &[&str] = &["w", "x", "y", "z"];

/// Quantity of a sensor's readings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeasuredQuantity {
    /// Name, such as `rate`.
    pub name: &'static str,
    /// Unit; empty for a dimensionless quantity.
    pub unit: &'static str,
    /// Names of the components; empty for a scalar.
    pub components: Vec<String>,
    /// Meaning, as a noun phrase.
    pub meaning: &'static str,
}

impl MeasuredQuantity {
    fn new(name: &'static str, unit: &'static str, meaning: &'static str) -> Self {
        Self { name, unit, components: Vec::new(), meaning }
    }

    fn with(mut self, components: &[&str]) -> Self {
        self.components = components.iter().map(|&name| name.to_owned()).collect();
        self
    }
}

impl SensorKind {
    /// Returns the quantities that the sensor measures on a body with `axes` axes, of which it is the source of the attitude
    /// or not; none of a tachometer, whose readings are the speeds of the wheels.
    pub fn measured_quantities(&self, provides_attitude: bool, axes: usize) -> Vec<MeasuredQuantity> {
        let quantity = MeasuredQuantity::new;
        match self {
            Self::Tachometer(_) => Vec::new(),
            Self::Accelerometer(accelerometer) => {
                let meaning = "specific force along the axes of the sensor";
                let mut force = quantity("specific_force", "m/s²", meaning);
                force.components = (1..=accelerometer.along.len()).map(|number| number.to_string()).collect();
                vec![force]
            }
            Self::Magnetometer(_) => {
                vec![quantity("field", "T", "magnetic field in body axes").with(VECTOR)]
            }
            Self::SunSensor(_) | Self::SunCells(_) => {
                vec![quantity("direction", "", "direction to the Sun in body axes").with(VECTOR)]
            }
            Self::EarthSensor(_) => {
                vec![quantity("direction", "", "direction to the planet's centre in body axes").with(VECTOR)]
            }
            Self::Continuous | Self::Sampled(_) | Self::Gyro(_) | Self::StarTracker(_) | Self::Own(_) => {
                let mut quantities = Vec::new();
                if provides_attitude && axes > 1 {
                    let meaning = "measured rotation from body axes to inertial axes";
                    quantities.push(quantity("attitude", "", meaning).with(QUATERNION));
                } else if provides_attitude {
                    quantities.push(quantity("angle", "rad", "measured angle"));
                }
                if self.is_continuous() || self.rate_noise(0).is_some() {
                    let rate = quantity("rate", "rad/s", "measured rate in body axes");
                    quantities.push(if axes > 1 { rate.with(VECTOR) } else { rate });
                }
                quantities
            }
        }
    }
}
