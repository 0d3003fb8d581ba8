#![no_main]
//! Any bytes read as a role mapping: no panic, every place is one of the joints it is asked for, and a mapping that is
//! written is read again the same.
//!
//! Joints' names come first, one a line, up to an empty line; the mapping follows.

use libfuzzer_sys::fuzz_target;
use morec::clip::{Joint, Skeleton};
use morec::math::Vec3;
use morec::roles::mapping::{Mapping, write};
use morec::roles::{Role, RoleMap};

fuzz_target!(|bytes: &[u8]| {
    let at = bytes.windows(2).position(|w| w == b"\n\n");
    let (names, text) = bytes.split_at(at.unwrap_or(0));
    let names = String::from_utf8_lossy(names);
    let names: Vec<&str> = names.lines().take(64).collect();
    let Ok(mapping) = Mapping::read(text) else {
        return;
    };
    if let Ok(places) = mapping.places(&names) {
        assert!(places.len() <= Role::COUNT);
    }
    let joints = names.iter().enumerate().map(|(at, name)| Joint {
        name: (*name).to_owned(),
        parent: at.checked_sub(1),
        offset: Vec3::y(),
        tip: None,
    });
    let Ok(skeleton) = Skeleton::new(joints.collect()) else {
        return;
    };
    let mut map = RoleMap::find(&skeleton);
    if mapping.apply(&skeleton, &mut map).is_err() {
        return;
    }
    let written = write(&map, &skeleton);
    let unlike = |name: &&str| name.trim() != *name || name.is_empty() || *name == "-";
    let mut sorted = names.clone();
    sorted.sort_unstable();
    let twice = sorted.windows(2).any(|w| w[0] == w[1]);
    // Such names cannot be distinguished from others in a mapping file.
    if twice || names.iter().any(unlike) || names.iter().any(|n| n.contains('\r')) {
        return;
    }
    let again = Mapping::read(written.as_bytes()).expect("what was written can be read");
    let mut map_again = RoleMap::default();
    again
        .apply(&skeleton, &mut map_again)
        .expect("every joint is there");
    for role in Role::ALL {
        assert_eq!(map.joint(role), map_again.joint(role), "{role}");
    }
});
