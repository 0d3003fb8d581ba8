//! Draws text and thin lines on a grid of characters.

/// Style of a character; 0 is plain, 1 dimmed, from 2 on a colour each.
pub type Style = u8;

/// Plain text.
pub const PLAIN: Style = 0;
/// Text of less weight.
pub const DIM: Style = 1;

/// The escape codes of the styles from 2 on: colours that are seen on light and dark ground.
const COLOURS: [&str; 6] = ["32", "34", "35", "36", "33", "31"];

/// The colour of class number `class`.
pub fn class_style(class: usize) -> Style {
    2 + (class % COLOURS.len()) as Style
}

/// A grid of characters. Whatever falls outside is cut off.
#[derive(Debug, Clone)]
pub struct CharGrid {
    columns: usize,
    cells: Vec<(char, Style)>,
}

impl CharGrid {
    /// An empty one.
    pub fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            cells: vec![(' ', PLAIN); columns * rows],
        }
    }

    /// Writes `text` from column `x` of row `y`, at most up to column `stop`.
    pub fn text(&mut self, x: usize, y: usize, stop: usize, text: &str, style: Style) {
        for (at, c) in (x..stop.min(self.columns)).zip(text.chars()) {
            if let Some(cell) = self.cells.get_mut(y * self.columns + at) {
                *cell = (if c.is_control() { '?' } else { c }, style);
            }
        }
    }

    /// The lines, without blanks at their ends; with escape codes only if `colour`.
    pub fn render(&self, colour: bool) -> String {
        let mut out = String::with_capacity(self.cells.len() * 2);
        for row in self.cells.chunks(self.columns.max(1)) {
            let used = row
                .iter()
                .rposition(|cell| cell.0 != ' ')
                .map_or(0, |last| last + 1);
            let mut style = PLAIN;
            for &(c, next) in &row[..used] {
                if colour && next != style {
                    out += &escape(next);
                    style = next;
                }
                out.push(c);
            }
            if style != PLAIN {
                out += &escape(PLAIN);
            }
            out.push('\n');
        }
        out
    }
}

fn escape(style: Style) -> String {
    match style {
        PLAIN => "\x1b[0m".to_owned(),
        DIM => "\x1b[0;2m".to_owned(),
        colour => format!(
            "\x1b[0;1;{}m",
            COLOURS[usize::from(colour - 2) % COLOURS.len()]
        ),
    }
}

/// Dots, two across and four down in each character.
#[derive(Debug, Clone)]
pub struct Dots {
    columns: usize,
    rows: usize,
    cells: Vec<u8>,
}

impl Dots {
    /// None set, on `columns` by `rows` characters.
    pub fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns,
            rows,
            cells: vec![0; columns * rows],
        }
    }

    /// Sets the dot at `x` to the right and `y` down, if it is on the grid.
    pub fn set(&mut self, x: f64, y: f64) {
        // Bits of U+2800 by row and column of the dot.
        const BITS: [[u8; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        if !(x >= 0.0 && y >= 0.0 && x < 2.0 * self.columns as f64 && y < 4.0 * self.rows as f64) {
            return;
        }
        let (x, y) = (x as usize, y as usize);
        self.cells[y / 4 * self.columns + x / 2] |= BITS[y % 4][x % 2];
    }

    /// Sets the dots of a straight line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2]) {
        let way = [to[0] - from[0], to[1] - from[1]];
        let far = way[0].abs().max(way[1].abs());
        // A line that leaves the grid by miles is nobody's arm.
        let steps = if far.is_finite() {
            far.min(2000.0).ceil().max(1.0)
        } else {
            return;
        };
        for step in 0..=steps as usize {
            let u = step as f64 / steps;
            self.set(from[0] + u * way[0], from[1] + u * way[1]);
        }
    }

    /// Copies the dots to `picture` as braille characters, or as asterisks without Unicode.
    pub fn draw(
        &self,
        picture: &mut CharGrid,
        (x, y): (usize, usize),
        unicode: bool,
        style: Style,
    ) {
        for (at, &bits) in self
            .cells
            .iter()
            .enumerate()
            .filter(|(_, bits)| **bits != 0)
        {
            let c = if unicode {
                char::from_u32(0x2800 + u32::from(bits)).unwrap_or('*')
            } else {
                '*'
            };
            let column = x + at % self.columns;
            picture.text(
                column,
                y + at / self.columns,
                column + 1,
                c.encode_utf8(&mut [0; 4]),
                style,
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_falls_outside_is_cut_off() {
        let mut picture = CharGrid::new(5, 2);
        picture.text(3, 0, 99, "abcdef", PLAIN);
        picture.text(0, 7, 99, "nowhere", PLAIN);
        picture.text(1, 1, 3, "xyz", PLAIN);
        assert_eq!(picture.render(true), "   ab\n xy\n");
    }

    #[test]
    fn colours_are_ended_on_their_line_or_not_used() {
        let mut picture = CharGrid::new(8, 1);
        picture.text(0, 0, 8, "hi", class_style(0));
        assert_eq!(picture.render(true), "\x1b[0;1;32mhi\x1b[0m\n");
        assert_eq!(picture.render(false), "hi\n");
    }

    #[test]
    fn dots_become_braille() {
        let mut dots = Dots::new(2, 1);
        dots.line([0.0, 0.0], [0.0, 3.0]);
        dots.set(3.0, 3.0);
        dots.set(-1.0, 0.0);
        dots.set(f64::NAN, 9.0);
        let mut picture = CharGrid::new(4, 1);
        dots.draw(&mut picture, (1, 0), true, PLAIN);
        assert_eq!(picture.render(false), " ⡇⢀\n");
    }
}
