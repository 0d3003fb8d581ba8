//! A part of a skeleton is posed as the whole.

use mocap::kinematics::{PartialSkeleton, WorldPose, for_each_world_pose};
use proptest::prelude::*;

use crate::bvh_roundtrip::clip;

proptest! {
    #[test]
    fn the_joints_of_a_part_are_where_the_whole_skeleton_has_them(
        clip in clip(), chosen in prop::collection::vec(any::<bool>(), 9), rest in 0usize..3,
    ) {
        let wanted: Vec<usize> = (0..clip.skeleton.len()).filter(|joint| chosen[*joint]).collect();
        let mut whole: Vec<(f64, WorldPose)> = Vec::new();
        for_each_world_pose(&clip, &(0..rest), |secs, pose| whole.push((secs, pose.clone())));
        let mut frame = 0;
        PartialSkeleton::of(&clip, wanted.iter().copied()).for_each_world_pose(&(0..rest), |secs, pose| {
            assert_eq!(secs, whole[frame].0);
            for joint in &wanted {
                assert_eq!(pose.positions[*joint], whole[frame].1.positions[*joint]);
            }
            frame += 1;
        });
        prop_assert_eq!(frame, clip.frames);
    }
}
