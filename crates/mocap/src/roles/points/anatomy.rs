//! Markers of no published set, by what laboratories call the bones below them: `L_ASIS`, `RLFE`, `AnkleMedial_R`.
//!
//! Protocols share few labels but many abbreviations. Each is put into one spelling here; joints then lie between the
//! markers on both sides of them, as in the published sets. Sources: the marker guides of Plug-in Gait, Helen Hayes, CAST (Cappozzo et
//! al. 1995), van Sint Jan (2007), Visual3D and Qualisys.

use super::place::PointJoint;
use super::set::{LEAST_ROLES, PointSet, Recognised};
use crate::roles::Role;

/// Abbreviation of each bony landmark, and its spellings, without the side.
const SPELLINGS: [(&str, &str); 18] = [
    (
        "asi",
        "asias sias siasi crestfront asipelvis ant pelvisfront asi asis ias fwt waistfront waistf frontwaist \
         iliacfront",
    ),
    (
        "psi",
        "psias sips pelvisback post psi psis ips bwt waistback waistb backwaist waist",
    ),
    (
        "tro",
        "gtro troc troch grtr gtroc hipcenter hipcentre hipjc tro gtr gt ftc trochanter greatertrochanter hip \
         hjc thi1",
    ),
    (
        "knel",
        "lek knee1 lfemc lfep lcondyle lfemcond klateral femlat kneeext lepik ep lfemepi kn kne knel lk lfe fle \
         lfc le lkne knee kneelat kneelateral latknee lateralknee kneeout kneeo kneeouter klat lepi \
         latcondyle lknee lepicondyle outerknee",
    ),
    (
        "knem",
        "knee2 mfemc mfep mcondyle mfemcond kmedial femmed kneeint mepik mfemepi knem mk mfe fme mfc me mkne \
         knm kneemed kneemedial medknee medialknee kneein kneei kneeinner kmed mepi medcondyle mknee \
         mepicondyle innerknee",
    ),
    (
        "ankl",
        "mall lmalleolus lateralmalleolus mlat ankleext anlat latmall ank ankl la lm fal lmal lank ankle \
         anklelat anklelateral latankle lateralankle ankleout ankleo ankleouter lmall latmal latmalleolus \
         malleoluslat lankle alat outerankle",
    ),
    (
        "ankm",
        "mmalleolus medialmalleolus mmed ankleint anmed medmall ankm ma mm tam mmal mank anm anklemed \
         anklemedial medankle medialankle anklein anklei ankleinner mmall medmal medmalleolus malleolusmed \
         mankle amed innerankle",
    ),
    (
        "acr",
        "should shou acrom shld gleno lac clo1 shol acr acro ac acj sae sho shoulder acromion acromium \
         shouldertop sh topshoulder fsh",
    ),
    (
        "elbl",
        "lee elbow1 el lep lhep lehum elboext lelbepi lhumepi epl humlat lhc ell elb elbl lel hle lhe elbow \
         elbowlat elbowlateral latelbow elbowout lelb lelbow outerelbow elat",
    ),
    (
        "elbm",
        "mee elbow2 em mep mhep mehum elboint melbepi mhumepi epm hummed mhc elbm mel hme mhe elm elbowmed \
         elbowmedial medelbow elbowin melb melbow innerelbow emed iel",
    ),
    (
        "wrir",
        "lw faradius rs rstyl radial wristradius wrirad wrl rst wra wrir rad rsp radius wrist wri wristrad \
         wristin wristradial radstyl radialstyloid wristlat iwr wr lwrist wristthumb",
    ),
    (
        "wriu",
        "mw faulna us ustyl ulnar wristulna wriuln wrm ust wrb wriu uln usp ulna wristuln wristout wristulnar \
         ulnstyl ulnarstyloid wristmed owr mwrist wristpinky",
    ),
    (
        "head",
        "head fhead thead fhd headfront frhead temple headf hd ear",
    ),
    (
        "sacr",
        "sacr sacrum vsacral vsac vsacr sacro sacral s1 s2 mpsis waistback",
    ),
    ("c7", "c7 cv7 vc7 c7t1 spinetop backtop"),
    ("clav", "clav sjn ij suprasternale jn manubrium sternumtop"),
    ("strn", "strn sxs px sternum xiphoid xyphoid chest xyph"),
    ("t10", "t10 tv7 t8 tv10 t12 tv2 midback"),
];

/// Joints from these landmarks, the best measured first: between both sides of a joint, else at the side that has a marker; the
/// hip's centre from the pelvis by regression, else the trochanter.
const ANATOMY: PointSet = PointSet {
    name: "anatomical markers",
    points: "",
    numbered: false,
    by_name: true,
    roles: &[
        (
            "?_thigh",
            "hip(?;lasi;rasi;lpsi+rpsi)|hip(?;lasi;rasi;sacr)|?tro",
        ),
        ("?_shin", "?knel+?knem|?knel|?knem"),
        ("?_foot", "?ankl+?ankm|?ankl|?ankm"),
        ("?_arm", "?acr"),
        ("?_forearm", "?elbl+?elbm|?elbl|?elbm"),
        ("?_hand", "?wrir+?wriu|?wrir|?wriu"),
        (
            "hips",
            "lasi+rasi+lpsi+rpsi|lasi+rasi+sacr|lasi+rasi|@left_thigh+@right_thigh",
        ),
        ("neck", "c7+clav|c7|clav|@left_arm+@right_arm"),
        ("torso", "t10+strn|t10|strn"),
        ("head", "lhead+rhead|head|headtop|tophead"),
    ],
    more_roles: &[],
};

