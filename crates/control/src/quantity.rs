//! Quantity that a program outside a run can ask for: its name, unit, shape and meaning, declared once for all readers.

use std::ops::Deref;

use flexsc_record::description::field_text;

/// Shape of the values of a quantity.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum QuantityShape {
    /// Number.
    Scalar,
    /// Vector with the components x, y and z.
    Vector,
    /// Quaternion w, x, y, z.
    Quaternion,
    /// List of this many numbers.
    List(usize),
}

impl QuantityShape {
    /// Returns the shape of a value about each axis of a body: a number or a vector.
    pub const fn about_axes(axes: usize) -> Self {
        if axes > 1 { Self::Vector } else { Self::Scalar }
    }

    /// Returns the number of values of a list; `None` for a scalar.
    pub const fn count(self) -> Option<usize> {
        match self {
            Self::Scalar => None,
            Self::Vector => Some(3),
            Self::Quaternion => Some(4),
            Self::List(count) => Some(count),
        }
    }

    /// Returns the names of the components; none of a scalar.
    pub fn components(self) -> Vec<String> {
        let named = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        match self {
            Self::Scalar => Vec::new(),
            Self::Vector => named(&["x", "y", "z"]),
            Self::Quaternion => named(&["w", "x", "y", "z"]),
            Self::List(count) => (1..=count).map(|number| number.to_string()).collect(),
        }
    }
}

/// Meaning of a quantity.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// Noun phrase.
    Text(&'static str),
    /// Paths of fields of the log with the meaning, such as `rates/axes/rate_rad_s`: one for all components, or one for each.
    Logged(&'static [&'static str]),
}

/// Quantity that a program outside a run can ask for.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct QuantityDescription {
    /// Name within its group, such as `rate`.
    pub name: &'static str,
    /// Unit; empty for a dimensionless quantity.
    pub unit: &'static str,
    /// Shape of the values.
    pub shape: QuantityShape,
    /// Meaning.
    pub meaning: Meaning,
}

impl QuantityDescription {
    /// Returns the number of values.
    pub fn width(&self) -> usize {
        self.shape.count().unwrap_or(1)
    }

    /// Returns the meaning of a component.
    pub fn text(&self, component: usize) -> String {
        match self.meaning {
            Meaning::Text(text) => text.to_owned(),
            Meaning::Logged(paths) => {
                let path = paths.get(component).or(paths.first());
                path.and_then(|path| field_text(path)).unwrap_or_else(|| self.name.to_owned())
            }
        }
    }
}

/// Returns the number of values of all fields together.
pub fn total_width<Q: Deref<Target = QuantityDescription>>(fields: &[Q]) -> usize {
    fields.iter().map(|field| field.width()).sum()
}
