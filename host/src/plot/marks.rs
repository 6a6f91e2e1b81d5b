//! Which samples are drawn, and where: those in the plane of incidence over the scattering angle, others over their angle from the specular direction.

use std::collections::BTreeMap;

use brdfit_core::geometry::Sample;
use std::f64::consts::LOG10_E;

use super::axis::Axis;
use super::curve::LnF;
use super::frame::{PANELS, POINTS, RIGHT, WIDTH, degrees};
use super::svg;
use crate::input::plane;

/// What is drawn of a scan.
#[derive(Clone, Copy)]
pub struct Data<'a> {
    /// The samples that were fitted.
    pub samples: &'a [Sample<f64>],
    /// The samples that were left out although they have a place in the picture.
    pub left_out: &'a [Sample<f64>],
    /// How many were left out in all.
    pub left_out_count: usize,
}

/// The samples of one incident angle.
#[derive(Default)]
pub struct Panel {
    /// Radians.
    pub theta_i: f64,
    /// Angle in degrees and log10 of the BRDF.
    pub measured: Vec<(f64, f64)>,
    /// The same of what was left out.
    pub left_out: Vec<(f64, f64)>,
    /// The measured samples.
    samples: Vec<Sample<f64>>,
}

impl Panel {
    /// Where a model has the measured samples: angle in degrees and log10 of the BRDF.
    pub fn model(&self, ln_f: &LnF) -> Vec<(f64, f64)> {
        let each = self.samples.iter().zip(&self.measured);
        each.filter_map(|(sample, point)| Some((point.0, ln_f(sample)? * LOG10_E)))
            .collect()
    }

    /// The measured samples, in the order of their points.
    pub fn samples(&self) -> &[Sample<f64>] {
        &self.samples
    }
}

/// Panels that share their axes.
pub struct Block {
    /// True over signed theta_s, false over the angle from the specular direction.
    pub in_plane: bool,
    panels: Vec<Panel>,
}

impl Block {
    /// The panels that are drawn: of very many an even choice.
    pub fn shown(&self) -> impl Iterator<Item = &Panel> {
        self.panels.iter().step_by(self.panels.len().div_ceil(PANELS).max(1))
    }

    /// Samples in all panels.
    pub fn samples(&self) -> usize {
        self.panels.iter().map(|panel| panel.measured.len()).sum()
    }

    /// Points of a panel at most.
    pub fn limit(&self) -> usize {
        POINTS / self.shown().count().max(1)
    }

    /// The horizontal axis.
    pub fn axis(&self, pixels: f64) -> Axis {
        Axis::angles(
            self.shown().flat_map(|panel| &panel.measured).map(|point| point.0),
            pixels,
        )
    }

    /// What stands above a panel.
    pub fn caption(&self, panel: &Panel) -> String {
        let apart = if self.in_plane { "" } else { ", out of plane" };
        format!("{} = {}°{apart}", svg::sub("θ", "i"), degrees(panel.theta_i))
    }

    /// What stands below the panels.
    pub fn label(&self) -> String {
        if self.in_plane {
            format!("scattering angle {} (degrees, positive forward)", svg::sub("θ", "s"))
        } else {
            "out of the plane of incidence: angle from the specular direction (degrees)".to_string()
        }
    }
}

/// All blocks of a picture.
pub struct Marks {
    blocks: Vec<Block>,
    angles: usize,
}

