//! Logged enumerations: each value with a short label for people and an identifier for protobuf.

/// Labels of an enumeration, for a log column.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LoggedEnum {
    /// Name of the enumeration.
    pub name: &'static str,
    /// Description of each value.
    pub docs: &'static [&'static str],
    /// Label of each value.
    pub values: &'static [&'static str],
}

impl LoggedEnum {
    /// Returns the label as an identifier: `W+` becomes `W_PLUS`.
    pub fn identifier(label: &str) -> String {
        label.replace('+', "_PLUS").replace('-', "_MINUS").replace(' ', "_").to_uppercase()
    }
}

/// Declares an enumeration with its labels.
macro_rules! labels {
    ($(#[$doc:meta])* $name:ident { $(#[doc = $value_doc:literal] $value:ident = $label:literal),+ $(,)? }) => {
        $(#[$doc])*
        #[derive(Copy, Clone, Debug, PartialEq, Eq)]
        pub enum $name {
            $(#[doc = $value_doc] $value),+
        }

        impl $name {
            /// Labels of the enumeration, for a log column.
            pub const LABELS: $crate::enum_label::LoggedEnum = $crate::enum_label::LoggedEnum {
                name: stringify!($name),
                docs: &[$($value_doc),+],
                values: &[$($label),+],
            };

            /// Values of the enumeration, in the order of their labels.
            pub const VALUES: &[Self] = &[$(Self::$value),+];

            /// Returns the label of the value.
            pub const fn label(self) -> &'static str {
                Self::LABELS.values[self as usize]
            }
        }
    };
}

pub(crate) use labels;
