//! The table of results as Parquet: columns of text, whole numbers and f64, absent where a cell is empty.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use super::record::{RowsIn, cells};

/// Columns of words; what is named nowhere here is f64.
const TEXT: [&str; 8] = [
    "file",
    "scan",
    "method",
    "terms",
    "at_bound",
    "stop",
    "theta_i_deg",
    "error",
];
/// Columns of whole numbers.
const WHOLE: [&str; 6] = ["samples", "seed", "starts", "minima", "cost", "linearize"];
/// Rows that are in memory at once.
const GROUP: usize = 16_384;

fn physical(column: &str) -> Physical {
    if TEXT.contains(&column) {
        Physical::BYTE_ARRAY
    } else if WHOLE.contains(&column) {
        Physical::INT64
    } else {
        Physical::DOUBLE
    }
}

/// Writes the rows of a table.
///
/// # Errors
/// A row is broken, or the output can not be written.
pub fn write(columns: &[String], rows: RowsIn, out: &mut (dyn Write + Send)) -> io::Result<()> {
    let field = |name: &String| {
        let kind = physical(name);
        let logical = match kind {
            Physical::BYTE_ARRAY => Some(LogicalType::String),
            Physical::INT64 => Some(LogicalType::integer(64, false)),
            _ => None,
        };
        let field = Type::primitive_type_builder(name, kind).with_repetition(Repetition::OPTIONAL);
        field.with_logical_type(logical).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("fits").with_fields(fields).build()?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
    let mut group: Vec<Vec<String>> = Vec::new();
    let mut rows = rows.peekable();
    while let Some(row) = rows.next() {
        group.push(cells(row?)?);
        if group.len() == GROUP || rows.peek().is_none() {
            let mut target = writer.next_row_group()?;
            for (place, name) in columns.iter().enumerate() {
                let texts: Vec<&str> = group.iter().map(|row| row[place].as_str()).collect();
                if let Some(column) = target.next_column()? {
                    fill(column, name, &texts)?;
                }
            }
            target.close()?;
            group.clear();
        }
    }
    writer.close()?;
    Ok(())
}

/// Writes one column of a group of rows.
fn fill(mut column: SerializedColumnWriter, name: &str, texts: &[&str]) -> Result<(), ParquetError> {
    let there: Vec<i16> = texts.iter().map(|text| i16::from(!text.is_empty())).collect();
    let values = texts.iter().copied().filter(|text| !text.is_empty());
    let wrong = |text: &str| ParquetError::General(format!("'{text}' in column {name} is no number"));
    match physical(name) {
        Physical::BYTE_ARRAY => {
            let values: Vec<ByteArray> = values.map(ByteArray::from).collect();
            put::<ByteArrayType>(&mut column, &values, &there)?;
        }
        Physical::INT64 => {
            let values = values.map(|text| text.parse::<u64>().map(u64::cast_signed).map_err(|_| wrong(text)));
            put::<Int64Type>(&mut column, &values.collect::<Result<Vec<_>, _>>()?, &there)?;
        }
        _ => {
            let values = values.map(|text| text.parse::<f64>().map_err(|_| wrong(text)));
            put::<DoubleType>(&mut column, &values.collect::<Result<Vec<_>, _>>()?, &there)?;
        }
    }
    column.close()
}

fn put<T: DataType>(column: &mut SerializedColumnWriter, values: &[T::T], there: &[i16]) -> Result<(), ParquetError> {
    column.typed::<T>().write_batch(values, Some(there), None)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    use super::*;
    use crate::commands::batch::record::Row;

    #[test]
    fn reads_back() {
        let columns = crate::commands::batch::run::columns();
        // More rows than one group has, and each third failed.
        let count = GROUP + 3;
        let cell = |row: usize, name: &str| match (physical(name), row % 3) {
            (Physical::BYTE_ARRAY, 2) if name == "file" || name == "error" => format!("ä {row}"),
            (_, 2) => String::new(),
            (Physical::BYTE_ARRAY, _) => format!("{name} {row}"),
            (Physical::INT64, _) => (u64::MAX - row as u64).to_string(),
            _ => (0.1 * row as f64).to_string(),
        };
        let row = |row: usize| Ok(Row::Cells(columns.iter().map(|name| cell(row, name)).collect()));
        let file = tempfile::NamedTempFile::new().unwrap();
        write(&columns, &mut (0..count).map(row), &mut file.as_file()).unwrap();
        let reader = SerializedFileReader::new(file.reopen().unwrap()).unwrap();
        assert_eq!(reader.metadata().num_row_groups(), 2);
        let mut rows = 0;
        for (row, read) in reader.get_row_iter(None).unwrap().enumerate() {
            for (name, field) in read.unwrap().get_column_iter() {
                let text = match field {
                    Field::Null => String::new(),
                    Field::Str(text) => text.clone(),
                    Field::ULong(number) => number.to_string(),
                    Field::Double(number) => number.to_string(),
                    other => panic!("{other:?}"),
                };
                assert_eq!(text, cell(row, name), "{name} of row {row}");
            }
            rows += 1;
        }
        assert_eq!(rows, count);
    }
}
