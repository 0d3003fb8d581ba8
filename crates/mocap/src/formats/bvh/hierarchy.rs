//! The HIERARCHY section: joints, offsets and channels.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use super::notes::Notes;
use super::number;
use super::text::{Cursor, show};
use crate::clip::Joint;
use crate::formats::encoding::Encoding;
use crate::formats::{Limits, ParseError, Place};
use crate::math::{Axis, Vec3};

/// One column of the motion table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Channel {
    Position(Axis),
    Rotation(Axis),
}

/// The skeletons of a file, one after another, and the columns of their shared motion table.
#[derive(Debug, Default)]
pub(super) struct BvhHierarchy {
    /// Joints of all roots in file order; parents are indices into this list.
    pub joints: Vec<Joint>,
    /// For each joint, the line it begins on.
    pub lines: Vec<u64>,
    /// For each joint, its columns.
    pub columns: Vec<Range<usize>>,
    /// What each column of a frame moves, in the order of the file.
    pub channels: Vec<Channel>,
    /// First joint of each root, in order.
    pub roots: Vec<usize>,
    /// True if a MOTION section follows.
    pub motion_follows: bool,
}

impl BvhHierarchy {
    /// The joints of the `k`th root.
    pub fn character(&self, k: usize) -> Range<usize> {
        self.roots[k]..self.roots.get(k + 1).copied().unwrap_or(self.joints.len())
    }
}

/// Reads from the first ROOT to the word MOTION or the end of the file.
pub(super) fn parse(
    cursor: &mut Cursor<'_>,
    encoding: Encoding,
    limits: &Limits,
    notes: &mut Notes,
) -> Result<BvhHierarchy, ParseError> {
    let mut parser = Parser {
        cursor,
        encoding,
        limits,
        notes,
        found: BvhHierarchy::default(),
        open: Vec::new(),
    };
    while let Some(token) = parser.keyword()? {
        if parser.open.is_empty() {
            if token.eq_ignore_ascii_case(b"MOTION") {
                parser.found.motion_follows = true;
                break;
            }
            parser.top_level(token)?;
        } else {
            parser.inside(token)?;
        }
    }
    parser.finish()
}

/// A brace that was opened and not yet closed.
struct OpenJoint {
    /// The joint, or for an End Site the joint it belongs to.
    joint: usize,
    is_end: bool,
    line: u64,
    offset: Option<Vec3>,
}

struct Parser<'a, 't> {
    cursor: &'a mut Cursor<'t>,
    encoding: Encoding,
    limits: &'a Limits,
    notes: &'a mut Notes,
    found: BvhHierarchy,
    open: Vec<OpenJoint>,
}

