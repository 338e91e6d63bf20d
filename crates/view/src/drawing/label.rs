//! Labels of a drawing: texts in its corners, with leaders to what they name.

use std::fmt::Write;

use flexsc_core::numerics::attitude::Vector;

use super::projection::Projection;
use super::{SIZE, escaped};

/// Distance of labels, and of the upper and the lower ones from the edges.
const STEP: f64 = 46.0;
const TOP: f64 = 22.0;
const BOTTOM: [f64; 2] = [140.0, 72.0];
/// Widths of a character of the first and the second line.
const WIDTHS: [f64; 2] = [8.6, 7.2];

/// Text with the point that it names.
#[derive(Clone, Debug)]
pub struct Label {
    /// Point (m).
    pub at: Vector,
    /// First line, in bold, and second line.
    pub lines: [String; 2],
}

impl Label {
    /// Creates a label of a point.
    pub fn new(at: Vector, first: impl Into<String>, second: impl Into<String>) -> Self {
        Self { at, lines: [first.into(), second.into()] }
    }
}

/// Returns labels with their leaders: on each side the upper half of them above, the rest below.
pub fn drawn(labels: &[Label], view: &Projection) -> String {
    let mut svg = String::new();
    for right in [false, true] {
        let is_right = |label: &&Label| (view.place(&label.at)[0] > SIZE[0] / 2.0 - 4.0) == right;
        let mut own: Vec<&Label> = labels.iter().filter(is_right).collect();
        own.sort_by(|a, b| view.place(&a.at)[1].total_cmp(&view.place(&b.at)[1]));
        let half = own.len().div_ceil(2);
        // A leader begins at the inner end of its text: those to the middle have the outer places, and cross no other text.
        let from_middle = |label: &Label| (view.place(&label.at)[0] - SIZE[0] / 2.0).abs();
        own[..half].sort_by(|a, b| from_middle(a).total_cmp(&from_middle(b)));
        own[half..].sort_by(|a, b| from_middle(b).total_cmp(&from_middle(a)));
        let (upper, lower) = own.split_at(half);
        let bottom = SIZE[1] - BOTTOM[usize::from(right)] - STEP * (lower.len().max(1) - 1) as f64;
        for (labels, from) in [(upper, TOP), (lower, bottom)] {
            for (place, label) in labels.iter().enumerate() {
                add(&mut svg, label, (right, from + STEP * place as f64), view.place(&label.at));
            }
        }
    }
    svg
}

fn add(svg: &mut String, label: &Label, (right, y): (bool, f64), [px, py]: [f64; 2]) {
    let (x, anchor, side) = if right { (SIZE[0] - 8.0, "end", -1.0) } else { (8.0, "start", 1.0) };
    let widths = [0, 1].map(|line| label.lines[line].chars().count() as f64 * WIDTHS[line]);
    let (from, height) = (x + side * (widths[0].max(widths[1]) + 5.0), y + 4.0);
    let [first, second] = [0, 1].map(|line| escaped(&label.lines[line]));
    let text = format!("text x=\"{x}\" text-anchor=\"{anchor}\"");
    // Writing to a string cannot fail.
    let _ = writeln!(
        svg,
        "<path d=\"M{px:.1},{py:.1} L{from:.1},{height:.1}\" stroke=\"#6b7785\" stroke-width=\".9\" fill=\"none\"/>\
         <circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"2.4\" fill=\"#1b2733\"/>\
         <{text} y=\"{y:.1}\" font-size=\"14.5\" font-weight=\"bold\" fill=\"#1b2733\">{first}</text>\
         <{text} y=\"{:.1}\" font-size=\"13\" fill=\"#4a5663\">{second}</text>",
        y + 16.0
    );
}
