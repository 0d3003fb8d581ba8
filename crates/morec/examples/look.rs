#![allow(clippy::print_stdout, missing_docs)]
use morec::files::FileReader;
use morec::roles::Role;
fn main() {
    for path in std::env::args().skip(1) {
        println!("## {path}");
        match FileReader::default().open(path.as_ref()) {
            Err(e) => println!("    REFUSED {e}"),
            Ok(takes) => {
                for t in &takes {
                    let r = &t.report;
                    println!("    length     {} frames {} Hz, {} joints, rot {}", t.clip.frames, t.clip.rate_hz, t.clip.skeleton.len(), r.has_rotations);
                    println!("    up {} unit {:?} ({}) body {:?} legs {:?} set {:?} rest {:?}", r.up, r.unit, r.metres_per_unit, r.body_height, r.leg_length, r.point_set, r.rest_frames);
                    println!("    roles {} missing {:?}", Role::COUNT - t.roles.missing().count(), t.roles.missing().map(|r| r.name()).collect::<Vec<_>>());
                    for n in &r.doubts { println!("    doubt   {n}"); }
                    for n in &r.notes { println!("    note   {n}"); }
                }
                for w in &takes[0].warnings { println!("    warning {}: {}", w.at, w.text); }
            }
        }
    }
}
