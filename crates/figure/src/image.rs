//! Figures as PNG and PDF: the same SVG, rendered with embedded fonts, independent of the system's fonts.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use crate::{Style, origin, pdf};

/// Pixels of a PNG per pixel of the SVG, for screens.
const SCALE: f64 = 2.0;
/// Pixels of a PNG per pixel on paper: 600 per inch.
const FINE: f64 = 600.0 / 96.0;
/// Number of bytes of a PNG before its second chunk.
const HEADER: usize = 33;
/// Maximum number of pixels of a PNG.
const MOST: u32 = 150_000_000;

/// Renderer from SVG to PNG and PDF.
pub struct Renderer(Options<'static>);

impl Default for Renderer {
    /// Creates a renderer with its fonts.
    fn default() -> Self {
        let mut options = Options::default();
        let fonts = options.fontdb_mut();
        fonts.load_font_data(dejavu::sans::regular().to_vec());
        fonts.set_sans_serif_family("DejaVu Sans");
        Self(options)
    }
}

impl Renderer {
    /// Renders the PNG of an SVG that was laid out for a style.
    pub fn png(&self, svg: &str, style: &Style) -> Result<Vec<u8>, String> {
        let tree = Tree::from_str(svg, &self.0).map_err(|error| error.to_string())?;
        let scale = if style.is_for_screens() { SCALE } else { FINE * style.scale() } as f32;
        let size = tree.size().to_int_size().scale_by(scale).ok_or("it has no size")?;
        let too_large = || "it is too large for a PNG, but not for SVG and PDF";
        if size.width().saturating_mul(size.height()) > MOST {
            return Err(too_large().to_owned());
        }
        let mut pixels = Pixmap::new(size.width(), size.height()).ok_or_else(too_large)?;
        resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
        let mut png = pixels.encode_png().map_err(|error| error.to_string())?;
        png.splice(HEADER..HEADER, origin::PNG.iter().copied());
        Ok(png)
    }

    /// Renders the PDF of an SVG, with the glyphs that it uses.
    pub fn pdf(&self, svg: &str) -> Result<Vec<u8>, String> {
        pdf::written(&Tree::from_str(svg, &self.0).map_err(|error| error.to_string())?)
    }
}
