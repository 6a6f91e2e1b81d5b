//! On a microcontroller: through the debugger, which under QEMU is QEMU.

use core::fmt;

#[cfg(target_arch = "arm")]
use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
use riscv_rt::entry;
use semihosting::process::ExitCode;
use semihosting::{eprintln, experimental, io, println, process};

#[entry]
fn main() -> ! {
    let mut exit = ExitCode::FAILURE;
    match experimental::env::args::<256>() {
        Err(_) => eprintln!("no command line"),
        Ok(args) => {
            // The first argument names the image.
            for name in (&args).skip(1).flatten() {
                exit = match crate::run(name) {
                    Ok(()) => ExitCode::SUCCESS,
                    Err(_) => ExitCode::FAILURE,
                };
            }
        }
    }
    exit.exit_process()
}

pub fn write(text: &[u8]) -> fmt::Result {
    let mut stdout = io::stdout().map_err(|_| fmt::Error)?;
    io::Write::write_all(&mut stdout, text).map_err(|_| fmt::Error)
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    println!("{info}");
    process::exit(101)
}
