//! Parameters of a method by their paths.

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
    /// Its value.
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

/// Settings as usual but for `fields`, of which a mistake is named.
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
    given.iter().try_fold(params, |params, param| {
        set(params, param).map_err(|why| ParamError {
            param: param.to_string(),
            why,
        })
    })
}

fn set<P: Serialize + DeserializeOwned>(params: P, param: &Param) -> Result<P, String> {
    let mut tree = serde_json::to_value(&params).map_err(|error| error.to_string())?;
    let name = &param.name;
    let known = leaves(&tree);
    if !known.iter().any(|(path, _)| path == name) {
        let known: Vec<String> = known.into_iter().map(|(path, _)| path).collect();
        let hint = nearest(name, &known);
        return Err(format!("there is no parameter {name}{hint}"));
    }
    let Some(place) = tree.pointer_mut(&format!("/{}", name.replace('.', "/"))) else {
        return Err(format!("{name} is not set"));
    };
    let before = std::mem::replace(place, param.value.clone());
    // What is not set as usual says nothing of what a value looks like.
    let usual = match before.is_null() {
        true => String::new(),
        false => format!(" (it is {before})"),
    };
    serde_json::from_value(tree).map_err(|error| format!("{error}{usual}"))
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
