//! Rows as a Parquet file, written and read: one row group, compressed by zstd.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

use flexsc_record::atomic_file;
use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{ColumnChunkMetaData, KeyValue, RowGroupMetaData};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type, TypePtr};

use super::checksum;
use super::contained::contained;
use super::rows::{ColumnCells, ColumnHeading, ColumnKind, RunRows};

/// Compression level of zstd: higher ones gain nothing for numbers.
const LEVEL: i32 = 3;
/// Number of cells from which the encoding of a column is chosen.
const FIRST: usize = 256;
/// Largest number of rows of a part.
pub const MOST_ROWS: usize = 1 << 24;
/// Nor more bytes.
const MOST_BYTES: u64 = 1 << 30;

fn other(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(error) => match error.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(error) => io::Error::new(io::ErrorKind::InvalidData, error.to_string()),
        },
        error => io::Error::new(io::ErrorKind::InvalidData, error.to_string()),
    }
}

fn field_type(field: &ColumnHeading) -> Result<TypePtr, ParquetError> {
    let leaf = |name: &str, kind| {
        let physical = match kind {
            ColumnKind::Integers => Physical::INT64,
            ColumnKind::Numbers | ColumnKind::Lists => Physical::DOUBLE,
            ColumnKind::Text => Physical::BYTE_ARRAY,
        };
        let leaf = Type::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
        let leaf = match kind {
            ColumnKind::Text => {
                leaf.with_logical_type(Some(LogicalType::String)).with_converted_type(ConvertedType::UTF8)
            }
            _ => leaf,
        };
        Ok::<TypePtr, ParquetError>(Arc::new(leaf.build()?))
    };
    if field.kind != ColumnKind::Lists {
        return leaf(&field.name, field.kind);
    }
    let element = leaf("element", ColumnKind::Lists)?;
    let list =
        Type::group_type_builder("list").with_repetition(Repetition::REPEATED).with_fields(vec![element]);
    let whole = Type::group_type_builder(&field.name)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(Some(LogicalType::List))
        .with_converted_type(ConvertedType::LIST)
        .with_fields(vec![Arc::new(list.build()?)]);
    Ok(Arc::new(whole.build()?))
}

/// Checks that this build reads and writes Parquet files.
///
/// # Errors
/// Never: this build does.
pub fn parquet_is_built_in() -> io::Result<()> {
    Ok(())
}

/// Returns the content of a file with these rows and metadata.
pub fn encode(rows: &RunRows, notes: &[(&str, String)]) -> io::Result<Vec<u8>> {
    let mut bytes = written(rows, notes).map_err(other)?;
    if !checksum::fill(&mut bytes) {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "has no place for its checksum"));
    }
    Ok(bytes)
}

fn written(rows: &RunRows, notes: &[(&str, String)]) -> Result<Vec<u8>, ParquetError> {
    let fields = rows.fields.iter().map(field_type).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("campaign").with_fields(fields).build()?;
    let blank = (checksum::NAME, checksum::BLANK.to_owned());
    let notes = notes.iter().chain([&blank]);
    let notes = notes.map(|(name, text)| KeyValue::new((*name).to_owned(), text.clone())).collect();
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(LEVEL)?))
        .set_created_by(format!("flexsc {}", env!("CARGO_PKG_VERSION")))
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_key_value_metadata(Some(notes));
    for (field, column) in rows.fields.iter().zip(&rows.columns) {
        if !repeats(column) {
            properties =
                properties.set_column_dictionary_enabled(ColumnPath::from(field.name.as_str()), false);
        }
    }
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties.build()))?;
    let mut group = writer.next_row_group()?;
    for column in &rows.columns {
        write_column(&mut group, column)?;
    }
    group.close()?;
    writer.close()?;
    Ok(bytes)
}

/// Returns true if the first numbers repeat so often that a dictionary saves space.
fn repeats(column: &ColumnCells) -> bool {
    let ColumnCells::Numbers(cells) = column else { return true };
    let mut first: Vec<u64> = cells.iter().take(FIRST).map(|cell| cell.to_bits()).collect();
    let count = first.len();
    first.sort_unstable();
    first.dedup();
    2 * first.len() <= count
}

