//! What a proof needs of a scan: numbers of each sample that do not depend on the parameters, and the bounds.

use brdfit_core::brdf::{ABSORBING, ALL, Brdf, DIFFUSE, Params, SURFACE, VOLUME, fresnel};
use brdfit_core::geometry::{Geometry, Sample, SampleError};
use brdfit_core::real::Real;

/// Number of coordinates: u of the three parts of Eq. 14, mu = 1/m^2, a = ln n and b = ln(1 + kappa^2).
pub(crate) const D: usize = 6;
/// Parts of Eq. 14: Lambert's, the surface lobe, the volume lobe.
pub(crate) const PARTS: usize = 3;
/// Place of mu among the coordinates.
pub(crate) const MU: usize = 3;
/// Place of a = ln n.
pub(crate) const A: usize = 4;
/// Place of b = ln(1 + kappa^2).
pub(crate) const B: usize = 5;

/// One part of Eq. 14 at one sample: it is `exp(level + u + phi - slope mu)` times the measured f.
///
/// u is ln rho_d for Lambert's part, and ln(rho F mu) with F at the reference angle for a lobe; phi is ln F over that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    /// ln of the geometry's factor over the measured f.
    pub level: f64,
    /// Sum of the absolute values that `level` was made of, for its rounding.
    pub size: f64,
    /// tan^2 theta_h; 0 for Lambert's part.
    pub slope: f64,
    /// Place of its cosine of theta_d among [`Scene::cosines`]; not used for Lambert's part.
    pub cosine: usize,
}

/// One sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub terms: [Term; PARTS],
    /// Square of the weight over the largest of the scan.
    pub weight2: f64,
    geometry: Geometry<f64>,
    ln_f: f64,
}

/// A scan with the terms and bounds of its model.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) rows: Vec<Row>,
    /// All different cosines of theta_d and theta_de, rising.
    pub(crate) cosines: Vec<f64>,
    /// Places among `cosines` whose neighbours are near: the ends, the references, and no more than necessary.
    pub(crate) nodes: Vec<usize>,
    /// The reference angle of each lobe, as a place among `cosines`: that of the sample nearest to its peak.
    pub(crate) reference: [usize; 2],
    /// Parts that the terms contain.
    pub(crate) present: [bool; PARTS],
    pub(crate) lower: Params<f64>,
    pub(crate) upper: Params<f64>,
}

/// Cosines that differ by less are those of one angle, and their difference is rounding.
const SAME: f64 = 8.0 * f64::EPSILON;

impl Scene {
    /// The scan of `samples`; `terms` as in [`brdfit_core::brdf`], bounds of parameters that they do not contain are ignored.
    ///
    /// # Errors
    /// Place of a sample that is not valid, and why it is not.
    pub fn new(
        samples: &[Sample<f64>],
        terms: u8,
        lower: &Params<f64>,
        upper: &Params<f64>,
    ) -> Result<Self, (usize, SampleError)> {
        let heaviest = samples.iter().fold(0.0, |most: f64, s| most.max(s.weight.abs()));
        let mut seen = Vec::new();
        for (index, sample) in samples.iter().enumerate() {
            let geometry = Geometry::new(sample.theta_i, sample.theta_s, sample.delta_phi);
            let geometry = geometry.map_err(|error| (index, error))?;
            if !(sample.brdf.is_finite() && sample.weight.is_finite()) {
                return Err((index, SampleError::NotFinite));
            }
            if !(sample.brdf >= f64::MIN_POSITIVE) {
                return Err((index, SampleError::NotPositive));
            }
            let weight = sample.weight.abs() / heaviest;
            if weight * weight > 0.0 {
                seen.push((geometry, Real::portable_ln(sample.brdf), weight * weight));
            }
        }
        let lobes = seen.iter().flat_map(|(geometry, ..)| geometry.lobes);
        let mut cosines: Vec<f64> = lobes.map(|lobe| lobe.cos_theta_d).collect();
        cosines.sort_by(f64::total_cmp);
        cosines.dedup_by(|next, kept| *next - *kept <= SAME);
        let row = |(geometry, ln_f, weight2): &(Geometry<f64>, f64, f64)| Row {
            terms: terms_of(geometry, *ln_f, &cosines),
            weight2: *weight2,
            geometry: *geometry,
            ln_f: *ln_f,
        };
        let rows: Vec<Row> = seen.iter().map(row).collect();
        let nearest = |k: usize| {
            let terms = rows.iter().map(|row| row.terms[k]);
            let nearest = terms.min_by(|x, y| x.slope.total_cmp(&y.slope).then(x.cosine.cmp(&y.cosine)));
            nearest.map_or(0, |term| term.cosine)
        };
        let reference = [nearest(1), nearest(2)];
        let known = |params: &Params<f64>| Params {
            kappa: if terms & ABSORBING != 0 { params.kappa } else { 0.0 },
            ..*params
        };
        Ok(Scene {
            nodes: nodes(&cosines, reference),
            rows,
            cosines,
            reference,
            present: [DIFFUSE, SURFACE, VOLUME].map(|part| terms & part != 0),
            lower: known(lower),
            upper: known(upper),
        })
    }

