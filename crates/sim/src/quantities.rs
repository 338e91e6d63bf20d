//! What a run can be asked, declared once: a row of this table appears in the observation or the telemetry of every run that
//! has it, and so in Gymnasium spaces, in the packets of `flexsc serve` and their description, and among the variables of FMUs.

use std::cell::OnceCell;
use std::ops::Deref;

use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::{AttitudeErrorMeasure, ReferenceNeeds, Setpoint};
use flexsc_control::quantity::{Meaning, Quantity, Shape};
use flexsc_control::sensor::SensorKind;
use flexsc_control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_record::{ControlMomentGyros, Hinges};

use super::plant::{FlowQuantities, OneAxisQuantities, ThreeAxisQuantities};
use super::run_view::RunView;
use flexsc_scenario::Scenario;

/// Origin of the values of a quantity.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum QuantityGroup {
    /// True state.
    True,
    /// Latest measurement of the sensors; NaN before the first.
    Measured,
    /// State estimate of the last sample.
    Estimated,
    /// State estimate that the laws would read now.
    Predicted,
    /// Reference that the laws would read now.
    Reference,
    /// Wheels, as available to their drives.
    Wheels,
}

impl QuantityGroup {
    /// Returns the name of the group.
    pub const fn name(self) -> &'static str {
        match self {
            Self::True => "state",
            Self::Measured => "measured",
            Self::Estimated | Self::Predicted => "estimate",
            Self::Reference => "reference",
            Self::Wheels => "wheels",
        }
    }

    /// Returns true for the groups of [`super::Simulation::observe`]; the others are in [`super::Simulation::telemetry`].
    pub const fn is_observed(self) -> bool {
        matches!(self, Self::True | Self::Measured | Self::Estimated)
    }
}

/// Quantity that a run has.
#[derive(Copy, Clone, Debug)]
pub struct QuantityField {
    /// Origin of the values.
    pub group: QuantityGroup,
    quantity: Quantity,
    read: Read,
}

impl Deref for QuantityField {
    type Target = Quantity;

    fn deref(&self) -> &Quantity {
        &self.quantity
    }
}

impl QuantityField {
    /// Returns the name with that of the group, such as `estimate.rate`.
    pub fn path(&self) -> String {
        format!("{}.{}", self.group.name(), self.name)
    }

    /// Returns the description of a component as a sentence, with its origin.
    pub fn description(&self, component: usize) -> String {
        let mut text = self.text(component);
        match self.group {
            QuantityGroup::Measured => text.insert_str(0, "Latest measurement; NaN before the first. "),
            QuantityGroup::Estimated => text.insert_str(0, "Estimate that the laws read. "),
            _ => text[..1].make_ascii_uppercase(),
        }
        text
    }
}

