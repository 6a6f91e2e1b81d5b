//! Under Linux, by its system calls: no C library for another processor is needed, and none can lend its arithmetic.

use core::arch::{asm, naked_asm};
use core::ffi::{CStr, c_char};
use core::fmt;

const OUTPUT: usize = 1;

/// Numbers of the system calls `write` and `exit`.
#[cfg(target_arch = "aarch64")]
const CALLS: (usize, usize) = (64, 93);
#[cfg(any(target_arch = "s390x", target_arch = "x86"))]
const CALLS: (usize, usize) = (4, 1);

/// Linux begins here, with the number of arguments on top of the stack and their addresses after it.
#[unsafe(no_mangle)]
#[unsafe(naked)]
extern "C" fn _start() -> ! {
    #[cfg(target_arch = "aarch64")]
    naked_asm!("mov x0, sp", "bl {begin}", begin = sym begin);
    #[cfg(target_arch = "s390x")]
    naked_asm!("lgr %r2, %r15", "aghi %r15, -160", "brasl %r14, {begin}", begin = sym begin);
    #[cfg(target_arch = "x86")]
    naked_asm!("mov eax, esp", "and esp, -16", "sub esp, 12", "push eax", "call {begin}", begin = sym begin);
}

/// Runs the programs that are named after the image's own name.
unsafe extern "C" fn begin(stack: *const usize) -> ! {
    let mut status = 1;
    // SAFETY: Linux lays the number of arguments there.
    let arguments = unsafe { *stack };
    for i in 1..arguments {
        // SAFETY: and behind it so many addresses of text that ends with 0.
        let name = unsafe { CStr::from_ptr(*stack.add(1 + i) as *const c_char) };
        status = usize::from(name.to_str().map_err(|_| fmt::Error).and_then(crate::run).is_err());
    }
    exit(status)
}

/// A system call with three arguments.
///
/// # Safety
/// What Linux asks for that call.
unsafe fn call(number: usize, [a, b, c]: [usize; 3]) -> isize {
    let result;
    // SAFETY: as the caller says; nothing but the result changes.
    unsafe {
        #[cfg(target_arch = "aarch64")]
        asm!("svc 0", in("x8") number, inlateout("x0") a => result, in("x1") b, in("x2") c, options(nostack));
        #[cfg(target_arch = "s390x")]
        asm!("svc 0", in("r1") number, inlateout("r2") a => result, in("r3") b, in("r4") c, options(nostack));
        #[cfg(target_arch = "x86")]
        asm!("int 0x80", inlateout("eax") number => result, in("ebx") a, in("ecx") b, in("edx") c, options(nostack));
    }
    result
}

pub fn write(text: &[u8]) -> fmt::Result {
    let mut rest = text;
    while !rest.is_empty() {
        // SAFETY: the memory is that of a slice.
        let written = unsafe { call(CALLS.0, [OUTPUT, rest.as_ptr() as usize, rest.len()]) };
        rest = usize::try_from(written)
            .ok()
            .and_then(|written| rest.get(written..))
            .ok_or(fmt::Error)?;
    }
    Ok(())
}

fn exit(status: usize) -> ! {
    loop {
        // SAFETY: ends the process.
        unsafe { call(CALLS.1, [status, 0, 0]) };
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let mut lines = crate::Lines::new();
    let _ = fmt::write(&mut lines, format_args!("{info}\n"));
    exit(101)
}
