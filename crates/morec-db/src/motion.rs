//! The stored form of a clip's motion: packing and unpacking. No other module knows the format of these bytes.

use morec::clip::{Clip, Span};
use morec::formats::ParseError;
use morec::import::{ImportOptions, ImportReport, SignedAxis, Take, normalize};
use morec::progress::Progress;
use morec::roles::{Role, RoleMap};
use morec::smooth::{CompressedClip, SmoothError, SmoothParams, compress};
use rayon::prelude::*;
use rusqlite::{OptionalExtension, params};

use crate::{ClipId, DbError, MotionDb};

/// A clip as it is kept: metres, Y up, within the stated error of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredClip {
    /// Skeleton and frames, at the rate of its file.
    pub clip: Clip,
    /// Roles of the joints.
    pub roles: RoleMap,
    /// T-pose frames at the start.
    pub rest: Span,
}

impl StoredClip {
    /// The clip as one that was read from a file in metres with Y up: its roles and rest pose are those that are kept.
    ///
    /// # Errors
    /// None at present: only a mapping of roles can be wrong, and there is none.
    pub fn into_take(self) -> Result<Take, ParseError> {
        let options = ImportOptions {
            up: Some(SignedAxis::Y),
            metres_per_unit: Some(1.0),
            rest_frames: Some(self.rest.len()),
            ..ImportOptions::default()
        };
        let read = normalize(self.clip.clone(), &options)?;
        Ok(Take {
            clip: self.clip,
            roles: self.roles,
            ..read
        })
    }
}

/// A clip as it is written to the database.
pub(crate) struct Packed {
    pub motion: Vec<u8>,
    pub max_angle_rad: f64,
    pub max_position_metres: f64,
    pub skeleton_hash: [u8; 32],
    pub joints: usize,
    pub roles: String,
    pub facts: String,
    pub stored: StoredClip,
}

/// Compresses a clip. Motion so wild that joints cannot be kept within the bound is kept channel by channel, and
/// says how far it is off.
pub(crate) fn pack(take: Take, progress: &dyn Progress) -> Result<Packed, String> {
    let Take {
        clip,
        roles,
        report,
        ..
    } = take;
    let bounded = match compress(&clip, &SmoothParams::database(), progress) {
        Err(SmoothError::Bound { .. }) => compress(&clip, &SmoothParams::default(), progress),
        other => other,
    };
    let compressed = bounded.map_err(|error| error.to_string())?;
    let errors = compressed.errors();
    let (skeleton_hash, joints) = (skeleton_hash(&clip), clip.skeleton.len());
    // Long clips take much memory: the one that is stored takes the place of the one that was read.
    drop(clip);
    Ok(Packed {
        max_angle_rad: errors.max_angle_rad,
        max_position_metres: errors.max_joint_position_metres,
        skeleton_hash,
        joints,
        roles: roles_to_json(&roles),
        facts: report_to_json(&report),
        stored: StoredClip {
            clip: compressed
                .sample(compressed.source_rate_hz())
                .map_err(|error| error.to_string())?,
            roles,
            rest: report.rest_frames,
        },
        motion: compressed.to_bytes(),
    })
}

fn report_to_json(report: &ImportReport) -> String {
    serde_json::to_string(report).unwrap_or_default()
}

/// The joint of each role, in the order of [`Role::ALL`].
pub(crate) fn roles_to_json(roles: &RoleMap) -> String {
    let joints: Vec<Option<usize>> = Role::ALL
        .into_iter()
        .map(|role| roles.joint(role))
        .collect();
    serde_json::to_string(&joints).unwrap_or_default()
}

pub(crate) fn roles_from_json(json: &str, joints: usize) -> Option<RoleMap> {
    let list: Vec<Option<usize>> = serde_json::from_str(json).ok()?;
    let mut map = RoleMap::default();
    for (role, joint) in Role::ALL.into_iter().zip(list) {
        map.set(role, joint.filter(|j| *j < joints));
    }
    Some(map)
}