/// Function that gives the values of a quantity one after another, and returns `None` if the run does not have it.
type Read = fn(&AskedRun<'_>, &mut dyn FnMut(f64)) -> Option<()>;

/// Shape of a quantity, on one axis and on three.
#[derive(Copy, Clone, PartialEq, Eq)]
enum Extent {
    /// Number on a one-axis body, otherwise a vector.
    Axes,
    Quaternion,
    /// List of any length.
    List,
}

/// Unit of a quantity.
#[derive(Copy, Clone)]
enum Unit {
    Of(&'static str),
    /// Unit of a torque on the body.
    Torque,
    /// Unit on one axis, and on three.
    OfAxes(&'static str, &'static str),
}

/// Row of the table.
struct Declared {
    group: QuantityGroup,
    name: &'static str,
    unit: Unit,
    extent: Extent,
    /// Meaning on one axis, and on three.
    meaning: [Meaning; 2],
    /// Returns true for a scenario whose runs have the quantity, as far as `read` does not tell.
    given: fn(&Scenario) -> bool,
    read: Read,
}

macro_rules! quantities {
    ($($group:ident $name:literal, $unit:expr, $extent:ident, $meaning:expr $(, if $given:expr)? => $read:expr;)*) => {
        const QUANTITIES: &[Declared] = &[$(Declared {
            group: QuantityGroup::$group,
            name: $name,
            unit: $unit,
            extent: Extent::$extent,
            meaning: $meaning,
            given: given!($($given)?),
            read: $read,
        }),*];
    };
}

macro_rules! given {
    () => {
        |_| true
    };
    ($given:expr) => {
        $given
    };
}

use Unit::{Of, OfAxes, Torque};

quantities! {
    // State, measurements and estimates of the last sample: the observation.
    True "attitude", Of(""), Quaternion, logged(&[], &["pointing/q_w", "pointing/q_x", "pointing/q_y", "pointing/q_z"]) => |run, out| {
        let q = run.three_axis()?.attitude();
        give(out, [q.w, q.i, q.j, q.k])
    };
    True "error", Of("rad"), Axes, ANGLES => |run, out| {
        run.three_axis()?;
        give(out, run.plant.truth().orientation.error_from(&run.guidance.origin(run.now)))
    };
    True "angle", Of("rad"), Axes, ANGLES => |run, out| run.one_axis().and_then(|_| give(out, [run.plant.truth().sensor_angles()[0]]));
    True "rate", Of("rad/s"), Axes, RATES => |run, out| give(out, run.of_axes(run.plant.truth().rate));
    True "rigid_angle", Of("rad"), Axes, logged(&["attitude/rigid_rad"], &[]) => |run, out| give(out, [run.one_axis()?.body().state.rigid_angle]);
    True "rigid_rate", Of("rad/s"), Axes, logged(&["rate/rigid_rad_s"], &["rates/axes/rigid_rad_s"]) => |run, out| match run.plant.quantities() {
        FlowQuantities::OneAxis(motion) => give(out, [motion.body().state.rigid_rate]),
        FlowQuantities::ThreeAxis(_) => give(out, run.plant.truth().rigid_rate),
    };
    True "modes", OfAxes("rad", "m sqrt(kg)"), List, logged(&["modes/modes/displacement_rad"], &["vibrations/modes/displacement"]) => |run, out| match run.plant.quantities() {
        FlowQuantities::OneAxis(motion) => give(out, motion.body().state.modes.iter().map(|mode| mode.displacement)),
        FlowQuantities::ThreeAxis(motion) => give(out, motion.body().state.modes.iter().map(|mode| mode.displacement)),
    };
    True "mode_rates", OfAxes("rad/s", "m sqrt(kg)/s"), List, logged(&["modes/modes/rate_rad_s"], &["vibrations/modes/rate"]) => |run, out| match run.plant.quantities() {
        FlowQuantities::OneAxis(motion) => give(out, motion.body().mode_rates()),
        FlowQuantities::ThreeAxis(motion) => give(out, motion.body().mode_rates()),
    };
    True "torque", Torque, Axes, logged(&["torque/applied_nm"], &["torques/axes/applied_nm"]) => |run, out| {
        let magnetic = run.three_axis().map(|motion| motion.magnetic_torque());
        give(out, (0..run.axes()).map(|axis| magnetic.map_or(0.0, |torque| torque[axis]) + run.torque(axis)))
    };
    True "wheel_speed", Of("rad/s"), Axes, logged(&["wheel/speed_rad_s"], &[]) => |run, out| {
        run.one_axis()?;
        let rates = [run.plant.truth().rate[0], run.plant.truth().rigid_rate[0]];
        give(out, [run.loads.actuator.response(run.now, 0, rates).rotor?.speed_rad_s])
    };
    True "wheel_speeds", Of("rad/s"), List, logged(&[], &["wheels/wheels/speed_rad_s"]) => |run, out| {
        run.three_axis()?;
        let wheels = run.loads.actuator.capabilities().wheels(run.now, run.plant.truth().rate);
        wheels.first()?;
        give(out, wheels.iter().map(|wheel| wheel.speed_rad_s))
    };
    True "gimbal_angles", Of("rad"), List, logged(&[], &["control_moment_gyros/gyros/angle_rad"]) => |run, out| give(out, run.gyros()?.gyros.iter().map(|gyro| gyro.angle_rad));
    True "gimbal_rates", Of("rad/s"), List, logged(&[], &["control_moment_gyros/gyros/rate_rad_s"]) => |run, out| give(out, run.gyros()?.gyros.iter().map(|gyro| gyro.rate_rad_s));
    True "hinge_angles", Of("rad"), List, logged(&[], &["hinges/hinges/angle_rad"]) => |run, out| give(out, run.hinges()?.hinges.iter().map(|hinge| hinge.angle_rad));
    True "hinge_rates", Of("rad/s"), List, logged(&[], &["hinges/hinges/rate_rad_s"]) => |run, out| give(out, run.hinges()?.hinges.iter().map(|hinge| hinge.rate_rad_s));
    Measured "angle", Of("rad"), Axes, ANGLES => |run, out| run.one_axis().and_then(|_| run.measured(0, out));
    Measured "error", Of("rad"), Axes, ANGLES => |run, out| run.three_axis().and_then(|_| run.measured(0, out));
    Measured "rate", Of("rad/s"), Axes, RATES => |run, out| run.measured(1, out);
    Estimated "angle", Of("rad"), Axes, ANGLES => |run, out| run.one_axis().and_then(|_| run.estimated(|own| own.angle, 0, out));
    Estimated "error", Of("rad"), Axes, ANGLES => |run, out| run.three_axis().and_then(|_| run.estimated(|own| own.angle, 0, out));
    Estimated "rate", Of("rad/s"), Axes, RATES => |run, out| run.estimated(|own| own.rate, 1, out);

    // What the laws would read at this instant: the telemetry.
    Predicted "angle", Of("rad"), Axes, [
        Meaning::Text("estimated angle"),
        Meaning::Text("rotation vector from the reference attitude to the estimated one"),
    ] => |run, out| run.predicted(|own| own.angle, out);
    Predicted "rate", Of("rad/s"), Axes, text("estimated rate in body axes") => |run, out| run.predicted(|own| own.rate, out);
    Predicted "error", Of("rad"), Axes, text("twice the vector part of the quaternion from the reference attitude to the estimated one")
        => |run, out| run.three_axis().and_then(|_| run.predicted(|own| AttitudeErrorMeasure::Quaternion.error(own), out));
    Predicted "field_rate", Of("T/s"), Axes, text("rate of change of the measured magnetic field"), if |scenario| scenario.sensor.iter().any(SensorKind::measures_field)
        => |run, out| run.predicted(|own| own.field_rate, out);
    Predicted "mode_displacement", Of("rad"), Axes, text("displacement of the dominant mode"), if reads_dominant_mode
        => |run, out| run.predicted(|own| own.dominant.displacement, out);
    Predicted "mode_rate", Of("rad/s"), Axes, text("rate of the dominant mode"), if reads_dominant_mode
        => |run, out| run.predicted(|own| own.dominant.rate, out);
    Predicted "mode_frequency", Of("rad/s"), Axes, text("frequency of the dominant mode"), if reads_dominant_mode
        => |run, out| run.predicted(|own| own.dominant.frequency, out);
    Reference "attitude", Of(""), Quaternion, text("rotation from the axes of the reference to inertial axes") => |run, out| {
        let q = run.estimation.origin().attitude()?;
        give(out, [q.w, q.i, q.j, q.k])
    };
    Reference "angle", Of("rad"), Axes, text("reference of `estimate.angle`") => |run, out| run.setpoints(|own| own.at(run.now).0, out);
    Reference "rate", Of("rad/s"), Axes, text("reference of `estimate.rate`") => |run, out| run.setpoints(|own| own.at(run.now).1, out);
    Reference "acceleration", Of("rad/s²"), Axes, text("acceleration of the reference") => |run, out| run.setpoints(|own| own.acceleration, out);
    Wheels "speed", Of("rad/s"), List, text("speeds of the wheels, as available to their drives") => |run, out| {
        let speeds = run.wheel_speeds();
        speeds.first()?;
        give(out, speeds)
    };
}

/// Meaning of angles and errors, and of rates.
const ANGLES: [Meaning; 2] = logged(
    &["attitude/angle_rad"],
    &["pointing/roll_error_rad", "pointing/pitch_error_rad", "pointing/yaw_error_rad"],
);
const RATES: [Meaning; 2] = logged(&["rate/rate_rad_s"], &["rates/axes/rate_rad_s"]);

/// Meaning of a quantity that is a field of the log.
const fn logged(one_axis: &'static [&'static str], three_axes: &'static [&'static str]) -> [Meaning; 2] {
    [Meaning::Logged(one_axis), Meaning::Logged(three_axes)]
}

