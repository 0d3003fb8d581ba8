//! `morec reproduce`: the thesis's evaluation on the user's clips.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use morec_measure::reproduce::{Reproduction, StageCost, Study, page, reproduce};

use crate::material::MaterialArgs;
use crate::output;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Run the evaluation of the thesis of 2009 on labelled clips.
///
/// Cuts the clips (§5.1), groups the samples (§5.2), classifies cut-out samples (§5.3) and whole streams (§5.4) with trees
/// trained on half of each class, once with the thesis's values (faithful) and once with tuned ones. Writes a page with the
/// thesis's tables beside yours. --param sets parameters of the setting chosen with --svrdm; --method, --everyday, --mirror and
/// --bones apply to the method templates only.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 done; 1 reading or training failed; 2 wrong command line.\n\n\
    Example: morec reproduce --clips referee/clips --labels referee/labels.tsv --classes walk,traveling,no_score \\\n\
    \x20          --unknown exercises/clips -o reproduction/"
)]
pub struct Args {
    /// Test clips without any class: every detection is a false alarm
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    unknown: Vec<PathBuf>,
    /// Seeds of the half splits, separated by commas
    #[arg(long, value_delimiter = ',', value_name = "N", default_values_t = [1, 2])]
    seed: Vec<u64>,
    /// Folder for the page, its JSON, pictures (SVG) and confidence maps (TSV)
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    material: MaterialArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    let material = args.material.load(&args.unknown)?;
    let settings = args.material.settings.both_svrdm()?;
    let study = Study {
        clips: &material.data.clips,
        samples: &material.data.samples,
        classes: &material.data.classes,
        unknown: &material.data.unknown,
        seeds: &args.seed,
        settings: &settings,
    };
    let result = reproduce(&study, &StageBar::new())?;
    // Whoever stops reading what is printed still gets the page.
    write(&args.output, &result, &about(args, &study))?;
    print(&result);
    println!(
        "\n{}: the page, its figures as JSON, {} pictures",
        args.output.display(),
        result.pictures.len()
    );
    Ok(ExitCode::SUCCESS)
}

fn about(args: &Args, study: &Study<'_>) -> Vec<(String, String)> {
    let pair = |name: &str, value: String| (name.to_owned(), value);
    vec![
        pair("labels", args.material.label_source()),
        pair("samples", study.samples.len().to_string()),
        pair("classes", study.classes.join(", ")),
        pair("clips of unknown motion", study.unknown.len().to_string()),
        pair("morec", env!("CARGO_PKG_VERSION").to_owned()),
    ]
}

fn write(folder: &Path, result: &Reproduction, about: &[(String, String)]) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let keep = |name: &str, text: &str| {
        let path = folder.join(name);
        output::write_whole(&path, |out| out.write_all(text.as_bytes()))
            .with_context(|| path.display().to_string())
    };
    keep("reproduction.html", &page(result, about))?;
    keep("reproduction.json", &serde_json::to_string_pretty(result)?)?;
    for picture in &result.pictures {
        // Names come from clips, which may be called anything.
        let safe = |c: char| {
            if c.is_alphanumeric() || "_-.".contains(c) {
                c
            } else {
                '_'
            }
        };
        let name: String = picture.name.chars().map(safe).collect();
        keep(&format!("{name}.svg"), &picture.svg)?;
        if let Some(table) = &picture.table {
            keep(&format!("{name}.tsv"), table)?;
        }
    }
    Ok(())
}

fn print(result: &Reproduction) {
    println!("Clusters by kWAS (§5.2)");
    let mut table = TextTable::new(["", "tau", "clusters", "Rand", "adjusted"]);
    for c in &result.clustering {
        table.row([
            if c.centred { "centred" } else { "as they are" }.to_owned(),
            c.tau.to_string(),
            c.clusters.to_string(),
            format!("{:.3}", c.rand_index),
            format!("{:.3}", c.adjusted_rand_index),
        ]);
    }
    print!("{table}");
    println!("\nCut-out samples (§5.3)");
    let mut table = TextTable::new([
        "",
        "seed",
        "half",
        "T",
        "all P_C",
        "P_E",
        "unseen P_C",
        "P_E",
        "alike, all",
        "unseen",
        "index",
    ]);
    for c in &result.classification {
        table.row([
            c.setting.name().to_owned(),
            c.seed.to_string(),
            if c.complement { "other" } else { "one" }.to_owned(),
            format!("{:.2}", c.accept),
            format!("{:.3}", c.all.p_c),
            format!("{:.3}", c.all.p_e),
            format!("{:.3}", c.unseen.p_c),
            format!("{:.3}", c.unseen.p_e),
            format!("{:.3} / {:.3}", c.alike[0].p_c, c.alike[0].p_e),
            format!("{:.3} / {:.3}", c.alike[1].p_c, c.alike[1].p_e),
            format!("{:.1} KB", c.index_bytes as f64 / 1000.0),
        ]);
    }
    print!("{table}");
    println!("\nStreams (§5.4)");
    let mut table = TextTable::new([
        "",
        "seed",
        "accuracy",
        "F1",
        "false alarms a minute, unknown",
        "delay",
    ]);
    let figure = |v: Option<f64>| v.map_or("–".to_owned(), |v| format!("{v:.3}"));
    for s in &result.streams {
        let e = &s.evaluation;
        table.row([
            s.setting.name().to_owned(),
            s.seed.to_string(),
            figure(e.thesis.accuracy),
            figure(e.f1_at(0.5)),
            figure(e.unknown.per_minute),
            figure(e.delay.median_secs),
        ]);
    }
    print!("{table}");
    println!("\nStages on one thread (Table 5.8): µs a row, share, KB");
    let mut table = TextTable::new(["", "rows a second", "IA", "SA", "FVE", "SC", "SS", "ST"]);
    for p in &result.performance {
        let stage = |s: &StageCost| {
            format!(
                "{:.2}, {:.0} %, {:.0}",
                s.micros,
                100.0 * s.share,
                s.bytes as f64 / 1000.0
            )
        };
        let first = [
            p.setting.name().to_owned(),
            format!("{:.0}", p.rows_per_second),
        ];
        table.row(first.into_iter().chain(p.stages.iter().map(stage)));
    }
    print!("{table}");
    println!("\nThe path of a sample down the tree (Fig. 5.2)");
    for c in result.classification.iter().filter(|c| !c.complement) {
        println!(
            "{}, seed {}: {}",
            c.setting.name(),
            c.seed,
            c.path.join("; ")
        );
    }
}
