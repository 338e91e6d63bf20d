//! App of cFS: messages, the functions that treat them, configuration, and stubs with which it is tested.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::payload::Payload;
use super::{cfs_replay, named};
use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::glue::camel;
use crate::package::{PackageFile, Plan, text};

/// Longest name of a pipe: cFS keeps 20 bytes of it.
const LONGEST_PIPE: usize = 19;
/// Longest name of the file of a table, of which cFS keeps 20 bytes too.
const LONGEST_FILE: usize = 19;
/// First number of a topic of the app.
const FIRST_TOPIC: usize = 0x90;

/// Returns the files of the app, of its stubs and their Makefile.
pub(super) fn files(plan: &Plan<'_>, header: &str, source: &str) -> Vec<PackageFile> {
    let (prefix, app) = (plan.prefix, format!("cfs/{}_app", plan.prefix));
    let pipe = shortened(prefix, LONGEST_PIPE - "_PIPE".len()).to_uppercase();
    let of_config = |name: &str| format!("{app}/config/default_{prefix}_app_{name}.h");
    let file = |path: String, template: &str| text(path, named(template, plan));
    let table_name = table_name(plan);
    let with_table = |text: String| if plan.parameters.is_empty() { String::new() } else { text };
    let checked = format!(" $(APP)/fsw/tables/{table_name}.c");
    let tables = format!("add_cfe_tables(LOWER_app fsw/tables/{table_name}.c)\n");
    let mut files = vec![
        file(
            "cfs/Makefile".to_owned(),
            &include_str!("../files/cfs/Makefile").replace("MORE", &with_table(checked)),
        ),
        file(
            format!("{app}/CMakeLists.txt"),
            &include_str!("../files/cfs/CMakeLists.txt").replace("TABLES", &with_table(tables)),
        ),
        file(format!("{app}/arch_build.cmake"), include_str!("../files/cfs/arch_build.cmake")),
        file(format!("{app}/mission_build.cmake"), include_str!("../files/cfs/mission_build.cmake")),
        file(of_config("msg"), &messages(plan)),
        file(of_config("msgids"), &message_ids(plan)),
        file(of_config("perfids"), include_str!("../files/cfs/perfids.h")),
        file(
            of_config("platform_cfg"),
            &include_str!("../files/cfs/platform_cfg.h").replace("PIPE_NAME\"", &format!("{pipe}_PIPE\"")),
        ),
        file(of_config("topicids"), &topics(plan)),
        file(format!("{app}/fsw/inc/{prefix}_app_eventids.h"), include_str!("../files/cfs/eventids.h")),
        text(format!("{app}/fsw/src/{prefix}.c"), source.to_owned()),
        text(format!("{app}/fsw/src/{prefix}.h"), header.to_owned()),
        file(format!("{app}/fsw/src/{prefix}_app.c"), &app_source(plan)),
        file(format!("{app}/fsw/src/{prefix}_app.h"), &app_header(plan)),
        file("cfs/stubs/bus.c".to_owned(), include_str!("../files/cfs/stub_bus.c")),
        file("cfs/stubs/bus.h".to_owned(), include_str!("../files/cfs/stub_bus.h")),
        file("cfs/stubs/cfe.h".to_owned(), include_str!("../files/cfs/stub_cfe.h")),
        file(
            "cfs/stubs/cfe_core_api_base_msgids.h".to_owned(),
            include_str!("../files/cfs/stub_base_msgids.h"),
        ),
        file("cfs/stubs/replay.c".to_owned(), &cfs_replay::replay(plan)),
    ];
    if !plan.parameters.is_empty() {
        files.extend([
            file(format!("{app}/fsw/tables/{table_name}.c"), &table(plan)),
            file(
                "cfs/stubs/cfe_tbl_filedef.h".to_owned(),
                "/* STUB of the header of tables of cFE: see cfe.h. */\n#include \"cfe.h\"\n",
            ),
        ]);
    }
    files
}

