//! Codes of windows: what moves how much, and the travel, in 48 bytes, by which clips are sorted before any bound is taken.
//!
//! A code is of windows of some lengths alone, each half as far from the next as it is long. An example is compared with those of the
//! length that is nearest to its own. That is no bound of its distance, and says well enough which clips to look at first.

use std::sync::OnceLock;

use morec::features::{BODY_BONES, BoneSet};
use multiversion::multiversion;
use rayon::prelude::*;

use super::bound::{SketchedClip, SketchedClips};
use super::probe::{OCTAVES, SIDE, SharedLanes, SketchProbe, SketchProbes};
use super::sketch::{Sketch, SketchBytes, SketchLanes, SketchTables};
use super::summary::WEIGHTS;
use super::window_sketch::{PARTS, WindowSketch, asinh};
use super::windows::{TRAVEL, X};
use super::{Example, SearchOptions};

/// Rows of windows that have codes.
const LEVELS: [usize; 4] = [32, 64, 128, 256];
/// Values of a code that are of motion: deviations of the coordinates, and of the bones between the halves of the window.
const MOTION: usize = X + BODY_BONES;
/// All values of a code; the last are those of travel.
const VALUES: usize = MOTION + TRAVEL;
/// What a value of motion, of travel, counts.
const UNITS: (f32, f32) = (1.0 / 200.0, 1.0 / 24.0);
/// Clips of a group, whose codes lie together.
const GROUP: usize = 4096;

/// The codes of clips, made when an example of about a length is first searched for: three bytes a row of windows of 32 rows, and half of
/// that for each doubling.
#[derive(Debug, Default)]
pub struct SketchCodes {
    levels: [OnceLock<Vec<CodeGroup>>; LEVELS.len()],
}

/// Codes of some clips that lie together.
#[derive(Debug, Default)]
struct CodeGroup {
    /// Of each clip its bones, its rows and where its codes end.
    clips: Vec<(BoneSet, usize, usize)>,
    codes: Vec<[u8; VALUES]>,
}

/// An example as codes are compared with it, for clips of some bones.
struct ProbeCode {
    code: [i16; VALUES],
    /// All bits of what is compared, none of what is not.
    mask: [i16; VALUES],
    /// Of the length of what motion differs by.
    motion: f32,
}

impl SketchCodes {
    /// For each clip about how far its nearest window is from the example or its mirror image; infinite if it shares no bone with them. O(codes).
    pub fn estimates(
        &self,
        example: &Example,
        options: &SearchOptions,
        clips: &impl SketchedClips,
    ) -> Vec<f32> {
        let query = SketchProbes::of(example, options);
        let groups = self.groups(query.rows, clips);
        groups
            .par_iter()
            .flat_map_iter(|group| group.estimates(&query))
            .collect()
    }

    /// The codes of windows of the length that is nearest to this many rows.
    fn groups(&self, rows: usize, clips: &impl SketchedClips) -> &[CodeGroup] {
        let far = |level: &usize| (LEVELS[*level] as f32 / rows as f32).ln().abs();
        let level = (0..LEVELS.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
        let level = level.unwrap_or(0);
        self.levels[level].get_or_init(|| {
            let starts = (0..clips.count()).into_par_iter().step_by(GROUP);
            let group = |start: usize| {
                let of_group = start..clips.count().min(start + GROUP);
                CodeGroup::of(LEVELS[level], of_group.map(|at| clips.clip(at)))
            };
            starts.map(group).collect()
        })
    }
}

impl CodeGroup {
    fn of<'a>(level: usize, clips: impl Iterator<Item = SketchedClip<'a>>) -> Self {
        let (mut sketch, tables) = (Sketch::default(), SketchTables::new());
        let mut window = WindowSketch::default();
        let mut group = Self::default();
        for clip in clips {
            let mut rows = 0;
            if let Some(bytes) = SketchBytes::of(clip.sketch) {
                rows = bytes.rows;
                sketch.read(&bytes, &tables);
                let length = level.min(rows);
                let last = rows - length;
                let starts = (0..last).step_by((length / 2).max(1));
                for start in starts.chain([last]) {
                    window.turn(start, length);
                    let code = code_of_window(&mut window, &sketch, &tables);
                    group.codes.push(code);
                }
            }
            group.clips.push((clip.bones, rows, group.codes.len()));
        }
        group
    }

