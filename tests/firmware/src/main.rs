//! Runs the program named on the command line of the emulator (or, by a debugger, of the probe).
//!
//! No std, no alloc, no allocator: that this links is the proof that the core needs none.
#![no_std]
#![no_main]

#[path = "../programs/mod.rs"]
mod programs;

use core::fmt::{self, Write};

#[cfg(target_arch = "arm")]
use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
use riscv_rt::entry;
use semihosting::process::ExitCode;
use semihosting::{eprintln, io, println, process};

/// Collects a line, since every call to the debugger costs as much as a short fit.
struct Lines {
    buffer: [u8; 128],
    filled: usize,
}

impl Lines {
    fn flush(&mut self) -> fmt::Result {
        let text = self.buffer.get(..self.filled).ok_or(fmt::Error)?;
        self.filled = 0;
        let mut stdout = io::stdout().map_err(|_| fmt::Error)?;
        io::Write::write_all(&mut stdout, text).map_err(|_| fmt::Error)
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

#[entry]
fn main() -> ! {
    let mut exit = ExitCode::FAILURE;
    match semihosting::experimental::env::args::<256>() {
        Err(_) => eprintln!("no command line"),
        Ok(args) => {
            // The first argument names the image.
            for name in (&args).skip(1).flatten() {
                exit = run(name);
            }
        }
    }
    exit.exit_process()
}

fn run(name: &str) -> ExitCode {
    let mut lines = Lines {
        buffer: [0; 128],
        filled: 0,
    };
    match programs::PROGRAMS.iter().find(|program| program.0 == name) {
        None => {
            eprintln!("no program {name}");
            ExitCode::FAILURE
        }
        Some((_, program)) => match program(&mut lines).and_then(|()| lines.flush()) {
            Ok(()) => ExitCode::SUCCESS,
            Err(_) => ExitCode::FAILURE,
        },
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    println!("{info}");
    process::exit(101)
}
