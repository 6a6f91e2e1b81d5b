//! What the core costs on a Cortex-M: built by `./run --budgets` once for each set of terms, number type and use.
//!
//! The images `fit` and `search` hold nothing but start-up and the core, so their size is that of the core; `costs` prints.
#![no_std]
#![no_main]

#[path = "../programs/mod.rs"]
#[allow(dead_code)]
mod programs;

use core::hint::black_box;

use brdfit_core::brdf::{self, ALL, Params};
use brdfit_core::geometry::{Block, Geometry, LANES, LobeGeometry, Observation, Sample};
use brdfit_core::lm::{self, Bounds, Fit, Options, Problem};
use brdfit_core::real::Real;
use brdfit_core::residuals::Scan;
use brdfit_core::search::{CANDIDATES, FITS, Search};
use cortex_m_rt::entry;
use programs::scan;
use semihosting::process;

const TERMS: u8 = match option_env!("BRDFIT_TERMS") {
    Some(text) => digits(text.as_bytes()),
    None => ALL,
};
const P: usize = brdf::parameters(TERMS);
const IS_F64: bool = matches!(option_env!("BRDFIT_REAL"), Some(text) if text.len() == 3 && text.as_bytes()[1] == b'6');
/// `f`it, `s`earch or `c`osts.
const USE: u8 = match option_env!("BRDFIT_USE") {
    Some(text) => text.as_bytes()[0],
    None => b'c',
};

/// Geometry comes from a table that the host made, not from angles.
const TABLED: bool = matches!(option_env!("BRDFIT_GEOMETRY"), Some(text) if text.as_bytes()[0] == b't');

const fn digits(text: &[u8]) -> u8 {
    let (mut value, mut i) = (0, 0);
    while i < text.len() {
        value = 10 * value + (text[i] - b'0');
        i += 1;
    }
    value
}

unsafe extern "C" {
    /// What every interrupt of the board leads to: `memory/mps2-an386/device.x`.
    fn Interrupt();
}

/// The interrupts of the board, as the package of a device has them for [`cortex_m_rt`].
#[unsafe(link_section = ".vector_table.interrupts")]
#[unsafe(no_mangle)]
pub static __INTERRUPTS: [unsafe extern "C" fn(); 32] = [Interrupt; 32];

/// The memory of a search, which the caller owns.
type State<R> = Search<R, P, 4, FITS>;

#[entry]
fn main() -> ! {
    match (USE, IS_F64) {
        (b'c', false) => costs::<f32>(),
        (b'c', true) => costs::<f64>(),
        (_, false) => image::<f32>(),
        (_, true) => image::<f64>(),
    }
    if USE == b'c' {
        process::exit(0)
    }
    // An instrument's program does not end.
    loop {}
}

/// Least and largest coordinates, of rho_d, rho_s, rho_v, m, n and kappa^2.
const BOUNDS: [[f64; 6]; 2] = [[0.0, 0.0, 0.0, 1e-5, 1.0, 0.0], [1.0, 100.0, 100.0, 10.0, 100.0, 1e4]];

/// Those of the terms, in both number types: constants, as firmware has them.
const SINGLE: [[f32; P]; 2] = {
    let (double, mut single) = (DOUBLE, [[0.0; P]; 2]);
    let mut k = 0;
    while k < 2 * P {
        single[k / P][k % P] = double[k / P][k % P] as f32;
        k += 1;
    }
    single
};
const DOUBLE: [[f64; P]; 2] = {
    let mut bounds = [[0.0; P]; 2];
    let mut index = 0;
    while index < 6 {
        if brdf::has(TERMS, index) {
            bounds[0][brdf::slot(TERMS, index)] = BOUNDS[0][index];
            bounds[1][brdf::slot(TERMS, index)] = BOUNDS[1][index];
        }
        index += 1;
    }
    bounds
};

fn bounds<R: Real>() -> Bounds<R, P> {
    let [lower, upper] = *R::table(&SINGLE, &DOUBLE);
    Bounds { lower, upper }
}

fn start<R: Real>() -> [R; P] {
    let (tenth, one) = (R::of(0.1), R::ONE);
    Scan::<R, TERMS, P>::coordinates(&Params::from_array([
        tenth,
        one,
        R::of(0.01),
        R::of(0.2),
        R::of(1.5),
        R::of(0.5),
    ]))
}

/// Samples that nobody knows go in, parameters go out.
fn image<R: Real>() {
    let sample = black_box(Sample::in_plane(R::ZERO, R::ZERO, R::ZERO));
    let geometry = Geometry {
        lobes: [LobeGeometry {
            tan2_theta_h: R::ZERO,
            cos_theta_d: R::ONE,
            factor: R::ONE,
        }; 2],
    };
    let mut blocks = [Block::<R>::empty(); scan::BLOCKS];
    for block in &mut blocks {
        for lane in 0..LANES {
            let observation = if TABLED {
                Observation::at(black_box(geometry), sample.brdf, sample.weight)
            } else {
                Observation::new(&sample)
            };
            if let Ok(observation) = observation {
                block.set(lane, &observation);
            }
        }
    }
    let scan = Scan::<R, TERMS, P>::new(&blocks);
    if USE == b'f' {
        black_box(lm::fit(&scan, &bounds(), start(), &Options::default()).x);
    } else {
        let mut state = State::new();
        state.begin(&bounds(), 0, CANDIDATES, &Options::default());
        while state.step(&scan) {}
        black_box(state.best().map(|best| best.x));
    }
}

