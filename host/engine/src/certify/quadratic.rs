//! A quadratic over the cube `-1 <= z <= 1`: a lower bound that holds whatever the rounding, and what parts of the cube it excludes.

use super::scene::D;

/// `constant + 2 gradient.z + z' hessian z`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quadratic {
    pub constant: f64,
    pub gradient: [f64; D],
    pub hessian: Matrix,
}

type Matrix = [[f64; D]; D];

/// How often each coordinate is moved in the search of a least value.
const SWEEPS: usize = 40;

/// A convex quadratic below the given one, and where it is least.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Convex {
    below: Quadratic,
    /// Bound of what rounding adds to a value of `below` in the cube.
    rounding: f64,
    /// Near where it is least.
    pub least: [f64; D],
    /// No value in the cube is below this.
    pub bound: f64,
}

impl Quadratic {
    fn slope(&self, z: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|i| {
            let mut sum = self.gradient[i];
            for k in 0..D {
                sum += self.hessian[i][k] * z[k];
            }
            2.0 * sum
        })
    }

    /// The value at `z`.
    pub fn at(&self, z: &[f64; D]) -> f64 {
        let slope = self.slope(z);
        let mut value = self.constant;
        for i in 0..D {
            value += z[i] * (self.gradient[i] + 0.5 * slope[i]);
        }
        value
    }

    /// A convex quadratic below it that is near to it.
    pub fn convex(&self) -> Convex {
        let largest = (0..D).fold(0.0, |most: f64, i| most.max(self.hessian[i][i].abs()));
        let ridge = 1e-13 * largest + f64::MIN_POSITIVE;
        let mut below = *self;
        if !is_positive(&below.hessian, ridge) {
            below = self.raised(&by_eigenvalues(&self.hessian, ridge));
        }
        if !is_positive(&below.hessian, ridge) {
            below = self.raised(&by_dominance(&self.hessian, ridge));
        }
        let mut size = below.constant.abs() + self.constant.abs();
        for i in 0..D {
            size += 2.0 * below.gradient[i].abs();
            for k in 0..D {
                size += below.hessian[i][k].abs();
            }
        }
        let mut convex = Convex {
            below,
            rounding: 64.0 * f64::EPSILON * size,
            least: below.descend([0.0; D], [-1.0; D], [1.0; D]),
            bound: 0.0,
        };
        convex.bound = convex.bound_from(&convex.least, &[-1.0; D], &[1.0; D]);
        convex
    }

    /// With more on the diagonal of the matrix, and less on the constant: in the cube that is below.
    fn raised(&self, by: &[f64; D]) -> Self {
        let mut below = *self;
        for i in 0..D {
            below.hessian[i][i] += by[i];
            below.constant -= by[i];
        }
        below
    }

    /// Near the least value in a box, by descent along one coordinate after the other.
    pub fn descend(&self, mut z: [f64; D], lo: [f64; D], hi: [f64; D]) -> [f64; D] {
        let mut slope = self.slope(&z);
        for _ in 0..SWEEPS {
            let mut moved = 0.0f64;
            for i in 0..D {
                let bend = 2.0 * self.hessian[i][i];
                if !(bend > 0.0) {
                    continue;
                }
                let to = (z[i] - slope[i] / bend).max(lo[i]).min(hi[i]);
                let step = to - z[i];
                if step != 0.0 {
                    for k in 0..D {
                        slope[k] += 2.0 * self.hessian[k][i] * step;
                    }
                    z[i] = to;
                    moved = moved.max(step.abs());
                }
            }
            if moved < 1e-4 {
                break;
            }
        }
        z
    }
}

impl Convex {
    /// A bound of the values in a box within the cube, from the tangent at `z`.
    fn bound_from(&self, z: &[f64; D], lo: &[f64; D], hi: &[f64; D]) -> f64 {
        let slope = self.below.slope(z);
        let mut value = self.below.at(z);
        for i in 0..D {
            value += (slope[i] * (lo[i] - z[i])).min(slope[i] * (hi[i] - z[i]));
        }
        value - self.rounding
    }

    /// The part of the cube in which values may be below `target`, as its ends; `bound` is below it.
    pub fn narrowed(&self, target: f64) -> ([f64; D], [f64; D]) {
        let (mut lo, mut hi) = ([-1.0; D], [1.0; D]);
        for i in 0..D {
            if self.below.hessian[i][i] == 0.0 && self.below.gradient[i] == 0.0 {
                continue;
            }
            for upper in [false, true] {
                if let Some(end) = self.cut(target, i, upper, lo, hi) {
                    if upper {
                        hi[i] = end;
                    } else {
                        lo[i] = end;
                    }
                }
            }
        }
        (lo, hi)
    }

