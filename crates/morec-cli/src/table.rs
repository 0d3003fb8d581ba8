//! Text tables in the terminal, aligned with blanks: the first column left, the others right.

use std::fmt;

/// A table; `Display` writes it, a line for each row, however long.
pub struct TextTable {
    rows: Vec<Vec<String>>,
    /// Names of columns that may be left out, the least important first.
    least: Vec<String>,
}

impl TextTable {
    /// A table with these column names.
    pub fn new<const N: usize>(header: [&str; N]) -> Self {
        Self::with_header(header.map(str::to_owned).to_vec())
    }

    /// A table whose column names are made at run time.
    pub fn with_header(header: Vec<String>) -> Self {
        Self {
            rows: vec![header],
            least: Vec::new(),
        }
    }

    /// Columns that are left out where the terminal is too narrow, the least important first.
    pub fn least<const N: usize>(mut self, columns: [&str; N]) -> Self {
        self.least = columns.map(str::to_owned).to_vec();
        self
    }

    /// Adds a row; it may be shorter than the header.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }
}

impl TextTable {
    fn columns(&self) -> usize {
        self.rows.iter().map(Vec::len).max().unwrap_or(0)
    }

    fn widths(&self) -> Vec<usize> {
        let widest = |at: usize| {
            self.rows
                .iter()
                .filter_map(|r| r.get(at))
                .map(|c| columns_of(c))
                .max()
        };
        (0..self.columns())
            .map(|at| widest(at).unwrap_or(0))
            .collect()
    }

    /// The table in at most `width` columns, as far as that can be: long texts lose their middle, then columns go, then
    /// texts lose more. Numbers are never cut.
    pub fn fitted(&self, width: usize) -> TextTable {
        let mut table = TextTable {
            rows: self.rows.clone(),
            least: Vec::new(),
        };
        let mut least = self.least.iter();
        loop {
            let widths = table.shrunk(width, SHORT_TEXT);
            if total(&widths) <= width {
                return table.cut_to(&widths);
            }
            let gone = least
                .by_ref()
                .find_map(|name| table.rows[0].iter().position(|h| h == name));
            let Some(at) = gone else { break };
            for row in table.rows.iter_mut().filter(|row| at < row.len()) {
                row.remove(at);
            }
        }
        let widths = table.shrunk(width, SHORTEST_TEXT);
        table.cut_to(&widths)
    }

    /// Widths with which the table fits, or as near to that as texts of `shortest` columns come.
    fn shrunk(&self, width: usize, shortest: usize) -> Vec<usize> {
        let mut widths = self.widths();
        while total(&widths) > width {
            let wide = (0..widths.len()).filter(|at| widths[*at] > shortest && self.is_text(*at));
            let Some(widest) = wide.max_by_key(|at| widths[*at]) else {
                break;
            };
            widths[widest] -= 1;
        }
        widths
    }

    /// True if a column below its name holds anything but numbers.
    fn is_text(&self, at: usize) -> bool {
        let cells = self.rows.iter().skip(1).filter_map(|row| row.get(at));
        cells
            .into_iter()
            .any(|cell| !cell.is_empty() && cell.parse::<f64>().is_err())
    }

    fn cut_to(mut self, widths: &[usize]) -> TextTable {
        for row in &mut self.rows {
            for (cell, width) in row.iter_mut().zip(widths) {
                *cell = shortened(cell, *width);
            }
        }
        self
    }

    /// The rows, names of the columns first.
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// The whole table with its columns separated by tabs: for other programs.
    pub fn tabbed(&self) -> String {
        let clean = |cell: &String| cell.replace(['\t', '\n', '\r'], " ");
        let columns = self.columns();
        let line = |row: &Vec<String>| {
            let cells: Vec<String> = (0..columns)
                .map(|at| row.get(at).map_or_else(String::new, clean))
                .collect();
            cells.join("\t") + "\n"
        };
        self.rows.iter().map(line).collect()
    }
}

/// Texts are cut to this before columns are left out, and to the other afterwards.
const SHORT_TEXT: usize = 16;
const SHORTEST_TEXT: usize = 6;

