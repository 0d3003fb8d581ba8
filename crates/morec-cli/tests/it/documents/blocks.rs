//! Commands in Markdown.

/// What is to be done with a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Check {
    /// Its commands run.
    Run,
    /// Its options are checked.
    Options,
    /// Its commands need the real clips.
    RealClips,
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
    /// Whether it shows what the commands print (`console`).
    pub shows_output: bool,
    /// What is to be done with it.
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
        let shows_output = kind == "```console";
        let commands = commands(&body, shows_output);
        if commands.contains("morec") || commands.contains("cargo") {
            found.push(Block {
                line: at + 1,
                commands,
                shows_output,
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
        "none" => Check::None,
        other => panic!("line {line}: no check is called {other:?}"),
    }
}

/// The lines that this test runs: commands of morec, with the loops and variables around them.
fn commands(body: &[&str], shows_output: bool) -> String {
    let mut script = String::new();
    let mut lines = body.iter();
    while let Some(line) = lines.next() {
        let first = match shows_output {
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
        <!-- check: options -->\n```console\n$ morec e\noutput\n```\n\
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
    assert!(found[1].shows_output && !found[0].shows_output);
    assert_eq!(of(2).1, Check::None);
    assert_eq!(of(3).1, Check::RealClips);
}
