//! Container of glTF 2.0: a JSON chunk and a binary chunk in one file.

use serde_json::{Map, Value as Json, json};

/// Kind of the values of an accessor.
#[derive(Copy, Clone, PartialEq, Eq)]
pub enum AccessorKind {
    /// One number.
    Scalar,
    /// Three numbers.
    Vector,
    /// Quaternion, scalar last.
    Rotation,
}

impl AccessorKind {
    fn width(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector => 3,
            Self::Rotation => 4,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Scalar => "SCALAR",
            Self::Vector => "VEC3",
            Self::Rotation => "VEC4",
        }
    }
}

/// Use of a buffer view, as glTF numbers it.
#[derive(Copy, Clone)]
enum BufferTarget {
    Vertices = 34962,
    Indices = 34963,
}

/// Number types of accessors, as glTF numbers them.
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;

/// Binary data of a file, and the accessors to it.
#[derive(Default)]
pub struct BinaryData {
    bytes: Vec<u8>,
    views: Vec<Json>,
    accessors: Vec<Json>,
    /// True if a number is too large for single precision.
    overflows: bool,
}

impl BinaryData {
    /// Returns true if a number is too large for single precision, so that there is no valid file.
    pub fn overflows(&self) -> bool {
        self.overflows
    }

    /// Adds values of vertices; returns the index of their accessor.
    pub fn add_vertices(&mut self, values: &[f32]) -> usize {
        self.add_floats(values, AccessorKind::Vector, Some(BufferTarget::Vertices))
    }

    /// Adds values of an animation; returns the index of their accessor.
    pub fn add_samples(&mut self, values: &[f32], kind: AccessorKind) -> usize {
        self.add_floats(values, kind, None)
    }

    /// Adds indices of triangles; returns the index of their accessor.
    pub fn add_indices(&mut self, indices: &[u32]) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
        self.add_accessor(start, Some(BufferTarget::Indices), UNSIGNED, indices.len(), AccessorKind::Scalar)
    }

    fn add_floats(&mut self, values: &[f32], kind: AccessorKind, target: Option<BufferTarget>) -> usize {
        let start = self.bytes.len();
        // A negative zero would be another byte for an equal value.
        self.bytes.extend(values.iter().flat_map(|value| (value + 0.0).to_le_bytes()));
        self.overflows |= values.iter().any(|value| !value.is_finite());
        let width = kind.width();
        let index = self.add_accessor(start, target, FLOAT, values.len() / width, kind);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f64> {
            let of = |part: usize| values.iter().skip(part).step_by(width).copied().reduce(pick);
            (0..width).map(|part| f64::from(of(part).unwrap_or(0.0) + 0.0)).collect()
        };
        self.accessors[index]["min"] = json!(bound(f32::min));
        self.accessors[index]["max"] = json!(bound(f32::max));
        index
    }

    fn add_accessor(
        &mut self,
        start: usize,
        target: Option<BufferTarget>,
        numbers: u32,
        count: usize,
        kind: AccessorKind,
    ) -> usize {
        let mut view = json!({"buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start});
        if let Some(target) = target {
            view["target"] = json!(target as u32);
        }
        self.views.push(view);
        self.accessors.push(json!({
            "bufferView": self.views.len() - 1, "componentType": numbers, "count": count, "type": kind.name()
        }));
        self.accessors.len() - 1
    }

    /// Returns the file with these members of its document.
    pub fn into_file(self, members: Map<String, Json>) -> Vec<u8> {
        let mut document = members;
        document.insert("accessors".to_owned(), Json::Array(self.accessors));
        document.insert("bufferViews".to_owned(), Json::Array(self.views));
        document.insert("buffers".to_owned(), json!([{"byteLength": self.bytes.len()}]));
        let mut text = Json::Object(document).to_string().into_bytes();
        let mut bytes = self.bytes;
        // Chunks are padded to four bytes: text with blanks, binary data with zeros.
        text.resize(text.len().next_multiple_of(4), b' ');
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        let length = 12 + 8 + text.len() + 8 + bytes.len();
        let mut file = Vec::with_capacity(length);
        file.extend(*b"glTF");
        for word in [2, length as u32, text.len() as u32] {
            file.extend(word.to_le_bytes());
        }
        file.extend(*b"JSON");
        file.extend(text);
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(*b"BIN\0");
        file.extend(bytes);
        file
    }
}
