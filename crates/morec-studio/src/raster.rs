//! Pictures of the window without a window: egui's triangles drawn by the processor.
//!
//! `--screenshot` needs neither a display nor a graphics card, and gives the same picture everywhere.

use egui::epaint::{ClippedPrimitive, ImageData, Mesh, Primitive, TextureId, Vertex};
use egui::{Color32, ColorImage, Pos2, Rect, TexturesDelta};

/// The textures that egui has made: fonts.
#[derive(Default)]
pub struct Textures(std::collections::HashMap<TextureId, ColorImage>);

impl Textures {
    pub fn apply(&mut self, delta: &TexturesDelta) {
        for (id, part) in &delta.set {
            let ImageData::Color(image) = &part.image;
            match part.pos {
                None => {
                    self.0.insert(*id, (**image).clone());
                }
                Some([x0, y0]) => {
                    if let Some(whole) = self.0.get_mut(id) {
                        paste(whole, image, x0, y0);
                    }
                }
            }
        }
        for id in &delta.free {
            self.0.remove(id);
        }
    }
}

fn paste(whole: &mut ColorImage, part: &ColorImage, x0: usize, y0: usize) {
    let [width, height] = part.size;
    let across = whole.size[0];
    for y in 0..height {
        let to = (y0 + y) * across + x0;
        whole.pixels[to..to + width].copy_from_slice(&part.pixels[y * width..(y + 1) * width]);
    }
}

/// Draws primitives over `ground`; `scale` is pixels a point. Size in pixels.
pub fn draw(
    primitives: &[ClippedPrimitive],
    textures: &Textures,
    size: [usize; 2],
    scale: f32,
    ground: Color32,
) -> ColorImage {
    let mut image = ColorImage::filled(size, ground);
    for ClippedPrimitive {
        clip_rect,
        primitive,
    } in primitives
    {
        if let Primitive::Mesh(mesh) = primitive
            && let Some(texture) = textures.0.get(&mesh.texture_id)
        {
            draw_mesh(&mut image, mesh, texture, *clip_rect, scale);
        }
    }
    image
}

fn draw_mesh(image: &mut ColorImage, mesh: &Mesh, texture: &ColorImage, clip: Rect, scale: f32) {
    let [width, height] = image.size;
    let bound = |v: f32, most: usize| ((v * scale).round().max(0.0) as usize).min(most);
    let (x0, x1) = (bound(clip.left(), width), bound(clip.right(), width));
    let (y0, y1) = (bound(clip.top(), height), bound(clip.bottom(), height));
    for corners in mesh.indices.chunks_exact(3) {
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(|i| mesh.vertices[i as usize]);
        triangle(image, texture, [a, b, c], [x0, x1, y0, y1], scale);
    }
}

