//! Sentences for findings: what is wrong, and what to do.

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
                "{} of the frames show no body: step into the tracker's view and check that it is tracking",
                percent(share)
            ),
            TimeUnit { interval_secs } => time_unit(f, interval_secs),
            TimeStands { share } => write!(
                f,
                "{} of the frames are left out because their time is not after the previous frame's: send the time of each frame \
                 in seconds, or leave times out",
                percent(share)
            ),
            NoHeading => f.write_str(
                "the stream has neither the hip joints (left_thigh and right_thigh) nor the shoulders (left_arm and right_arm), \
                 so the direction that the body faces is unknown and nothing can be recognised: send one of these pairs",
            ),
            UpsideDown { mirrored } => {
                let send = if mirrored { "[x, -y, z]" } else { "[x, -y, -z]" };
                write!(f, "the head is below the feet, so Y points down: send {send}")
            }
            UpIsNotY { axis, negative, mirrored } => up_is_not_y(f, axis, negative, mirrored),
            Tilted { tilt_rad } => write!(
                f,
                "an upright performer appears tilted by {:.0}°: level the camera or calibrate the tracker again; above about 8° \
                 fewer motions are recognised",
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
                "often missing: {roles}; keep them in the tracker's view and unobstructed"
            ),
            UnknownUnit { leg } => write!(
                f,
                "a leg is {leg:.3} long, which fits a person in no common unit of length; recognition is not affected, but \
                 lengths in metres are guesses"
            ),
            Noisy { noise_m } => write!(
                f,
                "positions jitter by {:.1} cm, and above 1 cm motions are reported later or missed: add light, move closer, or \
                 switch on the tracker's smoothing",
                100.0 * noise_m
            ),
            Spikes { share } => write!(
                f,
                "in {} of the frames a joint jumps far away: check for reflections, hidden body parts or a second person in view",
                percent(share)
            ),
            SlowRate { rate_hz } => write!(
                f,
                "only {rate_hz:.1} frames arrive each second: motions that last a few frames are missed, and frames 0.5 s apart \
                 cannot be recognised at all; lower the camera's resolution or close other programs"
            ),
            FramesLost { share } => write!(
                f,
                "{} of the frames are lost in transmission: use a cable, another radio channel, or a lower frame rate",
                percent(share)
            ),
            FramesRepeated { share } => write!(
                f,
                "{} of the frames repeat the previous one: the sender is faster than its tracker, or each packet is sent twice; \
                 this does no harm",
                percent(share)
            ),
            UnevenArrival { jitter_secs } => write!(
                f,
                "frames arrive irregularly, by ±{:.0} ms, which delays reports by as much: use a cable or close other programs",
                1000.0 * jitter_secs
            ),
            MovingFloor => f.write_str(
                "the feet move together and never stand still, so the whole body glides: set up the tracker's floor or its base \
                 stations again; motions on the spot are still recognised, walking may not be",
            ),
            HipsFixed => f.write_str(
                "the hips never move: gestures of the arms are recognised, but motions of the whole body (walking, squats, \
                 jumps) may not be; if the performer is standing, send positions in the room, not relative to the hips",
            ),
            HandLost { per_minute } => write!(
                f,
                "a hand is lost {per_minute:.0} times a minute: keep it in the tracker's view, away from the edges; a motion in \
                 which the hand is lost for 0.5 s is not recognised",
            ),
            HandsSwap { per_minute } => write!(
                f,
                "left and right hand are exchanged {per_minute:.0} times a minute: show the tracker the palm or the back of a \
                 hand, not its edge, and keep the hands apart; or send each hand with the side that it was first seen with",
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
            ": times must be in seconds (are these frame numbers?), and frames more than 0.5 s apart cannot be recognised",
        ),
    }
}

fn joints_missing(f: &mut fmt::Formatter<'_>, roles: RoleSet) -> fmt::Result {
    const ADVICE: &str = "send them if the tracker has them, because the index may use them";
    let is_lower = |role: Role| role == Role::Hips || LEGS.as_flattened().contains(&role);
    let mut lower = Role::BODY.into_iter().filter(|role| is_lower(*role));
    let heading = !roles.contains(Role::LeftArm) && !roles.contains(Role::RightArm);
    if !heading || !lower.all(|role| roles.contains(role)) {
        return write!(f, "missing: {roles}; {ADVICE}");
    }
    f.write_str(
        "the stream has neither hips nor legs: the facing direction is taken from the shoulders, and motions of arms and head \
         are recognised",
    )?;
    let others: RoleSet = roles.iter().filter(|role| !is_lower(*role)).collect();
    match others.is_empty() {
        true => Ok(()),
        false => write!(f, "; also missing: {others}; {ADVICE}"),
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
        "the body extends along {sign}{name}, so {sign}{name} is up (unless the performer lies down), but Y must be up: send \
         {send}"
    )
}
