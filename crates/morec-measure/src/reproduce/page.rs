//! The evaluation as one page of HTML, table by table beside what the thesis prints.

use crate::plot::Text;
use crate::report::STYLE;

use super::classification::Rates;
use super::{Picture, Reproduction, thesis};

/// The page. Pictures are inside; `about` are pairs of name and value that say how it came about.
pub fn page(result: &Reproduction, about: &[(String, String)]) -> String {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n\
         <title>Reproduction</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <h1>The evaluation of 2009, reproduced</h1>\n<dl class=\"about\">\n"
    );
    for (name, value) in about {
        out.push_str(&format!(
            "<div><dt>{}</dt><dd>{}</dd></div>\n",
            Text(name),
            Text(value)
        ));
    }
    out.push_str(
        "</dl>\n<p>Bucur, <i>Efficient Motion Capture Database Indexing on the Cell Processor</i>, Trinity College Dublin \
         2009, chapter 5. The thesis had other clips, other labels and 11 classes, so figures agree in \
         size at best. <b>Faithful</b> keeps every parameter of the thesis, <b>tuned</b> changes some of them \
         (docs/parameters.md).</p>\n",
    );
    push_classes(&mut out, result);
    push_segmentation(&mut out, result);
    push_clustering(&mut out, result);
    push_classification(&mut out, result);
    push_streams(&mut out, result);
    push_performance(&mut out, result);
    super::unlabelled::push(&mut out, &result.unlabelled);
    out.push_str("</body>\n</html>\n");
    out
}

fn push_classes(out: &mut String, result: &Reproduction) {
    out.push_str(
        "<h2>Classes (Table 5.1)</h2>\n<p>The middle length is the mean of the shortest and the longest in the thesis, here \
         the median.</p>\n<div class=\"wide\"><table>\n<tr><th></th><th>class</th><th>shortest, s</th><th>middle, s</th>\
         <th>longest, s</th><th>samples</th><th>people</th></tr>\n",
    );
    let mut row = |of: &str, class: &str, [a, b, c]: [f64; 3], samples: usize, people: usize| {
        out.push_str(&format!(
            "<tr><th scope=\"row\">{of}</th><td>{}</td><td>{a:.3}</td><td>{b:.3}</td><td>{c:.3}</td><td>{samples}</td>\
             <td>{people}</td></tr>\n",
            Text(class)
        ));
    };
    for (class, secs, samples, people) in thesis::CLASSES {
        row("thesis", class, secs, samples, people);
    }
    for class in &result.classes {
        let secs = [class.shortest_secs, class.median_secs, class.longest_secs];
        row("here", &class.class, secs, class.samples, class.people);
    }
    out.push_str("</table></div>\n");
}

fn push_performance(out: &mut String, result: &Reproduction) {
    out.push_str(
        "<h2>Performance (Table 5.8)</h2>\n<p>The thesis ran each stage on a processor of its own and printed the size of its \
         code and data and its clocks per instruction. Here one thread runs all stages: the table has the time of each for a \
         row at the model's rate, and the bytes that it reads and writes.</p>\n<div class=\"wide\"><table>\n\
         <tr><th></th><th>stage</th><th>KB</th><th>clocks per instruction</th><th>µs a row</th><th>share</th></tr>\n",
    );
    for (stage, kb, cpi) in thesis::STAGES {
        out.push_str(&format!(
            "<tr><th scope=\"row\">thesis</th><td>{stage}</td><td>{kb:.2}</td><td>{cpi:.2}</td><td>–</td><td>–</td></tr>\n"
        ));
    }
    for of in &result.performance {
        for stage in &of.stages {
            out.push_str(&format!(
                "<tr><th scope=\"row\">{}</th><td>{}</td><td>{:.2}</td><td>–</td><td>{:.3}</td><td>{:.1} %</td></tr>\n",
                of.setting.name(),
                stage.stage,
                stage.bytes as f64 / 1000.0,
                stage.micros,
                100.0 * stage.share
            ));
        }
    }
    out.push_str("</table></div>\n<p>Rows a second: ");
    out.push_str(&format!(
        "thesis {:.0} on six processors",
        thesis::FRAMES_PER_SECOND
    ));
    for of in &result.performance {
        out.push_str(&format!(
            ", {} {:.0}",
            of.setting.name(),
            of.rows_per_second
        ));
    }
    out.push_str(" on one.</p>\n");
}

