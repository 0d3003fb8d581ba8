//! A performer and the index that recognises its motions: what needs no engine.

use std::sync::Arc;

use morec::clip::Skeleton;
use morec::features::KeyPose;
use morec::index::MotionIndex;
use morec::live::{Event, EventOptions, Frame, Performer, PerformerId, Rig};
use morec::math::Vec3;
use morec::roles::RoleMap;

/// Recognises the motions of one performer.
pub struct PerformerStream {
    index: MotionIndex,
    performer: Performer,
    frame: Frame,
    events: Vec<Event>,
}

impl PerformerStream {
    /// Of a performer with this skeleton. Roles that its joints' names do not tell are those of the clips that trained `index`.
    pub fn of_skeleton(index: MotionIndex, skeleton: Skeleton) -> Self {
        let mut roles = RoleMap::find(&skeleton);
        index.complete_roles(&mut roles, &skeleton);
        Self::of_rig(index, Rig { skeleton, roles })
    }

    /// Of a performer whose joints are known by their roles.
    pub fn of_roles(index: MotionIndex) -> Self {
        Self::of_rig(index, Rig::of_roles())
    }

    fn of_rig(index: MotionIndex, rig: Rig) -> Self {
        let options = EventOptions {
            each_repetition: true,
            ..EventOptions::default()
        };
        let mut performer = Performer::new(&index.model, PerformerId(0), &options);
        performer.set_rig(&Arc::new(rig), &mut |_| {});
        Self {
            index,
            performer,
            frame: Frame::default(),
            events: Vec::new(),
        }
    }

    /// Takes the places of the skeleton's joints, in their order.
    pub fn push(&mut self, secs: f64, places: impl Iterator<Item = Vec3>) {
        self.frame.pose.rotations.clear();
        self.frame.pose.positions.clear();
        self.frame.pose.positions.extend(places);
        self.take(secs);
    }

    /// Takes the places of the joints that play roles.
    pub fn push_places(&mut self, secs: f64, pose: &KeyPose) {
        self.frame.set_key_pose(pose);
        self.take(secs);
    }

    fn take(&mut self, secs: f64) {
        self.frame.time_secs = secs;
        self.frame.wall_secs = secs;
        self.events.clear();
        let events = &mut self.events;
        let mut say = |event| events.push(event);
        self.performer.push(&self.frame, &mut say);
    }

    /// Ends the stream; its last motions are then among the [`events`](Self::events).
    pub fn finish(&mut self) {
        self.events.clear();
        let events = &mut self.events;
        self.performer.finish(&mut |event| events.push(event));
    }

    /// The events that the last frame settled, with the names of their classes.
    pub fn events(&self) -> impl Iterator<Item = (String, Event)> {
        let named = |event: &Event| (self.index.model.class_name(event.class).to_owned(), *event);
        self.events.iter().map(named)
    }

    /// What is wrong with the stream of the last seconds for the index, a sentence each with its severity, the gravest first.
    pub fn findings(&self) -> Vec<String> {
        let known = self.performer.diagnosis();
        known.map_or_else(Vec::new, |known| self.index.findings(&known))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::features::for_each_pose;
    use morec::index::Provenance;
    use morec::labels::Sample;
    use morec::live::Phase;
    use morec::synth::{Person, Script, SyntheticTake};
    use morec::train::{Everyday, LabelSet, StreamKind, TrainClip, TrainOptions, train_clips};

    fn waves(number: usize) -> SyntheticTake {
        let script = Script::new(70 + number as u64, Person::draw(5, number));
        let script = (0..3).fold(script, |s, _| s.rest(1.0).play("wave"));
        let name = format!("clip{number}");
        script.rest(1.0).film(&name, 30.0).unwrap()
    }

    fn index() -> MotionIndex {
        let takes = [waves(0), waves(1)];
        let clips = takes.each_ref().map(|take| TrainClip {
            name: take.clip.name.clone(),
            roles: RoleMap::find(&take.clip.skeleton),
            rest: 0..0,
            source: StreamKind::Labelled,
            person: None,
            clip: take.clip.clone(),
        });
        let samples: Vec<Sample> = takes.iter().flat_map(SyntheticTake::samples).collect();
        let labelling = LabelSet {
            samples: &samples,
            classes: &["wave".to_owned()],
            ..LabelSet::default()
        };
        let options = TrainOptions {
            everyday: Everyday::Never,
            ..TrainOptions::default()
        };
        let (model, _) = train_clips(&clips, &labelling, &options, &()).unwrap();
        MotionIndex {
            roles: Default::default(),
            provenance: Provenance::default(),
            model: model.into(),
        }
    }

    #[test]
    fn waves_are_recognised_by_joints_and_by_roles_alike() {
        let take = waves(2);
        let roles = RoleMap::find(&take.clip.skeleton);
        let mut by_roles = PerformerStream::of_roles(index());
        let mut by_joints = PerformerStream::of_skeleton(index(), take.clip.skeleton.clone());
        let [mut of_roles, mut of_joints] = [Vec::new(), Vec::new()];
        let ends = |stream: &PerformerStream| -> Vec<(String, f64)> {
            let ends = stream.events().filter(|(_, e)| e.phase == Phase::End);
            ends.map(|(name, event)| (name, event.span.stop_secs)).collect()
        };
        for_each_pose(&take.clip, &roles, &(0..0), |secs, pose| {
            by_roles.push_places(secs, pose);
            of_roles.extend(ends(&by_roles));
        });
        for frame in 0..take.clip.frames {
            let pose = morec::kinematics::WorldPose::of(&take.clip, frame);
            let secs = frame as f64 / take.clip.rate_hz;
            by_joints.push(secs, pose.positions.into_iter());
            of_joints.extend(ends(&by_joints));
        }
        by_roles.finish();
        of_roles.extend(ends(&by_roles));
        by_joints.finish();
        of_joints.extend(ends(&by_joints));
        assert_eq!(of_roles.len(), 3, "{of_roles:?}");
        assert_eq!(of_joints, of_roles);
        assert!(of_roles.iter().all(|(name, _)| name == "wave"));
    }
}
