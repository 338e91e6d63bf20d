//! Enumerations that are logged: each value with a short label for people and a name for protobuf.

/// An enumeration as a log column.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Labels {
    /// Name of the enumeration.
    pub name: &'static str,
    /// What each value means.
    pub docs: &'static [&'static str],
    /// The label of each value.
    pub values: &'static [&'static str],
}

impl Labels {
    /// The name of a value as an identifier: `W+` becomes `W_PLUS`.
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
            /// The enumeration as a log column.
            pub const LABELS: $crate::label::Labels = $crate::label::Labels {
                name: stringify!($name),
                docs: &[$($value_doc),+],
                values: &[$($label),+],
            };

            /// The label of the value.
            pub const fn label(self) -> &'static str {
                Self::LABELS.values[self as usize]
            }
        }
    };
}

pub(crate) use labels;
