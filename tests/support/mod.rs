//! Code shared by several test files.
#![allow(dead_code, unreachable_pub, reason = "every test file uses a part of it")]

pub mod protocol;
