//! Poses as lines of JSON, from standard input or over TCP: for trackers that speak nothing else.
//!
//! One object a line, right-handed axes, Y up:
//!
//! ```json
//! {"t": 1.25, "actor": 0, "positions": {"hips": [0, 0.92, 0], "left_thigh": [0.09, 0.9, 0]}}
//! {"t": 1.27, "root": [0, 0.92, 0], "rotations": {"hips": [0, 0, 0, 1], "left_arm": [0, 0, 0.38, 0.92]}}
//! ```
//!
//! - `t`: seconds on the sender's clock; without it the time of arrival counts.
//! - `actor`: whom it shows, 0 if nothing is said.
//! - `positions`: where joints are in the world, by role, in any one unit of length; or
//! - `rotations`: how joints are turned in their parents' frames, `[x, y, z, w]`, by role. Turned by nothing, a
//!   person stands in a T-pose, facing +Z, the left side at +X. Lengths are those of a standard body; `root` is where
//!   its hips are.
//!
//! Roles are those of mapping files: hips, torso, neck, head, and left_ and right_ thigh, shin, foot, shoulder, arm,
//! forearm, hand. What a line leaves out is unknown at that time. Other fields are ignored.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Result, bail};
use morec::live::vmc::{HUMANOID, HUMANOID_BONES, rotation_of_unity};
use morec::live::{Actor, Frame, MAX_ACTORS, Next, Rig, Source, SourceCounts, wall_now_secs};
use morec::math::{Quat, Vec3};
use morec::roles::{Role, RoleMap};

use super::address::Address;
use super::lines::{Came, Lines};

/// Performers of one connection over TCP; others shall find places, too.
const NAMES: usize = 8;
/// A performer over TCP of whom nothing has come for so long has gone.
const GONE_SECS: f64 = 5.0;

const WAIT: Duration = Duration::from_millis(20);

/// A pose as a line gives it.
#[derive(Debug, Default, serde::Deserialize)]
#[serde(default)]
struct Line {
    t: Option<f64>,
    actor: u16,
    root: Option<[f64; 3]>,
    positions: BTreeMap<String, [f64; 3]>,
    rotations: BTreeMap<String, [f64; 4]>,
}

/// A pose in the order of roles; what is unknown is not a number.
#[derive(Debug, Clone, PartialEq)]
struct Pose {
    time_secs: Option<f64>,
    actor: u16,
    positions: [Vec3; Role::COUNT],
    /// Empty if the line gave positions.
    rotations: Vec<Quat>,
}

impl Pose {
    fn of_line(text: &str) -> Option<Self> {
        let line: Line = serde_json::from_str(text).ok()?;
        let mut pose = Self {
            time_secs: line.t.filter(|t| t.is_finite()),
            actor: line.actor,
            positions: [Vec3::repeat(f64::NAN); Role::COUNT],
            rotations: Vec::new(),
        };
        if line.rotations.is_empty() {
            for (name, position) in &line.positions {
                pose.positions[Role::from_name(name)?.index()] = Vec3::from(*position);
            }
        } else {
            pose.turn(&line)?;
        }
        let known = pose
            .positions
            .iter()
            .any(|p| p.iter().all(|c| c.is_finite()));
        known.then_some(pose)
    }

    /// A standard body with its joints turned; what is not named is not turned.
    fn turn(&mut self, line: &Line) -> Option<()> {
        let mut locals = [Quat::identity(); Role::COUNT];
        let mut named = [false; Role::COUNT];
        for (name, [x, y, z, w]) in &line.rotations {
            let role = Role::from_name(name)?;
            // The conversion turns Z and w round: twice round is as it was.
            let rotation = rotation_of_unity([*x, *y, -z, -w])?;
            (locals[role.index()], named[role.index()]) = (rotation, true);
        }
        let mut world = [(Vec3::zeros(), Quat::identity()); HUMANOID_BONES];
        self.rotations = vec![Quat::identity(); Role::COUNT];
        for (b, bone) in HUMANOID.iter().enumerate() {
            let local = bone
                .role
                .map_or(Quat::identity(), |role| locals[role.index()]);
            // The table faces −Z.
            let [x, y, z] = bone.offset;
            let offset = Vec3::new(-x, y, -z);
            world[b] = match bone.parent {
                Some(p) => (world[p].0 + world[p].1 * offset, world[p].1 * local),
                None => (line.root.map_or(offset, Vec3::from), local),
            };
            let Some(role) = bone.role else { continue };
            self.rotations[role.index()] = world[b].1;
            // A joint is known where the one that carries it is; shoulders and spine are seldom sent.
            use Role::*;
            let carried = matches!(
                role,
                LeftShin
                    | LeftFoot
                    | RightShin
                    | RightFoot
                    | LeftForearm
                    | LeftHand
                    | RightForearm
                    | RightHand
            );
            let by = bone.parent.and_then(|p| HUMANOID[p].role);
            if !carried || by.is_some_and(|role| named[role.index()]) {
                self.positions[role.index()] = world[b].0;
            }
        }
        Some(())
    }

