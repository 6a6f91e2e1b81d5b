//! Axes: from values to pixels, with their ticks.

use std::f64::consts::LOG10_E;

use brdfit_core::real::Real;

use super::svg::{self, log10};

/// One tick; without a label it is a minor one.
pub struct Tick {
    /// In the axis' own unit.
    pub at: f64,
    /// What stands beside it, as SVG.
    pub label: Option<String>,
}

/// A range of values over a length in pixels.
pub struct Axis {
    low: f64,
    high: f64,
    pixels: f64,
    ticks: Vec<Tick>,
    /// Pixels grow downwards.
    upwards: bool,
}

impl Axis {
    /// Degrees from left to right.
    pub fn angles(values: impl Iterator<Item = f64>, pixels: f64) -> Axis {
        let (low, high) = range(values, -90.0, 90.0, 4.0);
        let most = (pixels / 42.0).min(9.0);
        let step = [0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0]
            .into_iter()
            .find(|s| (high - low) / s <= most);
        let step = step.unwrap_or(45.0);
        let minor = if step == 30.0 { 10.0 } else { step / 5.0 };
        let margin = 0.02 * (high - low);
        let (low, high) = (low - margin, high + margin);
        let ticks = steps(low, high, minor).map(|at| {
            let turns = at / step;
            // In a narrow panel a label at the very end would run into the next panel's.
            let end = (at - low).min(high - at) / (high - low) * pixels;
            let major = (turns - turns.round()).abs() < 1e-6 && (pixels > 500.0 || end > 14.0);
            Tick {
                at,
                label: major.then(|| plain(at)),
            }
        });
        Axis {
            low,
            high,
            pixels,
            ticks: ticks.collect(),
            upwards: false,
        }
    }

    /// Any numbers from left to right.
    pub fn linear(values: impl Iterator<Item = f64>, pixels: f64) -> Axis {
        let (low, high) = range(values, 0.0, 1.0, f64::MIN_POSITIVE);
        let span = if high > low { high - low } else { low.abs().max(1.0) };
        let (low, high) = (low - 0.03 * span, high + 0.03 * span);
        // The least of 1, 2 and 5 times a power of ten that gives few enough labels.
        let least = (high - low) / (pixels / 70.0).max(3.0);
        let power = Real::exp(log10(least).floor() / LOG10_E);
        let step = [1.0, 2.0, 5.0, 10.0]
            .into_iter()
            .map(|k| k * power)
            .find(|&step| step >= least);
        let step = step.unwrap_or(10.0 * power);
        let ticks = steps(low, high, step).map(|at| Tick {
            at,
            label: Some(svg::number(at)),
        });
        Axis {
            low,
            high,
            pixels,
            ticks: ticks.collect(),
            upwards: false,
        }
    }

    /// The same from bottom to top.
    pub fn upwards(self) -> Axis {
        Axis { upwards: true, ..self }
    }

    /// log10 of a quantity from bottom to top; at least half a decade.
    pub fn logarithm(values: impl Iterator<Item = f64>, pixels: f64) -> Axis {
        let (low, high) = range(values, -2.0, 0.0, 0.5);
        let margin = 0.06 * (high - low);
        let (low, high) = (low - margin, high + margin);
        let decades = high.floor() - low.ceil() + 1.0;
        let most = (pixels / 32.0).floor();
        let mut ticks = Vec::new();
        if decades >= 3.0 {
            let step = (decades / most).ceil().max(1.0);
            for at in steps(low, high, 1.0) {
                let label = (at.rem_euclid(step) == 0.0).then(|| format!("10{}", svg::sup(&plain(at))));
                ticks.push(Tick { at, label });
            }
        }
        for decade in steps(low - 1.0, high, 1.0).filter(|_| decades <= most) {
            for mantissa in 1..10 {
                let at = decade + log10(f64::from(mantissa));
                let label = match mantissa {
                    1 if decades >= 3.0 => continue,
                    1 | 2 | 5 => true,
                    3 | 7 => high - low < 0.8,
                    _ => false,
                };
                let value = f64::from(mantissa) * Real::exp(decade / LOG10_E);
                let label = (label && decades < 3.0).then(|| svg::number(value));
                if low <= at && at <= high {
                    ticks.push(Tick { at, label });
                }
            }
        }
        Axis {
            low,
            high,
            pixels,
            ticks,
            upwards: true,
        }
    }

    /// The same from left to right.
    pub fn rightwards(self) -> Axis {
        Axis { upwards: false, ..self }
    }

    /// Where a value lies, in pixels from the left or from the top.
    pub fn pixel(&self, value: f64) -> f64 {
        let share = (value - self.low) / (self.high - self.low);
        self.pixels * if self.upwards { 1.0 - share } else { share }
    }

    /// Its length.
    pub fn pixels(&self) -> f64 {
        self.pixels
    }

    /// Its range of values.
    pub fn range(&self) -> (f64, f64) {
        (self.low, self.high)
    }

    /// Its ticks.
    pub fn ticks(&self) -> &[Tick] {
        &self.ticks
    }
}

/// Least and largest value, at least `span` apart; `low` and `high` if there is none.
fn range(values: impl Iterator<Item = f64>, low: f64, high: f64, span: f64) -> (f64, f64) {
    let finite = values.filter(|value| value.is_finite());
    let (least, most) = finite.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
    if least > most {
        return (low, high);
    }
    let grow = (0.5 * (span - (most - least))).max(0.0);
    (least - grow, most + grow)
}

/// The multiples of `step` within a range.
fn steps(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    ((low / step).ceil() as i64..=(high / step).floor() as i64).map(move |k| k as f64 * step)
}

/// A number as short as it goes, with a true minus sign.
pub fn plain(value: f64) -> String {
    format!("{value}").replace('-', "−")
}