    /// A place along coordinate `i` beyond which, up to its upper or down to its lower end, no value in the box is below `target`.
    fn cut(&self, target: f64, i: usize, upper: bool, lo: [f64; D], hi: [f64; D]) -> Option<f64> {
        let end = if upper { hi[i] } else { lo[i] };
        let start = self.least[i];
        let beyond = |at: f64, from: &[f64; D]| {
            let (mut low, mut high) = (lo, hi);
            (low[i], high[i]) = (at, at);
            let within: [f64; D] = std::array::from_fn(|k| from[k].max(low[k]).min(high[k]));
            let z = self.below.descend(within, low, high);
            if upper {
                high[i] = end;
            } else {
                low[i] = end;
            }
            (self.bound_from(&z, &low, &high), z)
        };
        let (face, far) = beyond(end, &self.least);
        if !(face > target) {
            return None;
        }
        // From the least point to the face the values are those of a parabola, if no further coordinate meets its end.
        let (rise, whole) = (target - self.bound, face - self.bound);
        let linear = (self.below.slope(&self.least)[i] * (end - start)).clamp(0.0, whole);
        let bend = whole - linear;
        let t = if bend > 1e-9 * whole {
            ((linear * linear + 4.0 * bend * rise).sqrt() - linear) / (2.0 * bend)
        } else {
            rise / whole
        };
        let mut t = t * 1.02 + 1e-3;
        for _ in 0..3 {
            if t > 0.97 {
                break;
            }
            let at = start + t * (end - start);
            let near: [f64; D] = std::array::from_fn(|k| self.least[k] + t * (far[k] - self.least[k]));
            if beyond(at, &near).0 >= target {
                return Some(at);
            }
            t = 0.5 * (t + 1.0);
        }
        None
    }
}

/// True only if `matrix` less `ridge` on its diagonal is positive definite: then Cholesky's method ends, in spite of rounding (Rump 2006).
fn is_positive(matrix: &Matrix, ridge: f64) -> bool {
    let mut l = [[0.0; D]; D];
    for i in 0..D {
        for k in 0..=i {
            let mut sum = matrix[i][k] - if i == k { ridge } else { 0.0 };
            // A coordinate that has no width has no row.
            if i == k && matrix[i] == [0.0; D] {
                sum = 1.0;
            }
            for j in 0..k {
                sum -= l[i][j] * l[k][j];
            }
            if i == k {
                if !(sum > 0.0) {
                    return false;
                }
                l[i][i] = sum.sqrt();
            } else {
                l[i][k] = sum / l[k][k];
            }
        }
    }
    true
}

/// What to add to the diagonal so that the matrix is diagonally dominant, and so positive.
fn by_dominance(matrix: &Matrix, ridge: f64) -> [f64; D] {
    std::array::from_fn(|i| {
        let others: f64 = (0..D).filter(|&k| k != i).map(|k| matrix[i][k].abs()).sum();
        (others * (1.0 + 1e-12) + 2.0 * ridge - matrix[i][i]).max(0.0)
    })
}

/// What to add to the diagonal so that no eigenvalue is negative, by the eigenvectors of those that are.
fn by_eigenvalues(matrix: &Matrix, ridge: f64) -> [f64; D] {
    let (values, vectors) = eigen(matrix);
    let mut push = [0.0; D];
    for e in 0..D {
        if values[e] < 3.0 * ridge {
            let norm: f64 = (0..D).map(|i| vectors[i][e].abs()).sum();
            for i in 0..D {
                push[i] += (4.0 * ridge - values[e]) * vectors[i][e].abs() * norm;
            }
        }
    }
    push
}

/// Eigenvalues and, column by column, eigenvectors, by Jacobi's rotations.
fn eigen(matrix: &Matrix) -> ([f64; D], Matrix) {
    let mut a = *matrix;
    let mut v = [[0.0; D]; D];
    for i in 0..D {
        v[i][i] = 1.0;
    }
    for _ in 0..12 {
        let mut off = 0.0;
        let mut all = 0.0;
        for p in 0..D {
            all += a[p][p] * a[p][p];
            for q in p + 1..D {
                off += a[p][q] * a[p][q];
            }
        }
        if off <= 1e-26 * all {
            break;
        }
        for p in 0..D {
            for q in p + 1..D {
                if a[p][q] == 0.0 {
                    continue;
                }
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = 1.0f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..D {
                    let (x, y) = (a[k][p], a[k][q]);
                    (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..D {
                    let (x, y) = (a[p][k], a[q][k]);
                    (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
                }
                for k in 0..D {
                    let (x, y) = (v[k][p], v[k][q]);
                    (v[k][p], v[k][q]) = (c * x - s * y, s * x + c * y);
                }
            }
        }
    }
    (std::array::from_fn(|i| a[i][i]), v)
}
