//! `morec db clips`: lists clips and changes their descriptions.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Result, anyhow, bail};
use morec::roles::Role;
use morec_db::{ClipFilter, ClipId, ClipInfo, ClipUpdate, ClipVideo, MotionDb};
use morec_ops::{ClapMatch, SoundEnvelope};

use crate::database;
use crate::print;
use crate::progress::StageBar;
use crate::table::TextTable;

/// List clips of a database, or change their descriptions
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db clips moves.mdb --clip 'walk*'
  morec db clips moves.mdb --class wave --subject anna
  morec db clips moves.mdb --clip 'ah_*' --set-subject ah --add-tag gesture
  morec db clips moves.mdb --clip 'test_*' --remove
  morec db clips moves.mdb --rename take_1 walk_01
  morec db clips moves.mdb --clip 'take_*' --set-role left_hand=LeftWrist
  morec db clips moves.mdb --clip bow --set-video bow.mp4 --video-offset clap")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Clips of this name; `*` any text, `?` one character
    #[arg(long, alias = "name", value_name = "CLIP")]
    clip: Option<String>,
    /// Clips of this person
    #[arg(long, value_name = "NAME")]
    subject: Option<String>,
    /// Clips with this tag
    #[arg(long, value_name = "WORD")]
    tag: Option<String>,
    /// Clips with a sample of this class
    #[arg(long, value_name = "CLASS")]
    class: Option<String>,
    /// Set the person in the listed clips; empty removes it
    #[arg(long, value_name = "NAME")]
    set_subject: Option<String>,
    /// Set the origin
    #[arg(long, value_name = "TEXT")]
    set_source: Option<String>,
    /// Set the licence
    #[arg(long, value_name = "TEXT")]
    set_licence: Option<String>,
    /// Rename a clip; labels, cuts and tags stay
    #[arg(long, num_args = 2, value_names = ["OLD", "NEW"])]
    rename: Vec<String>,
    /// Remove the chosen clips with their cuts and labels
    ///
    /// Chosen by --clip, --subject, --tag and --class.
    #[arg(long, conflicts_with = "rename")]
    remove: bool,
    /// Set the joint of a role: left_hand=LeftWrist; `left_hand=` for none
    #[arg(long, value_name = "ROLE=JOINT", value_parser = role_and_joint)]
    set_role: Vec<(Role, String)>,
    /// Set the video beside a clip; empty removes it
    ///
    /// Needs --clip with the name of one clip. The file stays where it is.
    #[arg(long, value_name = "VIDEO", requires = "clip")]
    set_video: Option<String>,
    /// Time of the video at which the clip begins, seconds; `clap` finds it
    ///
    /// `clap`: when the hands meet in the clip, the sound of the video rises most. The program ffmpeg reads the sound.
    #[arg(
        long,
        value_name = "SECS",
        default_value = "0",
        allow_hyphen_values = true,
        value_parser = video_offset,
        requires = "set_video"
    )]
    video_offset: VideoOffset,
    /// Add a tag
    #[arg(long, value_name = "WORD")]
    add_tag: Vec<String>,
    /// Remove a tag
    #[arg(long, value_name = "WORD")]
    remove_tag: Vec<String>,
    /// List at most N
    #[arg(long, value_name = "N")]
    limit: Option<usize>,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Changes, then lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    let filter = ClipFilter {
        name: args.clip.clone(),
        subject: args.subject.clone(),
        tag: args.tag.clone(),
        class: args.class.clone(),
    };
    let update = ClipUpdate {
        source: args.set_source.clone(),
        licence: args.set_licence.clone(),
        subject: args.set_subject.clone(),
        add_tags: args.add_tag.clone(),
        remove_tags: args.remove_tag.clone(),
    };
    if args.remove {
        return remove(args, &filter);
    }
    if let [old, new] = args.rename.as_slice() {
        database::open(&args.db)?.rename_clip(old, new)?;
        if !args.json {
            print::print(format_args!("{old} renamed to {new}\n"))?;
            return Ok(ExitCode::SUCCESS);
        }
    }
    if !args.set_role.is_empty() {
        set_roles(args, &filter)?;
    }
    if let (Some(path), Some(clip)) = (&args.set_video, &args.clip) {
        let mut db = database::open(&args.db)?;
        let video = match path.is_empty() {
            true => None,
            false => Some(ClipVideo {
                offset_secs: match args.video_offset {
                    VideoOffset::Secs(secs) => secs,
                    VideoOffset::Clap => offset_of_clap(&db, clip, path.as_ref())?,
                },
                path: path.clone(),
            }),
        };
        db.set_video(clip, video.as_ref())?;
    }
    let mut clips = if update == ClipUpdate::default() {
        database::open_read_only(&args.db)?.find_clips(&filter)?
    } else {
        let mut db = database::open(&args.db)?;
        let ids: Vec<ClipId> = db.find_clips(&filter)?.iter().map(|clip| clip.id).collect();
        db.update_clips(&ids, &update)?;
        let all = db.clips(&ClipFilter::default())?;
        all.into_iter()
            .filter(|clip| ids.contains(&clip.id))
            .collect()
    };
    clips.sort_by(|a, b| a.name.cmp(&b.name));
    let all = clips.len();
    clips.truncate(args.limit.unwrap_or(all));
    if args.json {
        print::print_json(&clips)?;
    } else {
        print(&clips, all)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// How far into a video its clip begins.
#[derive(Debug, Clone, Copy, PartialEq)]
enum VideoOffset {
    Secs(f64),
    /// Where a clap is seen when it is heard.
    Clap,
}

fn video_offset(text: &str) -> Result<VideoOffset, String> {
    match (text, text.parse()) {
        ("clap", _) => Ok(VideoOffset::Clap),
        (_, Ok(secs)) => Ok(VideoOffset::Secs(secs)),
        (_, Err(_)) => Err("expected seconds or clap".to_owned()),
    }
}

/// The offset at which a clap of the clip is seen when it is heard in the video; says where it is.
fn offset_of_clap(db: &MotionDb, clip: &str, video: &Path) -> Result<f64> {
    let stored = db.clip(db.find_clip(clip)?.id)?;
    let sound = SoundEnvelope::of_file("ffmpeg".as_ref(), video, &StageBar::stoppable()?);
    let clap = sound.and_then(|sound| ClapMatch::of(&sound, &stored.clip, &stored.roles));
    let clap = clap.map_err(|why| anyhow!("--video-offset clap: {why}"))?;
    eprintln!(
        "morec: hands meet at {:.2} s of {clip}, the loudest onset is at {:.2} s of the video: offset {:.3} s",
        clap.hands_secs,
        clap.sound_secs,
        clap.offset_secs()
    );
    Ok(clap.offset_secs())
}

fn role_and_joint(text: &str) -> Result<(Role, String), String> {
    let (role, joint) = text
        .split_once('=')
        .ok_or("expected ROLE=JOINT, as left_hand=LeftWrist")?;
    let known = || Role::ALL.map(Role::name).join(", ");
    let role = Role::from_name(role).ok_or_else(|| format!("expected one of {}", known()))?;
    Ok((role, joint.to_owned()))
}

/// Gives parts of the body to joints in all clips that a filter chooses, as one step.
fn set_roles(args: &Args, filter: &ClipFilter) -> Result<()> {
    let mut db = database::open(&args.db)?;
    let mut changed = Vec::new();
    for clip in db.find_clips(filter)? {
        let stored = db.clip(clip.id)?;
        let (joints, mut roles) = (stored.clip.skeleton.joints(), stored.roles);
        for (role, name) in &args.set_role {
            let joint = joints.iter().position(|joint| joint.name == *name);
            if joint.is_none() && !name.is_empty() {
                bail!("clip {} has no joint called {name:?}", clip.name);
            }
            roles.set(*role, joint);
        }
        changed.push((clip.id, roles));
    }
    Ok(db.set_roles(&changed)?)
}

/// Removes what a filter chooses; all clips of a database only by `--clip '*'`.
fn remove(args: &Args, filter: &ClipFilter) -> Result<ExitCode> {
    if *filter == ClipFilter::default() {
        bail!("--remove: choose the clips with --clip, --subject, --tag or --class");
    }
    let mut db = database::open(&args.db)?;
    let clips = db.find_clips(filter)?;
    let ids: Vec<ClipId> = clips.iter().map(|clip| clip.id).collect();
    let samples = db.remove_clips(&ids)?;
    if args.json {
        let names: Vec<&String> = clips.iter().map(|clip| &clip.name).collect();
        print::print_json(&serde_json::json!({ "removed": names, "samples": samples }))?;
    } else {
        print::print(format_args!(
            "{} clips removed with {samples} samples; morec db undo restores them\n",
            clips.len()
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn print(clips: &[ClipInfo], all: usize) -> Result<()> {
    let mut table = TextTable::new([
        "clip", "secs", "Hz", "joints", "samples", "kB", "who", "tags",
    ])
    .least(["kB", "joints", "Hz", "tags", "who", "secs"]);
    for clip in clips {
        table.row([
            clip.name.clone(),
            format!("{:.2}", clip.duration_secs()),
            format!("{:.0}", clip.rate_hz),
            clip.joints.to_string(),
            clip.samples.to_string(),
            format!("{:.1}", clip.motion_bytes as f64 / 1e3),
            clip.subject.clone().unwrap_or_default(),
            clip.tags.join(" "),
        ]);
    }
    print::print_table(&table, &print::counted(clips.len(), all, "clips"))
}
