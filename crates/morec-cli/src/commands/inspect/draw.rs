//! A small picture of the body with its roles, front and side.

use std::fmt::Write as _;

use morec::features::Hand;
use morec::import::Take;
use morec::kinematics::WorldPose;
use morec::math::Vec3;
use morec::roles::Role;

use crate::show::picture::{CharGrid, DIM, Dots, PLAIN, Style, class_style};

/// Side of the body that a bone is drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum DrawnSide {
    Left,
    Middle,
    Right,
}

impl DrawnSide {
    fn of(hand: Hand) -> Self {
        match hand {
            Hand::Left => DrawnSide::Left,
            Hand::Right => DrawnSide::Right,
        }
    }
}

/// Lines between roles of a body. Where one is not played, the line is left out.
const BONES: [(Role, Role, DrawnSide); 20] = [
    (Role::Hips, Role::Torso, DrawnSide::Middle),
    (Role::Torso, Role::Neck, DrawnSide::Middle),
    (Role::Hips, Role::Neck, DrawnSide::Middle),
    (Role::Neck, Role::Head, DrawnSide::Middle),
    (Role::Neck, Role::LeftShoulder, DrawnSide::Left),
    (Role::LeftShoulder, Role::LeftArm, DrawnSide::Left),
    (Role::Neck, Role::LeftArm, DrawnSide::Left),
    (Role::LeftArm, Role::LeftForearm, DrawnSide::Left),
    (Role::LeftForearm, Role::LeftHand, DrawnSide::Left),
    (Role::Hips, Role::LeftThigh, DrawnSide::Left),
    (Role::LeftThigh, Role::LeftShin, DrawnSide::Left),
    (Role::LeftShin, Role::LeftFoot, DrawnSide::Left),
    (Role::Neck, Role::RightShoulder, DrawnSide::Right),
    (Role::RightShoulder, Role::RightArm, DrawnSide::Right),
    (Role::Neck, Role::RightArm, DrawnSide::Right),
    (Role::RightArm, Role::RightForearm, DrawnSide::Right),
    (Role::RightForearm, Role::RightHand, DrawnSide::Right),
    (Role::Hips, Role::RightThigh, DrawnSide::Right),
    (Role::RightThigh, Role::RightShin, DrawnSide::Right),
    (Role::RightShin, Role::RightFoot, DrawnSide::Right),
];

/// The body in one frame, seen from the front and from its left: places of the roles in metres, right and up.
pub struct Drawing {
    front: Vec<Option<[f64; 2]>>,
    side: Vec<Option<[f64; 2]>>,
    names: Vec<String>,
    height: f64,
    width: f64,
    low: f64,
    /// True if no body is seen.
    is_hand: bool,
}

impl Drawing {
    /// The pose in the middle of the clip, facing out of the picture. `None` without frames or roles.
    pub fn of(take: &Take) -> Option<Self> {
        let Take {
            clip,
            roles,
            report,
            ..
        } = take;
        if clip.frames == 0 {
            return None;
        }
        let frame = (report.rest_frames.end + clip.frames) / 2;
        let pose = WorldPose::of(clip, frame.min(clip.frames - 1));
        let at = |role: Role| roles.joint(role).map(|joint| pose.positions[joint]);
        let body = at(Role::Hips).or(at(Role::Neck)).or(at(Role::Head));
        let mut hands = roles.played().filter(|(role, _)| Hand::of(*role).is_some());
        let hips = body.or_else(|| Some(pose.positions[hands.next()?.1]))?;
        let across = |a: Role, b: Role| {
            let mut across = at(a)? - at(b)?;
            across.y = 0.0;
            across.try_normalize(1e-9)
        };
        let left = across(Role::LeftThigh, Role::RightThigh)
            .or_else(|| across(Role::LeftArm, Role::RightArm))
            .unwrap_or(Vec3::x());
        let forward = left.cross(&Vec3::y());
        let seen = |axis: Vec3| -> Vec<Option<[f64; 2]>> {
            let place = |role: &Role| at(*role).map(|p| [(p - hips).dot(&axis), p.y]);
            Role::ALL.iter().map(place).collect()
        };
        // Seen from the front, the left is on the right; seen from its left, the body faces left.
        let (front, side) = (seen(left), seen(-forward));
        let all = || front.iter().chain(&side).flatten();
        let low = all().map(|p| p[1]).fold(f64::MAX, f64::min);
        let high = all().map(|p| p[1]).fold(f64::MIN, f64::max);
        let width = all().map(|p| p[0].abs()).fold(0.0, f64::max);
        let names = Role::ALL.iter().map(|&role| match roles.joint(role) {
            Some(joint) => clip.skeleton.joints()[joint].name.clone(),
            None => String::new(),
        });
        (high - low > 0.0).then(|| Self {
            names: names.collect(),
            height: high - low,
            width,
            low,
            is_hand: body.is_none(),
            front,
            side,
        })
    }