impl<'t> Parser<'_, 't> {
    /// The next token where a keyword should stand; comments are skipped.
    fn keyword(&mut self) -> Result<Option<&'t [u8]>, ParseError> {
        loop {
            self.cursor.skip_space()?;
            if !self.cursor.at_comment() {
                return self.cursor.token();
            }
            self.notes
                .count("comment", self.cursor.line, || "comment skipped".into());
            self.cursor.rest_of_line();
        }
    }

    fn error(&self, expected: impl Into<String>, found: Option<&[u8]>) -> ParseError {
        ParseError::new(self.cursor.place(), expected, show(found))
    }

    fn top_level(&mut self, token: &[u8]) -> Result<(), ParseError> {
        match token {
            b"{" | b"}" => {
                let line = self.cursor.line;
                self.notes.count("stray brace", line, || {
                    format!("stray {} skipped", show(Some(token)))
                });
                Ok(())
            }
            _ if token.eq_ignore_ascii_case(b"ROOT") => {
                self.found.roots.push(self.found.joints.len());
                self.open_joint(None)
            }
            _ => Err(self.error("ROOT or MOTION", Some(token))),
        }
    }

    fn inside(&mut self, token: &[u8]) -> Result<(), ParseError> {
        let (joint, is_end) = self.open.last().map_or((0, false), |o| (o.joint, o.is_end));
        let lower = token.to_ascii_lowercase();
        match lower.as_slice() {
            b"}" => self.close(),
            b"offset" => self.offset(),
            b"channels" => self.channels(joint, is_end),
            b"joint" if !is_end => self.open_joint(Some(joint)),
            // `End Site`, `EndSite`, `End Effector`, `End`.
            _ if lower.starts_with(b"end") && !is_end => self.open_end(joint),
            _ if is_end => Err(self.error("OFFSET or `}` in an End Site", Some(token))),
            _ => Err(self.error("OFFSET, CHANNELS, JOINT, End Site or `}`", Some(token))),
        }
    }

    fn open_joint(&mut self, parent: Option<usize>) -> Result<(), ParseError> {
        let line = self.cursor.line;
        let mut name = self.cursor.name(self.encoding)?;
        let joint = self.found.joints.len();
        if name.is_empty() {
            name = format!("joint{joint}");
            self.notes.count("no name", line, || {
                format!("a joint without a name, called {name}")
            });
        }
        if joint >= self.limits.joints {
            let expected = format!("at most {} joints", self.limits.joints);
            return Err(ParseError::new(Place::Line(line), expected, "more"));
        }
        if self.open.len() >= self.limits.depth {
            let expected = format!("at most {} joints from root to leaf", self.limits.depth);
            return Err(ParseError::new(Place::Line(line), expected, "more"));
        }
        // A joint without CHANNELS has none; its line, if it comes, widens this.
        let columns = self.found.channels.len();
        self.found.columns.push(columns..columns);
        self.found.lines.push(line);
        self.found.joints.push(Joint {
            name,
            parent,
            offset: Vec3::zeros(),
            tip: None,
        });
        self.open_brace(joint, false)
    }

    fn open_end(&mut self, joint: usize) -> Result<(), ParseError> {
        // The rest of the line, `Site` or a name of the end: a tip has none.
        self.cursor.name(self.encoding)?;
        self.open_brace(joint, true)
    }

    fn open_brace(&mut self, joint: usize, is_end: bool) -> Result<(), ParseError> {
        let line = self.cursor.line;
        match self.keyword()? {
            Some(b"{") => {
                self.open.push(OpenJoint {
                    joint,
                    is_end,
                    line,
                    offset: None,
                });
                Ok(())
            }
            other => {
                let what = self.describe(joint, is_end);
                Err(self.error(format!("`{{` after {what} (line {line})"), other))
            }
        }
    }

    fn describe(&self, joint: usize, is_end: bool) -> String {
        let what = if is_end { "the End Site of" } else { "joint" };
        format!("{what} {}", self.found.joints[joint].name)
    }

    fn close(&mut self) -> Result<(), ParseError> {
        let Some(open) = self.open.pop() else {
            return Ok(());
        };
        let line = self.cursor.line;
        if open.offset.is_none() {
            let name = self.found.joints[open.joint].name.clone();
            self.notes.count("no offset", open.line, || {
                format!("{name} has no OFFSET, taken as 0 0 0")
            });
        }
        let offset = open.offset.unwrap_or_else(Vec3::zeros);
        let joint = &mut self.found.joints[open.joint];
        if !open.is_end {
            joint.offset = offset;
        } else if joint.tip.is_none() {
            joint.tip = Some(offset);
        } else {
            let name = joint.name.clone();
            self.notes.count("second end", line, || {
                format!("{name} has several End Sites, the first is used")
            });
        }
        Ok(())
    }

    fn offset(&mut self) -> Result<(), ParseError> {
        let mut values = Vec::with_capacity(3);
        while values.len() < 3 {
            let token = self.cursor.token()?;
            self.number(token, &mut values)?;
        }
        if values.len() > 3 {
            return Err(ParseError::new(
                self.cursor.place(),
                "3 numbers after OFFSET",
                values.len().to_string(),
            ));
        }
        let line = self.cursor.line;
        if values.iter().any(|v| v.is_nan()) {
            self.notes.count("offset nan", line, || {
                "OFFSET is not a number, taken as 0".into()
            });
        }
        let offset = Vec3::from_iterator(values.iter().map(|v| if v.is_nan() { 0.0 } else { *v }));
        let Some(open) = self.open.last_mut() else {
            return Ok(());
        };
        if open.offset.replace(offset).is_some() {
            self.notes.count("second offset", line, || {
                "a second OFFSET in one joint, the last is used".into()
            });
        }
        Ok(())
    }

    /// Appends the number (or glued numbers) of one token.
    fn number(&mut self, token: Option<&[u8]>, values: &mut Vec<f64>) -> Result<(), ParseError> {
        let line = self.cursor.line;
        let text = token.unwrap_or_default();
        if let Some(value) = number::parse(text) {
            values.push(value);
        } else if let Some(value) = number::parse_with_comma(text) {
            self.notes.count("comma", line, || {
                format!("decimal comma in {}", show(token))
            });
            values.push(value);
        } else if number::parse_glued(text, values).is_some() {
            self.notes.count("glued", line, || {
                format!("numbers without a blank between them, {}", show(token))
            });
        } else {
            return Err(self.error("a number after OFFSET", token));
        }
        Ok(())
    }

    /// `CHANNELS n name…`: the names count, whatever `n` says.
    fn channels(&mut self, joint: usize, is_end: bool) -> Result<(), ParseError> {
        let token = self.cursor.token()?;
        let declared = token
            .and_then(|t| std::str::from_utf8(t).ok())
            .and_then(|t| t.parse::<usize>().ok());
        // The number is held against the names: where they differ, a program has left a channel out of one of the two.
        let Some(declared) = declared else {
            return Err(self.error("a count after CHANNELS", token));
        };
        let line = self.cursor.line;
        // Columns of a joint lie together; CHANNELS behind a child's would tear them apart.
        if self.found.columns[joint].end != self.found.channels.len() {
            let expected = "CHANNELS before the joint's children";
            return Err(ParseError::new(
                Place::Line(line),
                expected,
                "CHANNELS after them",
            ));
        }
        let before = self.found.channels.len();
        let unknown = self.channel_names()?;
        let named = self.found.channels.len() - before;
        // `CHANNELS 0` in an End Site is harmless.
        if is_end && named + declared > 0 {
            return Err(ParseError::new(
                Place::Line(line),
                "no channels in an End Site",
                declared.to_string(),
            ));
        }
        if let Some(token) = unknown.filter(|_| named < declared) {
            return Err(ParseError::new(
                Place::Line(line),
                "a channel such as Xrotation",
                show(Some(token)),
            ));
        }
        if named != declared {
            let text =
                || format!("CHANNELS declares {declared} but names {named}, the names count");
            self.notes.count("channel count", line, text);
        }
        self.found.columns[joint].end = self.found.channels.len();
        Ok(())
    }

    /// Appends channel names as far as they go; returns the first word of the line that is neither a channel nor a keyword.
    fn channel_names(&mut self) -> Result<Option<&'t [u8]>, ParseError> {
        loop {
            // The names may go on over the end of the line, so only the next token says whether there is one more.
            let mut ahead = self.cursor.clone();
            let line = ahead.line;
            let Some(token) = ahead.token()? else {
                return Ok(None);
            };
            match channel(token) {
                Some(channel) => self.found.channels.push(channel),
                None => return Ok((ahead.line == line && !is_keyword(token)).then_some(token)),
            }
            *self.cursor = ahead;
        }
    }

    fn finish(mut self) -> Result<BvhHierarchy, ParseError> {
        if let Some(open) = self.open.last() {
            let what = self.describe(open.joint, open.is_end);
            return Err(self.error(
                format!("`}}` closing {what} (opened on line {})", open.line),
                None,
            ));
        }
        if self.found.roots.is_empty() {
            return Err(self.error("ROOT", self.found.motion_follows.then_some(b"MOTION")));
        }
        for k in 0..self.found.roots.len() {
            let range = self.found.character(k);
            make_names_unique(
                &mut self.found.joints[range.clone()],
                &self.found.lines[range],
                self.notes,
            );
        }
        Ok(self.found)
    }
}

