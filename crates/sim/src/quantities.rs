//! Table of the quantities that programs outside a run can read: a row of it appears in the observation or the telemetry of every run that
//! has it, and so in Gymnasium spaces, in the packets of `flexsc serve` and their description, and among the variables of FMUs.

use std::ops::Deref;

use flexsc_control::estimator::EstimatorKind;
use flexsc_control::flight_quantity::FlightQuantity;
use flexsc_control::law::AttitudeErrorMeasure;
use flexsc_control::quantity::{Meaning, QuantityDescription, QuantityShape};
use flexsc_control::state_estimate::EstimateNeeds;

use super::plant::{FlowQuantities, ThreeAxisQuantities};
use super::quantity_reader::{QuantityReader, give};
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
    /// Values that the conditions of the mode compare; at a change, of the mode before.
    Conditions,
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
            Self::Conditions => "conditions",
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
    quantity: QuantityDescription,
    read: Read,
}

impl Deref for QuantityField {
    type Target = QuantityDescription;

    fn deref(&self) -> &QuantityDescription {
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
type Read = fn(&QuantityReader<'_>, &mut dyn FnMut(f64)) -> Option<()>;

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
    /// Returns true for a scenario whose runs have the quantity, where `read` cannot decide that.
    given: fn(&Scenario) -> bool,
    read: Read,
}

/// Declares the rows of the table, one by one: a group with name, unit, extent and meaning, or with a quantity of flight code,
/// a condition on the scenario if there is one, and the function that reads the values.
macro_rules! quantities {
    (@ [$($row:expr,)*]) => {
        const QUANTITIES: &[Declared] = &[$($row),*];
    };
    (@ [$($row:expr,)*] $group:ident flight $quantity:ident $(, if $given:expr)? => $read:expr; $($rest:tt)*) => {
        quantities! { @ [$($row,)* Declared {
            group: QuantityGroup::$group,
            name: FlightQuantity::$quantity.declaration().name,
            unit: Of(FlightQuantity::$quantity.declaration().unit),
            extent: Extent::Axes,
            meaning: text(FlightQuantity::$quantity.declaration().meaning),
            given: given!($($given)?),
            read: $read,
        },] $($rest)* }
    };
    (@ [$($row:expr,)*] $group:ident $name:literal, $unit:expr, $extent:ident, $meaning:expr => $read:expr; $($rest:tt)*) => {
        quantities! { @ [$($row,)* Declared {
            group: QuantityGroup::$group,
            name: $name,
            unit: $unit,
            extent: Extent::$extent,
            meaning: $meaning,
            given: |_| true,
            read: $read,
        },] $($rest)* }
    };
    ($group:ident $($rest:tt)*) => {
        quantities! { @ [] $group $($rest)* }
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
    True "rate", Of("rad/s"), Axes, RATES => |run, out| give(out, run.about_axes(run.plant.truth().rate));
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
        let magnetic = run.three_axis().map(<dyn ThreeAxisQuantities>::magnetic_torque);
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
    Predicted flight Angle => |run, out| run.predicted(|own| own.angle, out);
    Predicted flight Rate => |run, out| run.predicted(|own| own.rate, out);
    Predicted "error", Of("rad"), Axes, text("twice the vector part of the quaternion from the reference attitude to the estimated one")
        => |run, out| run.three_axis().and_then(|_| run.predicted(|own| AttitudeErrorMeasure::Quaternion.error(own), out));
    Predicted flight FieldRate, if |scenario| scenario.sensor.iter().any(|sensor| sensor.measures_field())
        => |run, out| run.predicted(|own| own.field_rate, out);
    Predicted flight Displacement, if reads_dominant_mode
        => |run, out| run.predicted(|own| own.dominant.displacement, out);
    Predicted flight DisplacementRate, if reads_dominant_mode
        => |run, out| run.predicted(|own| own.dominant.rate, out);
    Predicted flight Frequency, if reads_dominant_mode
        => |run, out| run.predicted(|own| own.dominant.frequency, out);
    Reference "attitude", Of(""), Quaternion, text("rotation from the axes of the reference to inertial axes") => |run, out| {
        let q = run.estimation.origin().attitude()?;
        give(out, [q.w, q.i, q.j, q.k])
    };
    Reference flight ReferenceAngle => |run, out| run.setpoints(|own| own.at(run.now).0, out);
    Reference flight ReferenceRate => |run, out| run.setpoints(|own| own.at(run.now).1, out);
    Reference flight ReferenceAcceleration => |run, out| run.setpoints(|own| own.acceleration, out);
    Wheels "speed", Of("rad/s"), List, text("speeds of the wheels, as available to their drives") => |run, out| {
        let speeds = run.wheel_speeds();
        speeds.first()?;
        give(out, speeds)
    };
    Conditions "attitude", Of(""), Quaternion, text("target attitude of the mode whose conditions are tested, before a change at this instant") => |run, out| {
        run.modes.and(run.estimation.origin().attitude())?;
        give(out, run.compared_attitude())
    };
    Conditions "rate", Of("rad/s"), Axes, text("rate of the reference of that mode") => |run, out| run.modes.and_then(|_| give(out, run.compared_rate()));
    Conditions "readings", Of(""), List, text("values that the conditions of all modes compare, in the order in which they name them; NaN of those that are not tested now") => |run, out| {
        run.modes?;
        give(out, run.compared_readings())
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

/// Returns true if the law reads the dominant mode.
fn reads_dominant_mode(scenario: &Scenario) -> bool {
    let is_own = matches!(scenario.estimator, Some(EstimatorKind::Own(_)));
    scenario.law.needs() == EstimateNeeds::DominantMode && !is_own
}

impl RunView<'_> {
    /// Returns the quantities of a scenario's run in the observation, or in the telemetry, in the order of the table.
    pub fn quantity_fields(&self, scenario: &Scenario, is_observed: bool) -> Vec<QuantityField> {
        self.fields_in(QUANTITIES, scenario, is_observed)
    }

    fn fields_in(&self, table: &[Declared], scenario: &Scenario, is_observed: bool) -> Vec<QuantityField> {
        let (axes, run) = (self.estimation.axis_count(), QuantityReader::new(*self));
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
                Extent::Axes => QuantityShape::about_axes(axes),
                Extent::Quaternion => QuantityShape::Quaternion,
                Extent::List => QuantityShape::List(count),
            };
            let meaning = row.meaning[usize::from(axes > 1)];
            let quantity = QuantityDescription { name: row.name, unit, shape, meaning };
            Some(QuantityField { group: row.group, quantity, read: row.read })
        };
        let wanted = |row: &&Declared| row.group.is_observed() == is_observed && (row.given)(scenario);
        table.iter().filter(wanted).filter_map(field).collect()
    }

    /// Writes the observation into a vector.
    pub fn write_observation(&self, row: &mut [f64]) {
        let (run, mut place) = (QuantityReader::new(*self), 0);
        for declared in QUANTITIES.iter().filter(|declared| declared.group.is_observed()) {
            (declared.read)(&run, &mut |value| {
                row[place] = value;
                place += 1;
            });
        }
    }

    /// Returns the values of fields.
    pub fn values(&self, fields: &[QuantityField]) -> Vec<f64> {
        let (run, mut values) = (QuantityReader::new(*self), Vec::new());
        for field in fields {
            (field.read)(&run, &mut |value| values.push(value));
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Simulation;

    const TOY: Declared = Declared {
        group: QuantityGroup::True,
        name: "toy",
        unit: Of("rad/s"),
        extent: Extent::Axes,
        meaning: text("twice the rate"),
        given: |_| true,
        read: |run, out| give(out, run.about_axes(run.plant.truth().rate).map(|rate| 2.0 * rate)),
    };

    #[test]
    fn a_row_is_all_that_a_quantity_needs() {
        let toml = "duration = 1.0\n[law.open]\n[body.spatial]\ninertia = [[3, 0, 0], [0, 2, 0], [0, 0, 2]]\n\
                    rate = [1e-5, -1e-5, 2e-5]\npoints = [{ name = \"hub\" }]\n\
                    modes = [{ frequency = 1.3, damping = 0.02, shapes.hub = { rotation = [0.02, 0.01, 0.03] } }]";
        let scenario = Scenario::parse("toy.toml", toml).expect("a scenario");
        let mut simulation = Simulation::new(&scenario, 0);
        simulation.open(&mut ()).expect("a start");
        let run = simulation.read_view();
        let fields = run.fields_in(&[TOY], &scenario, true);
        let [toy] = &fields[..] else { panic!("{fields:?}") };
        assert_eq!((toy.path().as_str(), toy.unit, toy.shape), ("state.toy", "rad/s", QuantityShape::Vector));
        assert_eq!(toy.description(2), "Twice the rate");
        assert_eq!(run.values(&fields), run.plant.truth().rate.map(|rate| 2.0 * rate));
        assert!(run.fields_in(&[TOY], &scenario, false).is_empty());
    }

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
