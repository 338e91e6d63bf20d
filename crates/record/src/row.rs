//! Rows: the fields of a topic listed once, for protobuf schemas, protobuf bytes, columns and CSV.

use super::Detail;
use crate::enum_label::LoggedEnum;

/// Topic of the log.
#[derive(Copy, Clone, Debug)]
pub struct Topic {
    /// Name with its leading slash.
    pub name: &'static str,
    /// Full name of the message: `flexsc.v1.Command`.
    pub message: &'static str,
    /// Description of the topic.
    pub doc: &'static [&'static str],
    /// Fields, in the order of their protobuf numbers.
    pub fields: &'static [RowField],
    /// Instants at which the topic has rows.
    pub logged: Logging,
    /// Panels of viewer layouts that depend on nothing but the rows.
    pub panels: &'static [TopicPanel],
}

/// Panel of viewer layouts that shows a field of a topic.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct TopicPanel {
    /// Name of the panel, unique among all panels.
    pub name: &'static str,
    /// Title with the unit.
    pub title: &'static str,
    /// Label of the line; in nested rows, the number of the row follows.
    pub label: &'static str,
    /// Name of the field.
    pub field: &'static str,
}

/// Instants at which a topic has rows, from which the least detail of a log that has it follows.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Logging {
    /// Rows at events, in every log.
    Event,
    /// Rows at samples or cycles, in full logs.
    Sample,
    /// One row in each period of a full log.
    Period,
    /// Rows for three-dimensional viewers.
    Scene,
}

impl Logging {
    /// Returns the least detail of a log that has the rows.
    pub const fn detail(self) -> Detail {
        match self {
            Self::Event => Detail::Events,
            Self::Sample | Self::Period => Detail::Full,
            Self::Scene => Detail::Scene,
        }
    }
}

/// Field of a row.
#[derive(Copy, Clone, Debug)]
pub struct RowField {
    /// Name with its unit: `angle_rad`.
    pub name: &'static str,
    /// Description of the field.
    pub doc: &'static [&'static str],
    /// Kind of value that the field holds.
    pub kind: FieldKind,
}

