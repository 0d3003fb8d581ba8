//! Limbs as lit triangles, the farthest first, so that every backend that draws triangles draws them; a fringe around each
//! smooths its edge, so that none needs several samples a pixel, which cost a processor that draws most of its time.

use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Color32, Shape};
use morec::kinematics::WorldPose;
use morec::math::Vec3;

use super::camera::View;
use super::{Body, BodySide};

/// Colours of a performer.
#[derive(Debug, Clone, Copy)]
pub struct BodyColours {
    pub left: Color32,
    pub right: Color32,
    pub middle: Color32,
    pub shadow: Color32,
}

impl BodyColours {
    /// All colours brought so far towards another.
    pub fn mixed(self, colour: Color32, share: f32) -> Self {
        let towards = |own: Color32| own.lerp_to_gamma(colour, share);
        Self {
            left: towards(self.left),
            right: towards(self.right),
            middle: towards(self.middle),
            shadow: self.shadow,
        }
    }
}

/// Corners of a limb's ring.
const AROUND: usize = 14;
/// Rings of the rounding at each end.
const CAP: usize = 3;

/// Width of the fringe, points.
const FRINGE: f32 = 0.8;

/// A triangle of the picture.
struct Triangle {
    /// Depth of its limb's middle, then its own: where limbs meet, one lies before the other as a whole.
    depth: (f64, f64),
    at: [egui::Pos2; 3],
    colours: [Color32; 3],
}

/// Collects triangles, then draws them from the farthest to the nearest.
pub struct Painter {
    view: View,
    light: Vec3,
    triangles: Vec<Triangle>,
    /// Distance of the limb that is being added.
    limb: f64,
}

impl Painter {
    pub fn new(view: View) -> Self {
        Self {
            view,
            light: Vec3::new(0.35, 0.8, 0.45).normalize(),
            triangles: Vec::new(),
            limb: 0.0,
        }
    }

    /// Adds a performer.
    pub fn body(&mut self, body: &Body, pose: &WorldPose, palette: &BodyColours) {
        let height = body.height;
        for limb in &body.limbs {
            let (Some(a), Some(b)) = (pose.positions.get(limb.from), pose.positions.get(limb.to))
            else {
                continue;
            };
            let length = (b - a).norm();
            // Props, worlds and points that are not seen are no limbs; neither are joints that coincide.
            if !is_limb(length, height) || length < 0.004 * height {
                continue;
            }
            let colour = match limb.side {
                BodySide::Left => palette.left,
                BodySide::Right => palette.right,
                BodySide::Middle => palette.middle,
            };
            // A short limb is not thicker than it is long by much.
            let thick = |r: f64| (r * height).min(0.9 * length);
            self.capsule(a, b, limb.radii.map(thick), colour);
        }
        if let Some((head, neck)) = body.head {
            self.head(pose, head, neck, height, palette.middle);
        }
    }

    fn head(
        &mut self,
        pose: &WorldPose,
        head: usize,
        neck: Option<usize>,
        height: f64,
        colour: Color32,
    ) {
        let Some(at) = pose.positions.get(head) else {
            return;
        };
        let up = neck
            .and_then(|neck| pose.positions.get(neck))
            .map(|neck| at - neck)
            .filter(|d| d.norm() > 1e-3)
            .map_or_else(Vec3::y, |d| d.normalize());
        let (low, high) = (at + up * (0.035 * height), at + up * (0.075 * height));
        self.capsule(&low, &high, [0.047 * height, 0.053 * height], colour);
    }

    /// Adds a limb with round ends.
    pub fn capsule(&mut self, a: &Vec3, b: &Vec3, radii: [f64; 2], colour: Color32) {
        let Some(axis) = (b - a).try_normalize(1e-9) else {
            return;
        };
        let side = match axis.x.abs() < 0.8 {
            true => Vec3::x().cross(&axis).normalize(),
            false => Vec3::y().cross(&axis).normalize(),
        };
        let other = axis.cross(&side);
        self.limb = self.view.depth(&((a + b) / 2.0));
        // Rings from one end to the other: where along the axis from which end, how wide, how the surface leans.
        let mut rings: Vec<(Vec3, f64, f64)> = Vec::with_capacity(2 * CAP + 2);
        for step in 0..=CAP {
            let angle = std::f64::consts::FRAC_PI_2 * (1.0 - step as f64 / CAP as f64);
            let (sin, cos) = angle.sin_cos();
            rings.push((a - axis * (radii[0] * sin), radii[0] * cos, -sin));
        }
        for step in 0..=CAP {
            let angle = std::f64::consts::FRAC_PI_2 * step as f64 / CAP as f64;
            let (sin, cos) = angle.sin_cos();
            rings.push((b + axis * (radii[1] * sin), radii[1] * cos, sin));
        }
        let ring = |(centre, radius, lean): &(Vec3, f64, f64)| -> Vec<Option<Corner>> {
            (0..AROUND)
                .map(|k| {
                    let turn = std::f64::consts::TAU * k as f64 / AROUND as f64;
                    let out = side * turn.cos() + other * turn.sin();
                    let point = centre + out * *radius;
                    let normal = out * (1.0 - lean * lean).max(0.0).sqrt() + axis * *lean;
                    self.corner(&point, &normal, colour)
                })
                .collect()
        };
        let corners: Vec<Vec<Option<Corner>>> = rings.iter().map(ring).collect();
        let seen = corners.iter().flatten().flatten();
        let edge = outline(seen.map(|corner| (corner.at, corner.colour)).collect());
        self.triangles.extend(fringe(&edge).map(|corners| Triangle {
            // Behind the limb itself.
            depth: (self.limb, f64::INFINITY),
            at: corners.map(|(at, _)| at),
            colours: corners.map(|(_, colour)| colour),
        }));
        for pair in corners.windows(2) {
            for k in 0..AROUND {
                let next = (k + 1) % AROUND;
                let quad = (pair[0][k], pair[0][next], pair[1][next], pair[1][k]);
                if let (Some(p), Some(q), Some(r), Some(s)) = quad {
                    self.triangle([p, q, r]);
                    self.triangle([p, r, s]);
                }
            }
        }
    }

