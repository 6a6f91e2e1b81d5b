//! Reads a file of any known format, fits each scan in it with the model that it needs, and prints what is known.
//!
//! `cargo run --release -p brdfit --example file -- paint.csv`

use std::error::Error;
use std::path::PathBuf;

use brdfit::analysis::choose::Wanted;
use brdfit::analysis::fit::fit;
use brdfit::engine::{FitOptions, Model};
use brdfit::input::{ReadOptions, read};
use brdfit::result;

fn main() -> Result<(), Box<dyn Error>> {
    let named = std::env::args_os().nth(1).map(PathBuf::from);
    let file = named.unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/data/testdata3_sym_seed1.csv").into());
    let options = ReadOptions {
        drop_invalid: true,
        ..ReadOptions::default()
    };
    let scans = read(&[file], &options, &mut std::io::empty())?;
    // Of several models that of least BIC is taken.
    let models = ["beckmann", "ggx"].into_iter().filter_map(Model::find);
    let wanted = Wanted::Best(models.map(FitOptions::of).collect());
    for scan in &scans {
        let fitted = fit(scan, &wanted)?;
        print!("{}", result::text(std::slice::from_ref(&fitted), true));
        for at in &fitted.derived {
            println!(
                "reflectance at {:.1} degrees: {:.4} +- {:.4}",
                at.theta_i.to_degrees(),
                at.reflectance.value,
                at.reflectance.stderr
            );
        }
    }
    Ok(())
}
