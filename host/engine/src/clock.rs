//! Wall time, which WebAssembly has only from the page that runs it.

use std::time::Duration;

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod now {
    use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

    pub type Now = Instant;

    pub fn since_1970() -> Duration {
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
    }

    pub fn now() -> Now {
        Instant::now()
    }

    pub fn since(begun: Now) -> Duration {
        begun.elapsed()
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod now {
    use std::sync::OnceLock;
    use std::time::Duration;

    pub type Now = Duration;

    static CLOCK: OnceLock<fn() -> Duration> = OnceLock::new();

    /// Takes the time from here: since the beginning of 1970, UTC. Without it no time passes; the first call counts.
    pub fn provide(clock: fn() -> Duration) {
        let _ = CLOCK.set(clock);
    }

    pub fn since_1970() -> Duration {
        now()
    }

    pub fn now() -> Now {
        CLOCK.get().map_or(Duration::ZERO, |clock| clock())
    }

    pub fn since(begun: Now) -> Duration {
        now().saturating_sub(begun)
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use now::provide;

/// The time since the beginning of 1970, UTC; zero where no clock is to be had.
pub fn since_1970() -> Duration {
    now::since_1970()
}

/// Runs from its start on.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch(now::Now);

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Stopwatch {
        Stopwatch(now::now())
    }

    /// The time since its start.
    pub fn elapsed(self) -> Duration {
        now::since(self.0)
    }
}