const fn text(text: &'static str) -> [Meaning; 2] {
    [Meaning::Text(text), Meaning::Text(text)]
}

/// Gives values one after another.
fn give(out: &mut dyn FnMut(f64), values: impl IntoIterator<Item = f64>) -> Option<()> {
    values.into_iter().for_each(out);
    Some(())
}

/// Returns true if the law reads the dominant mode.
fn reads_dominant_mode(scenario: &Scenario) -> bool {
    let is_own = matches!(scenario.estimator, Some(EstimatorKind::Own(_)));
    scenario.law.needs() == EstimateNeeds::DominantMode && !is_own
}

impl RunView<'_> {
    /// Returns the quantities of a scenario's run in the observation, or in the telemetry, in the order of the table.
    pub fn quantity_fields(&self, scenario: &Scenario, is_observed: bool) -> Vec<QuantityField> {
        let (axes, run) = (self.estimation.axis_count(), AskedRun::new(*self));
        let field = |row: &Declared| {
            let mut count = 0;
            (row.read)(&run, &mut |_| count += 1)?;
            let unit = match row.unit {
                Of(unit) => unit,
                Torque => scenario.model.torque_unit(),
                OfAxes(one_axis, three_axes) => {
                    if axes > 1 {
                        three_axes
                    } else {
                        one_axis
                    }
                }
            };
            let shape = match row.extent {
                Extent::Axes => Shape::about_axes(axes),
                Extent::Quaternion => Shape::Quaternion,
                Extent::List => Shape::List(count),
            };
            let meaning = row.meaning[usize::from(axes > 1)];
            let quantity = Quantity { name: row.name, unit, shape, meaning };
            Some(QuantityField { group: row.group, quantity, read: row.read })
        };
        let wanted = |row: &&Declared| row.group.is_observed() == is_observed && (row.given)(scenario);
        QUANTITIES.iter().filter(wanted).filter_map(field).collect()
    }

    /// Writes the observation into a vector.
    pub fn write_observation(&self, row: &mut [f64]) {
        let (run, mut place) = (AskedRun::new(*self), 0);
        for declared in QUANTITIES.iter().filter(|declared| declared.group.is_observed()) {
            (declared.read)(&run, &mut |value| {
                row[place] = value;
                place += 1;
            });
        }
    }

    /// Returns the values of fields.
    pub fn values(&self, fields: &[QuantityField]) -> Vec<f64> {
        let (run, mut values) = (AskedRun::new(*self), Vec::new());
        for field in fields {
            (field.read)(&run, &mut |value| values.push(value));
        }
        values
    }
}

