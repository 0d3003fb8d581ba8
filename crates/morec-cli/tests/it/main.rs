//! The commands as they are typed: one binary for all of them, a module for each.

mod agree;
mod budget;
mod classify;
mod convert;
mod db;
mod demo;
mod devices;
mod discover;
#[cfg(unix)]
mod documents;
mod evaluate;
mod folders;
mod hands;
mod inspect;
mod kit;
mod labels;
mod live;
mod mice;
mod motion_out;
mod outputs;
mod play;
mod poses;
mod record;
mod smooth;
mod studio;
mod video;
mod words;