fn write_column<W: io::Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    column: &ColumnCells,
) -> Result<(), ParquetError> {
    let Some(mut writer) = group.next_column()? else { return Ok(()) };
    let is_present = |is_present: bool| i16::from(is_present);
    match column {
        ColumnCells::Integers(cells) => {
            let values: Vec<i64> = cells.iter().flatten().copied().collect();
            let levels: Vec<i16> = cells.iter().map(|cell| is_present(cell.is_some())).collect();
            writer.typed::<Int64Type>().write_batch(&values, Some(&levels), None)?;
        }
        ColumnCells::Numbers(cells) => {
            let values: Vec<f64> = cells.iter().copied().filter(|cell| !cell.is_nan()).collect();
            let levels: Vec<i16> = cells.iter().map(|cell| is_present(!cell.is_nan())).collect();
            writer.typed::<DoubleType>().write_batch(&values, Some(&levels), None)?;
        }
        ColumnCells::Text(cells) => {
            let values: Vec<ByteArray> = cells.iter().flatten().map(|word| word.as_str().into()).collect();
            let levels: Vec<i16> = cells.iter().map(|cell| is_present(cell.is_some())).collect();
            writer.typed::<ByteArrayType>().write_batch(&values, Some(&levels), None)?;
        }
        ColumnCells::Lists(cells) => {
            let (mut values, mut levels, mut again) = (Vec::new(), Vec::new(), Vec::new());
            for cell in cells {
                let Some(list) = cell.as_ref().filter(|list| !list.is_empty()) else {
                    levels.push(is_present(cell.is_some()));
                    again.push(0);
                    continue;
                };
                for (place, number) in list.iter().enumerate() {
                    values.extend((!number.is_nan()).then_some(*number));
                    levels.push(if number.is_nan() { 2 } else { 3 });
                    again.push(i16::from(place > 0));
                }
            }
            writer.typed::<DoubleType>().write_batch(&values, Some(&levels), Some(&again))?;
        }
    }
    writer.close()
}

/// Returns the result of the Parquet library; its errors and panics become I/O errors.
fn parsed<T>(read: impl FnOnce() -> Result<T, ParquetError>) -> io::Result<T> {
    match contained(read) {
        Some(done) => done.map_err(other),
        None => Err(io::Error::new(io::ErrorKind::InvalidData, "no reader makes sense of it")),
    }
}

/// Parquet file that is read.
pub struct ParquetFile(SerializedFileReader<File>);

impl ParquetFile {
    /// Opens a file, and reads its metadata; the checksum is compared unless the file is known to be intact.
    ///
    /// # Errors
    /// [`io::ErrorKind::InvalidData`] of a damaged file; errors of the file system.
    pub fn open(path: &Path, is_whole: bool) -> io::Result<Self> {
        let mut file = atomic_file::open(path)?;
        let length = file.metadata()?.len();
        let damaged = |why: &str| Err(io::Error::new(io::ErrorKind::InvalidData, why));
        if length > MOST_BYTES {
            return damaged("larger than any part");
        }
        if !is_whole {
            let mut bytes = Vec::new();
            let _ = file.read_to_end(&mut bytes)?;
            if !checksum::is_right(&bytes) {
                return damaged("its checksum is wrong");
            }
        }
        let reader = parsed(|| SerializedFileReader::new(file))?;
        // The reader takes the places of columns on trust.
        let within = |column: &ColumnChunkMetaData| {
            let start = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
            let end = start.checked_add(column.compressed_size());
            let first = column.data_page_offset();
            start >= 0
                && first >= start
                && column.compressed_size() >= 0
                && column.num_values() >= 0
                && end.is_some_and(|end| first <= end && end.cast_unsigned() <= length)
        };
        if !reader.metadata().row_groups().iter().flat_map(RowGroupMetaData::columns).all(within) {
            return damaged("a column lies outside of the file");
        }
        Ok(Self(reader))
    }

