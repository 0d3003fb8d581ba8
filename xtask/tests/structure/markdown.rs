//! Tables, headings and code of a document.

/// A table of a document.
pub struct Table<'a> {
    /// The heading above it.
    pub section: &'a str,
    pub header: Vec<&'a str>,
    pub rows: Vec<Vec<&'a str>>,
}

/// The lines of a text, and for each whether it belongs to a fenced block.
pub fn lines(text: &str) -> impl Iterator<Item = (&str, bool)> {
    let mut fenced = false;
    text.lines().map(move |line| {
        let fence = line.trim_start().starts_with("```");
        fenced ^= fence;
        (line, fenced || fence)
    })
}

fn cells(line: &str) -> Vec<&str> {
    let inside = line.trim().trim_start_matches('|').trim_end_matches('|');
    inside.split('|').map(str::trim).collect()
}

/// All tables of a text.
pub fn tables(text: &str) -> Vec<Table<'_>> {
    let (mut found, mut section, mut open) = (Vec::<Table>::new(), "", false);
    for (line, code) in lines(text) {
        let row = line.starts_with('|') && !code;
        match (row, open, found.last_mut()) {
            (true, true, Some(table)) if !line.starts_with("|--") => table.rows.push(cells(line)),
            (true, false, _) => found.push(Table {
                section,
                header: cells(line),
                rows: vec![],
            }),
            _ => {}
        }
        open = row;
        if line.starts_with('#') && !code {
            section = line.trim_start_matches('#').trim();
        }
    }
    found
}

/// What stands between backticks.
pub fn inline_code(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// The text outside of fenced blocks and of tables.
pub fn prose(text: &str) -> String {
    let kept = lines(text).filter(|(line, code)| !code && !line.starts_with('|'));
    kept.map(|(line, _)| line).collect::<Vec<_>>().join("\n")
}

#[test]
fn tables_are_read() {
    let text = "# A\n| x | y |\n|---|---|\n| 1 | `b` |\ntext\n```\n# no\n| no |\n```\n## B\n| z |\n|--:|\n| 2 |\n";
    let tables = tables(text);
    let sections: Vec<_> = tables.iter().map(|t| t.section).collect();
    assert_eq!(sections, ["A", "B"]);
    assert_eq!(tables[0].header, ["x", "y"]);
    assert_eq!(tables[0].rows, [["1", "`b`"]]);
    assert_eq!(tables[1].rows, [["2"]]);
    assert_eq!(prose(text), "# A\ntext\n## B");
    assert_eq!(inline_code("a `b` c `d`").collect::<Vec<_>>(), ["b", "d"]);
}
