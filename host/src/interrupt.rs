//! Ctrl-C, the request to end, and a reader of standard output that went away: what they do while a command works.
//!
//! Most commands write nothing before they are done, so that an interrupt ends them at once.
//! One that can keep what is finished calls [`keeping`], looks at the flag that it gets, and ends by itself; a second interrupt ends it too.

use std::io::{Write, stderr};
use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;

use crate::error;

/// Exit code of a command that was interrupted: 128 and the number of SIGINT, as shells have it.
pub const EXIT_CODE: u8 = 130;

/// An interrupt has been asked for.
static ASKED: AtomicBool = AtomicBool::new(false);
/// The command keeps what is finished.
static KEEPING: AtomicBool = AtomicBool::new(false);
/// The result is still to go to standard output.
static AWAITED: AtomicBool = AtomicBool::new(false);
/// Held while a file is put in its place.
static WRITING: Mutex<()> = Mutex::new(());

/// From here on the command keeps what is finished when the flag is set, and ends soon.
pub fn keeping() -> &'static AtomicBool {
    KEEPING.store(true, Ordering::Relaxed);
    &ASKED
}

/// Has an interrupt been asked for?
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// A program ends at once only while no file is half written.
pub fn writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Says whether the result of the command is still to go to standard output.
pub fn await_reader(awaited: bool) {
    AWAITED.store(awaited, Ordering::Relaxed);
}

/// Answers interrupts from here on; for the program itself, once.
#[cfg(unix)]
pub fn listen() {
    use rustix::event::{PollFd, PollFlags, poll};
    use signal_hook::consts::{SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    // Where handlers are not to be had, an interrupt ends the program as ever.
    if let Ok(mut signals) = Signals::new([SIGINT, SIGTERM]) {
        thread::spawn(move || signals.forever().for_each(|_| interrupted()));
    }
    thread::spawn(|| {
        let output = std::io::stdout();
        // Without a wish for anything, poll returns when the other end is closed.
        let mut fds = [PollFd::new(&output, PollFlags::empty())];
        let ended = poll(&mut fds, None).is_ok();
        if ended && AWAITED.load(Ordering::Relaxed) {
            end("standard output was closed before there was a result", error::EXIT_CODE);
        }
    });
}

/// Elsewhere an interrupt ends the program as ever.
#[cfg(not(unix))]
pub fn listen() {}

#[cfg(unix)]
fn interrupted() {
    if ASKED.swap(true, Ordering::Relaxed) {
        end("interrupted again: ended at once", EXIT_CODE);
    }
    if !KEEPING.load(Ordering::Relaxed) {
        end("interrupted: nothing was written", EXIT_CODE);
    }
    let _ = writeln!(
        stderr(),
        "interrupted: what is finished is kept; once more ends at once"
    );
}

#[cfg(unix)]
fn end(why: &str, code: u8) -> ! {
    let _file_is_whole = writing();
    // If even standard error is closed, the exit code remains.
    let _ = writeln!(stderr(), "{why}");
    exit(i32::from(code))
}
