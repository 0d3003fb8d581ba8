//! Parameters of a method, set by their paths (`decode.lag_ticks=2`), with suggestions for misspelt names.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use morec::labels::hint;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

/// A value for the parameter at a path, as `decode.lag_ticks=2`.
#[derive(Debug, Clone, PartialEq)]
pub struct Param {
    /// Path of the parameter: names of fields with dots between them.
    pub name: String,
    /// The value, as JSON.
    pub value: Value,
}

/// Why a parameter cannot be set.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("parameter {param}: {why}")]
pub struct ParamError {
    param: String,
    why: String,
}

impl FromStr for Param {
    type Err = String;

    /// What is no JSON is the name of a choice.
    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
        let named = |_| Value::String(value.to_owned());
        Ok(Self {
            name: name.to_owned(),
            value: serde_json::from_str(value).unwrap_or_else(named),
        })
    }
}

impl fmt::Display for Param {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.name, word(self.value.clone()))
    }
}

/// A value as it is typed: text without quotes.
pub(crate) fn word(value: Value) -> String {
    match value {
        Value::String(text) => text,
        value => value.to_string(),
    }
}

/// Writes parameters as a table by path.
pub(crate) fn to_table<S: Serializer>(params: &[Param], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(params.iter().map(|param| (&param.name, &param.value)))
}

/// Reads parameters from a table by path.
pub(crate) fn from_table<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Param>, D::Error> {
    let table = BTreeMap::<String, Value>::deserialize(from)?;
    let param = |(name, value)| Param { name, value };
    Ok(table.into_iter().map(param).collect())
}

/// Defaults overridden by `fields`; the error names the bad field.
///
/// # Errors
/// There is no field of a name, or it cannot have the value.
pub fn from_fields<S: Serialize + DeserializeOwned + Default>(
    fields: impl IntoIterator<Item = (String, Value)>,
) -> Result<S, ParamError> {
    let param = |(name, value)| Param { name, value };
    let fields: Vec<Param> = fields.into_iter().map(param).collect();
    with(S::default(), &fields)
}

/// `params` with those that `given` names set.
///
/// # Errors
/// There is no parameter of a name, or it cannot have the value.
pub(crate) fn with<P: Serialize + DeserializeOwned>(
    params: P,
    given: &[Param],
) -> Result<P, ParamError> {
    let of = |param: &Param, why: String| ParamError {
        param: param.to_string(),
        why,
    };
    let Ok(usual) = serde_json::to_value(&params) else {
        return Ok(params);
    };
    let (mut tree, mut read, mut mistake) = (usual.clone(), params, None);
    let unknown = |param: &Param| {
        let known: Vec<String> = leaves(&usual).into_iter().map(|(path, _)| path).collect();
        let (name, hint) = (&param.name, nearest(&param.name, &known));
        of(param, format!("no parameter is called {name}{hint}"))
    };
    for param in given {
        if !put(&mut tree, &usual, param) {
            return Err(unknown(param));
        }
        match serde_json::from_value(tree.clone()) {
            Ok(params) => (read, mistake) = (params, None),
            // A rule's fields may make sense together only: the first mistake stands unless what follows mends it.
            Err(error) => {
                let was = at(&usual, &param.name).filter(|was| !was.is_null());
                let was = was.map_or(String::new(), |was| format!(" (its value is {was})"));
                mistake.get_or_insert_with(|| of(param, format!("{error}{was}")));
            }
        }
    }
    if let Some(mistake) = mistake {
        return Err(mistake);
    }
    let now = serde_json::to_value(&read).unwrap_or_default();
    let ignored = given.iter().find(|param| at(&now, &param.name).is_none());
    ignored.map_or(Ok(read), |param| Err(unknown(param)))
}

/// The value at a path.
fn at<'t>(tree: &'t Value, name: &str) -> Option<&'t Value> {
    tree.pointer(&format!("/{}", name.replace('.', "/")))
}

/// Puts a value at its path. Where the path leads into another choice than that of `usual`, as `keep.quality` where
/// `keep` has `dims`, the choice is exchanged. False where there is no such path.
fn put(tree: &mut Value, usual: &Value, param: &Param) -> bool {
    let (mut place, mut usual) = (tree, Some(usual));
    for field in param.name.split('.') {
        usual = match usual {
            Some(Value::Object(fields)) if fields.len() > 1 || fields.contains_key(field) => {
                match fields.get(field) {
                    None => return false,
                    known => known,
                }
            }
            // A choice, by its name alone or with its fields.
            Some(_) => {
                let chosen = place.get(field).cloned();
                *place = Value::Object(chosen.map(|c| (field.to_owned(), c)).into_iter().collect());
                None
            }
            None => None,
        };
        if !place.is_object() {
            *place = Value::Object(serde_json::Map::new());
        }
        place = &mut place[field];
    }
    *place = param.value.clone();
    true
}

