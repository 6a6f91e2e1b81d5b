//! Tensor files: named arrays of numbers behind a head that says where each begins.

use crate::error::{Error, shown};

const MAGIC: &[u8; 12] = b"tensor_file\0";

/// True if the file begins as these do.
pub fn is(file: &[u8]) -> bool {
    file.starts_with(MAGIC)
}

/// A named array, whose last dimension is dense.
#[derive(Clone)]
pub struct Field<'a> {
    /// Its name.
    pub name: String,
    /// Its dimensions.
    pub shape: Vec<usize>,
    bytes: &'a [u8],
    kind: Kind,
}

/// The kind of numbers.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Byte,
    F32,
    F64,
    /// Numbers that no measurement has.
    Other,
}

impl Field<'_> {
    /// The number at `place`; NaN beyond the end.
    pub fn number(&self, place: usize) -> f64 {
        let at = |size: usize| self.bytes.get(place * size..(place + 1) * size);
        match self.kind {
            Kind::Byte => at(1).map(|bytes| bytes[0].into()),
            Kind::F32 => at(4).and_then(|bytes| Some(f32::from_le_bytes(bytes.try_into().ok()?).into())),
            Kind::F64 => at(8).and_then(|bytes| Some(f64::from_le_bytes(bytes.try_into().ok()?))),
            Kind::Other => None,
        }
        .unwrap_or(f64::NAN)
    }

    /// So many numbers from `begin` on.
    pub fn numbers(&self, begin: usize, count: usize) -> Vec<f64> {
        (begin..begin + count).map(|place| self.number(place)).collect()
    }

    /// All numbers.
    pub fn all(&self) -> Vec<f64> {
        self.numbers(0, self.shape.iter().product())
    }
}

/// A place in the head.
struct Cursor<'a> {
    file: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn bytes(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let bytes = self.file.get(self.at..).and_then(|rest| rest.get(..count));
        self.at += count;
        bytes.ok_or_else(|| fault("the head ends early"))
    }

    /// A number of `bytes` bytes, little end first.
    fn integer(&mut self, bytes: usize) -> Result<u64, Error> {
        let bytes = self.bytes(bytes)?;
        Ok(bytes
            .iter()
            .rev()
            .fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    fn size(&mut self) -> Result<usize, Error> {
        usize::try_from(self.integer(8)?).map_err(|_| fault("a number of its head is too large"))
    }
}

fn fault(what: &str) -> Error {
    Error::new(format!("as tensor file: {what}")).help("is the file cut off?")
}

/// The fields of a file.
///
/// # Errors
/// The head is not understood, or a field is outside of the file.
pub fn fields(file: &[u8]) -> Result<Vec<Field<'_>>, Error> {
    // Sizes in bytes of the kinds 1 to 11: integers of 8 to 64 bits, with and without sign, then f16, f32 and f64.
    const SIZES: [usize; 11] = [1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8];
    if !is(file) {
        return Err(fault("it does not begin with tensor_file"));
    }
    let mut head = Cursor { file, at: MAGIC.len() };
    let version = [head.integer(1)?, head.integer(1)?];
    if version != [1, 0] {
        return Err(fault(&format!(
            "its version is {}.{}, and not 1.0",
            version[0], version[1]
        )));
    }
    let count = head.integer(4)?;
    let mut fields = Vec::new();
    for _ in 0..count {
        let length = head.integer(2)? as usize;
        let name = String::from_utf8_lossy(head.bytes(length)?).into_owned();
        let dimensions = head.integer(2)?;
        let kind = head.integer(1)? as usize;
        let offset = head.size()?;
        let shape = (0..dimensions).map(|_| head.size()).collect::<Result<Vec<_>, _>>()?;
        let size = SIZES.get(kind.wrapping_sub(1));
        let size = size.ok_or_else(|| fault(&format!("the field {} has numbers of an unknown kind", shown(&name))))?;
        let bytes = shape.iter().try_fold(*size, |bytes, &count| bytes.checked_mul(count));
        let bytes = bytes.and_then(|bytes| file.get(offset..)?.get(..bytes));
        fields.push(Field {
            bytes: bytes.ok_or_else(|| fault(&format!("the field {} is not all there", shown(&name))))?,
            name,
            shape,
            kind: match kind {
                1 => Kind::Byte,
                10 => Kind::F32,
                11 => Kind::F64,
                _ => Kind::Other,
            },
        });
    }
    Ok(fields)
}

/// Numbers to write.
pub enum Numbers {
    /// Bytes without a sign.
    Bytes(Vec<u8>),
    /// Numbers of single precision.
    F32(Vec<f32>),
}

/// A file of these fields: name, shape and as many numbers as the shape says.
pub fn write(fields: &[(&str, Vec<usize>, Numbers)]) -> Vec<u8> {
    let head: usize = fields
        .iter()
        .map(|(name, shape, _)| 13 + name.len() + 8 * shape.len())
        .sum();
    let mut file = MAGIC.to_vec();
    file.extend([1, 0]);
    file.extend((fields.len() as u32).to_le_bytes());
    let mut offset = file.len() + head;
    let mut body = Vec::new();
    for (name, shape, numbers) in fields {
        file.extend((name.len() as u16).to_le_bytes());
        file.extend(name.as_bytes());
        file.extend((shape.len() as u16).to_le_bytes());
        let begin = body.len();
        match numbers {
            Numbers::Bytes(bytes) => {
                file.push(1);
                body.extend(bytes);
            }
            Numbers::F32(values) => {
                file.push(10);
                body.extend(values.iter().flat_map(|value| value.to_le_bytes()));
            }
        }
        file.extend((offset as u64).to_le_bytes());
        shape.iter().for_each(|&size| file.extend((size as u64).to_le_bytes()));
        offset += body.len() - begin;
    }
    file.extend(body);
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file() -> Vec<u8> {
        let mut file = MAGIC.to_vec();
        file.extend([1, 0, 2, 0, 0, 0]);
        let head = 18 + (2 + 1 + 2 + 1 + 8 + 16) + (2 + 1 + 2 + 1 + 8 + 8);
        for (name, kind, shape, offset) in [(b"a", 10u8, &[2u64, 3][..], head), (b"b", 11, &[1], head + 24)] {
            file.extend([1, 0]);
            file.extend(name);
            file.extend((shape.len() as u16).to_le_bytes());
            file.push(kind);
            file.extend((offset as u64).to_le_bytes());
            shape.iter().for_each(|size| file.extend(size.to_le_bytes()));
        }
        (0..6u8).for_each(|k| file.extend(f32::from(k).to_le_bytes()));
        file.extend(0.1f64.to_le_bytes());
        file
    }

    #[test]
    fn fields_have_their_numbers() {
        let file = file();
        let fields = fields(&file).unwrap();
        assert_eq!(
            (fields[0].name.as_str(), fields[0].shape.as_slice()),
            ("a", &[2, 3][..])
        );
        assert_eq!(fields[0].all(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        assert_eq!((fields[0].number(4), fields[1].number(0)), (4.0, 0.1));
        assert!(fields[1].number(1).is_nan());
    }

    #[test]
    fn a_file_that_is_cut_off_or_of_another_kind_is_refused() {
        let whole = file();
        for end in 0..whole.len() {
            assert!(fields(&whole[..end]).is_err(), "{end}");
        }
        let mut other = whole.clone();
        other[12] = 2;
        assert!(fields(&other).err().unwrap().what.contains("version is 2.0"));
        let mut huge = whole;
        huge[32..40].copy_from_slice(&u64::MAX.to_le_bytes());
        assert!(fields(&huge).is_err());
    }
}
