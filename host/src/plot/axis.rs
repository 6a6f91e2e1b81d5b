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
        const STEPS: [f64; 8] = [0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0];
        let fits = STEPS.iter().position(|step| (high - low) / step <= most);
        let margin = 0.02 * (high - low);
        let (low, high) = (low - margin, high + margin);
        let ticks = |step: f64| -> Vec<Tick> {
            let minor = if step == 30.0 { 10.0 } else { step / 5.0 };
            let tick = |at: f64| {
                let turns = at / step;
                // In a narrow panel a label at the very end would run into the next panel's.
                let end = (at - low).min(high - at) / (high - low) * pixels;
                let major = (turns - turns.round()).abs() < 1e-6 && (pixels > 500.0 || end > 14.0);
                Tick {
                    at,
                    label: major.then(|| plain(at)),
                }
            };
            steps(low, high, minor).map(tick).collect()
        };
        let larger = STEPS[..=fits.unwrap_or(STEPS.len() - 1)].iter().rev();
        let ticks = with_labels(larger.map(|&step| ticks(step)));
        Axis::of((low, high), pixels, ticks)
    }

    fn of((low, high): (f64, f64), pixels: f64, ticks: Vec<Tick>) -> Axis {
        Axis {
            low,
            high,
            pixels,
            ticks,
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
        let power = Real::portable_exp(log10(least).floor() / LOG10_E);
        let ticks = |step: f64| -> Vec<Tick> {
            let tick = |at: f64| Tick {
                at,
                label: Some(svg::number(at)),
            };
            steps(low, high, step).map(tick).collect()
        };
        let smaller = [10.0, 5.0, 2.0, 1.0, 0.5, 0.2].map(|k| k * power);
        let first = smaller.iter().rposition(|&step| step >= least).unwrap_or(0);
        let ticks = with_labels(smaller[first..].iter().map(|&step| ticks(step)));
        Axis::of((low, high), pixels, ticks)
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
        let powers = |step: f64| -> Vec<Tick> {
            let tick = |at: f64| Tick {
                at,
                label: (at.rem_euclid(step) == 0.0).then(|| format!("10{}", svg::sup(&plain(at)))),
            };
            steps(low, high, 1.0).map(tick).collect()
        };
        // The mantissas that have a label, where there are not enough powers of ten.
        let mantissas = |labelled: &[f64]| -> Vec<Tick> {
            let mut ticks = Vec::new();
            let minor = (1..10).map(f64::from).filter(|mantissa| !labelled.contains(mantissa));
            let all: Vec<(f64, bool)> = labelled.iter().map(|&mantissa| (mantissa, true)).collect();
            let all: Vec<(f64, bool)> = all.into_iter().chain(minor.map(|mantissa| (mantissa, false))).collect();
            for decade in steps(low - 1.0, high, 1.0).filter(|_| decades <= most) {
                for &(mantissa, is_labelled) in &all {
                    let at = decade + log10(mantissa);
                    let value = mantissa * Real::portable_exp(decade / LOG10_E);
                    if low <= at && at <= high {
                        let label = is_labelled.then(|| svg::number(value));
                        ticks.push(Tick { at, label });
                    }
                }
            }
            ticks
        };
        const FEW: [f64; 3] = [1.0, 2.0, 5.0];
        const SOME: [f64; 5] = [1.0, 2.0, 3.0, 5.0, 7.0];
        const WHOLE: [f64; 9] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0];
        const HALVES: [f64; 10] = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
        let ticks = if decades >= 3.0 {
            let step = (decades / most).ceil().max(1.0);
            let mut ticks = with_labels((1..=step as u32).rev().map(|step| powers(f64::from(step))));
            ticks.extend(
                mantissas(&[])
                    .into_iter()
                    .filter(|tick| (tick.at - tick.at.round()).abs() > 1e-9),
            );
            ticks
        } else {
            let choices: [&[f64]; 4] = [&FEW, &SOME, &WHOLE, &HALVES];
            let enough = if high - low < 0.8 { 1 } else { 0 };
            with_labels(choices[enough..].iter().map(|labelled| mantissas(labelled)))
        };
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

/// The first ticks of which three or more have a label, or the last.
fn with_labels(choices: impl Iterator<Item = Vec<Tick>>) -> Vec<Tick> {
    let mut last = Vec::new();
    for ticks in choices {
        last = ticks;
        if last.iter().filter(|tick| tick.label.is_some()).count() >= 3 {
            break;
        }
    }
    last
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_has_three_labels() {
        let labels = |axis: &Axis| axis.ticks().iter().filter(|tick| tick.label.is_some()).count();
        for pixels in [130.0, 160.0, 200.0, 272.0, 400.0, 818.0] {
            let mut low = 1e-4;
            while low < 1e3 {
                for span in [1e-3, 0.1, 0.7, 1.0, 3.3, 10.0, 77.0] {
                    for ends in [[-low, low], [low, low + span * low], [0.0, low * span]] {
                        let axis = Axis::linear(ends.into_iter(), pixels);
                        assert!(
                            (3..25).contains(&labels(&axis)),
                            "linear {ends:?} {pixels}: {}",
                            labels(&axis)
                        );
                    }
                }
                for decades in [0.0, 0.3, 0.56, 0.9, 1.3, 2.0, 2.7, 3.5, 4.9, 7.0, 11.0] {
                    let axis = Axis::logarithm([log10(low), log10(low) + decades].into_iter(), pixels);
                    assert!(
                        labels(&axis) >= 3,
                        "logarithm {low} {decades} {pixels}: {}",
                        labels(&axis)
                    );
                }
                for width in [1.0, 4.0, 7.0, 19.0, 45.0, 90.0, 170.0, 180.0] {
                    let begin = (low * 1e3) % 60.0 - 90.0;
                    let axis = Axis::angles([begin, begin + width].into_iter(), pixels);
                    assert!(labels(&axis) >= 3, "angles {begin} {width} {pixels}: {}", labels(&axis));
                }
                low *= 1.37;
            }
        }
    }
}
