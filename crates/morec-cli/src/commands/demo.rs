//! `morec demo`: the whole job on made people, with the commands that do it.

mod folder;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Parser;
use morec::import::{ImportOptions, normalize};
use morec::labels::{ClipLength, read_found};
use morec::synth::{DatabaseSpec, SyntheticTake, database};

use super::{evaluate, recognize, train};
use crate::files::{ReadArgs, open};
use crate::show::{self, Said, Scene, Truth};
use folder::DemoFolder;

/// See the whole job in about a minute, without a clip of your own.
///
/// Makes clips of several synthetic people who perform eight gestures with other motions in between, and their
/// labels; trains an index on all people but one, which takes most of the time; recognises the stream of the one it
/// has never seen, shows it in the terminal, and measures. Each step is printed as the command that does it, to be
/// repeated with clips of your own.
///
/// The people are made, not recorded: figures measured on them say nothing about accuracy on real people.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 all done; 1 something failed, the message says what; 2 wrong command line."
)]
pub struct Args {
    /// Where to put everything; a folder that is not empty must be an earlier demo's
    #[arg(long, value_name = "DIR", default_value = "morec-demo")]
    folder: std::path::PathBuf,
    /// Play the stream so many times as fast as it was performed
    #[arg(long, value_name = "TIMES", default_value = "4", value_parser = speed)]
    speed: f64,
    /// Print what was recognised instead of playing the stream, as without a terminal
    #[arg(long)]
    quiet: bool,
}

/// Seed of the people, chosen for nothing but being the year of the thesis.
const SEED: u64 = 2009;

/// Seven people, the last of whom is not trained on; every class twice a stream.
fn spec() -> DatabaseSpec {
    DatabaseSpec {
        people: 7,
        repetitions: 2,
        ..DatabaseSpec::default()
    }
}

fn speed(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(speed) if (0.1..=1000.0).contains(&speed) => Ok(speed),
        _ => Err("expected a number from 0.1 to 1000".to_owned()),
    }
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let begun = Instant::now();
    let folder = DemoFolder::claim(&args.folder)?;
    let mut takes = timed("1. Making people and filming them", || {
        Ok(database(SEED, &spec()))
    })?;
    let Some(unseen) = takes.pop() else {
        bail!("nobody to show")
    };
    folder.write(&takes, &unseen)?;
    println!("{}", folder.contents(&takes, &unseen));

    let codes = [
        step(
            "2. Training on all of them but one",
            &folder.train(),
            train::run,
        )?,
        step(
            "3. Recognising the one never seen",
            &folder.recognize(),
            recognize::run,
        )?,
    ];
    show(&folder, &unseen, args)?;
    let measured = step("4. Measuring", &folder.evaluate(), evaluate::run)?;
    println!(
        "\n{}\nAll of it took {:.0} s.",
        folder.farewell(),
        begun.elapsed().as_secs_f64()
    );
    let failed = codes
        .into_iter()
        .chain([measured])
        .find(|code| *code != ExitCode::SUCCESS);
    Ok(failed.unwrap_or(ExitCode::SUCCESS))
}

/// A command's arguments alone on a line.
#[derive(Parser)]
#[command(no_binary_name = true)]
struct Line<A: clap::Args> {
    #[command(flatten)]
    args: A,
}

/// Prints a command and runs it, from the very words printed. `words` begin with the command's name.
fn step<A: clap::Args>(
    title: &str,
    words: &[OsString],
    run: impl FnOnce(&A) -> Result<ExitCode>,
) -> Result<ExitCode> {
    println!("\n{title}\n$ {}\n", folder::shell_line(words));
    let line = Line::<A>::try_parse_from(&words[1..]).context("a command of the demo's own")?;
    let begun = Instant::now();
    let code = run(&line.args)?;
    println!("({:.1} s)", begun.elapsed().as_secs_f64());
    Ok(code)
}

fn timed<T>(title: &str, job: impl FnOnce() -> Result<T>) -> Result<T> {
    println!("{title}");
    let begun = Instant::now();
    let result = job()?;
    println!("({:.1} s)", begun.elapsed().as_secs_f64());
    Ok(result)
}

/// Plays the unseen person's clip with what was found in it, both read back from their files.
fn show(folder: &DemoFolder, take: &SyntheticTake, args: &Args) -> Result<()> {
    let path = folder.clip(take, true);
    let Some(clip) = open(&path, &ReadArgs::default())?.clips.pop() else {
        bail!("{}: holds no clip", path.display());
    };
    let clip = normalize(clip, &ImportOptions::default())?.clip;
    let length = ClipLength {
        frames: clip.frames,
        rate_hz: clip.rate_hz,
    };
    let said = said(&folder.found(), &take.clip.name, length)?;
    let truth = |l: &morec::synth::Label| Truth {
        class: l.class.to_owned(),
        start_secs: l.start_secs,
        stop_secs: l.stop_secs,
    };
    let truth: Vec<Truth> = take.labels.iter().map(truth).collect();
    let title = format!(
        "{}, never seen before, {} times as fast",
        take.person, args.speed
    );
    let scene = Scene {
        title: &title,
        clip: &clip,
        truth: &truth,
        said: &said,
    };
    let secs = clip.duration_secs();
    println!(
        "\nThe {secs:.0} s of {}'s stream, and what was said about it when:\n",
        take.person
    );
    match args.quiet {
        true => show::write_events(&scene, &mut std::io::stdout().lock()),
        false => show::play(&scene, args.speed),
    }
    .context("showing the stream")
}

/// The detections in the table `path`, in the order they were reported.
fn said(path: &Path, clip: &str, length: ClipLength) -> Result<Vec<Said>> {
    let shown = || path.display().to_string();
    let table = read_found(&std::fs::read(path).with_context(shown)?).with_context(shown)?;
    let (found, _) = table.resolve(&[(clip.to_owned(), length)].into());
    let mut said: Vec<Said> = found
        .into_iter()
        .map(|f| Said {
            class: f.class,
            start_secs: f.start_secs,
            stop_secs: f.stop_secs,
            score: f.score.unwrap_or(1.0),
            reported_secs: f.reported_secs.unwrap_or(f.stop_secs),
        })
        .collect();
    said.sort_by(|a, b| a.reported_secs.total_cmp(&b.reported_secs));
    Ok(said)
}