/// Returns the name of the table's source without its extension; the build of cFS requires that the file of the table has it too.
fn table_name(plan: &Plan<'_>) -> String {
    format!("{}_tbl", shortened(plan.prefix, LONGEST_FILE - "_tbl.tbl".len()))
}

/// Returns a name of at most this length; a longer one keeps its start, and ends with four digits by which names with that start
/// differ.
fn shortened(name: &str, longest: usize) -> String {
    if name.len() <= longest {
        return name.to_owned();
    }
    let hash = Sha256::digest(name);
    let start: String = name.chars().take(longest - 4).collect();
    format!("{start}{:02x}{:02x}", hash[0], hash[1])
}

/// Returns the table of parameters, with the defaults.
fn table(plan: &Plan<'_>) -> String {
    let rows: Vec<String> =
        plan.parameters.iter().map(|own| format!("    .{} = {:?}", own.name, own.value)).collect();
    format!(
        "/* Table of the parameters, which the app validates. */\n#include \"cfe_tbl_filedef.h\"\n\n#include \"LOWER.h\"\n\n\
         extern LOWER_parameters Parameters;\nLOWER_parameters Parameters = {{\n{}\n}};\n\n\
         CFE_TBL_FILEDEF(Parameters, UPPER_APP.Parameters, Control parameters, {}.tbl)\n",
        rows.join(",\n"),
        table_name(plan)
    )
}

/// Returns the functions with which the app takes a table of parameters.
fn table_functions() -> &'static str {
    "/* Validates a table of parameters. */\nstatic int32_t UPPER_APP_ValidateParameters(void *Table)\n{\n    \
     return LOWER_parameters_check((const LOWER_parameters *)Table) == 0 ? CFE_SUCCESS : -1;\n}\n\n\
     /* Takes the parameters of a table that was loaded. */\nstatic void UPPER_APP_ManageParameters(void)\n{\n    void *Table = NULL;\n\n    \
     CFE_TBL_Manage(UPPER_APP_Data.Table);\n    if (CFE_TBL_GetAddress(&Table, UPPER_APP_Data.Table) == CFE_TBL_INFO_UPDATED) {\n        \
     UPPER_APP_Data.Parameters = *(const LOWER_parameters *)Table;\n        (void)LOWER_set_parameters(&UPPER_APP_Data.State, &UPPER_APP_Data.Parameters);\n    \
     }\n    CFE_TBL_ReleaseAddress(UPPER_APP_Data.Table);\n}\n\n"
}

/// Statements of the app that register the table of parameters.
const REGISTERED: &str = "    Status = CFE_TBL_Register(&UPPER_APP_Data.Table, \"Parameters\", sizeof(LOWER_parameters), CFE_TBL_OPT_DEFAULT,\n        \
     UPPER_APP_ValidateParameters);\n    if (Status == CFE_SUCCESS) {\n        \
     Status = CFE_TBL_Load(UPPER_APP_Data.Table, CFE_TBL_SRC_ADDRESS, &LOWER_default_parameters);\n    }\n    if (Status != CFE_SUCCESS) {\n        \
     CFE_ES_WriteToSysLog(\"UPPER: no table, status 0x%08lX\\n\", (unsigned long)Status);\n        return Status;\n    }\n";

/// Returns the name of the law: the last function.
fn law<'a>(plan: &Plan<'a>) -> &'a CallLayout {
    &plan.calls[plan.calls.len() - 1]
}

