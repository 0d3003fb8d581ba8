//! The header is that of the sources.

use std::fs;
use std::path::Path;

#[test]
fn the_header_is_current() {
    let crate_folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(crate_folder.join("cbindgen.toml")).unwrap();
    // By its source: given the crate instead, cbindgen would ask cargo for every dependency of every platform.
    let builder = cbindgen::Builder::new().with_src(crate_folder.join("src/lib.rs"));
    let mut made = Vec::new();
    builder
        .with_config(config)
        .generate()
        .unwrap()
        .write(&mut made);
    let made = String::from_utf8(made).unwrap();
    let path = crate_folder.join("include/morec.h");
    if std::env::var_os("MOREC_WRITE_HEADER").is_some() {
        fs::write(&path, &made).unwrap();
    }
    // A checkout may have its own line ends.
    let kept = fs::read_to_string(&path)
        .unwrap_or_default()
        .replace("\r\n", "\n");
    assert!(
        kept == made,
        "include/morec.h is not what the sources give; MOREC_WRITE_HEADER=1 writes it anew"
    );
}
