//! The state of a fit or of a search, and blocks of samples, as bytes: to flash and back, on any machine.
//!
//! What goes on from restored state has the bits of what was never interrupted.
//! The format is plain: a header of [`HEADER`] bytes (a mark, the version, what it is and its capacities, length, CRC-32) and the fields in their order, little-endian.
//! All of it is numbers of known length, so a crate for serialisation would add code and nothing else.
//!
//! ```
//! # use brdfit_core::{brdf::ALL, geometry::{Block, Observation, Sample}, lm::Options, residuals::Scan};
//! use brdfit_core::saved;
//! use brdfit_core::search::{CANDIDATES, Search};
//!
//! # let mut blocks = [Block::<f32>::EMPTY; 2];
//! # for row in 0..21 {
//! #     let sample = Sample::in_plane(0.5, (row as f32 - 10.0) * 0.1, 0.3 + 0.01 * (row % 3) as f32);
//! #     blocks[row / 16].set(row % 16, &Observation::new(&sample).unwrap());
//! # }
//! # let scan = Scan::<f32, ALL, 6>::new(&blocks);
//! let mut search = Search::<f32, 6, 4>::new();
//! search.begin(&Scan::<f32, ALL, 6>::usual_bounds(), 0, CANDIDATES, &Options::default());
//! for _ in 0..100 {
//!     search.step(&scan);
//! }
//! let mut flash = [0; 4096];
//! let length = saved::save(&mut search, &mut flash)?;
//!
//! let mut after_reset = Search::<f32, 6, 4>::new();
//! saved::restore(&mut after_reset, &flash[..length])?;
//! while search.step(&scan) {}
//! while after_reset.step(&scan) {}
//! assert_eq!(after_reset.best().unwrap().x, search.best().unwrap().x);
//! # Ok::<(), saved::SavedError>(())
//! ```

use crate::geometry::Block;
use crate::list::List;
use crate::real::Real;

/// Bytes before the fields.
pub const HEADER: usize = 20;
/// The version of the format; another one is refused.
pub const VERSION: u8 = 1;

const MARK: [u8; 4] = *b"brdf";

/// Why bytes were not written or not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SavedError {
    /// There is no room for them, or there are fewer than were written.
    Length,
    /// They do not begin as saved state does.
    NotSaved,
    /// They are of another version of the format.
    Version,
    /// They hold another type: other numbers, another number of parameters, or other capacities.
    Other,
    /// They were damaged. If the checksum did not tell it, which takes intent, the state is not to be used.
    Damaged,
}

/// State that can be saved.
pub trait Saved {
    /// What it is, the size of its numbers, and its capacities.
    fn shape(&self) -> [u32; 3];
    /// Its fields, each in its turn written to the tape or read from it.
    fn fields(&mut self, tape: &mut Tape<'_>);
}

/// Where fields go, or come from.
#[derive(Debug)]
pub struct Tape<'a> {
    side: Side<'a>,
    place: usize,
    failed: bool,
}

#[derive(Debug)]
enum Side<'a> {
    /// Only counts.
    Measure,
    Write(&'a mut [u8]),
    Read(&'a [u8]),
}

impl Tape<'_> {
    fn bytes(&mut self, value: &mut [u8]) {
        let end = self.place + value.len();
        match &mut self.side {
            Side::Measure => {}
            Side::Write(bytes) => match bytes.get_mut(self.place..end) {
                Some(to) => to.copy_from_slice(value),
                None => self.failed = true,
            },
            Side::Read(bytes) => match bytes.get(self.place..end) {
                Some(from) => value.copy_from_slice(from),
                None => self.failed = true,
            },
        }
        self.place = end;
    }

    /// A number of 8 bits.
    pub fn u8(&mut self, value: &mut u8) {
        self.bytes(core::slice::from_mut(value));
    }

    /// A number of 32 bits.
    pub fn u32(&mut self, value: &mut u32) {
        let mut bytes = value.to_le_bytes();
        self.bytes(&mut bytes);
        *value = u32::from_le_bytes(bytes);
    }

    /// A number of 64 bits.
    pub fn u64(&mut self, value: &mut u64) {
        let mut bytes = value.to_le_bytes();
        self.bytes(&mut bytes);
        *value = u64::from_le_bytes(bytes);
    }

    /// Real numbers, by their bits.
    pub fn reals<R: Real>(&mut self, values: &mut [R]) {
        for value in values {
            let mut bytes = value.bits().to_le_bytes();
            self.bytes(bytes.get_mut(..size_of::<R>()).unwrap_or_default());
            *value = R::of_bits(u64::from_le_bytes(bytes));
        }
    }

    /// One of these values.
    pub fn one_of<T: Copy + PartialEq>(&mut self, value: &mut T, all: &[T]) {
        let mut place = all.iter().position(|one| one == value).unwrap_or(0) as u8;
        self.u8(&mut place);
        match all.get(usize::from(place)) {
            Some(&one) => *value = one,
            None => self.failed = true,
        }
    }

    /// Yes or no.
    pub fn flag(&mut self, value: &mut bool) {
        self.one_of(value, &[false, true]);
    }

    /// A list, of which each item is written or read, whole, by a function; new ones are `empty` first.
    pub(crate) fn list<S: List + ?Sized>(
        &mut self,
        list: &mut S,
        empty: S::Item,
        mut item: impl FnMut(&mut Self, &mut S::Item),
    ) {
        let mut count = list.len() as u32;
        self.u32(&mut count);
        if !list.resize(count as usize, empty) {
            self.failed = true;
        }
        for value in list.iter_mut() {
            item(self, value);
        }
    }
}

