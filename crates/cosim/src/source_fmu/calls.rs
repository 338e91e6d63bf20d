//! C between the variables of an FMU and the functions of an exported control system.

use std::fmt::Write as _;

use flexsc_core::Scenario;
use flexsc_core::numerics::time::Span;
use flexsc_export_c::control_system::{Channel, ControlSystem, NumberKind};
use flexsc_export_c::package::ControlSources;
use flexsc_flight_precision::Precision;

use super::bindings::{BoundCall, InputSource, SourceModel};
use super::variables::find;
use crate::variable::{Causality, ValueKind, VariableStart};

/// Functions and constants that two FMUs in one program do not share.
const SHARED: [&str; 16] = [
    "fmu_variables",
    "fmu_is_before",
    "fmu_sum",
    "fmu_since",
    "fmu_is_new",
    "fmu_has_changed",
    "fmu_reset",
    "fmu_move",
    "fmu_begin",
    "fmu_step",
    "fmu_get",
    "fmu_set",
    "fmu_pack",
    "fmu_unpack",
    "fmu_start",
    "fmu_act",
];

/// Inputs that act when they change: the function, the first reference and the number of values.
fn watched(model: &SourceModel) -> Vec<(&'static str, usize, usize)> {
    let mut all = Vec::new();
    for call in &model.calls {
        for (channel, source) in call.layout.inputs.iter().zip(&call.inputs) {
            let is_flag = call.layout.name == "supervise" && channel.kind == NumberKind::Flag;
            if let InputSource::Values(first) = source
                && (is_flag || matches!(call.layout.name, "enter" | "shift"))
            {
                all.push((call.layout.name, *first, channel.count));
            }
        }
    }
    all
}

/// Returns the header with the sizes of the model.
pub fn model_header(model: &SourceModel, prefix: &str, precision: Precision, token: &str) -> String {
    let reference = |name: &str| find(&model.table, name).unwrap_or(0);
    let shared: String =
        SHARED.iter().map(|name| format!("#define {name} {prefix}_{name}\n")).collect::<Vec<_>>().concat();
    let real = if precision.is_double() { "double" } else { "float" };
    let watched: usize = watched(model).iter().map(|(.., count)| count).sum();
    format!(
        "/* Sizes of the model around {prefix}.c. */\n#ifndef FMU_MODEL_H\n#define FMU_MODEL_H\n\n#include \"{prefix}.h\"\n\n\
         #define FMU_TOKEN \"{token}\"\n#define FMU_STATE {prefix}_state\n#define FMU_REAL {real}\n\n\
         /* Names that two FMUs in one program do not share. */\n{shared}\n\
         enum {{\n    FMU_VALUES = {},\n    FMU_WATCHED = {},\n    FMU_SENSORS = {},\n    FMU_TIME = {},\n    FMU_TIME_WHOLE = {},\n    \
         FMU_TIME_PART = {},\n    FMU_EVENT_WHOLE = {},\n    FMU_EVENT_PART = {},\n    FMU_EVENTS = {}\n}};\n\n#endif\n",
        model.table.variables().len(),
        watched.max(1),
        model.sensors.len().max(1),
        reference("time"),
        reference("time_whole_s"),
        reference("time_fs"),
        reference("event_whole_s"),
        reference("event_fs"),
        reference("events"),
    )
}

/// Returns a span as an initialiser.
fn ticks(span: Span) -> String {
    let parts = span.ticks();
    format!("{{INT64_C({}), INT64_C({})}}", parts.whole, parts.part)
}

/// Returns the source that calls the functions.
pub fn calls_source(
    model: &SourceModel,
    exported: &ControlSources,
    scenario: &Scenario,
    prefix: &str,
) -> String {
    let writer = CallWriter { model, exported, scenario, prefix };
    let mut text = format!(
        "/* Values of the variables, and the calls of {prefix}.c. */\n#include \"fmu_instance.h\"\n\n#include <math.h>\n#include <string.h>\n\n"
    );
    writer.write_variables(&mut text);
    if exported.has_time {
        let _ = writeln!(
            text,
            "static {prefix}_ticks ticks(fmu_ticks now)\n{{\n    const {prefix}_ticks own = {{now.whole, now.part}};\n    return own;\n}}\n"
        );
    }
    writer.write_field_age(&mut text);
    for call in &model.calls {
        writer.write_call(call, &mut text);
    }
    writer.write_readings(&mut text);
    writer.write_start(&mut text);
    writer.write_act(&mut text);
    text
}