fn push_segmentation(out: &mut String, result: &Reproduction) {
    out.push_str(
        "<h2>Segmentation (§5.1)</h2>\n<p>As the thesis states, repeated motions are not separated, and \
         transitions stay inside segments. A sample has a segment of its own if they share more than half of \
         the longer of the two.</p>\n<div class=\"wide\"><table>\n<tr><th>clip</th><th>length</th><th>samples</th>\
         <th>cuts</th><th>samples with a segment of their own</th></tr>\n",
    );
    for s in &result.segmentation {
        let (clip, cuts) = (Text(&s.clip), s.cuts_secs.len());
        out.push_str(&format!(
            "<tr><th scope=\"row\">{clip}</th><td>{:.1} s</td><td>{}</td><td>{cuts}</td><td>{}</td></tr>\n",
            s.secs, s.samples, s.alone
        ));
    }
    out.push_str("</table></div>\n");
    push_pictures(out, result, "segmentation_");
}

fn push_clustering(out: &mut String, result: &Reproduction) {
    out.push_str(
        "<h2>Clusters by kWAS (§5.2)</h2>\n<p>Centred: on the database's mean and reduced to 16 dimensions, as in \
         §4.2. As they are: with the mean pose, which gives numbers of clusters like those printed.</p>\n\
         <div class=\"wide\"><table>\n<tr><th></th><th>τ</th><th>samples</th><th>clusters</th><th>TP</th><th>FP</th>\
         <th>FN</th><th>TN</th><th>Rand</th><th>adjusted</th></tr>\n",
    );
    for (tau, clusters, counts) in thesis::CLUSTERS {
        let all: u64 = counts.iter().sum();
        let rand = (counts[0] + counts[3]) as f64 / all as f64;
        push_cells(
            out,
            "thesis",
            &[format!("{tau}"), "122".to_owned(), clusters.to_string()],
            &counts,
            &[format!("{rand:.3}"), "–".to_owned()],
        );
    }
    for c in &result.clustering {
        let p = &c.pairs;
        push_cells(
            out,
            if c.centred { "centred" } else { "as they are" },
            &[
                format!("{}", c.tau),
                c.samples.to_string(),
                c.clusters.to_string(),
            ],
            &[
                p.true_positive,
                p.false_positive,
                p.false_negative,
                p.true_negative,
            ],
            &[
                format!("{:.3}", c.rand_index),
                format!("{:.3}", c.adjusted_rand_index),
            ],
        );
    }
    out.push_str("</table></div>\n");
}

fn push_cells(out: &mut String, name: &str, first: &[String], counts: &[u64], last: &[String]) {
    out.push_str(&format!("<tr><th scope=\"row\">{name}</th>"));
    let counts = counts.iter().map(u64::to_string);
    for cell in first
        .iter()
        .cloned()
        .chain(counts)
        .chain(last.iter().cloned())
    {
        out.push_str(&format!("<td>{cell}</td>"));
    }
    out.push_str("</tr>\n");
}

