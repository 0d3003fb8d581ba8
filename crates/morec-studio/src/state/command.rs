//! Commands: panels emit them, `State` carries them out.

use std::path::PathBuf;

use morec::cluster::KwasParams;
use morec::features::BoneSet;
use morec::roles::Role;
use morec::smooth::ChannelKind;
use morec::train::ClassKind;
use morec::train::thesis::SvrdmTrainParams;
use morec_db::ClipId;
use morec_db::exchange::LabelFormat;
use morec_db::labels::SampleId;
use morec_ops::{CutMethod, GroupMethod};

use super::compare::CompareCommand;
use super::cuts::CutCommand;
use super::live::LiveCommand;
use super::player::PlayCommand;
use super::shelf::ShelfCommand;
use super::similar::SimilarCommand;
use super::study::StudyCommand;
use super::video::VideoCommand;
use crate::body::Camera;
use crate::store::Edit;
use crate::stretch::Stretch;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Panel {
    Library,
    Label,
    Classes,
    Train,
    Live,
}

impl Panel {
    pub const ALL: [Panel; 5] = [
        Panel::Library,
        Panel::Label,
        Panel::Classes,
        Panel::Train,
        Panel::Live,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Panel::Library => "Library",
            Panel::Label => "Label",
            Panel::Classes => "Classes",
            Panel::Train => "Train",
            Panel::Live => "Live",
        }
    }

    /// The panel of this name, in whatever letters.
    pub fn named(name: &str) -> Option<Self> {
        let same = |p: &Panel| p.name().eq_ignore_ascii_case(name);
        Panel::ALL.into_iter().find(same)
    }
}

/// One thing that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    Show(Panel),
    Dark(bool),
    ShowHistory(bool),
    ShowKeys(bool),
    /// Asks whether a step of another program shall be taken back.
    UndoAsks(bool),
    Dismiss(usize),
    File(FileCommand),
    Edit(Edit),
    Library(LibraryCommand),
    Play(PlayCommand),
    Look(ViewCommand),
    Timeline(TimelineCommand),
    Classes(ClassCommand),
    Train(TrainCommand),
    Live(LiveCommand),
    Cuts(CutCommand),
    Similar(SimilarCommand),
    Shelf(ShelfCommand),
    Compare(CompareCommand),
    Study(StudyCommand),
    Video(VideoCommand),
    /// Cancels the job of this place.
    Cancel(usize),
}

/// Files, named or to be asked for.
#[derive(Debug, Clone, PartialEq)]
pub enum FileCommand {
    AskOpen,
    AskImport,
    AskImportFolder,
    AskSave,
    AskExportIndex,
    AskExportReport(i64),
    AskNew,
    Open(PathBuf),
    New(PathBuf),
    Import(Vec<PathBuf>),
    AskImportLabels,
    /// A video beside the clip that is shown.
    AskVideo,
    Video(String, PathBuf),
    /// Files of captions, which are searched beside the database.
    AskCaptions,
    Captions(Vec<PathBuf>),
    /// Reads files of labels for a look at what they would change; the next three say what becomes of them.
    ImportLabels(Vec<PathBuf>),
    ReplaceLabels(bool),
    ApplyLabels,
    DismissLabels,
    Save(PathBuf),
    ExportIndex(PathBuf),
    /// A report of the database, as JSON.
    ExportReport(i64, PathBuf),
    /// Labels of all clips in a form.
    AskExportLabels(LabelFormat),
    /// The clip that is shown, as BVH.
    AskExportClip,
    /// The selected stretch, or the selected label, as a clip.
    AskExportStretch,
    /// The labels of a class as clips.
    AskExportClass(String),
    /// A page that plays the clip that is shown.
    AskExportPage,
    /// The time budget, as a table.
    AskExportBudget,
    ExportBudget(PathBuf),
    ExportLabels(LabelFormat, PathBuf),
    ExportClip(PathBuf),
    ExportStretch(PathBuf),
    ExportClass(String, PathBuf),
    ExportPage(PathBuf),
    /// No dialog can be opened: a path is typed.
    NoDialog(Ask),
    /// The path so far; `None` ends typing.
    Typing(Option<String>),
    /// Closes the window, after a question if there is something to save.
    Close,
    /// Opens the database of this place that an earlier run left.
    OpenLeftover(usize),
    /// One of the databases that were left stays until the next start.
    LeaveLeftover(usize),
    /// Asks whether it shall be removed for good; the next does so, if that was asked.
    AskDiscard(Option<usize>),
    DiscardLeftover(usize),
    /// The answers to the question whether the database shall be saved before it is left.
    LeaveSaving,
    LeaveDiscarding,
    Stay,
}

impl FileCommand {
    /// True if the database that is open is left.
    pub fn leaves(&self) -> bool {
        use FileCommand::{Close, New, Open, OpenLeftover};
        matches!(self, Close | Open(_) | New(_) | OpenLeftover(_))
    }
}

/// Text of a path, where there is no file dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TypedPath {
    pub ask: Ask,
    pub text: String,
    /// True once the field has been shown.
    pub begun: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub enum LibraryCommand {
    Filter(String),
    Sort(Column),
    /// Selects a clip, beside those that are selected if `add`.
    Select {
        clip: ClipId,
        add: bool,
    },
    /// Selects the clips of the list from the first that is selected to this one.
    SelectTo(ClipId),
    /// Shows and selects the clip this many rows below the one that is shown, above it where negative.
    Step(i64),
    /// Shows a clip.
    Open(ClipId),
    /// Shows a stretch of a clip of this name, in a loop.
    GoTo(Stretch),
    /// Shows a stretch of a clip in a loop, and selects it.
    SelectStretch(Stretch),
    DismissReport,
    /// Selects all clips of the list.
    SelectAll,
    /// Uses the clips that somebody has selected as background, or no longer.
    Background,
    /// The pattern of names by which class and person are read.
    Pattern(String),
    /// Clips as strips of poses instead of a table.
    Strips(bool),
    /// The part of the body whose joint is to be clicked.
    Role(Option<Role>),
    /// A joint plays a part of the body from now on; or none does.
    GiveRole {
        role: Role,
        joint: Option<usize>,
    },
    /// Gives roles in all clips of the rig, or in one.
    RolesOfAll(bool),
}