    fn corner(&self, point: &Vec3, normal: &Vec3, colour: Color32) -> Option<Corner> {
        let (at, depth) = self.view.project(point)?;
        let eye = self.view.towards_eye(point);
        let faces = normal.dot(&eye);
        let lit = normal.dot(&self.light).max(0.0);
        let half = (self.light + eye).normalize();
        let shine = normal.dot(&half).max(0.0).powi(24) * 0.16;
        // Edges that turn away are a little darker, which sets limbs apart from each other.
        let rim = 0.72 + 0.28 * faces.max(0.0).sqrt();
        let level = (0.50 + 0.55 * lit) * rim;
        Some(Corner {
            at,
            depth,
            colour: shade(colour, level as f32, shine as f32),
            faces,
        })
    }

    fn triangle(&mut self, corners: [Corner; 3]) {
        // What faces away is hidden by what faces the camera.
        if corners.iter().all(|c| c.faces < -0.05) {
            return;
        }
        self.triangles.push(Triangle {
            depth: (self.limb, corners.iter().map(|c| c.depth).sum()),
            at: corners.map(|c| c.at),
            colours: corners.map(|c| c.colour),
        });
    }

    /// The performer's shadow on the floor at `floor`, as flat limbs in one colour.
    pub fn shadow(&self, body: &Body, pose: &WorldPose, floor: f64, colour: Color32) -> Shape {
        let mut mesh = Mesh::default();
        for limb in &body.limbs {
            let (Some(a), Some(b)) = (pose.positions.get(limb.from), pose.positions.get(limb.to))
            else {
                continue;
            };
            if !is_limb((b - a).norm(), body.height) {
                continue;
            }
            let flat = |p: &Vec3| {
                let drop = (p.y - floor) / self.light.y;
                let on_floor = p - self.light * drop * 0.55;
                Vec3::new(on_floor.x, floor, on_floor.z)
            };
            let (a, b) = (flat(a), flat(b));
            let along = (b - a).try_normalize(1e-6).unwrap_or_else(Vec3::x);
            let across = Vec3::new(-along.z, 0.0, along.x);
            let [ra, rb] = limb.radii.map(|r| r * body.height);
            let ring = (0..10).map(|k| {
                let turn = std::f64::consts::TAU * (k as f64 + 0.5) / 10.0;
                let (end, r) = if turn.cos() > 0.0 { (b, rb) } else { (a, ra) };
                end + along * (turn.cos() * r) + across * (turn.sin() * r)
            });
            let corners: Option<Vec<_>> = ring.map(|p| self.view.project(&p)).collect();
            let Some(corners) = corners else { continue };
            let first = mesh.vertices.len() as u32;
            mesh.vertices
                .extend(corners.iter().map(|(at, _)| vertex(*at, colour)));
            let edge = outline(corners.iter().map(|(at, _)| (*at, colour)).collect());
            for corners in fringe(&edge) {
                push(&mut mesh, corners);
            }
            (1..corners.len() as u32 - 1)
                .for_each(|k| mesh.indices.extend([first, first + k, first + k + 1]));
        }
        Shape::mesh(mesh)
    }

    /// True if nothing was added that is seen.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// All triangles as one shape.
    pub fn finish(mut self) -> Shape {
        self.triangles.sort_unstable_by(|a, b| {
            let (a, b) = (a.depth, b.depth);
            b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1))
        });
        let mut mesh = Mesh::default();
        mesh.vertices.reserve(3 * self.triangles.len());
        mesh.indices.reserve(3 * self.triangles.len());
        for triangle in &self.triangles {
            let [p, q, r] = triangle.at;
            let [a, b, c] = triangle.colours;
            push(&mut mesh, [(p, a), (q, b), (r, c)]);
        }
        Shape::mesh(mesh)
    }
}

