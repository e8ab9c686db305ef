//! Dense linear algebra for the embedded data: the QR decomposition of a tall matrix that arrives in blocks of rows, the null vector
//! of its triangle, and minimum norm least squares.
//!
//! Results have the same bits on every platform.
//!
//! ```
//! use veronese::linear::{NullVector, RowQr};
//!
//! // Points on the plane x + 2y − z = 0, four at a time, column-major.
//! let mut qr = RowQr::new(3);
//! for k in 0..5 {
//!     let x: Vec<f64> = (0..4).map(|i| f64::from(4 * k + i) * 0.3 - 2.0).collect();
//!     let y: Vec<f64> = x.iter().map(|x| x * x - 1.0).collect();
//!     let z = x.iter().zip(&y).map(|(x, y)| x + 2.0 * y);
//!     let mut block: Vec<f64> = x.iter().copied().chain(y.iter().copied()).chain(z).collect();
//!     qr.absorb(4, &mut block);
//! }
//! let null = NullVector::of(&qr.into_triangle());
//! assert!(null.residual < 1e-13);
//! let [a, b, c] = null.vector[..] else { unreachable!() };
//! assert!((a / c + 1.0).abs() < 1e-13 && (b / c + 2.0).abs() < 1e-13);
//! ```

pub(crate) mod kernels;
mod least_squares;
mod null_vector;
mod qr;
mod singular_values;
mod triangle;

pub use least_squares::least_squares;
pub use null_vector::NullVector;
pub use qr::RowQr;
pub use triangle::Triangle;
