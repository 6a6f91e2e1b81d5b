//! Tables of numbers over the unit square: bilinear between nodes, and the map that makes a density of them.

/// A table of values over the unit square; rows are along x.
pub struct Table {
    values: Vec<f64>,
    width: usize,
    height: usize,
}

impl Table {
    /// None if there are fewer than two rows or columns.
    pub fn new(values: Vec<f64>, width: usize) -> Option<Table> {
        let height = values.len() / width.max(1);
        (width >= 2 && height >= 2).then_some(Table { values, width, height })
    }

    /// The value at a place, bilinear; a place outside counts as the nearest in the square.
    pub fn at(&self, x: f64, y: f64) -> f64 {
        let ((i, s), (j, t)) = (cell(x, self.width), cell(y, self.height));
        let value = |i: usize, j: usize| self.values[i + j * self.width];
        mix(
            mix(value(i, j), value(i + 1, j), s),
            mix(value(i, j + 1), value(i + 1, j + 1), s),
            t,
        )
    }
}

/// The cell of a coordinate among `nodes` nodes, and the place in it.
fn cell(x: f64, nodes: usize) -> (usize, f64) {
    let scaled = x.clamp(0.0, 1.0) * (nodes - 1) as f64;
    let first = (scaled as usize).min(nodes - 2);
    (first, scaled - first as f64)
}

fn mix(a: f64, b: f64, t: f64) -> f64 {
    (1.0 - t) * a + t * b
}

/// The map from the unit square to itself whose density is a table, bilinear between nodes: first along y, then along x.
pub struct Warp {
    table: Table,
    /// Integral up to each row, over the cells' sides.
    rows: Vec<f64>,
    /// Integral along each row up to each node.
    columns: Vec<f64>,
}

impl Warp {
    /// Of a table of two or more rows and columns; rows are along x.
    pub fn new(values: Vec<f64>, width: usize) -> Warp {
        let height = values.len() / width;
        let mut columns = Vec::with_capacity(values.len());
        for row in values.chunks_exact(width) {
            columns.extend(integral(row));
        }
        let ends: Vec<f64> = columns.chunks_exact(width).map(|row| row[width - 1]).collect();
        Warp {
            rows: integral(&ends),
            columns,
            table: Table { values, width, height },
        }
    }

    /// Where a place of the even square goes.
    pub fn sample(&self, x: f64, y: f64) -> [f64; 2] {
        let Table { values, width, height } = &self.table;
        let last = |j: usize| self.columns[(j + 1) * width - 1];
        let (j, t) = invert(y, &self.rows, last);
        let row = |i: usize| mix(self.columns[j * width + i], self.columns[(j + 1) * width + i], t);
        let along: Vec<f64> = (0..*width).map(row).collect();
        let density = |i: usize| mix(values[j * width + i], values[(j + 1) * width + i], t);
        let (i, s) = invert(x, &along, density);
        [
            (i as f64 + s) / (width - 1) as f64,
            (j as f64 + t) / (height - 1) as f64,
        ]
    }
}

/// The integral up to each node by the trapezoidal rule, steps of 1.
fn integral(values: &[f64]) -> Vec<f64> {
    let steps = values.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
    let sums = steps.scan(0.0, |sum, step| {
        *sum += step;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// The cell, and the place in it, at which the integral of a piecewise linear density reaches `part` of the whole.
fn invert(part: f64, integral: &[f64], density: impl Fn(usize) -> f64) -> (usize, f64) {
    let cells = integral.len() - 1;
    let wanted = part.clamp(0.0, 1.0) * integral[cells];
    let first = integral.partition_point(|&sum| sum <= wanted).clamp(1, cells) - 1;
    let rest = wanted - integral[first];
    let (a, b) = (density(first), density(first + 1));
    // rest = a t + (b - a) t^2 / 2, without the cancellation of the usual form where a and b are near.
    let root = (a * a + 2.0 * rest * (b - a)).max(0.0).sqrt();
    let t = if a + root > 0.0 { 2.0 * rest / (a + root) } else { 0.0 };
    (first, t.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_bilinear() {
        let table = Table::new(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 3).unwrap();
        assert_eq!(
            (table.at(0.25, 0.5), table.at(1.0, 1.0), table.at(2.0, -1.0)),
            (2.0, 5.0, 2.0)
        );
        assert!(Table::new(vec![1.0, 2.0], 2).is_none() && Table::new(vec![1.0, 2.0], 1).is_none());
    }

    #[test]
    fn an_even_density_maps_nothing() {
        let warp = Warp::new(vec![3.0; 12], 4);
        for (x, y) in [(0.0, 0.0), (0.3, 0.7), (1.0, 1.0), (0.5, 0.25)] {
            let [u, v] = warp.sample(x, y);
            assert!((u - x).abs() < 1e-15 && (v - y).abs() < 1e-15, "{u} {v}");
        }
    }

    #[test]
    fn as_much_density_lies_below_the_image_as_the_place_says() {
        // The density (1 + 3 v) (1 + 2 u): its parts up to u and v are known.
        let (width, height) = (5, 4);
        let node = |k: usize| {
            let (u, v) = ((k % width) as f64 / 4.0, (k / width) as f64 / 3.0);
            (1.0 + 2.0 * u) * (1.0 + 3.0 * v)
        };
        let warp = Warp::new((0..width * height).map(node).collect(), width);
        for k in 0..=20 {
            let (x, y) = (f64::from(k) / 20.0, f64::from((7 * k) % 21) / 20.0);
            let [u, v] = warp.sample(x, y);
            assert!(((u + u * u) / 2.0 - x).abs() < 1e-14, "{x} {u}");
            assert!(((v + 1.5 * v * v) / 2.5 - y).abs() < 1e-14, "{y} {v}");
        }
    }
}
