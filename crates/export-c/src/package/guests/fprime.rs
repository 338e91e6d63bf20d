//! Component of F Prime: its model, its implementation, and stubs with which it is tested.

use std::fmt::Write as _;

use super::fprime_ports::{arrays, handled, type_name};
use super::{fprime_stubs, named};
use crate::control_system::{CallLayout, Channel};
use crate::glue::camel;
use crate::package::{PackageFile, Plan, text};

/// Keywords of F Prime's modelling language among the words that a member may have as its name.
const KEYWORDS: [&str; 42] = [
    "action",
    "active",
    "array",
    "assert",
    "at",
    "base",
    "block",
    "bool",
    "change",
    "choice",
    "command",
    "component",
    "constant",
    "container",
    "default",
    "enum",
    "event",
    "exit",
    "fatal",
    "format",
    "group",
    "health",
    "id",
    "initial",
    "instance",
    "internal",
    "on",
    "param",
    "phase",
    "port",
    "priority",
    "queue",
    "record",
    "reference",
    "seconds",
    "send",
    "signal",
    "size",
    "state",
    "string",
    "time",
    "type",
];

/// Returns the files of the component, of its stubs and their Makefile.
pub(super) fn files(plan: &Plan<'_>, header: &str, source: &str) -> Vec<PackageFile> {
    let (prefix, component) = (plan.prefix, format!("{}Control", camel(plan.prefix)));
    let directory = format!("fprime/Components/{component}");
    let file = |path: String, template: &str| {
        let template = template
            .replace("COMPONENT", &component)
            .replace("MODULE", &camel(prefix))
            .replace("LOWER_LAW", &format!("LOWER_{}", law(plan).name));
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
            &fprime_stubs::stub(plan),
        ),
        file("fprime/stubs/framework.fpp".to_owned(), include_str!("../files/fprime/framework.fpp")),
        file("fprime/stubs/replay.cpp".to_owned(), &fprime_stubs::replay(plan)),
    ]
}

/// Returns the parameters of the model, and the event of those that are refused.
fn modelled_parameters(plan: &Plan<'_>) -> String {
    if plan.parameters.is_empty() {
        return String::new();
    }
    let each = plan.parameters.iter().map(|own| {
        format!("    @ {}\n    param {}: F64 default {:?}\n\n", own.about, own.name.to_uppercase(), own.value)
    });
    each.collect::<String>()
        + "    @ Parameters are not taken, because one is beyond its limits\n    event ParametersRefused(place: I32) severity warning high \
           format \"parameter {} is beyond its limits\" throttle 16\n\n    param get port prmGetOut\n\n    param set port prmSetOut\n\n"
}

/// Returns the functions that take the parameters.
fn parameter_functions(plan: &Plan<'_>) -> String {
    if plan.parameters.is_empty() {
        return String::new();
    }
    let each = plan.parameters.iter().map(|own| {
        format!("    parameters.{} = this->paramGet_{}(valid);\n", own.name, own.name.to_uppercase())
    });
    format!(
        "void COMPONENT ::parameterUpdated(FwPrmIdType id) {{\n    (void)id;\n    this->takeParameters();\n}}\n\n\
         void COMPONENT ::parametersLoaded() {{\n    this->takeParameters();\n}}\n\n\
         void COMPONENT ::takeParameters() {{\n    Fw::ParamValid valid = Fw::ParamValid::INVALID;\n    LOWER_parameters parameters;\n{}    \
         const I32 place = LOWER_parameters_check(&parameters);\n    if (place != 0) {{\n        this->log_WARNING_HI_ParametersRefused(place);\n        \
         return;\n    }}\n    this->lock();\n    this->m_parameters = parameters;\n    (void)LOWER_set_parameters(&this->m_state, &this->m_parameters);\n    this->unLock();\n}}\n\n",
        each.collect::<String>()
    )
}

/// Returns the statement that sets the parameters of a state that was just set; nothing without parameters.
fn set_parameters(plan: &Plan<'_>) -> &'static str {
    if plan.parameters.is_empty() {
        ""
    } else {
        "\n    (void)LOWER_set_parameters(&this->m_state, &this->m_parameters);"
    }
}

/// Returns the law: the last function.
fn law<'a>(plan: &Plan<'a>) -> &'a CallLayout {
    &plan.calls[plan.calls.len() - 1]
}

