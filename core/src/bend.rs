//! Steps in the index of refraction that hold further than straight ones.

use crate::fresnel::Index;
use crate::geometry::{Block, LANES};
use crate::pack::Pack;
use crate::real::Real;

/// Of the rows of weight above 0: the third least tan^2 theta_h, in column `tan2`, and cos theta_d, in column `cos`, nearest to the peak.
pub(crate) fn peak<R: Real, const C: usize>(blocks: &[Block<R, LANES, C>], tan2: usize, cos: usize) -> (R, R) {
    let mut cos_theta_d = R::ONE;
    let mut nearest = [R::MAX; 3];
    for block in blocks {
        let (Some(tan2), Some(cos)) = (block.columns.get(tan2), block.columns.get(cos)) else {
            continue;
        };
        for (&weight, (&tan2, &cos)) in block.weight.iter().zip(tan2.iter().zip(cos)) {
            let mut tan2 = tan2;
            if !(weight > R::ZERO) {
                continue;
            }
            if tan2 < nearest[0] {
                cos_theta_d = cos;
            }
            for place in &mut nearest {
                if tan2 < *place {
                    core::mem::swap(place, &mut tan2);
                }
            }
        }
    }
    (nearest[2], cos_theta_d)
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
/// `n`, `kappa2` and the weights are places of coordinates; each weight comes with the geometry of its lobe.
pub(crate) fn bend<R: Real, const P: usize>(
    x: &[R; P],
    step: &[R; P],
    to: [R; P],
    [n, kappa2]: [Option<usize>; 2],
    weights: impl IntoIterator<Item = (Option<usize>, usize)>,
    peaks: Pack<R, 2>,
) -> [R; P] {
    let at = |x: &[R; P], place: Option<usize>, absent: R| place.and_then(|k| x.get(k).copied()).unwrap_or(absent);
    if n.is_none() {
        return to;
    }
    let (old_n, old_kappa2) = (at(x, n, R::ONE), at(x, kappa2, R::ZERO));
    let (d_n, d_kappa2) = (at(step, n, R::ZERO), at(step, kappa2, R::ZERO));
    let mut bent = to;
    for (place, more) in [n, kappa2]
        .into_iter()
        .zip(straighten([old_n, old_kappa2], [d_n, d_kappa2]))
    {
        if let Some(value) = place.and_then(|k| bent.get_mut(k)) {
            *value += more;
        }
    }
    let from = Index::new(old_n, old_kappa2).reflect(peaks, true);
    let (new_n, new_kappa2) = (
        at(&bent, n, R::ONE).max(R::ONE),
        at(&bent, kappa2, R::ZERO).max(R::ZERO),
    );
    let there = Index::new(new_n, new_kappa2).reflect(peaks, false);
    let d_n2 = R::of(2.0) * old_n * d_n;
    for (place, lobe) in weights {
        // So the compiler sees that no index is out of range.
        let lobe = lobe % 2;
        let Some(rho) = place.and_then(|k| bent.get_mut(k)) else {
            continue;
        };
        let d_f = from.d_n2.0[lobe] * d_n2 + from.d_kappa2.0[lobe] * d_kappa2;
        let amplitude = from.f.0[lobe] * at(&to, place, R::ZERO) + at(x, place, R::ZERO) * d_f;
        if amplitude > R::ZERO && there.f.0[lobe] > R::TINY {
            *rho = amplitude / there.f.0[lobe];
        }
    }
    bent
}