/// How many bytes it takes; the value stays as it is.
pub fn length(value: &mut (impl Saved + ?Sized)) -> usize {
    let mut tape = Tape {
        side: Side::Measure,
        place: HEADER,
        failed: false,
    };
    value.fields(&mut tape);
    tape.place
}

/// Writes the state of a value, which stays as it is; how many bytes it took.
///
/// # Errors
/// [`SavedError::Length`] if there is not enough room: [`length`] tells how much is needed.
pub fn save(value: &mut (impl Saved + ?Sized), bytes: &mut [u8]) -> Result<usize, SavedError> {
    let length = length(value);
    let (header, fields) = bytes
        .get_mut(..length)
        .and_then(|bytes| bytes.split_at_mut_checked(HEADER))
        .ok_or(SavedError::Length)?;
    let mut tape = Tape {
        side: Side::Write(fields),
        place: 0,
        failed: false,
    };
    value.fields(&mut tape);
    let mut sum = checksum(fields);
    let mut tape = Tape {
        side: Side::Write(header),
        place: 0,
        failed: false,
    };
    tape.bytes(&mut MARK.clone());
    header_fields(&mut tape, &mut value.shape(), &mut (length as u32), &mut sum);
    Ok(length)
}

/// Takes the state that was written, on this machine or another; `value` is of the same type and capacities.
///
/// # Errors
/// [`SavedError`]; the value is then as it was, but after a forged checksum.
pub fn restore(value: &mut (impl Saved + ?Sized), bytes: &[u8]) -> Result<(), SavedError> {
    let (header, rest) = bytes.split_at_checked(HEADER).ok_or(SavedError::Length)?;
    let mut tape = Tape {
        side: Side::Read(header),
        place: 0,
        failed: false,
    };
    let mut mark = [0; 4];
    tape.bytes(&mut mark);
    if mark != MARK {
        return Err(SavedError::NotSaved);
    }
    let (mut shape, mut length, mut sum) = ([0; 3], 0, 0);
    if header_fields(&mut tape, &mut shape, &mut length, &mut sum) != VERSION {
        return Err(SavedError::Version);
    }
    if shape != value.shape() {
        return Err(SavedError::Other);
    }
    let fields = (length as usize)
        .checked_sub(HEADER)
        .and_then(|length| rest.get(..length));
    let fields = fields.ok_or(SavedError::Length)?;
    if sum != checksum(fields) {
        return Err(SavedError::Damaged);
    }
    let mut tape = Tape {
        side: Side::Read(fields),
        place: 0,
        failed: false,
    };
    value.fields(&mut tape);
    if tape.failed || tape.place != fields.len() {
        return Err(SavedError::Damaged);
    }
    Ok(())
}

/// What follows the mark; the version.
fn header_fields(tape: &mut Tape<'_>, shape: &mut [u32; 3], length: &mut u32, sum: &mut u32) -> u8 {
    let [what, numbers, capacities] = shape;
    let mut first = u32::from(VERSION) | *what << 8 | *numbers << 16;
    tape.u32(&mut first);
    (*what, *numbers) = (first >> 8 & 0xff, first >> 16);
    tape.u32(capacities);
    tape.u32(length);
    tape.u32(sum);
    first as u8
}

/// CRC-32 of IEEE 802.3, bit by bit: a table would take a kilobyte of flash.
fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for &byte in bytes {
        sum ^= u32::from(byte);
        for _ in 0..8 {
            sum = sum >> 1 ^ (0xedb8_8320 & (sum & 1).wrapping_neg());
        }
    }
    !sum
}

impl<R: Real, const L: usize, const C: usize> Saved for [Block<R, L, C>] {
    fn shape(&self) -> [u32; 3] {
        let capacities = (self.len() as u32) << 16 | (L as u32) << 8 | C as u32;
        [1, size_of::<R>() as u32, capacities]
    }
    fn fields(&mut self, tape: &mut Tape<'_>) {
        for block in self {
            for column in &mut block.columns {
                tape.reals(column);
            }
            tape.reals(&mut block.ln_f);
            tape.reals(&mut block.weight);
        }
    }
}
