//! Learning curves: results with fewer samples and fewer people.

use std::collections::{BTreeMap, BTreeSet};

use morec::progress::Progress;
use morec::train::TrainError;
use morec_db::{DbError, MotionDb, ReportKind};
use morec_measure::crossval::{
    CrossvalData, CrossvalError, CrossvalOptions, TaughtLimit, crossval,
};
use morec_measure::eval::{Evaluation, MEASURED_OVERLAP};
use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::crossval::evaluation;
use crate::{CrossvalSettings, OperationError, TrainSettings};

/// Draws of samples and people at each point but the last, at which all teach.
const DRAWS: u64 = 3;

/// Measures of cross-validations in which ever more samples of each class teach, and ever more people.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LearningCurve {
    /// What was left out in turn, in words.
    pub divided: String,
    /// 1, 2, 4 … samples of each class from all people, then 1, 2, 4 … people with all their samples, then all of both.
    pub points: Vec<CurvePoint>,
    /// What the next samples are worth, and of which class.
    pub advice: Vec<String>,
}

/// One number of samples or people.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Samples of each class that teach at most; `None` for all.
    pub samples: Option<usize>,
    /// People who teach at most; `None` for all.
    pub people: Option<usize>,
    /// Measures of each draw.
    pub draws: Vec<CurveFigures>,
}

/// Measures of one draw.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurveFigures {
    /// F1 of events.
    pub f1: Option<f64>,
    /// Share of the samples that are found.
    pub recall: Option<f64>,
    /// False alarms a minute in the clips with labels.
    pub alarms_per_minute: Option<f64>,
    /// Median delay of a report, seconds.
    pub delay_secs: Option<f64>,
    /// Share of each class's samples that a detection overlaps by half.
    pub recall_of_classes: BTreeMap<String, f64>,
}

impl CurveFigures {
    fn of(e: &Evaluation) -> Self {
        let of_class = |of: &morec_measure::eval::ClassFigures| {
            let at = of.overlap.iter().find(|o| o.min_iou == MEASURED_OVERLAP)?;
            Some((of.class.clone(), at.recall?))
        };
        Self {
            f1: e.events.f1,
            recall: e.events.recall,
            alarms_per_minute: e.false_alarms.per_minute,
            delay_secs: e.delay.median_secs,
            recall_of_classes: e.classes.iter().filter_map(of_class).collect(),
        }
    }
}

impl CurvePoint {
    /// Least, mean and largest of a measure over the draws; `None` if no draw has it.
    pub fn spread(&self, of: impl Fn(&CurveFigures) -> Option<f64>) -> Option<[f64; 3]> {
        let values: Vec<f64> = self.draws.iter().filter_map(of).collect();
        let least = values.iter().copied().reduce(f64::min)?;
        let largest = values.iter().copied().reduce(f64::max)?;
        Some([
            least,
            values.iter().sum::<f64>() / values.len() as f64,
            largest,
        ])
    }

    fn recall_of(&self, class: &str) -> Option<f64> {
        Some(self.spread(|draw| draw.recall_of_classes.get(class).copied())?[1])
    }
}

impl LearningCurve {
    /// The result in a line.
    pub fn title(&self) -> String {
        let f1 = |point: &CurvePoint| point.spread(|draw| draw.f1).map(|spread| spread[1]);
        let ends = self
            .points
            .first()
            .and_then(f1)
            .zip(self.points.last().and_then(f1));
        ends.map_or_else(String::new, |(first, all)| {
            format!("F1 of events {first:.3} with the fewest, {all:.3} with all")
        })
    }

    /// Keeps it in a database. Gives the number of the report.
    ///
    /// # Errors
    /// The database cannot be written.
    pub fn keep(&self, db: &mut MotionDb) -> Result<i64, DbError> {
        db.keep_report(ReportKind::Curve, &self.title(), &json!(self))
    }
}

impl CrossvalSettings {
    /// Cross-validates with 1, 2, 4 … samples of each class and with 1, 2, 4 … people, three draws each, and with all of them. Other
    /// measures of these settings (`samples`, `perturb`, `sensitivities`) are left out. A draw that cannot be trained is left out.
    /// Costs as many cross-validations as there are draws.
    ///
    /// # Errors
    /// As [`crossval`](Self::crossval).
    pub fn learning_curve(
        &self,
        data: &CrossvalData<'_>,
        train: &TrainSettings,
        progress: &dyn Progress,
    ) -> Result<LearningCurve, OperationError> {
        let divided = self.divided(data)?;
        let recipe = train.recipe()?;
        let mut points = points_of(data);
        let last = points.len() - 1;
        let total = last * DRAWS as usize + 1;
        let mut done = 0;
        for (place, point) in points.iter_mut().enumerate() {
            let draws = if place == last { 1 } else { DRAWS };
            for draw in 0..draws {
                progress.report("cross-validations", done, total);
                if progress.cancelled() {
                    return Err(CrossvalError::Train {
                        fold: "all".to_owned(),
                        source: TrainError::Cancelled,
                    }
                    .into());
                }
                done += 1;
                let options = CrossvalOptions {
                    taught: TaughtLimit {
                        samples_per_class: point.samples,
                        people: point.people,
                        draw,
                    },
                    ..CrossvalOptions::from(self.fold_by())
                };
                match crossval(data, &options, &recipe, &()) {
                    Ok(outcome) => point
                        .draws
                        .push(CurveFigures::of(&evaluation(&outcome.tested)?)),
                    Err(error) if place == last => return Err(error.into()),
                    Err(_) => {}
                }
            }
        }
        progress.report("cross-validations", total, total);
        drop_what_is_all(&mut points);
        let advice = advice(&points);
        Ok(LearningCurve {
            divided,
            points,
            advice,
        })
    }
}

