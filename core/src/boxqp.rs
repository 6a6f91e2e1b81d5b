//! The linear algebra of a bounded step: a strictly convex quadratic over a box, by active sets.

use crate::real::Real;

/// Minimises `g' d + d' a d / 2` over `lower <= d <= upper`, where `lower <= 0 <= upper`.
///
/// `a` is symmetric and positive definite; a pivot that rounding makes too small leaves its variable where it is.
/// A variable that ends on a bound is exactly equal to it.
pub(crate) fn minimize<R: Real, const P: usize>(a: &[[R; P]; P], g: &[R; P], lower: &[R; P], upper: &[R; P]) -> [R; P] {
    let mut d = [R::ZERO; P];
    // A variable that is not free is on a bound.
    let mut free = [false; P];
    for i in 0..P {
        let pushed = lower[i] >= R::ZERO && g[i] >= R::ZERO || upper[i] <= R::ZERO && g[i] <= R::ZERO;
        free[i] = !(pushed || lower[i] >= upper[i]);
    }
    // Each round fixes or frees one variable; the quadratic falls at each, so no set comes twice, and few are ever needed.
    for _ in 0..4 * P {
        let target = solve_free(a, g, &d, &free);
        // The longest part of the way to the target that stays in the box; what is not free is there.
        let (mut part, mut blocking, mut bound) = (R::ONE, P, R::ZERO);
        for i in 0..P {
            let way = target[i] - d[i];
            let end = if way < R::ZERO { lower[i] } else { upper[i] };
            let room = end - d[i];
            if way != R::ZERO && room.abs() < part * way.abs() {
                (part, blocking, bound) = (room / way, i, end);
            }
        }
        for i in 0..P {
            let to = d[i] + part * (target[i] - d[i]);
            d[i] = to.max(lower[i]).min(upper[i]);
        }
        if blocking < P {
            (d[blocking], free[blocking]) = (bound, false);
            continue;
        }
        // At the minimum over the free variables: free the bound one that pulls inwards most, if any does.
        let (mut strongest, mut release) = (R::ZERO, P);
        for i in 0..P {
            if free[i] || lower[i] >= upper[i] {
                continue;
            }
            let mut slope = g[i];
            for j in 0..P {
                slope += a[i][j] * d[j];
            }
            let inwards = if d[i] == lower[i] { -slope } else { slope };
            let pull = inwards * inwards / a[i][i].max(R::MIN_POSITIVE);
            if inwards > R::ZERO && pull > strongest {
                (strongest, release) = (pull, i);
            }
        }
        if release >= P {
            break;
        }
        free[release] = true;
    }
    d
}

/// The minimum over the free variables with the others held at `d`: LDL' of the rows and columns that are free.
fn solve_free<R: Real, const P: usize>(a: &[[R; P]; P], g: &[R; P], d: &[R; P], free: &[bool; P]) -> [R; P] {
    // First that part of `a`, then L times the pivots; what is not free has zeros, and so no pivot.
    let mut l = [[R::ZERO; P]; P];
    let mut inverse_pivot = [R::ZERO; P];
    let mut x = *d;
    let mut rhs = [R::ZERO; P];
    for i in 0..P {
        if free[i] {
            rhs[i] = -g[i];
            for j in 0..P {
                if free[j] {
                    l[i][j] = a[i][j];
                } else {
                    rhs[i] -= a[i][j] * d[j];
                }
            }
        }
    }
    for j in 0..P {
        let diagonal = l[j][j];
        let pivot = less_products(diagonal, &l[j], &l[j], &inverse_pivot, j);
        // A pivot of rounding noise would send the step anywhere.
        if !(pivot > R::EPSILON * diagonal) {
            continue;
        }
        for i in j + 1..P {
            l[i][j] = less_products(l[i][j], &l[i], &l[j], &inverse_pivot, j);
        }
        rhs[j] = less_products(rhs[j], &l[j], &inverse_pivot, &rhs, j);
        inverse_pivot[j] = R::ONE / pivot;
    }
    for j in (0..P).rev() {
        if inverse_pivot[j] != R::ZERO {
            let mut sum = rhs[j];
            for i in j + 1..P {
                if inverse_pivot[i] != R::ZERO {
                    sum -= l[i][j] * x[i];
                }
            }
            x[j] = sum * inverse_pivot[j];
        }
    }
    x
}

/// A number less the products of the first `count` of three lists.
#[cfg_attr(target_os = "none", inline(never))]
fn less_products<R: Real, const P: usize>(from: R, a: &[R; P], b: &[R; P], c: &[R; P], count: usize) -> R {
    let mut sum = from;
    for k in 0..count.min(P) {
        sum -= a[k] * b[k] * c[k];
    }
    sum
}
