//! `morec db indexes`: lists, writes and removes the indexes stored in a database.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};

use crate::database;
use crate::dates;
use crate::output;
use crate::print;
use crate::table::TextTable;

/// List kept indexes, write one to a file, or remove one
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db indexes moves.mdb
  morec db indexes moves.mdb --write moves -o moves.index
  morec recognize moves.index new/
  morec db indexes moves.mdb --remove moves")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    /// Write this index to the file of --output
    #[arg(long, value_name = "NAME", requires = "output")]
    write: Option<String>,
    /// File to write it to
    #[arg(short, long, value_name = "INDEX", requires = "write")]
    output: Option<PathBuf>,
    /// Remove this index
    #[arg(long, value_name = "NAME", conflicts_with = "write")]
    remove: Option<String>,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Writes or removes, then lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    if let Some(name) = &args.remove {
        database::open(&args.db)?.remove_index(name)?;
    }
    let db = database::open_read_only(&args.db)?;
    if let (Some(name), Some(path)) = (&args.write, &args.output) {
        let bytes = db.index(name)?;
        output::check_index(path)?;
        output::write_whole(path, |out| out.write_all(&bytes))
            .with_context(|| path.display().to_string())?;
    }
    let indexes = db.indexes()?;
    if args.json {
        print::print_json(&indexes)?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut table = TextTable::new(["index", "trained", "samples", "kB", ""]).least(["kB"]);
    for index in &indexes {
        let stale = "labels have changed since";
        table.row([
            index.name.clone(),
            dates::to_the_second(index.trained_secs),
            index.samples.to_string(),
            format!("{:.1}", index.bytes as f64 / 1e3),
            if index.stale { stale } else { "" }.to_owned(),
        ]);
    }
    print::print_table(&table, &format!("{} indexes\n", indexes.len()))?;
    Ok(ExitCode::SUCCESS)
}
