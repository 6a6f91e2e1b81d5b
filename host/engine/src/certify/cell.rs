//! How F depends on the angle over a rectangle of indices: phi, the logarithm of F over its value at the reference angle of its lobe.

use super::interval::{Interval, up};
use super::jet::Jet;
use super::reflect::Indices;
use super::scene::Scene;

/// phi near the middle of a cell: `value + a da + b db + (aa da^2 + 2 ab da db + bb db^2) / 2`, off by at most `error + (err_aa da^2 + 2 err_ab |da db| + err_bb db^2) / 2`.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Shape {
    pub value: f64,
    pub a: f64,
    pub b: f64,
    pub aa: f64,
    pub ab: f64,
    pub bb: f64,
    pub error: f64,
    pub err_aa: f64,
    pub err_ab: f64,
    pub err_bb: f64,
    /// The least and the largest value in the cell.
    pub range: [f64; 2],
}

/// What a rectangle of a and b fixes.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub middle: [f64; 2],
    /// Of the surface and the volume lobe, cosine by cosine.
    tables: [Vec<Shape>; 2],
    /// ln of F at the reference angle of each lobe.
    pub ln_f: [Interval; 2],
}

impl Cell {
    pub fn new(scene: &Scene, lo: [f64; 2], hi: [f64; 2]) -> Self {
        let sides = [0, 1].map(|k| Interval::new(lo[k], hi[k]));
        let middle = sides.map(Interval::middle);
        let whole = Indices::new(sides[0], sides[1]);
        let centre = Indices::new(Interval::point(middle[0]), Interval::point(middle[1]));
        let cosines = &scene.cosines;
        let middles: Vec<Jet> = cosines.iter().map(|&c| centre.psi(c)).collect();
        let nodes: Vec<Jet> = scene.nodes.iter().map(|&k| whole.psi(cosines[k])).collect();
        let slope = |k: &[usize]| whole.psi_slope(Interval::new(cosines[k[0]], cosines[k[1]]));
        let slopes: Vec<Jet> = scene.nodes.windows(2).map(slope).collect();
        let reach = [0, 1].map(|k| sides[k].far_from(middle[k]));
        let mut ln_f = [Interval::point(0.0); 2];
        let tables = [0, 1].map(|lobe| {
            let from = scene.reference[lobe];
            let start = scene.nodes.partition_point(|&node| node < from);
            if let Some(node) = nodes.get(start) {
                ln_f[lobe] = whole.ln_f(node);
            }
            let over = differences(scene, &nodes, &slopes, start);
            let shape = |k: usize| shape(&(middles[k] - middles[from]), &over[k], reach);
            (0..cosines.len()).map(shape).collect()
        });
        Cell { middle, tables, ln_f }
    }

    /// How phi of a lobe depends on the indices at a cosine.
    #[inline(always)]
    pub fn shape(&self, lobe: usize, cosine: usize) -> &Shape {
        &self.tables[lobe][cosine]
    }
}

/// Enclosures of psi less that at the node `start`, of every cosine: from node to node by its slope, and by the plain difference.
fn differences(scene: &Scene, nodes: &[Jet], slopes: &[Jet], start: usize) -> Vec<Jet> {
    let cosines = &scene.cosines;
    let step = |from: usize, to: usize| Interval::point(cosines[to]) - Interval::point(cosines[from]);
    let mut chain = vec![Jet::constant(Interval::point(0.0)); nodes.len()];
    for k in start + 1..nodes.len() {
        let next = chain[k - 1] + slopes[k - 1] * step(scene.nodes[k - 1], scene.nodes[k]);
        chain[k] = next.and(nodes[k] - nodes[start]);
    }
    for k in (0..start).rev() {
        let next = chain[k + 1] + slopes[k] * step(scene.nodes[k + 1], scene.nodes[k]);
        chain[k] = next.and(nodes[k] - nodes[start]);
    }
    let mut node = 0;
    let each = (0..cosines.len()).map(|k| {
        while node + 1 < scene.nodes.len() && scene.nodes[node + 1] <= k {
            node += 1;
        }
        let left = scene.nodes[node];
        if left == k {
            return chain[node];
        }
        let right = scene.nodes[node + 1];
        let from_left = chain[node] + slopes[node] * step(left, k);
        from_left.and(chain[node + 1] + slopes[node] * step(right, k))
    });
    each.collect()
}

/// |phi| is below this at every cosine above 2e-16, which [`brdfit_core::geometry::Geometry::new`] warrants.
const FAR: f64 = 1e3;

/// From enclosures of phi in the middle and over the whole of a cell.
fn shape(at: &Jet, over: &Jet, reach: [f64; 2]) -> Shape {
    let [ra, rb] = reach;
    let (value, a, b) = (at.value.middle(), at.a.middle(), at.b.middle());
    let (aa, ab, bb) = (at.aa.middle(), at.ab.middle(), at.bb.middle());
    let (err_aa, err_ab, err_bb) = (over.aa.far_from(aa), over.ab.far_from(ab), over.bb.far_from(bb));
    let error = up(up(at.value.far_from(value) + at.a.far_from(a) * ra) + at.b.far_from(b) * rb);
    // The mean value theorem, and the plain enclosure.
    let span = |x: Interval, reach: f64| x * Interval::new(-reach, reach);
    let mean = at.value + span(over.a, ra) + span(over.b, rb);
    let range = over.value.and(mean).and(Interval::new(-FAR, FAR));
    let second = error + 0.5 * (err_aa * ra * ra + 2.0 * err_ab * ra * rb + err_bb * rb * rb);
    let middle = range.middle();
    let plain = range.far_from(middle);
    let range = [range.lo, range.hi];
    // Where a cell is too wide for derivatives, a constant is nearer; and where they have no bound.
    if second < plain {
        Shape {
            value,
            a,
            b,
            aa,
            ab,
            bb,
            error,
            err_aa,
            err_ab,
            err_bb,
            range,
        }
    } else {
        Shape {
            value: middle,
            error: plain,
            range,
            ..Shape::default()
        }
    }
}