    /// Returns a value of the metadata.
    pub fn metadata(&self, name: &str) -> Option<String> {
        let notes = self.0.metadata().file_metadata().key_value_metadata()?;
        notes.iter().find(|note| note.key == name)?.value.clone()
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> u64 {
        u64::try_from(self.0.metadata().file_metadata().num_rows()).unwrap_or(0)
    }

    /// Returns the headings of the columns.
    fn fields(&self) -> Vec<ColumnHeading> {
        let schema = self.0.metadata().file_metadata().schema();
        let kind = |field: &Type| {
            if field.is_group() {
                return ColumnKind::Lists;
            }
            match field.get_physical_type() {
                Physical::INT64 => ColumnKind::Integers,
                Physical::DOUBLE => ColumnKind::Numbers,
                _ => ColumnKind::Text,
            }
        };
        let field =
            |column: &TypePtr| ColumnHeading { name: column.name().to_owned(), unit: "", kind: kind(column) };
        schema.get_fields().iter().map(field).collect()
    }

    /// Returns a column; `None` if the file has no such column.
    pub fn column(&self, name: &str) -> io::Result<Option<ColumnCells>> {
        parsed(|| self.read(name))
    }

    fn read(&self, name: &str) -> Result<Option<ColumnCells>, ParquetError> {
        let fields = self.fields();
        // Every field has one leaf.
        let Some(place) = fields.iter().position(|field| field.name == name) else { return Ok(None) };
        let rows = usize::try_from(self.rows()).unwrap_or(usize::MAX);
        if rows > MOST_ROWS {
            return Err(ParquetError::General(format!("has more than {MOST_ROWS} rows")));
        }
        let mut all = ColumnCells::empty(fields[place].kind);
        for group in 0..self.0.num_row_groups() {
            let group = self.0.get_row_group(group)?;
            let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0).min(rows);
            let column = match (group.get_column_reader(place)?, fields[place].kind) {
                (ColumnReader::Int64ColumnReader(reader), ColumnKind::Integers) => {
                    let (values, levels, _) = read_all(reader, rows)?;
                    ColumnCells::Integers(filled(values.into_iter().map(Some), &levels, || None))
                }
                (ColumnReader::DoubleColumnReader(reader), ColumnKind::Numbers) => {
                    let (values, levels, _) = read_all(reader, rows)?;
                    ColumnCells::Numbers(filled(values.into_iter(), &levels, || f64::NAN))
                }
                (ColumnReader::ByteArrayColumnReader(reader), ColumnKind::Text) => {
                    let (values, levels, _) = read_all(reader, rows)?;
                    let words =
                        values.iter().map(|word| Some(String::from_utf8_lossy(word.data()).into_owned()));
                    ColumnCells::Text(filled(words, &levels, || None))
                }
                (ColumnReader::DoubleColumnReader(reader), ColumnKind::Lists) => {
                    let (values, levels, again) = read_all(reader, rows)?;
                    ColumnCells::Lists(lists(&values, &levels, &again))
                }
                _ => return Err(ParquetError::General(format!("`{name}` is not a column of a campaign"))),
            };
            all.append(column);
        }
        Ok(Some(all))
    }
}

/// Non-null values, and the definition and repetition levels of all cells.
type NullableValues<T> = (Vec<T>, Vec<i16>, Vec<i16>);

fn read_all<D: DataType>(
    mut reader: ColumnReaderImpl<D>,
    rows: usize,
) -> Result<NullableValues<D::T>, ParquetError> {
    let (mut values, mut levels, mut again) = (Vec::new(), Vec::new(), Vec::new());
    let mut remaining = rows;
    while remaining > 0 {
        let (read, _, _) =
            reader.read_records(remaining, Some(&mut levels), Some(&mut again), &mut values)?;
        if read == 0 {
            return Err(ParquetError::EOF("has fewer rows than it declares".to_owned()));
        }
        remaining -= read;
    }
    Ok((values, levels, again))
}

