use crate::cli::Fault;
use std::path::{Path, PathBuf};
use terrell::scene::Scene;

/// What cannot be a folder is better known before the work than after.
pub fn check_folder(folder: &Path) -> Result<(), Fault> {
    if folder.exists() && !folder.is_dir() {
        return Err(format!("cannot write to {}: it is not a folder", folder.display()).into());
    }
    match folder.parent() {
        Some(parent) if parent != Path::new("") && !parent.is_dir() => {
            Err(format!("cannot make {}: there is no folder {}", folder.display(), parent.display()).into())
        }
        _ => Ok(()),
    }
}

/// A folder's name for every scene.
pub fn folder_names(scenes: &[Scene]) -> Result<Vec<String>, Fault> {
    let mut names: Vec<String> = Vec::new();
    for scene in scenes {
        let name = scene.name.replace(['/', '\\'], "_");
        if names.contains(&name) {
            return Err(format!("two scenes are called '{name}'; compare them one by one").into());
        }
        names.push(name);
    }
    Ok(names)
}

/// Folders that were made here; without files in them they go again.
#[derive(Default)]
pub struct Folders(Vec<PathBuf>);

impl Folders {
    /// Makes one, if it is not there.
    pub fn make(&mut self, folder: &Path) -> Result<(), Fault> {
        if !folder.is_dir() {
            std::fs::create_dir(folder).map_err(|e| format!("cannot make {}: {e}", folder.display()))?;
            self.0.push(folder.to_owned());
        }
        Ok(())
    }

    /// What is in them is finished.
    pub fn keep(mut self) {
        self.0.clear();
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        for folder in self.0.iter().rev() {
            // Whatever is in it stays, and so does it.
            let _ = std::fs::remove_dir(folder);
        }
    }
}
