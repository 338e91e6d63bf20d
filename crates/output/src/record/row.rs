//! Rows: the fields of a topic listed once, for protobuf schemas, protobuf bytes, columns and CSV.

use crate::label::Labels;

/// A topic of the log.
#[derive(Copy, Clone, Debug)]
pub struct Topic {
    /// Name with its leading slash.
    pub name: &'static str,
    /// Full name of the message: `flexsc.v1.Command`.
    pub message: &'static str,
    /// What it tells.
    pub doc: &'static [&'static str],
    /// Its fields, in the order of their protobuf numbers.
    pub fields: &'static [Field],
}

/// A field of a row.
#[derive(Copy, Clone, Debug)]
pub struct Field {
    /// Name with its unit: `angle_rad`.
    pub name: &'static str,
    /// What it tells.
    pub doc: &'static [&'static str],
    /// What it holds.
    pub kind: Kind,
}

/// What a field holds.
#[derive(Copy, Clone, Debug)]
pub enum Kind {
    /// A double; NaN where there is no value.
    Number,
    /// A count.
    Count,
    /// A value of an enumeration.
    Label(&'static Labels),
    /// A text.
    Text,
    /// Yes or no.
    Flag,
    /// A date or a span of time, as this message of the package `google.protobuf`.
    Time(&'static str),
    /// A row within the row.
    Row(&'static Message),
    /// Any number of rows within the row.
    Rows(&'static Message),
}

/// What a row is as a message.
#[derive(Debug)]
pub struct Message {
    /// Full name: `flexsc.v1.ModeMotion`.
    pub name: &'static str,
    /// What it tells, line by line.
    pub doc: &'static [&'static str],
    /// Its fields.
    pub fields: &'static [Field],
}

/// Something with fields.
pub trait Row {
    /// What it tells, line by line.
    const DOC: &'static [&'static str];
    /// The fields.
    const FIELDS: &'static [Field];

    /// Puts the fields into a sink, in their order.
    fn put<S: Sink>(&self, sink: &mut S);
}

/// A row that is a message of its own.
pub trait TopicRow: Row {
    /// Its topic.
    const TOPIC: Topic;
}

/// Takes the fields of a row, one after the other.
pub trait Sink {
    /// Takes a double.
    fn number(&mut self, value: f64);
    /// Takes a count.
    fn count(&mut self, value: u64);
    /// Takes the index of an enumeration's value.
    fn label(&mut self, index: usize, labels: &'static Labels);
    /// Takes a text.
    fn text(&mut self, text: &str);
    /// Takes a yes or a no.
    fn flag(&mut self, value: bool);
    /// Takes a date (ns since 1970, or since the start of a run without a date) or a span of time (ns).
    fn time(&mut self, nanoseconds: u64);
    /// Takes a row within the row.
    fn row<R: Row>(&mut self, row: &R);
    /// Takes rows within the row.
    fn rows<R: Row>(&mut self, rows: &[R]);
}

/// A type that can be a field.
pub trait Cell {
    /// What the field holds.
    const KIND: Kind;

    /// Puts the field into a sink.
    fn put<S: Sink>(&self, sink: &mut S);
}

impl Cell for f64 {
    const KIND: Kind = Kind::Number;
    #[inline]
    fn put<S: Sink>(&self, sink: &mut S) {
        sink.number(*self);
    }
}

impl Cell for u64 {
    const KIND: Kind = Kind::Count;
    #[inline]
    fn put<S: Sink>(&self, sink: &mut S) {
        sink.count(*self);
    }
}

impl Cell for String {
    const KIND: Kind = Kind::Text;
    fn put<S: Sink>(&self, sink: &mut S) {
        sink.text(self);
    }
}

impl Cell for bool {
    const KIND: Kind = Kind::Flag;
    fn put<S: Sink>(&self, sink: &mut S) {
        sink.flag(*self);
    }
}

/// A date on the time base of a log: nanoseconds since 1970 UTC, or since the start of a run whose scenario has no date.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Stamp(pub u64);

impl Cell for Stamp {
    const KIND: Kind = Kind::Time("Timestamp");
    fn put<S: Sink>(&self, sink: &mut S) {
        sink.time(self.0);
    }
}

/// A span of time in nanoseconds; 0 for no end.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Lifetime(pub u64);

impl Cell for Lifetime {
    const KIND: Kind = Kind::Time("Duration");
    fn put<S: Sink>(&self, sink: &mut S) {
        sink.time(self.0);
    }
}

/// A field's name: one that is a word of the language has a prefix in it.
pub const fn plain(name: &'static str) -> &'static str {
    match name.as_bytes() {
        [b'r', b'#', ..] => name.split_at(2).1,
        _ => name,
    }
}

/// Declares row types of a package, and topics for those that have a name.
macro_rules! rows {
    (package $package:literal; $($(#[doc = $doc:literal])* $name:ident $(= $topic:literal)? {
        $($(#[doc = $field_doc:literal])* $field:ident: $of:ty),+ $(,)?
    })+) => {
        $(
            $(#[doc = $doc])*
            #[derive(Clone, Debug, PartialEq)]
            pub struct $name {
                $($(#[doc = $field_doc])* pub $field: $of),+
            }

            impl $crate::record::row::Row for $name {
                const DOC: &'static [&'static str] = &[$($doc),*];
                const FIELDS: &'static [$crate::record::row::Field] = &[
                    $($crate::record::row::Field {
                        name: $crate::record::row::plain(stringify!($field)),
                        doc: &[$($field_doc),*],
                        kind: <$of as $crate::record::row::Cell>::KIND,
                    }),+
                ];

                #[inline]
                fn put<S: $crate::record::row::Sink>(&self, sink: &mut S) {
                    $($crate::record::row::Cell::put(&self.$field, sink);)+
                }
            }

            impl $name {
                const MESSAGE: $crate::record::row::Message = $crate::record::row::Message {
                    name: concat!($package, ".", stringify!($name)),
                    doc: <$name as $crate::record::row::Row>::DOC,
                    fields: <$name as $crate::record::row::Row>::FIELDS,
                };
            }

            impl $crate::record::row::Cell for $name {
                const KIND: $crate::record::row::Kind = $crate::record::row::Kind::Row(&<$name>::MESSAGE);
                fn put<S: $crate::record::row::Sink>(&self, sink: &mut S) {
                    sink.row(self);
                }
            }

            impl $crate::record::row::Cell for Vec<$name> {
                const KIND: $crate::record::row::Kind = $crate::record::row::Kind::Rows(&<$name>::MESSAGE);
                fn put<S: $crate::record::row::Sink>(&self, sink: &mut S) {
                    sink.rows(self);
                }
            }

            $(impl $crate::record::row::TopicRow for $name {
                const TOPIC: $crate::record::row::Topic = $crate::record::row::Topic {
                    name: $topic,
                    message: concat!($package, ".", stringify!($name)),
                    doc: <$name as $crate::record::row::Row>::DOC,
                    fields: <$name as $crate::record::row::Row>::FIELDS,
                };
            })?
        )+

        /// The topics declared here, in their order.
        pub const DECLARED: &[$crate::record::row::Topic] = &[
            $($({
                const _: &str = $topic;
                <$name as $crate::record::row::TopicRow>::TOPIC
            },)?)+
        ];
    };
}

/// Lets a labelled enumeration be a field.
macro_rules! label_cells {
    ($($of:ty),+ $(,)?) => {
        $(impl $crate::record::row::Cell for $of {
            const KIND: $crate::record::row::Kind = $crate::record::row::Kind::Label(&<$of>::LABELS);
            #[inline]
            fn put<S: $crate::record::row::Sink>(&self, sink: &mut S) {
                sink.label(*self as usize, &<$of>::LABELS);
            }
        })+
    };
}

pub(crate) use {label_cells, rows};
