//! Features that this build leaves out, and how to get them.

#[cfg(not(feature = "png"))]
use flexsc_figure::Style;

/// Hint of the errors about features that are not built in.
pub const HINT: &str = "hint: cargo build --release --features full";

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
