//! The exponential function for the innermost loop: the same bits everywhere, and simple enough to be vectorised.
//!
//! `exp x = 2ᵏ·exp r` with `k = round(x / ln 2)` and `|r| ≤ ½ ln 2`; `exp r` by its Taylor polynomial of degree 11, whose
//! remainder is below 6·10⁻¹⁵. Only `+ − ×` and bit operations are used, each of them exact to the last bit by IEEE 754.

/// Arguments below this give `exp(LOWEST)`, about 10⁻³⁰⁴: small enough to mean nothing, large enough to stay normal.
pub(crate) const LOWEST: f64 = -700.0;

/// Adding this to a number of size below 2⁵¹ rounds it to an integer, held in the low bits of the sum.
const ROUNDER: f64 = 6_755_399_441_055_744.0; // 1.5·2⁵²
/// ln 2 in two parts; the first has 32 trailing zero bits, so that k·HIGH is exact.
const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// 1/11!, 1/10!, …, 1/2!, 1, 1.
const TAYLOR: [f64; 12] = [
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

/// `exp x` for `x ≤ 0`, relative error below 10⁻¹³; arguments below [`LOWEST`] are raised to it.
#[inline(always)]
pub(crate) fn exp_of_negative(x: f64) -> f64 {
    let x = if x < LOWEST { LOWEST } else { x };
    let shifted = x * std::f64::consts::LOG2_E + ROUNDER;
    let k = shifted - ROUNDER;
    let r = (x - k * LN_2_HIGH) - k * LN_2_LOW;
    let mut p = TAYLOR[0];
    p = p * r + TAYLOR[1];
    p = p * r + TAYLOR[2];
    p = p * r + TAYLOR[3];
    p = p * r + TAYLOR[4];
    p = p * r + TAYLOR[5];
    p = p * r + TAYLOR[6];
    p = p * r + TAYLOR[7];
    p = p * r + TAYLOR[8];
    p = p * r + TAYLOR[9];
    p = p * r + TAYLOR[10];
    p = p * r + TAYLOR[11];
    // The low bits of `shifted` are k in two's complement: moved to the exponent's place they multiply by 2ᵏ.
    f64::from_bits(p.to_bits().wrapping_add(shifted.to_bits() << 52))
}

#[cfg(test)]
mod tests {
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    use super::*;

    #[test]
    fn agrees_with_the_library_to_thirteen_digits() {
        let mut worst = 0.0_f64;
        for i in 0..=200_000 {
            let x = LOWEST * (f64::from(i) / 200_000.0) * (f64::from(i % 1000) / 999.0);
            worst = worst.max((exp_of_negative(x) / libm::exp(x) - 1.0).abs());
        }
        assert!(worst < 1e-13, "relative error {worst:e}");
    }

    #[test]
    fn the_ends_of_its_range_are_what_they_should_be() {
        assert_eq!(exp_of_negative(0.0).to_bits(), 1.0_f64.to_bits());
        assert_eq!(exp_of_negative(-1e300).to_bits(), exp_of_negative(LOWEST).to_bits());
        assert!(exp_of_negative(LOWEST) > 0.0 && exp_of_negative(LOWEST).is_normal());
    }
}