    /// On a terminal: the front view, the view from the left, and what the colours mean.
    pub fn text(&self, colour: bool, unicode: bool) -> String {
        const ROWS: usize = 18;
        const GAP: usize = 4;
        // A character is twice as high as wide: two dots by four.
        let scale = 4.0 * (ROWS as f64 - 0.5) / self.height;
        let half = ((self.width * scale / 2.0).ceil() as usize + 1).min(30);
        let columns = 2 * half;
        let mut picture = CharGrid::new(2 * columns + GAP, ROWS + 2);
        for (places, from) in [(&self.front, 0), (&self.side, columns + GAP)] {
            for side in [DrawnSide::Right, DrawnSide::Middle, DrawnSide::Left] {
                let mut dots = Dots::new(columns, ROWS);
                let dot = |[x, y]: [f64; 2]| {
                    [
                        half as f64 * 2.0 + x * scale,
                        (self.low + self.height - y) * scale,
                    ]
                };
                for (a, b) in self.lines(places, side) {
                    dots.line(dot(a), dot(b));
                }
                dots.draw(&mut picture, (from, 0), unicode, style(side));
            }
        }
        let from = half.saturating_sub(6);
        picture.text(from, ROWS, from + 15, "from the front", DIM);
        let from = columns + GAP + half.saturating_sub(6);
        picture.text(from, ROWS, from + 14, "from its left", DIM);
        let mut text = picture.render(colour);
        if colour {
            text += "  \x1b[0;1;34mleft\x1b[0m, \x1b[0;1;32mright\x1b[0m\n";
        } else {
            text += "  in the front view, the body's left is on the right\n";
        }
        text
    }

    /// Lines of one side between roles that are played. A line from the hips to the neck stands for those over the torso
    /// where that is missing, and so with shoulders.
    fn lines<'a>(
        &'a self,
        places: &'a [Option<[f64; 2]>],
        side: DrawnSide,
    ) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + 'a {
        let there = |role: Role| places[role.index()].is_some();
        let hands = Hand::BOTH.into_iter().flat_map(move |hand| {
            let side = DrawnSide::of(hand);
            let lines = hand.lines(there).into_iter();
            lines.map(move |(a, b)| (a, b, side))
        });
        BONES
            .into_iter()
            .chain(hands)
            .filter(move |&(a, b, of)| {
                of == side
                    && !(a == Role::Hips && b == Role::Neck && there(Role::Torso))
                    && !(a == Role::Neck && b == Role::LeftArm && there(Role::LeftShoulder))
                    && !(a == Role::Neck && b == Role::RightArm && there(Role::RightShoulder))
            })
            .filter_map(|(a, b, _)| Some((places[a.index()]?, places[b.index()]?)))
    }

    /// As an SVG picture, with the joints' names at their places.
    pub fn svg(&self, title: &str) -> String {
        const HEIGHT: f64 = 480.0;
        const MARGIN: f64 = 40.0;
        let scale = HEIGHT / self.height;
        let half = (self.width * scale).max(120.0) + MARGIN;
        let (width, height) = (4.0 * half, HEIGHT + 2.0 * MARGIN);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" \
             font-size=\"11\">\n<title>{}</title>\n",
            escaped(title)
        );
        for (places, middle, said) in [
            (&self.front, half, "from the front"),
            (&self.side, 3.0 * half, "from its left"),
        ] {
            let dot = |[x, y]: [f64; 2]| {
                let down = MARGIN + (self.low + self.height - y) * scale;
                [middle + x * scale, down]
            };
            for side in [DrawnSide::Right, DrawnSide::Middle, DrawnSide::Left] {
                for (a, b) in self.lines(places, side) {
                    let ([x, y], [u, v]) = (dot(a), dot(b));
                    // Writing to a string cannot fail.
                    let _ = writeln!(
                        svg,
                        "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{u:.1}\" y2=\"{v:.1}\" stroke=\"{}\" stroke-width=\"3\"/>",
                        paint(side)
                    );
                }
            }
            for (role, place) in Role::ALL.into_iter().zip(places) {
                let Some([x, y]) = place.map(dot) else {
                    continue;
                };
                let _ = writeln!(
                    svg,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\"><title>{role}: {}</title></circle>",
                    escaped(&self.names[role.index()])
                );
                // Beside a body there is no room for the names of fingers.
                let has_room = !role.is_of_hand() || self.is_hand;
                if middle == half && has_room {
                    let (end, shift) = if x < middle - 1.0 {
                        ("end", -6.0)
                    } else {
                        ("start", 6.0)
                    };
                    let _ = writeln!(
                        svg,
                        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{end}\">{}</text>",
                        x + shift,
                        y - 3.0,
                        escaped(&self.names[role.index()])
                    );
                }
            }
            let _ = writeln!(
                svg,
                "<text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#777\">{said}</text>",
                height - 8.0
            );
        }
        svg += "</svg>\n";
        svg
    }
}