    fn known(&self) -> u32 {
        let known = |p: &Vec3| p.iter().all(|c| c.is_finite());
        (0..Role::COUNT)
            .filter(|r| known(&self.positions[*r]))
            .fold(0, |mask, r| mask | 1 << r)
    }
}

/// A performer of some connection.
struct Performer {
    connection: u64,
    number: u16,
    gone: bool,
    heard_secs: f64,
    /// Roles that were seen.
    known: u32,
}

/// Poses as lines of JSON.
pub struct JsonSource {
    lines: Lines,
    /// Whether the end of the lines is the end of the source.
    ends: bool,
    performers: Vec<Performer>,
    /// A pose whose skeleton was announced first.
    waiting: Option<(Actor, Pose)>,
    leaving: Vec<Actor>,
    begun_secs: f64,
    counts: SourceCounts,
}

impl JsonSource {
    /// `json:-` is standard input.
    pub fn open(address: &Address) -> Result<Self> {
        address.allow(&[])?;
        if address.place != "-" {
            bail!("{address}: expected json:- (standard input) or json+tcp://HOST:PORT");
        }
        Ok(Self::new(Lines::stdin()?, true))
    }

    /// `json+tcp://HOST:PORT` listens there. Returns where, too.
    pub fn listen(address: &Address) -> Result<(Self, std::net::SocketAddr)> {
        address.allow(&[])?;
        let (lines, at) = Lines::listen(address.socket()?)?;
        Ok((Self::new(lines, false), at))
    }

    fn new(lines: Lines, ends: bool) -> Self {
        Self {
            lines,
            ends,
            performers: Vec::new(),
            waiting: None,
            leaving: Vec::new(),
            begun_secs: wall_now_secs(),
            counts: SourceCounts::default(),
        }
    }

    /// The performer `number` of `connection`, a new one if there is room.
    fn performer(&mut self, connection: u64, number: u16) -> Option<usize> {
        let is = |p: &Performer| p.connection == connection && p.number == number;
        if let Some(at) = self.performers.iter().position(is) {
            let performer = &mut self.performers[at];
            performer.heard_secs = wall_now_secs();
            if std::mem::take(&mut performer.gone) {
                self.counts.interruptions += 1;
                // Its skeleton is announced anew.
                performer.known = 0;
            }
            return Some(at);
        }
        let of_connection = |p: &&Performer| p.connection == connection && !p.gone;
        if !self.ends && self.performers.iter().filter(of_connection).count() >= NAMES {
            return None;
        }
        let new = Performer {
            connection,
            number,
            gone: false,
            heard_secs: wall_now_secs(),
            known: 0,
        };
        if let Some(at) = self.performers.iter().position(|p| p.gone) {
            self.counts.interruptions += 1;
            self.performers[at] = new;
            return Some(at);
        }
        (self.performers.len() < MAX_ACTORS).then(|| {
            self.performers.push(new);
            self.performers.len() - 1
        })
    }

    /// Performers of whom nothing comes any more make room; a file on standard input may take its time.
    fn forget_silent(&mut self) {
        if self.ends {
            return;
        }
        let now_secs = wall_now_secs();
        for (at, performer) in self.performers.iter_mut().enumerate() {
            if !performer.gone && now_secs - performer.heard_secs > GONE_SECS {
                performer.gone = true;
                self.leaving.push(Actor(at as u16));
            }
        }
    }

    fn line(&mut self, connection: u64, text: Option<&str>, frame: &mut Frame) -> Next {
        self.counts.packets += 1;
        let Some(pose) = text.and_then(Pose::of_line) else {
            self.counts.malformed += 1;
            return Next::Quiet;
        };
        let Some(at) = self.performer(connection, pose.actor) else {
            self.counts.refused += 1;
            return Next::Quiet;
        };
        let performer = &mut self.performers[at];
        let actor = Actor(at as u16);
        let seen = pose.known();
        if seen & !performer.known != 0 {
            performer.known |= seen;
            let rig = rig_of(performer.known);
            self.waiting = Some((actor, pose));
            return Next::Rig(actor, Arc::new(rig));
        }
        self.counts.incomplete += u64::from(seen != performer.known);
        self.fill(actor, &pose, frame)
    }

