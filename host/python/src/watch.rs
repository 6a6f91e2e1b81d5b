//! Long work without the interpreter's lock, which Ctrl-C ends.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, Builder, Thread};
use std::time::Duration;

use brdfit::engine::Until;
use brdfit::until::give_up;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Time between two looks for Ctrl-C.
const TICK: Duration = Duration::from_millis(20);
/// Stack of a thread that runs commands, bytes: what a main thread has.
const STACK: usize = 8 << 20;

/// Flags that no search looks at, for the next ones.
static FREE: Mutex<Vec<&'static AtomicBool>> = Mutex::new(Vec::new());

/// A flag that ends the searches that look at it.
struct Flag(&'static AtomicBool);

impl Flag {
    fn take() -> Flag {
        let free = FREE.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let flag = free.unwrap_or_else(|| Box::leak(Box::default()));
        flag.store(false, Ordering::Relaxed);
        Flag(flag)
    }
}

impl Drop for Flag {
    fn drop(&mut self) {
        FREE.lock().unwrap_or_else(PoisonError::into_inner).push(self.0);
    }
}

/// Tells the waiting thread at the end of a work, also if that panics.
struct Done<'a>(&'a AtomicBool, Thread);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
        self.1.unpark();
    }
}

/// Waits until `done`, and looks for signals; `tick` is called meanwhile.
fn wait(py: Python<'_>, done: &AtomicBool, tick: &mut dyn FnMut(Python<'_>) -> PyResult<()>) -> PyResult<()> {
    while !done.load(Ordering::Acquire) {
        py.detach(|| thread::park_timeout(TICK));
        py.check_signals()?;
        tick(py)?;
    }
    Ok(())
}

fn no_threads(error: impl std::fmt::Display) -> PyErr {
    PyRuntimeError::new_err(format!("no threads: {error}; take fewer"))
}

/// Runs `work` on a thread of its own, which ends when it sees that the [`Until`] is over; what it borrows stays until then.
///
/// # Errors
/// What a signal raises, such as `KeyboardInterrupt`, and what `tick` raises, which is called every 20 ms.
pub fn scoped<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(Until) -> T + Send,
    mut tick: impl FnMut(Python<'_>) -> PyResult<()>,
) -> PyResult<T> {
    let (flag, done) = (Flag::take(), AtomicBool::new(false));
    let (until, main) = (Until::set(flag.0), thread::current());
    thread::scope(|scope| {
        let done = &done;
        let run = move || {
            let _done = Done(done, main);
            give_up(until);
            work(until)
        };
        let worker = Builder::new().spawn_scoped(scope, run).map_err(no_threads)?;
        let waited = wait(py, done, &mut tick);
        flag.0.store(waited.is_err(), Ordering::Relaxed);
        let result = py.detach(|| worker.join());
        waited?;
        Ok(result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

/// The same for work that owns all it needs: what does not look at the [`Until`], such as reading a file, is left behind by a signal.
///
/// # Errors
/// What a signal raises.
pub fn apart<T: Send + 'static>(py: Python<'_>, work: impl FnOnce(Until) -> T + Send + 'static) -> PyResult<T> {
    let (flag, done) = (Flag::take(), Arc::new(AtomicBool::new(false)));
    let (raw, until, main, ended) = (flag.0, Until::set(flag.0), thread::current(), done.clone());
    let run = move || {
        let _done = Done(&ended, main);
        // The flag is not free before the work ends.
        let _flag = flag;
        give_up(until);
        work(until)
    };
    let worker = Builder::new().stack_size(STACK).spawn(run).map_err(no_threads)?;
    if let Err(signal) = wait(py, &done, &mut |_| Ok(())) {
        raw.store(true, Ordering::Relaxed);
        return Err(signal);
    }
    let result = py.detach(|| worker.join());
    Ok(result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
}
