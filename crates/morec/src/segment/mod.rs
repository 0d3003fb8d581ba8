//! Cutting a clip where one behaviour ends and another begins, without labels (thesis §3.5, Algorithm 2).
//!
//! The first `K` frames of a segment are modelled by probabilistic principal components (Tipping and Bishop 1999); the
//! next `T` frames are held against the model; `K` grows by `Δ` until the frames ahead stop fitting (Barbič, Safonova,
//! Pan, Faloutsos, Hodgins, Pollard: *Segmenting motion capture data into distinct behaviors*, 2004). Cycles of one
//! behaviour stay together: what is found are changes of behaviour, not repetitions.
//!
//! Notation: `n` values in a row, `r` dimensions of the model, `λᵢ` its eigenvalues, `λ` the mean of the others, `H` the
//! mean Mahalanobis distance of the frames ahead. Rows may be of any description at any even rate.
//!
//! Change points of a kernel ([`change_points`], [`kernel_cuts`]) are the default beside it:
//!
//! ```
//! use morec::features::Rows;
//! use morec::segment::change_points;
//!
//! let (still, moving) = (vec![0.0f32; 40], vec![1.0f32; 40]);
//! let rows = Rows::from_values(1, [still, moving].concat());
//! assert_eq!(change_points(&rows, 1.0, 10), [40]);
//! ```

mod cuts;
mod cycles;
mod kernel;
mod params;
mod pass;
mod peaks;
mod ppca;
mod still;
mod windows;

pub use cuts::{Cut, MisfitSample, Segmentation, segment};
pub use cycles::{CycleParams, Cycles, cycles};
pub use kernel::{KernelParams, change_points, kernel_cuts};
pub use params::{PassDirections, PpcaParams, SegmentError};
pub use ppca::Ppca;
pub use still::{StillKind, StillParams, still_stretches};
pub use windows::{WindowRows, window_rows};

#[cfg(test)]
mod tests;
