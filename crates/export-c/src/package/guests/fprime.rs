//! Component of F Prime: its model, its implementation, and stubs with which it is tested.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::{camel, named};
use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::package::signature::has_time;
use crate::package::{PackageFile, Plan, text};

/// Keywords of F Prime's modelling language among the words that a member may have as its name.
const KEYWORDS: [&str; 42] = [
    "action", "active", "array", "assert", "at", "base", "block", "bool", "change", "choice", "command",
    "component", "constant", "container", "default", "enum", "event", "exit", "fatal", "format", "group",
    "health", "id", "initial", "instance", "internal", "on", "param", "phase", "port", "priority", "queue",
    "record", "reference", "seconds", "send", "signal", "size", "state", "string", "time", "type",
];

/// Returns the files of the component, of its stubs and their Makefile.
pub(super) fn files(plan: &Plan<'_>, header: &str, source: &str) -> Vec<PackageFile> {
    let (prefix, component) = (plan.prefix, format!("{}Control", camel(plan.prefix)));
    let directory = format!("fprime/Components/{component}");
    let file = |path: String, template: &str| {
        let template =
            template.replace("COMPONENT", &component).replace("MODULE", &camel(prefix)).replace("LOWER_LAW", &format!(
                "LOWER_{}",
                law(plan).name
            ));
        text(path, named(&template, plan))
    };
    vec![
        file(format!("{directory}/CMakeLists.txt"), include_str!("../files/fprime/CMakeLists.txt")),
        file(format!("{directory}/{component}.cpp"), &implementation(plan)),
        file(format!("{directory}/{component}.fpp"), &model(plan)),
        file(format!("{directory}/{component}.hpp"), &class(plan)),
        text(format!("{directory}/{prefix}.c"), source.to_owned()),
        text(format!("{directory}/{prefix}.h"), header.to_owned()),
        file("fprime/Makefile".to_owned(), include_str!("../files/fprime/Makefile")),
        file(
            format!("fprime/stubs/Components/{component}/{component}ComponentAc.hpp"),
            &stub(plan),
        ),
        file("fprime/stubs/framework.fpp".to_owned(), include_str!("../files/fprime/framework.fpp")),
        file("fprime/stubs/replay.cpp".to_owned(), &replay(plan)),
    ]
}

/// Returns the law: the last function.
fn law<'a>(plan: &Plan<'a>) -> &'a CallLayout {
    &plan.calls[plan.calls.len() - 1]
}

/// Returns the type of a channel in C++, which the model defines.
fn type_name(channel: &Channel, scalar: [&str; 3]) -> String {
    let (kind, name) = match channel.kind {
        NumberKind::Real => (0, "Real"),
        NumberKind::Flag => (1, "Flag"),
        NumberKind::Integer(_) => (2, "Integer"),
    };
    if channel.count == 1 { scalar[kind].to_owned() } else { format!("{name}{}", channel.count) }
}

/// Types of scalars in the model and in C++.
const MODEL: [&str; 3] = ["F64", "bool", "I64"];
const CPP: [&str; 3] = ["F64", "bool", "I64"];

/// Returns the arrays of the model: name, count and type of the elements.
fn arrays(plan: &Plan<'_>) -> BTreeSet<(String, usize, &'static str)> {
    let channels = plan.calls.iter().flat_map(|call| call.inputs.iter().chain(&call.outputs));
    channels
        .filter(|channel| channel.count > 1)
        .map(|channel| {
            let element = type_name(&Channel { count: 1, ..channel.clone() }, MODEL);
            let element = MODEL.into_iter().find(|name| *name == element).unwrap_or(MODEL[0]);
            (type_name(channel, MODEL), channel.count, element)
        })
        .collect()
}

/// Returns the model.
fn model(plan: &Plan<'_>) -> String {
    let (mut types, mut ports, mut counters) = (String::new(), String::new(), String::new());
    for (name, count, element) in arrays(plan) {
        let _ = writeln!(types, "  array {name} = [{count}] {element}\n");
    }
    for call in plan.calls {
        let name = camel(call.name);
        for (side, about, channels) in [("Input", "Inputs", &call.inputs), ("Output", "Outputs", &call.outputs)] {
            let mut parameters = Vec::new();
            if has_time(plan) {
                parameters.push("    now_whole: I64 @< Time since the start: whole seconds\n".to_owned());
                parameters.push("    now_part: I64 @< Femtoseconds past them\n".to_owned());
            }
            parameters.extend(channels.iter().map(|channel| {
                let escape = if KEYWORDS.contains(&channel.name.as_str()) { "$" } else { "" };
                format!(
                    "    {escape}{}: {} @< {}\n",
                    channel.name,
                    type_name(channel, MODEL),
                    channel.about
                )
            }));
            let _ = writeln!(
                types,
                "  @ {about} of LOWER_{}. {}\n  port {name}{side}(\n{}  )\n",
                call.name,
                call.about,
                parameters.concat()
            );
        }
        let _ = writeln!(
            ports,
            "    guarded input port {0}Input: {name}Input\n\n    output port {0}Output: {name}Output\n",
            call.name
        );
        let _ = writeln!(counters, "    @ Calls of LOWER_{}\n    telemetry {name}Calls: U32\n", call.name);
    }
    let measured: Vec<String> =
        plan.calls[..plan.calls.len() - 1].iter().map(|call| format!("LOWER_{}", call.name)).collect();
    let measured = if measured.is_empty() { "no function".to_owned() } else { measured.join(", ") };
    include_str!("../files/fprime/component.fpp")
        .replace("TYPES", &types)
        .replace("PORTS", &ports)
        .replace("COUNTERS    @ Answer", &format!("{counters}    @ Answer"))
        .replace("MEASURED", &measured)
}