/// One triangle: a pixel is inside if its middle is; edges that two triangles share are drawn once.
fn triangle(
    image: &mut ColorImage,
    texture: &ColorImage,
    mut v: [Vertex; 3],
    clip: [usize; 4],
    scale: f32,
) {
    let at = |v: &Vertex| Pos2::new(v.pos.x * scale, v.pos.y * scale);
    let edge = |a: Pos2, b: Pos2, p: Pos2| (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    let mut area = edge(at(&v[0]), at(&v[1]), at(&v[2]));
    if area < 0.0 {
        v.swap(1, 2);
        area = -area;
    }
    if area.is_nan() || area <= 1e-6 {
        return;
    }
    let p = [at(&v[0]), at(&v[1]), at(&v[2])];
    let least = |f: fn(&Pos2) -> f32| p.iter().map(f).fold(f32::MAX, f32::min);
    let most = |f: fn(&Pos2) -> f32| p.iter().map(f).fold(f32::MIN, f32::max);
    let [x0, x1, y0, y1] = clip;
    let from = |v: f32, low: usize| (v - 0.5).ceil().max(low as f32) as usize;
    let to = |v: f32, high: usize| ((v - 0.5).floor() + 1.0).clamp(0.0, high as f32) as usize;
    // The left and the upper edge belong to the triangle, the others to its neighbours.
    let owns = |a: Pos2, b: Pos2| (a.y == b.y && b.x > a.x) || b.y < a.y;
    let owned = [owns(p[1], p[2]), owns(p[2], p[0]), owns(p[0], p[1])];
    for y in from(least(|q| q.y), y0)..to(most(|q| q.y), y1) {
        for x in from(least(|q| q.x), x0)..to(most(|q| q.x), x1) {
            let middle = Pos2::new(x as f32 + 0.5, y as f32 + 0.5);
            let w = [
                edge(p[1], p[2], middle),
                edge(p[2], p[0], middle),
                edge(p[0], p[1], middle),
            ];
            if (0..3).any(|k| w[k] < 0.0 || (w[k] == 0.0 && !owned[k])) {
                continue;
            }
            let w = w.map(|w| w / area);
            let colour = mix(&v, w);
            let u = (0..3).map(|k| w[k] * v[k].uv.x).sum::<f32>();
            let t = (0..3).map(|k| w[k] * v[k].uv.y).sum::<f32>();
            let texel = sample(texture, u, t);
            let pixel = &mut image.pixels[y * image.size[0] + x];
            *pixel = over(multiply(colour, texel), *pixel);
        }
    }
}

type Rgba = [f32; 4];

fn rgba(colour: Color32) -> Rgba {
    colour.to_array().map(f32::from)
}

fn mix(v: &[Vertex; 3], w: [f32; 3]) -> Rgba {
    let parts = v.map(|v| rgba(v.color));
    std::array::from_fn(|i| (0..3).map(|k| w[k] * parts[k][i]).sum())
}

/// Between the four nearest texels, as a graphics card does.
fn sample(texture: &ColorImage, u: f32, v: f32) -> Rgba {
    let [width, height] = texture.size;
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let texel = |x: f32, y: f32| {
        let at = |v: f32, most: usize| (v.max(0.0) as usize).min(most - 1);
        rgba(texture.pixels[at(y, height) * width + at(x, width)])
    };
    let (fx, fy) = (x - x.floor(), y - y.floor());
    let (x, y) = (x.floor(), y.floor());
    let corners = [
        texel(x, y),
        texel(x + 1.0, y),
        texel(x, y + 1.0),
        texel(x + 1.0, y + 1.0),
    ];
    let shares = [
        (1.0 - fx) * (1.0 - fy),
        fx * (1.0 - fy),
        (1.0 - fx) * fy,
        fx * fy,
    ];
    std::array::from_fn(|i| (0..4).map(|k| shares[k] * corners[k][i]).sum())
}

fn multiply(a: Rgba, b: Rgba) -> Rgba {
    std::array::from_fn(|i| a[i] * b[i] / 255.0)
}

/// Colours are multiplied by their opacity already.
fn over(top: Rgba, bottom: Color32) -> Color32 {
    let below = rgba(bottom);
    let through = 1.0 - top[3] / 255.0;
    let [r, g, b, a] =
        std::array::from_fn(|i| (top[i] + below[i] * through).round().clamp(0.0, 255.0) as u8);
    Color32::from_rgba_premultiplied(r, g, b, a)
}

/// Every N pixels as one: their mean.
pub fn smaller(image: &ColorImage, times: usize) -> ColorImage {
    let [width, height] = [image.size[0] / times, image.size[1] / times];
    let mut out = ColorImage::filled([width, height], Color32::BLACK);
    let count = (times * times) as u32;
    for y in 0..height {
        for x in 0..width {
            let mut sum = [0u32; 3];
            for dy in 0..times {
                for dx in 0..times {
                    let pixel = image.pixels[(y * times + dy) * image.size[0] + x * times + dx];
                    let parts = [pixel.r(), pixel.g(), pixel.b()];
                    (0..3).for_each(|k| sum[k] += u32::from(parts[k]));
                }
            }
            let [r, g, b] = sum.map(|s| ((s + count / 2) / count) as u8);
            out.pixels[y * width + x] = Color32::from_rgb(r, g, b);
        }
    }
    out
}
