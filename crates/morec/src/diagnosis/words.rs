//! Findings in sentences that say what to do.

use std::fmt;

use crate::math::Axis;
use crate::roles::{LEGS, Role};

use super::finding::Finding;
use super::role_set::RoleSet;

fn percent(share: f64) -> String {
    if share < 0.1 {
        format!("{:.1} %", 100.0 * share)
    } else {
        format!("{:.0} %", 100.0 * share)
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use Finding::*;
        match *self {
            Nobody { share } => write!(
                f,
                "{} of the frames show no body: step into view of the tracker, and look whether it tracks",
                percent(share)
            ),
            TimeUnit { interval_secs } => time_unit(f, interval_secs),
            TimeStands { share } => write!(
                f,
                "{} of the frames are not later than the frame before and are left out: send the time of each frame in seconds, or no time at all",
                percent(share)
            ),
            NoHeading => f.write_str(
                "neither left_thigh and right_thigh (the hip joints) nor left_arm and right_arm are seen, so it is unknown which way the body faces and nothing can be recognised: send these joints, too",
            ),
            UpsideDown { mirrored } => {
                let send = if mirrored { "[x, -y, z]" } else { "[x, -y, -z]" };
                write!(f, "the head is below the feet, so Y points down: send {send}")
            }
            UpIsNotY { axis, negative, mirrored } => up_is_not_y(f, axis, negative, mirrored),
            Tilted { tilt_rad } => write!(
                f,
                "an upright performer appears tilted by {:.0}°: level the camera, or calibrate the tracker again; recognition suffers from some 8° on",
                tilt_rad.to_degrees()
            ),
            SidesExchanged => f.write_str(
                "knees and arms bend backwards, so left and right are exchanged or one axis points the wrong way: exchange the names of left and right, or send [-x, y, z] if the coordinates are left-handed",
            ),
            Frozen { secs } => write!(
                f,
                "nothing has moved for {secs:.1} s: the tracker has stopped or sends a fixed pose; start it or calibrate it again"
            ),
            JointsMissing { roles } => joints_missing(f, roles),
            JointsFlicker { roles } => write!(
                f,
                "seen only at times: {roles}; keep them in view of the tracker, and away from what hides them"
            ),
            UnknownUnit { leg } => write!(
                f,
                "a leg is {leg:.3} long, which is a person's in no common unit of length; recognition does not mind, figures in metres are guesses"
            ),
            Noisy { noise_m } => write!(
                f,
                "positions jitter by {:.1} cm: more light, less distance or the tracker's own smoothing help; from 1 cm on motions are reported later or missed",
                100.0 * noise_m
            ),
            Spikes { share } => write!(
                f,
                "in {} of the frames a joint is thrown far aside: look for reflections, for hidden parts, or for a second person in view",
                percent(share)
            ),
            SlowRate { rate_hz } => write!(
                f,
                "only {rate_hz:.1} frames come a second: what lasts no longer than a few frames is not seen, and frames half a second apart are no stream; lower the resolution of the camera, or close other programs"
            ),
            FramesLost { share } => write!(
                f,
                "{} of the frames are lost on the way: use a cable, another channel, or a lower rate",
                percent(share)
            ),
            FramesRepeated { share } => write!(
                f,
                "{} of the frames repeat the one before: the sender is faster than its tracker, or every packet comes twice, which does no harm",
                percent(share)
            ),
            UnevenArrival { jitter_secs } => write!(
                f,
                "frames come unevenly, by ±{:.0} ms: motions are reported as much later; use a cable, or close other programs",
                1000.0 * jitter_secs
            ),
            MovingFloor => f.write_str(
                "the feet move together and never stand, so the whole body glides: fix the tracker's floor or its base stations; motions on the spot are still recognised, walking may not be",
            ),
            HipsFixed => f.write_str(
                "the hips never move: gestures of the arms are recognised, motions of the whole body (walking, squats, jumps) may not be; if the performer is standing, send positions in the room, not relative to the hips",
            ),
            HandLost { per_minute } => write!(
                f,
                "a hand is lost {per_minute:.0} times a minute: keep it in view of the tracker, and away from its edges; a motion in which it is lost for half a second is not recognised",
            ),
            HandsSwap { per_minute } => write!(
                f,
                "left and right hand change places {per_minute:.0} times a minute: show the tracker the inner side of a hand or its back, not the edge, and keep hands apart; or send every hand with the side that it was first seen with",
            ),
        }
    }
}

fn time_unit(f: &mut fmt::Formatter<'_>, interval_secs: f64) -> fmt::Result {
    if interval_secs < 0.1 {
        return write!(
            f,
            "frames are only {:.3} ms apart by their times: times must be in seconds",
            1000.0 * interval_secs
        );
    }
    let unit = [
        (1e-3, "milliseconds"),
        (1e-6, "microseconds"),
        (1e-9, "nanoseconds"),
    ]
    .into_iter()
    .find(|(unit, _)| (0.002..0.2).contains(&(interval_secs * unit)));
    write!(f, "frames are {interval_secs:.1} s apart by their times")?;
    match unit {
        Some((unit, name)) => write!(
            f,
            ", which look like {name}: times must be in seconds, so multiply them by {unit:e}"
        ),
        None => f.write_str(
            ": times must be in seconds (are these numbers of frames?), and frames more than 0.5 s apart are no stream",
        ),
    }
}

fn joints_missing(f: &mut fmt::Formatter<'_>, roles: RoleSet) -> fmt::Result {
    const ADVICE: &str = "the index cannot use them: send them if the tracker has them";
    let is_lower = |role: Role| role == Role::Hips || LEGS.as_flattened().contains(&role);
    let mut lower = Role::BODY.into_iter().filter(|role| is_lower(*role));
    let heading = !roles.contains(Role::LeftArm) && !roles.contains(Role::RightArm);
    if !heading || !lower.all(|role| roles.contains(role)) {
        return write!(f, "never seen: {roles}; {ADVICE}");
    }
    f.write_str(
        "neither hips nor legs are seen: the shoulders tell which way the body faces, and motions of arms and head are \
         recognised",
    )?;
    let others: RoleSet = roles.iter().filter(|role| !is_lower(*role)).collect();
    match others.is_empty() {
        true => Ok(()),
        false => write!(f, "; never seen either: {others}; {ADVICE}"),
    }
}

fn up_is_not_y(
    f: &mut fmt::Formatter<'_>,
    axis: Axis,
    negative: bool,
    mirrored: bool,
) -> fmt::Result {
    let sign = if negative { "-" } else { "" };
    // Turned so that the axis becomes Y; a left-handed one has one sign the other way.
    let (name, send) = match (axis, negative != mirrored) {
        (Axis::Z, false) => ("Z", format!("[x, {sign}z, -y]")),
        (Axis::Z, true) => ("Z", format!("[x, {sign}z, y]")),
        (Axis::X, false) => ("X", format!("[-y, {sign}x, z]")),
        (_, _) => ("X", format!("[y, {sign}x, z]")),
    };
    write!(
        f,
        "the body lies along {sign}{name}, so {sign}{name} is up (unless the performer lies down): send {send}, Y must be up"
    )
}
