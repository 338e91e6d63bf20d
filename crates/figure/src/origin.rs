//! Marks that distinguish the files of figures from those of other programs.

/// Attributes that only the SVG of a figure has in this order.
const SVG: &[u8] = br#" stroke-linejoin="round" viewBox="0 0 "#;
/// Comment in the head of a PDF.
pub const PDF: &[u8] = b"% figure of flexsc\n";
/// Chunk of a PNG with the name of the program, and its checksum.
pub const PNG: &[u8] = b"\0\0\0\x0FtEXtSoftware\0flexsc\xD5\xC0\x0D\x9E";
/// Number of bytes in which a mark is looked for.
const HEAD: usize = 300;

/// Returns true if the bytes are those of a file with a figure.
pub fn is_figure(bytes: &[u8]) -> bool {
    let head = &bytes[..bytes.len().min(HEAD)];
    let has = |mark: &[u8]| head.windows(mark.len()).any(|part| part == mark);
    (head.starts_with(b"<svg ") && has(SVG))
        || (head.starts_with(b"%PDF-") && has(PDF))
        || (head.starts_with(b"\x89PNG") && has(PNG))
}

#[cfg(test)]
mod tests {
    use super::is_figure;
    use crate::{Figure, FigureAxis, Panel, Style};

    #[test]
    fn figures_are_distinguished_from_other_files() {
        let axis = || FigureAxis::exact("x", "m", 0.0..1.0);
        let panels = vec![Panel::new(axis(), axis(), Vec::new())];
        let figure = Figure { title: "empty".to_owned(), panels, panel_height: 100 };
        let style = Style::default();
        let svg = figure.laid_out(&style).expect("drawn");
        assert!(is_figure(svg.as_bytes()));
        #[cfg(feature = "png")]
        {
            let renderer = crate::Renderer::default();
            let (png, pdf) = (renderer.png(&svg, &style).expect("drawn"), renderer.pdf(&svg).expect("drawn"));
            assert!(is_figure(&png) && is_figure(&pdf));
            // The chunk is one that readers of PNG accept.
            assert!(resvg::tiny_skia::Pixmap::decode_png(&png).is_ok());
        }
        for other in [&b"<svg width=\"1\"></svg>"[..], b"%PDF-1.5\n", b"\x89PNG\r\n", b"", b"notes"] {
            assert!(!is_figure(other));
        }
    }
}