/// Returns the parameters of a handler or of an output in C++.
fn parameters(plan: &Plan<'_>, channels: &[Channel]) -> String {
    let mut list = if has_time(plan) { vec!["I64 now_whole".to_owned(), "I64 now_part".to_owned()] } else { Vec::new() };
    list.extend(channels.iter().map(|channel| {
        let reference = if channel.count == 1 { ["", ""] } else { ["const ", "&"] };
        format!("{}{}{} {}", reference[0], type_name(channel, CPP), reference[1], channel.name)
    }));
    list.join(", ")
}

/// Returns the parameters of a handler after the number of its port.
fn handled(plan: &Plan<'_>, call: &CallLayout) -> String {
    let list = parameters(plan, &call.inputs);
    if list.is_empty() { list } else { format!(", {list}") }
}

/// Returns the arguments with the time, and then these channels.
fn arguments(plan: &Plan<'_>, channels: &[Channel]) -> Vec<String> {
    let time = ["now_whole", "now_part"].iter().filter(|_| has_time(plan)).map(|name| (*name).to_owned());
    time.chain(channels.iter().map(|channel| channel.name.clone())).collect()
}

/// Returns the parameter of the time, as the exported functions take it.
fn now(plan: &Plan<'_>) -> &'static str {
    if has_time(plan) { "const LOWER_ticks& now, " } else { "" }
}

/// Returns the declaration of the class.
fn class(plan: &Plan<'_>) -> String {
    let (mut handlers, mut functions, mut members) = (String::new(), String::new(), String::new());
    for call in plan.calls {
        let name = call.name;
        let _ = writeln!(
            handlers,
            "    // {}\n    void {name}Input_handler(FwIndexType portNum{}) override;\n",
            call.about,
            handled(plan, call)
        );
        let _ = writeln!(
            functions,
            "    // Calls the function, and sends its outputs.\n    void {name}({}const LOWER_{name}_input& input);\n",
            now(plan)
        );
        let _ = writeln!(members, "    U32 m_{name}Calls;");
    }
    include_str!("../files/fprime/component.hpp")
        .replace("HANDLERS", &handlers)
        .replace("FUNCTIONS", &functions)
        .replace("TIME    bool", if has_time(plan) { "    LOWER_ticks m_now;\n    bool" } else { "    bool" })
        .replace("MEMBERS", &members)
}

/// Returns the implementation.
fn implementation(plan: &Plan<'_>) -> String {
    let (mut functions, mut zeros, mut resets) = (String::new(), String::new(), String::new());
    let law = law(plan).name;
    for call in plan.calls {
        functions.push_str(&handler(plan, call, call.name == law));
        functions.push_str(&function(plan, call));
        let _ = write!(zeros, ", m_{}Calls(0)", call.name);
        let _ = writeln!(
            resets,
            "    this->m_{0}Calls = 0;\n    this->tlmWrite_{1}Calls(0);",
            call.name,
            camel(call.name)
        );
    }
    let (initial, given) = if has_time(plan) { ("m_now(), ", "this->m_now, ") } else { ("", "") };
    include_str!("../files/fprime/component.cpp")
        .replace("LAW(GIVEN", &format!("{law}({given}"))
        .replace("INITIAL", initial)
        .replace("ZEROS", &zeros)
        .replace("FUNCTIONS", &functions)
        .replace("RESETS", &resets)
}

/// Returns the handler of the inputs of a function; those of the law are kept.
fn handler(plan: &Plan<'_>, call: &CallLayout, is_law: bool) -> String {
    let name = call.name;
    let mut text = format!(
        "void COMPONENT ::{name}Input_handler(FwIndexType portNum{}) {{\n    (void)portNum;\n    LOWER_{name}_input input;\n",
        handled(plan, call)
    );
    for channel in &call.inputs {
        copy(channel, &format!("input.{}", channel.name), &channel.name, &mut text);
    }
    if has_time(plan) {
        text.push_str(
            "    LOWER_ticks now;\n    now.whole = now_whole;\n    now.part = now_part;\n",
        );
    }
    let now = if has_time(plan) { "now, " } else { "" };
    if is_law {
        if has_time(plan) {
            text.push_str("    this->m_now = now;\n");
        }
        text.push_str("    this->m_input = input;\n    this->m_hasInput = true;\n}\n\n");
    } else {
        let _ = writeln!(text, "    this->{name}({now}input);\n}}\n");
    }
    text
}

/// Returns the function that calls a function of the control system, and sends its outputs.
fn function(plan: &Plan<'_>, call: &CallLayout) -> String {
    let name = call.name;
    let given = if has_time(plan) { "now, " } else { "" };
    let mut text = format!(
        "void COMPONENT ::{name}({}const LOWER_{name}_input& input) {{\n    LOWER_{name}_output output;\n    \
         LOWER_{name}(&this->m_state, {given}&input, &output);\n",
        now(plan)
    );
    let mut arguments: Vec<String> = vec!["0".to_owned()];
    if has_time(plan) {
        arguments.extend(["now.whole".to_owned(), "now.part".to_owned()]);
    }
    for channel in &call.outputs {
        if channel.count == 1 {
            arguments.push(format!("output.{}", channel.name));
        } else {
            let _ = writeln!(text, "    {} {};", type_name(channel, CPP), channel.name);
            copy(channel, &channel.name, &format!("output.{}", channel.name), &mut text);
            arguments.push(channel.name.clone());
        }
    }
    let _ = writeln!(
        text,
        "    if (this->isConnected_{name}Output_OutputPort(0)) {{\n        this->{name}Output_out({});\n    }}\n    \
         this->tlmWrite_{}Calls(++this->m_{name}Calls);\n}}\n",
        arguments.join(", "),
        camel(name)
    );
    text
}

/// Writes the copy of a channel.
fn copy(channel: &Channel, to: &str, from: &str, text: &mut String) {
    if channel.count == 1 {
        let _ = writeln!(text, "    {to} = {from};");
    } else {
        let _ = writeln!(
            text,
            "    for (U32 i = 0; i < {}; i++) {{\n        {to}[i] = {from}[i];\n    }}",
            channel.count
        );
    }
}

/// Returns the stub of the class that F Prime generates.
fn stub(plan: &Plan<'_>) -> String {
    let (mut calls, mut handlers, mut outputs, mut telemetry) =
        (String::new(), String::new(), String::new(), String::new());
    for call in plan.calls {
        let name = call.name;
        let list = arguments(plan, &call.inputs).iter().map(|name| format!(", {name}")).collect::<String>();
        let _ = writeln!(
            calls,
            "    void call_{name}Input({}) {{ this->{name}Input_handler(0{list}); }}",
            parameters(plan, &call.inputs)
        );
        let _ = writeln!(
            handlers,
            "    virtual void {name}Input_handler(FwIndexType portNum{}) = 0;",
            handled(plan, call)
        );
        let added: Vec<String> =
            call.outputs.iter().map(|channel| format!("        words.add({});\n", channel.name)).collect();
        let times = if has_time(plan) { "        (void)now_whole;\n        (void)now_part;\n" } else { "" };
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
    let arrays: String = arrays(plan)
        .into_iter()
        .map(|(name, count, element)| format!("typedef StubArray<{element}, {count}> {name};\n"))
        .collect();
    include_str!("../files/fprime/stub.hpp")
        .replace("ARRAYS", &arrays)
        .replace("CALLS    void", &format!("{calls}    void"))
        .replace("HANDLERS", &handlers)
        .replace("OUTPUTS", &outputs)
        .replace("TELEMETRY", &telemetry)
}

/// Returns the program that replays the vectors through the ports.
fn replay(plan: &Plan<'_>) -> String {
    let (mut cases, mut counters) = (String::new(), String::new());
    for (index, call) in plan.calls.iter().enumerate() {
        let name = call.name;
        let _ = writeln!(cases, "        if (index == {index}) {{");
        for channel in &call.inputs {
            let scope = if channel.count == 1 { "" } else { "MODULE::" };
            let _ = writeln!(
                cases,
                "            {scope}{0} {1} = {scope}{0}();\n            Reader::read({1});",
                type_name(channel, CPP),
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
    include_str!("../files/fprime/replay.cpp")
        .replace("CASES    }", &format!("{cases}    }}"))
        .replace("CALL_COUNTERS", &counters)
        .replace("CALL_COUNT", &plan.calls.len().to_string())
}
