//! The table of missed samples with the reasons.

use std::collections::BTreeMap;

use super::html::{Text, unfolding};
use crate::explain::Miss;

/// Rows that are shown at once; the others unfold.
const SHOWN: usize = 12;

pub(super) fn push(out: &mut String, misses: &[Miss]) {
    if misses.is_empty() {
        return;
    }
    out.push_str("<h2>Why samples were missed</h2>\n");
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for miss in misses {
        *counts.entry(miss.reason.kind()).or_default() += 1;
    }
    let mut counts: Vec<(&str, usize)> = counts.into_iter().collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let counted: Vec<String> = counts
        .iter()
        .map(|(kind, count)| format!("{kind} {count}"))
        .collect();
    out.push_str(&format!(
        "<p class=\"small\">{} samples: {}.</p>\n",
        misses.len(),
        counted.join(", ")
    ));
    unfolding(out, misses, SHOWN, push_table);
}

fn push_table(out: &mut String, misses: &[Miss]) {
    out.push_str(
        "<div class=\"wide\"><table>\n<tr><th scope=\"col\">clip</th><th>class</th><th>start</th><th>stop</th>\
         <th>why</th><th>found at sensitivity</th></tr>\n",
    );
    for miss in misses {
        let at = miss
            .sensitivity
            .map_or("–".to_owned(), |rate| rate.to_string());
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.2} s</td><td>{:.2} s</td><td class=\"text\">{}</td>\
             <td>{at}</td></tr>\n",
            Text(&miss.clip),
            Text(&miss.class),
            miss.span.start_secs,
            miss.span.stop_secs,
            Text(&miss.reason.to_string()),
        ));
    }
    out.push_str("</table></div>\n");
}