fn push_classification(out: &mut String, result: &Reproduction) {
    out.push_str(
        "<h2>Cut-out samples (§5.3)</h2>\n<p>Half of each class trains. The thesis also classifies the samples that trained; \
         the unseen ones show how good it is. In the last columns a sample \
         must also reach the confidence that the recogniser requires (Eq. 4.5 without the length, or its \
         replacement).</p>\n<div class=\"wide\"><table>\n\
         <tr><th></th><th>seed</th><th>half</th><th>trained</th><th>T</th><th>all: P_C</th><th>P_E</th><th>P_R</th>\
         <th>unseen: P_C</th><th>P_E</th><th>P_R</th><th>alike, all: P_C / P_E</th><th>unseen: P_C / P_E</th>\
         <th>index</th></tr>\n",
    );
    for (i, [c, e, r]) in thesis::CLASSIFICATION.iter().enumerate() {
        out.push_str(&format!(
            "<tr><th scope=\"row\">thesis</th><td>–</td><td>{}</td><td>61</td><td>0.92</td><td>{c:.3}</td><td>{e:.3}</td>\
             <td>{r:.3}</td><td>–</td><td>–</td><td>–</td><td>–</td><td>–</td><td>–</td></tr>\n",
            ["one", "the other"][i]
        ));
    }
    let rates = |r: &Rates| {
        format!(
            "<td>{:.3}</td><td>{:.3}</td><td>{:.3}</td>",
            r.p_c, r.p_e, r.p_r
        )
    };
    for c in &result.classification {
        let [all, unseen] = &c.alike;
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{:.2}</td>{}{}<td>{:.3} / {:.3}</td>\
             <td>{:.3} / {:.3}</td><td>{:.1} KB</td></tr>\n",
            c.setting.name(),
            c.seed,
            if c.complement { "the other" } else { "one" },
            c.taught,
            c.accept,
            rates(&c.all),
            rates(&c.unseen),
            all.p_c,
            all.p_e,
            unseen.p_c,
            unseen.p_e,
            c.index_bytes as f64 / 1000.0
        ));
    }
    out.push_str("</table></div>\n");
    for c in result
        .classification
        .iter()
        .filter(|c| !c.path.is_empty() && !c.complement)
    {
        out.push_str(&format!(
            "<p>{}, seed {}: the path of a sample down the tree (Fig. 5.2):</p>\n<ol>\n",
            c.setting.name(),
            c.seed
        ));
        for line in &c.path {
            out.push_str(&format!("<li>{}</li>\n", Text(line)));
        }
        out.push_str("</ol>\n");
    }
    for part in ["_tree", "_confusion", "_branch_"] {
        push_pictures(out, result, part);
    }
}

fn push_streams(out: &mut String, result: &Reproduction) {
    out.push_str(
        "<h2>Streams (§5.4)</h2>\n<p>In the thesis's accuracy a long detection can match a short sample; F1 at \
         half overlap, one to one, is stricter.</p>\n<div class=\"wide\"><table>\n<tr><th></th><th>seed</th><th>TP</th>\
         <th>FP</th><th>FN</th><th>TN</th><th>accuracy</th><th>F1</th><th>false alarms a minute, unknown motion</th>\
         <th>delay</th></tr>\n",
    );
    let ([tp, fp, fn_, tn], accuracy) = thesis::STREAMS;
    out.push_str(&format!(
        "<tr><th scope=\"row\">thesis</th><td>–</td><td>{tp}</td><td>{fp}</td><td>{fn_}</td><td>{tn}</td>\
         <td>{accuracy:.3}</td><td>–</td><td>–</td><td>–</td></tr>\n"
    ));
    let figure =
        |v: Option<f64>, decimals: usize| v.map_or("–".to_owned(), |v| format!("{v:.decimals$}"));
    for s in &result.streams {
        let t = &s.evaluation.thesis;
        out.push_str(&format!(
            "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>\
             <td>{}</td><td>{}</td><td>{} s</td></tr>\n",
            s.setting.name(),
            s.seed,
            t.true_positives,
            t.false_positives,
            t.false_negatives,
            t.true_negatives,
            figure(t.accuracy, 3),
            figure(s.evaluation.f1_at(0.5), 3),
            figure(s.evaluation.unknown.per_minute, 2),
            figure(s.evaluation.delay.median_secs, 2)
        ));
    }
    out.push_str("</table></div>\n");
    push_pictures(out, result, "_timeline_");
    push_pictures(out, result, "_map_");
}

fn push_pictures(out: &mut String, result: &Reproduction, part: &str) {
    let shown: Vec<&Picture> = result
        .pictures
        .iter()
        .filter(|p| p.name.contains(part))
        .collect();
    if shown.is_empty() {
        return;
    }
    out.push_str(&format!(
        "<details open><summary>{} pictures</summary>\n",
        shown.len()
    ));
    for picture in shown {
        out.push_str(&format!(
            "<figure><figcaption>{}</figcaption>\n{}</figure>\n",
            Text(&picture.caption),
            picture.svg
        ));
    }
    out.push_str("</details>\n");
}
