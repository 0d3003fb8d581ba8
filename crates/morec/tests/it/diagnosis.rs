//! Real clips of people before calibrated devices: a warning or an error in one is a false one.

use std::path::Path;

use morec::diagnosis::{Diagnoser, Finding, Severity, diagnose_clip};
use morec::features::for_each_pose;
use morec::formats::{Limits, bvh};
use morec::import::{ImportOptions, Take, normalize};
use morec::roles::{Role, RoleMap};

use crate::kit::data;

fn clips(folder: &Path) -> Vec<Take> {
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ext| ext == "bvh"))
        .collect();
    paths.sort();
    let read = |path: &std::path::PathBuf| {
        let name = path.file_stem().unwrap().to_string_lossy();
        let bytes = std::fs::read(path).unwrap();
        let loaded = bvh::read(&bytes, &name, &Default::default(), &Limits::default()).unwrap();
        normalize(
            loaded.clips.into_iter().next().unwrap(),
            &ImportOptions::default(),
        )
        .unwrap()
    };
    paths.iter().map(read).collect()
}

fn matters(finding: &&Finding) -> bool {
    finding.severity() >= Severity::Warning
}

/// False findings in a clip as a whole and at every moment of it as a live stream, and the number of moments.
fn false_findings(take: &Take, roles: &RoleMap) -> (Vec<String>, usize) {
    let (clip, rest) = (&take.clip, take.rest());
    let whole = diagnose_clip(clip, roles, rest);
    let mut found: Vec<String> = whole
        .findings()
        .iter()
        .filter(matters)
        .map(|finding| format!("{}: {finding}", clip.name))
        .collect();
    let (mut diagnoser, mut said, mut moments) = (Diagnoser::live(), 0, 0);
    for_each_pose(clip, roles, rest, |secs, pose| {
        diagnoser.push(secs, secs, pose);
        if !diagnoser.frames().is_multiple_of(16) {
            return;
        }
        moments += 1;
        let findings = diagnoser.diagnosis().findings();
        for finding in findings.iter().filter(matters) {
            if said & finding.bit() == 0 {
                found.push(format!("{} at {secs:.2} s: {finding}", clip.name));
            }
            said |= finding.bit();
        }
    });
    (found, moments)
}

#[test]
fn real_clips_give_no_false_finding() {
    let Some(data) = data() else { return };
    let (mut clips_seen, mut moments, mut mirrored, mut false_ones) = (0, 0, 0, Vec::new());
    for set in ["referee", "gestures", "sessions", "everyday"] {
        for take in clips(&data.join(set).join("clips")) {
            clips_seen += 1;
            // The mirror image of a clip has the opposite of its evidence, and is reported by it.
            let whole = diagnose_clip(&take.clip, &take.roles, take.rest());
            mirrored += usize::from(whole.sides.sum().is_some_and(|sum| sum > 0.08));
            let (found, of_clip) = false_findings(&take, &take.roles);
            false_ones.extend(found.iter().map(|finding| format!("{set}/{finding}")));
            moments += of_clip;
        }
    }
    eprintln!(
        "{clips_seen} clips, {moments} moments of streams, {} false findings; the mirror images of {mirrored} clips are reported",
        false_ones.len()
    );
    assert!(clips_seen >= 795, "{clips_seen} clips");
    assert!(
        mirrored * 100 >= clips_seen * 95,
        "{mirrored} of {clips_seen}"
    );
    assert!(false_ones.is_empty(), "{false_ones:#?}");
}

#[test]
fn real_upper_bodies_give_no_false_finding() {
    let Some(data) = data() else { return };
    let mut false_ones = Vec::new();
    for take in clips(&data.join("sessions/clips")) {
        let mut roles = take.roles.clone();
        for role in &Role::ALL[..Role::Neck.index()] {
            roles.set(*role, None);
        }
        false_ones.extend(false_findings(&take, &roles).0);
        let whole = diagnose_clip(&take.clip, &roles, take.rest());
        assert_eq!(whole.metres_per_unit, 1.0, "{whole}");
    }
    assert!(false_ones.is_empty(), "{false_ones:#?}");
}
