//! How far residuals spread when outliers do not count.

/// Without noise the residuals are rounding, and none of them is an outlier.
const LEAST: f64 = 1e-12;
/// The median of the size of a Gaussian residual is its standard deviation over this.
const GAUSSIAN: f64 = 1.4826;

/// The standard deviation of Gaussian residuals of these sizes, after a fit of `free` parameters, from their median.
pub fn median(sizes: impl Iterator<Item = f64>, free: usize) -> f64 {
    let mut sizes: Vec<f64> = sizes.collect();
    sizes.sort_by(f64::total_cmp);
    let Some(&median) = sizes.get(sizes.len() / 2) else {
        return LEAST;
    };
    let count = sizes.len() as f64;
    let left = (sizes.len().saturating_sub(free)).max(1) as f64;
    (GAUSSIAN * median * (count / left).sqrt()).max(LEAST)
}

/// Tukey's biweight, tuned to withstand half of the samples (Rousseeuw and Yohai 1984).
#[derive(Clone, Copy, Debug)]
pub struct Biweight {
    /// The mean of rho at the scale.
    mean: f64,
}

/// Residuals beyond this many scales count alike.
const REACH: f64 = 1.547_645;

impl Biweight {
    /// For so many samples, of which `free` are used up by the parameters.
    pub fn new(samples: usize, free: usize) -> Self {
        let left = samples.saturating_sub(free).max(1);
        Biweight {
            mean: 0.5 * left as f64 / samples.max(1) as f64,
        }
    }

    /// The scale: where the mean of rho is that of Gaussian residuals.
    pub fn scale(&self, residuals: &[f64]) -> f64 {
        const ROUNDS: usize = 100;
        let count = residuals.len().max(1) as f64;
        let mut scale = median(residuals.iter().map(|residual| residual.abs()), 0);
        for _ in 0..ROUNDS {
            let sum: f64 = residuals.iter().map(|residual| rho(residual / scale)).sum();
            let next = (scale * (sum / count / self.mean).sqrt()).max(LEAST);
            let settled = (next - scale).abs() <= 1e-9 * scale;
            scale = next;
            if settled {
                break;
            }
        }
        scale
    }

    /// The root of the weight of a residual of so many scales: 1 to 0.
    pub fn root_weight(&self, scales: f64) -> f64 {
        let part = scales / REACH;
        (1.0 - part * part).max(0.0)
    }
}

/// From 0 to 1 at [`REACH`] and beyond.
fn rho(scales: f64) -> f64 {
    let part = scales / REACH;
    let left = (1.0 - part * part).max(0.0);
    1.0 - left * left * left
}
