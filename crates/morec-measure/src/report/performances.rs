//! How well motions were performed: the angle from the nearest sample over time, and the bones that differ most.

use super::html::{Text, unfolding};
use crate::explain::{BoneDeviation, Performance};
use crate::plot::Chart;

const WIDTH: usize = 560;
const HEIGHT: usize = 220;
/// Performances that are drawn: those farthest off. The table has all.
const DRAWN: usize = 6;
/// Rows of the table that are shown at once; the others unfold.
const SHOWN: usize = 12;
/// Bones of a performance that are listed.
const BONES: usize = 6;
/// Pixels of a degree in the bars of bones, and the longest bar.
const DEGREE: f64 = 3.0;
const LONGEST: f64 = 270.0;

pub(super) fn push(out: &mut String, performances: &[Performance]) {
    if performances.is_empty() {
        return;
    }
    out.push_str(
        "<h2>How well motions were performed</h2>\n<p class=\"small\">Each correctly recognised motion is compared with the nearest \
         sample of its class: the mean angle between their bones, aligned in time. The motion with the largest angle comes \
         first.</p>\n",
    );
    let mut sorted: Vec<&Performance> = performances.iter().collect();
    sorted.sort_by(|a, b| b.deviation.off_degrees.total_cmp(&a.deviation.off_degrees));
    for performance in sorted.iter().take(DRAWN) {
        push_figure(out, performance);
    }
    unfolding(out, &sorted, SHOWN, push_table);
}

/// A bone's name in words.
fn words(bone: &BoneDeviation) -> String {
    bone.bone.replace('_', " ")
}

fn push_figure(out: &mut String, performance: &Performance) {
    let Performance {
        clip,
        class,
        span,
        deviation,
    } = performance;
    out.push_str(&format!(
        "<figure class=\"performance\"><figcaption><b>{}</b> in {}, {:.2} to {:.2} s: {:.0}° off on average, in \
         {:.2} times the sample's duration</figcaption>\n",
        Text(class),
        Text(clip),
        span.start_secs,
        span.stop_secs,
        deviation.off_degrees,
        deviation.pace,
    ));
    let chart = Chart::new(format!("{class}: angle from the nearest sample over time"))
        .axes("seconds of the clip", "degrees off")
        .size(WIDTH, HEIGHT)
        .line("all bones", deviation.curve(*span))
        .line("", [(span.start_secs, 0.0)]);
    let worst = deviation.worst(*span);
    let chart = chart.marks("worst moment", worst.map(|(secs, _)| secs));
    out.push_str(&chart.svg());
    out.push_str(
        "<table>\n<tr><th scope=\"col\">bone</th><th>off</th><th></th><th>most</th><th>at</th></tr>\n",
    );
    for bone in deviation.bones.iter().take(BONES) {
        let long = (bone.off_degrees * DEGREE).min(LONGEST);
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{:.0}°</td><td class=\"level\"><i style=\"width:{long:.0}px\"></i></td><td>{:.0}°</td>\
             <td>{:.2} s</td></tr>\n",
            words(bone),
            bone.off_degrees,
            bone.worst_degrees,
            bone.worst_secs
        ));
    }
    out.push_str("</table></figure>\n");
}

fn push_table(out: &mut String, performances: &[&Performance]) {
    out.push_str(
        "<div class=\"wide\"><table>\n<tr><th scope=\"col\">clip</th><th>class</th><th>start</th><th>stop</th><th>off</th>\
         <th>duration over the sample's</th><th>farthest off</th><th>most</th><th>at</th></tr>\n",
    );
    for performance in performances {
        let Some(bone) = performance.deviation.bones.first() else {
            continue;
        };
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.2} s</td><td>{:.2} s</td><td>{:.1}°</td><td>{:.2}</td><td>{}</td>\
             <td>{:.0}°</td><td>{:.2} s</td></tr>\n",
            Text(&performance.clip),
            Text(&performance.class),
            performance.span.start_secs,
            performance.span.stop_secs,
            performance.deviation.off_degrees,
            performance.deviation.pace,
            words(bone),
            bone.worst_degrees,
            bone.worst_secs
        ));
    }
    out.push_str("</table></div>\n");
}
