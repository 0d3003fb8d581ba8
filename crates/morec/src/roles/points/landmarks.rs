//! Landmarks of pose estimators and depth cameras, and joints by their usual names.

use super::PointSet;

/// Roles among joints by their usual names: of landmark models, of skeletons of every animation program, and morec's
/// own. Upper arms come before collars, because a shoulder is the one or the other.
pub(super) const JOINTS: PointSet = PointSet {
    name: "joint names",
    points: "",
    numbered: false,
    roles: &[
        (
            "?_thigh",
            "?upleg|?thigh|?upperleg|?femur|?hjc|?hip|?hipjoint",
        ),
        (
            "?_shin",
            "?knee|?shin|?lowleg|?lowerleg|?calf|?tibia|?shank|?kjc|?leg",
        ),
        ("?_foot", "?ankle|?ajc|?foot"),
        (
            "?_arm",
            "?uparm|?upperarm|?uarm|?arm|?humerus|?sjc|?shldr|?shoulder",
        ),
        (
            "?_forearm",
            "?forearm|?lowerarm|?lowarm|?farm|?elbow|?ejc|?radius",
        ),
        ("?_hand", "?wrist|?wjc|?hand"),
        ("?_shoulder", "?collar|?clavicle|?shoulder"),
        (
            "hips",
            "hips|pelvis|midhip|hipcenter|hipcentre|spinebase|hip|root|@left_thigh+@right_thigh",
        ),
        (
            "neck",
            "neck|neck1|neckbase|shouldercenter|shouldercentre|spineshoulder|@left_arm+@right_arm",
        ),
        (
            "torso",
            "torso|spine|spine1|spinemid|midspine|ab|abdomen|lowerback|chest|spine2|thorax",
        ),
        ("head", "head|headtop|lear+rear|nose|skull"),
    ],
    joints_too: false,
};

const fn landmarks(
    name: &'static str,
    points: &'static str,
    roles: &'static [(&'static str, &'static str)],
) -> PointSet {
    PointSet {
        name,
        points,
        numbered: true,
        roles,
        joints_too: true,
    }
}

/// Each with the order of its points.
pub(super) const SETS: [PointSet; 9] = [
    // BlazePose; developers.google.com/mediapipe, "Pose landmark detection".
    landmarks(
        "MediaPipe pose (33)",
        "nose leyeinner leye leyeouter reyeinner reye reyeouter lear rear lmouth rmouth lshoulder rshoulder \
         lelbow relbow lwrist rwrist lpinky rpinky lindex rindex lthumb rthumb lhip rhip lknee rknee lankle \
         rankle lheel rheel lfootindex rfootindex",
        &[("head", "lear+rear")],
    ),
    // OpenPose, output format of its pose models.
    landmarks(
        "OpenPose BODY_25",
        "nose neck rshoulder relbow rwrist lshoulder lelbow lwrist midhip rhip rknee rankle lhip lknee lankle \
         reye leye rear lear lbigtoe lsmalltoe lheel rbigtoe rsmalltoe rheel",
        &[("head", "lear+rear|nose")],
    ),
    landmarks(
        "OpenPose COCO (18)",
        "nose neck rshoulder relbow rwrist lshoulder lelbow lwrist rhip rknee rankle lhip lknee lankle reye leye \
         rear lear",
        &[("head", "lear+rear|nose")],
    ),
    // Kinect for Windows SDK 1.8, JointType.
    landmarks(
        "Kinect v1 (20)",
        "hipcenter spine shouldercenter head lshoulder lelbow lwrist lhand rshoulder relbow rwrist rhand lhip \
         lknee lankle lfoot rhip rknee rankle rfoot",
        &[],
    ),
    // Kinect for Windows SDK 2.0, JointType.
    landmarks(
        "Kinect v2 (25)",
        "spinebase spinemid neck head lshoulder lelbow lwrist lhand rshoulder relbow rwrist rhand lhip lknee \
         lankle lfoot rhip rknee rankle rfoot spineshoulder lhandtip lthumb rhandtip rthumb",
        &[("neck", "spineshoulder|neck")],
    ),
    // cocodataset.org, keypoints of a person.
    landmarks(
        "COCO (17)",
        "nose leye reye lear rear lshoulder rshoulder lelbow relbow lwrist rwrist lhip rhip lknee rknee lankle \
         rankle",
        &[("head", "lear+rear|nose")],
    ),
    // The 17 joints that work on Human3.6M (Ionescu et al. 2014) evaluates.
    landmarks(
        "Human3.6M (17)",
        "hip rhip rknee rfoot lhip lknee lfoot spine thorax neck head lshoulder lelbow lwrist rshoulder relbow \
         rwrist",
        &[
            ("neck", "thorax|neck"),
            ("?_foot", "?ankle|?foot"),
            ("torso", "spine"),
        ],
    ),
    // SMPL (Loper et al. 2015): 24 joints; AMASS and its kin leave out the hands.
    landmarks(
        "SMPL (24)",
        "pelvis lhip rhip spine1 lknee rknee spine2 lankle rankle spine3 lfoot rfoot neck lcollar rcollar head \
         lshoulder rshoulder lelbow relbow lwrist rwrist lhand rhand",
        &[],
    ),
    landmarks(
        "SMPL (22)",
        "pelvis lhip rhip spine1 lknee rknee spine2 lankle rankle spine3 lfoot rfoot neck lcollar rcollar head \
         lshoulder rshoulder lelbow relbow lwrist rwrist",
        &[],
    ),
];