/// Returns the header of the messages.
fn messages(plan: &Plan<'_>) -> String {
    let mut text = "/* Messages of the app: numbers in the byte order of the processor. */\n#ifndef UPPER_APP_MSG_H\n\
                    #define UPPER_APP_MSG_H\n\n#include \"cfe.h\"\n\n/* Codes of commands. */\n#define UPPER_APP_NOOP_CC           0\n\
                    #define UPPER_APP_RESET_COUNTERS_CC 1\n/* Sets the state of the control system as before its first call. */\n\
                    #define UPPER_APP_RESTART_CC        2\n\n/* Message without a payload: all commands, the request of the counters, and \
                    the message that wakes the\n * app up. */\ntypedef struct {\n    CFE_MSG_CommandHeader_t CommandHeader;\n} \
                    UPPER_APP_NoArgsCmd_t;\n\n"
        .to_owned();
    for call in plan.calls {
        for (is_input, side, about) in [(true, "Input", "Inputs"), (false, "Output", "Outputs")] {
            let payload = Payload::for_call(plan, call, is_input);
            let _ = write!(
                text,
                "/* {about} of `LOWER_{}`. {} */\n{}",
                call.name,
                call.about,
                payload.definition()
            );
            let _ = writeln!(
                text,
                "typedef struct {{\n    CFE_MSG_TelemetryHeader_t TelemetryHeader;\n    {} Payload;\n}} UPPER_APP_{}_{side}_t;\n",
                payload.name,
                camel(call.name)
            );
        }
    }
    let _ = write!(
        text,
        "/* Counters. */\ntypedef struct {{\n    /* Messages that woke the app up, and those without new inputs. */\n    uint32 WakeUps;\n    \
         uint32 MissedInputs;\n    /* Messages of a wrong length or for another app. */\n    uint32 RefusedMessages;\n    \
         /* Calls of {}. */\n    uint32 Calls[{}];\n    uint16 CommandCounter;\n    uint16 CommandErrorCounter;\n}} \
         UPPER_APP_HkTlm_Payload_t;\n\ntypedef struct {{\n    CFE_MSG_TelemetryHeader_t TelemetryHeader;\n    \
         UPPER_APP_HkTlm_Payload_t Payload;\n}} UPPER_APP_HkTlm_t;\n\n#endif\n",
        plan.calls.iter().map(|call| format!("`LOWER_{}`", call.name)).collect::<Vec<_>>().join(", "),
        plan.calls.len()
    );
    text
}

/// Returns the names of the messages with the inputs or outputs of each function.
fn names(plan: &Plan<'_>, side: &str) -> Vec<String> {
    plan.calls.iter().map(|call| format!("{}_{side}", call.name.to_uppercase())).collect()
}

/// Returns the numbers of topics: commands, then telemetry.
fn topics(plan: &Plan<'_>) -> String {
    let commands = ["CMD", "SEND_HK", "WAKE_UP"].map(str::to_owned);
    let telemetry: Vec<String> =
        ["HK_TLM".to_owned()].into_iter().chain(names(plan, "INPUT")).chain(names(plan, "OUTPUT")).collect();
    let mut text =
        "/* Topics of the app. A mission sets numbers that no other app has. */\n#ifndef UPPER_APP_TOPICIDS_H\n\
         #define UPPER_APP_TOPICIDS_H\n\n"
            .to_owned();
    for list in [&commands[..], &telemetry[..]] {
        for (index, name) in list.iter().enumerate() {
            let _ =
                writeln!(text, "#define CFE_MISSION_UPPER_APP_{name}_TOPICID 0x{:x}", FIRST_TOPIC + index);
        }
        text.push('\n');
    }
    text.push_str("#endif\n");
    text
}

/// Returns the numbers of messages.
fn message_ids(plan: &Plan<'_>) -> String {
    let mut text =
        "/* Numbers of the messages of the app. */\n#ifndef UPPER_APP_MSGIDS_H\n#define UPPER_APP_MSGIDS_H\n\n\
         #include \"cfe_core_api_base_msgids.h\"\n#include \"LOWER_app_topicids.h\"\n\n"
            .to_owned();
    for name in ["CMD", "SEND_HK", "WAKE_UP"] {
        let _ = writeln!(
            text,
            "#define UPPER_APP_{name}_MID CFE_PLATFORM_CMD_TOPICID_TO_MIDV(CFE_MISSION_UPPER_APP_{name}_TOPICID)"
        );
    }
    for name in ["HK_TLM".to_owned()].into_iter().chain(names(plan, "INPUT")).chain(names(plan, "OUTPUT")) {
        let _ = writeln!(
            text,
            "#define UPPER_APP_{name}_MID CFE_PLATFORM_TLM_TOPICID_TO_MIDV(CFE_MISSION_UPPER_APP_{name}_TOPICID)"
        );
    }
    text.push_str("\n#endif\n");
    text
}

