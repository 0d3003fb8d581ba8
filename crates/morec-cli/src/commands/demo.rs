//! `morec demo`: trains, recognises and measures on a few clips, and prints the commands that do it.

mod cast;
mod folder;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Parser;
use morec::import::ImportOptions;
use morec::labels::Mark;
use morec::labels::{ClipLength, Labels, read_detections};
use morec::live::Detection;

use super::{evaluate, recognize, train};
use crate::files::{ReadArgs, takes};
use crate::show::{self, ShownClip};
use cast::Cast;
use folder::DemoFolder;

/// Try everything in a few seconds, without your own clips.
///
/// Unpacks clips of two basketball referees, other motion and labels; trains an index; recognises another recording,
/// plays it in the terminal, and measures. Each step is printed as a command that you can repeat with your own clips.
///
/// The clips were obtained from mocap.cs.cmu.edu; the database was created with funding from NSF EIA-0196217. With
/// --synthetic, seven synthetic people perform eight gestures instead, which takes about a minute.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 all done; 1 something failed, the message says what; 2 wrong command line."
)]
pub struct Args {
    /// Folder for everything: new, empty, or of an earlier demo
    #[arg(long, value_name = "DIR", default_value = "morec-demo")]
    folder: std::path::PathBuf,
    /// Play the stream N times as fast
    #[arg(long, value_name = "TIMES", default_value = "4", value_parser = speed)]
    speed: f64,
    /// Use synthetic people
    #[arg(long)]
    synthetic: bool,
    /// Print what was recognised instead of playing it
    #[arg(long)]
    quiet: bool,
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
    let cast = match args.synthetic {
        true => cast::synthetic()?,
        #[cfg(feature = "demo-clips")]
        false => cast::real(),
        #[cfg(not(feature = "demo-clips"))]
        false => bail!(
            "this morec was built without the clips of real people (feature demo-clips): use `morec demo --synthetic`"
        ),
    };
    println!("{}", cast.title);
    folder.write(&cast)?;
    println!("{}", folder.contents(&cast));

    let codes = [
        step("2. Training", &folder.train(&cast), train::run)?,
        step(
            "3. Recognising the new clip",
            &folder.recognize(),
            recognize::run,
        )?,
    ];
    show(&folder, &cast, args)?;
    let measured = step("4. Measuring", &folder.evaluate(), evaluate::run)?;
    println!(
        "\n{}\nThe demo took {:.0} s.",
        folder.farewell(&cast),
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
struct CommandLine<A: clap::Args> {
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
    let line =
        CommandLine::<A>::try_parse_from(&words[1..]).context("a command of the demo's own")?;
    let begun = Instant::now();
    let code = run(&line.args)?;
    println!("({:.1} s)", begun.elapsed().as_secs_f64());
    Ok(code)
}

/// Plays the new clip with what was found in it, both read back from their files.
fn show(folder: &DemoFolder, cast: &Cast, args: &Args) -> Result<()> {
    let path = folder.path(&cast.clip);
    let takes = takes(&path, &ReadArgs::default(), &ImportOptions::default())?;
    let Some(take) = takes.first() else {
        bail!("{}: contains no clip", path.display());
    };
    let length = ClipLength::from(&take.clip);
    let lengths = BTreeMap::from([(cast.name.clone(), length)]);
    let said = said(&folder.found(), &lengths)?;
    let table = Labels::from_path(folder.path("truth.tsv"))?;
    let truth = table.resolve(&lengths).samples.into_iter();
    let truth: Vec<Mark> = truth.map(|l| Mark::new(l.class, l.span)).collect();
    let title = format!("{}, {} times as fast", cast.whose, args.speed);
    let scene = ShownClip {
        title: &title,
        clip: &take.clip,
        truth: &truth,
        said: &said,
    };
    println!(
        "\nThe {:.0} s of {}, with the time of each report:\n",
        take.clip.duration_secs(),
        cast.whose
    );
    match args.quiet {
        true => show::write_events(&scene, &mut crate::console::stdout()),
        false => show::play(&scene, args.speed),
    }
    .context("showing the stream")
}

/// The detections in the table `path`, in the order they were reported.
fn said(path: &Path, lengths: &BTreeMap<String, ClipLength>) -> Result<Vec<Detection<String>>> {
    let shown = || path.display().to_string();
    let table = read_detections(&std::fs::read(path).with_context(shown)?).with_context(shown)?;
    let (found, _) = table.resolve(lengths);
    let mut said: Vec<Detection<String>> = found
        .into_iter()
        .map(|f| Detection {
            class: f.class,
            span: f.span,
            score: f.score.unwrap_or(1.0),
            reported_secs: f.reported_secs.unwrap_or(f.span.stop_secs),
            repetitions: None,
        })
        .collect();
    said.sort_by(|a, b| a.reported_secs.total_cmp(&b.reported_secs));
    Ok(said)
}
