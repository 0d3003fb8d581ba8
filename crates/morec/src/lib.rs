//! Index a motion-capture database, recognise its motions live.
//!
//! Labelled motion-capture clips train a [`MotionIndex`], one immutable file; a
//! [`Recognizer`] made from it takes a performer's poses one by one and says which motions
//! happened, from when to when, a tenth of a second or two after each has ended.
//!
//! The library prints nothing and starts no runtime; it takes bytes and values, and opens files only in [`files`] and
//! where a path is given. The command `morec` puts a terminal around it.
//!
//! # Example
//!
//! ```no_run
//! # fn main() -> Result<(), morec::Error> {
//! let takes = morec::files::open_all("clips/")?;                // or morec::Take::from_bvh(&bytes)?
//! let idle = morec::files::open_all("background/")?;            // motion of no class
//! let labels = morec::Labels::from_path("labels.tsv")?;
//! let index = morec::Trainer::new().labels(&labels).background(&idle).train(&takes)?;
//! index.save("signs.index")?;
//!
//! let [take] = &morec::files::open("new.bvh")?[..] else { return Ok(()) };
//! for detection in index.recognize(take)? {
//!     println!("{detection}");                                  // wave from 1.23 s to 2.50 s, score 0.87
//! }
//!
//! let model = index.model.clone();                              // for the names of the classes
//! let mut live = index.recognizer(take.bones())?;               // allocates; says why it cannot
//! for (secs, pose) in take.poses() {                            // world positions of the body's joints, any rate
//!     for detection in live.push(secs, &pose) {                 // allocates nothing, cannot fail
//!         println!("{}", detection.named(&model));
//!     }
//! }
//! # Ok(())
//! # }
//! ```
//!
//! The same on synthetic people, so that it runs anywhere: three teach two gestures, a fourth performs them.
//!
//! ```
//! use morec::synth::{DatabaseSpec, database};
//! use morec::{Labels, Take, Trainer};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let spec = DatabaseSpec { people: 4, repetitions: 2, classes: vec!["wave", "bow"], ..Default::default() };
//! let mut people = database(1, &spec);
//! let new = people.pop().ok_or("nobody")?;
//! let mut labels = Labels::default();
//! for person in &people {
//!     for label in &person.labels {
//!         labels.add(&person.clip.name, label.class, label.span);
//!     }
//! }
//! let takes = people.into_iter().map(|person| Take::new(person.clip)).collect::<Result<Vec<_>, _>>()?;
//!
//! let index = Trainer::new().labels(&labels).train(&takes)?;
//! let found = index.recognize(&Take::new(new.clip)?)?;
//! assert!(found.len() >= 2 && found.iter().all(|d| ["wave", "bow"].contains(&d.class)));
//! # Ok(())
//! # }
//! ```
//!
//! # The way of the data
//!
//! | step | module | gives |
//! |---|---|---|
//! | bytes of a file | [`formats`] | a [`Clip`]: skeleton, frames, and what had to be repaired |
//! | units, axes, body parts | [`import`], [`roles`] | metres, Y up, a [`RoleMap`](roles::RoleMap) |
//! | rotations of what has positions only | [`fitting`] | a skeleton of fixed bone lengths, and its residuals |
//! | poses in the world | [`kinematics`] | a [`KeyPose`] for each frame |
//! | feature rows | [`features`] | 30 rows a second, alike for people of any size, facing anywhere |
//! | learning | [`labels`], [`train`] | a [`TemplateModel`](templates::TemplateModel) and a report |
//! | keeping | [`index`] | one file, with a checksum and where it came from |
//! | recognising | [`templates`] or [`svrdm`], [`decode`], [`live`] | [`Detection`]s, nothing taken back |
//! | naming whole clips | [`classify`] | one class each, or none, with probabilities |
//! | looking at a stream | [`diagnosis`] | what is wrong with it, in sentences that say what to do |
//! | without labels | [`pivots`], [`pca`], [`segment`], [`cluster`] | pose rows, fewer dimensions, cuts, samples that are alike |
//!
//! [`smooth`] turns clips into keyframes and curves, a small form to keep them in. [`synth`] makes people, clips and
//! labels where there are none; [`resample`], [`math`], [`classes`] and [`progress`] are shared by several of these.
//!
//! Clips and what is read from them are the crate `mocap`, rows and classes `morec-features`, [`pivots`], [`pca`] and [`svrdm`]
//! (the method of 2009) `morec-svrdm`; their modules have their paths here. Figures, reports, pictures and tables of what was
//! recognised are the crate `morec-measure`.
//!
//! # Features
//!
//! All are on by default but `fbx` and `hdf5`.
//!
//! | feature | has |
//! |---|---|
//! | `live` | index files, and recognition of poses: [`index`], [`live`], [`diagnosis`] and what they need |
//! | `formats` | clip files as bytes, and takes: [`formats`], [`import`], [`smooth`] |
//! | `files` | clip files by path: [`files`]; includes `formats` |
//! | `train` | labels, training, synthetic people; includes `formats` and `live` |
//! | `fbx` | FBX files, which takes a C compiler |
//! | `hdf5` | HDF5 files of pose estimators |
//!
//! # Notation
//!
//! Times are seconds in every public interface, frames stand beside them only where files count in them; ranges are
//! half-open. Angles are radians, lengths metres after [`import`]. A rotation called `a_from_b` takes coordinates in
//! `b` to coordinates in `a`.
//!
//! | sign | is |
//! |---|---|
//! | `b` | bones that a skeleton and an index have in common: at most 11 of a body, 52 with hands and points |
//! | `d` | values in a feature row of a body: `6 b + 4`, 70 with its 11 bones |
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

