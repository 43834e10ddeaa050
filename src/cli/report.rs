use super::Fault;
use clap::Args;
use serde_json::Value;
use std::io::Write;
use std::path::{Path, PathBuf};
use terrell::picture::{self, Pending};

/// What is told of what was done.
#[derive(Args)]
pub struct ReportFlags {
    /// Write what was done, with times and counts, as JSON; - for standard output
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Say nothing unless something is wrong
    #[arg(short, long)]
    pub quiet: bool,
}

impl ReportFlags {
    fn json_file(&self) -> Option<&Path> {
        self.json.as_deref().filter(|path| *path != Path::new("-"))
    }

    /// Before the work: whether output and JSON can be written, and are none of what was read.
    pub fn check(&self, output: &Path, read: &[PathBuf]) -> Result<(), Fault> {
        check_not_read(output, read)?;
        self.check_json(read)?;
        if let Some(json) = self.json_file() {
            let in_folder = output.is_dir()
                && json.canonicalize().is_ok_and(|j| output.canonicalize().is_ok_and(|o| j.starts_with(o)));
            if json == output || in_folder {
                return Err(both(json));
            }
        }
        Ok(())
    }

    /// The same of JSON alone.
    pub fn check_json(&self, read: &[PathBuf]) -> Result<(), Fault> {
        let Some(json) = self.json_file() else { return Ok(()) };
        check_target(json)?;
        check_not_read(json, read)
    }

    /// Whether there is to be JSON.
    pub fn has_json(&self) -> bool {
        self.json.is_some()
    }

    /// After it: gives files their names, the JSON's among them, all or none.
    pub fn finish(&self, mut files: Vec<Pending>, read: &[PathBuf], summary: &Value) -> Result<(), Fault> {
        files.iter().try_for_each(|file| check_not_read(file.path(), read))?;
        self.check_json(read)?;
        if let Some(path) = self.json_file() {
            let json = picture::prepare(path, |to| writeln!(to, "{summary:#}"))?;
            let plain = json.path().is_file() || !json.path().exists();
            if plain && files.iter().any(|file| file.path() == json.path()) {
                return Err(both(path));
            }
            files.push(json);
        }
        Ok(files.into_iter().try_for_each(Pending::finish)?)
    }

    /// Tells on standard output; what is for people goes to standard error where the JSON is there.
    pub fn tell(&self, line: &str, summary: &Value) -> Result<(), Fault> {
        let json_to_stdout = self.json.is_some() && self.json_file().is_none();
        if json_to_stdout {
            writeln!(std::io::stdout(), "{summary:#}")?;
        }
        if !self.quiet {
            if json_to_stdout { eprint!("{line}") } else { std::io::stdout().write_all(line.as_bytes())? }
        }
        Ok(())
    }
}

fn both(path: &Path) -> Fault {
    format!("{} cannot be both what is made and the JSON", path.display()).into()
}

fn check_not_read(path: &Path, read: &[PathBuf]) -> Result<(), Fault> {
    let Ok(place) = path.canonicalize() else { return Ok(()) };
    if read.iter().any(|other| other.canonicalize().is_ok_and(|other| other == place)) {
        return Err(format!("{} is among what is read; write to another file", path.display()).into());
    }
    Ok(())
}

/// What cannot be written to is better known before the work than after.
pub fn check_target(path: &Path) -> Result<(), Fault> {
    if path.is_dir() {
        return Err(format!("cannot write {}: it is a directory", path.display()).into());
    }
    match path.parent() {
        Some(folder) if folder != Path::new("") && !folder.is_dir() => {
            Err(format!("cannot write {}: there is no folder {}", path.display(), folder.display()).into())
        }
        _ => Ok(()),
    }
}
