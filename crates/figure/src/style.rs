//! Size of a figure on paper, and of its letters.

use std::ops::RangeInclusive;

/// Pixels of SVG and CSS per millimetre and per point.
const PER_MM: f64 = 96.0 / 25.4;
const PER_PT: f64 = 96.0 / 72.0;
/// Size of the axes' names in the layout (px).
const NAMES: f64 = 12.0;
/// Width of the layout for screens (px).
const SCREEN: f64 = 800.0;
/// Largest number of columns of a sheet for screens, and width of a page (mm).
const COLUMNS: usize = 3;
const PAGE: f64 = 181.0;
/// Size of the axes' names if only a width is given (pt).
const USUAL: f64 = 8.0;
/// Minimum and maximum width of the layout (px).
const LAYOUTS: RangeInclusive<f64> = 230.0..=3000.0;

/// Size of a figure and of its letters.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Style {
    /// Width (mm); 800 px by default.
    width: Option<f64>,
    /// Size of the axes' names (pt).
    font: Option<f64>,
    /// True if titles are drawn.
    is_titled: bool,
}

impl Style {
    /// Creates a style from a width (mm) and a size of the axes' names (pt).
    ///
    /// # Errors
    /// If a size is out of range, or the letters are too large for the width.
    pub fn new(width: Option<f64>, font: Option<f64>) -> Result<Self, String> {
        if let Some(width) = width.filter(|width| !(30.0..=400.0).contains(width)) {
            return Err(format!("the width must be 30 to 400 mm, got {width}"));
        }
        if let Some(font) = font.filter(|font| !(4.0..=24.0).contains(font)) {
            return Err(format!("the font must have 4 to 24 pt, got {font}"));
        }
        let style = Self { width, font, is_titled: false };
        if !LAYOUTS.contains(&style.across()) {
            let (width, font) = (style.width_mm(), font.unwrap_or(USUAL));
            return Err(format!("a figure {width:.0} mm wide has no room for letters of {font} pt"));
        }
        Ok(style)
    }

    /// Returns the style with the titles of figures above them.
    #[must_use]
    pub fn titled(self) -> Self {
        Self { is_titled: true, ..self }
    }

    /// Returns true if titles are drawn.
    pub fn is_titled(&self) -> bool {
        self.is_titled
    }

    fn width_mm(&self) -> f64 {
        self.width.unwrap_or(SCREEN / PER_MM)
    }

    /// Returns true if the sizes are those for screens.
    pub fn is_for_screens(&self) -> bool {
        self.width.is_none() && self.font.is_none()
    }

    /// Returns the largest number of columns of a sheet whose letters stay legible: those of a page of 180 mm, or of a wide
    /// screen.
    pub(crate) fn columns(&self) -> usize {
        if self.is_for_screens() { COLUMNS } else { ((PAGE / self.width_mm()) as usize).max(1) }
    }

    /// Returns the pixels on paper per pixel of the layout.
    pub fn scale(&self) -> f64 {
        self.width_mm() * PER_MM / f64::from(self.layout_width())
    }

    /// Returns the width of the layout before rounding (px).
    fn across(&self) -> f64 {
        if self.is_for_screens() {
            return SCREEN;
        }
        self.width_mm() * PER_MM * NAMES / (self.font.unwrap_or(USUAL) * PER_PT)
    }

    /// Returns the width of the layout (px).
    pub fn layout_width(&self) -> u32 {
        self.across().round() as u32
    }

    /// Sets the size on paper of an SVG with this layout, or of a sheet of several.
    pub fn sized(&self, svg: &str) -> String {
        if self.is_for_screens() {
            return svg.to_owned();
        }
        // The size is an attribute of the first element.
        let (head, rest) = svg.split_at(svg.find('>').unwrap_or(0));
        let mut head = head.to_owned();
        for name in ["width", "height"] {
            let Some((before, after)) = head.split_once(&format!(" {name}=\"")) else { continue };
            let Some((number, after)) = after.split_once('"') else { continue };
            let Ok(pixels) = number.parse::<f64>() else { continue };
            let size = pixels * self.scale() / PER_MM;
            head = format!("{before} {name}=\"{size:.3}mm\"{after}");
        }
        head + rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_and_widths_are_those_asked_for() {
        let screen = Style::default();
        assert_eq!(
            (screen.layout_width(), screen.sized("<svg width=\"800\">")),
            (800, "<svg width=\"800\">".into())
        );
        // 8 pt are 10.667 px, and 12 px of the layout.
        let column = Style::new(Some(85.0), None).expect("fits");
        assert_eq!(column.layout_width(), 361);
        let sized = column
            .sized("<svg width=\"361\" height=\"180\" viewBox=\"0 0 3610 1800\"><path stroke-width=\"2\"/>");
        assert!(sized.starts_with("<svg width=\"85.000mm\""), "{sized}");
        assert!(
            sized.contains(" height=\"42.382mm\" viewBox=\"0 0 3610 1800\"><path stroke-width=\"2\"/>"),
            "{sized}"
        );
        let large = Style::new(None, Some(18.0)).expect("fits");
        assert_eq!(large.layout_width(), 400);
        for (width, font) in [(Some(10.0), None), (None, Some(f64::NAN)), (Some(60.0), Some(24.0))] {
            assert!(Style::new(width, font).is_err(), "{width:?} {font:?}");
        }
    }
}
