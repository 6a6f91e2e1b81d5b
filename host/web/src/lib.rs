//! brdfit in a web page: what the page asks for goes in as JSON, what the library answers comes out as JSON.
//!
//! Five functions and two imports are all that the page and the module know of each other, so that no generator of bindings is needed: strings are UTF-8 in the module's memory, at an address with a length.
//! The page calls from one worker; what traps there (a panic, no more memory) ends that worker, and the page starts another.
//!
//! | Room | What it holds |
//! |---|---|
//! | [`request`] | what can be asked, as plain data |
//! | [`session`] | the files at hand, and the last scan and fit, so that they are not made twice |
//! | [`answer`] | from a request to the text of an answer |
//! | [`view`] | numbers for the page's own drawings |

pub mod answer;
pub mod request;
pub mod session;
pub mod view;

#[cfg(target_family = "wasm")]
mod exports;
