use super::*;

fn roles(names: &[&str]) -> (String, Vec<Role>) {
    let found = recognise(names).unwrap();
    (
        found.set.to_owned(),
        found.roles.iter().map(|(role, _)| *role).collect(),
    )
}

fn sets() -> impl Iterator<Item = &'static PointSet> {
    landmarks::SETS.iter().chain(&markers::SETS)
}

#[test]
fn every_set_knows_itself_by_name_and_gives_a_body() {
    for set in sets() {
        let names: Vec<String> = set.names().collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let (found, roles) = roles(&names);
        // What has everybody's names may be taken for any set that has them.
        if set.by_name {
            assert_eq!(found, set.name);
        }
        use Role::*;
        const LEGS_ALONE: [&str; 6] = [
            "Plug-in Gait, lower body",
            "Helen Hayes (Vicon labels)",
            "Fukuchi (BMClab)",
            "Conventional Gait Model 2",
            "CAST",
            "Visual3D",
        ];
        const HEADLESS: [&str; 3] = ["Rajagopal 2015", "OpenCap", "Vicon upper limb"];
        let has_legs = set.name != "Vicon upper limb";
        for role in [Hips, LeftThigh, RightThigh, LeftFoot, RightFoot] {
            assert_eq!(roles.contains(&role), has_legs, "{found}: {role}");
        }
        if set.name == "BTS Davis" {
            // Of the upper body it has shoulders and neck.
            continue;
        }
        let has_arms = !LEGS_ALONE.contains(&set.name);
        for role in [
            Neck,
            LeftArm,
            LeftForearm,
            LeftHand,
            RightArm,
            RightForearm,
            RightHand,
        ] {
            assert_eq!(roles.contains(&role), has_arms, "{found}: {role}");
        }
        let has_head = has_arms && !HEADLESS.contains(&set.name);
        assert_eq!(roles.contains(&Head), has_head, "{found}");
    }
}

#[test]
fn spellings_and_subjects_do_not_matter() {
    let (set, known) = roles(&crate::formats::ntu::JOINTS);
    assert_eq!((set.as_str(), known.len()), ("Kinect v2 (25)", 16));
    let gait: Vec<String> = "LFHD RFHD LBHD RBHD C7 T10 CLAV STRN RBAK LSHO LUPA LELB LFRA LWRA LWRB LFIN RSHO RUPA RELB \
        RFRA RWRA RWRB RFIN LASI RASI LPSI RPSI LTHI LKNE LTIB LANK LHEE LTOE RTHI RKNE RTIB RANK RHEE RTOE"
        .split(' ')
        .map(|name| format!("Reed:{name}"))
        .collect();
    let gait: Vec<&str> = gait.iter().map(String::as_str).collect();
    assert_eq!(roles(&gait).0, "Plug-in Gait");
}

#[test]
fn joints_of_any_skeleton_by_name() {
    let names = [
        "Hips",
        "Spine",
        "Neck",
        "Head",
        "LeftShoulder",
        "LeftArm",
        "LeftForeArm",
        "LeftHand",
        "RightShoulder",
        "RightArm",
        "RightForeArm",
        "RightHand",
        "LeftUpLeg",
        "LeftLeg",
        "LeftFoot",
        "RightUpLeg",
        "RightLeg",
        "RightFoot",
    ];
    let found = recognise(&names).unwrap();
    assert_eq!(found.roles.len(), Role::BODY_COUNT);
    let joint = |role: Role| {
        let (_, place) = found.roles.iter().find(|(r, _)| *r == role).unwrap();
        names[place.single().unwrap()]
    };
    assert_eq!(joint(Role::LeftShoulder), "LeftShoulder");
    assert_eq!(joint(Role::LeftArm), "LeftArm");
    assert_eq!(joint(Role::LeftShin), "LeftLeg");
    let own: Vec<&str> = Role::ALL.iter().map(|role| role.name()).collect();
    let found = recognise(&own).unwrap();
    for (role, place) in found.roles {
        assert_eq!(own[place.single().unwrap()], role.name());
    }
}

/// Suits and motion-capture programs have words of their own for a skeleton; half of them are those of some landmark set.
#[test]
fn skeletons_of_suits_are_no_landmarks() {
    let rokoko = "Hip Spine Thorax Neck Head LeftScapula LeftShoulder LeftElbow LeftHand RightScapula RightShoulder \
        RightElbow RightHand LeftThigh LeftShin LeftFoot LeftToe RightThigh RightShin RightFoot RightToe";
    let qualisys = "Hips Spine Spine1 Spine2 Neck Head LeftShoulder LeftArm LeftForeArm LeftForeArmRoll LeftHand RightShoulder \
        RightArm RightForeArm RightForeArmRoll RightHand LeftUpLeg LeftLeg LeftFoot LeftToeBase RightUpLeg RightLeg \
        RightFoot RightToeBase";
    for names in [rokoko, qualisys] {
        let names: Vec<&str> = names.split_whitespace().collect();
        let found = recognise(&names).unwrap();
        assert_eq!(found.set, "joint names", "{names:?}");
        let joint = |role: Role| {
            let (_, place) = found.roles.iter().find(|(r, _)| *r == role).unwrap();
            names[place.single().unwrap()]
        };
        assert!(["LeftThigh", "LeftUpLeg"].contains(&joint(Role::LeftThigh)));
        assert!(["LeftShin", "LeftLeg"].contains(&joint(Role::LeftShin)));
        assert_eq!(joint(Role::LeftFoot), "LeftFoot");
        assert!(["LeftElbow", "LeftForeArm"].contains(&joint(Role::LeftForearm)));
        assert_eq!(joint(Role::RightHand), "RightHand");
    }
}

#[test]
fn numbers_are_told_apart_by_the_lengths_of_limbs() {
    // A person's joints by COCO's names, left and right alike.
    let coco = &landmarks::SETS[5];
    let pose: Vec<Vec3> = coco
        .names()
        .map(|name| {
            let side = if name.starts_with('l') { 1.0 } else { -1.0 };
            let (x, y) = match name.trim_start_matches(['l', 'r']) {
                "shoulder" => (0.2, 1.4),
                "elbow" => (0.45, 1.4),
                "wrist" => (0.7, 1.4),
                "hip" => (0.1, 0.9),
                "knee" => (0.1, 0.5),
                "ankle" => (0.1, 0.1),
                _ => (0.05, 1.6),
            };
            Vec3::new(side * x, y, 0.0)
        })
        .collect();
    let numbers: Vec<String> = (0..17).map(|n| format!("kp_{n}")).collect();
    let numbers: Vec<&str> = numbers.iter().map(String::as_str).collect();
    let found = recognise_posed(&numbers, &[pose]).unwrap();
    assert_eq!(found.set, "COCO (17)");
}

#[test]
fn chance_makes_no_body() {
    assert_eq!(recognise(&["A", "B", "C", "Head", "Hip"]), None);
    assert_eq!(recognise(&[]), None);
    let cluster: Vec<String> = (1..30).map(|n| format!("Foot_Marker{n}")).collect();
    let cluster: Vec<&str> = cluster.iter().map(String::as_str).collect();
    assert_eq!(recognise(&cluster), None);
}
