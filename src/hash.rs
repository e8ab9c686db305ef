//! A hash for recognising data later, the same in every build. Not for keys that somebody may choose. XXH64 is as good and takes five times
//! as much code in the module.

/// An odd number without a pattern, as in FxHash.
const MULTIPLIER: u64 = 0x517c_c1b7_2722_0a95;

/// A hash of some bytes: words of 64 bits, multiplied and folded. A change within one word always changes it.
#[inline(never)]
pub(crate) fn hash(seed: u64, bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut last = [0; 8];
    last[..rest.len()].copy_from_slice(rest);
    let length = (bytes.len() as u64).to_le_bytes();
    words.iter().chain([&last, &length]).fold(seed, |hash, word| {
        let product = (hash ^ u64::from_le_bytes(*word)).wrapping_mul(MULTIPLIER);
        product ^ (product >> 32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_the_order_the_length_and_the_seed_count() {
        let bytes: Vec<u8> = (0..43).map(|k| 5 * k).collect();
        let mut others = vec![
            bytes[..42].to_vec(),
            [&bytes[..], &[0]].concat(),
            [&bytes[8..16], &bytes[..8], &bytes[16..]].concat(),
        ];
        others.extend((0..8 * bytes.len()).map(|bit| {
            let mut other = bytes.clone();
            other[bit / 8] ^= 1 << (bit % 8);
            other
        }));
        let mut hashes: Vec<u64> = others.iter().map(|other| hash(0, other)).collect();
        hashes.extend([hash(0, &bytes), hash(0, &[]), hash(0, &[0])]);
        hashes.sort_unstable();
        assert!(hashes.windows(2).all(|pair| pair[0] != pair[1]));
        assert_ne!(hash(0, &bytes), hash(1, &bytes));
    }
}
