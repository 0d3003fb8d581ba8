//! Measures what `morec` recognises, and shows it: no part of recognition depends on this crate.
//!
//! | module | gives |
//! |---|---|
//! | [`eval`] | measures of detections against labelled samples: events, overlaps, false alarms, delays, agreement of annotators |
//! | [`crossval`] | training and testing in turn, by person or by clip |
//! | [`explain`] | the condition that a missed sample failed, and the bones that deviated from the nearest template |
//! | [`perturb`] | clips with the faults of other devices |
//! | [`plot`], [`report`], [`player`] | charts, timelines and pages that play motions (feature `report`) |
//! | [`reproduce`] | the experiments of Bucur 2009, chapter 5, on clips of your own (feature `report`) |
//! | [`tables`] | positions, rotations and feature rows as NumPy archives and CSV (feature `report`) |

#![warn(clippy::missing_errors_doc, clippy::missing_panics_doc)]

pub mod crossval;
pub mod eval;
pub mod explain;
pub mod perturb;

#[cfg(feature = "report")]
pub mod player;
#[cfg(feature = "report")]
pub mod plot;
#[cfg(feature = "report")]
pub mod report;
#[cfg(feature = "report")]
pub mod reproduce;
#[cfg(feature = "report")]
pub mod tables;
