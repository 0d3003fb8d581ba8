//! Published marker sets, and joints between their markers.
//!
//! Where a joint has markers on both sides, it is their middle; where it has one, the marker stands for it: directions of
//! bones are then a few degrees off, always alike. Hip joints come from the pelvis ([`PointJoint`](super::PointJoint)).

use super::landmarks::landmarks;
use super::set::PointSet;

const fn markers(
    name: &'static str,
    points: &'static str,
    roles: &'static [(&'static str, &'static str)],
) -> PointSet {
    PointSet {
        numbered: false,
        more_roles: &[],
        ..landmarks(name, points, roles)
    }
}

/// Those without roles of their own have them by what their labels abbreviate ([`anatomy`](super::anatomy)).
pub(super) const SETS: [PointSet; 20] = [
    // Vicon, "Plug-in Gait Reference Guide": full body, with joint centres where the model's outputs are in the file
    // (FEP, FEO, TIO, HUP, HUO, RAO). Medial markers as labs add them.
    markers(
        "Plug-in Gait",
        "?fhd ?bhd c7 t10 clav strn rbak ?sho ?upa ?elb ?fra ?wra ?wrb ?fin ?asi ?psi ?thi ?kne ?tib ?ank ?hee ?toe",
        PLUG_IN_GAIT,
    ),
    // The same guide, lower body; after Kadaba et al. (1990) and Davis et al. (1991).
    markers(
        "Plug-in Gait, lower body",
        "?asi ?psi ?thi ?kne ?tib ?ank ?hee ?toe",
        PLUG_IN_GAIT,
    ),
    markers(
        "Helen Hayes (Vicon labels)",
        "?asi sacr ?thi ?kne ?tib ?ank ?hee ?toe",
        PLUG_IN_GAIT,
    ),
    // Kadaba, Ramakrishnan and Wootten (1990), labelled as Motion Analysis and OpenSim's gait models do.
    markers(
        "Helen Hayes",
        "tophead fronthead rearhead ?shoulder roffset ?elbow ?wrist ?asis vsacral ?thigh ?knee ?shank ?ankle ?heel \
         ?toe",
        HELEN_HAYES,
    ),
    // OpenSim's Gait2392 and the sets after it: clusters on thighs and shanks.
    markers(
        "OpenSim gait",
        "?asis vsacral ?thighupper ?thighfront ?thighrear ?shankupper ?shankfront ?shankrear ?heel ?midfootsup \
         ?midfootlat ?toetip sternum ?acromium ?bicep ?elbow ?wristmed ?wristlat ?toelat ?toemed ?temple tophead",
        HELEN_HAYES,
    ),
    // mocap.cs.cmu.edu, "Marker Placement Guide": 41 markers, the pelvis by four at the waist.
    markers(
        "CMU (41)",
        "?fhd ?bhd c7 t10 clav strn rbac ?sho ?upa ?elb ?frm ?wra ?wrb ?fin ?thm ?fwt ?bwt ?thi ?kne ?shn ?ank ?hee \
         ?toe ?mt5",
        CMU,
    ),
    // The later set of the same database, also of HDM05: elbows, wrists and knees on both sides.
    markers(
        "CMU (both sides)",
        "ariel ?fhd ?bhd c7 t10 clav strn ?fsh ?bsh ?upa ?elb ?iel ?frm ?iwr ?owr ?ihand ?ohand ?fwt ?mwt ?bwt ?thi \
         ?kne ?kni ?shn ?ank ?hee ?mt1 ?mt5 ?toe",
        CMU,
    ),
    // Leardini et al., "A new anatomically based protocol for gait analysis" (2007): the Rizzoli gait set, in
    // the abbreviations of van Sint Jan (2007) that Qualisys uses.
    markers(
        "Rizzoli (IOR)",
        "?ias ?ips ?ftc ?fle ?fme ?fax ?ttc ?fal ?tam ?fcc ?fm1 ?fm2 ?fm5 ?head sgl ?sae cv7 tv2 tv7 sjn sxs ?hle ?hme ?rsp \
         ?usp",
        RIZZOLI,
    ),
    // BTS, protocols "Davis" of SMART-Clinic, after Davis et al., "A gait analysis data collection and reduction technique" (1991).
    markers(
        "BTS Davis",
        "c7 ?should sacrum ?asis ?bar1 ?knee1 ?bar2 ?mall ?heel ?met",
        BTS,
    ),
    // OptiTrack, Motive documentation: Baseline marker sets of 37 to 41 markers.
    markers(
        "OptiTrack Baseline",
        "headtop headfront headside backtop backleft backright chest ?waistfront ?waistback \
         ?shouldertop ?shoulderback ?uarmhigh ?elbowout ?wristout ?wristin ?handout ?thigh ?kneeout ?shin ?ankleout \
         ?toeout ?toein ?toetip ?heel",
        OPTITRACK,
    ),
    // Rajagopal et al., "Full-body musculoskeletal model for muscle-driven simulation of human gait" (2016): OpenSim's model of 2015.
    markers(
        "Rajagopal 2015",
        "?acr c7 clav ?ash ?psh ?ua1 ?ua2 ?ua3 ?lel ?mel ?fasuperior ?faradius ?faulna ?asi ?psi ?th1 ?th2 ?th3 ?lfc ?mfc ?tb1 \
         ?tb2 ?tb3 ?lmal ?mmal ?cal ?toe ?mt5",
        &[],
    ),
    // Uhlrich et al., "OpenCap: Human movement dynamics from smartphone videos" (2023): the markers that it infers.
    markers(
        "OpenCap",
        "c7 ?shoulder ?asis ?psis ?knee ?mknee ?ankle ?mankle ?toe ?5meta ?calc ?lelbow ?melbow ?lwrist ?mwrist ?thigh1 ?thigh2 \
         ?thigh3 ?sh1 ?sh2 ?sh3 ?hjc",
        &[],
    ),
    // Fukuchi, Fukuchi and Duarte, "A public dataset of overground and treadmill walking kinematics and kinetics" (2018).
    markers(
        "Fukuchi (BMClab)",
        "?asis ?psis ?iliaccrest ?gtr ?knee ?kneemedial ?hf ?tt ?ankle ?anklemedial ?heel ?mt1 ?mt2 ?mt5",
        &[],
    ),
    // van den Bogert et al., "A real-time system for biomechanical analysis" (2013): Motek's treadmills.
    markers(
        "Human Body Model",
        "?head thead fhead c7 t10 sacr nave xyph strn bbac ?sho ?delt ?lee ?mee ?frm ?mw ?lw ?fin ?asis ?psis ?gtro ?lek ?ati ?lm \
         ?hee ?toe ?mt5",
        &[],
    ),
    // Qualisys Track Manager, its sets for animation and for sports.
    markers(
        "Qualisys animation",
        "?head headtop headfront ?shouldertop ?shoulderback ?arm ?elbowout ?wristout ?wristin ?handout ?handin chest spinetop ?back \
         ?waistfront ?waistback ?thigh ?kneeout ?shin ?ankleout ?heelback ?forefootout ?forefootin ?toetip",
        OPTITRACK,
    ),
    markers(
        "Qualisys sports",
        "?head headfront ?shouldertop ?arm ?elbowout ?elbowin ?wristout ?wristin ?handout chest spinethoracic2 spinethoracic12 \
         ?waistfront ?waist waistback ?thighfrontlow ?kneeout ?kneein ?shinfronthigh ?ankleout ?heelback ?forefoot2 ?forefoot5",
        OPTITRACK,
    ),
    // Leboeuf et al., "The conventional gait model, an open-source implementation" (2019), its versions 2.
    markers(
        "Conventional Gait Model 2",
        "?asi ?psi ?thi ?thap ?thad ?kne ?knm ?tib ?tiap ?tiad ?ank ?med ?hee ?toe ?fmh ?smh ?vmh",
        PLUG_IN_GAIT,
    ),
    // Vicon, "Upper Limb Model Guide".
    markers(
        "Vicon upper limb",
        "c7 t10 clav strn ?sho ?upa ?upb ?upc ?elb ?frm ?wra ?wrb ?fin",
        PLUG_IN_GAIT,
    ),
    // Cappozzo et al., "Position and orientation in space of bones during movement" (1995), with clusters.
    markers(
        "CAST",
        "?asis ?psis ?gt ?le ?me ?hf ?tt ?lm ?mm ?ca ?fm ?sm ?vm",
        &[],
    ),
    // C-Motion, "Marker Set Guidelines" of Visual3D.
    markers(
        "Visual3D",
        "?asis ?psis ?ilc ?gtr ?lk ?mk ?la ?ma ?hl ?mt1 ?mt5 ?th1 ?th2 ?th3 ?th4 ?sk1 ?sk2 ?sk3 ?sk4",
        &[],
    ),
];

