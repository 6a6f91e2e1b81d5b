//! Pictures as files: SVG, or PNG that is drawn from it.

use std::path::PathBuf;

use crate::error::Error;
use crate::target::Target;

/// The endings that pictures can have, in the order in which a report writes them.
pub const ENDINGS: &[&str] = if cfg!(feature = "png") {
    &["svg", "png"]
} else {
    &["svg"]
};

/// Accepts the name of a picture: `.svg`, with the feature `png` also `.png`, or no ending, which stands for SVG.
///
/// # Errors
/// Another ending.
pub fn name(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    match ending.as_deref().and_then(|ending| ending.to_str()) {
        None | Some("svg") => Ok(path),
        Some("png") if cfg!(feature = "png") => Ok(path),
        Some("png") => Err("this program is built without PNG; take .svg, or build it with --features png".to_string()),
        Some(_) => Err(format!("a picture is {}; let it end in .svg", ENDINGS.join(" or "))),
    }
}

/// Writes a picture in the form that the ending of its name says.
///
/// # Errors
/// The file cannot be written, or the picture not be drawn.
pub fn save(target: &Target, svg: &str) -> Result<(), Error> {
    let path = target.path();
    if path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("png"))
    {
        target.write(&png(svg).map_err(|error| error.in_file(path.display().to_string()))?)
    } else {
        target.write(svg.as_bytes())
    }
}

/// The bytes of a PNG.
#[cfg(feature = "png")]
fn png(svg: &str) -> Result<Vec<u8>, Error> {
    use resvg::tiny_skia::{Pixmap, Transform};
    use resvg::usvg::{Options, Tree};

    /// Pixels of a PNG for one of the SVG: 1800 across, 15 cm at 300 dpi.
    const SCALE: f32 = 2.0;
    /// With their own font, pictures have the same letters on every machine, and some where there are no fonts at all.
    const FONTS: [&[u8]; 3] = [
        include_bytes!("font/DejaVuSansCondensed.ttf"),
        include_bytes!("font/DejaVuSansCondensed-Bold.ttf"),
        include_bytes!("font/DejaVuSansCondensed-Oblique.ttf"),
    ];

    let fail = |why: &dyn std::fmt::Display| {
        Error::new(format!("the picture cannot be drawn: {why}")).help("write it as .svg")
    };
    let mut options = Options::default();
    for font in FONTS {
        options.fontdb_mut().load_font_data(font.to_vec());
    }
    options.fontdb_mut().set_sans_serif_family("DejaVu Sans Condensed");
    let tree = Tree::from_str(svg, &options).map_err(|error| fail(&error))?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let canvas = size.and_then(|size| Pixmap::new(size.width(), size.height()));
    let mut canvas = canvas.ok_or_else(|| fail(&"it is too large"))?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut canvas.as_mut());
    canvas.encode_png().map_err(|error| fail(&error))
}

#[cfg(not(feature = "png"))]
fn png(_svg: &str) -> Result<Vec<u8>, Error> {
    Err(Error::new("this program is built without PNG").help("take .svg, or build it with --features png"))
}
