//! Until when the searches of a command are wanted, for programs that call commands and go on themselves.

use std::cell::Cell;

use crate::engine::Until;

thread_local! {
    static UNTIL: Cell<Until> = const { Cell::new(Until::NEVER) };
}

/// What this thread asks for from here on is given up when `until` says so.
pub fn give_up(until: Until) {
    UNTIL.set(until);
}

/// Until when what this thread asks for is wanted; for good, if nothing else was said.
pub fn until() -> Until {
    UNTIL.get()
}
