//! Statistical estimation: the paper's nonlinear refinement ([`product`]), and the maximum likelihood fit of a mixture of motions, which
//! [`fit_motions`](crate::fit_motions) uses with [`Method::Best`](crate::Method::Best).

mod estimator;
#[cfg(test)]
mod limit;
mod mixture;
mod precision;
pub mod product;
mod report;
mod samples;
mod score;
mod selection;
mod subset;
mod untangling;

pub(crate) use estimator::Search;
pub(crate) use mixture::Mixture;
pub(crate) use precision::{covariance, determined};
pub use report::{Report, Termination};
pub(crate) use samples::Samples;
pub(crate) use selection::select;
