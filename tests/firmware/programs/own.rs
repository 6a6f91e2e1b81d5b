//! A model of one's own: ABg scatter from its formula alone, searched like any other; its derivatives are those of dual numbers.

use core::fmt::{self, Write};

use brdfit_core::dual::Number;
use brdfit_core::formula::{Directions, Formula, Own};
use brdfit_core::geometry::{Block, LANES, Sample};
use brdfit_core::lm::Options;
use brdfit_core::model::{Parameter, Role};
use brdfit_core::real::Real;
use brdfit_core::residuals::{Residuals, observe};
use brdfit_core::search::{CANDIDATES, Search};

use super::number;

/// `A / (B + |beta - beta_0|^g)`.
#[derive(Clone, Copy)]
struct Abg;

impl Formula<3> for Abg {
    const PARAMETERS: [Parameter; 3] = [
        Parameter::new("A", "A", Role::Weight, 1e3).unit("sr^-1"),
        Parameter::new("B", "B", Role::Shape, 10.0)
            .bounds(1e-9, 10.0)
            .spread(1e-6, 1.0),
        Parameter::new("g", "g", Role::Shape, 6.0).spread(0.5, 4.0),
    ];

    fn brdf<R: Real, N: Number<R>>([a, b, g]: &[N; 3], at: &Directions<R>) -> N {
        *a / (*b + N::of(at.shift.max(R::MIN_POSITIVE)).pow(*g))
    }
}

const ROWS: usize = 48;
/// Of a polished mirror.
const TRUTH: [f64; 3] = [0.01, 0.001, 1.75];

pub fn run(out: &mut dyn Write) -> fmt::Result {
    writeln!(out, "f64")?;
    own::<f64>(out)?;
    writeln!(out, "f32")?;
    own::<f32>(out)
}

fn own<R: Real>(out: &mut dyn Write) -> fmt::Result {
    let truth = TRUTH.map(R::of);
    let mut blocks = [Block::<R, LANES, 8>::EMPTY; ROWS / LANES];
    for row in 0..ROWS as u16 {
        let (theta_i, theta_s) = (R::of(0.5), (R::from(row) - R::of(20.0)) / R::of(20.0));
        let at = Directions::new(theta_i, theta_s, R::PI).map_err(|_| fmt::Error)?;
        // Noise that every machine makes alike: 0.9 to 1.1 in steps.
        let noise = R::ONE + (R::from(row * 37 % 21) - R::of(10.0)) / R::of(100.0);
        let sample = Sample::in_plane(theta_i, theta_s, Abg::brdf(&truth, &at) * noise);
        let observation = observe::<R, Own<Abg>, 3, 8>(&sample).map_err(|_| fmt::Error)?;
        if let Some(block) = blocks.get_mut(usize::from(row) / LANES) {
            block.set(usize::from(row) % LANES, &observation);
        }
    }
    let scan = Residuals::<R, Own<Abg>, 3, 8>::new(&blocks);
    let bounds = Residuals::<R, Own<Abg>, 3, 8>::usual_bounds();
    let mut state = Search::<R, 3, 2>::new();
    state.begin(&bounds, 0, CANDIDATES, &Options::default());
    while state.step(&scan) {}
    let best = state.best().ok_or(fmt::Error)?;
    number(out, "cost", best.at.cost)?;
    for (parameter, value) in Abg::PARAMETERS.iter().zip(best.x) {
        number(out, parameter.name, value)?;
    }
    Ok(())
}
