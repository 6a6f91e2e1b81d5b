//! Shares of intervals that hold the truth, and what may be said of them.

/// Intervals of 95 % should hold in so many.
pub const WANTED: (f64, f64) = (0.93, 0.97);

/// So many of all.
#[derive(Clone, Copy, Default)]
pub struct Share {
    pub held: usize,
    pub count: usize,
}

impl Share {
    pub fn of(list: impl Iterator<Item = bool>) -> Share {
        list.fold(Share::default(), |share, held| Share {
            held: share.held + usize::from(held),
            count: share.count + 1,
        })
    }

    /// Of all, 0 to 1.
    pub fn part(self) -> f64 {
        self.held as f64 / self.count as f64
    }

    /// In %, marked where it is out of what is wanted by more than chance: `-` below it, `+` above.
    pub fn shown(self) -> String {
        if self.count == 0 {
            return "–".into();
        }
        let mark = match self.side() {
            side if side < 0 => " -",
            side if side > 0 => " +",
            _ => "",
        };
        format!("{:.1}{mark}", 100.0 * self.part())
    }

    /// -1 where it is below what is wanted by more than 1.96 standard deviations of a count, 1 where it is above, else 0.
    pub fn side(self) -> i32 {
        let chance = |wanted: f64| noise(wanted, self.count);
        match self.part() {
            part if part < WANTED.0 - chance(WANTED.0) => -1,
            part if part > WANTED.1 + chance(WANTED.1) => 1,
            _ => 0,
        }
    }
}

/// By how much a share of `count` differs from its expectation by chance, in 95 %: the normal approximation of the binomial.
pub fn noise(part: f64, count: usize) -> f64 {
    1.96 * (part * (1.0 - part) / count as f64).sqrt()
}
