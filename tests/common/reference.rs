//! The 60-digit reference values in `tests/data/reference`.

/// One row of `model.csv`.
#[derive(Clone, Debug)]
pub struct Row {
    pub case: String,
    /// theta_i, theta_s, delta_phi in degrees.
    pub angles: [f64; 3],
    /// rho_d, rho_s, rho_v, m, n, kappa.
    pub params: [f64; 6],
    /// ln f, and its derivatives by the parameters; infinite where f64 has no such number.
    pub values: [f64; 7],
}

fn lines(file: &str) -> Vec<Vec<String>> {
    let path = format!("{}/tests/data/reference/{file}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    text.lines()
        .skip(1)
        .map(|line| line.split(',').map(str::to_string).collect())
        .collect()
}

fn numbers<const N: usize>(cells: &[String]) -> [f64; N] {
    std::array::from_fn(|i| {
        cells[i]
            .parse()
            .unwrap_or_else(|_| panic!("not a number: {}", cells[i]))
    })
}

/// `model.csv`.
pub fn model() -> Vec<Row> {
    lines("model.csv")
        .iter()
        .map(|cells| Row {
            case: cells[0].clone(),
            angles: numbers(&cells[1..4]),
            params: numbers(&cells[4..10]),
            values: numbers(&cells[10..17]),
        })
        .collect()
}

/// `fresnel.csv`: (cos theta, n, kappa) and (F, dF/dn, dF/dkappa).
pub fn fresnel() -> Vec<([f64; 3], [f64; 3])> {
    lines("fresnel.csv")
        .iter()
        .map(|cells| (numbers(&cells[0..3]), numbers(&cells[3..6])))
        .collect()
}

/// One row of `lobes.csv`.
#[derive(Clone, Debug)]
pub struct LobesRow {
    pub distribution: String,
    pub masking: String,
    /// theta_i, theta_s, delta_phi in radians.
    pub angles: [f64; 3],
    /// In the order rho_d, rho_s, rho_v, m, n, kappa, m_v, rho_2, m_2.
    pub params: [f64; 9],
    /// ln f, and its derivatives by the parameters.
    pub values: [f64; 10],
}

/// `lobes.csv`.
pub fn lobes() -> Vec<LobesRow> {
    lines("lobes.csv")
        .iter()
        .map(|cells| LobesRow {
            distribution: cells[0].clone(),
            masking: cells[1].clone(),
            angles: numbers(&cells[2..5]),
            params: numbers(&cells[5..14]),
            values: numbers(&cells[14..24]),
        })
        .collect()
}
