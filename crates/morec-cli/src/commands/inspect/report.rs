//! Report of `inspect` on a file, as text and as JSON.

pub mod summary;

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use morec::clip::{Clip, Span};
use morec::diagnosis::{Diagnosis, Finding, Findings, diagnose_clip};
use morec::features::{Hand, Profile};
use morec::formats::Format;
use morec::formats::Warning;
use morec::import::{ImportReport, Take};
use morec::roles::{Role, RoleMap};
use serde::Serialize;

/// A file, read or not.
#[derive(Serialize)]
#[serde(untagged)]
pub enum FileReport {
    /// It was read.
    Read(Box<InspectReport>),
    /// It was not.
    Failed {
        /// Path of the file.
        path: PathBuf,
        /// The reason.
        error: String,
    },
}

impl FileReport {
    /// A file that could not be read.
    pub fn failed(path: &Path, error: &anyhow::Error) -> Self {
        Self::Failed {
            path: path.to_owned(),
            error: format!("{error:#}"),
        }
    }
}

/// A file that was read.
#[derive(Serialize)]
pub struct InspectReport {
    path: PathBuf,
    format: Format,
    #[serde(skip_serializing_if = "Option::is_none")]
    skeleton: Option<PathBuf>,
    clips: Vec<ClipReport>,
    warnings: Vec<Warning>,
}

#[derive(Serialize)]
struct ClipReport {
    name: String,
    frames: usize,
    rate_hz: f64,
    duration_secs: f64,
    joints: Vec<JointReport>,
    missing_roles: Vec<Role>,
    #[serde(skip)]
    roles: String,
    /// Of a body with fingers.
    #[serde(skip_serializing_if = "Option::is_none")]
    fingers: Option<String>,
    #[serde(flatten)]
    facts: ImportReport,
    repaired: Vec<Span>,
    diagnosis: Diagnosed,
}

/// Diagnosis of the clip as a stream.
#[derive(Serialize)]
struct Diagnosed {
    #[serde(flatten)]
    figures: Diagnosis,
    findings: Findings,
}

#[derive(Serialize)]
struct JointReport {
    name: String,
    parent: Option<usize>,
    roles: Vec<Role>,
    #[serde(skip)]
    depth: usize,
}

impl InspectReport {
    /// Gathers what there is to say.
    pub fn new(
        path: &Path,
        format: Format,
        skeleton: Option<PathBuf>,
        imported: &[Take],
        warnings: Vec<Warning>,
    ) -> Self {
        let clips = imported.iter().map(ClipReport::new).collect();
        Self {
            path: path.to_owned(),
            format,
            skeleton,
            clips,
            warnings,
        }
    }

    /// Writes it for people: joint by joint if `full`.
    pub fn write(&self, out: &mut dyn Write, full: bool) -> io::Result<()> {
        writeln!(out, "{}", self.path.display())?;
        for clip in &self.clips {
            if full {
                self.write_clip(out, clip)?;
            } else {
                clip.write_summary(out, self.format)?;
            }
        }
        if full {
            for warning in &self.warnings {
                writeln!(out, "  warning    {warning}")?;
            }
        } else if !self.warnings.is_empty() {
            let more = match self.warnings.len() - 1 {
                0 => String::new(),
                more => format!(" (and {more} more)"),
            };
            writeln!(out, "  warning: {}{more}", self.warnings[0])?;
        }
        Ok(())
    }

    fn write_clip(&self, out: &mut dyn Write, clip: &ClipReport) -> io::Result<()> {
        let format = self.format.title();
        match &self.skeleton {
            Some(skeleton) => writeln!(
                out,
                "  format     {format}, skeleton {}",
                skeleton.display()
            )?,
            None => writeln!(out, "  format     {format}")?,
        }
        if self.clips.len() > 1 {
            writeln!(out, "  character  {}", clip.name)?;
        }
        clip.write(out)
    }
}