fn is_keyword(token: &[u8]) -> bool {
    let lower = token.to_ascii_lowercase();
    matches!(
        lower.as_slice(),
        b"{" | b"}" | b"offset" | b"channels" | b"joint" | b"root" | b"motion"
    ) || lower.starts_with(b"end")
        || lower.starts_with(b"#")
        || lower.starts_with(b"//")
}

fn channel(token: &[u8]) -> Option<Channel> {
    let (first, rest) = token.split_first()?;
    let axis = Axis::from_letter(char::from(*first))?;
    if rest.eq_ignore_ascii_case(b"position") {
        Some(Channel::Position(axis))
    } else {
        rest.eq_ignore_ascii_case(b"rotation")
            .then_some(Channel::Rotation(axis))
    }
}

/// Gives the second `Hand` of a skeleton the name `Hand.001`.
fn make_names_unique(joints: &mut [Joint], lines: &[u64], notes: &mut Notes) {
    // A name that is made must be none that another joint has by itself.
    let originals: HashSet<String> = joints.iter().map(|j| j.name.clone()).collect();
    let mut next: HashMap<String, usize> = HashMap::new();
    for (joint, &line) in joints.iter_mut().zip(lines) {
        let Some(number) = next.get_mut(&joint.name) else {
            next.insert(joint.name.clone(), 1);
            continue;
        };
        let old = std::mem::take(&mut joint.name);
        while joint.name.is_empty() || originals.contains(&joint.name) {
            joint.name = format!("{old}.{number:03}");
            *number += 1;
        }
        let text = || {
            format!(
                "another joint is called {old} too, this one is now {}",
                joint.name
            )
        };
        notes.count("same name", line, text);
    }
}
