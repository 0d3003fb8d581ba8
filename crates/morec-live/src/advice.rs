//! Advice about streams in sentences, each given once and as soon as it is certain. Used by `morec live` and `morec.listen`.

use std::time::{Duration, Instant};

use morec::diagnosis::{Finding, Severity};
use morec::index::MotionIndex;
use morec::live::{MAX_PERFORMERS, Status};

/// After so long without data, that is reported.
const SILENCE: Duration = Duration::from_secs(2);
/// Between two looks.
const EVERY: Duration = Duration::from_millis(200);

/// Said once of a performer for whom the wider gate opened.
const OPENED: &str = "performs unlike the training subject: matching is relaxed from now on (--performer teacher keeps it strict)";

/// Findings about one source.
struct AdvisedSource {
    name: String,
    /// Bits of the findings of each performer that were there at the last look, and of those that were said.
    seen: [u32; MAX_PERFORMERS],
    said: [u32; MAX_PERFORMERS],
    silence_said: bool,
    /// Performers for whom the wider gate was closed at some look, and of whom it was said that it opened.
    closed: [bool; MAX_PERFORMERS],
    opening_said: [bool; MAX_PERFORMERS],
    misfit_said: bool,
}

/// Says findings of sources, each once.
pub struct Advice {
    sources: Vec<AdvisedSource>,
    begun: Instant,
    looked: Instant,
}

impl Advice {
    /// For sources of these names.
    pub fn new(names: impl IntoIterator<Item = String>) -> Self {
        let source = |name| AdvisedSource {
            name,
            seen: [0; MAX_PERFORMERS],
            said: [0; MAX_PERFORMERS],
            silence_said: false,
            closed: [false; MAX_PERFORMERS],
            opening_said: [false; MAX_PERFORMERS],
            misfit_said: false,
        };
        let now = Instant::now();
        Self {
            sources: names.into_iter().map(source).collect(),
            begun: now,
            looked: now,
        }
    }

    /// News in the statuses of sources that are compared with `index`, in their order. What only one look has shown waits for
    /// the next.
    pub fn look(&mut self, statuses: &[Status], index: &MotionIndex) -> Vec<String> {
        let mut lines = Vec::new();
        if self.looked.elapsed() < EVERY {
            return lines;
        }
        self.looked = Instant::now();
        let silent = self.begun.elapsed() >= SILENCE;
        for (source, status) in self.sources.iter_mut().zip(statuses) {
            if silent && status.frames == 0 && !source.silence_said && !status.ended {
                source.silence_said = true;
                lines.push(format!("{}: {}", source.name, silence(status)));
            }
            source.look(status, &mut lines);
            source.misfit(status, index, &mut lines);
        }
        lines
    }
}

impl AdvisedSource {
    fn look(&mut self, status: &Status, lines: &mut Vec<String>) {
        for actor in &status.actors {
            let at = actor.actor.index();
            // With --performer anyone it never was closed.
            self.closed[at] |= !actor.admits_strangers;
            if actor.admits_strangers && self.closed[at] && !self.opening_said[at] {
                self.opening_said[at] = true;
                lines.push(format!("{}: {OPENED}", who(&self.name, at)));
            }
            let Some(diagnosis) = actor.diagnosis else {
                continue;
            };
            let findings = diagnosis.findings();
            for finding in findings.iter().filter(|finding| matters(finding)) {
                let bit = finding.bit();
                if self.seen[at] & bit != 0 && self.said[at] & bit == 0 {
                    self.said[at] |= bit;
                    lines.push(format!(
                        "{}: {}: {finding}",
                        who(&self.name, at),
                        finding.severity()
                    ));
                }
            }
            self.seen[at] = findings.bits();
        }
    }

    /// Says once that the index does not fit a performer: of another kind, or with another heading in training.
    fn misfit(&mut self, status: &Status, index: &MotionIndex, lines: &mut Vec<String>) {
        if self.misfit_said {
            return;
        }
        let mut known = status.actors.iter().filter_map(|actor| actor.diagnosis);
        if let Some((severity, text)) = known.find_map(|d| index.misfit(&d)) {
            self.misfit_said = true;
            lines.push(format!("{}: {severity}: {text}", self.name));
        }
    }
}

fn matters(finding: &Finding) -> bool {
    finding.severity() >= Severity::Warning
}

fn who(source: &str, actor: usize) -> String {
    match actor {
        0 => source.to_owned(),
        actor => format!("{source}, performer {actor}"),
    }
}

/// Likely reason why a source has given no frame.
fn silence(status: &Status) -> String {
    let counts = &status.source;
    if counts.packets == 0 {
        "nothing has arrived yet: check that the tracker is sending, that it sends to this address and port, and that no \
         firewall blocks it".to_owned()
    } else if counts.not_motion > 0 {
        "only a rest pose arrives: the tracker sees no person (give --keep-t-pose if the performer really stands in a \
         T-pose)".to_owned()
    } else if counts.malformed * 2 > counts.packets {
        "packets arrive but cannot be read: check that the sender uses this protocol".to_owned()
    } else {
        "packets arrive, but without poses: switch on the sending of bones in the tracker"
            .to_owned()
    }
}

