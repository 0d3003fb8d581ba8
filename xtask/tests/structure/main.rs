//! What the sources and the documents look like, in one program that links nothing of the product.

mod circles;
mod documents;
mod figures;
mod markdown;
mod names;
mod packages;
mod sources;
mod spans;
mod terms;
mod unsafe_code;
