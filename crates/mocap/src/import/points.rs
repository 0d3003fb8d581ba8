//! Roles of points, and joints computed between points.

use crate::clip::{Clip, Gap, Span};
use crate::formats::ParseError;
use crate::kinematics::WorldPose;
use crate::math::Vec3;
use crate::roles::mapping::Mapping;
use crate::roles::points::{
    PointJoint, recognise_hands, recognise_numbered_hand, recognise_posed, recognise_tracked,
};
use crate::roles::{Role, RoleMap};

/// Frames that settle what names leave open.
const LOOKED_AT: usize = 8;
/// Frames that tell a left hand from a right one: in one of them it may be flat.
const HANDS_LOOKED_AT: usize = 64;

/// The doubt about a clip of points that belong to no known set.
pub(super) const UNKNOWN: &str = "the points match no known set, so no body is found: assign roles with --roles FILE, as in \
    `left_knee<TAB>LKNE+LKNM` for the middle of two points (`morec inspect CLIP --roles-template` writes such a file), or leave \
    the clip out if it shows no person";

/// The roles of a clip of points by tables of known sets, and the set's name.
pub(super) fn find_roles(clip: &mut Clip) -> (RoleMap, Option<&'static str>) {
    let names: Vec<&str> = clip.skeleton.names().collect();
    let poses = |count: usize| -> Vec<Vec<Vec3>> {
        let step = clip.frames.div_ceil(count).max(1);
        let frames = (0..clip.frames).step_by(step);
        let places = |frame| WorldPose::of(clip, frame).positions;
        frames.map(places).collect()
    };
    let played = |(set, roles): (&'static str, Vec<(Role, usize)>)| {
        let mut map = RoleMap::default();
        for (role, point) in roles {
            map.set(role, Some(point));
        }
        (map, Some(set))
    };
    // As many numbered points may be a body; a hand is sooner known.
    if let Some(hand) = recognise_numbered_hand(&names, &poses(HANDS_LOOKED_AT)) {
        return played(hand);
    }
    let Some(found) = recognise_posed(&names, &poses(LOOKED_AT)) else {
        let found = recognise_hands(&names, &poses(HANDS_LOOKED_AT));
        let found = found.or_else(|| recognise_tracked(&names));
        return found.map_or_else(|| (RoleMap::default(), None), played);
    };
    let places = found
        .roles
        .into_iter()
        .map(|(role, place)| (role, Some(place)));
    let map = play(clip, RoleMap::default(), places.collect());
    (map, Some(found.set))
}

/// Overrides roles as a mapping file says. Where it says what the points of a custom skeleton are, nothing else plays a role: joints
/// of a dog may have names of a person's.
///
/// # Errors
/// A joint that the clip does not have, with its line in the mapping file.
pub(super) fn apply(
    mapping: &Mapping,
    clip: &mut Clip,
    map: RoleMap,
) -> Result<RoleMap, ParseError> {
    let names: Vec<&str> = clip.skeleton.names().collect();
    let places = mapping.places(&names)?;
    let is_custom = places
        .iter()
        .any(|(role, place)| role.is_custom() && place.is_some());
    let map = if is_custom { RoleMap::default() } else { map };
    let states_hips = places.iter().any(|(role, _)| *role == Role::Hips);
    let mut map = play(clip, map, places);
    // A root that is stated to be the neck or the head is not the hips that it was taken for.
    let hips = map.joint(Role::Hips);
    let is_hips = |role| hips.is_some() && map.joint(role) == hips;
    if !states_hips && (is_hips(Role::Neck) || is_hips(Role::Head)) {
        map.set(Role::Hips, None);
    }
    Ok(map)
}

/// Gives each role to the joint in its place; `clip` gets new joints for places between joints.
fn play(clip: &mut Clip, mut map: RoleMap, places: Vec<(Role, Option<PointJoint>)>) -> RoleMap {
    let mut between: Vec<(Role, PointJoint)> = Vec::new();
    for (role, place) in places {
        map.set(role, place.as_ref().and_then(PointJoint::single));
        between.extend(
            place
                .filter(|p| p.single().is_none())
                .map(|place| (role, place)),
        );
    }
    let mut tracks: Vec<Vec<Vec3>> = vec![Vec::with_capacity(clip.frames); between.len()];
    let mut pose = WorldPose::default();
    for frame in 0..clip.frames {
        pose.set(clip, frame);
        for ((_, place), track) in between.iter().zip(&mut tracks) {
            let at = place.at(|joint| pose.positions[joint]);
            // A pelvis without a direction for a moment leaves the joint where it was.
            track.push(at.or(track.last().copied()).unwrap_or_else(Vec3::zeros));
        }
    }
    let mut roots = Vec::with_capacity(between.len());
    for ((role, place), track) in between.iter().zip(tracks) {
        let joint = clip.skeleton.len() + roots.len();
        map.set(*role, Some(joint));
        add_gaps(clip, joint, place);
        roots.push((free_name(clip, role.name()), track));
    }
    clip.add_roots(roots);
    map
}

/// A place is unknown wherever one of its points is.
fn add_gaps(clip: &mut Clip, joint: usize, place: &PointJoint) {
    let Some(points) = &mut clip.points else {
        return;
    };
    let of = place.points();
    let gaps = points.gaps.iter().filter(|gap| of.contains(&gap.joint));
    let mut spans: Vec<Span> = gaps.map(|gap| gap.frames.clone()).collect();
    spans.sort_by_key(|span| span.start);
    for frames in spans {
        match points.gaps.last_mut() {
            Some(last) if last.joint == joint && last.frames.end >= frames.start => {
                last.frames.end = last.frames.end.max(frames.end);
            }
            _ => points.gaps.push(Gap { joint, frames }),
        }
    }
}

/// A name that no joint has.
fn free_name(clip: &Clip, name: &str) -> String {
    let mut free = name.to_owned();
    while clip.skeleton.find(&free).is_some() {
        free.push('*');
    }
    free
}
