//! Matrices from NumPy archives: dense arrays by name, and archives of `scipy.sparse.save_npz`.

use std::fs::File;
use std::io::{BufReader, Cursor, Read};
use std::path::Path;

use nalgebra::DMatrix;
use npyz::{NpyFile, Order};
use zip::ZipArchive;

use super::LARGEST;
use crate::text_file::open;

/// Largest length of an array's header (bytes): those of numeric arrays have at most 128.
const LONGEST_HEADER: usize = 1024;
/// Largest number of opening brackets in the header of a numeric array: a shape within the dictionary has 2.
const MOST_BRACKETS: usize = 8;
/// Largest length of the name of a sparse format (bytes): `csr` in UTF-32 has 12.
const LONGEST_FORMAT: usize = 64;

/// Reads an array of a file: the named one, or else the sparse matrix or the only array in it.
pub fn read(path: &Path, array: Option<&str>) -> Result<DMatrix<f64>, String> {
    let archive = ZipArchive::new(BufReader::new(open(path)?));
    let mut archive = Archive(archive.map_err(|error| format!("is not an npz archive: {error}"))?);
    let names = archive.names();
    match (array, names.as_slice()) {
        (Some(name), _) => archive.dense(name),
        (None, names) if names.iter().any(|name| name == "format") => archive.sparse(),
        (None, [only]) => archive.dense(only),
        (None, _) => {
            let names = names.join("`, `");
            Err(format!("must be followed by a colon and the name of an array, one of `{names}`"))
        }
    }
}

struct Archive(ZipArchive<BufReader<File>>);

/// Array: its shape, and its numbers in the order in which they are stored.
struct Array {
    shape: Vec<usize>,
    numbers: Vec<f64>,
    order: Order,
}

impl Archive {
    fn names(&self) -> Vec<String> {
        let array = |name: &str| npyz::npz::array_name_from_file_name(name).map(str::to_owned);
        let mut names: Vec<_> = self.0.file_names().flatten().filter_map(|name| array(&name)).collect();
        names.sort();
        names
    }

