//! Descriptions of clips: listing, finding, renaming, removing, and changing origin, licence, person and tags. Motion is in
//! [`motion`](crate::motion) and is not read here.

use rusqlite::{Connection, OptionalExtension, Row, params};

use crate::history::counted;
use crate::{DbError, MotionDb, names};

/// The tag of background clips, which train as motion outside all classes.
pub const BACKGROUND: &str = "background";

/// A clip's number in its database.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub struct ClipId(pub i64);

/// A clip without its motion.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct ClipInfo {
    /// Number of the clip.
    pub id: ClipId,
    /// Its name, one of a kind in the database.
    #[serde(rename = "clip")]
    pub name: String,
    /// Frames at the file's rate.
    pub frames: usize,
    /// Frames a second.
    pub rate_hz: f64,
    /// T-pose frames at the start.
    pub rest_frames: usize,
    /// Frames that reading filled in.
    pub repaired_frames: usize,
    /// Joints of its skeleton.
    pub joints: usize,
    /// Number of its skeleton; clips of one skeleton share it.
    pub skeleton: i64,
    /// Path of its file when it was imported.
    pub path: String,
    /// Its file's format.
    pub format: String,
    /// Bytes of compressed motion.
    pub motion_bytes: usize,
    /// Origin of the material.
    pub source: Option<String>,
    /// Under which terms.
    pub licence: Option<String>,
    /// Person in it.
    pub subject: Option<String>,
    /// Words attached to it.
    pub tags: Vec<String>,
    /// Number of accepted samples in it.
    pub samples: usize,
}

impl ClipInfo {
    /// True if the clip has the tag [`BACKGROUND`].
    pub fn is_background(&self) -> bool {
        self.tags.iter().any(|tag| tag == BACKGROUND)
    }

    /// Length in seconds.
    pub fn duration_secs(&self) -> f64 {
        self.frames as f64 / self.rate_hz
    }
}

/// Conditions on clips; all must hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClipFilter {
    /// The name matches this pattern (`*` any text, `?` one character).
    pub name: Option<String>,
    /// This person is seen.
    pub subject: Option<String>,
    /// This tag is attached.
    pub tag: Option<String>,
    /// It holds an accepted sample of this class.
    pub class: Option<String>,
}

/// Changes to clips; `None` leaves a value as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ClipUpdate {
    /// New source; empty takes it away.
    pub source: Option<String>,
    /// New licence; empty takes it away.
    pub licence: Option<String>,
    /// New subject; empty takes it away.
    pub subject: Option<String>,
    /// Tags to attach.
    pub add_tags: Vec<String>,
    /// Tags to take off.
    pub remove_tags: Vec<String>,
}

const COLUMNS: &str = "c.id, c.name, c.frames, c.rate_hz, c.rest_frames, c.repaired_frames, k.joints, c.skeleton, \
    f.path, f.format, length(c.motion) AS motion_bytes, c.source, c.licence, c.subject, \
    (SELECT group_concat(tag, char(10)) FROM tags t WHERE t.clip = c.id) AS tags, \
    (SELECT count(*) FROM samples s WHERE s.clip = c.id AND s.state = 'accepted') AS samples \
    FROM clips c JOIN files f ON f.id = c.file JOIN skeletons k ON k.id = c.skeleton";

fn info(row: &Row<'_>) -> rusqlite::Result<ClipInfo> {
    let count = |column: &str| -> rusqlite::Result<usize> {
        Ok(row.get::<_, i64>(column)?.max(0) as usize)
    };
    let tags: Option<String> = row.get("tags")?;
    Ok(ClipInfo {
        id: ClipId(row.get("id")?),
        name: row.get("name")?,
        frames: count("frames")?,
        rate_hz: row.get("rate_hz")?,
        rest_frames: count("rest_frames")?,
        repaired_frames: count("repaired_frames")?,
        joints: count("joints")?,
        skeleton: row.get("skeleton")?,
        path: row.get("path")?,
        format: row.get("format")?,
        motion_bytes: count("motion_bytes")?,
        source: row.get("source")?,
        licence: row.get("licence")?,
        subject: row.get("subject")?,
        tags: tags.map_or_else(Vec::new, |tags| {
            tags.split('\n').map(str::to_owned).collect()
        }),
        samples: count("samples")?,
    })
}

