//! Out of the database: labels in every form, a clip, a page to send to somebody.

use std::error::Error;
use std::path::{Path, PathBuf};

use morec::TimeSpan;
use morec::clip::{Clip, Gap, JointTrack, Points, Span};
use morec::formats::bvh;
use morec::labels::Mark;
use morec_db::exchange::{self, Annotation, LabelFormat};
use morec_db::labels::{DbSample, SampleFilter, SampleState};
use morec_db::{ClipFilter, ClipId, ClipVideo, DbError, MotionDb};
use morec_measure::player::{PlayedClip, PlayedVideo, page};
use morec_ops::video_of_page;

use super::progress::JobError;
use crate::format;
use crate::stretch::Stretch;

/// A kind of export.
#[derive(Debug, Clone)]
pub enum Export {
    /// Accepted labels; forms of one clip into a folder, a file for each.
    Labels(LabelFormat),
    /// The motion of a clip, as BVH.
    Clip(ClipId),
    /// A stretch of a clip, as BVH.
    Stretch(Stretch),
    /// The accepted samples of a class, as BVH into a folder, a file for each.
    Class(String),
    /// A page that plays a clip with its labels and with what was recognised.
    Page(ClipId, Vec<Mark>),
}

/// Writes what is asked for of the database at `db` to `path`; gives a sentence about what was written.
pub fn export(db: &Path, what: &Export, path: &Path) -> Result<String, JobError> {
    let name = format::file_name(path);
    match written(db, what, path) {
        Ok(said) => Ok(format!("{name}: {said}")),
        Err(why) => Err(JobError::Failed(format!("{name}: not written: {why}"))),
    }
}

fn written(db: &Path, what: &Export, path: &Path) -> Result<String, String> {
    // Writing over what is read would lose it.
    if path.exists() && path.canonicalize().ok() == db.canonicalize().ok() {
        return Err("this is the database itself".to_owned());
    }
    let db = MotionDb::open_read_only(db).map_err(|e| e.to_string())?;
    match what {
        Export::Labels(form) => labels(&db, *form, path),
        Export::Clip(clip) => {
            let stored = db.clip(*clip).map_err(|e| e.to_string())?;
            write_whole(path, &bytes_of(&stored.clip)?)?;
            Ok(format::count(stored.clip.frames, "frame"))
        }
        Export::Stretch(of) => {
            let stored = db.clip(of.clip).map_err(|e| e.to_string())?;
            let part = part(&stored.clip, of.span, &stored.clip.name)?;
            write_whole(path, &bytes_of(&part)?)?;
            Ok(format::count(part.frames, "frame"))
        }
        Export::Class(class) => samples(&db, class, path),
        Export::Page(clip, detections) => {
            let video = video(&db, *clip, path).map_err(|e| e.to_string())?;
            let (video, said) = match video {
                Some(Ok(video)) => (Some(video), ", with its video".to_owned()),
                Some(Err(why)) => (None, format!(", without its video: {why}")),
                None => (None, String::new()),
            };
            let html = played(&db, *clip, detections.clone(), video).map_err(|e| e.to_string())?;
            write_whole(path, html.as_bytes())?;
            Ok(format!("a page that plays the clip in any browser{said}"))
        }
    }
}

fn labels(db: &MotionDb, form: LabelFormat, path: &Path) -> Result<String, String> {
    let filter = SampleFilter {
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let samples = db.samples(&filter).map_err(|e| e.to_string())?;
    let annotations: Vec<Annotation> = samples.into_iter().map(Annotation::from).collect();
    let clips = db
        .clips(&ClipFilter::default())
        .map_err(|e| e.to_string())?;
    let lengths = exchange::clip_lengths(&clips);
    let said = format::count(annotations.len(), "label");
    if !form.is_of_one_clip() {
        let text = exchange::write(form, &annotations, &lengths)?;
        write_whole(path, text.as_bytes())?;
        return Ok(said);
    }
    std::fs::create_dir_all(path).map_err(|e| e.to_string())?;
    let of_clips: Vec<&[Annotation]> = annotations.chunk_by(|a, b| a.clip == b.clip).collect();
    let names = exchange::file_names(of_clips.iter().map(|all| all[0].clip.as_str()));
    for (of_clip, name) in of_clips.iter().zip(&names) {
        let text = exchange::write(form, of_clip, &lengths)?;
        write_whole(&path.join(form.file_of_clip(name)), text.as_bytes())?;
    }
    Ok(format!("{said} in {}", format::count(names.len(), "file")))
}

fn bytes_of(clip: &Clip) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    bvh::write(clip, &mut bytes).map_err(|e| e.to_string())?;
    Ok(bytes)
}