#![warn(clippy::missing_errors_doc, clippy::missing_panics_doc)]

#[cfg(any(feature = "formats", feature = "live"))]
mod facade;

#[cfg(feature = "live")]
pub mod classify;
#[cfg(feature = "live")]
pub mod decode;
#[cfg(feature = "live")]
pub mod diagnosis;
#[cfg(feature = "live")]
pub mod index;
#[cfg(feature = "live")]
pub mod live;
#[cfg(feature = "live")]
mod periodicity;
#[cfg(feature = "live")]
pub mod templates;

#[cfg(feature = "train")]
pub mod cluster;
#[cfg(feature = "train")]
pub mod discover;
#[cfg(feature = "train")]
pub mod labels;
#[cfg(feature = "train")]
pub mod segment;
#[cfg(feature = "train")]
pub mod synth;
#[cfg(feature = "train")]
pub mod train;

/// The Rust of README, so that it compiles.
#[cfg(all(doctest, feature = "files", feature = "train"))]
#[doc = include_str!("../README.md")]
mod readme {}

#[cfg(any(feature = "formats", feature = "live"))]
pub use facade::Error;
#[cfg(feature = "train")]
pub use facade::Trainer;
#[cfg(feature = "live")]
pub use index::MotionIndex;
#[cfg(feature = "train")]
pub use labels::Labels;
#[cfg(feature = "live")]
pub use live::{Detection, Event, Recognizer, Session};
#[cfg(feature = "files")]
pub use mocap::files;
#[doc(hidden)] // For lines of JSON that arrive live.
pub use mocap::nan;
pub use mocap::{
    BoneSet, Clip, KeyPose, ParseError, Place, SignedAxis, Skeleton, TimeSpan, Warning, clip,
    humanoid, kinematics, math, pose, progress, resample, rng, roles,
};
#[cfg(feature = "formats")]
pub use mocap::{ImportOptions, Take, fitting, formats, import, smooth};
#[doc(inline)]
pub use morec_features as features;
pub use morec_features::{ClassId, ClassInfo, classes};
#[cfg(feature = "live")]
pub use morec_svrdm::{pca, pivots, svrdm};
#[cfg(feature = "train")]
pub use train::TrainingReport;