/// Returns the model.
fn model(plan: &Plan<'_>) -> String {
    let (mut types, mut ports, mut counters) = (String::new(), String::new(), String::new());
    for (name, count, element) in arrays(plan) {
        let _ = writeln!(types, "  array {name} = [{count}] {element}\n");
    }
    for call in plan.calls {
        let name = camel(call.name);
        for (side, about, channels) in
            [("Input", "Inputs", &call.inputs), ("Output", "Outputs", &call.outputs)]
        {
            let mut parameters = Vec::new();
            if plan.has_time() {
                parameters.push("    now_whole: I64 @< Time since the start: whole seconds\n".to_owned());
                parameters.push("    now_part: I64 @< Femtoseconds past them\n".to_owned());
            }
            parameters.extend(channels.iter().map(|channel| {
                let escape = if KEYWORDS.contains(&channel.name.as_str()) { "$" } else { "" };
                format!("    {escape}{}: {} @< {}\n", channel.name, type_name(channel), channel.about)
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
        .replace(
            "COUNTERSPARAMETERS    @ Answer",
            &format!("{counters}{}    @ Answer", modelled_parameters(plan)),
        )
        .replace("MEASURED", &measured)
}

/// Returns the parameter of the time, as the exported functions take it.
fn now(plan: &Plan<'_>) -> &'static str {
    if plan.has_time() { "const LOWER_ticks& now, " } else { "" }
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
    if plan.inits_at_time() {
        members.push_str("    bool m_hasStarted;\n");
    }
    let mut taken = "";
    if !plan.parameters.is_empty() {
        members.push_str("    LOWER_parameters m_parameters;\n");
        taken = "    void parameterUpdated(FwPrmIdType id) override;\n    void parametersLoaded() override;\n\n    // Takes the parameters, if \
                 they are within their limits.\n    void takeParameters();\n\n";
    }
    include_str!("../files/fprime/component.hpp")
        .replace("HANDLERS", &handlers)
        .replace("PARAMETERS", taken)
        .replace("FUNCTIONS", &functions)
        .replace(
            "TIME    bool",
            if plan.has_time() { "    LOWER_ticks m_now;\n    bool" } else { "    bool" },
        )
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
    // Modes begin at the time of the first inputs.
    let start = if plan.inits_at_time() {
        zeros.push_str(", m_hasStarted(false)");
        "this->m_hasStarted = false;".to_owned()
    } else {
        format!("LOWER_init(&this->m_state);{}", set_parameters(plan))
    };
    if !plan.parameters.is_empty() {
        zeros.push_str(", m_parameters(LOWER_default_parameters)");
    }
    let (initial, given) = if plan.has_time() { ("m_now(), ", "this->m_now, ") } else { ("", "") };
    include_str!("../files/fprime/component.cpp")
        .replace("BEGIN_STATE", &start)
        .replace("PARAMETERS", &parameter_functions(plan))
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
        "void COMPONENT ::{name}Input_handler(FwIndexType portNum{}) {{\n    (void)portNum;\n    LOWER_{name}_input input{{}};\n",
        handled(plan, call)
    );
    for channel in &call.inputs {
        copy(channel, &format!("input.{}", channel.name), &channel.name, &mut text);
    }
    if plan.has_time() {
        text.push_str("    LOWER_ticks now;\n    now.whole = now_whole;\n    now.part = now_part;\n");
    }
    let now = if plan.has_time() { "now, " } else { "" };
    if is_law {
        if plan.has_time() {
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
    let given = if plan.has_time() { "now, " } else { "" };
    let start = if plan.inits_at_time() {
        format!(
            "    if (!this->m_hasStarted) {{\n        LOWER_init(&this->m_state, now);{}\n        this->m_hasStarted = true;\n    }}\n",
            set_parameters(plan).replace("\n    ", "\n        ")
        )
    } else {
        String::new()
    };
    let mut text = format!(
        "void COMPONENT ::{name}({}const LOWER_{name}_input& input) {{\n    LOWER_{name}_output output;\n{start}    \
         LOWER_{name}(&this->m_state, {given}&input, &output);\n",
        now(plan)
    );
    let mut arguments: Vec<String> = vec!["0".to_owned()];
    if plan.has_time() {
        arguments.extend(["now.whole".to_owned(), "now.part".to_owned()]);
    }
    for channel in &call.outputs {
        if channel.count == 1 {
            arguments.push(format!("output.{}", channel.name));
        } else {
            let _ = writeln!(text, "    {} {};", type_name(channel), channel.name);
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