/// A file for each accepted sample of a class, by clip and time.
fn samples(db: &MotionDb, class: &str, folder: &Path) -> Result<String, String> {
    let filter = SampleFilter {
        class: Some(class.to_owned()),
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let samples = db.samples(&filter).map_err(|e| e.to_string())?;
    std::fs::create_dir_all(folder).map_err(|e| e.to_string())?;
    let of_clips: Vec<&[DbSample]> = samples.chunk_by(|a, b| a.clip == b.clip).collect();
    let names = of_clips.iter().flat_map(|of_clip| {
        let numbered = of_clip.iter().enumerate();
        numbered.map(|(at, s)| format!("{}_{class}_{}", s.clip_name, at + 1))
    });
    let names: Vec<String> = names.collect();
    let mut files = exchange::file_names(names.iter().map(String::as_str)).into_iter();
    for of_clip in of_clips {
        let stored = db.clip(of_clip[0].clip).map_err(|e| e.to_string())?;
        for (sample, name) in of_clip.iter().zip(&mut files) {
            let part = part(&stored.clip, sample.span(), &name)?;
            write_whole(&folder.join(format!("{name}.bvh")), &bytes_of(&part)?)?;
        }
    }
    Ok(format::count(samples.len(), "clip"))
}

/// The frames of a stretch as a clip of its own.
fn part(clip: &Clip, span: TimeSpan, name: &str) -> Result<Clip, String> {
    let frames = span.frames_among(clip.frames, clip.rate_hz);
    if frames.is_empty() {
        return Err(format!("the stretch contains no frame of {}", clip.name));
    }
    let joints = clip.skeleton.len();
    let within = |of: &Span| {
        let (start, end) = (of.start.max(frames.start), of.end.min(frames.end));
        (start < end).then(|| start - frames.start..end - frames.start)
    };
    let tracks = clip.tracks.iter().map(|track| JointTrack {
        joint: track.joint,
        positions: track.positions[frames.clone()].to_vec(),
    });
    let points = clip.points.as_ref().map(|points| {
        let gaps = points.gaps.iter().filter_map(|gap| {
            let (joint, frames) = (gap.joint, within(&gap.frames)?);
            Some(Gap { joint, frames })
        });
        Points {
            gaps: gaps.collect(),
            ..*points
        }
    });
    Ok(Clip {
        name: name.to_owned(),
        skeleton: clip.skeleton.clone(),
        rate_hz: clip.rate_hz,
        rotations: clip.rotations[frames.start * joints..frames.end * joints].to_vec(),
        tracks: tracks.collect(),
        frames: frames.len(),
        repaired: clip.repaired.iter().filter_map(within).collect(),
        points,
    })
}

/// The video of a clip as its page names it, or why the file cannot be used; `None` for a clip without a video.
fn video(db: &MotionDb, clip: ClipId, page: &Path) -> Result<ExportedVideo, DbError> {
    let videos = db.videos()?;
    let of_page = |of: &ClipVideo| video_of_page(page, of.path.as_ref(), of.offset_secs);
    Ok(videos.get(&clip).map(of_page))
}

type ExportedVideo = Option<Result<PlayedVideo, String>>;

fn played(
    db: &MotionDb,
    clip: ClipId,
    detections: Vec<Mark>,
    video: Option<PlayedVideo>,
) -> Result<String, Box<dyn Error>> {
    let stored = db.clip(clip)?;
    let filter = SampleFilter {
        clip: Some(clip),
        state: Some(SampleState::Accepted),
        ..SampleFilter::default()
    };
    let labels = db.samples(&filter)?.into_iter().map(|s| {
        let span = s.span();
        Mark::new(s.class, span)
    });
    let title = stored.clip.name.clone();
    let played = PlayedClip {
        clip: &stored.clip,
        roles: &stored.roles,
        beside: None,
        span: None,
        labels: labels.collect(),
        detections,
        video,
    };
    Ok(page(&title, &[played]))
}

/// Writes a file so that there is all of it or what was there before.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let beside = PathBuf::from(beside);
    let done = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    done.map_err(|error| {
        // What is there of it is of no use.
        let _ = std::fs::remove_file(&beside);
        error.to_string()
    })
}