/// The roles of points of these normalised names, if both legs are there, or both arms.
pub(super) fn assign(names: &[String]) -> Option<Recognised> {
    let found = ANATOMY.assign(&spellings(names))?;
    let has = |role| found.roles.iter().any(|(known, _)| *known == role);
    let arms = [
        [Role::LeftArm, Role::LeftForearm, Role::LeftHand],
        [Role::RightArm, Role::RightForearm, Role::RightHand],
    ];
    let has_arms = arms.into_iter().flatten().all(has);
    // Two roles more than a published set needs: short labels such as `LA` mean other things on other things than people.
    let is_body = found.has_hips() || has_arms;
    (is_body && found.roles.len() >= LEAST_ROLES + 2).then_some(found)
}

/// `found` with the limbs that only these spellings know: what is stuck beside a published set, or called otherwise in it.
pub(super) fn complete(mut found: Recognised, names: &[String]) -> Recognised {
    let Some(more) = ANATOMY.assign(&spellings(names)) else {
        return found;
    };
    for (role, place) in more.roles {
        let known = |(known, at): &(Role, PointJoint)| *known == role || *at == place;
        if role != Role::Torso && !found.roles.iter().any(known) {
            found.roles.push((role, place));
        }
    }
    found.roles.sort_by_key(|(role, _)| role.index());
    found
}

fn spellings(names: &[String]) -> Vec<String> {
    let mut known: Vec<String> = Vec::with_capacity(names.len());
    for name in names {
        let spelt = spelt(name).filter(|spelt| !known.contains(spelt));
        // What is spelt in no known way keeps its own name, out of the way of those that are.
        known.push(spelt.unwrap_or_else(|| format!("?{name}")));
    }
    known
}

/// The one spelling of a marker's name, its side in front.
fn spelt(name: &str) -> Option<String> {
    const MIDDLE: [&str; 5] = ["sacr", "c7", "clav", "strn", "t10"];
    let find = |bare: &str| {
        let mut spellings = SPELLINGS.iter();
        spellings
            .find(|(_, spelt)| spelt.split(' ').any(|spelt| spelt == bare))
            .map(|(place, _)| *place)
    };
    if let Some(place) = find(name).filter(|place| MIDDLE.contains(place) || *place == "head") {
        return Some(place.to_owned());
    }
    // Normalised names have their side in front. Of the middle is only what has no side.
    let side = name.get(..1).filter(|side| ["l", "r"].contains(side))?;
    let place = find(&name[1..]).filter(|place| !MIDDLE.contains(place))?;
    Some(format!("{side}{place}"))
}

#[cfg(test)]
mod tests {
    use super::super::recognise;
    use crate::roles::Role;

    fn sided(labels: &[&str], side: &dyn Fn(char, &str) -> String) -> Vec<String> {
        let both = |label: &&str| ['L', 'R'].map(|s| side(s, label));
        labels.iter().flat_map(both).collect()
    }

    #[test]
    fn labels_of_laboratories_make_legs_and_arms() {
        let before = |s: char, label: &str| format!("{s}_{label}");
        let joined = |s: char, label: &str| format!("{s}{label}");
        let behind = |s: char, label: &str| format!("{label}_{s}");
        let cast = sided(
            &[
                "ASIS", "PSIS", "TH1", "LFE", "MFE", "SK1", "LM", "MM", "HEEL", "MT1",
            ],
            &before,
        );
        let visual = sided(
            &[
                "ILC", "ASIS", "PSIS", "GTR", "LK", "MK", "LA", "MA", "HL", "ACR", "LEL", "MEL",
                "RAD", "ULN",
            ],
            &joined,
        );
        let spelt = sided(
            &[
                "ASIS", "PSIS", "KneeLat", "KneeMed", "AnkleLat", "AnkleMed", "Acromion",
                "ElbowLat", "WristRad",
            ],
            &behind,
        );
        for (labels, roles) in [(cast, 7), (visual, 14), (spelt, 14)] {
            let names: Vec<&str> = labels.iter().map(String::as_str).collect();
            let found = recognise(&names).unwrap_or_else(|| panic!("{names:?}"));
            assert_eq!(found.roles.len(), roles, "{names:?}");
            let place = |role| {
                &found
                    .roles
                    .iter()
                    .find(|(known, _)| *known == role)
                    .unwrap()
                    .1
            };
            for (role, side) in [(Role::LeftShin, 'L'), (Role::RightShin, 'R')] {
                let of = place(role).points();
                assert_eq!(of.len(), 2, "{names:?}");
                assert!(of.iter().all(|&p| names[p].contains(side)), "{names:?}");
            }
        }
    }

    #[test]
    fn bones_of_nothing_known_make_no_body() {
        let names = ["B1", "B2", "LX", "RX", "LW", "RW", "marker7", "TOP"];
        assert_eq!(recognise(&names), None);
    }
}