pub(crate) fn list(conn: &Connection, filter: &ClipFilter) -> Result<Vec<ClipInfo>, DbError> {
    let sql = format!(
        "SELECT {COLUMNS} WHERE (?1 IS NULL OR c.name GLOB ?1) AND (?2 IS NULL OR c.subject = ?2) \
         AND (?3 IS NULL OR EXISTS (SELECT 1 FROM tags t WHERE t.clip = c.id AND t.tag = ?3)) \
         AND (?4 IS NULL OR EXISTS (SELECT 1 FROM samples s JOIN classes n ON n.id = s.class \
              WHERE s.clip = c.id AND s.state = 'accepted' AND n.name = ?4)) ORDER BY c.name"
    );
    let mut statement = conn.prepare(&sql)?;
    let given = params![filter.name, filter.subject, filter.tag, filter.class];
    let clips = statement
        .query_map(given, info)?
        .collect::<Result<_, _>>()?;
    Ok(clips)
}

pub(crate) fn find(conn: &Connection, name: &str) -> Result<ClipInfo, DbError> {
    let sql = format!("SELECT {COLUMNS} WHERE c.name = ?1");
    let find = |name: &str| conn.query_row(&sql, params![name], info).optional();
    if let Some(found) = find(name)? {
        return Ok(found);
    }
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    find(stem)?.ok_or_else(|| names::unknown(conn, "clip", name))
}

impl MotionDb {
    /// The clips that match a filter, sorted by name. Unlike [`clips`](Self::clips), a filter that matches nothing is an
    /// error, so that a misspelt name is reported.
    ///
    /// # Errors
    /// [`DbError::Unknown`] with the nearest names: no clip has the name or matches the pattern, no clip shows the person or
    /// has the tag, or the class does not exist.
    pub fn find_clips(&self, filter: &ClipFilter) -> Result<Vec<ClipInfo>, DbError> {
        if let Some(class) = &filter.class {
            self.need_class(class)?;
        }
        let parts = [
            ("clip", &filter.name),
            ("person", &filter.subject),
            ("tag", &filter.tag),
        ];
        for (kind, name) in parts {
            let Some(name) = name else { continue };
            let mut alone = ClipFilter::default();
            match kind {
                "clip" => alone.name = Some(name.clone()),
                "person" => alone.subject = Some(name.clone()),
                _ => alone.tag = Some(name.clone()),
            }
            if self.clips(&alone)?.is_empty() {
                return Err(names::unknown(&self.conn, kind, name));
            }
        }
        self.clips(filter)
    }

    /// The clips that match a filter, sorted by name. The list is empty if no clip matches; [`find_clips`](Self::find_clips) reports an
    /// unknown name instead.
    ///
    /// # Errors
    /// The database cannot be read.
    pub fn clips(&self, filter: &ClipFilter) -> Result<Vec<ClipInfo>, DbError> {
        list(&self.conn, filter)
    }

    /// The clip with this name. A file name with its extension finds the clip as well.
    ///
    /// # Errors
    /// [`DbError::Unknown`], with the nearest names, if no clip is called so.
    pub fn find_clip(&self, name: &str) -> Result<ClipInfo, DbError> {
        find(&self.conn, name)
    }

    /// Gives a clip another name; its labels, cuts and tags stay with it.
    ///
    /// # Errors
    /// There is no such clip, another one has the new name, or the name is empty, longer than 200 bytes or holds control characters.
    pub fn rename_clip(&mut self, from: &str, to: &str) -> Result<(), DbError> {
        let blank = to.trim() != to || to.is_empty();
        if blank || to.len() > names::LONGEST || to.chars().any(char::is_control) {
            let expected = "a clip's name: 1 to 200 bytes without blanks around it, tabs, line ends or other control characters";
            return Err(DbError::Invalid(format!(
                "expected {expected}, found {to:?}"
            )));
        }
        self.edit(&format!("rename clip {from} to {to}"), |conn| {
            let clip = find(conn, from)?;
            let sql = "SELECT 1 FROM clips WHERE name = ?1 AND id <> ?2";
            if conn.prepare(sql)?.exists(params![to, clip.id.0])? {
                return Err(DbError::Invalid(format!(
                    "a clip called {to} exists already"
                )));
            }
            let sql = "UPDATE clips SET name = ?2 WHERE id = ?1";
            conn.execute(sql, params![clip.id.0, to])?;
            Ok(())
        })
    }

