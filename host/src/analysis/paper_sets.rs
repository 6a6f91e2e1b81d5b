//! The paper's three synthetic sets, and what it says of them.

use brdfit_core::geometry::Sample;

use crate::engine::Material;
use serde::Serialize;

/// What noise the synthetic sets have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Noise {
    /// Uniform within +-10 %: the reading that agrees with the paper's fitted rho_d.
    Sym,
    /// Uniform within 0 to 10 %.
    Pos,
}

/// One set; parameters in the order of [`brdfit_core::brdf::NAMES`].
pub struct Source {
    /// As the paper calls it.
    pub name: &'static str,
    /// Incident angle, degrees.
    pub theta_i_deg: f64,
    /// Number of distinct minima that the paper found.
    pub paper_minima: u32,
    /// The values that the data were made with.
    pub actual: [f64; 6],
    /// The paper's best fit.
    pub paper_best: [f64; 6],
    sym: [&'static str; 3],
    pos: [&'static str; 3],
}

impl Source {
    /// The draws of the noise, as CSV.
    pub fn files(&self, noise: Noise) -> &[&'static str; 3] {
        match noise {
            Noise::Sym => &self.sym,
            Noise::Pos => &self.pos,
        }
    }
}

macro_rules! draws {
    ($set:literal, $noise:literal) => {
        [
            include_str!(concat!("../../data/testdata", $set, "_", $noise, "_seed1.csv")),
            include_str!(concat!("../../data/testdata", $set, "_", $noise, "_seed2.csv")),
            include_str!(concat!("../../data/testdata", $set, "_", $noise, "_seed3.csv")),
        ]
    };
}

/// Section 4 of the paper; the fits from its text and its Table 2.
pub const SETS: [Source; 3] = [
    Source {
        name: "Test data 1",
        theta_i_deg: 45.0,
        paper_minima: 13,
        actual: [0.1, 10.0, 0.01, 0.1, 3.0, 1.0],
        paper_best: [0.1, 11.27, 0.01, 0.1, 2.94, 0.9],
        sym: draws!(1, "sym"),
        pos: draws!(1, "pos"),
    },
    Source {
        name: "Test data 2",
        theta_i_deg: 80.0,
        paper_minima: 6,
        actual: [0.2, 1.5, 0.02, 0.15, 1.15, 0.9],
        paper_best: [0.2, 3.37, 0.02, 0.15, 1.01, 0.87],
        sym: draws!(2, "sym"),
        pos: draws!(2, "pos"),
    },
    Source {
        name: "Test data 3",
        theta_i_deg: 30.0,
        paper_minima: 4,
        actual: [0.15, 1.0, 0.001, 0.005, 1.1, 0.86],
        paper_best: [0.15, 2.37, 0.001, 0.005, 1.02, 0.92],
        sym: draws!(3, "sym"),
        pos: draws!(3, "pos"),
    },
];

/// The samples of one of the files above: theta_i and theta_s in degrees, BRDF in sr^-1.
pub fn samples(csv: &str) -> Vec<Sample<f64>> {
    let number = |cell: Option<&str>| cell.and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN);
    let row = |line: &str| {
        let mut cells = line.split(',');
        let [theta_i, theta_s, brdf] = std::array::from_fn(|_| number(cells.next()));
        Sample::in_plane(theta_i.to_radians(), theta_s.to_radians(), brdf)
    };
    csv.lines().skip(1).map(row).collect()
}

/// A scan to study.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// File or set.
    pub name: String,
    /// Its samples.
    pub samples: Vec<Sample<f64>>,
    /// What it was made with, if that is known.
    pub truth: Option<Material>,
}

/// The paper's three sets, with the first draw of symmetric noise.
pub fn paper_scans() -> Vec<Subject> {
    let subject = |set: &Source| Subject {
        name: set.name.to_string(),
        samples: samples(set.files(Noise::Sym)[0]),
        truth: Some(Material::paper(set.actual)),
    };
    SETS.iter().map(subject).collect()
}