type Roles = &'static [(&'static str, &'static str)];

const PLUG_IN_GAIT: Roles = &[
    (
        "?_thigh",
        "?fep|?hjc|hip(?;lasi;rasi;lpsi+rpsi)|hip(?;lasi;rasi;sacr)|hip(?;lasi;rasi;sacrum)",
    ),
    (
        "?_shin",
        "?feo|?kjc|?kne+?knm|?kne+?mkne|?kne+?knem|?kne+?kneemed|?kne",
    ),
    (
        "?_foot",
        "?tio|?ajc|?ank+?anm|?ank+?mank|?ank+?ankm|?ank+?mma|?ank+?med|?ank",
    ),
    ("?_arm", "?hup|?clo|?sjc|?sho"),
    (
        "?_forearm",
        "?huo|?ejc|?elb+?elm|?elb+?melb|?elb+?elbm|?elb",
    ),
    ("?_hand", "?rao|?wjc|?wra+?wrb|?wra|?wrb|?wri"),
    (
        "hips",
        "lasi+rasi+lpsi+rpsi|lasi+rasi+sacr|lasi+rasi+sacrum|lasi+rasi",
    ),
    ("neck", "c7+clav|c7|clav|lsho+rsho"),
    ("torso", "t10+strn|t10|strn"),
    ("head", "lfhd+rfhd+lbhd+rbhd|lfhd+rfhd|lbhd+rbhd|head"),
];

