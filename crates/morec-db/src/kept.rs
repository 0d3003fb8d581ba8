//! A clip as it is kept: compressed motion, feature rows, and what is known of it and of its file. What databases and
//! archives have in common, so that clips go from one to the other without loss.

use std::path::{Path, PathBuf};

use morec::clip::Clip;
use morec::diagnosis::errors_of_clip;
use morec::features::{FeatureParams, Rows};
use morec::files::{ClipFile, FileError, FileReader, each_piece, split_choice};
use morec::formats::{Place, Warning};
use morec::import::{ImportOptions, normalize};

use crate::motion::{Packed, pack, unpack};
use crate::rows::{self, ClipRows, rows_of};
use crate::{ClipId, DbError, StoredClip};

/// A clip of a file, kept.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptClip {
    /// Name of the clip.
    pub name: String,
    /// Path, format and hash of the file that it was read from.
    pub file: KeptFile,
    /// Its number among the clips of the file, from 0.
    pub character: usize,
    /// Person in it.
    pub subject: Option<String>,
    /// Origin of the material, as given at import.
    pub source: Option<String>,
    /// Under which terms.
    pub licence: Option<String>,
    /// Words for finding it.
    pub tags: Vec<String>,
    /// Number of frames.
    pub frames: usize,
    /// Frames a second.
    pub rate_hz: f64,
    /// Frames at the start that show a rest pose.
    pub rest_frames: usize,
    /// Frames that were filled by interpolation.
    pub repaired_frames: usize,
    /// Number of joints.
    pub joints: usize,
    /// Hash of the skeleton: names, parents, and offsets to a tenth of a millimetre.
    pub skeleton_hash: [u8; 32],
    /// The joint of each role, in the order of [`Role::ALL`](morec::roles::Role::ALL), as JSON.
    pub roles: String,
    /// Import report, as JSON.
    pub facts: String,
    /// The furthest that any stored joint rotation is from its file's, radians.
    pub max_angle_rad: f64,
    /// The furthest that any stored joint is from where its file has it, metres.
    pub max_position_metres: f64,
    /// The bytes of an `.mclip` file.
    pub motion: Vec<u8>,
    /// Recipe of the feature rows.
    pub recipe: String,
    /// The bones that rows cover, a bit each.
    pub bones: i64,
    /// Feature rows, [packed](Rows::to_packed).
    pub rows: Vec<u8>,
}

/// The file that a clip is from.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptFile {
    /// Hash of its content (and of which of its clips was chosen).
    pub hash: [u8; 32],
    /// Path of the file.
    pub path: String,
    /// Format of the file.
    pub format: String,
    /// Size in bytes.
    pub bytes: u64,
    /// The skeleton file that an AMC motion was read with.
    pub skeleton: Option<String>,
    /// Repairs and doubts from reading.
    pub warnings: Vec<String>,
}

/// The content of a file by its hash and its size. One clip of a file (`FILE#2`) is another content than the whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct FileContent {
    pub hash: [u8; 32],
    pub bytes: u64,
}

impl FileContent {
    /// Of the file at `path`, which holds `bytes`.
    pub fn of(path: &Path, bytes: &[u8]) -> Self {
        let mut hasher = blake3::Hasher::new();
        hasher.update(bytes);
        Self::new(hasher, path, bytes.len() as u64)
    }

    /// Of the file at `path`, of which a piece at a time is held.
    pub fn of_large(path: &Path) -> std::io::Result<Self> {
        let mut hasher = blake3::Hasher::new();
        let take = |piece: &[u8]| _ = hasher.update(piece);
        let bytes = each_piece(&split_choice(path).0, take)?;
        Ok(Self::new(hasher, path, bytes))
    }

    fn new(mut hasher: blake3::Hasher, path: &Path, bytes: u64) -> Self {
        hasher.update(split_choice(path).1.unwrap_or_default().as_bytes());
        Self {
            hash: *hasher.finalize().as_bytes(),
            bytes,
        }
    }
}

/// Why there is no clip of a file to keep.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{reason}")]
pub struct NotKept {
    /// The reason in a sentence.
    pub reason: String,
    /// True if it is the memory that the file needs.
    pub of_memory: bool,
}

impl From<String> for NotKept {
    fn from(reason: String) -> Self {
        Self {
            reason,
            of_memory: false,
        }
    }
}

impl From<FileError> for NotKept {
    fn from(error: FileError) -> Self {
        Self {
            reason: error.kind.to_string(),
            of_memory: error.kind.is_of_memory(),
        }
    }
}

impl KeptClip {
    /// The clips in `bytes`, which are the file at `path`, made ready and compressed. The same bytes give the same.
    ///
    /// # Errors
    /// Why there are none, in a sentence.
    pub fn of_file(path: &Path, bytes: &[u8], reader: &FileReader) -> Result<Vec<Self>, NotKept> {
        let parsed = reader.parse(path, bytes)?;
        Ok(Self::of_parsed(
            path,
            parsed,
            FileContent::of(path, bytes),
            reader,
        )?)
    }

