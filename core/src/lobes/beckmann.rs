use super::{Distribution, Shadowing};
use crate::pack::Pack;
use crate::real::Real;

/// Beckmann and Spizzichino 1963, Eq. 8: `g(t) = exp(-t)`.
#[derive(Clone, Copy, Debug)]
pub struct Beckmann;

/// From here on no facet is hidden, in the approximation of [`Beckmann::visible`].
const ALL_VISIBLE: f64 = 1.6;

impl Distribution for Beckmann {
    const UNDERFLOWS: bool = true;

    #[inline(always)]
    fn shape<R: Real, const K: usize>(t: Pack<R, K>, shift: Pack<R, K>, _q: R) -> Pack<R, K> {
        let exponent = (t.map(|t| -t) - shift).map(|x| x.min(R::MOST_EXPONENT));
        // What is too low for it is cut.
        exponent.zip(
            R::exp_within(exponent),
            |x, e| if x < R::LEAST_EXPONENT { R::ZERO } else { e },
        )
    }

    #[inline(always)]
    fn fall<R: Real, const K: usize>(t: Pack<R, K>, _q: R) -> Pack<R, K> {
        t
    }
}

impl Shadowing for Beckmann {
    /// Walter, Marschner, Li and Torrance 2007, section 5.2: with `a = 1 / (m tan theta)`, `(3.535 a + 2.181 a^2) / (1 + 2.276 a + 2.577 a^2)` below `a = 1.6` and 1 above.
    #[inline(always)]
    fn visible<R: Real, const K: usize>(a2: Pack<R, K>) -> (Pack<R, K>, Pack<R, K>) {
        let limit = R::of(ALL_VISIBLE);
        let a = a2.map(|a2| a2.max(R::MIN_POSITIVE)).rsqrt();
        let hides = a.map(|a| if a < limit { R::ONE } else { R::ZERO });
        let a = a.map(|a| a.min(limit));
        let above = a * (a * R::of(2.181) + R::of(3.535));
        let below = a * (a * R::of(2.577) + R::of(2.276)) + R::ONE;
        let d_above = a * R::of(2.0 * 2.181) + R::of(3.535);
        let d_below = a * R::of(2.0 * 2.577) + R::of(2.276);
        let share = above / below;
        let slope = (d_above - share * d_below) / below;
        let visible = share.zip(hides, |share, hides| if hides > R::ZERO { share } else { R::ONE });
        (visible, slope * a * hides * -R::ONE)
    }
}
