//! One file per command. Each has its arguments, `Args`, and `run(Args) -> anyhow::Result<ExitCode>`.
//!
//! Exit codes: 0 all went well; 1 something could not be done (the message says what); 2 the command line was
//! wrong.

pub mod agree;
pub mod bench;
pub mod budget;
pub mod classify;
pub mod complete;
pub mod convert;
pub mod crossval;
pub mod cut;
pub mod db;
pub mod demo;
pub mod discover;
pub mod evaluate;
pub mod group;
pub mod inspect;
pub mod live;
pub mod play;
pub mod recognize;
pub mod record;
pub mod reduce;
pub mod reproduce;
pub mod send;
pub mod smooth;
pub mod studio;
pub mod teach;
pub mod train;