/// Kind of a field's contents.
#[derive(Copy, Clone, Debug)]
pub enum FieldKind {
    /// Floating-point number; NaN if there is no value.
    Number,
    /// Integer count.
    Count,
    /// Value of an enumeration.
    Label(&'static LoggedEnum),
    /// Text value.
    Text,
    /// Boolean value.
    Flag,
    /// Date or time span, as this message of the package `google.protobuf`.
    Time(&'static str),
    /// Nested row.
    Row(&'static RowMessage),
    /// Any number of nested rows.
    Rows(&'static RowMessage),
}

/// Protobuf message of a row.
#[derive(Debug)]
pub struct RowMessage {
    /// Full name: `flexsc.v1.ModeMotion`.
    pub name: &'static str,
    /// Description, line by line.
    pub doc: &'static [&'static str],
    /// Fields of the message.
    pub fields: &'static [RowField],
}

/// Row with a fixed list of fields.
pub trait Row {
    /// Description, line by line.
    const DOC: &'static [&'static str];
    /// Fields of the row.
    const FIELDS: &'static [RowField];

    /// Writes the fields into a sink, in their order.
    fn write_to<S: Sink>(&self, sink: &mut S);

    /// Reads rows from a source of their fields, whose names begin with `before`; `None` if a field is missing.
    fn read_rows<S: Source>(source: &S, before: &str) -> Option<Vec<Self>>
    where
        Self: Sized;
}

/// Row that is a message of a topic.
pub trait TopicRow: Row {
    /// Topic of the row.
    const TOPIC: Topic;
}

/// Destination of the fields of a row, one after the other.
pub trait Sink {
    /// Writes a double.
    fn number(&mut self, value: f64);
    /// Writes a count.
    fn count(&mut self, value: u64);
    /// Writes the index of an enumeration's value.
    fn label(&mut self, index: usize, labels: &'static LoggedEnum);
    /// Writes a text.
    fn text(&mut self, text: &str);
    /// Writes a boolean.
    fn flag(&mut self, value: bool);
    /// Writes a date (ns since 1970, or since the start of a run without a date) or a time span (ns).
    fn time(&mut self, nanoseconds: u64);
    /// Writes a nested row.
    fn row<R: Row>(&mut self, row: &R);
    /// Writes nested rows.
    fn rows<R: Row>(&mut self, rows: &[R]);
}

/// Source of the fields of rows: all values of a field together.
pub trait Source {
    /// Reads doubles.
    fn read_numbers(&self, name: &str) -> Option<Vec<f64>>;
    /// Reads counts, and flags as 0 or 1.
    fn read_counts(&self, name: &str) -> Option<Vec<u64>>;
    /// Reads indices of an enumeration's values.
    fn read_labels(&self, name: &str, labels: &LoggedEnum) -> Option<Vec<usize>>;
    /// Reads texts.
    fn read_texts(&self, name: &str) -> Option<Vec<String>>;
    /// Reads dates or time spans (ns), to the precision of a double in seconds.
    fn read_times(&self, name: &str) -> Option<Vec<u64>>;
    /// Returns the number of nested rows in each row, and the source of their fields.
    fn nested_rows(&self, name: &str) -> Option<(&[u32], &Self)>;
}

/// Type that can be a field.
pub trait FieldType {
    /// Kind of the field's contents.
    const KIND: FieldKind;

    /// Writes the field into a sink.
    fn write_to<S: Sink>(&self, sink: &mut S);

    /// Reads the values of the field in all rows; `None` if it is missing or of another kind.
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>>
    where
        Self: Sized;
}

impl FieldType for f64 {
    const KIND: FieldKind = FieldKind::Number;
    #[inline]
    fn write_to<S: Sink>(&self, sink: &mut S) {
        sink.number(*self);
    }
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>> {
        source.read_numbers(name)
    }
}

impl FieldType for u64 {
    const KIND: FieldKind = FieldKind::Count;
    #[inline]
    fn write_to<S: Sink>(&self, sink: &mut S) {
        sink.count(*self);
    }
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>> {
        source.read_counts(name)
    }
}

impl FieldType for String {
    const KIND: FieldKind = FieldKind::Text;
    fn write_to<S: Sink>(&self, sink: &mut S) {
        sink.text(self);
    }
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>> {
        source.read_texts(name)
    }
}

impl FieldType for bool {
    const KIND: FieldKind = FieldKind::Flag;
    fn write_to<S: Sink>(&self, sink: &mut S) {
        sink.flag(*self);
    }
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>> {
        Some(source.read_counts(name)?.into_iter().map(|flag| flag != 0).collect())
    }
}

/// Date on the time base of a log: nanoseconds since 1970 UTC, or since the start of a run whose scenario has no date.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct LogDate(pub u64);

impl FieldType for LogDate {
    const KIND: FieldKind = FieldKind::Time("Timestamp");
    fn write_to<S: Sink>(&self, sink: &mut S) {
        sink.time(self.0);
    }
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>> {
        Some(source.read_times(name)?.into_iter().map(Self).collect())
    }
}

/// Time span in nanoseconds; 0 if unlimited.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct LogSpan(pub u64);

impl FieldType for LogSpan {
    const KIND: FieldKind = FieldKind::Time("Duration");
    fn write_to<S: Sink>(&self, sink: &mut S) {
        sink.time(self.0);
    }
    fn read_values<S: Source>(source: &S, name: &str) -> Option<Vec<Self>> {
        Some(source.read_times(name)?.into_iter().map(Self).collect())
    }
}

/// Returns a field's name without the prefix `r#` of Rust keywords.
pub const fn field_name(name: &'static str) -> &'static str {
    match name.as_bytes() {
        [b'r', b'#', ..] => name.split_at(2).1,
        _ => name,
    }
}

/// Declares row types of a package, and topics for the types with a topic name. `at` gives the instants of the rows, by
/// default events, and `panels` the panels of viewer layouts, each with name, title, label and field.
macro_rules! rows {
    (package $package:literal; $($(#[doc = $doc:literal])* $name:ident
        $(= $topic:literal $(at $logging:ident)?
            $(panels [$($panel:literal: $title:literal, $label:literal $shown:ident);+ $(;)?])?)? {
        $($(#[doc = $field_doc:literal])* $field:ident: $of:ty),+ $(,)?
    })+) => {
        $(
            $(#[doc = $doc])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $name {
                $($(#[doc = $field_doc])* pub $field: $of),+
            }

            impl $crate::row::Row for $name {
                const DOC: &'static [&'static str] = &[$($doc),*];
                const FIELDS: &'static [$crate::row::RowField] = &[
                    $($crate::row::RowField {
                        name: $crate::row::field_name(stringify!($field)),
                        doc: &[$($field_doc),*],
                        kind: <$of as $crate::row::FieldType>::KIND,
                    }),+
                ];

                #[inline]
                fn write_to<S: $crate::row::Sink>(&self, sink: &mut S) {
                    $($crate::row::FieldType::write_to(&self.$field, sink);)+
                }

                fn read_rows<S: $crate::row::Source>(source: &S, before: &str) -> Option<Vec<Self>> {
                    $(let name = format!("{before}{}", $crate::row::field_name(stringify!($field)));
                    let mut $field = <$of as $crate::row::FieldType>::read_values(source, &name)?.into_iter();)+
                    let next = || Some(Self { $($field: $field.next()?),+ });
                    Some(std::iter::from_fn(next).collect())
                }
            }

            impl $name {
                const MESSAGE: $crate::row::RowMessage = $crate::row::RowMessage {
                    name: concat!($package, ".", stringify!($name)),
                    doc: <$name as $crate::row::Row>::DOC,
                    fields: <$name as $crate::row::Row>::FIELDS,
                };
            }

            impl $crate::row::FieldType for $name {
                const KIND: $crate::row::FieldKind = $crate::row::FieldKind::Row(&<$name>::MESSAGE);
                fn write_to<S: $crate::row::Sink>(&self, sink: &mut S) {
                    sink.row(self);
                }
                fn read_values<S: $crate::row::Source>(source: &S, name: &str) -> Option<Vec<Self>> {
                    <$name as $crate::row::Row>::read_rows(source, &format!("{name}."))
                }
            }

            impl $crate::row::FieldType for Vec<$name> {
                const KIND: $crate::row::FieldKind = $crate::row::FieldKind::Rows(&<$name>::MESSAGE);
                fn write_to<S: $crate::row::Sink>(&self, sink: &mut S) {
                    sink.rows(self);
                }
                fn read_values<S: $crate::row::Source>(source: &S, name: &str) -> Option<Vec<Self>> {
                    let (counts, inner) = source.nested_rows(name)?;
                    let mut rows = <$name as $crate::row::Row>::read_rows(inner, "")?.into_iter();
                    Some(counts.iter().map(|count| rows.by_ref().take(*count as usize).collect()).collect())
                }
            }

            $(impl $crate::row::TopicRow for $name {
                const TOPIC: $crate::row::Topic = $crate::row::Topic {
                    name: $topic,
                    message: concat!($package, ".", stringify!($name)),
                    doc: <$name as $crate::row::Row>::DOC,
                    fields: <$name as $crate::row::Row>::FIELDS,
                    logged: $crate::row::logging!($($logging)?),
                    panels: &[$($($crate::row::TopicPanel {
                        name: $panel,
                        title: $title,
                        label: $label,
                        field: stringify!($shown),
                    }),+)?],
                };
            })?
        )+

        /// Topics declared in this macro call, in their order.
        pub(crate) const DECLARED: &[$crate::row::Topic] = &[
            $($({
                const _: &str = $topic;
                <$name as $crate::row::TopicRow>::TOPIC
            },)?)+
        ];
    };
}

/// Returns the named instants of a topic's rows, by default events.
macro_rules! logging {
    () => {
        $crate::row::Logging::Event
    };
    ($logging:ident) => {
        $crate::row::Logging::$logging
    };
}

/// Implements `FieldType` for labelled enumerations.
macro_rules! label_cells {
    ($($of:ty),+ $(,)?) => {
        $(impl $crate::row::FieldType for $of {
            const KIND: $crate::row::FieldKind = $crate::row::FieldKind::Label(&<$of>::LABELS);
            #[inline]
            fn write_to<S: $crate::row::Sink>(&self, sink: &mut S) {
                sink.label(*self as usize, &<$of>::LABELS);
            }
            fn read_values<S: $crate::row::Source>(source: &S, name: &str) -> Option<Vec<Self>> {
                let indices = source.read_labels(name, &<$of>::LABELS)?;
                indices.into_iter().map(|index| <$of>::VALUES.get(index).copied()).collect()
            }
        })+
    };
}

pub(crate) use {label_cells, logging, rows};
