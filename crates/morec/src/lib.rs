//! Index a motion-capture database, recognise its motions live.
//!
//! Labelled motion-capture clips train a [`MotionIndex`](index::MotionIndex), one immutable file; a
//! [`Recognizer`](live::Recognizer) made from it takes a performer's poses one by one and says which motions
//! happened, from when to when, a tenth of a second or two after each has ended.
//!
//! The library takes bytes and values and gives bytes and values: it opens no file, prints nothing, starts no
//! runtime. The command `morec` puts files and a terminal around it.
//!
//! # Example
//!
//! Three made people teach two gestures; a fourth, whom the index has never seen, performs them.
//!
//! ```
//! use std::sync::Arc;
//!
//! use morec::features::{bones_of_clip, for_each_pose};
//! use morec::import::{ImportOptions, prepare};
//! use morec::labels::Sample;
//! use morec::live::Recognizer;
//! use morec::synth::{DatabaseSpec, database};
//! use morec::train::{Labelling, Source, TrainClip, TrainOptions, train_clips};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // Clips from files come from formats::bvh::read or formats::acclaim; these are made.
//! let classes = ["wave", "bow"];
//! let spec = DatabaseSpec { people: 4, repetitions: 2, classes: classes.to_vec(), ..Default::default() };
//! let mut takes = database(1, &spec);
//! let new = takes.pop().ok_or("nobody")?;
//!
//! let (mut clips, mut samples) = (Vec::new(), Vec::new());
//! for take in &takes {
//!     // Metres, Y up, and which joint is which part of the body.
//!     let imported = prepare(take.clip.clone(), &ImportOptions::default())?;
//!     clips.push(TrainClip {
//!         name: take.clip.name.clone(),
//!         clip: imported.clip,
//!         roles: imported.roles,
//!         rest: imported.facts.rest_frames,
//!         source: Source::Labelled,
//!         person: Some(take.person.clone()),
//!     });
//!     samples.extend(take.labels.iter().map(|label| Sample {
//!         clip: take.clip.name.clone(),
//!         class: label.class.to_owned(),
//!         start_secs: label.start_secs,
//!         stop_secs: label.stop_secs,
//!         whole_clip: false,
//!         person: Some(take.person.clone()),
//!         line: 0,
//!     }));
//! }
//! let labelling = Labelling {
//!     samples: &samples,
//!     classes: &classes.map(str::to_owned),
//!     unlabelled_is_background: true,
//!     ..Default::default()
//! };
//! // The last argument hears of progress and may cancel; () does neither.
//! let (model, report) = train_clips(&clips, &labelling, &TrainOptions::default(), &())?;
//! assert_eq!(report.classes.len(), 2);
//!
//! // The live side: poses come with a time, at any rate, even or uneven.
//! let model = Arc::new(model);
//! let performer = prepare(new.clip, &ImportOptions::default())?;
//! let (clip, roles, rest) = (&performer.clip, &performer.roles, &performer.facts.rest_frames);
//! let mut recognizer = Recognizer::new(&model, bones_of_clip(clip, roles, rest))?;
//! let mut found = Vec::new();
//! for_each_pose(clip, roles, rest, |time_secs, pose| {
//!     found.extend_from_slice(recognizer.push(time_secs, pose)); // no allocation, no failure
//! });
//! found.extend_from_slice(recognizer.finish());
//! for d in &found {
//!     let class = &model.classes[d.class.index()].name;
//!     println!("{class} from {:.2} s to {:.2} s, said at {:.2} s", d.start_secs, d.stop_secs, d.reported_secs);
//! }
//! assert!(found.len() >= 2);
//! # Ok(())
//! # }
//! ```
//!
//! # The way of the data
//!
//! | step | module | gives |
//! |---|---|---|
//! | bytes of a file | [`formats`] | a [`Clip`](clip::Clip): skeleton, frames, and what had to be repaired |
//! | units, axes, body parts | [`import`], [`roles`] | metres, Y up, a [`RoleMap`](roles::RoleMap) |
//! | poses in the world | [`kinematics`] | a [`KeyPose`](features::KeyPose) for each frame |
//! | feature rows | [`features`] | 30 rows a second, alike for people of any size, facing anywhere |
//! | learning | [`labels`], [`train`] | a [`TemplateModel`](templates::TemplateModel) and a report |
//! | keeping | [`index`] | one file, with a checksum and where it came from |
//! | recognising | [`templates`] or [`svrdm`], [`decode`], [`live`] | [`Detection`](live::Detection)s, nothing taken back |
//! | looking at a stream | [`diagnosis`] | what is wrong with it, in sentences that say what to do |
//! | without labels | [`pivots`], [`pca`], [`segment`], [`cluster`] | pose rows, fewer dimensions, cuts, samples that are alike |
//! | measuring | [`eval`], [`crossval`], [`report`], [`plot`] | figures, timelines, charts, one page of HTML |
//!
//! [`smooth`] turns clips into keyframes and curves, a small form to keep them in. [`synth`] makes people, clips and
//! labels where there are none; [`resample`], [`math`], [`classes`] and [`progress`] are shared by several of these.
//!
//! # Notation
//!
//! Times are seconds in every public interface, frames stand beside them only where files count in them; ranges are
//! half-open. Angles are radians, lengths metres after [`import`]. A rotation called `a_from_b` takes coordinates in
//! `b` to coordinates in `a`.
//!
//! | sign | is |
//! |---|---|
//! | `b` | bones that a skeleton and an index have in common, at most 11 |
//! | `d` | values in a feature row: `6 b + 4`, 70 with all bones |
//! | `t` | a tick: one feature row, 1/30 s unless an index says otherwise |
//! | `x`, `v` | bone directions in the heading frame, and their velocities (`3 b` values each) |
//! | `z` | a feature row `[x ; β v ; γ root]`, then mapped by the metric: `A z` |
//! | `A` | the metric, `d × d`: `(S_w + ρ tr(S_t)/d · I)^(−1/2)`, scaled |
//! | `S_w`, `S_t` | covariance of rows within a class between people; of all rows |
//! | `T`, `n` | a template (a sample's mapped rows) and its length in ticks |
//! | `c(j,t)` | `‖T_j − z_t‖²` |
//! | `D(j,t)` | cost of the best path of the template's first `j` rows that ends at tick `t` |
//! | `d_c(t)` | distance of class `c` at tick `t`: the least `D(n,t)/n` of its templates |
//! | `n(t)` | the same of the negative templates |
//! | `θ`, `κ` | the threshold of distances, and the gate against negatives |
//!
//! The method with its sources is in `docs/method.md`, the invariants in `ARCHITECTURE.md`, the reasons for every
//! dependency in `docs/decisions.md`.

pub mod classes;
pub mod clip;
pub mod cluster;
mod coder;
pub mod crossval;
pub mod decode;
pub mod diagnosis;
pub mod eval;
pub mod features;
pub mod formats;
pub mod import;
pub mod index;
pub mod kinematics;
pub mod labels;
pub mod live;
pub mod math;
pub mod pca;
pub mod perturb;
pub mod pivots;
pub mod plot;
pub mod progress;
pub mod report;
pub mod reproduce;
pub mod resample;
pub mod roles;
pub mod segment;
pub mod smooth;
pub mod svrdm;
pub mod synth;
pub mod templates;
#[cfg(test)]
#[path = "../tests/testing/mod.rs"]
mod testing;
pub mod train;
