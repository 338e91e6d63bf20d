//! Makefile, description and start-up code of boards.

use std::fmt::Write as _;

use super::Plan;
use super::accuracy::{OutputAccuracy, table};

/// Files with which the driver runs on a Cortex-M board.
pub fn board_files() -> [(&'static str, &'static str); 6] {
    [
        ("boards/double_sum.c", include_str!("files/double_sum.c")),
        ("boards/instructions.c", include_str!("files/instructions.c")),
        ("boards/instructions.h", include_str!("files/instructions.h")),
        ("boards/mps2.ld", include_str!("files/mps2.ld")),
        ("boards/stack.awk", include_str!("files/stack.awk")),
        ("boards/start.c", include_str!("files/start.c")),
    ]
}

/// Returns the Makefile, with the hashes of the self-test for numbers of cycles.
pub fn makefile(prefix: &str, hashes: &[(u64, u64)]) -> String {
    let mut text = include_str!("files/Makefile").replace("NAME", prefix);
    // The longer names come first.
    for (cycles, hash) in hashes.iter().rev() {
        text = text.replace(&format!("HASH_{cycles}\n"), &format!("{hash:016x}\n"));
    }
    text
}

/// Returns the description of the directory.
pub fn readme(plan: &Plan<'_>, hashes: &[(u64, u64)], vectors: usize, accuracy: &[OutputAccuracy]) -> String {
    let prefix = plan.prefix;
    let mut text = format!(
        "# Control system of {}\n\nExported by flexsc {}. `{prefix}.h` and `{prefix}.c` are the control system: C99, no heap, no library but \
         `memcpy`. The code is translated from the Rust code that flexsc calls in a run.\n\n| function | does |\n|---|---|\n",
        plan.origin.file,
        env!("CARGO_PKG_VERSION")
    );
    for call in plan.calls {
        let _ = writeln!(text, "| `{prefix}_{}` | {} |", call.name, call.about);
    }
    text.push_str(&origin(plan, &format!("text `{prefix}_version`")));
    let _ = write!(
        text,
        "\n`{prefix}.icd.json` has the interface: inputs and outputs with unit, frame and range, and the order of calls. `main_loop.c` is a main loop, \
         which `make main-loop` builds.\n\n`make check` replays the {vectors} calls in `vectors.bin`, recorded in a run of flexsc, and compares every output by bits; \
         then it calls the functions with random and extreme inputs (zeros, subnormals, infinities, NaN) and compares a hash. \
         `make check-all` does the same under emulation on AArch64, RISC-V, Cortex-M4F and Cortex-M7. `make instructions` counts the most instructions of a call on the boards, and \
         `make lint` runs static analysis.\n\n| cycles | hash |\n|---|---|\n"
    );
    for (cycles, hash) in hashes {
        let _ = writeln!(text, "| {cycles} | {hash:016x} |");
    }
    text.push_str(&table(accuracy, vectors));
    let _ = write!(
        text,
        "\nEqual bits need IEEE 754 {}, round to nearest, subnormal numbers, no fused multiply-add (`-ffp-contract=off`) and no \
         fast-math. An output must not be compared by bits if it is NaN.\n",
        plan.numbers()
    );
    text
}

/// Returns the description of the directory of a crate.
pub fn readme_of_crate(plan: &Plan<'_>, vectors: usize, accuracy: &[OutputAccuracy]) -> String {
    let name = plan.prefix;
    let mut text = format!(
        "# Control system of {}\n\nExported by flexsc {} as a crate: `no_std`, no heap, no dependencies and no unsafe code. `src/control_system.rs` has the functions, \
         from the text that `flexsc export-c` translates to C; the other files are the flight code that flexsc calls in a run.\n\n| function | does |\n|---|---|\n",
        plan.origin.file,
        env!("CARGO_PKG_VERSION")
    );
    for call in plan.calls {
        let _ = writeln!(text, "| `{name}::control_system::{}` | {} |", call.name, call.about);
    }
    text.push_str(&origin(plan, "constant `VERSION`"));
    let _ = write!(
        text,
        "\nA state begins as `State::UNSET`, and `init` sets it. `cargo test` replays the {vectors} calls in `vectors.bin`, recorded in a run of flexsc, and compares every output by bits; \
         then it calls the functions with random and extreme inputs (zeros, subnormals, infinities, NaN) and compares a hash.\n"
    );
    text + &table(accuracy, vectors)
}

/// Returns the part about the scenario, the version, and the parts of the control loop that are not in the code.
fn origin(plan: &Plan<'_>, version: &str) -> String {
    let mut text = String::new();
    let changes =
        plan.origin.changes.iter().map(|change| format!(", with `{change}`")).collect::<Vec<_>>().concat();
    let _ = writeln!(
        text,
        "\nScenario: {}{changes}; `scenario.toml` has it with all defaults, SHA-256 `{}`. The {version} has the hash in flight. \
         The flight code is part of flexsc, under MIT or Apache-2.0.",
        plan.origin.file, plan.digest
    );
    if plan.excluded_parts.iter().all(|part| part.is_supplied) {
        text.push_str("\nEvery part of the scenario's control loop is in this code.\n");
    }
    for (is_supplied, head) in
        [(false, "Not part of this code"), (true, "Inputs from guidance and ephemerides")]
    {
        let parts: Vec<_> =
            plan.excluded_parts.iter().filter(|part| part.is_supplied == is_supplied).collect();
        if !parts.is_empty() {
            let _ = writeln!(text, "\n{head}:\n\n| part of the scenario | the caller must |\n|---|---|");
        }
        for part in parts {
            let _ = writeln!(text, "| `{}` | {} |", part.key, part.duty);
        }
    }
    text
}