/// Columns of a line: an indent, the cells, two blanks between them.
fn total(widths: &[usize]) -> usize {
    2 + widths.iter().sum::<usize>() + 2 * widths.len().saturating_sub(1)
}

/// Columns that a text takes in a terminal: East Asian signs take two, signs that combine none.
fn columns_of(text: &str) -> usize {
    text.chars().map(width_of).sum()
}

fn width_of(sign: char) -> usize {
    match u32::from(sign) {
        0x300..0x370 | 0x200B..=0x200F => 0,
        0x1100..0x1160 | 0x2E80..0xA4D0 | 0xAC00..0xD7A4 | 0xF900..0xFB00 | 0xFE30..0xFE70 => 2,
        0xFF00..0xFF61 | 0xFFE0..0xFFE7 | 0x1F300..0x1FB00 | 0x20000..0x30000 => 2,
        _ => 1,
    }
}

/// A text of at most `width` columns: what is too long loses its middle, as names mostly differ at their ends.
fn shortened(text: &str, width: usize) -> String {
    if columns_of(text) <= width {
        return text.to_owned();
    }
    let room = width.saturating_sub(1);
    let head = beginning(text.chars(), room.div_ceil(2));
    let tail: String = beginning(text.chars().rev(), room / 2)
        .chars()
        .rev()
        .collect();
    format!("{head}…{tail}")
}

/// The first signs, as many as have room.
fn beginning(signs: impl Iterator<Item = char>, room: usize) -> String {
    let mut used = 0;
    let fits = |sign: &char| {
        used += width_of(*sign);
        used <= room
    };
    signs.take_while(fits).collect()
}

impl fmt::Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widths = self.widths();
        for row in &self.rows {
            let mut line = String::from("  ");
            for (column, cell) in row.iter().enumerate() {
                let pad = " ".repeat(widths[column] - columns_of(cell));
                match column {
                    0 => line.push_str(&format!("{cell}{pad}")),
                    _ => line.push_str(&format!("  {pad}{cell}")),
                }
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let mut table = TextTable::new(["class", "n"]);
        table.row(["é".to_owned(), "100".to_owned()]);
        table.row(["walking".to_owned()]);
        assert_eq!(
            table.to_string(),
            "  class      n\n  é        100\n  walking\n"
        );
    }

    fn clips() -> TextTable {
        let mut table = TextTable::new(["clip", "secs", "joints", "who"]).least(["joints", "secs"]);
        for (clip, secs) in [
            ("studio_2026_walk_in_a_circle_take_01", "12.5"),
            ("short", "3"),
            ("動作の練習その一二三四五六七", "100.25"),
        ] {
            table.row([clip, secs, "31", "anna"].map(str::to_owned));
        }
        table
    }

    #[test]
    fn no_line_is_wider_than_the_terminal() {
        for width in [24, 30, 40, 60, 80, 200] {
            let text = clips().fitted(width).to_string();
            assert!(
                text.lines().all(|line| columns_of(line) <= width),
                "{width}:\n{text}"
            );
        }
    }

    #[test]
    fn names_lose_their_middle_before_columns_go_and_numbers_stay_whole() {
        assert_eq!(clips().fitted(200).to_string(), clips().to_string());
        let medium = clips().fitted(44).to_string();
        assert!(
            medium.contains("joints") && medium.contains("studio") && medium.contains("_01"),
            "{medium}"
        );
        assert!(
            medium.contains('…') && medium.contains("100.25"),
            "{medium}"
        );
        let narrow = clips().fitted(26).to_string();
        assert!(
            !narrow.contains("joints") && narrow.contains("anna"),
            "{narrow}"
        );
        assert_eq!(shortened("abcdefgh", 5), "ab…gh");
        assert_eq!(
            columns_of(&shortened("動作の練習", 6)),
            5,
            "a half of a wide sign is none"
        );
    }

    #[test]
    fn other_programs_get_everything() {
        let mut table = TextTable::new(["clip", "n", "what"]);
        table.row(["a\tb".to_owned(), "1".to_owned()]);
        assert_eq!(table.tabbed(), "clip\tn\twhat\na b\t1\t\n");
    }
}
