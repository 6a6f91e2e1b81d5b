//! Pointers of C as references, after what can be checked was checked.

use core::mem::MaybeUninit;

use crate::types::brdfit_error::{self, Length, Misaligned, Null};

fn check<T>(pointer: *const T) -> Result<(), brdfit_error> {
    if pointer.is_null() {
        Err(Null)
    } else if !pointer.is_aligned() {
        Err(Misaligned)
    } else {
        Ok(())
    }
}

fn check_many<T>(pointer: *const T, count: usize) -> Result<(), brdfit_error> {
    check(pointer)?;
    let most = isize::MAX as usize / size_of::<T>();
    if count == 0 || count > most {
        Err(Length)
    } else {
        Ok(())
    }
}

/// What is read.
///
/// # Safety
/// A pointer that is neither null nor misaligned points to a `T` that nobody writes to during `'a`.
pub unsafe fn input<'a, T>(pointer: *const T) -> Result<&'a T, brdfit_error> {
    check(pointer)?;
    // SAFETY: as asked of the caller.
    Ok(unsafe { &*pointer })
}

/// What may be left out.
///
/// # Safety
/// As for `input`.
pub unsafe fn optional<'a, T>(pointer: *const T) -> Result<Option<&'a T>, brdfit_error> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: as asked of the caller.
    unsafe { input(pointer) }.map(Some)
}

/// What is read, as an array.
///
/// # Safety
/// As for `input`, for `count` of them.
pub unsafe fn inputs<'a, T>(pointer: *const T, count: usize) -> Result<&'a [T], brdfit_error> {
    check_many(pointer, count)?;
    // SAFETY: as asked of the caller.
    Ok(unsafe { core::slice::from_raw_parts(pointer, count) })
}

/// What is changed.
///
/// # Safety
/// As for `input`, and nobody else reads it either.
pub unsafe fn changed<'a, T>(pointer: *mut T) -> Result<&'a mut T, brdfit_error> {
    check(pointer)?;
    // SAFETY: as asked of the caller.
    Ok(unsafe { &mut *pointer })
}

/// What is written, and was nothing before.
///
/// # Safety
/// As for `changed`, but the memory may hold anything.
pub unsafe fn output<'a, T>(pointer: *mut T) -> Result<&'a mut MaybeUninit<T>, brdfit_error> {
    // SAFETY: as asked of the caller.
    unsafe { changed(pointer.cast()) }
}

/// What is written, as an array.
///
/// # Safety
/// As for `output`, for `count` of them.
pub unsafe fn outputs<'a, T>(pointer: *mut T, count: usize) -> Result<&'a mut [MaybeUninit<T>], brdfit_error> {
    check_many(pointer, count)?;
    // SAFETY: as asked of the caller.
    Ok(unsafe { core::slice::from_raw_parts_mut(pointer.cast(), count) })
}
