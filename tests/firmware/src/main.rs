//! Runs the program named on the command line of the emulator (or, by a debugger, of the probe).
//!
//! No std, no alloc, no allocator: that this links is the proof that the core needs none.
#![no_std]
#![no_main]

/// How an image begins, writes and ends.
#[cfg_attr(target_os = "none", path = "outside/debugger.rs")]
#[cfg_attr(target_os = "linux", path = "outside/linux.rs")]
#[cfg_attr(target_family = "wasm", path = "outside/node.rs")]
mod outside;
#[path = "../programs/mod.rs"]
mod programs;

use core::fmt::{self, Write};

/// Collects a line, since every call to the debugger costs as much as a short fit.
struct Lines {
    buffer: [u8; 128],
    filled: usize,
}

impl Lines {
    fn new() -> Self {
        Lines {
            buffer: [0; 128],
            filled: 0,
        }
    }

    fn flush(&mut self) -> fmt::Result {
        let text = self.buffer.get(..self.filled).ok_or(fmt::Error)?;
        self.filled = 0;
        outside::write(text)
    }
}

impl Write for Lines {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for &byte in text.as_bytes() {
            *self.buffer.get_mut(self.filled).ok_or(fmt::Error)? = byte;
            self.filled += 1;
            if byte == b'\n' || self.filled == self.buffer.len() {
                self.flush()?;
            }
        }
        Ok(())
    }
}

/// Runs the program of this name.
fn run(name: &str) -> fmt::Result {
    let mut lines = Lines::new();
    let Some((_, program)) = programs::PROGRAMS.iter().find(|program| program.0 == name) else {
        writeln!(lines, "no program {name}")?;
        return Err(fmt::Error);
    };
    program(&mut lines)?;
    lines.flush()
}