impl ClipReport {
    fn new(imported: &Take) -> Self {
        let (clip, roles, facts) = (&imported.clip, &imported.roles, &imported.report);
        let figures = diagnose_clip(clip, roles, &facts.rest_frames);
        Self {
            name: clip.name.clone(),
            frames: clip.frames,
            rate_hz: clip.rate_hz,
            duration_secs: clip.duration_secs(),
            joints: joints(clip, roles),
            missing_roles: roles.missing().collect(),
            roles: count_of(roles),
            fingers: fingers_of(clip, roles),
            facts: facts.clone(),
            repaired: clip.repaired.clone(),
            diagnosis: Diagnosed {
                figures,
                findings: figures.findings(),
            },
        }
    }

    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let facts = &self.facts;
        writeln!(out, "  length     {}", self.length())?;
        writeln!(out, "  up         {}", facts.up)?;
        writeln!(
            out,
            "  unit       {} ({} m)",
            self.unit(),
            significant(facts.metres_per_unit)
        )?;
        if let Some(height) = facts.body_height {
            write!(out, "  body       {height:.2} m from feet to head")?;
            match facts.leg_length {
                Some(leg) => writeln!(out, ", legs {leg:.2} m")?,
                None => writeln!(out)?,
            }
        }
        writeln!(
            out,
            "  place      {}",
            if facts.travels {
                "travels"
            } else {
                "stays in place"
            }
        )?;
        if let Some(hand) = self.diagnosis.figures.hand_m {
            writeln!(
                out,
                "  hand       {:.1} cm from wrist to fingertip",
                100.0 * hand
            )?;
        }
        if let Some(noise_m) = self.diagnosis.figures.noise_m {
            writeln!(out, "  noise      {:.2} cm", 100.0 * noise_m)?;
        }
        writeln!(out, "  rest pose  {}", self.rest())?;
        if !self.repaired.is_empty() {
            let total: usize = self.repaired.iter().map(Span::len).sum();
            writeln!(
                out,
                "  repaired   {total} frames: {}",
                spans(&self.repaired)
            )?;
        }
        if !facts.has_rotations {
            let set = facts.point_set.unwrap_or("no known set");
            writeln!(out, "  points     {set}; rotations are not known")?;
        }
        writeln!(out, "  roles      {}{}", self.roles, self.missing())?;
        if let Some(fingers) = &self.fingers {
            writeln!(out, "  fingers    {fingers}")?;
        }
        writeln!(out, "  joints     {}", self.joints.len())?;
        self.write_joints(out)?;
        for doubt in &facts.doubts {
            writeln!(out, "  warning    {doubt}")?;
        }
        for note in &facts.notes {
            writeln!(out, "  note       {note}")?;
        }
        for finding in self.findings() {
            let (severity, text) = finding.of_file();
            writeln!(out, "  {severity:<10} {text}")?;
        }
        Ok(())
    }

    fn write_joints(&self, out: &mut dyn Write) -> io::Result<()> {
        // A file may hold names and chains of any length; roles beside them are read up to a page's width.
        const WIDEST: usize = 60;
        let indented = |joint: &JointReport| {
            let depth = joint.depth.min(WIDEST / 2);
            format!("{}{}", "  ".repeat(depth), joint.name)
        };
        let widths = self.joints.iter().map(|j| indented(j).chars().count());
        let width = widths.max().unwrap_or(0).min(WIDEST);
        for joint in depth_first(&self.joints)
            .into_iter()
            .map(|j| &self.joints[j])
        {
            let roles: Vec<&str> = joint.roles.iter().map(|role| role.name()).collect();
            let line = format!("    {:width$}  {}", indented(joint), roles.join(", "));
            writeln!(out, "{}", line.trim_end())?;
        }
        Ok(())
    }

    fn write_summary(&self, out: &mut dyn Write, format: Format) -> io::Result<()> {
        writeln!(
            out,
            "  {}, {} joints, {}; up {}, {}, rest pose {}; roles {}{}",
            format.title(),
            self.joints.len(),
            self.length(),
            self.facts.up,
            self.unit(),
            self.rest(),
            self.roles,
            self.missing(),
        )?;
        if !self.facts.has_rotations {
            let set = self.facts.point_set.unwrap_or("no known set of points");
            writeln!(out, "  {set}; rotations are not known")?;
        }
        for doubt in &self.facts.doubts {
            writeln!(out, "  warning: {doubt}")?;
        }
        for note in &self.facts.notes {
            writeln!(out, "  note: {note}")?;
        }
        for finding in self.findings() {
            let (severity, text) = finding.of_file();
            writeln!(out, "  {severity}: {text}")?;
        }
        Ok(())
    }

    /// What is found, but for what a clip without any role says by itself: that no frame shows a body.
    fn findings(&self) -> impl Iterator<Item = &Finding> {
        let is_body = self.missing_roles.len() < Role::BODY_COUNT;
        let said = move |finding: &&Finding| is_body || !matches!(finding, Finding::Nobody { .. });
        self.diagnosis.findings.iter().filter(said)
    }

    fn length(&self) -> String {
        let rate = significant(self.rate_hz);
        format!(
            "{} frames, {:.2} s at {rate} Hz",
            self.frames, self.duration_secs
        )
    }

    fn unit(&self) -> &'static str {
        self.facts.unit.unwrap_or("unknown unit")
    }

    fn rest(&self) -> String {
        match self.facts.rest_frames.len() {
            0 => "none".to_owned(),
            _ => format!(
                "frames {}",
                spans(std::slice::from_ref(&self.facts.rest_frames))
            ),
        }
    }

    fn missing(&self) -> String {
        let names: Vec<&str> = self.missing_roles.iter().map(|role| role.name()).collect();
        if names.is_empty() {
            String::new()
        } else {
            format!("; missing: {}", names.join(", "))
        }
    }
}

