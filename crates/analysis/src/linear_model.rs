//! Scenario's body at rest as one linear system, x' = A x + B u, y = C x + D u, for control design programs.
//!
//! A one-axis body has the system of `CoupledMatrices`. With three axes G' = M + H x w, q'' + D q' + W² q = phi' (M + H x w): G
//! = J w_r, with the rate of the hub w = w_r + phi q' where modes act back on it, and the rotor momentum H
//! (\[Likins70\]). A rotor h at a point of the structure gives h x w_p there, with the rotations phi_p and the rate w_p = w_r + phi_p
//! q' of the point: its modes whirl. Environment torques are left out.

use flexsc_dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_dynamics::flow::CoupledMatrices;
use flexsc_dynamics::frequency_drift::FrequencyDrift;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{AXES, Vector};
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::body::BodyAxes;
use nalgebra::{DMatrix, Matrix3};
use schemars::JsonSchema;
use serde::Serialize;

use flexsc_scenario::Scenario;

/// Linear state-space model of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearModel {
    /// Matrix A, row by row.
    pub a: Vec<Vec<f64>>,
    /// Matrix B, row by row.
    pub b: Vec<Vec<f64>>,
    /// Matrix C, row by row.
    pub c: Vec<Vec<f64>>,
    /// States x.
    pub states: Vec<Signal>,
    /// Inputs u: the torques that actuators give.
    pub inputs: Vec<Signal>,
    /// Outputs y: angle and rate as sensors measure them, and all coordinates.
    pub outputs: Vec<Signal>,
}

/// Name and unit of a state, an input or an output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(extend("x-main" = "name"))]
pub struct Signal {
    /// Name of the signal.
    pub name: String,
    /// Unit of the signal.
    pub unit: String,
}

