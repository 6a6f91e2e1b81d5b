//! The state of a search as bytes.

use super::{Kind, Phase, SearchIn, Task, Trial};
use crate::list::List;
use crate::minima::Minimum;
use crate::real::Real;
use crate::saved::{Saved, Tape};
use crate::search::{BANDS, Waits};

impl<R: Real, const P: usize, M: List<Item = Minimum<R, P>>, F: List<Item = Trial<R, P>>> Saved
    for SearchIn<R, P, M, F>
{
    fn shape(&self) -> [u32; 3] {
        let (fits, minima) = (self.fits.capacity() as u32, self.ends.minima.capacity() as u32);
        let capacities = (P as u32) << 24 | (fits & 0xff) << 16 | minima & 0xffff;
        [5, size_of::<R>() as u32, capacities]
    }
    fn fields(&mut self, tape: &mut Tape<'_>) {
        use Task::{Again, Begin, Choose, Converge, Judge, Last, Level, Propose, Settle, Short, Weigh};
        let phases = [
            Phase::Known,
            Phase::Rounds,
            Phase::Variations,
            Phase::Last,
            Phase::Ended,
        ];
        tape.one_of(&mut self.phase, &phases);
        let tasks = [
            Choose, Propose, Weigh, Level, Begin, Short, Judge, Converge, Last, Again, Settle,
        ];
        tape.one_of(&mut self.task, &tasks);
        let bands: [Kind; 2 * BANDS as usize] = core::array::from_fn(|k| match k as u32 {
            band if band < BANDS => Kind::Band(band),
            band => Kind::Corner(band - BANDS),
        });
        let mut band = bands.contains(&self.kind);
        tape.flag(&mut band);
        if band {
            tape.one_of(&mut self.kind, &bands);
        } else {
            tape.one_of(&mut self.kind, &[Kind::Everywhere, Kind::Index, Kind::Slopes]);
        }
        tape.flag(&mut self.unsettled);
        tape.flag(&mut self.flat);
        tape.flag(&mut self.elsewhere);
        tape.u64(&mut self.seed);
        for number in [
            &mut self.candidates,
            &mut self.round,
            &mut self.made,
            &mut self.known,
            &mut self.again,
            &mut self.group,
            &mut self.next,
            &mut self.end,
            &mut self.levelled,
            &mut self.place,
            &mut self.until,
            &mut self.evaluations.cost,
            &mut self.evaluations.linearize,
            &mut self.options.max_passes,
            &mut self.candidate.passes,
        ] {
            tape.u32(number);
        }
        tape.one_of(&mut self.candidate.waits, &[Waits::No, Waits::Weights, Waits::Fading]);
        for numbers in [
            &mut self.bounds.lower,
            &mut self.bounds.upper,
            &mut self.centre.0,
            &mut self.candidate.x,
        ] {
            tape.reals(numbers);
        }
        for number in [
            &mut self.options.cost_tolerance,
            &mut self.options.step_tolerance,
            &mut self.options.damping,
            &mut self.centre.1,
            &mut self.candidate.rank,
        ] {
            tape.reals(core::slice::from_mut(number));
        }
        tape.list(self.starts.as_mut_view(), Minimum::EMPTY, |tape, start| {
            start.fields(tape)
        });
        tape.list(&mut self.fits, Trial::EMPTY, |tape, trial| {
            trial.fit.fields(tape);
            tape.u64(&mut trial.start);
        });
        self.ends.fields(tape);
    }
}
