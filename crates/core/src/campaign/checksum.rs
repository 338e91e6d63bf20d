//! The checksum of a part, which the part itself holds among its notes: of all its bytes but those of the checksum.

use std::ops::Range;

use flexsc_numerics::random::fnv1a_of;

/// The name of the note.
pub const NAME: &str = "flexsc.checksum";
/// Digits of the note before the checksum is known.
pub const BLANK: &str = "0000000000000000";
/// The bytes before the digits: Thrift's compact form of a name of 15 bytes, and of a text of 16 that follows.
const BEFORE: &[u8] = b"\x18\x0fflexsc.checksum\x18\x10";

/// Where the digits are; the notes are near the end of a file.
fn digits(bytes: &[u8]) -> Option<Range<usize>> {
    let before = bytes.windows(BEFORE.len()).rposition(|window| window == BEFORE)?;
    let from = before + BEFORE.len();
    let digits = from..from + BLANK.len();
    (digits.end <= bytes.len()).then_some(digits)
}

fn compute(bytes: &[u8], digits: &Range<usize>) -> String {
    format!("{:016x}", fnv1a_of(&[&bytes[..digits.start], &bytes[digits.end..]]))
}

/// Writes the checksum of a file over the blank one; returns true if there is a blank one.
pub fn fill(bytes: &mut [u8]) -> bool {
    let Some(digits) = digits(bytes) else { return false };
    let sum = compute(bytes, &digits);
    bytes[digits].copy_from_slice(sum.as_bytes());
    true
}

/// Returns true if a file is intact: it has a checksum, which matches its content.
pub fn is_right(bytes: &[u8]) -> bool {
    digits(bytes).is_some_and(|digits| bytes[digits.clone()] == *compute(bytes, &digits).as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_flipped_bit_is_seen() {
        let mut bytes = [b"PAR1 rows ", BEFORE, BLANK.as_bytes(), b" and a footer"].concat();
        assert!(!is_right(&bytes) && fill(&mut bytes) && is_right(&bytes));
        for bit in 0..8 * bytes.len() {
            bytes[bit / 8] ^= 1 << (bit % 8);
            assert!(!is_right(&bytes), "bit {bit}");
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
        assert!(!is_right(b"PAR1") && !is_right(&bytes[..bytes.len() - 1]) && !fill(&mut [0; 40]));
    }

    /// FNV-1a of two published test vectors: of nothing, and of `foobar`.
    #[test]
    fn the_sum_is_the_published_hash() {
        for (pieces, sum) in [(["", ""], 0xcbf2_9ce4_8422_2325), (["foo", "bar"], 0x8594_4171_f739_67e8)] {
            assert_eq!(fnv1a_of(&pieces.map(str::as_bytes)), sum);
        }
    }
}