    /// The sum of squared residuals of ln f at `params`, each times its weight over the largest; weights and kappa of absent terms must be 0.
    pub fn cost(&self, params: &Params<f64>) -> f64 {
        let model = Brdf::<f64, ALL>::new(params);
        let square = |row: &Row| {
            let residual = model.ln_f(&row.geometry) - row.ln_f;
            row.weight2 * residual * residual
        };
        self.rows.iter().map(square).sum()
    }

    /// Cosine of theta_d where F of the surface lobe, and of theta_de where that of the volume lobe, is part of the coordinates.
    pub fn reference_cosines(&self) -> [f64; 2] {
        self.reference.map(|place| self.cosines[place])
    }

    /// The parameters at the coordinates of a [`super::Region`], which need not be within the bounds; of absent terms weights and kappa are 0, m and n are 1.
    pub fn params(&self, x: &[f64; D]) -> Params<f64> {
        let lobes = self.present[1] || self.present[2];
        let n = if lobes { Real::portable_exp(x[A]) } else { 1.0 };
        let kappa = if lobes {
            (Real::portable_exp(x[B]) - 1.0).max(0.0).sqrt()
        } else {
            0.0
        };
        let weight = |k: usize| {
            if x[k] == f64::NEG_INFINITY {
                0.0
            } else if k == 0 {
                Real::portable_exp(x[0])
            } else {
                let f = fresnel(self.cosines[self.reference[k - 1]], n, kappa).0;
                Real::portable_exp(x[k] - Real::portable_ln(f.max(f64::MIN_POSITIVE)) - Real::portable_ln(x[MU]))
            }
        };
        Params {
            rho_d: weight(0),
            rho_s: weight(1),
            rho_v: weight(2),
            m: if lobes { 1.0 / x[MU].sqrt() } else { 1.0 },
            n,
            kappa,
        }
    }

    /// The coordinates of parameters.
    pub fn point(&self, params: &Params<f64>) -> [f64; D] {
        let ln = |x: f64| {
            if x > 0.0 {
                Real::portable_ln(x)
            } else {
                f64::NEG_INFINITY
            }
        };
        let mu = if params.m > 0.0 {
            1.0 / (params.m * params.m)
        } else {
            0.0
        };
        let lobe = |k: usize, rho: f64| {
            let f = self
                .cosines
                .get(self.reference[k])
                .map(|&c| fresnel(c, params.n, params.kappa).0);
            ln(rho) + ln(f.unwrap_or(0.0)) + ln(mu)
        };
        let index = |x: f64| Real::portable_ln(x.max(1.0));
        [
            ln(params.rho_d),
            lobe(0, params.rho_s),
            lobe(1, params.rho_v),
            mu,
            index(params.n),
            index(1.0 + params.kappa * params.kappa),
        ]
    }

    /// The nearest parameters within the bounds.
    pub fn clamp(&self, params: &Params<f64>) -> Params<f64> {
        let (lower, upper, params) = (self.lower.to_array(), self.upper.to_array(), params.to_array());
        let lobes = self.present[1] || self.present[2];
        Params::from_array(std::array::from_fn(|i| {
            if self.present.get(i).copied().unwrap_or(lobes) {
                params[i].max(lower[i]).min(upper[i])
            } else {
                params[i]
            }
        }))
    }

    /// How far rounding can move a [`Scene::cost`] of about `cost`.
    pub fn rounding(&self, cost: f64) -> f64 {
        let square = |row: &Row| {
            let error = 8.0 * f64::EPSILON * (row.ln_f.abs() + 8.0);
            row.weight2 * error * error
        };
        let squares: f64 = self.rows.iter().map(square).sum();
        // By the inequality of Cauchy and Schwarz.
        2.0 * (cost * squares).sqrt() + squares + self.rows.len() as f64 * f64::EPSILON * cost
    }
}

fn terms_of(geometry: &Geometry<f64>, ln_f: f64, cosines: &[f64]) -> [Term; PARTS] {
    let term = |factor: f64, slope: f64, cosine: usize| {
        let factor = Real::portable_ln(factor);
        Term {
            level: factor - ln_f,
            size: factor.abs() + ln_f.abs(),
            slope,
            cosine,
        }
    };
    let lobe = |k: usize| {
        let lobe = geometry.lobes[k];
        let place = cosines.partition_point(|&c| c <= lobe.cos_theta_d).max(1) - 1;
        term(lobe.factor, lobe.tan2_theta_h, place)
    };
    [term(1.0 / f64::PI, 0.0, 0), lobe(0), lobe(1)]
}

/// Far enough apart that they are few, and near enough that the slope of F by the cosine hardly changes from one to the next.
const GAP: f64 = 0.02;

fn nodes(cosines: &[f64], reference: [usize; 2]) -> Vec<usize> {
    let mut nodes: Vec<usize> = Vec::new();
    for k in 0..cosines.len() {
        let end = k == 0 || k + 1 == cosines.len() || reference.contains(&k);
        let far = |&last: &usize| cosines.get(k + 1).is_some_and(|next| next - cosines[last] > GAP);
        if end || nodes.last().is_some_and(far) {
            nodes.push(k);
        }
    }
    nodes
}
