//! Hashes of results.

/// FNV-1a, 64 bits.
pub fn fnv(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Hash of the bits of numbers.
pub fn fnv_of(numbers: impl IntoIterator<Item = f64>) -> u64 {
    fnv(numbers.into_iter().flat_map(f64::to_le_bytes))
}