/// Everything found of a source that is compared with `index`, a sentence each, for the end of a session.
pub fn advice_of_status(status: &Status, index: &MotionIndex) -> Vec<String> {
    let mut lines = Vec::new();
    if status.frames == 0 {
        lines.push(silence(status));
    }
    for actor in &status.actors {
        let Some(diagnosis) = actor.diagnosis else {
            continue;
        };
        let name = match actor.actor.index() {
            0 if status.actors.len() == 1 => "stream".to_owned(),
            actor => format!("performer {actor}"),
        };
        lines.push(format!("{name}: {diagnosis}"));
        lines.extend(index.findings(&diagnosis));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::Trainer;
    use morec::diagnosis::Diagnoser;
    use morec::features::KeyPose;
    use morec::import::{ImportOptions, normalize};
    use morec::labels::Labels;
    use morec::live::{PerformerId, PerformerStatus};
    use morec::math::Vec3;
    use morec::roles::Role;
    use morec::synth::{Person, Script};
    use morec::train::{Everyday, TrainOptions};

    fn performer(admits_strangers: bool) -> PerformerStatus {
        PerformerStatus {
            actor: PerformerId(1),
            frames: 60,
            time_secs: 2.0,
            wall_secs: 2.0,
            wait_secs: 0.0,
            early: None,
            last: None,
            admits_strangers,
            diagnosis: None,
        }
    }

    #[test]
    fn an_opened_gate_is_said_once_and_not_where_it_was_open_from_the_start() {
        let said = |looks: &[bool]| {
            let mut source = Advice::new(["here".to_owned()]).sources.remove(0);
            let mut lines = Vec::new();
            for is_open in looks {
                let status = Status {
                    frames: 60,
                    actors: vec![performer(*is_open)],
                    ..Status::default()
                };
                source.look(&status, &mut lines);
            }
            lines
        };
        let opened = said(&[false, true, true, false, true]);
        assert_eq!(opened, [format!("here, performer 1: {OPENED}")]);
        assert_eq!(said(&[true, true]), [""; 0]);
        assert_eq!(said(&[false, false]), [""; 0]);
    }

    /// An index that was learned without legs.
    fn index() -> MotionIndex {
        let person = Person::draw(3, 1);
        let script = Script::new(3, person).rest(1.0).play("push").rest(1.0);
        let film = script.play("wave").rest(1.0).film("film", 30.0).unwrap();
        let mut labels = Labels::default();
        for sample in film.samples() {
            labels.add(&sample.clip, &sample.class, sample.span);
        }
        let take = normalize(film.clip, &ImportOptions::default()).unwrap();
        let options = TrainOptions {
            everyday: Everyday::Never,
            ..Default::default()
        };
        let trainer = Trainer::new().labels(&labels).method(options);
        let mut index = trainer.train(&[take]).unwrap();
        index.roles.remove(&Role::LeftThigh);
        index.roles.remove(&Role::RightThigh);
        index
    }

    /// Two seconds of a stream that stays in `pose`.
    fn status_of(pose: &KeyPose) -> Status {
        let mut diagnoser = Diagnoser::live();
        for frame in 0..60 {
            let secs = f64::from(frame) / 30.0;
            diagnoser.push(secs, secs, pose);
        }
        let actor = PerformerStatus {
            diagnosis: Some(diagnoser.diagnosis()),
            ..performer(false)
        };
        Status {
            frames: 60,
            actors: vec![actor],
            ..Status::default()
        }
    }

    #[test]
    fn an_index_of_whole_bodies_is_doubted_once_where_no_hips_are_seen() {
        let mut desk = KeyPose::default();
        desk.set(Role::LeftArm, Vec3::new(0.2, 1.4, 0.0));
        desk.set(Role::RightArm, Vec3::new(-0.2, 1.4, 0.0));
        let mut index = index();
        let mut source = Advice::new(["json:-".to_owned()]).sources.remove(0);
        let mut said = Vec::new();
        let mut look = |index: &MotionIndex| {
            source.misfit(&status_of(&desk), index, &mut said);
            said.len()
        };
        assert_eq!(look(&index), 0, "it was learned without legs");
        for role in [Role::LeftThigh, Role::RightThigh] {
            index.roles.insert(role, role.name().to_owned());
        }
        assert_eq!(look(&index), 1);
        assert_eq!(look(&index), 1);
        assert!(said[0].starts_with("json:-: warning: the index takes the heading from the hips"));
    }

    #[test]
    fn a_finding_is_said_once_when_it_has_lasted_for_two_looks() {
        let status = status_of(&KeyPose::default());
        let mut source = Advice::new(["vmc://here".to_owned()]).sources.remove(0);
        let mut said = Vec::new();
        source.look(&status, &mut said);
        assert_eq!(said, [""; 0]);
        (0..3).for_each(|_| source.look(&status, &mut said));
        assert_eq!(said.len(), 1, "{said:?}");
        assert!(
            said[0].starts_with("vmc://here, performer 1: error: 100 % of the frames show no body")
        );
        let index = index();
        assert!(advice_of_status(&status, &index)[1].contains("no body"));
    }

    #[test]
    fn silence_has_its_reasons() {
        let index = index();
        let mut status = Status::default();
        assert!(advice_of_status(&status, &index)[0].contains("nothing has arrived"));
        status.source.packets = 9;
        assert!(advice_of_status(&status, &index)[0].contains("without poses"));
        status.source.malformed = 8;
        assert!(advice_of_status(&status, &index)[0].contains("cannot be read"));
        status.source.not_motion = 3;
        assert!(advice_of_status(&status, &index)[0].contains("rest pose"));
    }
}