    fn fill(&self, actor: Actor, pose: &Pose, frame: &mut Frame) -> Next {
        frame.wall_secs = wall_now_secs();
        frame.time_secs = pose.time_secs.unwrap_or(frame.wall_secs - self.begun_secs);
        frame.actor = actor;
        frame.pose.positions.clear();
        frame.pose.positions.extend(pose.positions);
        frame.pose.rotations.clone_from(&pose.rotations);
        Next::Frame
    }
}

impl Source for JsonSource {
    fn next(&mut self, frame: &mut Frame) -> Next {
        if let Some((actor, pose)) = self.waiting.take() {
            return self.fill(actor, &pose, frame);
        }
        self.forget_silent();
        if let Some(actor) = self.leaving.pop() {
            return Next::Gone(actor);
        }
        match self.lines.next(WAIT) {
            Came::Line(connection, text) => self.line(connection, text.as_deref(), frame),
            Came::Closed(connection) => {
                for (at, performer) in self.performers.iter_mut().enumerate() {
                    if performer.connection == connection && !performer.gone {
                        performer.gone = true;
                        self.leaving.push(Actor(at as u16));
                    }
                }
                Next::Quiet
            }
            Came::Nothing => Next::Quiet,
            Came::Ended if self.ends => Next::Ended,
            Came::Ended => {
                std::thread::sleep(WAIT);
                Next::Quiet
            }
        }
    }

    fn counts(&self) -> SourceCounts {
        self.counts
    }
}

/// A skeleton of the roles in `known`.
fn rig_of(known: u32) -> Rig {
    let mut rig = Rig::of_roles();
    let mut roles = RoleMap::default();
    for role in Role::ALL
        .into_iter()
        .filter(|r| known >> r.index() & 1 == 1)
    {
        roles.set(role, Some(role.index()));
    }
    rig.roles = roles;
    rig
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_taken_as_they_are() {
        let pose = Pose::of_line(
            r#"{"t": 2.5, "actor": 3, "positions": {"head": [0, 1.6, 0.1]}, "note": 1}"#,
        )
        .unwrap();
        assert_eq!(
            (pose.time_secs, pose.actor, pose.known()),
            (Some(2.5), 3, 1 << Role::Head.index())
        );
        assert_eq!(pose.positions[Role::Head.index()], Vec3::new(0.0, 1.6, 0.1));
    }

    #[test]
    fn an_arm_turned_about_the_vertical_reaches_forward() {
        // The left arm lies along +X; −90° about Y takes it to +Z, where the person looks.
        let line = r#"{"rotations": {"hips": [0,0,0,1], "left_arm": [0,-0.7071068,0,0.7071068]}}"#;
        let pose = Pose::of_line(line).unwrap();
        let at = |role: Role| pose.positions[role.index()];
        let arm = (at(Role::LeftForearm) - at(Role::LeftArm)).normalize();
        assert!((arm - Vec3::z()).norm() < 1e-6, "{arm}");
        assert!(at(Role::LeftThigh).x > 0.0 && at(Role::Neck).y > at(Role::Hips).y);
        // Nothing was said of the forearm, so nothing is known of the hand.
        assert!(at(Role::LeftHand).x.is_nan());
    }

    #[test]
    fn rubbish_is_no_pose() {
        for line in [
            "",
            "hello",
            "{}",
            "[1,2]",
            r#"{"positions": {"tail": [0,0,0]}}"#,
            r#"{"positions": {"head": [0,0]}}"#,
            r#"{"rotations": {"head": [0,0,0,0]}}"#,
            r#"{"t": "soon", "positions": {"head": [0,0,0]}}"#,
        ] {
            assert_eq!(Pose::of_line(line), None, "{line}");
        }
    }

    /// One connection cannot take every place, and a place of whom nothing comes is free again.
    #[test]
    fn one_connection_does_not_take_all_places() {
        let lines = Lines::listen("127.0.0.1:0".parse().unwrap()).unwrap().0;
        let mut source = JsonSource::new(lines, false);
        let taken = (0..40)
            .filter_map(|number| source.performer(1, number))
            .count();
        assert_eq!(taken, NAMES);
        assert!(source.performer(2, 0).is_some());
        for performer in &mut source.performers {
            performer.heard_secs -= 2.0 * GONE_SECS;
        }
        source.forget_silent();
        assert_eq!(source.leaving.len(), NAMES + 1);
        assert!(source.performer(1, 39).is_some() && source.performer(1, 0).is_some());
    }
}
