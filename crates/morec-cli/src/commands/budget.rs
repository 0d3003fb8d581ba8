//! `morec budget`: how the time of clips is divided among classes.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use morec::labels::{ClassBudget, ClassTransitions, TimeBudget, read_people};
use morec_db::ClipFilter;
use morec_db::labels::SampleFilter;
use morec_measure::plot::HeatMap;
use morec_ops::time_budget;

use crate::commands::db::page::Page;
use crate::database;
use crate::files::{self, ReadArgs};
use crate::json::write_json;
use crate::labels::{self, LabelArgs};
use crate::lengths::lengths_of;
use crate::output;
use crate::table::TextTable;

/// Measure how much time each class takes
///
/// For each class, and for each person: number of labels, total and mean duration, share of the clips' duration, labels a minute;
/// then which class follows which in the same clip. Clips without labels do not count.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec budget labels.tsv --clips clips/
  morec budget day1.boris --clips clips/ --plot budget.svg
  morec budget moves.mdb --report budget.html

Exit codes: 0 measured; 1 a file cannot be read or there is no label; 2 wrong command line.")]
pub struct Args {
    /// Labels in any form that is read, or a database
    #[arg(value_name = "LABELS|DB")]
    labels: PathBuf,
    /// The labelled clips, for their frame rates and lengths
    ///
    /// Without them, labels must be in seconds, and a clip ends with its last label.
    #[arg(long, value_name = "DIR|CLIP", num_args = 1..)]
    clips: Vec<PathBuf>,
    /// Persons of clips: a table with columns clip and person
    ///
    /// Or give the labels a column person.
    #[arg(long, value_name = "TSV")]
    people: Option<PathBuf>,
    /// Draw each person's share of time by class as SVG
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,
    /// File to write: a table of classes, people and transitions, or the same as JSON
    #[arg(short, long, value_name = "TSV|JSON")]
    output: Option<PathBuf>,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
    /// Write a page of HTML with the tables and that picture too
    #[arg(long, value_name = "HTML")]
    report: Option<PathBuf>,
    #[command(flatten)]
    reading: LabelArgs,
    #[command(flatten)]
    read: ReadArgs,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(path) = &args.plot {
        output::check_picture(path)?;
    }
    if let Some(path) = &args.report {
        output::check_page(path)?;
    }
    if let Some(path) = &args.output {
        output::check_ending(path, "a table or JSON", &["tsv", "json"])?;
    }
    let budget = match database::only(std::slice::from_ref(&args.labels))? {
        Some(path) => of_database(path)?,
        None => of_labels(args)?,
    };
    if budget.clips == 0 {
        bail!("{}: no label in any clip", args.labels.display());
    }
    if let Some(path) = &args.plot {
        let svg = picture(&budget).svg();
        output::write_whole(path, |out| out.write_all(svg.as_bytes()))
            .with_context(|| path.display().to_string())?;
    }
    if let Some(path) = &args.output {
        let is_json = path.extension().is_some_and(|ending| ending == "json");
        output::write_whole(path, |mut out| match is_json {
            true => write_json(&mut out, &budget),
            false => out.write_all(budget.tsv().as_bytes()),
        })
        .with_context(|| path.display().to_string())?;
    }
    let tables = BudgetTables::of(&budget);
    if let Some(path) = &args.report {
        tables.write_page(path, &budget)?;
    }
    let mut out = crate::console::stdout();
    match args.json {
        true => write_json(&mut out, &budget)?,
        false => tables.write(&mut out)?,
    }
    out.flush()?;
    Ok(ExitCode::SUCCESS)
}

fn of_database(path: &Path) -> Result<TimeBudget> {
    let db = database::open_read_only(path)?;
    let samples = db.samples(&SampleFilter::default())?;
    let clips = db.clips(&ClipFilter::default())?;
    Ok(time_budget(&samples, &clips))
}