/// Run that is asked, with what its laws would read at this instant.
struct AskedRun<'a> {
    run: RunView<'a>,
    law_inputs: OnceCell<LawInputs>,
}

/// State estimates predicted to this instant, and setpoints, about each axis.
struct LawInputs {
    estimates: Vec<StateEstimate>,
    setpoints: Vec<Setpoint>,
}

impl<'a> Deref for AskedRun<'a> {
    type Target = RunView<'a>;

    fn deref(&self) -> &RunView<'a> {
        &self.run
    }
}

impl<'a> AskedRun<'a> {
    const fn new(run: RunView<'a>) -> Self {
        Self { run, law_inputs: OnceCell::new() }
    }

    fn axes(&self) -> usize {
        self.estimation.axis_count()
    }

    fn one_axis(&self) -> Option<&dyn OneAxisQuantities> {
        self.plant.quantities().one_axis()
    }

    fn three_axis(&self) -> Option<&dyn ThreeAxisQuantities> {
        self.plant.quantities().three_axis()
    }

    fn of_axes(&self, values: [f64; 3]) -> impl Iterator<Item = f64> + use<> {
        values.into_iter().take(self.axes())
    }

    /// Gives the measured angles (part 0) or rates (part 1); those of a continuous sensor are true.
    fn measured(&self, part: usize, out: &mut dyn FnMut(f64)) -> Option<()> {
        if self.sensors.is_continuous() {
            return self.true_motion(part, out);
        }
        let is_reported = self.sensors.reading.is_some();
        give(out, self.sensors.measured.iter().map(|own| if is_reported { own[part] } else { f64::NAN }))
    }

