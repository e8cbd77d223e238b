//! Damage to the bytes of a file, as disks, editors and transfers do it, and as a fuzzer does.

use super::seeded::SeededNumbers;

/// Largest file that damage makes, bytes.
const LARGEST: usize = 1 << 20;
/// Longest piece that is repeated, overwritten or moved, bytes.
const LONGEST_PIECE: usize = 64;
/// Bytes that readers treat unlike others.
const SPECIAL: [u8; 12] = [
    0, b'\n', b'\r', b'"', b'-', b'.', b'0', b'9', b'e', 0x7f, 0x80, 0xff,
];

/// The bytes with one to four damages. `words` are inserted or put in place of others; `other` is
/// another file of the kind, whose end may take the place of this one's.
pub fn damaged(bytes: &[u8], other: &[u8], words: &[&str], random: &mut SeededNumbers) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        damage(&mut bytes, other, words, random);
        bytes.truncate(LARGEST);
    }
    bytes
}

fn damage(bytes: &mut Vec<u8>, other: &[u8], words: &[&str], random: &mut SeededNumbers) {
    let at = random.below(bytes.len() + 1);
    let end = (at + random.below(LONGEST_PIECE)).min(bytes.len());
    match random.below(9) {
        0 => bytes.truncate(at),
        1 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        2 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte = *random.pick(&SPECIAL);
            }
        }
        3 => drop(bytes.drain(at..end)),
        4 => {
            let piece = bytes[at..end].repeat(1 + random.below(20));
            bytes.splice(at..at, piece);
        }
        5 => bytes[at..end].fill(0),
        6 => {
            let from = random.below(other.len() + 1);
            bytes.truncate(at);
            bytes.extend_from_slice(&other[from..]);
        }
        7 => swap_words(bytes, random),
        _ => {
            let word = random.pick(words).as_bytes();
            let until = if random.one_in(2) { at } else { end };
            bytes.splice(at..until, word.iter().copied());
        }
    }
}

/// Two words, numbers or lines change places.
fn swap_words(bytes: &mut Vec<u8>, random: &mut SeededNumbers) {
    let parts = |byte: &u8| *byte == *b"\n,: ".get(usize::from(byte & 3)).unwrap_or(&b'\n');
    let mut words: Vec<Vec<u8>> = bytes.split_inclusive(parts).map(<[u8]>::to_vec).collect();
    let (one, other) = (random.below(words.len()), random.below(words.len()));
    if !words.is_empty() {
        words.swap(one, other);
    }
    *bytes = words.concat();
}
