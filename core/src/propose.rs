//! Where a candidate is: everything but its weights.

use crate::lm::Bounds;
use crate::model::{NEAR, Parameter, Role, Seen};
use crate::real::Real;
use crate::search::{BANDS, Region};
use crate::start;

/// (n, kappa) of the first variations of a point, in groups: a minimum has neighbours in these regimes. The squares of kappa are exact in `f32`.
pub(crate) const INDICES: [(f64, f64); 14] = [
    // F hardly depends on the angle.
    (100.0, 0.0),
    (100.0, 100.0),
    (1.0, 100.0),
    (1.0, 15.0),
    (10.0, 0.0),
    // Dielectrics; the first stands for one that [`crate::model::Model::fade`] moves.
    (1.0, 0.0),
    (1.2, 0.0),
    (2.0, 0.0),
    (3.5, 0.0),
    // Metals.
    (1.0, 5.0),
    (1.0, 2.0),
    (1.0, 0.5),
    (1.5, 1.5),
    (4.0, 4.0),
];
/// Where these groups begin and end.
pub(crate) const GROUPS: [(u32, u32); 3] = [(0, 5), (5, 9), (9, INDICES.len() as u32)];
/// The place of that.
const FADING: u64 = GROUPS[1].0 as u64;
/// Where that begins: 1 / kappa^2, or n where kappa cannot be so large.
const FADE_FROM: (u16, f64) = (10, 1.3);
/// Shares of the regimes of the index: kappa = 0, n = 1, both in the corner where F vanishes; the rest has both.
const REGIMES: [f64; 3] = [0.3, 0.25, 0.1];
/// Share of the candidates that have slopes from pairs of samples.
const PAIRS: f64 = 0.25;
/// Independent numbers of a candidate, beside its point in an even sequence.
const NUMBERS: usize = 8;

/// What proposals need to know of the parameters of a model.
pub(crate) struct Shapes<R: Real, const P: usize> {
    pub roles: &'static [Role; P],
    /// Is there an index of refraction among them?
    pub has_index: bool,
    /// See [`Parameter::spread`].
    pub spread: &'static [[R; 2]; P],
}

/// See [`Real::table`].
pub(crate) const fn single<const N: usize>(pairs: &[(f64, f64); N]) -> [[f32; 2]; N] {
    let mut table = [[0.0; 2]; N];
    let mut k = 0;
    while k < N {
        table[k] = [pairs[k].0 as f32, pairs[k].1 as f32];
        k += 1;
    }
    table
}

/// See [`Real::table`].
pub(crate) const fn double<const N: usize>(pairs: &[(f64, f64); N]) -> [[f64; 2]; N] {
    let mut table = [[0.0; 2]; N];
    let mut k = 0;
    while k < N {
        table[k] = [pairs[k].0, pairs[k].1];
        k += 1;
    }
    table
}

/// Where candidates of some parameters are spread.
pub(crate) const fn spreads<const P: usize>(parameters: &[Parameter; P]) -> [(f64, f64); P] {
    let mut spreads = [(0.0, 0.0); P];
    let mut k = 0;
    while k < P {
        spreads[k] = parameters[k].spread;
        k += 1;
    }
    spreads
}

/// The roles of some parameters.
pub(crate) const fn roles<const P: usize>(parameters: &[Parameter; P]) -> [Role; P] {
    let mut roles = [Role::Shape; P];
    let mut k = 0;
    while k < P {
        roles[k] = parameters[k].role;
        k += 1;
    }
    roles
}

