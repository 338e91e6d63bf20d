//! Laws about each axis: their members of the state, constants, start and step.

use std::fmt::Write as _;

use flexsc_core::numerics::attitude::AXES;

use super::law_scope::LawScope;
use super::member::{self, Member};
use super::text::{VECTOR, about, block, literal, local, vector};
use super::{Glue, compensators, momentum, parameters};
use crate::control_system::LawsOfAxes;

impl LawScope<'_> {
    /// Returns the members of the state.
    pub fn members(&self) -> Vec<Member> {
        fn law(kind: &str, laws: &[impl std::fmt::Debug]) -> Member {
            Member::about_axes("Law about each axis.", "law", kind, laws)
        }
        match &self.laws.laws {
            LawsOfAxes::Pd(own) => {
                vec![law("PdLaw", &own.iter().map(|(law, _)| law).collect::<Vec<_>>())]
            }
            LawsOfAxes::PhasePlane(own, _) => vec![law("PhasePlaneLaw", own)],
            LawsOfAxes::StateSpace(own) => compensators::members(own),
            LawsOfAxes::Attitude(own) => {
                let laws: Vec<_> = own.iter().map(|(law, _)| law).collect();
                let filters = own.iter().enumerate().filter(|(_, (_, filters))| !filters.is_empty());
                let filters = filters.map(|(axis, (_, filters))| {
                    let name = format!("filters_{axis}");
                    Member::list("Filters of the law about an axis.", &name, "BiquadFilter", filters)
                });
                [law("AttitudeFeedback", &laws)].into_iter().chain(filters).collect()
            }
        }
    }

    /// Adds the constants: gain schedules, matrices, inertia.
    pub fn add_constants(&self, glue: &mut Glue<'_>) {
        match &self.laws.laws {
            LawsOfAxes::Pd(own) => {
                for (axis, (_, points)) in own.iter().enumerate() {
                    let about = "Gain of the extra loop over the frequency of the mode.";
                    let name = self.constant(&format!("schedule_{axis}"));
                    glue.list(about, &name, "SchedulePoint", points);
                }
            }
            LawsOfAxes::StateSpace(own) => compensators::add_constants(glue, self, own),
            LawsOfAxes::PhasePlane(..) | LawsOfAxes::Attitude(_) => {}
        }
        if self.laws.is_acceleration() {
            let about = "Inertia tensor (kg m^2), without that of the rotors about their own axes, whose momentum is absolute.";
            glue.constant(about, &self.constant("inertia"), "Matrix3", &literal(&self.laws.inertia));
        }
    }

    /// Returns the statements that start the laws of a mode without a past.
    pub fn start(&self, glue: &Glue<'_>) -> String {
        member::set_all(&self.members(), &self.path()) + &self.tuned(glue)
    }

    /// Returns the statements that give the laws their parameters.
    pub fn tuned(&self, glue: &Glue<'_>) -> String {
        let law = self.mode.map_or_else(|| "law".to_owned(), |mode| format!("law_{mode}."));
        parameters::apply(glue, &law)
    }

    /// Returns the statements that decide: the commands, and the torque of accelerations.
    pub fn step(&self, glue: &Glue<'_>) -> String {
        let axes = self.laws.axis_count();
        let mut text = String::new();
        match &self.laws.laws {
            LawsOfAxes::StateSpace(own) if self.laws.is_together() => {
                text += &compensators::step_together(glue, self, &own[0]);
            }
            LawsOfAxes::StateSpace(own) => {
                let each = own.iter().enumerate();
                text.extend(each.map(|(axis, law)| compensators::step_about(self, law, axis)));
            }
            _ => {
                if axes == 3 {
                    let [roll, pitch, yaw] = [0, 1, 2].map(|axis| self.estimate("angle", axis));
                    let total = format!("axis_motion::total_angle({roll}, {pitch}, {yaw})");
                    text += &local("f64", "total_angle", &total);
                }
                text.extend((0..axes).map(|axis| self.step_about(axis)));
            }
        }
        if self.laws.is_acceleration() {
            text += &self.torque(glue);
        }
        text
    }

    /// Returns the step of the law about an axis.
    fn step_about(&self, axis: usize) -> String {
        let (laws, axes) = (self.laws, self.laws.axis_count());
        let input = |name: &str| format!("input.{}", about(name, axis, axes));
        let given = |is_read: bool, name: &str| if is_read { input(name) } else { "0.0".to_owned() };
        let total = if axes == 3 { "total_angle" } else { "total_angle: 0.0" };
        // A mode is an input, or an estimate of the filter.
        let mode = |name: &str| match &laws.filter {
            _ if !laws.reads_mode() => "0.0".to_owned(),
            Some(unit) if name == "frequency" => literal(&unit.axes[axis].frequency),
            Some(_) => self.estimate(name, axis),
            None => input(name),
        };
        let motion = format!(
            "AxisMotion {{ angle: {}, {total}, rate: {}, queued_rate: {}, displacement: {}, displacement_rate: {}, frequency: {} }}",
            self.estimate("angle", axis),
            self.estimate("rate", axis),
            given(laws.commands_changes(), "queued_rate"),
            mode("displacement"),
            mode("displacement_rate"),
            mode("frequency"),
        );
        let reference = format!(
            "AxisReference {{ angle: {}, rate: {}, acceleration: {} }}",
            input("reference_angle"),
            input("reference_rate"),
            given(laws.is_acceleration(), "reference_acceleration"),
        );
        let mut text =
            local("AxisMotion", "motion", &motion) + &local("AxisReference", "reference", &reference);
        let (output, lists) = match &laws.laws {
            // They have steps of their own.
            LawsOfAxes::StateSpace(_) => return String::new(),
            LawsOfAxes::Pd(own) if own[axis].1.is_empty() => ("torque", "&[]".to_owned()),
            LawsOfAxes::Pd(_) => ("torque", format!("&{}", self.constant(&format!("schedule_{axis}")))),
            LawsOfAxes::PhasePlane(_, modes) => ("rate_change", self.elastic_modes(axis, *modes, &mut text)),
            LawsOfAxes::Attitude(own) if own[axis].1.is_empty() => ("acceleration", "&mut []".to_owned()),
            LawsOfAxes::Attitude(_) => {
                ("acceleration", format!("&mut {}", self.state(&format!("filters_{axis}"))))
            }
        };
        let (output, law) = (about(output, axis, axes), self.state(&about("law", axis, axes)));
        text += &local("f64", "command", &format!("{law}.step(&motion, &reference, {lists})"));
        let _ = writeln!(text, "    output.{output} = command;");
        if axes == 1 { text } else { format!("\n    // {}\n", AXES[axis]) + &block(&text) }
    }

    /// Writes the modes that active damping reads about an axis, and returns them as arguments.
    fn elastic_modes(&self, axis: usize, modes: usize, text: &mut String) -> String {
        if modes == 0 {
            return "&[], false".to_owned();
        }
        let axes = self.laws.axis_count();
        let each = (0..modes).map(|mode| {
            let [rate, frequency, influence] = ["mode_rate", "mode_frequency", "mode_influence"]
                .map(|name| about(name, axis * modes + mode, axes * modes));
            format!("ElasticRateEstimate {{ rate: input.{rate}, frequency: input.{frequency}, influence: input.{influence} }}")
        });
        let each = each.collect::<Vec<_>>().join(", ");
        *text += &local(&format!("[ElasticRateEstimate; {modes}]"), "modes", &format!("[{each}]"));
        format!("&modes, input.{}", about("modes_are_trusted", axis, axes))
    }

    /// Returns the conversion of accelerations to a torque.
    fn torque(&self, glue: &Glue<'_>) -> String {
        let (laws, axes) = (self.laws, self.laws.axis_count());
        let of_axes = |value: &dyn Fn(usize) -> String| {
            vector(&[0, 1, 2].map(|axis| if axis < axes { value(axis) } else { "0.0".to_owned() }))
        };
        let mut text = "\n    // torque of these accelerations\n".to_owned();
        let acceleration = of_axes(&|axis| format!("output.{}", about("acceleration", axis, axes)));
        text += &local("Vector3", "acceleration", &acceleration);
        if !self.has_attitude {
            text += &local("Vector3", "rate", &of_axes(&|axis| self.estimate("rate", axis)));
        }
        text += &momentum::stored(glue, "step", &laws.stored, "rate");
        let inertia = self.constant("inertia");
        let torque = format!("torque_distribution::torque(&{inertia}, &acceleration, &rate, &stored)");
        text += &local("Vector3", "torque", &torque);
        let each = VECTOR.into_iter().enumerate().take(axes);
        text.extend(each.map(|(axis, component)| {
            format!("    output.{} = torque.{component};\n", about("torque", axis, axes))
        }));
        text
    }
}
