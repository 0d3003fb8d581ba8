//! A wrong role is mended by a click.

use morec::roles::Role;

use super::{Person, made};

fn joint_name(person: &Person, role: Role) -> String {
    let motion = person.state().player.motion.as_ref().unwrap();
    let joint = motion.roles.joint(role).unwrap();
    motion.clip.skeleton.joints()[joint].name.clone()
}

#[test]
fn a_part_and_a_joint_are_clicked_and_the_skeleton_follows_and_it_is_undone() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    let before = person
        .state()
        .store
        .as_ref()
        .unwrap()
        .snapshot
        .roles
        .clone();
    let (left, right) = (
        joint_name(&person, Role::LeftFoot),
        joint_name(&person, Role::RightFoot),
    );
    person.click(&format!("Part left foot: {left}"));
    person.click(&format!("Joint {right}"));
    person.settle();
    assert_eq!(joint_name(&person, Role::LeftFoot), right);
    let motion = person.state().player.motion.as_ref().unwrap();
    assert_eq!(
        motion.roles.joint(Role::RightFoot),
        None,
        "a joint plays one part"
    );
    assert!(
        !person.offers(&format!("Joint {right}")),
        "nothing is asked for any more"
    );
    let now = &person.state().store.as_ref().unwrap().snapshot.roles;
    assert!(
        now.iter().all(|(id, roles)| *roles != before[id]),
        "in all of this rig"
    );
    let line = &person.state().command_line;
    assert!(
        line.contains(&format!("--set-role left_foot={right}")),
        "{line}"
    );
    assert!(line.contains("--set-role right_foot="), "{line}");
    person.undo();
    assert_eq!(
        person.state().store.as_ref().unwrap().snapshot.roles,
        before
    );
    assert_eq!(joint_name(&person, Role::LeftFoot), left);
}

#[test]
fn a_part_is_given_to_nobody_in_one_clip_only() {
    let folder = tempfile::tempdir().unwrap();
    let mut person = Person::before(&[made(folder.path(), 0)]);
    let hips = joint_name(&person, Role::Hips);
    person.click(&format!("Part hips: {hips}"));
    person.click("in all of this rig (3 clips)");
    person.click("None");
    person.settle();
    let snapshot = &person.state().store.as_ref().unwrap().snapshot;
    let without = snapshot
        .roles
        .values()
        .filter(|r| r.joint(Role::Hips).is_none());
    assert_eq!(without.count(), 1);
    person.undo();
    assert_eq!(joint_name(&person, Role::Hips), hips);
}