fn filled<T>(mut values: impl Iterator<Item = T>, levels: &[i16], nothing: impl Fn() -> T) -> Vec<T> {
    let cell = |level: &i16| if *level == 1 { values.next() } else { None };
    levels.iter().map(cell).map(|cell| cell.unwrap_or_else(&nothing)).collect()
}

fn lists(values: &[f64], levels: &[i16], again: &[i16]) -> Vec<Option<Vec<f64>>> {
    let (mut lists, mut values): (Vec<Option<Vec<f64>>>, _) = (Vec::new(), values.iter());
    for (level, again) in levels.iter().zip(again) {
        if *again == 0 {
            lists.push((*level > 0).then(Vec::new));
        }
        if *level > 1
            && let Some(Some(list)) = lists.last_mut()
        {
            let number = if *level == 3 { values.next() } else { None };
            list.push(number.copied().unwrap_or(f64::NAN));
        }
    }
    lists
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_as_they_were() {
        let field = |name: &str, kind| ColumnHeading { name: name.to_owned(), unit: "", kind };
        let fields = [
            field("run", ColumnKind::Integers),
            field("x", ColumnKind::Numbers),
            field("word", ColumnKind::Text),
            field("list", ColumnKind::Lists),
            field("nothing", ColumnKind::Text),
        ];
        let columns = vec![
            ColumnCells::Integers(vec![Some(1), None, Some(i64::MIN)]),
            ColumnCells::Numbers(vec![0.1, f64::INFINITY, -1e-300]),
            ColumnCells::Text(vec![None, Some("é".to_owned()), Some(String::new())]),
            ColumnCells::Lists(vec![None, Some(vec![]), Some(vec![1.0, 2.5])]),
            ColumnCells::Text(vec![None; 3]),
        ];
        let rows = RunRows { fields: Arc::new(fields), columns };
        let file = tempfile(&encode(&rows, &[("a", "b".to_owned())]).expect("encoded"));
        let reading = ParquetFile::open(&file, false).expect("a file");
        assert_eq!((reading.rows(), reading.metadata("a").as_deref()), (3, Some("b")));
        assert_eq!(reading.fields(), rows.fields.to_vec());
        for field in rows.fields.iter() {
            assert_eq!(
                reading.column(&field.name).expect("read").as_ref(),
                rows.column(&field.name).as_deref()
            );
        }
        assert_eq!(reading.column("other").expect("read"), None);
        std::fs::write(&file, b"PAR1 and no more").expect("written");
        assert!(ParquetFile::open(&file, false).is_err());
        std::fs::remove_file(file).expect("removed");
    }

    /// Every byte of the footer with other values, under a checksum that is right.
    #[test]
    fn forged_files_are_errors() {
        let fields = [ColumnHeading { name: "x".to_owned(), unit: "", kind: ColumnKind::Numbers }];
        let columns = vec![ColumnCells::Numbers(vec![0.1, f64::NAN, 7.0])];
        let rows = RunRows { fields: Arc::new(fields), columns };
        let whole = encode(&rows, &[]).expect("encoded");
        let place = std::env::temp_dir().join(format!("flexsc-forged-{}.parquet", std::process::id()));
        for position in 4..whole.len() - 4 {
            for other in [whole[position] ^ 1, whole[position] ^ 0x40, 0x00, 0x7f, 0xff] {
                let mut bytes = whole.clone();
                bytes[position] = other;
                checksum::fill(&mut bytes);
                std::fs::write(&place, bytes).expect("written");
                // What it says, it says without a panic.
                let _ = ParquetFile::open(&place, false).and_then(|reading| reading.column("x"));
            }
        }
        std::fs::remove_file(place).expect("removed");
    }

    fn tempfile(bytes: &[u8]) -> std::path::PathBuf {
        let path = std::env::temp_dir().join(format!("flexsc-{}.parquet", std::process::id()));
        std::fs::write(&path, bytes).expect("written");
        path
    }
}
