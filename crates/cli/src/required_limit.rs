//! Limit of a requirement in figures: a red line, in the unit in which the limit was written.

use flexsc_core::formats::reader_units::{ReaderUnit, ReaderUnits};
use flexsc_core::scenario::AssessedRequirement;
use flexsc_figure::{FigureAxis, Layer, LayerShape, Point, colour};

/// Limit of a requirement.
pub struct RequiredLimit {
    /// Largest allowed value.
    pub limit: f64,
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
        Self { limit: requirement.limit, text, unit }
    }

    /// Returns the limit in words.
    pub fn words(&self) -> String {
        format!("at most {}", self.text)
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
