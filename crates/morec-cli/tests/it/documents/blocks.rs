//! Commands in Markdown.

/// Kind of check of a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Check {
    /// Its commands run.
    Run,
    /// Its options are checked.
    Options,
    /// Its commands need the real clips.
    RealClips,
    /// Its commands run; on the real clips they print what the block shows.
    Output,
    /// Its commands run, and print what the block shows, whatever clips there are.
    OutputEverywhere,
    /// Nothing.
    None,
}

/// A fenced block with commands.
#[derive(Debug, PartialEq)]
pub struct Block {
    /// The line of its fence, from 1.
    pub line: usize,
    /// Its commands, as a shell script.
    pub commands: String,
    /// Output of the commands, line by line, if the block shows it (`console`): without omissions, and without sizes of
    /// files, which depend on the names of folders.
    pub output: Vec<String>,
    /// Its kind of check.
    pub check: Check,
}

/// All blocks of a document that hold a command of morec.
pub fn blocks(text: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut before = "";
    let mut lines = text.lines().enumerate();
    while let Some((at, line)) = lines.next() {
        let kind = match line.trim() {
            "```sh" | "```console" => line.trim(),
            other if other.starts_with("```") => {
                lines.by_ref().find(|(_, l)| l.trim() == "```");
                continue;
            }
            other => {
                before = other;
                continue;
            }
        };
        let body: Vec<&str> = lines
            .by_ref()
            .map(|(_, line)| line)
            .take_while(|line| line.trim() != "```")
            .collect();
        let console = kind == "```console";
        let commands = commands(&body, console);
        if commands.contains("morec") || commands.contains("cargo") {
            found.push(Block {
                line: at + 1,
                commands,
                output: output(&body, console),
                check: check(before, at + 1),
            });
        }
        before = "";
    }
    found
}

/// The marker on the line above a fence.
fn check(before: &str, line: usize) -> Check {
    let Some(marker) = before.strip_prefix("<!-- check:") else {
        return Check::Run;
    };
    match marker.trim_end_matches("-->").trim() {
        "options" => Check::Options,
        "real clips" => Check::RealClips,
        "output" => Check::Output,
        "output everywhere" => Check::OutputEverywhere,
        "none" => Check::None,
        other => panic!("line {line}: no check is called {other:?}"),
    }
}

/// The lines that this test runs: commands of morec, with the loops and variables around them.
fn commands(body: &[&str], console: bool) -> String {
    let mut script = String::new();
    let mut lines = body.iter();
    while let Some(line) = lines.next() {
        let first = match console {
            true => line.strip_prefix("$ "),
            false => Some(line.trim_start()),
        };
        let Some(first) = first else { continue };
        let mut command = first.to_owned();
        while command.ends_with('\\') {
            command.pop();
            command.push_str(lines.next().map_or("", |next| next.trim_start()));
        }
        if is_run(&command) {
            script.push_str(&command);
            script.push('\n');
        }
    }
    script
}

/// The lines that a block shows as printed.
fn output(body: &[&str], console: bool) -> Vec<String> {
    body.iter()
        .filter(|line| console && !line.starts_with("$ "))
        .map(|line| line.trim().to_owned())
        .filter(|line| !line.is_empty() && line != "…" && !line.contains(" bytes"))
        .collect()
}

fn is_run(command: &str) -> bool {
    let word = command.split_whitespace().next().unwrap_or("");
    let assigns = word
        .split_once('=')
        .is_some_and(|(name, _)| name.chars().all(|c| c.is_ascii_alphabetic() || c == '_'));
    matches!(word, "morec" | "for" | "done")
        || command.starts_with("cargo run")
        || command.contains("| morec ")
        || assigns
}

#[test]
fn blocks_are_found_with_their_markers() {
    let text = "text\n```sh\ncargo test\n```\n\
        ```sh\nX=1 Y=2\nfor i in 1 2; do\n    morec a \\\n        -b $i   # c\ndone\ngit clone x\ncat a | morec d -\n```\n\
        <!-- check: options -->\n```console\n$ morec e\n out put\n…\nx: 9 bytes\n```\n\
        ```c\n```\n\
        <!-- check: none -->\n```sh\nmorec f\n```\n\
        <!-- check: real clips -->\n```sh\nmorec g\n```\n";
    let found = blocks(text);
    let of = |n: usize| (found[n].commands.as_str(), found[n].check);
    assert_eq!(found.len(), 4);
    assert_eq!(
        of(0),
        (
            "X=1 Y=2\nfor i in 1 2; do\nmorec a -b $i   # c\ndone\ncat a | morec d -\n",
            Check::Run
        )
    );
    assert_eq!(of(1), ("morec e\n", Check::Options));
    assert_eq!(found[1].output, ["out put"]);
    assert!(found[0].output.is_empty());
    assert_eq!(of(2).1, Check::None);
    assert_eq!(of(3).1, Check::RealClips);
}
