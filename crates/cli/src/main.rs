//! The command `flexsc`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(flexsc_cli::main(std::env::args_os()))
}