/// Names, parents and offsets to a tenth of a millimetre: what makes two clips' skeletons one.
fn skeleton_hash(clip: &Clip) -> [u8; 32] {
    let mut hasher = blake3::Hasher::new();
    for joint in clip.skeleton.joints() {
        hasher.update(joint.name.as_bytes());
        hasher.update(&[0]);
        hasher.update(&joint.parent.map_or(u64::MAX, |p| p as u64).to_le_bytes());
        for value in joint.offset.iter() {
            hasher.update(&((value * 1e4).round() as i64).to_le_bytes());
        }
    }
    *hasher.finalize().as_bytes()
}

impl MotionDb {
    /// A clip's motion, decoded. O(frames · joints).
    ///
    /// # Errors
    /// There is no such clip; its bytes are damaged.
    pub fn clip(&self, id: ClipId) -> Result<StoredClip, DbError> {
        self.packed(id)?.unpack()
    }

    /// Several clips' motions, roles and rest poses, unpacked in parallel, in the order of `ids`.
    ///
    /// # Errors
    /// As [`clip`](Self::clip), for the first that fails.
    pub fn stored_clips(&self, ids: &[ClipId]) -> Result<Vec<StoredClip>, DbError> {
        let packed: Result<Vec<PackedClip>, DbError> =
            ids.iter().map(|id| self.packed(*id)).collect();
        packed?.par_iter().map(PackedClip::unpack).collect()
    }

    fn packed(&self, id: ClipId) -> Result<PackedClip, DbError> {
        let sql = "SELECT motion, roles, rest_frames, name FROM clips WHERE id = ?1";
        let found = self
            .conn
            .prepare_cached(sql)?
            .query_row(params![id.0], |row| {
                Ok(PackedClip {
                    motion: row.get("motion")?,
                    roles: row.get("roles")?,
                    rest: row.get("rest_frames")?,
                    name: row.get("name")?,
                })
            });
        let unknown = || DbError::unknown("clip", &format!("#{}", id.0));
        found.optional()?.ok_or_else(unknown)
    }

    /// The stored motion of a clip: the bytes of an `.mclip` file (docs/formats/mclip.md).
    ///
    /// # Errors
    /// [`DbError::Unknown`] if the clip does not exist.
    pub fn motion_bytes(&self, id: ClipId) -> Result<Vec<u8>, DbError> {
        let found = self
            .conn
            .prepare_cached("SELECT motion FROM clips WHERE id = ?1")?
            .query_row(params![id.0], |row| row.get(0))
            .optional()?;
        found.ok_or_else(|| DbError::unknown("clip", &format!("#{}", id.0)))
    }
}

/// A clip as its row has it.
struct PackedClip {
    motion: Vec<u8>,
    roles: String,
    rest: i64,
    name: String,
}

impl PackedClip {
    fn unpack(&self) -> Result<StoredClip, DbError> {
        unpack(&self.motion, &self.roles, self.rest, &self.name)
    }
}

pub(crate) fn unpack(
    bytes: &[u8],
    roles: &str,
    rest: i64,
    name: &str,
) -> Result<StoredClip, DbError> {
    let damaged = |what: String| DbError::Damaged(format!("clip {name}: {what}"));
    let compressed = CompressedClip::from_bytes(bytes).map_err(|e| damaged(e.to_string()))?;
    let sampled = compressed
        .sample(compressed.source_rate_hz())
        .map_err(|e| damaged(e.to_string()))?;
    let clip = Clip {
        name: name.to_owned(),
        ..sampled
    };
    let roles = roles_from_json(roles, clip.skeleton.len())
        .ok_or_else(|| damaged("its roles".to_owned()))?;
    let rest = 0..(rest.max(0) as usize).min(clip.frames);
    Ok(StoredClip { clip, roles, rest })
}
