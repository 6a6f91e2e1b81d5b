//! In WebAssembly: node calls for a program by its number, and takes its lines (see `node.mjs`).

use core::arch::wasm32;
use core::fmt;

#[link(wasm_import_module = "env")]
unsafe extern "C" {
    safe fn take(text: *const u8, length: usize);
}

/// The name of program `index`, taken as its lines are; false if there is none.
#[unsafe(no_mangle)]
extern "C" fn name(index: usize) -> bool {
    match crate::programs::PROGRAMS.get(index) {
        Some((name, _)) => write(name.as_bytes()).is_ok(),
        None => false,
    }
}

/// Runs program `index`; true if it ended well.
#[unsafe(no_mangle)]
extern "C" fn run(index: usize) -> bool {
    let name = crate::programs::PROGRAMS.get(index).map_or("", |program| program.0);
    crate::run(name).is_ok()
}

pub fn write(text: &[u8]) -> fmt::Result {
    take(text.as_ptr(), text.len());
    Ok(())
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let mut lines = crate::Lines::new();
    let _ = fmt::write(&mut lines, format_args!("{info}\n"));
    wasm32::unreachable()
}
