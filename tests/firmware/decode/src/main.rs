//! Writes the log that comes in on standard input as text: `decode ELF`, where ELF is the image that logs.
//!
//! defmt's own decoder with little around it: `defmt-print` does the same, but takes three times as long to build.

use std::io::{self, Read};

use anyhow::{Context, bail};
use defmt_decoder::{DecodeError, Table};

fn main() -> anyhow::Result<()> {
    let image = std::env::args().nth(1).context("which image?")?;
    let table = Table::parse(&std::fs::read(&image)?)?.with_context(|| format!("{image} does not log"))?;
    let mut bytes = Vec::new();
    io::stdin().read_to_end(&mut bytes)?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&bytes);
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("print", |level| level.as_str());
                println!("{level} {}", frame.display_message());
            }
            Err(DecodeError::UnexpectedEof) => return Ok(()),
            Err(DecodeError::Malformed) => bail!("a frame that defmt did not write"),
        }
    }
}