/// Writer of the calls.
struct CallWriter<'a> {
    model: &'a SourceModel,
    exported: &'a ControlSources,
    scenario: &'a Scenario,
    prefix: &'a str,
}

/// Returns an element of a member.
fn element(channel: &Channel, index: usize) -> String {
    if channel.count == 1 { channel.name.clone() } else { format!("{}[{index}]", channel.name) }
}

/// Returns the expression of an element of an input.
fn input(channel: &Channel, source: InputSource, index: usize) -> String {
    let value = |first: usize| match channel.kind {
        NumberKind::Real => format!("(FMU_REAL)run->values[{}]", first + index),
        NumberKind::Flag => format!("run->values[{}] != 0.0", first + index),
        NumberKind::Integer(_) => format!("(int64_t)run->values[{}]", first + index),
    };
    match source {
        InputSource::Values(first) => value(first),
        InputSource::IsNew(sensor) => format!("is_new[{sensor}]"),
        InputSource::Reading(sensor, first) => {
            format!("run->seen[{sensor}].whole < 0 ? (FMU_REAL)NAN : {}", value(first))
        }
        InputSource::FieldRate(_, first) => {
            format!("knows_field_rate(run, now) ? {} : (FMU_REAL)NAN", value(first))
        }
        InputSource::Silence(sensor) => format!(
            "(FMU_REAL)fmu_since(now, run->seen[{sensor}].whole < 0 ? run->start : run->seen[{sensor}])"
        ),
    }
}

