//! The columns of the program's tables, as values for Python.

use brdfit::analysis::fit::FittedScan;
use brdfit::engine::{FitOptions, Model, Outcome};
use brdfit::result::cell::{Cell, Kind};
use brdfit::result::columns::{Column, FitRow, of_fits, of_outcomes};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Of one fit: each column with its value.
pub fn of_one<'py>(py: Python<'py>, fitted: &FittedScan) -> PyResult<Bound<'py, PyDict>> {
    let table = PyDict::new(py);
    for column in of_fits(&[fitted.outcome.model]) {
        let name = &column.name;
        match column.cell(&FitRow::from(fitted)) {
            Cell::Empty => table.set_item(name, py.None()),
            Cell::Flag(flag) => table.set_item(name, flag),
            Cell::Whole(whole) => table.set_item(name, whole),
            Cell::Number(number) => table.set_item(name, number),
            Cell::Text(text) => table.set_item(name, text),
            Cell::Words(words) => table.set_item(name, words),
        }?;
    }
    Ok(table)
}

/// Of many fits: an array for each column that is not of words.
pub struct Table(Vec<(Column, Values)>);

enum Values {
    Flag(Vec<bool>),
    Whole(Vec<u64>),
    Number(Vec<f64>),
}

impl Table {
    /// A table without rows.
    pub fn new(models: &[&Model]) -> Table {
        let of_numbers = |column: Column| match column.kind() {
            Kind::Text => None,
            Kind::Flag => Some((column, Values::Flag(Vec::new()))),
            Kind::Whole => Some((column, Values::Whole(Vec::new()))),
            Kind::Number => Some((column, Values::Number(Vec::new()))),
        };
        Table(of_outcomes(models).into_iter().filter_map(of_numbers).collect())
    }

    /// The cells of a fit.
    pub fn cells(&self, options: &FitOptions, outcome: &Outcome) -> Vec<Cell> {
        let row = FitRow {
            scan: None,
            options,
            outcome,
            minimum: None,
        };
        self.0.iter().map(|(column, _)| column.cell(&row)).collect()
    }

    /// One more row, of such cells; where there are none, numbers are NaN and the others 0.
    pub fn push(&mut self, cells: Option<Vec<Cell>>) {
        let cells = cells.unwrap_or_else(|| vec![Cell::Empty; self.0.len()]);
        for ((_, values), cell) in self.0.iter_mut().zip(cells) {
            match (values, cell) {
                (Values::Flag(values), cell) => values.push(cell == Cell::Flag(true)),
                (Values::Whole(values), Cell::Whole(whole)) => values.push(whole),
                (Values::Whole(values), _) => values.push(0),
                (Values::Number(values), Cell::Number(number)) => values.push(number),
                (Values::Number(values), _) => values.push(f64::NAN),
            }
        }
    }

    /// The arrays by name.
    pub fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let table = PyDict::new(py);
        for (column, values) in self.0 {
            match values {
                Values::Flag(values) => table.set_item(column.name, values.into_pyarray(py)),
                Values::Whole(values) => table.set_item(column.name, values.into_pyarray(py)),
                Values::Number(values) => table.set_item(column.name, values.into_pyarray(py)),
            }?;
        }
        Ok(table)
    }
}
