//! Captions of clips from files and folders.

use std::path::{Path, PathBuf};

use morec_db::exchange::{Caption, add_sources, read_captions};

/// Captions of files, and of folders of HumanML3D: texts, also below `texts`, and `index.csv`. `read` reads a file; its errors begin
/// with the path.
///
/// # Errors
/// A sentence that begins with the path that cannot be read.
pub fn captions_of(
    paths: &[PathBuf],
    read: &dyn Fn(&Path) -> Result<Vec<u8>, String>,
) -> Result<Vec<Caption>, String> {
    let mut captions = Vec::new();
    for path in paths {
        match path.is_dir() {
            true => captions.append(&mut of_folder(path, read)?),
            false => captions.append(&mut of_file(path, read)?),
        }
    }
    Ok(captions)
}

fn of_folder(
    path: &Path,
    read: &dyn Fn(&Path) -> Result<Vec<u8>, String>,
) -> Result<Vec<Caption>, String> {
    let texts = Some(path.join("texts")).filter(|texts| texts.is_dir());
    let folder = texts.as_deref().unwrap_or(path);
    let in_folder = |why: std::io::Error| format!("{}: {why}", folder.display());
    let entries = folder.read_dir().map_err(in_folder)?;
    let files = entries.map(|entry| entry.map(|entry| entry.path()));
    let mut files: Vec<PathBuf> = files.collect::<Result<_, _>>().map_err(in_folder)?;
    files.retain(|file| file.extension().is_some_and(|ending| ending == "txt"));
    files.sort();
    if files.is_empty() {
        return Err(format!(
            "{}: expected texts (*.txt), found none",
            folder.display()
        ));
    }
    let mut captions = Vec::new();
    for file in &files {
        captions.append(&mut of_file(file, read)?);
    }
    let table = path.join("index.csv");
    if table.is_file() {
        let added = add_sources(&mut captions, &read(&table)?);
        added.map_err(|why| format!("{}: {why}", table.display()))?;
    }
    Ok(captions)
}

fn of_file(
    path: &Path,
    read: &dyn Fn(&Path) -> Result<Vec<u8>, String>,
) -> Result<Vec<Caption>, String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let captions = read_captions(&name, &read(path)?);
    captions.map_err(|why| format!("{}: {why}", path.display()))
}
