//! morec for C, and for everything that can call C.
//!
//! `include/morec.h` is made from this crate; `README.md` beside it is the manual. Two ways in, which do not know of
//! each other:
//!
//! - Handles (`morec_…`): load an index, create a recogniser, push frames, poll events. No threads of its own, no
//!   callbacks, nothing global but the table of handles and each thread's last error.
//! - Eight calls (`mr…`) over one session in the process, as specified by Bucur, *Efficient motion capture database
//!   indexing on the Cell processor*, 2009, Table 4.3, with a clip played as the source of motion.
//!
//! Invariants of the boundary, and the modules that hold them:
//!
//! - No panic crosses it: every function runs inside `status::guard`.
//! - Handles are numbers, never followed: null, foreign and destroyed ones are looked up in `handles` and refused.
//! - Pointers to data are followed in `memory` only, after looking at whether they are null or misaligned.
//! - A recogniser in use by another thread is refused, not waited for.

#![deny(unsafe_op_in_unsafe_fn)]

mod axes;
mod diagnosis;
mod eight;
mod event;
mod frame;
mod handles;
mod index;
mod memory;
mod recognizer;
mod skeleton;
mod status;
mod stream;
mod words;

pub use axes::{MorecHandedness, MorecUpAxis};
pub use diagnosis::{
    MorecDiagnosis, MorecFinding, MorecSeverity, morec_recognizer_diagnosis,
    morec_recognizer_diagnosis_text,
};
pub use eight::{
    MotionSeg, mrInit, mrIsDataSourceDepleted, mrQueryMotionSegments, mrSetDataSource,
    mrSetDataSourceSpeed, mrStart, mrStop, mrStopDataSource, mrTerminate,
};
pub use event::{MorecEvent, MorecPhase, morec_bone_name};
pub use frame::{MorecFrame, MorecSpace};
pub use handles::{MorecIndex, MorecRecognizer};
pub use index::{
    MorecIndexFacts, MorecMethod, morec_index_class_name, morec_index_destroy, morec_index_facts,
    morec_index_from_memory, morec_index_load,
};
pub use recognizer::{
    MOREC_DEVIATION, MOREC_EACH_REPETITION, MOREC_PERFORMER_ANYONE, MOREC_PERFORMER_TEACHER,
    MOREC_PROGRESS, MOREC_TENTATIVE, MorecOptions, MorecStats, morec_recognizer_create,
    morec_recognizer_destroy, morec_recognizer_finish, morec_recognizer_joint_of_role,
    morec_recognizer_poll, morec_recognizer_push, morec_recognizer_reset, morec_recognizer_stats,
};
pub use skeleton::MorecSkeleton;
pub use status::{MorecStatus, morec_last_error, morec_status_text};
pub use words::{
    MOREC_ROLE_COUNT, MorecRole, morec_role_from_name, morec_role_name, morec_version,
};