/// Columns of the table of clips.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Column {
    Name,
    Length,
    Subject,
    Labels,
    Format,
    /// What was found of the words that are searched for.
    Found,
}

/// The view of the performer.
#[derive(Debug, Clone, PartialEq)]
pub enum ViewCommand {
    Camera(Camera),
    Front,
    Side,
    Top,
    Reset,
    Follow(bool),
    /// The part of the body that leaves a trail.
    Trail(Option<Role>),
    Onion(bool),
}

#[derive(Debug, Clone, PartialEq)]
pub enum TimelineCommand {
    Zoom {
        factor: f64,
        about_secs: f64,
    },
    Pan(f64),
    Whole,
    Select {
        id: Option<SampleId>,
        add: bool,
    },
    Range(Option<(f64, f64)>),
    /// Ends the selection of labels, stretch and cut.
    SelectNothing,
    /// Selects the segment between the cuts around a moment, and goes there.
    SelectSegment(f64),
    Snap(bool),
    /// A track for each class.
    AllClasses(bool),
    /// Takes hold of a label.
    Grab(super::timeline::Drag),
    /// The pointer that holds it is at a moment.
    Drag(f64),
    Drop,
    /// Splits the selected label at the playhead.
    Split,
    Merge,
    Remove,
    /// Moves start, stop or both of the selected label by this many frames.
    Nudge(super::timeline::Grip, i64),
    /// Puts the start or the stop of the selected label to the playhead.
    ToPlayhead(super::timeline::Grip),
    /// Labels the selected stretch.
    LabelRange(String),
    Cut(CutMethod),
    /// The curve of the joint of this name with its keyframes.
    Channel(Option<(String, ChannelKind)>),
    /// Width of the tracks, as drawn.
    Width(f32),
}

#[derive(Debug, Clone, PartialEq)]
pub enum ClassCommand {
    /// A new class of this name; it is in the database once it has a label.
    Add(String),
    Rename {
        from: String,
        to: String,
    },
    /// The labels of a class become those of another.
    Merge {
        from: String,
        into: String,
    },
    /// Makes a class background.
    IsBackground(String),
    Remove(String),
    /// The key of a class goes down, or up.
    Key {
        slot: usize,
        down: bool,
    },
    Propose,
    Group {
        cuts: bool,
        method: GroupMethod,
    },
    /// The hierarchy is cut into so many groups.
    Depth(usize),
    /// The group at this node of the hierarchy goes one step down, or up.
    Divide(usize),
    Join(usize),
    /// kWAS groups by this.
    Kwas(KwasParams),
    CloseGroups,
    /// The group of this place becomes a class.
    NameGroup {
        group: usize,
        name: String,
    },
    Move {
        id: SampleId,
        class: String,
    },
    /// A stretch becomes a label of a class.
    LabelStretch {
        of: Stretch,
        class: String,
    },
    Accept(SampleId),
    Reject(SampleId),
    /// Proposals at least this likely, percent, are accepted at once, others rejected.
    Likely(u8),
    /// Accepts the proposals at and above that, or rejects those below.
    JudgeAll {
        accept: bool,
    },
    /// The next proposal that is doubtful.
    NextDoubtful,
    Renaming(Option<(String, String)>),
    Adding(String),
    /// The first letters of the class that shall have the key Q; `None` ends choosing.
    Choosing(Option<String>),
    /// A class gets the place of a key, from 0; the class that had it gets the other place.
    GiveKey {
        class: String,
        place: usize,
    },
    /// This class has the key Q from now on.
    Choose(String),
}

#[derive(Debug, Clone, PartialEq)]
pub enum TrainCommand {
    Choose {
        class: String,
        on: bool,
    },
    /// What a class is, whatever its labels say; `None`: what they say.
    Kind {
        class: String,
        kind: Option<ClassKind>,
    },
    /// The parts that count.
    Parts(BoneSet),
    Train,
    Judge,
    /// Measures the learning curve.
    Curve,
    CloseCurve,
    /// Lists the moments of a cell of the confusion matrix and goes to the first; `None` lists the mistakes.
    Cell(Option<(usize, usize)>),
    /// Goes to the moment of this place in the cross-validation.
    Moment(usize),
    /// Goes to the moment so many lines below the chosen one, above it where negative.
    StepMoment(i64),
    Keep(String),
    UseIndex(String),
    /// Shows a report of the database again.
    OpenReport(i64),
    CloseReport,
    /// The figures with which the method of 2009 is trained from now on.
    ThesisParams(Box<SvrdmTrainParams>),
    /// Trains the method of 2009 on the same labels.
    Thesis,
    /// Cross-validates the method of 2009.
    JudgeThesis,
    /// Shows the boundary of a branch of its tree.
    Branch(usize),
    /// Plays the sample of this place that taught it.
    Sample(usize),
}

/// A file dialog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ask {
    Open,
    New,
    Import,
    ImportFolder,
    ImportLabels,
    Captions,
    Video(String),
    Save,
    ExportIndex,
    ExportReport(i64),
    ExportLabels(LabelFormat),
    ExportClip(String),
    ExportStretch(String),
    ExportClass(String),
    ExportPage(String),
    ExportBudget,
}
