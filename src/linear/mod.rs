//! Dense linear algebra that the embedded data needs and a general library does not offer: QR of a tall matrix that arrives
//! in blocks of rows, and the null vector of its triangle. Knows nothing of motions.

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
