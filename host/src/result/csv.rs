//! Fitted scans as a table.

use super::columns::{FitRow, of_fits, of_minima};
use crate::analysis::fit::FittedScan;
use crate::document::write_row;
use crate::engine::Model;

/// One row a scan, or with `minima` one row a distinct minimum.
pub fn csv(scans: &[FittedScan], minima: bool) -> String {
    let models: Vec<&Model> = scans.iter().map(|scan| scan.outcome.model).collect();
    let columns = if minima { of_minima(&models) } else { of_fits(&models) };
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing to memory does not fail.
    let names: Vec<&String> = columns.iter().map(|column| &column.name).collect();
    let _ = write_row(&mut writer, &names);
    let mut write = |row: FitRow| {
        let cells: Vec<String> = columns.iter().map(|column| column.cell(&row).text()).collect();
        let _ = write_row(&mut writer, &cells);
    };
    for scan in scans {
        let row = FitRow::from(scan);
        if minima {
            let each = scan.outcome.minima.iter().enumerate();
            each.for_each(|minimum| {
                write(FitRow {
                    minimum: Some(minimum),
                    ..row
                });
            });
        } else {
            write(row);
        }
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}