/// Sets what is no weight to candidate `i` of the sequence of `seed`; true if it is meant for [`crate::model::Model::fade`].
pub(crate) fn shapes<R: Real, const P: usize>(
    x: &mut [R; P],
    shapes: &Shapes<R, P>,
    bounds: &Bounds<R, P>,
    (seed, i): (u64, u64),
    seen: &Seen<R>,
    region: Region<R, P>,
) -> bool {
    // The first three take an even sequence; points of one in more dimensions would be further apart in these.
    let even = start::even::<R>(seed, i);
    let own = start::unit::<R, P>(seed, i);
    let numbers = start::unit::<R, NUMBERS>(seed ^ 0x55, i);
    let mut of_index = [numbers[6], numbers[7]];
    let (mut shapes_so_far, mut slopes) = (0, 0);
    // By index, so that the compiler sees that none is out of range.
    for k in 0..P {
        let (role, among) = (shapes.roles[k], &shapes.spread[k]);
        if role == Role::Weight {
            continue;
        }
        let range = (bounds.lower[k], bounds.upper[k]);
        let mut u = even.get(shapes_so_far).copied().unwrap_or(own[k]);
        shapes_so_far += 1;
        match role {
            Role::Index => of_index[0] = u,
            Role::Absorption => of_index[1] = u,
            _ => {
                let mut finest = R::ZERO;
                if role == Role::Slope {
                    finest = seen.finest;
                    u = in_band(u, region, slopes);
                    slopes += 1;
                }
                let spread = between(among, range, finest, u);
                let near = like(region).map_or(spread, |like| like[k]);
                x[k] = if role == Role::Slope {
                    slope(near, seen, &numbers, region)
                } else {
                    near
                };
            }
        }
    }
    if !shapes.has_index {
        if let Region::Index(like) = region {
            vary(x, shapes, bounds, like, &own);
        }
        return false;
    }
    index(x, shapes, bounds, of_index, i, region)
}

/// The point that a region is about.
fn like<'a, R, const P: usize>(region: Region<'a, R, P>) -> Option<&'a [R; P]> {
    match region {
        Region::Index(like) | Region::Slopes(like) => Some(like),
        _ => None,
    }
}

/// The place within the whole range from that within the band; only the first slope is kept to it.
fn in_band<R: Real, const P: usize>(u: R, region: Region<R, P>, slopes: usize) -> R {
    match region {
        Region::Band(band) | Region::Corner(band) if slopes == 0 => (R::from(band as u16) + u) / R::from(BANDS as u16),
        _ => u,
    }
}

/// A slope: `near`, or what a pair of samples tells.
fn slope<R: Real, const P: usize>(near: R, seen: &Seen<R>, numbers: &[R; NUMBERS], region: Region<R, P>) -> R {
    let varies = matches!(region, Region::Slopes(_));
    if (varies || matches!(region, Region::Everywhere) && numbers[4] < R::of(PAIRS))
        && let Some(slope) = pair(seen, numbers)
    {
        return slope;
    }
    if varies {
        near * (R::of(3.0) * (numbers[3] - R::of(0.5))).portable_exp()
    } else {
        near
    }
}

/// The slope m of a peak of which two samples see nothing else: m^2 is the difference of tan^2 theta_h over that of ln f.
#[cfg_attr(target_os = "none", inline(never))]
fn pair<R: Real>(seen: &Seen<R>, &[lobe, first, second, ..]: &[R; NUMBERS]) -> Option<R> {
    let near = &seen.near[usize::from(lobe > R::of(0.7))];
    // The first is more often one of the nearest.
    let pick = |u: R| near[usize::from((u * R::from(NEAR as u16)).whole()) % NEAR];
    let (a, b) = (pick(first * first), pick(second));
    let m2 = (b.0 - a.0) / (a.1 - b.1);
    (m2 > R::ZERO && m2 <= R::MAX).then(|| m2.sqrt())
}

/// A value of a parameter at `u` of its range, from 0 to 1; evenly in the logarithm if it is above 0.
fn between<R: Real>(&[least, most]: &[R; 2], (lower, upper): (R, R), finest: R, u: R) -> R {
    let least = least.max(finest);
    let from = lower.max(least).min(upper);
    let to = upper.min(most).max(lower);
    if from > R::ZERO {
        log_between(from, to, u)
    } else {
        from + (to - from) * u
    }
}

