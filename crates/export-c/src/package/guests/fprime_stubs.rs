//! Stubs for the component of F Prime: the class that F Prime would generate, and the program that replays the vectors.

use std::fmt::Write as _;

use super::fprime_ports::{arguments, arrays, handled, parameters, type_name};
use crate::control_system::NumberKind;
use crate::glue::camel;
use crate::package::FlightParameter;
use crate::package::Plan;

/// Returns the stub of the class that F Prime generates.
pub(super) fn stub(plan: &Plan<'_>) -> String {
    let (mut calls, mut handlers, mut outputs, mut telemetry) =
        (String::new(), String::new(), String::new(), String::new());
    for call in plan.calls {
        let name = call.name;
        let list =
            ["0".to_owned()].into_iter().chain(arguments(plan, &call.inputs)).collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            calls,
            "    void call_{name}Input({}) {{ this->{name}Input_handler({list}); }}",
            parameters(plan, &call.inputs)
        );
        let _ = writeln!(
            handlers,
            "    virtual void {name}Input_handler(FwIndexType portNum{}) = 0;",
            handled(plan, call)
        );
        let added: Vec<String> =
            call.outputs.iter().map(|channel| format!("        words.add({});\n", channel.name)).collect();
        let times = if plan.has_time() { "        (void)now_whole;\n        (void)now_part;\n" } else { "" };
        let list = parameters(plan, &call.outputs);
        let _ = writeln!(
            outputs,
            "    bool isConnected_{name}Output_OutputPort(FwIndexType portNum) {{ return portNum == 0; }}\n    \
             void {name}Output_out(FwIndexType portNum{}{list}) {{\n        (void)portNum;\n{times}        Words words;\n{}        \
             this->m_sent.push_back(std::make_pair(std::string(\"{name}\"), words));\n    }}",
            if list.is_empty() { "" } else { ", " },
            added.concat()
        );
        let counter = format!("{}Calls", camel(name));
        let _ = writeln!(
            telemetry,
            "    void tlmWrite_{counter}(U32 value) {{ this->m_telemetry[\"{counter}\"] = value; }}"
        );
    }
    let number = |own: &FlightParameter| {
        let name = own.name.to_uppercase();
        format!(
            "    F64 paramGet_{name}(Fw::ParamValid& valid) {{\n        valid = Fw::ParamValid::VALID;\n        \
             return this->m_numbers.count(\"{name}\") > 0 ? this->m_numbers[\"{name}\"] : {:?};\n    }}\n",
            own.value
        )
    };
    let numbers: String = plan.parameters.iter().map(number).collect();
    let arrays: Vec<String> = arrays(plan)
        .into_iter()
        .map(|(name, count, element)| format!("typedef StubArray<{element}, {count}> {name};\n"))
        .collect();
    include_str!("../files/fprime/stub.hpp")
        .replace("ARRAYS", &arrays.concat())
        .replace("CALLS    void", &format!("{calls}    void"))
        .replace("HANDLERS", &handlers)
        .replace("OUTPUTS", &outputs)
        .replace("TELEMETRY", &telemetry)
        .replace("PARAMETERS", &numbers)
}

/// Returns the program that replays the vectors through the ports.
pub(super) fn replay(plan: &Plan<'_>) -> String {
    let (mut cases, mut counters) = (String::new(), String::new());
    for (index, call) in plan.calls.iter().enumerate() {
        let name = call.name;
        let _ = writeln!(cases, "        if (index == {index}) {{");
        for channel in &call.inputs {
            let scope = if channel.count == 1 { "" } else { "MODULE::" };
            let _ = writeln!(
                cases,
                "            {scope}{0} {1} = {scope}{0}();\n            Reader::read({1});",
                type_name(channel),
                channel.name
            );
        }
        let kinds: String = call
            .outputs
            .iter()
            .flat_map(|channel| std::iter::repeat_n(channel, channel.count))
            .map(|channel| if channel.kind == NumberKind::Real { 'R' } else { 'I' })
            .collect();
        let list = arguments(plan, &call.inputs).join(", ");
        let _ = writeln!(cases, "            component.call_{name}Input({list});");
        if index + 1 == plan.calls.len() {
            cases.push_str(
                "            if (!component.m_sent.empty()) {\n                return fail(number, \"decided before `run`\");\n            \
                 }\n            component.call_run();\n",
            );
        }
        let _ = writeln!(
            cases,
            "            if (!hasOutputs(component, \"{name}\", \"{kinds}\")) {{\n                \
             return fail(number, \"other outputs of {name}\");\n            }}\n        }}"
        );
        let _ = write!(
            counters,
            " ||\n        component.m_telemetry[\"{}Calls\"] != calls[{index}]",
            camel(name)
        );
    }
    // A parameter of 0 has limits of its own.
    let other_than_zero = plan.parameters.iter().find(|own| own.value != 0.0);
    let tested = other_than_zero.map_or_else(String::new, |own| {
        let set = |factor: f64| {
            let (name, value) = (own.name.to_uppercase(), factor * own.value);
            format!("    component.call_parameterUpdated(\"{name}\", {value:?});\n")
        };
        format!(
            "{}{}    if (component.m_events[\"ParametersRefused\"] != 1) {{\n        return fail(count, \"other parameters refused\");\n    }}\n",
            set(100.0),
            set(1.5)
        )
    });
    include_str!("../files/fprime/replay.cpp")
        .replace("CASES    }", &format!("{cases}    }}"))
        .replace("PARAMETERS", &tested)
        .replace("CALL_COUNTERS", &counters)
        .replace("CALL_COUNT", &plan.calls.len().to_string())
}
