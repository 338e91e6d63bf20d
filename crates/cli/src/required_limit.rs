//! Limit of a requirement in figures: a red line, in the unit in which the limit was written.

use flexsc_core::formats::reader_units::{ReaderUnit, ReaderUnits};
use flexsc_core::scenario::{AssessedRequirement, ContrastRequirement};
use flexsc_figure::{FigureAxis, Layer, LayerShape, Point, colour};

/// Limit of a requirement.
pub struct RequiredLimit {
    /// Largest allowed value, or the least one.
    pub limit: f64,
    /// True of a least value.
    pub is_least: bool,
    /// The limit as it was written, with its unit.
    pub text: String,
    /// Unit of the limit.
    pub unit: ReaderUnit,
}

impl RequiredLimit {
    /// Returns the limit of a requirement.
    pub fn new(requirement: &AssessedRequirement) -> Self {
        let written = requirement.written_limit.as_deref();
        let unit = ReaderUnits::Engineering.as_written(written, requirement.limit, requirement.unit);
        let text = unit.limit(requirement.limit, written);
        Self { limit: requirement.limit, is_least: false, text, unit }
    }

    /// Returns the least contrast of an image that a requirement accepts.
    pub fn from_contrast(requirement: &ContrastRequirement) -> Self {
        let unit = ReaderUnits::Engineering.fitting(requirement.least, "");
        Self { limit: requirement.least, is_least: true, text: unit.limit(requirement.least, None), unit }
    }

    /// Returns true if a value is within the limit.
    pub fn is_met(&self, value: f64) -> bool {
        if self.is_least { value >= self.limit } else { value <= self.limit }
    }

    /// Returns the words before the limit.
    pub fn bound(&self) -> &'static str {
        if self.is_least { "at least" } else { "at most" }
    }

    /// Returns the limit in words.
    pub fn words(&self) -> String {
        format!("{} {}", self.bound(), self.text)
    }

    /// Returns an axis with its numbers in the unit of a limit, if there is one.
    pub fn shown(required: Option<&Self>, axis: FigureAxis) -> FigureAxis {
        match required {
            Some(own) if !own.unit.name.is_empty() => axis.in_unit(own.unit.clone()),
            _ => axis,
        }
    }

    /// Returns the line of the limit across a panel, with its value in the legend.
    pub fn across(&self, x: &FigureAxis) -> Layer {
        self.line(vec![(x.range.start, self.limit), (x.range.end, self.limit)])
    }

    /// Returns a line of the limit.
    pub fn line(&self, points: Vec<Point>) -> Layer {
        Layer::new(&self.words(), colour::RED, LayerShape::Line(1.6), points)
    }
}