/// How many of the roles are found: `18 of 18`, `21 of 21 (right hand)`, `18 of 18 and 42 of 42 (both hands)`.
fn count_of(map: &RoleMap) -> String {
    let is_found = |role: Role| map.joint(role).is_some();
    let count = |profile: Profile| {
        let expected: Vec<Role> = profile.expected(is_found).collect();
        let found = expected.iter().filter(|role| is_found(**role)).count();
        format!("{found} of {}", expected.len())
    };
    let hands = Hand::BOTH.map(|hand| hand.beside_wrist().into_iter().any(is_found));
    let of_hands = match hands {
        [true, true] => format!("{} (both hands)", count(Profile::Hands)),
        [true, false] => format!("{} (left hand)", count(Profile::Hand)),
        [false, true] => format!("{} (right hand)", count(Profile::Hand)),
        [false, false] => String::new(),
    };
    match map.profile() {
        Profile::Hand | Profile::Hands => of_hands,
        profile if of_hands.is_empty() => count(profile),
        profile => format!("{} and {of_hands}", count(profile)),
    }
}

/// What there is of fingers beside the roles, and how they are made to count.
fn fingers_of(clip: &Clip, map: &RoleMap) -> Option<String> {
    let found = map.with_fingers(&clip.skeleton);
    let is_new = |role: &Role| found.joint(*role).is_some() && map.joint(*role).is_none();
    let hands = Hand::BOTH.map(|hand| hand.beside_wrist().iter().any(is_new));
    let (of, bones) = match hands {
        [false, false] => return None,
        [true, true] => ("both hands", "hands or body_and_hands"),
        [true, false] => ("the left hand", "left_hand"),
        [false, true] => ("the right hand", "hand"),
    };
    let points = Role::ALL.iter().filter(|role| is_new(role)).count();
    Some(format!(
        "{points} points of {of}; they count with --bones {bones}"
    ))
}

fn joints(clip: &Clip, map: &RoleMap) -> Vec<JointReport> {
    let mut joints: Vec<JointReport> = Vec::with_capacity(clip.skeleton.len());
    for (j, joint) in clip.skeleton.joints().iter().enumerate() {
        let roles = Role::ALL
            .into_iter()
            .filter(|&role| map.joint(role) == Some(j))
            .collect();
        let depth = joint.parent.map_or(0, |parent| joints[parent].depth + 1);
        joints.push(JointReport {
            name: joint.name.clone(),
            parent: joint.parent,
            roles,
            depth,
        });
    }
    joints
}

/// Each joint followed by what hangs on it; files may list them level by level.
fn depth_first(joints: &[JointReport]) -> Vec<usize> {
    let mut children = vec![Vec::new(); joints.len()];
    let mut left = Vec::new();
    for (j, joint) in joints.iter().enumerate().rev() {
        match joint.parent {
            Some(parent) => children[parent].push(j),
            None => left.push(j),
        }
    }
    let mut order = Vec::with_capacity(joints.len());
    while let Some(j) = left.pop() {
        order.push(j);
        left.extend(&children[j]);
    }
    order
}

/// Half-open, as spans are everywhere; the first ten.
fn spans(spans: &[Span]) -> String {
    const SHOWN: usize = 10;
    let shown: Vec<String> = spans
        .iter()
        .take(SHOWN)
        .map(|s| format!("{}..{}", s.start, s.end))
        .collect();
    let more = if spans.len() > SHOWN { ", …" } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// Five significant digits at most, no trailing zeros.
fn significant(value: f64) -> String {
    let digits = (4 - value.abs().max(1e-300).log10().floor() as i32).clamp(0, 12) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