/// Sets n and kappa^2.
#[cfg_attr(target_os = "none", inline(never))]
fn index<R: Real, const P: usize>(
    x: &mut [R; P],
    shapes: &Shapes<R, P>,
    bounds: &Bounds<R, P>,
    [u, regime]: [R; 2],
    i: u64,
    region: Region<R, P>,
) -> bool {
    // Evenly in 1/n and in 1/(1 + kappa): F at large n and kappa is a function of the inverse, nearly linear.
    let (n_alone, kappa_alone) = (R::ONE / (R::ONE - R::of(0.99) * u), u / (R::ONE - R::of(0.99) * u));
    let two = R::of(REGIMES[0]) + R::of(REGIMES[1]);
    let steps = [R::of(REGIMES[0]), two, two + R::of(REGIMES[2])];
    let (mut n, mut kappa2) = (None, None);
    let mut fades = false;
    let indices = R::table(const { &single(&INDICES) }, const { &double(&INDICES) });
    let listed = usize::try_from(i).ok().and_then(|i| indices.get(i));
    match (region, listed) {
        (Region::Index(_), Some(&[listed_n, listed_kappa])) => {
            (n, kappa2) = (Some(listed_n), Some(listed_kappa * listed_kappa));
            fades = i == FADING;
        }
        (Region::Slopes(_), _) if i % 4 == 1 => fades = true,
        (Region::Corner(_), _) => fades = true,
        _ if regime < steps[0] => (n, kappa2) = (Some(n_alone), Some(R::ZERO)),
        _ if regime < steps[1] => (n, kappa2) = (Some(R::ONE), Some(kappa_alone * kappa_alone)),
        _ if regime < steps[2] => fades = true,
        _ => {}
    }
    let rest = (regime - steps[2]) / (R::ONE - steps[2]);
    for k in 0..P {
        let (lower, upper) = (bounds.lower[k], bounds.upper[k]);
        let (chosen, u, fading) = match shapes.roles[k] {
            Role::Index => (n, u, R::ONE),
            Role::Absorption => (kappa2, rest, R::ONE / R::from(FADE_FROM.0)),
            _ => continue,
        };
        x[k] = match (region, if fades { Some(fading) } else { chosen }) {
            (Region::Slopes(like), _) if i.is_multiple_of(2) => like[k],
            (_, Some(value)) => value.max(lower).min(upper),
            _ => between(&shapes.spread[k], (lower, upper), R::ZERO, u.max(R::ZERO)),
        };
    }
    if fades {
        fade_by_n(x, shapes.roles, bounds);
    }
    fades
}

/// Where kappa cannot be what a fading index begins with, n is.
fn fade_by_n<R: Real, const P: usize>(x: &mut [R; P], roles: &[Role; P], bounds: &Bounds<R, P>) {
    let absorbs = (0..P).any(|k| roles[k] == Role::Absorption && x[k] >= R::ONE / R::from(FADE_FROM.0));
    for k in 0..P {
        if roles[k] == Role::Index && !absorbs {
            x[k] = R::of(FADE_FROM.1).max(bounds.lower[k]).min(bounds.upper[k]);
        }
    }
}

/// Without an index, a minimum has neighbours anywhere: everything stays within a factor of e.
fn vary<R: Real, const P: usize>(
    x: &mut [R; P],
    shapes: &Shapes<R, P>,
    bounds: &Bounds<R, P>,
    like: &[R; P],
    own: &[R; P],
) {
    for k in 0..P {
        if shapes.roles[k] != Role::Weight {
            let factor = (own[k] + own[k] - R::ONE).portable_exp();
            x[k] = (like[k] * factor).max(bounds.lower[k]).min(bounds.upper[k]);
        }
    }
}

/// Between two positive numbers, evenly in the logarithm.
fn log_between<R: Real>(lower: R, upper: R, u: R) -> R {
    if !(lower < upper) {
        return lower;
    }
    let (a, b) = (lower.portable_ln(), upper.portable_ln());
    (a + (b - a) * u).portable_exp()
}
