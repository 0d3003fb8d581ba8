//! Primitives of [`Waker`](super::waker::Waker).

pub(super) use std::sync::OnceLock;
pub(super) use std::sync::atomic::{AtomicBool, Ordering};
pub(super) use std::thread::{Thread, current, park_timeout};