impl CallWriter<'_> {
    /// Writes kind, access and start of each variable.
    fn write_variables(&self, text: &mut String) {
        text.push_str("const fmu_variable fmu_variables[FMU_VALUES] = {\n");
        for variable in self.model.table.variables() {
            let kind = if variable.kind == ValueKind::Integer { "FMU_INTEGER" } else { "FMU_FLOAT" };
            let access = match variable.causality {
                Causality::Input => "FMU_INPUT",
                Causality::Parameter => "FMU_PARAMETER",
                _ => "FMU_OUTPUT",
            };
            let start = match variable.start {
                VariableStart::Float(value) => format!("{value:?}"),
                VariableStart::Integer(value) => format!("{value}.0"),
            };
            let _ = writeln!(text, "    {{{kind}, {access}, {start}}}, /* {} */", variable.name);
        }
        text.push_str("};\n\n");
    }

    /// Returns true if the rate of change of the field is an input of conditions.
    fn reads_field_rate(&self) -> bool {
        let mut inputs = self.model.calls.iter().flat_map(|call| &call.inputs);
        inputs.any(|source| matches!(source, InputSource::FieldRate(..)))
    }

    /// Writes the test whether the rate of change of the field is known.
    fn write_field_age(&self, text: &mut String) {
        if self.reads_field_rate() {
            text.push_str(
                "/* True if the last two readings of the field are recent. */\nstatic bool knows_field_rate(const fmu_run *run, fmu_ticks now)\n{\n    \
                 const fmu_ticks at = {run->state.field.at.whole, run->state.field.at.part};\n    \
                 const fmu_ticks age = {run->state.field.most_age.whole, run->state.field.most_age.part};\n    \
                 return run->state.field.has_rate && !fmu_is_before(fmu_sum(at, age), now);\n}\n\n",
            );
        }
    }

    /// Writes a function that passes the variables to a function of the control system.
    fn write_call(&self, call: &BoundCall, text: &mut String) {
        let (prefix, name) = (self.prefix, call.layout.name);
        let is_new = if call.inputs.iter().any(|own| matches!(own, InputSource::IsNew(_))) {
            ", const bool is_new[FMU_SENSORS]"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "static void call_{name}(fmu_run *run, fmu_ticks now{is_new})\n{{\n    {prefix}_{name}_input input;\n    {prefix}_{name}_output output;\n    memset(&input, 0, sizeof input);"
        );
        for (channel, source) in call.layout.inputs.iter().zip(&call.inputs) {
            for index in 0..channel.count {
                let value = input(channel, *source, index);
                let _ = writeln!(text, "    input.{} = {value};", element(channel, index));
            }
        }
        let now = if self.exported.has_time { "ticks(now), " } else { "" };
        let _ = writeln!(text, "    {prefix}_{name}(&run->state, {now}&input, &output);");
        if !self.exported.has_time {
            text.push_str("    (void)now;\n");
        }
        for (channel, first) in call.layout.outputs.iter().zip(&call.outputs) {
            let Some(first) = first else { continue };
            for index in 0..channel.count {
                let own = element(channel, index);
                let convert = if channel.kind == NumberKind::Flag { " ? 1.0 : 0.0" } else { "" };
                let cast = if channel.kind == NumberKind::Flag { "" } else { "(double)" };
                let _ = writeln!(text, "    run->values[{}] = {cast}output.{own}{convert};", first + index);
            }
        }
        if name == "supervise" {
            text.push_str(
                "    run->period.whole = output.period_whole;\n    run->period.part = output.period_part;\n    \
                 run->next_test.whole = output.has_next ? output.next_whole : FMU_NEVER;\n    run->next_test.part = output.has_next ? output.next_part : 0;\n    \
                 if (output.has_changed) {\n        run->next_step = now;\n    }\n",
            );
        }
        text.push_str("}\n\n");
    }

    /// Writes the function that takes new readings in the order of their times.
    fn write_readings(&self, text: &mut String) {
        if self.model.sensors.is_empty() {
            return;
        }
        let times: Vec<String> = self.model.sensors.iter().map(|own| own.time.to_string()).collect();
        let _ = writeln!(
            text,
            "/* Takes new readings, the earliest first. */\nstatic void take_readings(fmu_run *run)\n{{\n    \
             static const size_t times[FMU_SENSORS] = {{{}}};\n    bool is_new[FMU_SENSORS];\n    fmu_ticks at[FMU_SENSORS];\n\n    for (;;) {{\n        \
             int first = -1;\n        for (int sensor = 0; sensor < FMU_SENSORS; ++sensor) {{\n            \
             is_new[sensor] = fmu_is_new(run, sensor, times[sensor], &at[sensor]);\n            \
             if (is_new[sensor] && (first < 0 || fmu_is_before(at[sensor], at[first]))) {{\n                first = sensor;\n            }}\n        }}\n        \
             if (first < 0) {{\n            return;\n        }}\n        const fmu_ticks now = at[first];\n        \
             for (int sensor = 0; sensor < FMU_SENSORS; ++sensor) {{\n            is_new[sensor] = is_new[sensor] && !fmu_is_before(now, at[sensor]);\n            \
             if (is_new[sensor]) {{\n                run->seen[sensor] = at[sensor];\n            }}\n        }}",
            times.join(", ")
        );
        if self.takes_new_samples() {
            text.push_str("        call_sample(run, now, is_new);\n");
        }
        if let Some(sensor) = self.model.magnetometer {
            let _ = writeln!(
                text,
                "        if (is_new[{sensor}]) {{\n            call_field(run, now);\n        }}"
            );
        }
        text.push_str("    }\n}\n\n");
    }

    /// Returns true if new readings are samples: of an attitude filter, and not of one with a period.
    fn takes_new_samples(&self) -> bool {
        self.exported.system.estimator().is_some()
    }

    /// Writes the start.
    fn write_start(&self, text: &mut String) {
        let prefix = self.prefix;
        let is_modes = matches!(self.exported.system, ControlSystem::Modes(_));
        let now = if is_modes { ", ticks(now)" } else { "" };
        let _ = writeln!(
            text,
            "const char *fmu_start(fmu_run *run, fmu_ticks now)\n{{\n    {prefix}_init(&run->state{now});"
        );
        let parameters = &self.exported.parameters;
        if !parameters.is_empty() {
            let _ = writeln!(text, "    {prefix}_parameters parameters;");
            for (place, own) in parameters.iter().enumerate() {
                let reference = self.model.parameters + place;
                let _ = writeln!(text, "    parameters.{} = (FMU_REAL)run->values[{reference}];", own.name);
            }
            let _ = writeln!(
                text,
                "    if ({prefix}_set_parameters(&run->state, &parameters) != 0) {{\n        \
                 return \"a parameter is beyond its limits, which {prefix}.c has\";\n    }}"
            );
        }
        if self.model.call("start").is_some() {
            text.push_str("    call_start(run, now);\n");
        }
        let mut place = 0;
        for (_, first, count) in watched(self.model) {
            let _ = writeln!(text, "    (void)fmu_has_changed(run, {place}, {first}, {count});");
            place += count;
        }
        if self.model.call("supervise").is_some() {
            text.push_str("    run->next_test = now;\n");
        }
        if self.model.call("unload").is_some() {
            text.push_str("    run->next_unload = now;\n");
        }
        if self.model.call("sample").is_some() && !self.takes_new_samples() {
            text.push_str("    run->next_sample = now;\n");
        }
        if self.model.call("step").is_some() {
            let period = Span::from_seconds(self.exported.system.period());
            let period = self.scenario.study.law_period.unwrap_or(period);
            let _ = writeln!(
                text,
                "    const fmu_ticks period = {};\n    run->period = period;\n    run->next_step = now;",
                ticks(period)
            );
        }
        text.push_str("    (void)now;\n    return NULL;\n}\n\n");
    }

    /// Writes the response to inputs that have changed.
    fn write_changes(&self, text: &mut String) {
        let mut place = 0;
        for (call, first, count) in watched(self.model) {
            let _ = writeln!(text, "    if (fmu_has_changed(run, {place}, {first}, {count})) {{");
            place += count;
            match (call, &self.exported.system) {
                ("enter", ControlSystem::Modes(modes)) => {
                    let _ = writeln!(
                        text,
                        "        if (run->values[{first}] >= 0.0 && run->values[{first}] < {}.0) {{\n            \
                         call_enter(run, now);\n            run->next_test = now;\n            run->next_step = now;\n        }}",
                        modes.modes.len()
                    );
                }
                ("shift", _) => text.push_str("        call_shift(run, now);\n"),
                _ => text.push_str("        run->next_test = now;\n"),
            }
            text.push_str("    }\n");
        }
    }

    /// Writes the function that calls what is due.
    fn write_act(&self, text: &mut String) {
        text.push_str("void fmu_act(fmu_run *run, fmu_ticks now)\n{\n");
        self.write_changes(text);
        if !self.model.sensors.is_empty() {
            text.push_str("    take_readings(run);\n");
        }
        let due = |next: &str, call: &str, then: &str, text: &mut String| {
            let _ = writeln!(
                text,
                "    if (!fmu_is_before(now, run->{next})) {{\n        call_{call}(run, now);\n{then}    }}"
            );
        };
        if self.model.call("sample").is_some() && !self.takes_new_samples() {
            let period = self.scenario.study.sample_period.or(self.scenario.study.law_period);
            let period = ticks(period.unwrap_or(Span::from_seconds(self.exported.system.period())));
            let then = format!(
                "        const fmu_ticks period = {period};\n        run->next_sample = fmu_sum(run->next_sample, period);\n"
            );
            due("next_sample", "sample", &then, text);
        }
        if self.model.call("supervise").is_some() {
            due("next_test", "supervise", "", text);
        }
        if self.model.call("step").is_some() {
            let then = "        const fmu_ticks never = {FMU_NEVER, 0};\n        const bool has_period = run->period.whole > 0 || run->period.part > 0;\n        \
                 run->next_step = has_period ? fmu_sum(run->next_step, run->period) : never;\n";
            due("next_step", "step", then, text);
        }
        // As in a run, where the actuator takes the commands first.
        if let Some(unload) = self.model.call("unload") {
            let period = ticks(Span::from_seconds(unload.layout.period.unwrap_or(1.0)));
            let then = format!(
                "        const fmu_ticks period = {period};\n        run->next_unload = fmu_sum(run->next_unload, period);\n"
            );
            due("next_unload", "unload", &then, text);
        }
        if self.model.call("poll").is_some() {
            text.push_str("    call_poll(run, now);\n");
        }
        text.push_str("}\n");
    }
}