    /// Gives a part of the estimates of the last sample; those of a continuous sensor are true angles (part 0) or rates (part
    /// 1).
    fn estimated(
        &self,
        value: fn(&StateEstimate) -> f64,
        part: usize,
        out: &mut dyn FnMut(f64),
    ) -> Option<()> {
        if self.sensors.is_continuous() {
            return self.true_motion(part, out);
        }
        give(out, self.estimation.estimates.iter().map(value))
    }

    fn true_motion(&self, part: usize, out: &mut dyn FnMut(f64)) -> Option<()> {
        if part == 1 {
            return give(out, self.of_axes(self.plant.truth().rate));
        }
        give(out, self.of_axes(self.plant.sensed_angles(&self.guidance.origin(self.now))))
    }

    /// Gives a part of the estimates predicted to this instant.
    fn predicted(&self, value: fn(&StateEstimate) -> f64, out: &mut dyn FnMut(f64)) -> Option<()> {
        give(out, self.law_inputs().estimates.iter().map(value))
    }

    /// Gives a part of the setpoints.
    fn setpoints(&self, value: impl Fn(&Setpoint) -> f64, out: &mut dyn FnMut(f64)) -> Option<()> {
        give(out, self.law_inputs().setpoints.iter().map(value))
    }

    fn law_inputs(&self) -> &LawInputs {
        self.law_inputs.get_or_init(|| {
            let mut estimates = self.estimation.estimates.clone();
            self.estimation.predict_into(self.now, self.plant, self.sensors, &mut estimates);
            let square: f64 = estimates.iter().map(|estimate| estimate.angle * estimate.angle).sum();
            for estimate in &mut estimates {
                estimate.total_angle = f64::sqrt(square);
            }
            let led = self.guidance.reference_motion(self.now, &estimates);
            let needs = ReferenceNeeds { tracks_manoeuvre: true, ..ReferenceNeeds::default() };
            let setpoint = |axis: usize| {
                self.guidance.setpoint_for(needs, self.now, led.map(|setpoints| setpoints[axis]))
            };
            let setpoints = (0..estimates.len()).map(setpoint).collect();
            LawInputs { estimates, setpoints }
        })
    }

    /// Returns the speeds of the wheels (rad/s), as available to their drives.
    fn wheel_speeds(&self) -> Vec<f64> {
        let truth = self.plant.truth();
        if self.axes() > 1 {
            return self.loads.wheel_speeds(self.now, truth.rigid_rate);
        }
        let response = self.loads.actuator.response(self.now, 0, [truth.rate[0], truth.rigid_rate[0]]);
        response.rotor.iter().map(|wheel| wheel.speed_rad_s).collect()
    }

    /// Returns the motion of the appendages' hinges; `None` without hinges.
    fn hinges(&self) -> Option<Hinges> {
        self.three_axis()?.hinges()
    }

    /// Returns the row of the control moment gyros; `None` without any.
    fn gyros(&self) -> Option<ControlMomentGyros> {
        self.loads.actuator.capabilities().momentum?.gyros(self.now)
    }

    /// Returns the torque that the actuator applies about an axis (N m).
    fn torque(&self, axis: usize) -> f64 {
        let truth = self.plant.truth();
        self.loads.actuator.response(self.now, axis, [truth.rate[axis], truth.rigid_rate[axis]]).applied
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_a_meaning_and_a_name_of_its_own() {
        for (index, row) in QUANTITIES.iter().enumerate() {
            for meaning in row.meaning {
                let paths = match meaning {
                    Meaning::Text(text) => {
                        assert!(text.starts_with(char::is_lowercase), "{text}");
                        continue;
                    }
                    Meaning::Logged(paths) => paths,
                };
                for path in paths {
                    let text = flexsc_record::description::field_text(path);
                    assert!(text.is_some_and(|text| text.starts_with(char::is_uppercase)), "{path}");
                }
            }
            let same = |other: &Declared| (other.group, other.name) == (row.group, row.name);
            assert_eq!(QUANTITIES.iter().position(same), Some(index), "{}", row.name);
        }
    }
}