    /// About how far the nearest window of each clip is.
    fn estimates(&self, query: &SketchProbes) -> Vec<f32> {
        let (mut of_bones, mut probes) = (None, Vec::new());
        let mut begin = 0;
        let mut estimates = Vec::with_capacity(self.clips.len());
        for (bones, rows, end) in &self.clips {
            // Most clips show the same bones.
            if of_bones != Some(*bones) {
                let shared = query.shared(*bones);
                let pairs = query.probes.iter().zip(&shared);
                probes = pairs.map(|(p, shared)| ProbeCode::of(p, shared)).collect();
                of_bones = Some(*bones);
            }
            let codes = &self.codes[begin..*end];
            begin = *end;
            estimates.push(match (probes.is_empty(), codes.is_empty()) {
                (true, _) => f32::INFINITY,
                // Nothing is known of it: it is looked at first.
                (false, true) => 0.0,
                (false, false) => query.excess(*rows) + nearest(&probes, codes),
            });
        }
        estimates
    }
}

/// The code of a window of a sketch.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn code_of_window(
    window: &mut WindowSketch,
    sketch: &Sketch,
    tables: &SketchTables,
) -> [u8; VALUES] {
    window.take(sketch, tables, [0, PARTS]);
    window.take_halves(sketch, tables);
    window.take_eighths(sketch, tables);
    let mut octaves = [SketchLanes::ZERO; OCTAVES];
    for octave in 0..OCTAVES {
        window.energy(octave, &mut octaves[octave]);
    }
    let mut travels = [0f32; SIDE];
    travels[..TRAVEL].copy_from_slice(&window.mean_travel());
    let travels = asinh(&travels);
    code(&octaves, &travels[..TRAVEL])
}

/// The code of energies by octave and lane, and of a travel.
#[inline(always)]
fn code(octaves: &[SketchLanes; OCTAVES], travel: &[f32]) -> [u8; VALUES] {
    let mut code = [0u8; VALUES];
    let mut of_bones = [0f32; BODY_BONES];
    for lane in 0..X {
        let energy = octaves[0].0[lane] + octaves[1].0[lane] + octaves[2].0[lane];
        code[lane] = (energy.sqrt() / UNITS.0 + 0.5) as u8;
        of_bones[lane / 3] += octaves[0].0[lane];
    }
    for bone in 0..BODY_BONES {
        code[X + bone] = (of_bones[bone].sqrt() / UNITS.0 + 0.5) as u8;
    }
    for i in 0..TRAVEL {
        code[MOTION + i] = (travel[i] / UNITS.1 + 128.5) as u8;
    }
    code
}

impl ProbeCode {
    fn of(probe: &SketchProbe, shared: &SharedLanes) -> Self {
        let mut energies = probe.octaves;
        for octave in &mut energies {
            octave.0.iter_mut().for_each(|value| *value *= *value);
        }
        let mut mask = [-1i16; VALUES];
        for lane in 0..X {
            mask[lane] = -i16::from(shared.mask.0[lane] > 0.0);
        }
        for bone in 0..BODY_BONES {
            mask[X + bone] = -i16::from(shared.bone_mask[bone] > 0.0);
        }
        Self {
            code: code(&energies, &probe.travel).map(i16::from),
            mask,
            motion: WEIGHTS.motion * shared.scale * UNITS.0,
        }
    }
}

/// The least distance of codes from an example or its mirror image.
#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn nearest(probes: &[ProbeCode], codes: &[[u8; VALUES]]) -> f32 {
    let mut least = f32::INFINITY;
    for probe in probes {
        for code in codes {
            let mut apart = [0i16; VALUES];
            for i in 0..VALUES {
                apart[i] = (i16::from(code[i]) - probe.code[i]) & probe.mask[i];
            }
            let (mut all, mut travel) = (0i32, 0i32);
            for i in 0..VALUES {
                all += i32::from(apart[i]) * i32::from(apart[i]);
            }
            for i in MOTION..VALUES {
                travel += i32::from(apart[i]) * i32::from(apart[i]);
            }
            let motion = probe.motion * ((all - travel) as f32).sqrt();
            least = least.min(motion + WEIGHTS.travel * UNITS.1 * (travel as f32).sqrt());
        }
    }
    least
}
