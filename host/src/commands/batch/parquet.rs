//! The table of results as Parquet: columns of text, whole numbers and f64, absent where a cell is empty.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

use crate::records::record::{RowsIn, cells};
use crate::result::cell::{Cell, Kind};

/// Rows that are in memory at once.
const GROUP: usize = 16_384;

fn physical(kind: Kind) -> Physical {
    match kind {
        Kind::Text => Physical::BYTE_ARRAY,
        Kind::Whole => Physical::INT64,
        Kind::Number => Physical::DOUBLE,
        Kind::Flag => Physical::BOOLEAN,
    }
}

/// Writes the rows of a table.
///
/// # Errors
/// A row is broken, or the output cannot be written.
pub fn write(columns: &[(String, Kind)], rows: RowsIn, out: &mut (dyn Write + Send)) -> io::Result<()> {
    let field = |(name, kind): &(String, Kind)| {
        let logical = match kind {
            Kind::Text => Some(LogicalType::String),
            Kind::Whole => Some(LogicalType::integer(64, false)),
            Kind::Number | Kind::Flag => None,
        };
        let field = Type::primitive_type_builder(name, physical(*kind)).with_repetition(Repetition::OPTIONAL);
        field.with_logical_type(logical).build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("fits").with_fields(fields).build()?;
    let properties = WriterProperties::builder().set_compression(Compression::SNAPPY).build();
    let mut writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?;
    let mut group: Vec<Vec<Cell>> = Vec::new();
    let mut rows = rows.peekable();
    while let Some(row) = rows.next() {
        group.push(cells(row?)?);
        if group.len() == GROUP || rows.peek().is_none() {
            let mut target = writer.next_row_group()?;
            for (place, (name, kind)) in columns.iter().enumerate() {
                let cells: Vec<&Cell> = group.iter().map(|row| &row[place]).collect();
                if let Some(column) = target.next_column()? {
                    fill(column, name, *kind, &cells)?;
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
fn fill(mut column: SerializedColumnWriter, name: &str, kind: Kind, cells: &[&Cell]) -> Result<(), ParquetError> {
    let there: Vec<i16> = cells.iter().map(|cell| i16::from(!cell.is_empty())).collect();
    let cells = cells.iter().copied().filter(|cell| !cell.is_empty());
    let wrong = |cell: &Cell| ParquetError::General(format!("{cell:?} in column {name} is no {kind:?}"));
    match kind {
        Kind::Text => {
            let values: Vec<ByteArray> = cells.map(|cell| ByteArray::from(cell.text().as_str())).collect();
            put::<ByteArrayType>(&mut column, &values, &there)?;
        }
        Kind::Whole => {
            let values = cells.map(|cell| match cell {
                Cell::Whole(whole) => Ok(whole.cast_signed()),
                other => Err(wrong(other)),
            });
            put::<Int64Type>(&mut column, &values.collect::<Result<Vec<_>, _>>()?, &there)?;
        }
        Kind::Number => {
            let values = cells.map(|cell| match cell {
                Cell::Number(number) => Ok(*number),
                other => Err(wrong(other)),
            });
            put::<DoubleType>(&mut column, &values.collect::<Result<Vec<_>, _>>()?, &there)?;
        }
        Kind::Flag => {
            let values = cells.map(|cell| match cell {
                Cell::Flag(flag) => Ok(*flag),
                other => Err(wrong(other)),
            });
            put::<BoolType>(&mut column, &values.collect::<Result<Vec<_>, _>>()?, &there)?;
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
    use crate::records::record::Written;

    #[test]
    fn reads_back() {
        let columns = crate::commands::batch::run::columns(&[crate::engine::Model::paper()]);
        // More rows than one group has, and each third failed.
        let count = GROUP + 3;
        let cell = |row: usize, (name, kind): &(String, Kind)| match (kind, row % 3) {
            (Kind::Text, 2) if name == "file" || name == "error" => Cell::Text(format!("ä {row}")),
            (_, 2) => Cell::Empty,
            (Kind::Text, _) => Cell::Words(vec![name.clone(), row.to_string()]),
            (Kind::Whole, _) => Cell::Whole(u64::MAX - row as u64),
            (Kind::Number, _) => Cell::Number(0.1 * row as f64),
            (Kind::Flag, _) => Cell::Flag(row.is_multiple_of(2)),
        };
        let row = |row: usize| Ok(Written::Cells(columns.iter().map(|column| cell(row, column)).collect()));
        let file = tempfile::NamedTempFile::new().unwrap();
        write(&columns, &mut (0..count).map(row), &mut file.as_file()).unwrap();
        let reader = SerializedFileReader::new(file.reopen().unwrap()).unwrap();
        assert_eq!(reader.metadata().num_row_groups(), 2);
        let mut rows = 0;
        for (row, read) in reader.get_row_iter(None).unwrap().enumerate() {
            for ((name, field), column) in read.unwrap().get_column_iter().zip(&columns) {
                let read = match field {
                    Field::Null => Cell::Empty,
                    Field::Str(text) => Cell::Text(text.clone()),
                    Field::ULong(number) => Cell::Whole(*number),
                    Field::Double(number) => Cell::Number(*number),
                    Field::Bool(flag) => Cell::Flag(*flag),
                    other => panic!("{other:?}"),
                };
                let written = match cell(row, column) {
                    Cell::Words(words) => Cell::Text(words.join("+")),
                    other => other,
                };
                assert_eq!((name, read), (&column.0, written), "row {row}");
            }
            rows += 1;
        }
        assert_eq!(rows, count);
    }
}
