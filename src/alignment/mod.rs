//! Direct estimation of motions from intensities: robust costs, Gauss-Newton alignment, the dominant motion.

pub(crate) mod brightness;
pub(crate) mod cost;
pub(crate) mod dominant;
pub(crate) mod gauss_newton;