/// The parameters in which `params` is not `usual`, of the same type.
pub(crate) fn changed<P: Serialize>(params: &P, usual: &P) -> Vec<Param> {
    let leaves = |params: &P| serde_json::to_value(params).map_or(Vec::new(), |tree| leaves(&tree));
    let usual = leaves(usual);
    let (now, as_usual) = (leaves(params), |leaf: &_| usual.contains(leaf));
    let changed = now.into_iter().filter(|leaf| !as_usual(leaf));
    changed.map(|(name, value)| Param { name, value }).collect()
}

/// The paths of all parameters in a tree of them, as `decode.lag_ticks`, and their values.
fn leaves(tree: &Value) -> Vec<(String, Value)> {
    let Value::Object(branches) = tree else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for (name, branch) in branches {
        let below = leaves(branch);
        match below.is_empty() {
            true => all.push((name.clone(), branch.clone())),
            false => all.extend(below.into_iter().map(|(p, v)| (format!("{name}.{p}"), v))),
        }
    }
    all
}

/// The parameters that may have been meant by `name`: those near it as a whole, or near its last word.
fn nearest(name: &str, known: &[String]) -> String {
    let last = |path: &str| path.rsplit('.').next().unwrap_or_default().to_owned();
    let below: Vec<String> = known
        .iter()
        .filter(|path| path.starts_with(&format!("{name}.")) || last(path) == last(name))
        .cloned()
        .collect();
    match below.as_slice() {
        [] => hint(name, known),
        [only] => format!("; did you mean `{only}`?"),
        several => format!("; there are {}", several.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use morec::train::thesis::SvrdmTrainParams;

    fn set(given: &[&str]) -> Result<SvrdmTrainParams, String> {
        let given: Vec<Param> = given.iter().map(|p| p.parse().unwrap()).collect();
        with(SvrdmTrainParams::default(), &given).map_err(|error| error.to_string())
    }

    #[test]
    fn any_rule_can_be_exchanged() {
        let json = |given: &[&str], path| {
            at(&serde_json::to_value(set(given).unwrap()).unwrap(), path).cloned()
        };
        let quality = json(&["keep.quality=0.95"], "keep").unwrap();
        assert_eq!(quality.to_string(), r#"{"quality":0.95}"#);
        assert_eq!(
            json(&["tree.sigma=algorithm4"], "tree.sigma").unwrap(),
            "algorithm4"
        );
        let fixed = [
            "tree.sigma.fixed.full=0.3",
            "tree.sigma.fixed.reduced=0.2",
            "pose.rate_hz=60",
        ];
        assert_eq!(
            json(&fixed, "tree.sigma").unwrap().to_string(),
            r#"{"fixed":{"full":0.3,"reduced":0.2}}"#
        );
        let whole = r#"tree.sigma={"scaled":{"full":2,"reduced":3}}"#;
        assert_eq!(json(&[whole], "tree.sigma.scaled.full").unwrap(), 2.0);
        assert_eq!(
            json(&["stages.comparison=profiles"], "stages.comparison").unwrap(),
            "profiles"
        );
        assert_eq!(json(&["thresholds=fixed"], "thresholds").unwrap(), "fixed");
        let twice = ["thresholds=fixed", "thresholds.estimated.folds=5"];
        assert_eq!(json(&twice, "thresholds.estimated.folds").unwrap(), 5);
        assert_eq!(json(&["tree.solver=sor"], "tree.solver").unwrap(), "sor");
    }

    #[test]
    fn mistakes_are_named() {
        let error = |given: &[&str]| set(given).unwrap_err();
        assert!(
            error(&["keep.qualty=0.95"]).contains("qualty"),
            "{}",
            error(&["keep.qualty=0.95"])
        );
        assert!(error(&["stages.acept=1"]).contains("did you mean `stages.accept`"));
        assert!(error(&["tree.sigma.fixed.full=0.3"]).contains("reduced"));
        assert!(error(&["stages.accept=high"]).contains("its value is 0.8"));
        assert!(error(&["nothing=1"]).contains("no parameter is called nothing"));
    }

    #[test]
    fn what_was_changed_can_be_set_again() {
        for of in [SvrdmTrainParams::faithful(), SvrdmTrainParams::tuned()] {
            for base in [SvrdmTrainParams::faithful(), SvrdmTrainParams::tuned()] {
                assert_eq!(with(base.clone(), &changed(&of, &base)).unwrap(), of);
            }
        }
    }
}
