//! Laws about each axis in an exported control system: their members of the state, constants, start and step.

use std::fmt::Write as _;

use flexsc_core::numerics::attitude::AXES;

use super::compensator_calls;
use super::initialiser::initialiser;
use super::law_scope::LawCalls;
use super::shim::{self, VECTOR};
use super::signature::about;
use super::{momentum_calls, parameters};
use crate::control_system::LawsOfAxes;

impl LawCalls<'_> {
    /// Writes the members of the state.
    pub fn members(&self, text: &mut String) {
        let axes = self.laws.axis_count();
        let mut law = |name: &str| {
            let (name, law) = (self.plan.type_name(name), about("law", axes, axes));
            let _ = writeln!(text, "    /* Law about each axis. */\n    {name} {law};");
        };
        match &self.laws.laws {
            LawsOfAxes::Pd(_) => law("PdLaw"),
            LawsOfAxes::PhasePlane(..) => law("PhasePlaneLaw"),
            LawsOfAxes::StateSpace(own) => compensator_calls::members(own, text),
            LawsOfAxes::Attitude(own) => {
                law("AttitudeFeedback");
                let filters = own.iter().map(|(_, filters)| filters.len()).max().unwrap_or(0);
                if filters > 0 {
                    let name = self.plan.type_name("BiquadFilter");
                    let _ = writeln!(
                        text,
                        "    /* Filters of each law. */\n    {name} filters[{axes}][{filters}];"
                    );
                }
            }
        }
    }

    /// Writes the constants: gain schedules, matrices, inertia.
    pub fn constants(&self, text: &mut String) {
        let plan = self.plan;
        match &self.laws.laws {
            LawsOfAxes::Pd(own) => {
                for (axis, (_, points)) in own.iter().enumerate() {
                    let (about, name) = (
                        "Gain of the extra loop over the frequency of the mode.",
                        format!("schedule_{axis}"),
                    );
                    *text += &shim::list(plan, about, "SchedulePoint", &self.constant(&name), points);
                }
            }
            LawsOfAxes::StateSpace(own) => compensator_calls::constants(self, own, text),
            LawsOfAxes::PhasePlane(..) | LawsOfAxes::Attitude(_) => {}
        }
        if self.laws.is_acceleration() {
            let _ = writeln!(
                text,
                "/* Inertia tensor (kg m^2), without that of the rotors about their own axes, whose momentum is absolute. */\nstatic const {} {} = {};\n",
                plan.type_name("Matrix3"),
                self.constant("inertia"),
                initialiser(&self.laws.inertia, plan.prefix)
            );
        }
    }

    /// Writes the statements that start the laws without a past.
    pub fn start(&self, text: &mut String) {
        let (plan, axes) = (self.plan, self.laws.axis_count());
        if let (LawsOfAxes::StateSpace(_), Some(mode)) = (&self.laws.laws, self.mode) {
            let _ = writeln!(text, "    memset(&state->law_{mode}, 0, sizeof state->law_{mode});");
        }
        let mut set = |member: String, type_name: &str, value: String| {
            let _ = writeln!(text, "    {} = ({}){value};", self.state(&member), plan.type_name(type_name));
        };
        for axis in 0..axes {
            let member = about("law", axis, axes);
            match &self.laws.laws {
                // Their states and commands are zero.
                LawsOfAxes::StateSpace(_) => {}
                LawsOfAxes::Pd(own) => set(member, "PdLaw", initialiser(&own[axis].0, plan.prefix)),
                LawsOfAxes::PhasePlane(own, _) => {
                    set(member, "PhasePlaneLaw", initialiser(&own[axis], plan.prefix));
                }
                LawsOfAxes::Attitude(own) => {
                    set(member, "AttitudeFeedback", initialiser(&own[axis].0, plan.prefix));
                    for (index, filter) in own[axis].1.iter().enumerate() {
                        let value = initialiser(filter, plan.prefix);
                        set(format!("filters[{axis}][{index}]"), "BiquadFilter", value);
                    }
                }
            }
        }
        let law = self.mode.map_or_else(|| "law".to_owned(), |mode| format!("law_{mode}."));
        parameters::apply(plan, &law, text);
    }

    /// Writes the statements that decide: the commands, and the torque of accelerations.
    pub fn step(&self, text: &mut String) {
        let axes = self.laws.axis_count();
        if let LawsOfAxes::StateSpace(own) = &self.laws.laws {
            if self.laws.is_together() {
                compensator_calls::step_together(self, &own[0], text);
            } else {
                own.iter()
                    .enumerate()
                    .for_each(|(axis, law)| compensator_calls::step_about(self, law, axis, text));
            }
        } else {
            if axes == 3 {
                let [roll, pitch, yaw] = [0, 1, 2].map(|axis| self.estimate("angle", axis));
                let _ = writeln!(
                    text,
                    "    const double total_angle = axis_motion_total_angle({roll}, {pitch}, {yaw});"
                );
            }
            let [motion, reference, mode] =
                ["AxisMotion", "AxisReference", "ElasticRateEstimate"].map(|name| self.plan.type_name(name));
            let _ = writeln!(text, "    {motion} motion;\n    {reference} reference;");
            if self.laws.mode_count() > 0 {
                let _ = writeln!(text, "    {mode} modes[{}];", self.laws.mode_count());
            }
            (0..axes).for_each(|axis| self.step_about(axis, text));
        }
        if self.laws.is_acceleration() {
            self.torque(text);
        }
    }

    /// Writes the step of the law about an axis.
    fn step_about(&self, axis: usize, text: &mut String) {
        let (prefix, laws, axes) = (self.plan.prefix, self.laws, self.laws.axis_count());
        let input = |name: &str| format!("input->{}", about(name, axis, axes));
        let given = |is_read: bool, name: &str| if is_read { input(name) } else { "0.0".to_owned() };
        if axes == 3 {
            let _ = writeln!(text, "\n    /* {} */", AXES[axis]);
        }
        let total = if axes == 3 { "total_angle" } else { "0.0" };
        // A mode is an input, or an estimate of the filter.
        let mode = |name: &str| match &laws.filter {
            _ if !laws.reads_mode() => "0.0".to_owned(),
            Some(unit) if name == "frequency" => initialiser(&unit.axes[axis].frequency, prefix),
            Some(_) => self.estimate(name, axis),
            None => input(name),
        };
        let _ = writeln!(
            text,
            "    motion = ({prefix}_axis_motion){{ .angle = {}, .total_angle = {total}, .rate = {}, .queued_rate = {},\n        \
             .displacement = {}, .displacement_rate = {}, .frequency = {} }};",
            self.estimate("angle", axis),
            self.estimate("rate", axis),
            given(laws.commands_changes(), "queued_rate"),
            mode("displacement"),
            mode("displacement_rate"),
            mode("frequency"),
        );
        let _ = writeln!(
            text,
            "    reference = ({prefix}_axis_reference){{ .angle = {}, .rate = {}, .acceleration = {} }};",
            input("reference_angle"),
            input("reference_rate"),
            given(laws.is_acceleration(), "reference_acceleration"),
        );
        let (function, output, lists) = match &laws.laws {
            // They have steps of their own.
            LawsOfAxes::StateSpace(_) => return,
            LawsOfAxes::Pd(own) => {
                let schedule = self.constant(&format!("schedule_{axis}"));
                ("pd_law_step", "torque", shim::list_argument(&schedule, own[axis].1.len()))
            }
            LawsOfAxes::PhasePlane(_, modes) => {
                ("phase_plane_law_step", "rate_change", self.elastic_modes(axis, *modes, text))
            }
            LawsOfAxes::Attitude(own) => {
                let filters = self.state(&format!("filters[{axis}]"));
                ("attitude_feedback_step", "acceleration", shim::list_argument(&filters, own[axis].1.len()))
            }
        };
        let (output, law) = (about(output, axis, axes), self.state(&about("law", axis, axes)));
        let _ = writeln!(text, "    output->{output} = {function}(&{law}, &motion, &reference, {lists});");
    }

    /// Writes the modes that active damping reads about an axis, and returns them as arguments.
    fn elastic_modes(&self, axis: usize, modes: usize, text: &mut String) -> String {
        let axes = self.laws.axis_count();
        for mode in 0..modes {
            let [rate, frequency, influence] = ["mode_rate", "mode_frequency", "mode_influence"]
                .map(|name| about(name, axis * modes + mode, axes * modes));
            let _ = writeln!(
                text,
                "    modes[{mode}] = ({}){{ .rate = input->{rate}, .frequency = input->{frequency}, .influence = input->{influence} }};",
                self.plan.type_name("ElasticRateEstimate"),
            );
        }
        if modes == 0 {
            return "NULL, 0, false".to_owned();
        }
        format!("modes, {modes}, input->{}", about("modes_are_trusted", axis, axes))
    }

    /// Writes the conversion of accelerations to a torque.
    fn torque(&self, text: &mut String) {
        let (plan, laws, axes) = (self.plan, self.laws, self.laws.axis_count());
        let of_axes = |value: &dyn Fn(usize) -> String| {
            shim::vector(
                plan,
                &[0, 1, 2].map(|axis| if axis < axes { value(axis) } else { "0.0".to_owned() }),
            )
        };
        text.push_str("\n    /* torque of these accelerations */\n");
        let acceleration = of_axes(&|axis| format!("output->{}", about("acceleration", axis, axes)));
        shim::variable(plan, "Vector3", "acceleration", &acceleration, text);
        if !self.has_attitude {
            shim::variable(plan, "Vector3", "rate", &of_axes(&|axis| self.estimate("rate", axis)), text);
        }
        momentum_calls::declaration(plan, &laws.stored, "rate", text);
        let torque = format!(
            "torque_distribution_torque(&{}, &acceleration, &rate, &stored)",
            self.constant("inertia")
        );
        shim::variable(plan, "Vector3", "torque", &torque, text);
        for (axis, component) in VECTOR.into_iter().enumerate().take(axes) {
            let _ = writeln!(text, "    output->{} = torque.{component};", about("torque", axis, axes));
        }
    }
}
