//! Reader of figures: their texts, shapes and numbers.

use roxmltree::{Document, Node};

use crate::util::Dir;

pub const BLUE: &str = "#0072B2";
pub const SKY: &str = "#56B4E9";
pub const VERMILLION: &str = "#D55E00";
pub const BLACK: &str = "#000000";
/// Colour of limits.
pub const RED: &str = "#BE1E2D";

/// A point in the units of a figure's file.
pub type Point = (f64, f64);

/// A figure.
pub struct Drawing(pub String);

impl Drawing {
    pub fn read(dir: &Dir, name: &str) -> Self {
        Self(dir.text(&format!("figures/{name}.svg")))
    }

    /// Reads a figure from any path.
    pub fn at(dir: &Dir, path: &str) -> Self {
        Self(dir.text(path))
    }

    /// Returns a value of each element that has one.
    pub fn each<T>(&self, of: impl Fn(&Node<'_, '_>) -> Option<T>) -> Vec<T> {
        let document = Document::parse(&self.0).expect("well-formed XML");
        document.descendants().filter_map(|node| of(&node)).collect()
    }

    pub fn texts(&self) -> Vec<String> {
        self.each(|node| node.text().map(|text| text.trim().to_owned()))
    }

    #[track_caller]
    pub fn shows(&self, words: &[&str]) {
        let texts = self.texts();
        for words in words {
            assert!(texts.iter().any(|text| text == words), "no `{words}` in {texts:?}");
        }
    }

    /// Returns the points of all elements of a kind with a paint of a colour.
    pub fn shapes(&self, kind: &str, paint: &str, colour: &str) -> Vec<Vec<Point>> {
        self.each(|node| {
            let is = node.has_tag_name(kind) && node.attribute(paint) == Some(colour);
            is.then(|| points(node.attribute("points").unwrap_or_default()))
        })
    }

    /// Returns the line of a colour with the most points, the first of such.
    pub fn line(&self, colour: &str) -> Vec<Point> {
        let lines = self.shapes("polyline", "stroke", colour);
        lines.into_iter().rev().max_by_key(Vec::len).expect("a line")
    }

    /// Returns the position of a number at an axis.
    pub fn number(&self, text: &str) -> Point {
        let place = |node: &Node<'_, '_>| {
            let is = node.has_tag_name("text") && node.text().map(str::trim) == Some(text);
            let number = |name: &str| node.attribute(name)?.parse().ok();
            is.then(|| Some((number("x")?, number("y")?)))?
        };
        self.each(place).first().copied().unwrap_or_else(|| panic!("no number {text}"))
    }

    /// Returns the horizontal value at `x`, by the numbers below the last panel, in the unit of the axis.
    pub fn along(&self, x: f64) -> f64 {
        let number = |node: &Node<'_, '_>| {
            let text = node
                .text()
                .filter(|_| node.has_tag_name("text"))?
                .trim()
                .replace('−', "-")
                .replace('\u{202f}', "");
            let place = |name: &str| node.attribute(name)?.parse::<f64>().ok();
            Some((text.parse::<f64>().ok()?, place("x")?, place("y")?))
        };
        let numbers = self.each(number);
        let row = |y: f64| numbers.iter().filter(|n| n.2.to_bits() == y.to_bits()).collect::<Vec<_>>();
        let row = numbers.iter().rev().map(|n| row(n.2)).find(|row| row.len() > 1).expect("an axis");
        let (first, last) = (row[0], row[row.len() - 1]);
        first.0 + (last.0 - first.0) * (x - first.1) / (last.1 - first.1)
    }

    /// Returns the vertical value at `y`, by two numbers of the vertical axis of the first panel.
    pub fn up(&self, y: f64, [low, high]: [&str; 2]) -> f64 {
        let ([a, b], [from, to]) = ([low, high].map(|text| self.number(text).1), [low, high].map(value));
        from + (to - from) * (y - a) / (b - a)
    }

    /// Returns the horizontal value at `x`, by two numbers of the horizontal axis.
    pub fn across(&self, x: f64, [low, high]: [&str; 2]) -> f64 {
        let ([a, b], [from, to]) = ([low, high].map(|text| self.number(text).0), [low, high].map(value));
        from + (to - from) * (x - a) / (b - a)
    }
}

fn value(text: &str) -> f64 {
    text.replace('−', "-").replace('\u{202f}', "").parse().expect("a number")
}

fn points(text: &str) -> Vec<Point> {
    let point = |pair: &str| {
        let (x, y) = pair.split_once(',').expect("a pair");
        (value(x), value(y))
    };
    text.split_whitespace().map(point).collect()
}

#[track_caller]
pub fn near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() <= tolerance, "{found} is not {exact}");
}