/// The points that the data has samples and people for, all of both last.
fn points_of(data: &CrossvalData<'_>) -> Vec<CurvePoint> {
    let mut samples: BTreeMap<&str, usize> = BTreeMap::new();
    for sample in data.samples {
        *samples.entry(&sample.class).or_default() += 1;
    }
    let people: BTreeSet<&str> = data
        .clips
        .iter()
        .filter_map(|clip| clip.person.as_deref())
        .collect();
    let doubled = |below: usize| {
        std::iter::successors(Some(1), |n| Some(2 * n)).take_while(move |n| *n < below)
    };
    let point = |samples, people| CurvePoint {
        samples,
        people,
        draws: Vec::new(),
    };
    let most = samples.into_values().max().unwrap_or(0);
    let by_samples = doubled(most).map(|n| point(Some(n), None));
    // One of the people is left out.
    let by_people = doubled(people.len().saturating_sub(1)).map(|n| point(None, Some(n)));
    by_samples
        .chain(by_people)
        .chain([point(None, None)])
        .collect()
}

/// Drops points without measures, and points that measure what all samples and people do: the folds have no more.
fn drop_what_is_all(points: &mut Vec<CurvePoint>) {
    let Some(all) = points.pop() else { return };
    points.retain(|point| point.draws.iter().any(|draw| *draw != all.draws[0]));
    points.push(all);
}

/// Sentences on what the last steps brought.
fn advice(points: &[CurvePoint]) -> Vec<String> {
    let f1 = |point: &CurvePoint| Some(point.spread(|draw| draw.f1)?[1]);
    let Some((all, before)) = points.split_last() else {
        return Vec::new();
    };
    let mut advice = Vec::new();
    let step = |of: fn(&CurvePoint) -> Option<usize>, [one, several]: [&str; 2]| {
        let last = before.iter().rev().find(|point| of(point).is_some())?;
        let (number, from, to) = (of(last)?, f1(last)?, f1(all)?);
        let what = if number == 1 { one } else { several };
        let sentence = format!(
            "from at most {number} {what} to all, F1 of events goes from {from:.3} to {to:.3}"
        );
        Some((last, sentence))
    };
    let by_samples = step(|point| point.samples, ["sample", "samples"]);
    let by_people = step(|point| point.people, ["person", "people"]);
    let steps = by_samples.iter().chain(&by_people);
    advice.extend(steps.map(|(_, sentence)| sentence.clone()));
    let classes = all
        .draws
        .iter()
        .flat_map(|draw| draw.recall_of_classes.keys());
    let recalls: Vec<(&String, f64)> = classes
        .filter_map(|class| Some((class, all.recall_of(class)?)))
        .collect();
    if let Some((last, _)) = &by_samples {
        let gain =
            |(class, recall): &(&String, f64)| recall - last.recall_of(class).unwrap_or(*recall);
        if let Some(most) = recalls
            .iter()
            .max_by(|a, b| gain(a).total_cmp(&gain(b)))
            .filter(|most| gain(most) > 0.0)
        {
            advice.push(format!(
                "{} gains most from more samples: {:.0} % more of its samples are found",
                most.0,
                100.0 * gain(most)
            ));
        }
    }
    if let Some((class, recall)) = recalls
        .iter()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|least| least.1 < 0.95)
    {
        advice.push(format!(
            "{class} needs more samples most: with all its samples, {:.0} % are found",
            100.0 * recall
        ));
    }
    advice
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(samples: Option<usize>, f1: f64, walk: f64, jump: f64) -> CurvePoint {
        let figures = |f1: f64| CurveFigures {
            f1: Some(f1),
            recall: Some(f1),
            alarms_per_minute: None,
            delay_secs: None,
            recall_of_classes: [("walk".to_owned(), walk), ("jump".to_owned(), jump)].into(),
        };
        CurvePoint {
            samples,
            people: None,
            draws: vec![figures(f1 - 0.1), figures(f1 + 0.1)],
        }
    }

    #[test]
    fn points_that_are_all_there_is_are_left_out() {
        let mut points = vec![
            point(Some(1), 0.5, 0.5, 0.2),
            point(Some(2), 0.6, 0.9, 0.2),
            point(None, 0.6, 0.9, 0.2),
        ];
        points[1].draws = vec![points[2].draws[0].clone(); 3];
        points[2].draws.truncate(1);
        drop_what_is_all(&mut points);
        assert_eq!(
            points.iter().map(|p| p.samples).collect::<Vec<_>>(),
            [Some(1), None]
        );
    }

    #[test]
    fn advice_names_what_the_last_step_brought() {
        let points = [
            point(Some(1), 0.5, 0.5, 0.2),
            point(Some(2), 0.6, 0.9, 0.2),
            point(None, 0.7, 0.9, 0.6),
        ];
        assert_eq!(points[0].spread(|draw| draw.f1).map(|s| s[1]), Some(0.5));
        let advice = advice(&points);
        assert_eq!(
            advice[0],
            "from at most 2 samples to all, F1 of events goes from 0.600 to 0.700"
        );
        assert!(
            advice[1].starts_with("jump gains most from more samples: 40 %"),
            "{advice:?}"
        );
        assert!(
            advice[2].starts_with("jump needs more samples most: with all its samples, 60 %"),
            "{advice:?}"
        );
    }
}