fn style(side: DrawnSide) -> Style {
    match side {
        DrawnSide::Left => class_style(1),
        DrawnSide::Middle => PLAIN,
        DrawnSide::Right => class_style(0),
    }
}

fn paint(side: DrawnSide) -> &'static str {
    match side {
        DrawnSide::Left => "#2b6cb0",
        DrawnSide::Middle => "#555",
        DrawnSide::Right => "#2f855a",
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use morec::synth::{DatabaseSpec, database};

    /// A synthetic person; facing away from +Z if `turned`, so that the picture has to find the front.
    fn take(turned: bool) -> Take {
        let spec = DatabaseSpec {
            people: 1,
            repetitions: 1,
            classes: vec!["wave"],
            ..DatabaseSpec::default()
        };
        let mut clip = database(2, &spec).remove(0).clip;
        if turned {
            let half = morec::math::Axis::Y.rotation(std::f64::consts::PI);
            let joints = clip.skeleton.len();
            for frame in 0..clip.frames {
                let root = &mut clip.rotations[frame * joints];
                *root = half * *root;
            }
        }
        Take::new(clip).unwrap()
    }

    /// Centre of a role's circle: in the front view, then from the left.
    fn circles(svg: &str, role: &str) -> Vec<[f64; 2]> {
        let number = |line: &str, key: &str| {
            let (_, rest) = line.split_once(&format!("{key}=\"")).unwrap();
            rest.split_once('"').unwrap().0.parse().unwrap()
        };
        svg.lines()
            .filter(|line| line.contains(&format!("<title>{role}: ")))
            .map(|line| [number(line, "cx"), number(line, "cy")])
            .collect()
    }

    #[test]
    fn the_front_is_seen_from_the_front_and_the_head_is_up() {
        for turned in [false, true] {
            let take = take(turned);
            let drawing = Drawing::of(&take).unwrap();
            let svg = drawing.svg("a < b");
            assert!(svg.contains("<title>a &lt; b</title>"));
            let at = |role: &str| circles(&svg, role);
            for role in Role::ALL.iter().filter(|r| take.roles.joint(**r).is_some()) {
                assert_eq!(at(role.name()).len(), 2, "{role} in both views");
            }
            assert!(
                at("left_thigh")[0][0] > at("right_thigh")[0][0] + 5.0,
                "{turned}"
            );
            assert!(
                at("left_arm")[0][0] > at("right_arm")[0][0] + 5.0,
                "{turned}"
            );
            for view in 0..2 {
                let down = |role: &str| at(role)[view][1];
                assert!(
                    down("head") < down("hips") - 50.0 && down("hips") < down("left_foot") - 50.0
                );
            }
            // From the left, both hips are nearly in one place; from the front they are not.
            let apart =
                |view: usize| (at("left_thigh")[view][0] - at("right_thigh")[view][0]).abs();
            assert!(apart(1) < 0.3 * apart(0), "{} {}", apart(0), apart(1));
            // Both sides have as many lines.
            let lines = |side: DrawnSide| svg.matches(paint(side)).count();
            assert_eq!(lines(DrawnSide::Left), lines(DrawnSide::Right));
            assert!(lines(DrawnSide::Left) >= 2 * 5);
        }
    }

    #[test]
    fn the_terminal_shows_two_figures_of_the_bodys_height() {
        let drawing = Drawing::of(&take(false)).unwrap();
        let text = drawing.text(false, true);
        let drawn = |line: &&str| line.chars().any(|c| ('\u{2801}'..='\u{28FF}').contains(&c));
        let rows: Vec<&str> = text.lines().filter(drawn).collect();
        assert!((16..=19).contains(&rows.len()), "{}\n{text}", rows.len());
        let label = text.lines().find(|l| l.contains("from its left")).unwrap();
        assert!(label.contains("from the front"), "{text}");
        assert!(!drawing.text(false, false).chars().any(|c| c > '\u{7f}'));
        assert!(drawing.text(true, true).contains("\x1b["));
    }

    #[test]
    fn what_is_not_played_is_not_drawn() {
        let mut take = take(false);
        for role in [Role::LeftForearm, Role::LeftHand] {
            take.roles.set(role, None);
        }
        let svg = Drawing::of(&take).unwrap().svg("one arm");
        assert!(circles(&svg, "left_hand").is_empty());
        assert!(
            svg.matches(paint(DrawnSide::Left)).count()
                < svg.matches(paint(DrawnSide::Right)).count()
        );
        take.clip.frames = 0;
        assert!(Drawing::of(&take).is_none());
    }
}
