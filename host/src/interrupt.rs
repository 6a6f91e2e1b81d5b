//! Ctrl-C and the request to end: the first asks, the second ends the program at once.

use std::sync::Arc;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Exit code of a command that was interrupted and kept what it had: 128 and the number of SIGINT, as shells have it.
pub const EXIT_CODE: u8 = 130;

/// From the first call on, an interrupt no longer ends the program but sets this flag; a second one ends it.
pub fn flag() -> &'static AtomicBool {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    FLAG.get_or_init(|| {
        let asked = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // The order matters: while the flag is not set, the first does nothing. Where handlers are not to be had, an interrupt ends the program as ever.
            let _ = flag::register_conditional_shutdown(signal, i32::from(EXIT_CODE), Arc::clone(&asked))
                .and_then(|_| flag::register(signal, Arc::clone(&asked)));
        }
        asked
    })
}
