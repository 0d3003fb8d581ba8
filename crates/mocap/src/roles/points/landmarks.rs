//! Landmarks of pose estimators and depth cameras, and joints by their usual names.

use super::set::PointSet;

/// Roles among joints by their usual names: of landmark models, of skeletons of every animation program, and morec's
/// own. Upper arms come before collars, because a shoulder is the one or the other.
pub(super) const JOINTS: PointSet = PointSet {
    name: "joint names",
    points: "",
    numbered: false,
    by_name: true,
    roles: &[
        (
            "?_thigh",
            "?upleg|?thigh|?upperleg|?femur|?hjc|?hip|?hipjoint",
        ),
        (
            "?_shin",
            "?knee|?shin|?lowleg|?lowerleg|?calf|?tibia|?shank|?kjc|?leg",
        ),
        ("?_foot", "?ankle|?ajc|?talus|?foot"),
        (
            "?_arm",
            "?uparm|?upperarm|?uarm|?arm|?humerus|?sjc|?shldr|?shoulder",
        ),
        (
            "?_forearm",
            "?forearm|?lowerarm|?lowarm|?farm|?larm|?elbow|?ejc|?radius",
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
    more_roles: &[],
};

pub(super) const fn landmarks(
    name: &'static str,
    points: &'static str,
    roles: &'static [(&'static str, &'static str)],
) -> PointSet {
    PointSet {
        name,
        points,
        numbered: true,
        by_name: true,
        roles,
        more_roles: JOINTS.roles,
    }
}

const AZURE_KINECT: &[(&str, &str)] = &[
    ("?_shoulder", "?clavicle"),
    ("torso", "spinenavel|spinechest"),
    ("head", "head"),
];

/// Each with the order of its points.
pub(super) const SETS: [PointSet; 20] = [
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
    // Body Tracking SDK of Azure Kinect, k4abt_joint_id_t.
    landmarks(
        "Azure Kinect (32)",
        "pelvis spinenavel spinechest neck lclavicle lshoulder lelbow lwrist lhand lhandtip lthumb rclavicle \
         rshoulder relbow rwrist rhand rhandtip rthumb lhip lknee lankle lfoot rhip rknee rankle rfoot head nose \
         leye lear reye rear",
        AZURE_KINECT,
    ),
    // Body tracking of Stereolabs' ZED SDK, BODY_34 and BODY_38.
    PointSet {
        by_name: false,
        ..landmarks(
            "ZED (34)",
            "pelvis spinenavel spinechest neck lclavicle lshoulder lelbow lwrist lhand lhandtip lthumb rclavicle \
             rshoulder relbow rwrist rhand rhandtip rthumb lhip lknee lankle lfoot rhip rknee rankle rfoot head nose \
             leye lear reye rear lheel rheel",
            AZURE_KINECT,
        )
    },
    PointSet {
        by_name: false,
        ..landmarks(
            "ZED (38)",
            "pelvis spine1 spine2 spine3 neck nose leye reye lear rear lclavicle rclavicle lshoulder rshoulder lelbow \
             relbow lwrist rwrist lhip rhip lknee rknee lankle rankle lbigtoe rbigtoe lsmalltoe rsmalltoe lheel rheel \
             lthumb rthumb lindex rindex lmiddle rmiddle lpinky rpinky",
            &[
                ("?_shoulder", "?clavicle"),
                ("torso", "spine1|spine2"),
                ("head", "lear+rear|nose"),
            ],
        )
    },
    // MSR-Action3D (Li, Zhang and Liu 2010), in the order of the files of its joints.
    PointSet {
        by_name: false,
        ..landmarks(
            "MSR-Action3D (20)",
            "rshoulder lshoulder neck spine rhip lhip pelvis relbow lelbow rwrist lwrist rhand lhand rknee lknee rankle \
             lankle rfoot lfoot head",
            &[],
        )
    },
    // OpenNI and NiTE, XnSkeletonJoint, as its recorders write them.
    PointSet {
        by_name: false,
        ..landmarks(
            "OpenNI (15)",
            "head neck torso lshoulder lelbow lhand rshoulder relbow rhand lhip lknee lfoot rhip rknee rfoot",
            &[("?_hand", "?hand"), ("?_foot", "?foot")],
        )
    },
    // MPII Human Pose (Andriluka et al. 2014).
    landmarks(
        "MPII (16)",
        "rankle rknee rhip lhip lknee lankle pelvis thorax upperneck headtop rwrist relbow rshoulder lshoulder lelbow \
         lwrist",
        &[("neck", "thorax|upperneck"), ("head", "headtop")],
    ),
    // CMU Panoptic Studio (Joo et al. 2015), joints19.
    landmarks(
        "Panoptic (19)",
        "neck nose bodycenter lshoulder lelbow lwrist lhip lknee lankle rshoulder relbow rwrist rhip rknee rankle leye \
         lear reye rear",
        &[("hips", "bodycenter|lhip+rhip"), ("head", "lear+rear|nose")],
    ),
    // Halpe (Fang et al. 2022), 26 keypoints of the body, as AlphaPose and Pose2Sim have them.
    landmarks(
        "Halpe (26)",
        "nose leye reye lear rear lshoulder rshoulder lelbow relbow lwrist rwrist lhip rhip lknee rknee lankle rankle head \
         neck hip lbigtoe rbigtoe lsmalltoe rsmalltoe lheel rheel",
        &[("hips", "hip|lhip+rhip"), ("head", "lear+rear|head|nose")],
    ),
    // The 32 joints of Human3.6M (Ionescu et al. 2014), some in one place.
    landmarks(
        "Human3.6M (32)",
        "hip rhip rknee rankle rfoot rtoe lhip lknee lankle lfoot ltoe spineroot spine neck nose head neck2 \
         lshoulder lelbow lwrist lthumb lhand lhandtip lsite neck3 rshoulder relbow rwrist rthumb rhand rhandtip rsite",
        &[("hips", "hip"), ("torso", "spine"), ("neck", "neck")],
    ),
    // SMPL-H (Romero et al. 2017): SMPL's 22 joints and 15 for each hand.
    landmarks(
        "SMPL-H (52)",
        "pelvis lhip rhip spine1 lknee rknee spine2 lankle rankle spine3 lfoot rfoot neck lcollar rcollar head \
         lshoulder rshoulder lelbow relbow lwrist rwrist lindex1 lindex2 lindex3 lmiddle1 lmiddle2 lmiddle3 lpinky1 lpinky2 \
         lpinky3 lring1 lring2 lring3 lthumb1 lthumb2 lthumb3 rindex1 rindex2 rindex3 rmiddle1 rmiddle2 rmiddle3 rpinky1 \
         rpinky2 rpinky3 rring1 rring2 rring3 rthumb1 rthumb2 rthumb3",
        &[],
    ),
    // SMPL-X (Pavlakos et al. 2019): the same with jaw and eyes before the hands.
    landmarks(
        "SMPL-X (55)",
        "pelvis lhip rhip spine1 lknee rknee spine2 lankle rankle spine3 lfoot rfoot neck lcollar rcollar head \
         lshoulder rshoulder lelbow relbow lwrist rwrist jaw leyesmplhf reyesmplhf lindex1 lindex2 lindex3 lmiddle1 lmiddle2 \
         lmiddle3 lpinky1 lpinky2 lpinky3 lring1 lring2 lring3 lthumb1 lthumb2 lthumb3 rindex1 rindex2 rindex3 rmiddle1 \
         rmiddle2 rmiddle3 rpinky1 rpinky2 rpinky3 rring1 rring2 rring3 rthumb1 rthumb2 rthumb3",
        &[],
    ),
];
