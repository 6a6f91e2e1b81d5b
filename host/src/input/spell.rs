//! Names of angles as rows of words: `theta_i`, `thetaIn`, `angle of incidence`, `Einfallswinkel`.

/// A kind of word within the name of an angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Word {
    Polar,
    Angle,
    Azimuth,
    Incidence,
    Scattering,
    Difference,
    Filler,
}

/// Words that names of angles are made of; where short ones may stand says [`Part::goes_before`].
const WORDS: [(&str, Word); 115] = [
    ("theta", Word::Polar),
    ("th", Word::Polar),
    ("zenith", Word::Polar),
    ("zen", Word::Polar),
    ("polar", Word::Polar),
    ("angle", Word::Angle),
    ("ang", Word::Angle),
    ("phi", Word::Azimuth),
    ("ph", Word::Azimuth),
    ("varphi", Word::Azimuth),
    ("azimuthal", Word::Azimuth),
    ("azimuth", Word::Azimuth),
    ("azimut", Word::Azimuth),
    ("azim", Word::Azimuth),
    ("azm", Word::Azimuth),
    ("azi", Word::Azimuth),
    ("az", Word::Azimuth),
    ("incidence", Word::Incidence),
    ("incident", Word::Incidence),
    ("incoming", Word::Incidence),
    ("inc", Word::Incidence),
    ("input", Word::Incidence),
    ("in", Word::Incidence),
    ("illumination", Word::Incidence),
    ("illuminant", Word::Incidence),
    ("illum", Word::Incidence),
    ("ill", Word::Incidence),
    ("lighting", Word::Incidence),
    ("light", Word::Incidence),
    ("source", Word::Incidence),
    ("src", Word::Incidence),
    ("solar", Word::Incidence),
    ("sun", Word::Incidence),
    ("lamp", Word::Incidence),
    ("laser", Word::Incidence),
    ("beam", Word::Incidence),
    ("i", Word::Incidence),
    ("0", Word::Incidence),
    ("scattering", Word::Scattering),
    ("scattered", Word::Scattering),
    ("scatter", Word::Scattering),
    ("scatt", Word::Scattering),
    ("scat", Word::Scattering),
    ("sca", Word::Scattering),
    ("sc", Word::Scattering),
    ("reflection", Word::Scattering),
    ("reflected", Word::Scattering),
    ("reflect", Word::Scattering),
    ("refl", Word::Scattering),
    ("ref", Word::Scattering),
    ("outgoing", Word::Scattering),
    ("output", Word::Scattering),
    ("out", Word::Scattering),
    ("exitant", Word::Scattering),
    ("exit", Word::Scattering),
    ("emergence", Word::Scattering),
    ("emergent", Word::Scattering),
    ("emission", Word::Scattering),
    ("emitted", Word::Scattering),
    ("viewing", Word::Scattering),
    ("viewer", Word::Scattering),
    ("view", Word::Scattering),
    ("observation", Word::Scattering),
    ("observed", Word::Scattering),
    ("observer", Word::Scattering),
    ("obs", Word::Scattering),
    ("sensor", Word::Scattering),
    ("detection", Word::Scattering),
    ("detector", Word::Scattering),
    ("det", Word::Scattering),
    ("camera", Word::Scattering),
    ("receiving", Word::Scattering),
    ("receiver", Word::Scattering),
    ("receive", Word::Scattering),
    ("rec", Word::Scattering),
    ("measurement", Word::Scattering),
    ("measuring", Word::Scattering),
    ("measured", Word::Scattering),
    ("measure", Word::Scattering),
    ("meas", Word::Scattering),
    ("goniometer", Word::Scattering),
    ("s", Word::Scattering),
    ("r", Word::Scattering),
    ("o", Word::Scattering),
    ("v", Word::Scattering),
    ("e", Word::Scattering),
    ("delta", Word::Difference),
    ("relative", Word::Difference),
    ("rel", Word::Difference),
    ("minus", Word::Difference),
    ("difference", Word::Difference),
    ("diff", Word::Difference),
    // German and French.
    ("winkel", Word::Angle),
    ("einfalls", Word::Incidence),
    ("einstrahl", Word::Incidence),
    ("beleuchtungs", Word::Incidence),
    ("streu", Word::Scattering),
    ("ausfalls", Word::Scattering),
    ("reflexions", Word::Scattering),
    ("beobachtungs", Word::Scattering),
    ("detektor", Word::Scattering),
    ("dincidence", Word::Incidence),
    ("déclairage", Word::Incidence),
    ("declairage", Word::Incidence),
    ("dediffusion", Word::Scattering),
    ("deréflexion", Word::Scattering),
    ("dereflexion", Word::Scattering),
    ("dobservation", Word::Scattering),
    ("devue", Word::Scattering),
    ("of", Word::Filler),
    ("the", Word::Filler),
    ("to", Word::Filler),
    ("normal", Word::Filler),
    ("deg", Word::Filler),
    ("rad", Word::Filler),
];

/// A word within a name.
#[derive(Clone, Copy)]
struct Part {
    text: &'static str,
    kind: Word,
}

impl Part {
    fn is_letter(self) -> bool {
        self.text.len() == 1
    }

    fn names_an_angle(self) -> bool {
        matches!(self.kind, Word::Polar | Word::Angle | Word::Azimuth)
    }

    /// True of the name of an angle that other words may hold by chance, as `ph` in `sphere`.
    fn is_short(self) -> bool {
        self.names_an_angle() && self.text.len() < 4 && !["phi", "zen"].contains(&self.text)
    }

    /// May `next` be behind this one, `apart` if something stands between them, and `first` if nothing is before?
    fn goes_before(self, next: Part, apart: bool, first: bool) -> bool {
        let is_two = |part: Part| part.names_an_angle() && part.text.len() == 2;
        if self.is_letter() {
            // `V_ph` is a voltage, and the `r` of `ph_r - ph_i` is behind an angle.
            return !(first && is_two(next)) && (apart || next.names_an_angle() && !next.is_short());
        }
        let glued = if next.is_letter() {
            self.names_an_angle() && (!self.is_short() || "isrv0".contains(next.text))
        } else {
            // `thin` is no angle.
            !(self.is_short() && next.text.len() < 3 || next.is_short() && self.text.len() < 3)
        };
        apart || glued
    }
}

/// The kinds of the words that a name is a row of, if it is one: from its end, so that no name takes long.
///
/// `breaks` are the places in it where something stood between two letters, or a capital began, as the name was written.
pub fn spell(text: &str, breaks: &[usize]) -> Option<Vec<Word>> {
    let apart = |at: usize| breaks.binary_search(&at).is_ok();
    // At each place the word that begins there, if the rest is a row of words.
    let mut words: Vec<Option<Part>> = vec![None; text.len()];
    for at in (0..text.len()).filter(|&at| text.is_char_boundary(at)).rev() {
        let fits = |part: &Part| {
            let end = at + part.text.len();
            text[at..].starts_with(part.text)
                // `pH` is no word, and `ph_i` is two.
                && !(part.text.len() < 4 && (at + 1..end).any(apart))
                && (end == text.len() || words[end].is_some_and(|next| part.goes_before(next, apart(end), at == 0)))
        };
        words[at] = WORDS.iter().map(|&(text, kind)| Part { text, kind }).find(fits);
    }
    let mut kinds = Vec::new();
    let mut at = 0;
    while let Some(part) = *words.get(at)? {
        kinds.push(part.kind);
        at += part.text.len();
        if at == text.len() {
            return Some(kinds);
        }
    }
    None
}
