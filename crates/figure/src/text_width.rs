//! Widths of texts, which the backend does not know, and texts that fit into a width.

/// Least size of letters (px): 5.5 pt where the axes' names have 7 pt.
pub const SMALLEST: f64 = 9.5;

/// Estimates the width of a text of a size (px).
pub fn wide(text: &str, size: f64) -> f64 {
    0.57 * size * text.chars().count() as f64
}

/// Returns the font size, at most `most` (px), at which a text fits into `room` (px), but no smaller than legible.
pub fn fitting(text: &str, room: f64, most: f64) -> f64 {
    (room / wide(text, 1.0)).clamp(SMALLEST, most)
}

/// Splits a text between words into lines that fit, each as long as possible.
pub fn split(text: &str, fits: impl Fn(&str) -> bool) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if fits(&format!("{line} {word}")) => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}