fn costs<R: Real>() {
    let blocks = scan::blocks::<R>();
    let scan = Scan::<R, TERMS, P>::new(&blocks);
    let clock = Clock::start();
    print("bytes_blocks", size_of_val(&blocks));
    print("bytes_fit", size_of::<Fit<R, P>>());
    print("bytes_search", size_of::<State<R>>());
    let mut state = State::new();
    measure(&clock, "observation", || observation::<R>());
    measure(&clock, "cost", || pass_cost(&scan));
    measure(&clock, "linearize", || pass_linearize(&scan));
    let mut passes = 0;
    measure(&clock, "steps", || passes = ten_steps(&scan));
    print("steps", passes as usize - 1);
    measure(&clock, "fit", || whole_fit(&scan));
    measure(&clock, "search", || whole_search(&scan, &mut state));
}

// Each has a stack frame of its own, as it would have in firmware.
#[inline(never)]
fn observation<R: Real>() {
    let sample = Sample::in_plane(R::of(0.5), R::of(0.7), R::of(0.1));
    black_box(Observation::new(black_box(&sample)).is_ok());
}
#[inline(never)]
fn pass_cost<R: Real>(scan: &Scan<R, TERMS, P>) {
    black_box(scan.cost(&black_box(start())));
}
#[inline(never)]
fn pass_linearize<R: Real>(scan: &Scan<R, TERMS, P>) {
    black_box(&scan.linearize(&black_box(start())));
}
/// One pass to begin, and ten steps, each with its pass, or fewer if the fit ends; how many passes.
#[inline(never)]
fn ten_steps<R: Real>(scan: &Scan<R, TERMS, P>) -> u32 {
    let (bounds, options) = (bounds(), Options::default());
    let mut fit = Fit::begin(scan, &bounds, black_box(start()), &options);
    fit.run(scan, &bounds, &options, 11);
    black_box(&fit).passes
}
#[inline(never)]
fn whole_fit<R: Real>(scan: &Scan<R, TERMS, P>) {
    black_box(&lm::fit(scan, &bounds(), black_box(start()), &Options::default()));
}
#[inline(never)]
fn whole_search<R: Real>(scan: &Scan<R, TERMS, P>, state: &mut State<R>) {
    state.begin(&bounds(), black_box(0), CANDIDATES, &Options::default());
    while state.step(scan) {}
    black_box(state);
}

/// Instructions and bytes of stack of a call.
fn measure(clock: &Clock, name: &str, mut call: impl FnMut()) {
    const PAINTED: usize = 256 * 1024;
    const PAINT: u32 = 0xa5c3_5a3c;
    let top: usize;
    // SAFETY: the emulated machine has 4 MiB of RAM, of which no more than a tenth is in use above the stack pointer, and no interrupt is enabled; so what is below belongs to nobody while this function, which calls nothing, writes there.
    unsafe {
        core::arch::asm!("mov {}, sp", out(reg) top);
        let mut word = (top - PAINTED) as *mut u32;
        while (word as usize) < top - 64 {
            word.write_volatile(PAINT);
            word = word.add(1);
        }
    }
    let before = clock.now();
    call();
    let ticks = clock.now().wrapping_sub(before);
    let mut bottom = top - PAINTED;
    // SAFETY: as above.
    while unsafe { (bottom as *const u32).read_volatile() } == PAINT {
        bottom += 4;
    }
    put(name);
    put("_stack");
    print("", top - bottom);
    put(name);
    print(
        "_instructions",
        (u64::from(ticks) * clock.per_1024_ticks / 1024) as usize,
    );
}

/// The first timer of the CMSDK peripherals of mps2-an386 and mps2-an500; under `-icount` it counts instructions.
struct Clock {
    per_1024_ticks: u64,
}

const TIMER: *mut u32 = 0x4000_0000 as *mut u32;

impl Clock {
    fn start() -> Self {
        // SAFETY: these are the timer's registers RELOAD, VALUE and CTRL, which nobody else uses.
        unsafe {
            TIMER.add(2).write_volatile(u32::MAX);
            TIMER.add(1).write_volatile(u32::MAX);
            TIMER.write_volatile(1);
        }
        let mut clock = Clock { per_1024_ticks: 0 };
        let before = clock.now();
        // SAFETY: two instructions a round, one million rounds.
        unsafe {
            core::arch::asm!("2: subs {0}, {0}, #1", "bne 2b", inout(reg) 1_000_000u32 => _);
        }
        let ticks = clock.now().wrapping_sub(before);
        clock.per_1024_ticks = 2_000_000 * 1024 / u64::from(ticks.max(1));
        clock
    }

    fn now(&self) -> u32 {
        // SAFETY: the register VALUE, which counts down.
        unsafe { TIMER.add(1).read_volatile() }.wrapping_neg()
    }
}

fn print(name: &str, mut value: usize) {
    put(name);
    put(" ");
    let mut digits = [b'0'; 10];
    let mut first = digits.len() - 1;
    for (place, digit) in digits.iter_mut().enumerate().rev() {
        *digit += (value % 10) as u8;
        if *digit != b'0' {
            first = place;
        }
        value /= 10;
    }
    put(core::str::from_utf8(&digits[first..]).unwrap_or(""));
    put("\n");
}

fn put(text: &str) {
    if let Ok(mut stdout) = semihosting::io::stdout() {
        let _ = semihosting::io::Write::write_all(&mut stdout, text.as_bytes());
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    process::exit(101)
}
