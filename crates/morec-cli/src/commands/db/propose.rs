//! `morec db propose`: proposes more samples of labelled classes, and accepts or rejects them by score.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Result;
use morec::TimeSpan;
use morec_db::labels::{JudgedCounts, SampleFilter, SampleState};
use morec_db::{ClipFilter, ClipId, MotionDb, Proposal, most_informative};
use morec_ops::{ProposeSettings, share};
use serde::Serialize;

use crate::database;
use crate::print;
use crate::progress::StageBar;
use crate::table::TextTable;

/// Propose more samples of the labelled classes
///
/// Searches all clips for motions like the accepted samples and keeps the hits as proposals with their probability.
/// Accept confident proposals in bulk and check doubtful proposals one by one. Accepted proposals train the next round; rejected
/// proposals count against similar motions and are not proposed again. Proposals of earlier calls that were neither accepted nor
/// rejected are replaced; proposals from `morec group --name-as` and from files are kept.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  morec db propose moves.mdb
  morec db propose moves.mdb --accept 0.6             # of this score or more
  morec db propose moves.mdb --list --doubtful        # most informative first
  morec db export moves.mdb ask.csv --state proposed  # edit its column state:
  morec db label moves.mdb ask.csv")]
pub struct Args {
    /// The database
    #[arg(value_name = "DB")]
    db: PathBuf,
    #[command(flatten)]
    settings: ProposeSettings,
    /// Accept existing proposals with at least this score, 0 to 1
    #[arg(long, value_name = "SCORE", value_parser = share)]
    accept: Option<f64>,
    /// Reject existing proposals with less than this score
    #[arg(long, value_name = "SCORE", value_parser = share)]
    reject: Option<f64>,
    /// Only list existing proposals
    #[arg(long)]
    list: bool,
    /// List the most informative proposals first
    ///
    /// The least certain first, alternating between classes. Without --list, after a new round.
    #[arg(long)]
    doubtful: bool,
    /// List at most N
    #[arg(long, value_name = "N", default_value_t = 30)]
    limit: usize,
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

/// Judges, or proposes anew; then lists.
pub fn run(args: &Args) -> Result<ExitCode> {
    if !args.settings.classes.is_empty() {
        args.settings.check(&database::open_read_only(&args.db)?)?;
    }
    if args.accept.is_some() || args.reject.is_some() {
        return judge(args);
    }
    if args.list {
        return list(args, &database::open_read_only(&args.db)?);
    }
    let mut db = database::open(&args.db)?;
    let proposals = args.settings.run(&mut db, &StageBar::stoppable()?)?;
    show(args, &db, proposals)
}

fn proposed(db: &MotionDb) -> Result<Vec<morec_db::labels::DbSample>> {
    Ok(db.samples(&SampleFilter {
        state: Some(SampleState::Proposed),
        ..SampleFilter::default()
    })?)
}

fn judge(args: &Args) -> Result<ExitCode> {
    let mut db = database::open(&args.db)?;
    let judged = db.judge_by_score(&args.settings.classes, (args.accept, args.reject), "user")?;
    if args.json {
        print::print_json(&judged)?;
    } else {
        let JudgedCounts {
            accepted,
            rejected,
            left,
        } = judged;
        print::print(format_args!(
            "{accepted} accepted, {rejected} rejected, {left} left to check\n"
        ))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn list(args: &Args, db: &MotionDb) -> Result<ExitCode> {
    let mut proposals: Vec<Proposal> = proposed(db)?
        .into_iter()
        .map(|s| Proposal {
            clip: s.clip,
            class: s.class,
            span: TimeSpan::new(s.start_secs, s.stop_secs),
            whole_clip: s.whole_clip,
            score: s.score.unwrap_or(0.0) as f32,
        })
        .collect();
    proposals.sort_by(|a, b| b.score.total_cmp(&a.score));
    show(args, db, proposals)
}

#[derive(Serialize)]
struct NamedProposal {
    #[serde(rename = "clip")]
    name: String,
    #[serde(flatten)]
    proposal: Proposal,
}

fn show(args: &Args, db: &MotionDb, mut proposals: Vec<Proposal>) -> Result<ExitCode> {
    let sure = proposals.iter().filter(|p| p.is_sure()).count();
    if args.doubtful {
        let order = most_informative(&proposals, proposals.len());
        proposals = order.into_iter().map(|at| proposals[at].clone()).collect();
    }
    let names: BTreeMap<ClipId, String> = db
        .clips(&ClipFilter::default())?
        .into_iter()
        .map(|c| (c.id, c.name))
        .collect();
    let named = |p: Proposal| NamedProposal {
        name: names.get(&p.clip).cloned().unwrap_or_default(),
        proposal: p,
    };
    let all: Vec<NamedProposal> = proposals.into_iter().map(named).collect();
    if args.json {
        // A new round is printed as a whole; a list is as long as asked for.
        let shown = if args.list { args.limit } else { all.len() };
        print::print_json(&&all[..shown.min(all.len())])?;
        return Ok(ExitCode::SUCCESS);
    }
    let mut table = TextTable::new(["clip", "class", "start", "stop", "score"]).least(["stop"]);
    for NamedProposal { name, proposal: p } in all.iter().take(args.limit) {
        let secs = |secs: f64| format!("{secs:.2}");
        table.row([
            name.clone(),
            p.class.clone(),
            secs(p.span.start_secs),
            secs(p.span.stop_secs),
            format!("{:.2}", p.score),
        ]);
    }
    let more = all.len().saturating_sub(args.limit);
    let more = if more > 0 {
        format!("; {more} not shown")
    } else {
        String::new()
    };
    let last = format!(
        "{} proposed, {sure} of them with a score above 0.5{more}\n",
        all.len()
    );
    print::print_table(&table, &last)?;
    Ok(ExitCode::SUCCESS)
}
