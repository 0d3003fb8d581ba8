//! Diagnosis of a recogniser's stream: measures, and findings as sentences.

use std::ffi::c_char;

use morec::diagnosis::{Diagnosis, Finding, RoleSet, Severity};
use morec::roles::Role;

use crate::handles::{self, MorecRecognizer};
use crate::memory::{self, Versioned};
use crate::status::{MorecStatus, guard};

/// Something that is wrong with a stream, or worth knowing of it: one bit each, the same in every release.
#[repr(u32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecFinding {
    /// Frames show no body.
    Nobody = 1 << 0,
    /// Times are not seconds.
    TimeUnit = 1 << 1,
    /// Times do not go on.
    TimeStands = 1 << 2,
    /// The hip joints are never seen.
    NoHeading = 1 << 3,
    /// Y points down.
    UpsideDown = 1 << 4,
    /// Another axis than Y is up.
    UpIsNotY = 1 << 5,
    /// A standing body is not upright.
    Tilted = 1 << 6,
    /// Left and right are exchanged, or the coordinates are of the other hand.
    SidesExchanged = 1 << 7,
    /// Nothing moves at all.
    Frozen = 1 << 8,
    /// Parts of the body are never seen.
    JointsMissing = 1 << 9,
    /// Parts of the body come and go.
    JointsFlicker = 1 << 10,
    /// The size of the body is not a person's in any common unit.
    UnknownUnit = 1 << 11,
    /// Positions jitter.
    Noisy = 1 << 12,
    /// Joints are thrown aside in single frames.
    Spikes = 1 << 13,
    /// Few frames a second.
    SlowRate = 1 << 14,
    /// Frames are missing.
    FramesLost = 1 << 15,
    /// Frames repeat the one before.
    FramesRepeated = 1 << 16,
    /// Frames come unevenly.
    UnevenArrival = 1 << 17,
    /// The feet never stand: the body glides.
    MovingFloor = 1 << 18,
    /// The hips do not move while the hands do.
    HipsFixed = 1 << 19,
    /// A hand is away again and again.
    HandLost = 1 << 20,
    /// Left and right hand change places.
    HandsSwap = 1 << 21,
}

/// Severity of the gravest finding.
#[repr(i32)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MorecSeverity {
    /// Nothing was found.
    None = 0,
    /// Good to know; recognition works.
    Info = 1,
    /// Recognition works less well.
    Warning = 2,
    /// Nothing can be recognised in this stream.
    Error = 3,
}

/// Measures of a stream. Unknown measures are NaN. Lengths are in metres, converted from the inferred unit of the stream.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MorecDiagnosis {
    /// Set to `sizeof(MorecDiagnosis)` before the call.
    pub struct_size: usize,
    /// Number of frames examined.
    pub frames: u64,
    /// `MorecFinding` bits; 0 during about the first second of the stream.
    pub findings: u32,
    /// `MorecSeverity` of the most severe finding.
    pub severity: i32,
    /// Bit `r` for each `MorecRole` `r` that is always missing.
    pub missing_roles: u32,
    /// Bit `r` for each `MorecRole` `r` that is missing in some frames.
    pub flickering_roles: u32,
    /// Time from the first frame to the last, seconds.
    pub secs: f64,
    /// Frames a second.
    pub rate_hz: f64,
    /// Half the range of 90 % of the intervals between arrivals of frames, seconds.
    pub jitter_secs: f64,
    /// Share of the expected frames that did not arrive, 0 to 1.
    pub lost_share: f64,
    /// Share of the frames that repeat the previous frame, 0 to 1.
    pub repeated_share: f64,
    /// Share of the frames without a body, 0 to 1.
    pub empty_share: f64,
    /// Length from the ankles to the head joint along the bones, metres.
    pub height_m: f64,
    /// Length of thigh and shin, metres.
    pub leg_m: f64,
    /// Angle between a standing body, or the trunk, and the vertical, radians.
    pub tilt_rad: f64,
    /// Standard deviation of fast noise on each coordinate, metres.
    pub noise_m: f64,
    /// Share of the frames in which a joint jumps far away, 0 to 1.
    pub spike_share: f64,
}

// SAFETY: repr(C), begins with its size, numbers only.
unsafe impl Versioned for MorecDiagnosis {
    const NAME: &'static str = "MorecDiagnosis";
    const FIRST_SIZE: usize = size_of::<Self>();
}

/// The bits of the parts of a body, which `MorecRole` has; not those of hands.
fn parts_of_body(roles: RoleSet) -> u32 {
    let bits = roles.bits() & ((1 << Role::BODY_COUNT) - 1);
    u32::try_from(bits).unwrap_or_default()
}

impl From<&Diagnosis> for MorecDiagnosis {
    fn from(d: &Diagnosis) -> Self {
        let findings = d.findings();
        let severity = match findings.worst().map(Finding::severity) {
            None => MorecSeverity::None,
            Some(Severity::Info) => MorecSeverity::Info,
            Some(Severity::Warning) => MorecSeverity::Warning,
            Some(Severity::Error) => MorecSeverity::Error,
        };
        Self {
            struct_size: 0,
            frames: d.frames,
            findings: findings.bits(),
            severity: severity as i32,
            missing_roles: parts_of_body(d.missing),
            flickering_roles: parts_of_body(d.flickering),
            secs: d.secs,
            rate_hz: d.rate_hz.unwrap_or(f64::NAN),
            jitter_secs: d.jitter_secs.unwrap_or(f64::NAN),
            lost_share: d.lost_share,
            repeated_share: d.repeated_share,
            empty_share: d.empty_share,
            height_m: d.height_m.unwrap_or(f64::NAN),
            leg_m: d.leg_m.unwrap_or(f64::NAN),
            tilt_rad: d.tilt_rad.unwrap_or(f64::NAN),
            noise_m: d.noise_m.unwrap_or(f64::NAN),
            spike_share: d.spike_share,
        }
    }
}

/// Fills in `*diagnosis`, whose `struct_size` must be set, with measures of the stream so far. Allocates no memory.
///
/// # Safety
/// `diagnosis` is null or points to a struct of the size it says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_diagnosis(
    recognizer: *const MorecRecognizer,
    diagnosis: *mut MorecDiagnosis,
) -> MorecStatus {
    guard(|| {
        let known = handles::find(recognizer)?.diagnosis()?;
        // SAFETY: as promised to this function.
        unsafe { memory::write_struct(diagnosis, &MorecDiagnosis::from(&known)) }
    })
}

/// Writes the problems of the stream into the `size` bytes at `buffer`: one sentence with its remedy on each line, the most
/// severe first, zero-terminated. The text is empty if no problem is known. If `needed` is not null, it receives the number of bytes
/// needed. If the buffer is too small, the text is truncated and the status is `MOREC_STATUS_BUFFER_TOO_SMALL`.
///
/// # Safety
/// `buffer` is null or may be written to for `size` bytes; `needed` is null or may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn morec_recognizer_diagnosis_text(
    recognizer: *const MorecRecognizer,
    buffer: *mut c_char,
    size: usize,
    needed: *mut usize,
) -> MorecStatus {
    guard(|| {
        let text = handles::find(recognizer)?.findings()?.join("\n");
        // SAFETY: as promised to this function.
        unsafe { memory::give_text((buffer, size), needed, &text) }
    })
}