    /// The same for a large file of this content, which is not held as a whole if its format allows it.
    pub(crate) fn of_large(
        path: &Path,
        content: FileContent,
        reader: &FileReader,
    ) -> Result<Vec<Self>, NotKept> {
        let parsed = reader.read(path)?;
        if FileContent::of_large(path).map_err(|error| error.to_string())? != content {
            return Err("the file changed while it was read".to_owned().into());
        }
        Ok(Self::of_parsed(path, parsed, content, reader)?)
    }

    fn of_parsed(
        path: &Path,
        parsed: ClipFile,
        content: FileContent,
        reader: &FileReader,
    ) -> Result<Vec<Self>, String> {
        let options = ImportOptions {
            stated: parsed.stated,
            ..reader.import.clone()
        };
        let shown = |path: &PathBuf| path.to_string_lossy().into_owned();
        let file = KeptFile {
            hash: content.hash,
            path: path.to_string_lossy().into_owned(),
            format: parsed.format.name().to_owned(),
            bytes: content.bytes,
            skeleton: parsed.skeleton.as_ref().map(shown),
            warnings: parsed.warnings.iter().map(ToString::to_string).collect(),
        };
        let clips = parsed.clips.into_iter().enumerate();
        let kept = clips.map(|(character, clip)| Self::new(clip, character, &file, &options));
        let kept: Vec<Self> = kept.collect::<Result<_, _>>()?;
        match kept.is_empty() {
            true => Err("the file contains no clip".to_owned()),
            false => Ok(kept),
        }
    }

    fn new(
        clip: Clip,
        character: usize,
        file: &KeptFile,
        options: &ImportOptions,
    ) -> Result<Self, String> {
        if clip.frames == 0 {
            return Err(format!("{}: expected frames, found none", clip.name));
        }
        let name = clip.name.clone();
        let take = normalize(clip, options).map_err(|error| error.to_string())?;
        let mut file = file.clone();
        for doubt in &take.report.doubts {
            let warning = Warning::new(Place::File, format!("{name}: {doubt}"));
            file.warnings.push(warning.to_string());
        }
        for error in errors_of_clip(&take.clip, &take.roles, take.rest()) {
            let warning = Warning::new(Place::File, format!("{name}: {error}"));
            file.warnings.push(warning.to_string());
        }
        let packed = pack(take, &()).map_err(|reason| format!("{name}: {reason}"))?;
        let params = FeatureParams::default();
        let (bones, rows) = rows_of(&packed.stored, &params);
        let Packed {
            motion,
            max_angle_rad,
            max_position_metres,
            skeleton_hash,
            joints,
            roles,
            facts,
            stored,
        } = packed;
        Ok(Self {
            name,
            file,
            character,
            subject: None,
            source: None,
            licence: None,
            tags: Vec::new(),
            frames: stored.clip.frames,
            rate_hz: stored.clip.rate_hz,
            rest_frames: stored.rest.len(),
            repaired_frames: stored.clip.repaired.iter().map(|span| span.len()).sum(),
            joints,
            skeleton_hash,
            roles,
            facts,
            max_angle_rad,
            max_position_metres,
            motion,
            recipe: rows::recipe(&params),
            bones: rows::bits(bones),
            rows: rows.to_packed(),
        })
    }

    /// The motion, decoded. O(frames · joints).
    ///
    /// # Errors
    /// Damaged bytes.
    pub fn stored(&self) -> Result<StoredClip, DbError> {
        stored_clip(&self.name, &self.motion, &self.roles, self.rest_frames)
    }
}

/// A clip's motion from what is kept of it. O(frames · joints).
///
/// # Errors
/// Damaged bytes.
pub fn stored_clip(
    name: &str,
    motion: &[u8],
    roles: &str,
    rest_frames: usize,
) -> Result<StoredClip, DbError> {
    unpack(motion, roles, rest_frames as i64, name)
}

/// Feature rows from what is kept of them, under the number `clip`; `None` of a clip that shows no bone, or of bytes that
/// are none.
pub fn clip_rows(clip: ClipId, bones: i64, rows: &[u8]) -> Option<ClipRows> {
    rows::unpacked(clip, bones, rows, &FeatureParams::default())
}

/// Recipe of the feature rows made at present; rows of another recipe have to be made again.
pub fn rows_recipe() -> String {
    rows::recipe(&FeatureParams::default())
}

/// Feature rows of a stored clip, packed, and their bones.
pub fn packed_rows(stored: &StoredClip) -> (i64, Vec<u8>) {
    let params = FeatureParams::default();
    let (bones, rows): (_, Rows) = rows_of(stored, &params);
    (rows::bits(bones), rows.to_packed())
}