impl Marks {
    /// Sorts the samples, by incident angles that are equal to a hundredth of a degree.
    pub fn of(data: &Data) -> Marks {
        let mut panels: BTreeMap<(bool, i64), Panel> = BTreeMap::new();
        let mut add = |sample: &Sample<f64>, is_left_out: bool| {
            let signed = plane::signed_theta_s(sample);
            let key = (signed.is_none(), (sample.theta_i.to_degrees() * 100.0).round() as i64);
            let panel = panels.entry(key).or_default();
            panel.theta_i = sample.theta_i;
            let point = (
                signed.unwrap_or_else(|| plane::from_specular(sample)),
                svg::log10(sample.brdf),
            );
            if is_left_out {
                panel.left_out.push(point);
            } else {
                panel.measured.push(point);
                panel.samples.push(*sample);
            }
        };
        data.samples.iter().for_each(|sample| add(sample, false));
        data.left_out.iter().for_each(|sample| add(sample, true));
        let mut blocks: Vec<Block> = Vec::new();
        for ((apart, _), panel) in panels {
            match blocks.last_mut().filter(|block| block.in_plane != apart) {
                Some(block) => block.panels.push(panel),
                None => blocks.push(Block {
                    in_plane: !apart,
                    panels: vec![panel],
                }),
            }
        }
        if blocks.is_empty() {
            blocks.push(Block {
                in_plane: true,
                panels: Vec::new(),
            });
        }
        Marks {
            angles: blocks.iter().map(|block| block.panels.len()).max().unwrap_or(0),
            blocks,
        }
    }

    /// Those in plane, then the others.
    pub fn blocks(&self) -> impl Iterator<Item = &Block> + Clone {
        self.blocks.iter()
    }

    /// Says in the upper right corner what is not drawn.
    pub fn note(&self, out: &mut String, drawn: usize, total: usize) {
        let shown = self.blocks().map(|block| block.shown().count()).max().unwrap_or(0);
        let mut notes = Vec::new();
        if shown < self.angles {
            notes.push(format!("{shown} of {} incident angles", self.angles));
        }
        if drawn < total {
            notes.push(format!("{drawn} of {total} samples"));
        }
        if !notes.is_empty() {
            let note = format!("shown: {}", notes.join(", "));
            svg::text(out, WIDTH - RIGHT, 26.0, "text-anchor=\"end\"", &note);
        }
    }
}

/// At most `limit` of some points in pixels: the highest and the lowest of each part of the horizontal axis, so that no peak is lost.
pub fn thinned(mut points: Vec<(f64, f64)>, limit: usize) -> Vec<(f64, f64)> {
    if points.len() <= limit.max(2) {
        return points;
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let parts = (limit / 2).max(1);
    let (low, high) = (points[0].0, points[points.len() - 1].0);
    let part = |point: &(f64, f64)| ((point.0 - low) / (high - low).max(f64::MIN_POSITIVE) * parts as f64) as usize;
    let mut kept = Vec::with_capacity(2 * parts);
    for group in points.chunk_by(|a, b| part(a).min(parts - 1) == part(b).min(parts - 1)) {
        let by = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let (highest, lowest) = (group.iter().min_by(by), group.iter().max_by(by));
        kept.extend(highest);
        kept.extend(lowest.filter(|_| group.len() > 1));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_peaks() {
        let scan: Vec<(f64, f64)> = (0..10_000)
            .map(|k| {
                (
                    f64::from(k) / 10.0,
                    if k == 7531 { -50.0 } else { 1.0 + f64::from(k % 7) },
                )
            })
            .collect();
        let kept = thinned(scan.clone(), 300);
        assert!(kept.len() <= 300 && kept.contains(&scan[7531]));
        assert_eq!(thinned(scan[..200].to_vec(), 300), scan[..200]);
        assert!(thinned(vec![(1.0, 2.0); 50], 10).len() <= 10);
    }

    #[test]
    fn out_of_plane_is_apart() {
        let at = |delta_phi: f64| Sample {
            delta_phi,
            ..Sample::in_plane(0.5, 0.4, 0.1)
        };
        let samples = [at(std::f64::consts::PI), at(0.0), at(1.0)];
        let data = Data {
            samples: &samples,
            left_out: &[at(0.0)],
            left_out_count: 1,
        };
        let marks = Marks::of(&data);
        let counts: Vec<_> = marks
            .blocks()
            .map(|block| {
                let panel = block.shown().next().unwrap();
                (block.in_plane, panel.measured.len(), panel.left_out.len())
            })
            .collect();
        assert_eq!(counts, [(true, 2, 1), (false, 1, 0)]);
    }
}
