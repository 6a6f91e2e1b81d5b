//! The linear algebra of a bounded step: a strictly convex quadratic over a box, by active sets.

use crate::real::Real;

#[derive(Clone, Copy, PartialEq)]
enum At {
    Inside,
    Lower,
    Upper,
}

/// Minimises `g' d + d' a d / 2` over `lower <= d <= upper`, where `lower <= 0 <= upper`.
///
/// `a` is symmetric and positive definite; a pivot that rounding makes too small leaves its variable where it is.
/// A variable that ends on a bound is exactly equal to it.
pub(crate) fn minimize<R: Real, const P: usize>(a: &[[R; P]; P], g: &[R; P], lower: &[R; P], upper: &[R; P]) -> [R; P] {
    let mut d = [R::ZERO; P];
    let mut at = [At::Inside; P];
    for i in 0..P {
        if lower[i] >= R::ZERO && g[i] >= R::ZERO {
            at[i] = At::Lower;
        } else if upper[i] <= R::ZERO && g[i] <= R::ZERO {
            at[i] = At::Upper;
        }
        if lower[i] >= upper[i] {
            at[i] = At::Lower;
        }
    }
    // Each round fixes or frees one variable; the quadratic falls at each, so no set comes twice, and few are ever needed.
    for _ in 0..4 * P {
        let target = solve_free(a, g, &d, &at);
        // The longest part of the way to the target that stays in the box.
        let mut part = R::ONE;
        let mut blocking = None;
        for i in 0..P {
            if at[i] == At::Inside {
                let way = target[i] - d[i];
                let (room, side) = if way < R::ZERO {
                    (lower[i] - d[i], At::Lower)
                } else {
                    (upper[i] - d[i], At::Upper)
                };
                if way != R::ZERO && room.abs() < part * way.abs() {
                    part = room / way;
                    blocking = Some((i, side));
                }
            }
        }
        for i in 0..P {
            if at[i] == At::Inside {
                let to = d[i] + part * (target[i] - d[i]);
                d[i] = to.max(lower[i]).min(upper[i]);
            }
        }
        if let Some((i, side)) = blocking {
            at[i] = side;
            d[i] = if side == At::Lower { lower[i] } else { upper[i] };
            continue;
        }
        // At the minimum over the free variables: free the bound one that pulls inwards most, if any does.
        let mut strongest = R::ZERO;
        let mut release = None;
        for i in 0..P {
            if at[i] == At::Inside || lower[i] >= upper[i] {
                continue;
            }
            let mut slope = g[i];
            for j in 0..P {
                slope += a[i][j] * d[j];
            }
            let inwards = if at[i] == At::Lower { -slope } else { slope };
            let pull = inwards * inwards / a[i][i].max(R::MIN_POSITIVE);
            if inwards > R::ZERO && pull > strongest {
                strongest = pull;
                release = Some(i);
            }
        }
        match release {
            Some(i) => at[i] = At::Inside,
            None => break,
        }
    }
    d
}

/// The minimum over the free variables with the others held at `d`: LDL' of the rows and columns that are free.
fn solve_free<R: Real, const P: usize>(a: &[[R; P]; P], g: &[R; P], d: &[R; P], at: &[At; P]) -> [R; P] {
    let mut l = [[R::ZERO; P]; P];
    let mut inverse_pivot = [R::ZERO; P];
    let mut x = *d;
    let mut rhs = [R::ZERO; P];
    for i in 0..P {
        if at[i] == At::Inside {
            rhs[i] = -g[i];
            for j in 0..P {
                if at[j] != At::Inside {
                    rhs[i] -= a[i][j] * d[j];
                }
            }
        }
    }
    for j in 0..P {
        if at[j] != At::Inside {
            continue;
        }
        let mut pivot = a[j][j];
        for k in 0..j {
            // l holds L times the pivot until it is divided.
            pivot -= l[j][k] * l[j][k] * inverse_pivot[k];
        }
        // A pivot of rounding noise would send the step anywhere.
        if !(pivot > R::EPSILON * a[j][j]) {
            continue;
        }
        inverse_pivot[j] = R::ONE / pivot;
        for i in j + 1..P {
            if at[i] == At::Inside {
                let mut sum = a[i][j];
                for k in 0..j {
                    sum -= l[i][k] * l[j][k] * inverse_pivot[k];
                }
                l[i][j] = sum;
            }
        }
        let mut sum = rhs[j];
        for k in 0..j {
            sum -= l[j][k] * inverse_pivot[k] * rhs[k];
        }
        rhs[j] = sum;
    }
    for j in (0..P).rev() {
        if at[j] != At::Inside {
            continue;
        }
        if inverse_pivot[j] == R::ZERO {
            continue;
        }
        let mut sum = rhs[j];
        for i in j + 1..P {
            if at[i] == At::Inside && inverse_pivot[i] != R::ZERO {
                sum -= l[i][j] * x[i];
            }
        }
        x[j] = sum * inverse_pivot[j];
    }
    x
}
