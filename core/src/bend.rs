//! Steps in the index of refraction that hold further than straight ones.

use crate::fresnel::{Fresnel, Index};
use crate::geometry::{Block, LANES};
use crate::model::NEAR;
use crate::pack::Pack;
use crate::real::Real;

/// A sample nearer to a peak than this tan^2 theta_h sees the same of every slope that a fit can have.
const SPECULAR: f64 = 1e-10;

/// The least slope that a scan sees, over the third least tan theta_h: ln f follows a peak down over many powers of e, so that is far less than 1.
pub(crate) const FINEST: f64 = 0.09;

/// What the rows of weight above 0 tell of the peak of a lobe, with tan^2 theta_h in column `tan2` and cos theta_d in column `cos`: the latter of the nearest, and the third least tan^2 theta_h that is not 0. The nearest are put into `near`, as in [`Seen::near`](crate::model::Seen::near).
#[cfg_attr(target_os = "none", inline(never))]
pub(crate) fn peak<R: Real, const C: usize>(
    blocks: &[Block<R, LANES, C>],
    [tan2, cos]: [usize; 2],
    near: &mut [(R, R); NEAR],
) -> (R, R) {
    let mut cos_theta_d = R::ONE;
    let mut nearest = [R::MAX; 3];
    for block in blocks {
        let (Some(tan2), Some(cos)) = (block.columns.get(tan2), block.columns.get(cos)) else {
            continue;
        };
        for lane in 0..LANES {
            if !(block.weight[lane] > R::ZERO) {
                continue;
            }
            let mut sample = (tan2[lane], block.ln_f[lane]);
            if sample.0 < near[0].0 {
                cos_theta_d = cos[lane];
            }
            for place in near.iter_mut() {
                if sample.0 < place.0 {
                    core::mem::swap(place, &mut sample);
                }
            }
            let mut tan2 = tan2[lane];
            for place in &mut nearest {
                if R::of(SPECULAR) < tan2 && tan2 < *place {
                    core::mem::swap(place, &mut tan2);
                }
            }
        }
    }
    (cos_theta_d, nearest[2])
}

/// F with one index (n, kappa^2) at the peak of each lobe, and if `gradient` its derivatives by n^2 and kappa^2.
#[cfg_attr(target_os = "none", inline(never))]
fn at_peaks<R: Real>([n, kappa2]: [R; 2], peaks: &Pack<R, 2>, gradient: bool) -> [[R; 3]; 2] {
    let index = Index::new(n, kappa2);
    if cfg!(target_os = "none") {
        let mut places = [[R::ZERO; 3]; 2];
        index.reflect_each(&peaks.0, gradient, &mut places);
        return places;
    }
    // Side by side, which takes more instructions and half the time.
    let Fresnel { f, d_n2, d_kappa2 } = index.reflect(*peaks, gradient);
    [0, 1].map(|lobe| [f.0[lobe], d_n2.0[lobe], d_kappa2.0[lobe]])
}

/// F at the peak of each lobe with one index (n, kappa^2), over that with another; 1 where the other has none.
pub(crate) fn ratio<R: Real>(from: [R; 2], to: [R; 2], peaks: &Pack<R, 2>) -> [R; 2] {
    let (from, to) = (at_peaks(from, peaks, false), at_peaks(to, peaks, false));
    core::array::from_fn(|lobe| {
        let ([from, ..], [to, ..]) = (from[lobe], to[lobe]);
        if to > R::TINY { from / to } else { R::ONE }
    })
}

/// What is to be added to n + d n and kappa^2 + d kappa^2 so that Re 1/(n - i kappa) and (Im 1/(n - i kappa))^2 change by what they do to first order; nothing where that would make |n - i kappa| more than four times what it is.
///
/// All of second order, and written so that nothing cancels.
fn straighten<R: Real>([n, kappa2]: [R; 2], [d_n, d_kappa2]: [R; 2]) -> [R; 2] {
    let (one, two, quarter) = (R::ONE, R::of(2.0), R::of(0.25));
    let q = n * n + kappa2;
    // Relative changes of q, of n, and of Re 1/(n - i kappa) = n/q; then the change of 1/q.
    let u = (two * n * d_n + d_kappa2) / q;
    let v = d_n / n;
    let w = v - u;
    let s = (n * w) * (n * w) / q;
    let d = one - u + s;
    if !(w > quarter - one && d > quarter * quarter && kappa2 + d_kappa2 >= two * kappa2 * u) {
        return [R::ZERO; 2];
    }
    let e = u - s;
    [
        n * (u * v - s * (one + v)) / d,
        (two * d_kappa2 * u - (kappa2 + d_kappa2) * (two * s + e * e)) / (d * d),
    ]
}

/// Moves n and kappa where 1/(n - i kappa) goes straight, and then keeps rho F at the peak of each lobe where the linear model puts it.
///
/// F at large |n - i kappa| is a function of that inverse, nearly linear; in n and kappa the way there and back is long and curved.
/// And n and kappa change F at the peak, and hardly anything else that a scan sees.
/// `n`, `kappa2` and the weights are places of coordinates, beyond the last for what is not there; each weight comes with the geometry of its lobe.
pub(crate) fn bend<R: Real, const P: usize>(
    x: &[R; P],
    step: &[R; P],
    to: [R; P],
    [n, kappa2]: [usize; 2],
    weights: &[(usize, usize)],
    peaks: &Pack<R, 2>,
) -> [R; P] {
    let at = |x: &[R; P], place: usize, absent: R| x.get(place).copied().unwrap_or(absent);
    if n >= P {
        return to;
    }
    let (old_n, old_kappa2) = (at(x, n, R::ONE), at(x, kappa2, R::ZERO));
    let (d_n, d_kappa2) = (at(step, n, R::ZERO), at(step, kappa2, R::ZERO));
    let mut bent = to;
    let more = straighten([old_n, old_kappa2], [d_n, d_kappa2]);
    if let Some(n) = bent.get_mut(n) {
        *n += more[0];
    }
    if let Some(kappa2) = bent.get_mut(kappa2) {
        *kappa2 += more[1];
    }
    let from = at_peaks([old_n, old_kappa2], peaks, true);
    let (new_n, new_kappa2) = (
        at(&bent, n, R::ONE).max(R::ONE),
        at(&bent, kappa2, R::ZERO).max(R::ZERO),
    );
    let there = at_peaks([new_n, new_kappa2], peaks, false);
    let d_n2 = R::of(2.0) * old_n * d_n;
    for &(place, lobe) in weights {
        // So the compiler sees that no index is out of range.
        let lobe = lobe % 2;
        let Some(rho) = bent.get_mut(place) else {
            continue;
        };
        let ([f, by_n2, by_kappa2], [f_there, ..]) = (from[lobe], there[lobe]);
        let d_f = by_n2 * d_n2 + by_kappa2 * d_kappa2;
        let amplitude = f * at(&to, place, R::ZERO) + at(x, place, R::ZERO) * d_f;
        if amplitude > R::ZERO && f_there > R::TINY {
            *rho = amplitude / f_there;
        }
    }
    bent
}
