//! Features that this build leaves out, and how to get them.

#[cfg(not(feature = "png"))]
use flexsc_figure::Style;

use crate::error::CliError;

/// Hint of the errors about features that are not built in.
pub const HINT: &str = "hint: cargo build --release --features full";

/// Arguments of a verb that is not built in.
#[derive(clap::Args)]
#[command(disable_help_flag = true)]
pub struct VerbArgs {
    /// Whatever is given
    #[arg(hide = true, trailing_var_arg = true, allow_hyphen_values = true)]
    given: Vec<String>,
}

impl VerbArgs {
    /// Returns the error that `verb` needs `feature`.
    pub fn refuse(&self, verb: &str, feature: &str) -> Result<(), CliError> {
        let words = [&[format!("flexsc {verb}")], &self.given[..]].concat().join(" ");
        Err(CliError::Arguments(format!(
            "{words}: needs the feature `{feature}`, which this build leaves out\n\n{HINT}"
        )))
    }
}

/// Placeholder for the renderer of PNG and PDF.
#[cfg(not(feature = "png"))]
#[derive(Default)]
pub struct Renderer {}

#[cfg(not(feature = "png"))]
impl Renderer {
    #[expect(clippy::unused_self, reason = "as of the renderer that there is with the feature")]
    pub fn png(&self, _: &str, _: &Style) -> Result<Vec<u8>, String> {
        Err(format!("PNG needs the feature `png`, which this build leaves out\n\n{HINT}"))
    }

    #[expect(clippy::unused_self, reason = "as of the renderer that there is with the feature")]
    pub fn pdf(&self, _: &str) -> Result<Vec<u8>, String> {
        Err(format!("PDF needs the feature `png`, which this build leaves out\n\n{HINT}"))
    }
}
