//! The program itself, called from MATLAB.

use std::ffi::{CStr, CString, OsString, c_char};
use std::io::{Cursor, sink};

use brdfit::cli::call;
use brdfit::streams::Streams;

/// Writes to `answer` what a command prints whose standard input is `table`, or one line on what is wrong; `words`, with line breaks between, are its arguments. Returns 0, or 1 if something is wrong.
///
/// # Safety
/// `words` and `table` end with a zero byte. `answer` is given to [`brdfit_matlab_forget`] once it was read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_matlab_program(
    words: *const c_char,
    table: *const c_char,
    answer: &mut *mut c_char,
) -> i32 {
    // SAFETY: the caller's.
    let (words, table) = unsafe { (CStr::from_ptr(words), CStr::from_ptr(table)) };
    let (text, code) = match printed(&words.to_string_lossy(), table.to_bytes()) {
        Ok(text) => (text, 0),
        Err(why) => (why, 1),
    };
    // What is printed has no zero byte.
    *answer = CString::new(text).unwrap_or_default().into_raw();
    code
}

/// Forgets an answer of [`brdfit_matlab_program`].
///
/// # Safety
/// It is one, and was not forgotten.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn brdfit_matlab_forget(answer: *mut c_char) {
    // SAFETY: the caller's.
    drop(unsafe { CString::from_raw(answer) });
}

fn printed(words: &str, table: &[u8]) -> Result<String, String> {
    let words = std::iter::once("brdfit").chain(words.lines()).map(OsString::from);
    let mut output = Vec::new();
    let ended = call(
        words,
        &mut Streams {
            input: &mut Cursor::new(table),
            output: &mut output,
            errors: &mut sink(),
            progress: false,
            color: false,
            quiet: true,
        },
    );
    match ended {
        Ok(ended) if ended.code != 0 => Err(ended.why),
        Ok(_) => Ok(String::from_utf8_lossy(&output).into_owned()),
        Err(error) => Err(error.in_exception()),
    }
}