    fn open(&mut self, name: &str) -> Result<NpyFile<impl Read + '_>, String> {
        let names = self.names();
        let entry =
            self.0.by_name(&npyz::npz::file_name_from_array_name(name)).map_err(|error| match error {
                zip::result::ZipError::FileNotFound => {
                    format!("has no array `{name}`, only `{}`", names.join("`, `"))
                }
                error => format!("array `{name}`: {error}"),
            })?;
        let wrong = |error: &dyn std::fmt::Display| format!("array `{name}`: {error}");
        let (header, entry) = header(entry).map_err(|why| wrong(&why))?;
        NpyFile::new(Cursor::new(header).chain(entry)).map_err(|error| wrong(&error))
    }

    fn array(&mut self, name: &str) -> Result<Array, String> {
        let file = self.open(name)?;
        let dimension = |size: &u64| usize::try_from(*size).unwrap_or(usize::MAX);
        let shape: Vec<usize> = file.shape().iter().map(dimension).collect();
        // The number of elements is limited for any shape, so that nothing larger is unpacked.
        let size = shape.iter().try_fold(1_usize, |product, n| product.checked_mul(*n));
        if size.is_none_or(|size| size > LARGEST * LARGEST) {
            return Err(format!("array `{name}` must have at most {LARGEST} rows, got shape {shape:?}"));
        }
        let (order, kind) = (file.order(), file.dtype().descr());
        let numbers =
            numbers(file).ok_or_else(|| format!("array `{name}` must hold real numbers, got {kind}"))?;
        Ok(Array { shape, numbers: numbers.map_err(|error| format!("array `{name}`: {error}"))?, order })
    }

    fn dense(&mut self, name: &str) -> Result<DMatrix<f64>, String> {
        let Array { shape, numbers, order } = self.array(name)?;
        let [rows, columns] = shape[..] else {
            return Err(format!("array `{name}` must have two dimensions, got shape {shape:?}"));
        };
        Ok(match order {
            Order::C => DMatrix::from_row_slice(rows, columns, &numbers),
            Order::Fortran => DMatrix::from_column_slice(rows, columns, &numbers),
        })
    }

    fn sparse(&mut self) -> Result<DMatrix<f64>, String> {
        let format = self.open("format")?;
        let fits = |length: usize| length <= LONGEST_FORMAT;
        if !(format.shape().iter().product::<u64>() <= 1 && format.dtype().num_bytes().is_some_and(fits)) {
            let (kind, shape) = (format.dtype().descr(), format.shape());
            return Err(format!("array `format` must be one short text, got {kind} of shape {shape:?}"));
        }
        let format = format.into_vec::<Vec<u8>>().unwrap_or_default();
        let format =
            format.first().map(|bytes| String::from_utf8_lossy(bytes).into_owned()).unwrap_or_default();
        let shape = self.array("shape")?.numbers;
        let &[rows, columns] = shape.as_slice() else {
            return Err(format!("must be a matrix of two dimensions, got shape {shape:?}"));
        };
        let (rows, columns) = (rows as usize, columns as usize);
        if rows > LARGEST || columns > LARGEST {
            return Err(format!("must have at most {LARGEST} rows, got {rows} x {columns}"));
        }
        let data = self.array("data")?.numbers;
        let mut elements: Vec<(f64, f64, f64)> = Vec::with_capacity(data.len());
        match format.as_str() {
            "csr" | "csc" => {
                let (indices, starts) = (self.array("indices")?.numbers, self.array("indptr")?.numbers);
                let most = if format == "csr" { rows } else { columns };
                // Rising numbers: between others, such as NaN, the same elements could be taken again and again.
                if starts.len() != most + 1 || !starts.is_sorted_by(|from, to| from <= to) {
                    return Err(format!("array `indptr` must hold {} increasing indices", most + 1));
                }
                for (major, ends) in starts.windows(2).enumerate() {
                    for k in (ends[0] as usize)..(ends[1] as usize).min(indices.len()).min(data.len()) {
                        let (major, minor) = (major as f64, indices[k]);
                        let (i, j) = if format == "csr" { (major, minor) } else { (minor, major) };
                        elements.push((i, j, data[k]));
                    }
                }
            }
            "coo" => {
                let (row, column) = (self.array("row")?.numbers, self.array("col")?.numbers);
                elements.extend(row.iter().zip(&column).zip(&data).map(|((i, j), value)| (*i, *j, *value)));
            }
            "dia" => {
                // Element j of a diagonal is in column j.
                let offsets = self.array("offsets")?.numbers;
                let length = data.len() / offsets.len().max(1);
                for (offset, diagonal) in offsets.iter().zip(data.chunks_exact(length.max(1))) {
                    let within = (0..columns).map(|j| j as f64).zip(diagonal);
                    let within = within.filter(|(j, _)| (0.0..rows as f64).contains(&(j - offset)));
                    elements.extend(within.map(|(j, value)| (j - offset, j, *value)));
                }
            }
            _ => {
                return Err(format!(
                    "must be a sparse matrix of format csr, csc, coo or dia, got `{format}`"
                ));
            }
        }
        let mut matrix = DMatrix::zeros(rows, columns);
        for (i, j, value) in elements {
            if !((0.0..rows as f64).contains(&i) && (0.0..columns as f64).contains(&j)) {
                return Err(format!("has an element at {i}, {j}, outside of {rows} x {columns}"));
            }
            matrix[(i as usize, j as usize)] += value;
        }
        Ok(matrix)
    }
}

/// Returns the first bytes of an array, up to the end of its header, and the rest. A header is a Python expression,
/// whose parser takes twice as long with each level of brackets.
fn header<R: Read>(mut entry: R) -> Result<(Vec<u8>, R), String> {
    let reported = |error: std::io::Error| error.to_string();
    let mut first = vec![0; 8];
    entry.read_exact(&mut first).map_err(reported)?;
    // The length has two bytes in the first version, four in the others.
    let mut length = vec![0; if first[6] == 1 { 2 } else { 4 }];
    entry.read_exact(&mut length).map_err(reported)?;
    let bytes = length.iter().rev().fold(0, |all, byte| all << 8 | usize::from(*byte));
    if bytes > LONGEST_HEADER {
        return Err(format!("its header must have at most {LONGEST_HEADER} bytes, got {bytes}"));
    }
    let mut text = vec![0; bytes];
    entry.read_exact(&mut text).map_err(reported)?;
    if text.iter().filter(|byte| b"([{".contains(byte)).count() > MOST_BRACKETS {
        return Err(format!("its header must have at most {MOST_BRACKETS} brackets"));
    }
    Ok(([first, length, text].concat(), entry))
}

/// Returns the numbers of an array of any real type; `None` for another type.
fn numbers<R: Read>(file: NpyFile<R>) -> Option<std::io::Result<Vec<f64>>> {
    macro_rules! first_of {
        ($file:expr, $type:ty $(, $more:ty)*) => {
            match $file.try_data::<$type>() {
                #[allow(clippy::cast_lossless)] // Some of the types would not be lossless.
                Ok(data) => Some(data.map(|number| number.map(|number| number as f64)).collect()),
                Err(_file) => first_of!(_file $(, $more)*),
            }
        };
        ($file:expr) => { None };
    }
    first_of!(file, f64, f32, i64, i32, i16, i8, u64, u32, u16, u8)
}
