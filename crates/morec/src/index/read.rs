//! Reading an index.

use safetensors::SafeTensors;

use super::manifest::{FORMAT, Manifest, Preamble, SvrdmManifest};
use super::tensors::{Tables, checksum};
use super::{INDEX_VERSION, IndexError, MotionIndex, svrdm, templates};

impl MotionIndex {
    /// Opens a file's bytes and checks every part of them.
    ///
    /// # Errors
    /// Bytes that are no index, damaged, of a newer version, or of parts that do not fit together.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, IndexError> {
        let foreign = |e: safetensors::SafeTensorError| IndexError::Foreign(e.to_string());
        let (_, header) = SafeTensors::read_metadata(bytes).map_err(foreign)?;
        let words = header.metadata().as_ref().and_then(|m| m.get("morec"));
        let words = words.ok_or_else(|| {
            IndexError::Foreign("a safetensors file without a morec manifest".into())
        })?;
        let preamble: Preamble = parse(words)?;
        if preamble.format != FORMAT {
            return Err(IndexError::Foreign(format!(
                "its manifest says {:?}",
                preamble.format
            )));
        }
        if preamble.version > INDEX_VERSION {
            return Err(IndexError::Newer {
                found: preamble.version,
            });
        }
        let tables = || {
            SafeTensors::deserialize(bytes)
                .map(|t| Tables::of(&t))
                .map_err(foreign)
        };
        match preamble.method.as_str() {
            "templates" => {
                let (manifest, tables): (Manifest, _) = (parse(words)?, tables()?);
                check(words, manifest.checksum, &tables)?;
                let model = templates::read(&manifest, &tables)?.into();
                Ok(Self {
                    model,
                    roles: manifest.roles,
                    provenance: manifest.provenance,
                })
            }
            "svrdm" => {
                let (manifest, tables): (SvrdmManifest, _) = (parse(words)?, tables()?);
                check(words, manifest.checksum, &tables)?;
                let model = svrdm::read(&manifest, &tables)?.into();
                Ok(Self {
                    model,
                    roles: manifest.roles,
                    provenance: manifest.provenance,
                })
            }
            _ => Err(IndexError::Method(preamble.method)),
        }
    }
}

fn parse<'j, T: serde::Deserialize<'j>>(words: &'j str) -> Result<T, IndexError> {
    serde_json::from_str(words).map_err(|e| IndexError::Content(format!("manifest: {e}")))
}

/// The checksum is over the manifest's own text, so that fields this release does not know count too.
fn check(words: &str, expected: u32, tables: &Tables) -> Result<(), IndexError> {
    let text = words.replacen(&format!("\"checksum\":{expected}"), "\"checksum\":0", 1);
    let found = checksum(&text, tables.all());
    if found == expected {
        Ok(())
    } else {
        Err(IndexError::Checksum { expected, found })
    }
}
