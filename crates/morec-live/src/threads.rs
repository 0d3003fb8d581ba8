//! Binding of threads to processor cores.

/// Threads in the order in which frames pass them: neighbours go to neighbouring cores.
const STAGES: [&str; 7] = [
    "source",
    "input",
    "segments",
    "extraction",
    "classification",
    "scoring",
    "tracking",
];

/// Ties this thread, which is that of stage `what`, to a core: for
/// [`SessionOptions::on_thread`](morec::live::SessionOptions::on_thread). Where the system allows no such thing, the thread goes where it is sent.
pub fn pin_thread(what: &'static str) {
    let (Some(stage), Some(cores)) = (
        STAGES.iter().position(|stage| *stage == what),
        core_affinity::get_core_ids(),
    ) else {
        return;
    };
    if let Some(core) = cores.get(stage % cores.len().max(1)) {
        core_affinity::set_for_current(*core);
    }
}