fn of_labels(args: &Args) -> Result<TimeBudget> {
    let path = &args.labels;
    let mut labels = labels::read(path, &args.reading, &args.clips)?;
    if let Some(table) = &args.people {
        let people = read_people(&files::read(table)?);
        labels.add_people(&people.with_context(|| table.display().to_string())?);
    }
    if args.clips.is_empty() {
        eprintln!("morec: without --clips, each clip ends with its last label");
    }
    let lengths = lengths_of(&args.clips, &args.read, &[(path, &labels)])?;
    let resolved = labels.resolve(&lengths);
    for warning in labels.warnings.iter().chain(&resolved.warnings) {
        eprintln!("morec: {}: {warning}", path.display());
    }
    Ok(TimeBudget::of(&resolved.samples, &lengths))
}

/// The budget in words and tables, for the terminal and the page.
struct BudgetTables {
    head: String,
    classes: TextTable,
    /// Which class follows which, if any does.
    transitions: Option<TextTable>,
}

const TRANSITIONS: &str = "Next label in the same clip, rows followed by columns";

impl BudgetTables {
    fn of(budget: &TimeBudget) -> Self {
        let TimeBudget {
            clips,
            secs,
            unlabelled_secs,
            ..
        } = budget;
        let plural = if *clips == 1 { "" } else { "s" };
        Self {
            head: format!(
                "{clips} clip{plural}, {secs:.1} s; {unlabelled_secs:.1} s without a label ({})",
                percent(unlabelled_secs / secs.max(f64::MIN_POSITIVE))
            ),
            classes: class_table(budget),
            transitions: transition_table(&budget.transitions),
        }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        write!(out, "{}\n\n{}", self.head, self.classes)?;
        match &self.transitions {
            Some(table) => write!(out, "\n{TRANSITIONS}\n{table}"),
            None => Ok(()),
        }
    }

    fn write_page(&self, path: &Path, budget: &TimeBudget) -> Result<()> {
        let mut page = Page::default();
        page.heading("Time of each class");
        page.drawing(&picture(budget).svg());
        page.table(&self.classes);
        if let Some(table) = &self.transitions {
            page.heading(TRANSITIONS);
            page.table(table);
        }
        page.write(path, "Time budget", &self.head)?;
        eprintln!("morec: report: {}", path.display());
        Ok(())
    }
}

fn class_table(budget: &TimeBudget) -> TextTable {
    let mut table = TextTable::new([
        "class", "person", "labels", "total s", "mean s", "share", "a minute",
    ]);
    let mut add = |person: &str, class: &ClassBudget| {
        table.row([
            class.class.clone(),
            person.to_owned(),
            class.count.to_string(),
            format!("{:.1}", class.total_secs),
            format!("{:.2}", class.mean_secs),
            percent(class.share),
            format!("{:.2}", class.per_minute),
        ]);
    };
    for class in &budget.classes {
        add("all", class);
        for person in &budget.people {
            let of_person = person.classes.iter().find(|c| c.class == class.class);
            of_person.into_iter().for_each(|c| add(&person.person, c));
        }
    }
    table
}

fn transition_table(transitions: &ClassTransitions) -> Option<TextTable> {
    if transitions.counts.iter().flatten().all(|count| *count == 0) {
        return None;
    }
    let mut header = vec![String::new()];
    header.extend(transitions.classes.iter().cloned());
    let mut table = TextTable::with_header(header);
    for (class, counts) in transitions.classes.iter().zip(&transitions.counts) {
        let counts = counts.iter().map(|count| match count {
            0 => "–".to_owned(),
            count => count.to_string(),
        });
        table.row([class.clone()].into_iter().chain(counts));
    }
    Some(table)
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Shares of time in percent, a row for all and one for each person.
fn picture(budget: &TimeBudget) -> HeatMap {
    let names: Vec<String> = budget.classes.iter().map(|c| c.class.clone()).collect();
    let people = || budget.people.iter();
    let rows = std::iter::once(&budget.classes).chain(people().map(|p| &p.classes));
    let shares = rows.flat_map(|classes| {
        let of = |name: &String| classes.iter().find(|c| c.class == *name);
        names.iter().map(move |name| {
            let share = of(name).map_or(0.0, |c| 100.0 * c.share);
            (10.0 * share).round() / 10.0
        })
    });
    let rows = std::iter::once("all".to_owned()).chain(people().map(|p| p.person.clone()));
    let title = "Share of the clips' duration, percent";
    HeatMap::new(title, names.len(), shares.collect::<Vec<_>>())
        .names(rows.collect(), names.clone())
        .with_values()
}
