//! Integrals of several functions at once over an interval, to a tolerance: Gauss and Kronrod's rule of 7 and 15 nodes, halved where it has to be.

/// Nodes of Kronrod's rule from the end to the middle; every second is one of Gauss's (Piessens et al. 1983, QUADPACK).
const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
const GAUSS: [f64; 4] = [
    0.129_484_966_168_869_7,
    0.279_705_391_489_276_64,
    0.381_830_050_505_118_93,
    0.417_959_183_673_469_4,
];
/// Halvings at most.
const DEEPEST: u32 = 30;
/// Parts that an interval may have from the first.
const PARTS: usize = 15;

/// Places of one rule: the nodes on both sides, from the ends to the middle, and the middle once more, so that they go side by side through a formula.
pub const PLACES: usize = 16;
/// The weight of each place in Kronrod's rule.
const KRONRODS: [f64; PLACES] = {
    let mut weights = [0.0; PLACES];
    let mut k = 0;
    while k < PLACES - 1 {
        weights[k] = KRONROD[k / 2];
        k += 1;
    }
    weights
};
/// The same less its weight in Gauss's rule.
const DIFFERENCES: [f64; PLACES] = {
    let mut weights = KRONRODS;
    let mut k = 0;
    while k < 7 {
        weights[k / 2 * 4 + 2 + k % 2] -= GAUSS[k / 2];
        k += 1;
    }
    weights
};

/// Some ascending ends of parts.
pub struct Ends {
    ends: [f64; PARTS + 1],
    count: usize,
}

impl Ends {
    /// `low`, the first of those of `inner` that lie between, in order, and `high`.
    pub fn new(low: f64, high: f64, inner: impl IntoIterator<Item = f64>) -> Ends {
        let mut all = Ends {
            ends: [low; PARTS + 1],
            count: 1,
        };
        for end in inner.into_iter().filter(|&x| low < x && x < high) {
            // One place is kept for the end.
            if all.count < PARTS {
                all.insert(end);
            }
        }
        all.insert(high);
        all
    }

    fn insert(&mut self, end: f64) {
        let place = self.ends[..self.count].partition_point(|&known| known < end);
        if self.ends[..self.count].get(place) != Some(&end) {
            self.ends.copy_within(place..self.count, place + 1);
            self.ends[place] = end;
            self.count += 1;
        }
    }

    fn parts(&self) -> impl Iterator<Item = (f64, f64)> {
        self.ends[..self.count].windows(2).map(|ends| (ends[0], ends[1]))
    }
}

/// The integrals over the parts between `ends`, to about `tolerance` of the largest of the first `judged` functions, or of `size` if that is larger.
pub fn integrate<const N: usize>(
    f: &mut impl FnMut(&[f64; PLACES]) -> [[f64; PLACES]; N],
    ends: &Ends,
    judged: usize,
    tolerance: f64,
    size: f64,
) -> [f64; N] {
    let largest = |sums: &[f64; N]| sums[..judged].iter().fold(0.0f64, |most, sum| most.max(sum.abs()));
    let mut first = [([0.0; N], 0.0); PARTS];
    let mut sums = [0.0; N];
    for ((a, b), known) in ends.parts().zip(&mut first) {
        *known = rule(f, a, b, judged);
        add(&mut sums, 1.0, &known.0);
    }
    let error = tolerance * largest(&sums).max(size);
    let mut sums = [0.0; N];
    for ((a, b), &(part, worst)) in ends.parts().zip(&first) {
        let part = if worst <= error {
            part
        } else {
            let middle = 0.5 * (a + b);
            let mut left = halved(f, a, middle, judged, error, DEEPEST);
            add(&mut left, 1.0, &halved(f, middle, b, judged, error, DEEPEST));
            left
        };
        add(&mut sums, 1.0, &part);
    }
    sums
}

fn halved<const N: usize>(
    f: &mut impl FnMut(&[f64; PLACES]) -> [[f64; PLACES]; N],
    a: f64,
    b: f64,
    judged: usize,
    error: f64,
    deeper: u32,
) -> [f64; N] {
    let (sums, worst) = rule(f, a, b, judged);
    if worst <= error || deeper == 0 {
        return sums;
    }
    // Errors of the halves add like independent ones.
    let (middle, error) = (0.5 * (a + b), error * std::f64::consts::FRAC_1_SQRT_2);
    let mut left = halved(f, a, middle, judged, error, deeper - 1);
    add(&mut left, 1.0, &halved(f, middle, b, judged, error, deeper - 1));
    left
}

/// The integrals over one part, and the largest error of those that are judged: QUADPACK's, from how far both rules differ.
fn rule<const N: usize>(
    f: &mut impl FnMut(&[f64; PLACES]) -> [[f64; PLACES]; N],
    a: f64,
    b: f64,
    judged: usize,
) -> ([f64; N], f64) {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut places = [middle; PLACES];
    for (k, node) in NODES.into_iter().enumerate() {
        places[2 * k] = middle - half * node;
        places[2 * k + 1] = middle + half * node;
    }
    let values = f(&places);
    let mut kronrod = [0.0; N];
    for (sum, values) in kronrod.iter_mut().zip(&values) {
        *sum = half * weighted(values, &KRONRODS);
    }
    // Gauss's rule tells errors alone.
    let error = |k: usize| {
        let size = kronrod[k].abs();
        let part = (200.0 * (half * weighted(&values[k], &DIFFERENCES)).abs() / size).min(1.0);
        if size > 0.0 {
            size * part * libm::sqrt(part)
        } else {
            0.0
        }
    };
    let worst = (0..judged).map(error).fold(0.0, f64::max);
    (kronrod, worst)
}

/// The sum of all products, by halves that lie side by side.
fn weighted(values: &[f64; PLACES], weights: &[f64; PLACES]) -> f64 {
    let mut sums = [0.0; PLACES];
    for k in 0..PLACES {
        sums[k] = weights[k] * values[k];
    }
    let mut count = PLACES / 2;
    while count > 0 {
        for k in 0..count {
            sums[k] += sums[k + count];
        }
        count /= 2;
    }
    sums[0]
}

fn add<const N: usize>(sums: &mut [f64; N], factor: f64, values: &[f64; N]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