fn app_header(plan: &Plan<'_>) -> String {
    let mut outputs = "    /* Messages that the app sends. */\n".to_owned();
    for call in plan.calls {
        let name = camel(call.name);
        let _ = writeln!(outputs, "    UPPER_APP_{name}_Output_t {name}_Output;");
    }
    if !plan.parameters.is_empty() {
        outputs.push_str("    /* Table of parameters, and those in use. */\n    CFE_TBL_Handle_t Table;\n    LOWER_parameters Parameters;\n");
    }
    if plan.inits_at_time() {
        outputs.push_str("    /* True from the first inputs on, at whose time the control system starts. */\n    bool HasStarted;\n");
    }
    include_str!("../files/cfs/app.h").replace("LAW", &camel(law(plan).name)).replace("OUTPUTS", &outputs)
}

fn app_source(plan: &Plan<'_>) -> String {
    let measured: Vec<String> =
        plan.calls[..plan.calls.len() - 1].iter().map(|call| format!("`LOWER_{}`", call.name)).collect();
    let measured = if measured.is_empty() { "no function".to_owned() } else { measured.join(", ") };
    let (mut functions, mut cases, mut initialised) = (String::new(), String::new(), String::new());
    for (index, call) in plan.calls.iter().enumerate() {
        let (name, upper) = (camel(call.name), call.name.to_uppercase());
        functions.push_str(&function(plan, index, call));
        let action = if index + 1 == plan.calls.len() {
            format!(
                "UPPER_APP_Data.{name}_Input = *(const UPPER_APP_{name}_Input_t *)Buffer;\n                \
                 UPPER_APP_Data.Has_{name}_Input = true;"
            )
        } else {
            format!("UPPER_APP_{name}(&((const UPPER_APP_{name}_Input_t *)Buffer)->Payload);")
        };
        let _ = writeln!(
            cases,
            "        case UPPER_APP_{upper}_INPUT_MID:\n            \
             if (UPPER_APP_HasLength(Message, sizeof(UPPER_APP_{name}_Input_t))) {{\n                {action}\n            \
             }}\n            break;"
        );
        let _ = writeln!(
            initialised,
            "    CFE_MSG_Init(CFE_MSG_PTR(UPPER_APP_Data.{name}_Output.TelemetryHeader),\n        \
             CFE_SB_ValueToMsgId(UPPER_APP_{upper}_OUTPUT_MID), sizeof(UPPER_APP_Data.{name}_Output));"
        );
    }
    let subscribed: Vec<String> =
        names(plan, "INPUT").iter().map(|name| format!("UPPER_APP_{name}_MID")).collect();
    // Modes begin at the time of the first inputs.
    let is_later = plan.inits_at_time();
    let has_table = !plan.parameters.is_empty();
    let set = "\n    (void)LOWER_set_parameters(&UPPER_APP_Data.State, &UPPER_APP_Data.Parameters);";
    let start = if is_later {
        "UPPER_APP_Data.HasStarted = false;".to_owned()
    } else {
        format!("LOWER_init(&UPPER_APP_Data.State);{}", if has_table { set } else { "" })
    };
    if has_table {
        functions.insert_str(0, table_functions());
        initialised.push_str(REGISTERED);
    }
    let defaults = "    UPPER_APP_Data.Parameters = LOWER_default_parameters;\n";
    include_str!("../files/cfs/app.c")
        .replace("BEGIN_STATE", &start)
        .replace("DEFAULTS", if has_table { defaults } else { "" })
        .replace("MANAGED", if has_table { "    UPPER_APP_ManageParameters();\n" } else { "" })
        .replace("LOWER_LAW", &format!("LOWER_{}", law(plan).name))
        .replace("LAW", &camel(law(plan).name))
        .replace("MEASURED", &measured)
        .replace("FUNCTIONS", &functions)
        .replace("CASES", &cases)
        .replace("SUBSCRIBED", &subscribed.join(", "))
        .replace("INITIALISED", &initialised)
}