#[derive(Clone, Copy)]
struct Corner {
    at: egui::Pos2,
    depth: f64,
    colour: Color32,
    /// Cosine of the angle between the surface and the direction to the camera.
    faces: f64,
}

/// A corner in the picture.
type Coloured = (egui::Pos2, Color32);

/// The convex hull of corners, in order around it.
fn outline(mut corners: Vec<Coloured>) -> Vec<Coloured> {
    let order = |a: &Coloured, b: &Coloured| {
        let (a, b) = (a.0, b.0);
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    };
    corners.sort_unstable_by(order);
    corners.dedup_by_key(|corner| corner.0);
    if corners.len() < 3 {
        return Vec::new();
    }
    let mut hull: Vec<Coloured> = Vec::new();
    let half = |hull: &mut Vec<Coloured>, corner: Coloured, kept: usize| {
        while let [.., a, b] = hull[kept..] {
            let ((a, b), c) = ((a.0, b.0), corner.0);
            if (b - a).rot90().dot(c - b) < 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(corner);
    };
    corners
        .iter()
        .for_each(|&corner| half(&mut hull, corner, 0));
    // The last corner begins the way back, and the first ends it.
    let there = hull.len() - 1;
    let back = corners.iter().rev().skip(1);
    back.for_each(|&corner| half(&mut hull, corner, there));
    hull.pop();
    hull
}

/// Triangles around a convex outline that fade outwards.
fn fringe(outline: &[Coloured]) -> impl Iterator<Item = [Coloured; 3]> {
    let count = outline.len();
    let along = move |k: usize| {
        let (from, to) = (outline[k % count].0, outline[(k + 1) % count].0);
        (to - from).normalized()
    };
    // Outward on either side of a corner, at equal distance from both edges but where these fold back on themselves.
    let faded = move |k: usize| {
        let (before, after) = (along(k + count - 1).rot90(), along(k).rot90());
        let middle = (before + after).normalized();
        let width = FRINGE / middle.dot(after).max(0.5);
        (outline[k % count].0 + middle * width, Color32::TRANSPARENT)
    };
    (0..count).flat_map(move |k| {
        let (p, q) = (outline[k], outline[(k + 1) % count]);
        let (far_p, far_q) = (faded(k), faded(k + 1));
        [[p, q, far_q], [p, far_q, far_p]]
    })
}

fn push(mesh: &mut Mesh, corners: [Coloured; 3]) {
    let first = mesh.vertices.len() as u32;
    mesh.vertices
        .extend(corners.map(|(at, colour)| vertex(at, colour)));
    mesh.indices.extend([first, first + 1, first + 2]);
}

/// Props, worlds and points that are not seen are no limbs.
fn is_limb(length: f64, height: f64) -> bool {
    length < 0.6 * height
}

fn vertex(at: egui::Pos2, colour: Color32) -> Vertex {
    Vertex {
        pos: at,
        uv: WHITE_UV,
        color: colour,
    }
}

fn shade(colour: Color32, level: f32, shine: f32) -> Color32 {
    let part = |v: u8| (f32::from(v) * level + 255.0 * shine).clamp(0.0, 255.0) as u8;
    Color32::from_rgb(part(colour.r()), part(colour.g()), part(colour.b()))
}

#[cfg(test)]
mod tests {
    use egui::{Vec2, pos2};

    use super::*;

    #[test]
    fn a_fringe_goes_once_around_the_outline_and_fades_outwards() {
        let colour = Color32::from_rgb(10, 20, 30);
        let square = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let within = [(2.0, 0.0), (1.0, 3.0), (4.0, 2.0), (0.0, 0.0)];
        let corners = square.iter().chain(&within);
        let edge = outline(corners.map(|&(x, y)| (pos2(x, y), colour)).collect());
        let mut places: Vec<(f32, f32)> = edge.iter().map(|(at, _)| (at.x, at.y)).collect();
        places.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(places, [(0.0, 0.0), (0.0, 4.0), (4.0, 0.0), (4.0, 4.0)]);
        let triangles: Vec<_> = fringe(&edge).collect();
        assert_eq!(triangles.len(), 8);
        for (at, colour) in triangles.iter().flatten() {
            let off = (*at - pos2(2.0, 2.0)).abs() - Vec2::splat(2.0);
            let expected = if *colour == Color32::TRANSPARENT {
                FRINGE
            } else {
                0.0
            };
            assert!(
                (off - Vec2::splat(expected)).length() < 1e-5,
                "{at} {colour:?}"
            );
        }
        assert!(outline(vec![(pos2(1.0, 1.0), colour); 5]).is_empty());
    }
}
