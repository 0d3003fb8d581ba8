#![no_main]
//! Any bytes as the files of one archive, motions with the skeletons, buffers, frames and archives that lie beside them: no panic, and
//! no clip that is not whole.

use std::io::{Cursor, Write};
use std::path::Path;

use libfuzzer_sys::fuzz_target;
use morec::files::FileReader;
use morec_fuzz::{LIMITS, check};
use zip::CompressionMethod;
use zip::write::SimpleFileOptions;

const NAMES: [&str; 13] = [
    "a.amc", "a.asf", "b/a.asf", "a.mot", "a.osim", "a.gltf", "keys.bin", "f_1.json", "f_2.json", "f_3.json", "a.bvh",
    "a.bvh.gz", "in.zip",
];

fuzz_target!(|files: Vec<(u8, Vec<u8>)>| {
    let mut out = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let plain = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (kind, bytes) in &files {
        let name = NAMES[usize::from(*kind) % NAMES.len()];
        // A name that is taken is refused; the others make the archive.
        if out.start_file(name, plain).is_ok() {
            out.write_all(bytes).expect("memory takes every byte");
        }
    }
    let bytes = out.finish().expect("memory takes every byte").into_inner();
    let reader = FileReader {
        limits: LIMITS,
        ..FileReader::default()
    };
    if let Ok(read) = reader.parse(Path::new("all.zip"), &bytes) {
        read.clips.iter().for_each(check);
    }
});