    /// Removes clips with their cuts and samples, and what is known of files that hold no other clip, as one step. Gives
    /// how many samples went with them.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn remove_clips(&mut self, clips: &[ClipId]) -> Result<usize, DbError> {
        self.edit(&format!("remove {}", counted(clips.len(), "clip")), |conn| {
            let mut samples = 0;
            for id in clips {
                let sql = "SELECT count(*) FROM samples WHERE clip = ?1";
                samples += conn
                    .prepare_cached(sql)?
                    .query_row(params![id.0], |row| row.get::<_, i64>(0))?;
                conn.prepare_cached("DELETE FROM clips WHERE id = ?1")?
                    .execute(params![id.0])?;
            }
            conn.execute(
                "DELETE FROM files WHERE NOT EXISTS (SELECT 1 FROM clips c WHERE c.file = files.id)",
                [],
            )?;
            Ok(samples.max(0) as usize)
        })
    }

    /// Changes the descriptions of clips (origin, licence, person, tags, roles), all or none, as one step. Returns the
    /// number of clips that exist.
    ///
    /// # Errors
    /// A text contains control characters, such as tabs or line ends; the database cannot be written.
    pub fn update_clips(
        &mut self,
        clips: &[ClipId],
        update: &ClipUpdate,
    ) -> Result<usize, DbError> {
        let texts = [&update.source, &update.licence, &update.subject];
        let mut texts = texts.into_iter().flatten().chain(&update.add_tags);
        if let Some(text) = texts.find(|text| text.chars().any(char::is_control)) {
            return Err(DbError::Invalid(format!(
                "expected a text without tabs, line ends or other control characters, found {text:?}"
            )));
        }
        self.edit(&step_name(clips.len(), update), |conn| {
            clips
                .iter()
                .try_fold(0, |changed, id| Ok(changed + describe(conn, *id, update)?))
        })
    }
}

/// Name of a change of clips in the history.
fn step_name(clips: usize, update: &ClipUpdate) -> String {
    let clips = counted(clips, "clip");
    let texts = [&update.source, &update.licence, &update.subject];
    match (&update.add_tags[..], &update.remove_tags[..]) {
        (tags @ [_, ..], []) if texts == [&None; 3] => format!("tag {clips} {}", tags.join(", ")),
        ([], tags @ [_, ..]) if texts == [&None; 3] => {
            format!("take the tag {} off {clips}", tags.join(", "))
        }
        _ => format!("describe {clips}"),
    }
}

/// Changes what is known about a clip; says whether there is such a clip.
pub(crate) fn describe(
    conn: &Connection,
    id: ClipId,
    update: &ClipUpdate,
) -> Result<usize, DbError> {
    let sql = "SELECT 1 FROM clips WHERE id = ?1";
    if !conn.prepare_cached(sql)?.exists(params![id.0])? {
        return Ok(0);
    }
    let columns = [
        ("source", &update.source),
        ("licence", &update.licence),
        ("subject", &update.subject),
    ];
    for (column, value) in columns {
        if let Some(value) = value {
            let sql = format!(
                "UPDATE clips SET {column} = nullif(?2, '') WHERE id = ?1 AND {column} IS NOT nullif(?2, '')"
            );
            conn.prepare_cached(&sql)?.execute(params![id.0, value])?;
        }
    }
    for tag in &update.add_tags {
        let sql = "INSERT OR IGNORE INTO tags (clip, tag) VALUES (?1, ?2)";
        conn.prepare_cached(sql)?.execute(params![id.0, tag])?;
    }
    for tag in &update.remove_tags {
        let sql = "DELETE FROM tags WHERE clip = ?1 AND tag = ?2";
        conn.prepare_cached(sql)?.execute(params![id.0, tag])?;
    }
    Ok(1)
}
