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

    /// Before the work: whether output and JSON can be written.
    pub fn check(&self, output: &Path) -> Result<(), Fault> {
        if let Some(json) = self.json_file() {
            check_target(json)?;
            if json == output {
                return Err(both(json));
            }
        }
        Ok(())
    }

    /// After it: gives files their names, the JSON's among them, all or none.
    pub fn finish(&self, mut files: Vec<Pending>, summary: &Value) -> Result<(), Fault> {
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