fn signal(name: impl Into<String>, unit: &str) -> Signal {
    Signal { name: name.into(), unit: unit.to_owned() }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

impl LinearModel {
    /// Returns the linear model of a scenario's body, with its natural frequencies at the time `at` (s).
    ///
    /// # Errors
    /// A body that is no linear system: its key, and the reason.
    pub fn from_scenario(scenario: &Scenario, time: f64) -> Result<Self, ConfigError> {
        Self::at(scenario, time, None)
    }

    /// Returns the linear model of a scenario's body at the start, with the wheels that points of the structure carry at a speed
    /// (rad/s), each in the sense of its speed at the start.
    ///
    /// # Errors
    /// See [`Self::from_scenario`].
    pub fn at_wheel_speed(scenario: &Scenario, speed: f64) -> Result<Self, ConfigError> {
        Self::at(scenario, 0.0, Some(speed))
    }

    fn at(scenario: &Scenario, time: f64, wheel_speed: Option<f64>) -> Result<Self, ConfigError> {
        if scenario.study.articulation().is_some() {
            let why = "turn appendages, so the body changes with time and is not a linear system";
            return Err(ConfigError::new("appendage", format!("has drives that {why}")));
        }
        Ok(match scenario.model.axes() {
            BodyAxes::One(body) => Self::for_one_axis(scenario, body, time),
            BodyAxes::Three(body) => Self::for_three_axes(scenario, body, wheel_speed),
        })
    }

    /// Creates the model with the damping that runs have: the damping matrix of free modes without its off-diagonal elements
    /// where runs leave them out.
    ///
    /// # Errors
    /// Drives that turn appendages, as in [`Self::from_scenario`].
    pub fn for_runs(scenario: &Scenario) -> Result<Self, ConfigError> {
        let mut model = Self::from_scenario(scenario, 0.0)?;
        let BodyAxes::Three(body) = scenario.model.axes() else { return Ok(model) };
        if let Some(coupling) = body.coupling.as_ref().filter(|coupling| !coupling.couples_by_damping) {
            let modes = 0..coupling.damping.nrows();
            for (row, column) in modes.clone().flat_map(|row| modes.clone().map(move |column| (row, column)))
            {
                if row != column {
                    model.a[7 + 2 * row][7 + 2 * column] += coupling.damping[(row, column)];
                }
            }
        }
        Ok(model)
    }

    fn for_one_axis(scenario: &Scenario, body: &AxisModel, time: f64) -> Self {
        let ratio = |mode| {
            scenario.study.drift.as_ref().map_or(1.0, |drift: &FrequencyDrift| drift.ratio(mode, time))
        };
        let ratios: Vec<f64> = (0..body.modes.len()).map(ratio).collect();
        let (back_emf, total) = scenario.back_emf(body);
        let coupled = CoupledMatrices::new(body, back_emf, total, &ratios);
        let order = coupled.system.nrows();
        let shown = |first: usize, j: usize| {
            // The clamped modes of a hub with a commanded motion are not observable in it.
            let is_seen = j == first || j % 2 == first && body.drive == CommandedQuantity::Torque;
            if is_seen { 1.0 } else { 0.0 }
        };
        let mut outputs: Vec<(Signal, Vec<f64>)> = vec![
            (signal("angle", "rad"), (0..order).map(|j| shown(0, j)).collect()),
            (signal("rate", "rad/s"), (0..order).map(|j| shown(1, j)).collect()),
        ];
        for output in &body.outputs {
            let mut row = vec![0.0; order];
            row[0] = output.rigid.get();
            output.modes.iter().enumerate().for_each(|(mode, weight)| row[2 + 2 * mode] = weight.get());
            outputs.push((signal(output.name.clone(), &output.unit), row));
        }
        let mut states = vec![signal("rigid_angle", "rad"), signal("rigid_rate", "rad/s")];
        for mode in 0..body.modes.len() {
            states.push(signal(format!("mode{mode}_displacement"), "rad"));
            states.push(signal(format!("mode{mode}_rate"), "rad/s"));
        }
        let input = coupled.input / body.commanded_inertia();
        let b = DMatrix::from_column_slice(order, 1, input.as_slice());
        Self::new(&coupled.system, &b, states, vec![signal("torque", body.torque_unit())], outputs)
    }

    fn for_three_axes(scenario: &Scenario, body: &ThreeAxisModel, wheel_speed: Option<f64>) -> Self {
        let (settings, modes) = (&scenario.study, body.modes.len());
        let (inertia, coupling) = (body.inertia, body.coupling.as_ref());
        // The tensor was checked, so it has an inverse.
        let inverse = inverse_3x3(inertia).unwrap_or_else(Matrix3::identity);
        let seed = Seed { scenario: scenario.seed, run: 0 };
        let mut stored =
            Vector::from(settings.actuator(scenario, seed).capabilities().stored_momentum(Instant::START));
        let measured = settings.measured_rates(body);
        let hub = |mode: usize| coupling.map_or_else(Vector::zeros, |coupling| coupling.rotations[mode]);
        let order = 6 + 2 * modes;
        let (mut a, mut b) = (DMatrix::zeros(order, order), DMatrix::zeros(order, 3));
        // Response of rates and modes to a torque at a place of these rotations, and the rate there.
        let turned_at = |rotation: &dyn Fn(usize) -> Vector| {
            let (mut pushed, mut rate) = (DMatrix::zeros(order, 3), DMatrix::zeros(3, order));
            pushed.view_mut((3, 0), (3, 3)).copy_from(&inverse);
            rate.view_mut((0, 3), (3, 3)).fill_with_identity();
            for mode in 0..modes {
                pushed.view_mut((7 + 2 * mode, 0), (1, 3)).copy_from(&rotation(mode).transpose());
                rate.view_mut((0, 7 + 2 * mode), (3, 1)).copy_from(&rotation(mode));
            }
            (pushed, rate)
        };
        for axis in 0..3 {
            let input = &measured.inputs[axis];
            let rigid = Vector::from_fn(|row, _| input.turning[row] * input.acceleration);
            let unit = 1.0 / (inertia * rigid)[axis];
            let torque = inertia * rigid * unit;
            b.view_mut((3, axis), (3, 1)).copy_from(&(inverse * torque));
            for mode in 0..modes {
                b[(7 + 2 * mode, axis)] = input.forces[mode] * unit;
            }
            a[(axis, 3 + axis)] = 1.0;
        }
        for carried in &settings.carried_rotors {
            let momentum = |speed: f64| carried.rotor.axis * (carried.rotor.spin_inertia * speed);
            stored -=
                momentum(carried.speed + carried.rotor.axis.dot(&Vector::from(body.rate.map(Finite::get))));
            let (pushed, rate) = turned_at(&|mode| carried.rotations[mode]);
            let speed = wheel_speed.map_or(carried.speed, |speed| speed.copysign(carried.speed));
            a += pushed * momentum(speed).cross_matrix() * rate;
        }
        let (pushed, rate) = turned_at(&hub);
        a += pushed * stored.cross_matrix() * rate;
        for (index, mode) in body.modes.iter().enumerate() {
            let (q, w) = (6 + 2 * index, mode.frequency.get());
            a[(q, q + 1)] = 1.0;
            a[(q + 1, q)] -= w * w;
            match coupling {
                Some(coupling) => {
                    for other in 0..modes {
                        a[(q + 1, 7 + 2 * other)] -= coupling.damping[(index, other)];
                    }
                }
                None => a[(q + 1, q + 1)] -= 2.0 * mode.damping.get() * w,
            }
        }
        let mut outputs = Vec::new();
        for (first, suffix, unit) in [(0, "", "rad"), (1, "_rate", "rad/s")] {
            for (axis, name) in AXES.iter().enumerate() {
                let mut row = vec![0.0; order];
                row[3 * first + axis] = 1.0;
                for mode in 0..modes {
                    row[6 + first + 2 * mode] = measured.visibilities[axis][mode];
                }
                outputs.push((signal(format!("{name}{suffix}"), unit), row));
            }
        }
        let rigid = |suffix: &str, unit: &str| AXES.map(|axis| signal(format!("rigid_{axis}{suffix}"), unit));
        let mut states: Vec<Signal> = rigid("", "rad").into_iter().chain(rigid("_rate", "rad/s")).collect();
        for mode in 0..modes {
            states.push(signal(format!("mode{mode}_displacement"), "m sqrt(kg)"));
            states.push(signal(format!("mode{mode}_rate"), "m sqrt(kg)/s"));
        }
        let inputs = AXES.map(|axis| signal(format!("torque_{axis}"), "N m"));
        Self::new(&a, &b, states, inputs.into(), outputs)
    }

    /// Creates a system whose outputs are the measured coordinates and all its states.
    fn new(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        states: Vec<Signal>,
        inputs: Vec<Signal>,
        outputs: Vec<(Signal, Vec<f64>)>,
    ) -> Self {
        let (mut outputs, mut c): (Vec<Signal>, Vec<Vec<f64>>) = outputs.into_iter().unzip();
        for (index, state) in states.iter().enumerate() {
            outputs.push(state.clone());
            c.push((0..states.len()).map(|j| f64::from(u8::from(j == index))).collect());
        }
        Self { a: rows(a), b: rows(b), c, states, inputs, outputs }
    }
}