/// Returns the function that calls a function of the control system with a payload, and publishes its outputs.
fn function(plan: &Plan<'_>, index: usize, call: &CallLayout) -> String {
    let (name, lower) = (camel(call.name), call.name);
    let mut text = format!(
        "/* {} */\nstatic void UPPER_APP_{name}(const UPPER_APP_{name}_Input_Payload_t *In)\n{{\n    LOWER_{lower}_input Input;\n    \
         LOWER_{lower}_output Output;\n    UPPER_APP_{name}_Output_Payload_t *Out = &UPPER_APP_Data.{name}_Output.Payload;\n\n",
        call.about
    );
    if call.inputs.is_empty() {
        text.push_str("    Input.unused = false;\n");
    }
    for channel in &call.inputs {
        copy(channel, "Input.", "In->", " != 0", &mut text);
    }
    let time = "(LOWER_ticks){ .whole = In->now_whole, .part = In->now_part }";
    if plan.inits_at_time() {
        let _ = writeln!(
            text,
            "    if (!UPPER_APP_Data.HasStarted) {{\n        LOWER_init(&UPPER_APP_Data.State, {time});\n{}        UPPER_APP_Data.HasStarted = true;\n    }}",
            if plan.parameters.is_empty() {
                ""
            } else {
                "        (void)LOWER_set_parameters(&UPPER_APP_Data.State, &UPPER_APP_Data.Parameters);\n"
            }
        );
    }
    let now = if plan.has_time() { format!("{time}, ") } else { String::new() };
    let _ = writeln!(text, "    LOWER_{lower}(&UPPER_APP_Data.State, {now}&Input, &Output);");
    if plan.has_time() {
        text.push_str("    Out->now_whole = In->now_whole;\n    Out->now_part = In->now_part;\n");
    }
    for channel in &call.outputs {
        copy(channel, "Out->", "Output.", " ? 1 : 0", &mut text);
    }
    let header = format!("CFE_MSG_PTR(UPPER_APP_Data.{name}_Output.TelemetryHeader)");
    let _ = writeln!(
        text,
        "    UPPER_APP_Data.HkTlm.Payload.Calls[{index}]++;\n    CFE_SB_TimeStampMsg({header});\n    \
         CFE_SB_TransmitMsg({header}, true);\n}}\n"
    );
    text
}

/// Writes the copy of a channel; a truth value is converted.
fn copy(channel: &Channel, to: &str, from: &str, converted: &str, text: &mut String) {
    let (name, converted) = (&channel.name, if channel.kind == NumberKind::Flag { converted } else { "" });
    if channel.count == 1 {
        let _ = writeln!(text, "    {to}{name} = {from}{name}{converted};");
    } else {
        let _ = writeln!(
            text,
            "    for (size_t Index = 0; Index < {}; Index++) {{\n        {to}{name}[Index] = {from}{name}[Index]{converted};\n    }}",
            channel.count
        );
    }
}

#[cfg(test)]
mod tests {
    use super::shortened;

    #[test]
    fn names_with_equal_starts_stay_different() {
        assert_eq!(shortened("observer", 11), "observer");
        let [one, other] = ["earth_observer_day", "earth_observer_night"].map(|name| shortened(name, 11));
        assert!(one != other && one.starts_with("earth_o") && one.len() == 11, "{one} {other}");
    }
}
