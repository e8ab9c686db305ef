//! Code shared by several test files.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    dead_code,
    unreachable_pub,
    reason = "every test file uses a part of it"
)]

pub mod moving;
