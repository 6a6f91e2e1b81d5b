//! What the page calls, and what it gives.

use std::alloc::{Layout, alloc, dealloc};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use brdfit::engine::certify::Certificate;
use brdfit::engine::clock;

use crate::answer::answer;
use crate::session::Session;

#[link(wasm_import_module = "page")]
unsafe extern "C" {
    /// Milliseconds since the beginning of 1970, UTC, with parts.
    safe fn now() -> f64;
    /// How far a proof is: the part within which it is proved, boxes that were bounded, boxes to go.
    safe fn told(eps: f64, boxes: f64, open: f64);
}

static SESSION: Mutex<Option<Session>> = Mutex::new(None);
/// The last answer, which stays in place until the next.
static ANSWER: Mutex<String> = Mutex::new(String::new());

fn clock_of_the_page() -> Duration {
    Duration::try_from_secs_f64(now() / 1e3).unwrap_or_default()
}

fn tell(so_far: &Certificate) {
    told(so_far.eps, so_far.boxes as f64, so_far.open as f64);
}

fn with<T>(act: impl FnOnce(&mut Session) -> T) -> T {
    clock::provide(clock_of_the_page);
    // One thread: nothing waits here, and a panic ends the module.
    let mut session = SESSION.lock().unwrap_or_else(PoisonError::into_inner);
    act(session.get_or_insert_with(Session::default))
}

/// Memory for `length` bytes, or null if there is none.
#[unsafe(no_mangle)]
pub extern "C" fn brdfit_take(length: usize) -> *mut u8 {
    match Layout::from_size_align(length.max(1), 1) {
        // SAFETY: the size is not zero.
        Ok(layout) => unsafe { alloc(layout) },
        Err(_) => std::ptr::null_mut(),
    }
}

/// Owns what the page has written at an address of [`brdfit_take`].
///
/// # Safety
/// `at` is from [`brdfit_take`] with this `length`, all of it is written, and it is not used again.
unsafe fn taken(at: *mut u8, length: usize) -> Vec<u8> {
    if length == 0 {
        if let Ok(layout) = Layout::from_size_align(1, 1) {
            // SAFETY: as above; an empty text has one byte.
            unsafe { dealloc(at, layout) };
        }
        return Vec::new();
    }
    // SAFETY: as above; a Vec of bytes has this layout.
    unsafe { Vec::from_raw_parts(at, length, length) }
}

/// Takes a file, in place of one of the same name.
///
/// # Safety
/// Both are from [`brdfit_take`] with these lengths, written, and not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_file(name: *mut u8, name_length: usize, bytes: *mut u8, length: usize) {
    // SAFETY: this function's own conditions.
    let (name, bytes) = unsafe { (taken(name, name_length), taken(bytes, length)) };
    let name = String::from_utf8_lossy(&name).into_owned();
    with(|session| session.take_file(name, bytes));
}

/// Forgets all files.
#[unsafe(no_mangle)]
pub extern "C" fn brdfit_forget() {
    with(|session| *session = Session::default());
}

/// Answers a request; the result is the length of the answer.
///
/// # Safety
/// `at` is from [`brdfit_take`] with this length, written, and not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_ask(at: *mut u8, length: usize) -> usize {
    // SAFETY: this function's own conditions.
    let request = unsafe { taken(at, length) };
    let text = with(|session| answer(session, &request, &tell));
    let mut place = ANSWER.lock().unwrap_or_else(PoisonError::into_inner);
    *place = text;
    place.len()
}

/// Where the answer is, until the next request.
#[unsafe(no_mangle)]
pub extern "C" fn brdfit_answer() -> *const u8 {
    ANSWER.lock().unwrap_or_else(PoisonError::into_inner).as_ptr()
}