const HELEN_HAYES: Roles = &[
    (
        "?_thigh",
        "?hjc|hip(?;lasis;rasis;vsacral)|hip(?;lasis;rasis;sacral)|hip(?;lasis;rasis;sacrum)\
         |hip(?;lasis;rasis;lpsis+rpsis)",
    ),
    (
        "?_shin",
        "?kjc|?knee+?kneemedial|?knee+?kneemed|?knee+?mknee|?kneelat+?kneemed|?knee|?kneelat",
    ),
    (
        "?_foot",
        "?ajc|?ankle+?anklemedial|?ankle+?anklemed|?ankle+?mankle|?anklelat+?anklemed|?ankle|?anklelat\
         |?heel+?midfootsup",
    ),
    ("?_arm", "?sjc|?shoulder|?acromium|?acromion"),
    (
        "?_forearm",
        "?ejc|?lelbow+?melbow|?elbow+?elbowmedial|?elbow+?elbowmed|?elbowlat+?elbowmed|?elbow",
    ),
    ("?_hand", "?wjc|?lwrist+?mwrist|?wristmed+?wristlat|?wrist"),
    (
        "hips",
        "lasis+rasis+lpsis+rpsis|lasis+rasis+vsacral|lasis+rasis+sacral|lasis+rasis+sacrum|lasis+rasis",
    ),
    ("neck", "c7+clav|c7+sternum|c7|@left_arm+@right_arm"),
    ("torso", "sternum"),
    ("head", "ltemple+rtemple|fronthead+rearhead|tophead"),
];

const CMU: Roles = &[
    ("?_thigh", "hip(?;lfwt;rfwt;lbwt+rbwt)"),
    ("?_shin", "?kne+?kni|?kne"),
    ("?_foot", "?ank"),
    ("?_arm", "?fsh+?bsh|?sho"),
    ("?_forearm", "?elb+?iel|?elb"),
    ("?_hand", "?iwr+?owr|?wra+?wrb|?wra|?wrb"),
    ("hips", "lfwt+rfwt+lbwt+rbwt|lfwt+rfwt"),
    ("neck", "c7+clav|c7"),
    ("torso", "t10+strn|t10|strn"),
    ("head", "lfhd+rfhd+lbhd+rbhd|lfhd+rfhd"),
];

const RIZZOLI: Roles = &[
    (
        "?_thigh",
        "hip(?;lias;rias;lips+rips)|hip(?;lasis;rasis;lpsis+rpsis)|?ftc",
    ),
    ("?_shin", "?fle+?fme|?le+?me|?fle"),
    ("?_foot", "?fal+?tam|?lm+?mm|?fal"),
    ("?_arm", "?sae|?sho|?a"),
    ("?_forearm", "?hle+?hme|?hle|?elb"),
    ("?_hand", "?rsp+?usp|?rsp|?wri"),
    (
        "hips",
        "lias+rias+lips+rips|lasis+rasis+lpsis+rpsis|lias+rias",
    ),
    ("neck", "cv7+sjn|cv7|c7+ij|c7|@left_arm+@right_arm"),
    ("torso", "tv7+sxs|tv2|tv7|mai|sxs"),
    ("head", "lhead+rhead+sgl|lhead+rhead|sgl|head"),
];

const BTS: Roles = &[
    ("?_thigh", "hip(?;lasis;rasis;sacrum)|?troch|?gt"),
    ("?_shin", "?knee1+?knee2|?knee1|?knee"),
    ("?_foot", "?mall+?mallm|?mall"),
    ("?_arm", "?should"),
    ("?_forearm", "?elbow|?elb"),
    ("?_hand", "?wrist|?radius+?ulna|?wri"),
    ("hips", "lasis+rasis+sacrum|lasis+rasis"),
    ("neck", "c7|@left_arm+@right_arm"),
    ("head", "head|lhead+rhead"),
];

const OPTITRACK: Roles = &[
    (
        "?_thigh",
        "hip(?;lwaistfront;rwaistfront;lwaistback+rwaistback)|hip(?;lwaistfront;rwaistfront;waistback)\
         |hip(?;lwaistfront;rwaistfront;lwaist+rwaist)|hip(?;lwaistfront;rwaistfront;lback+rback)",
    ),
    ("?_shin", "?kneeout+?kneein|?kneeout"),
    ("?_foot", "?ankleout+?anklein|?ankleout"),
    ("?_arm", "?shouldertop+?shoulderback|?shouldertop"),
    ("?_forearm", "?elbowout+?elbowin|?elbowout"),
    ("?_hand", "?wristout+?wristin|?wristout"),
    (
        "hips",
        "lwaistfront+rwaistfront+lwaistback+rwaistback|lwaistfront+rwaistfront",
    ),
    (
        "neck",
        "backtop+chest|spinetop+chest|backtop|spinetop|@left_arm+@right_arm",
    ),
    ("torso", "backleft+backright|lback+rback|chest"),
    ("head", "headtop+headfront|headtop|lhead+rhead|headfront"),
];
