//! Writes settings as the words of a command line. The studio uses it to show the command that does the same.

use clap::{Arg, Args, Command};
use serde::Serialize;
use serde_json::Value;

use crate::params::{Param, word};

/// The options with their values that give `settings` on the command line: one for every field that is not as usual.
///
/// A list is one value with commas, or an option for each value, as the option says; a table of parameters is an option for each;
/// what is on or off is an option without a value.
pub fn arguments<S: Serialize + Default + Args>(settings: &S) -> Vec<(String, Option<String>)> {
    let fields = |settings: &S| match serde_json::to_value(settings) {
        Ok(Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    };
    let usual = fields(&S::default());
    let changed = fields(settings)
        .into_iter()
        .filter(|(name, value)| usual.get(name) != Some(value));
    let command = S::augment_args(Command::new("settings"));
    let of_field = |name: &str| command.get_arguments().find(|arg| arg.get_id() == name);
    changed
        .flat_map(|(name, value)| of_field(&name).map_or_else(Vec::new, |arg| option(arg, value)))
        .collect()
}

fn option(arg: &Arg, value: Value) -> Vec<(String, Option<String>)> {
    let option = format!("--{}", arg.get_long().unwrap_or(arg.get_id().as_str()));
    let each = |value: String| (option.clone(), Some(value));
    match value {
        Value::Null | Value::Bool(false) => Vec::new(),
        Value::Bool(true) => vec![(option, None)],
        Value::Array(values) => {
            let values = values.into_iter().map(word);
            match arg.get_value_delimiter() {
                Some(_) => vec![each(values.collect::<Vec<_>>().join(","))],
                None => values.map(each).collect(),
            }
        }
        Value::Object(params) => {
            let param = |(name, value)| each(Param { name, value }.to_string());
            params.into_iter().map(param).collect()
        }
        value => vec![each(word(value))],
    }
}

#[cfg(test)]
mod tests {
    use clap::FromArgMatches;
    use morec::train::thesis::SvrdmTrainParams;
    use serde::de::DeserializeOwned;

    use super::*;
    use crate::{
        CrossvalSettings, CutMethod, CutSettings, ImportSettings, LeftOut, Method, SearchSettings,
        TrainSettings, from_fields,
    };

    fn words<S: Serialize + Default + Args>(settings: &S) -> Vec<String> {
        let options = arguments(settings).into_iter();
        options
            .flat_map(|(option, value)| std::iter::once(option).chain(value))
            .collect()
    }

    fn parsed<S: Args + FromArgMatches>(words: &[String]) -> S {
        let command = S::augment_args(Command::new("op").no_binary_name(true));
        S::from_arg_matches(&command.try_get_matches_from(words).unwrap()).unwrap()
    }

    /// The command line and the keywords of Python give the settings back.
    fn returns<S>(settings: &S)
    where
        S: Args + Serialize + DeserializeOwned + Default + PartialEq + std::fmt::Debug,
    {
        assert_eq!(parsed::<S>(&words(settings)), *settings);
        let Ok(Value::Object(fields)) = serde_json::to_value(settings) else {
            panic!("no fields");
        };
        assert_eq!(from_fields::<S>(fields).unwrap(), *settings);
    }

    #[test]
    fn settings_come_back_from_a_command_line_and_from_keywords() {
        returns(&TrainSettings::default());
        returns(&CrossvalSettings::default());
        returns(&CutSettings::default());
        returns(&CutSettings {
            direction: morec::segment::PassDirections::Backward,
            rise: 3.5,
            ..CutMethod::Ppca.into()
        });
        returns(&ImportSettings {
            subject: Some("ada".into()),
            tags: vec!["walk".into(), "one, two".into()],
            ..ImportSettings::default()
        });
        returns(&SearchSettings::default());
        returns(&crate::DiscoverSettings {
            plain: true,
            runs: true,
        });
        returns(&SearchSettings {
            mirror: true,
            learned: true,
            classes: vec!["wave".into()],
            warp_share: 0.25,
            ..SearchSettings::default()
        });
        let settings = TrainSettings {
            classes: vec!["wave".into(), "bow".into()],
            gestures: vec!["wave".into()],
            bones: "upper".parse().unwrap(),
            everyday: morec::train::Everyday::Never,
            params: vec!["rho=0.4".parse().unwrap()],
            ..TrainSettings::default()
        };
        returns(&settings);
        let line =
            "--bones upper --classes wave,bow --everyday never --gestures wave --param rho=0.4";
        assert_eq!(words(&settings).join(" "), line);
        returns(&CrossvalSettings {
            by: LeftOut::Half,
            samples: Some(2),
            perturb: vec!["cam:1".parse().unwrap(), "mirror".parse().unwrap()],
            sensitivities: vec![0.5, 2.0],
            seed: 7,
        });
    }

    #[test]
    fn parameters_of_the_method_of_2009_are_named_where_they_are_not_those_of_a_setting() {
        let line = |params: &SvrdmTrainParams| {
            let settings = TrainSettings::of_svrdm(params);
            returns(&settings);
            assert_eq!(settings.method, Method::Svrdm);
            words(&settings).join(" ")
        };
        assert_eq!(line(&SvrdmTrainParams::tuned()), "--method svrdm");
        let faithful = line(&SvrdmTrainParams::faithful());
        assert_eq!(faithful, "--method svrdm --svrdm faithful");
        let mut params = SvrdmTrainParams::tuned();
        params.tree.machine.other = 0.375;
        let changed = line(&params);
        assert_eq!(changed, "--method svrdm --param tree.machine.other=0.375");
        let trained = TrainSettings::of_svrdm(&params).recipe().unwrap();
        let morec::train::Recipe::Svrdm(options) = trained else {
            panic!("{trained:?}");
        };
        assert_eq!(options.params, params);
    }

    #[test]
    fn a_field_that_cannot_be_read_is_named() {
        let given = |name: &str, value: Value| {
            let error = from_fields::<TrainSettings>([(name.to_owned(), value)]);
            error.unwrap_err().to_string()
        };
        let wrong = given("method", "magic".into());
        assert!(wrong.starts_with("parameter method=magic: "), "{wrong}");
        assert!(wrong.contains("auto"), "{wrong}");
        let unknown = given("mirrors", "yes".into());
        assert!(unknown.ends_with("did you mean `mirror`?"), "{unknown}");
    }
}
