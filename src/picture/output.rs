use super::{write_exr, write_png};
use crate::film::Film;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Picture formats we write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8-bit sRGB.
    Png,
    /// 32-bit float, all channels.
    Exr,
}

/// Why a picture could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// An ending we do not know.
    #[error("{}: unknown picture format{}; write to a .png or .exr file", .0.display(), .0.extension().map(|e| format!(" '.{}'", e.to_string_lossy())).unwrap_or_default())]
    UnknownFormat(PathBuf),
    /// The place cannot be written to.
    #[error("cannot write {}: {source}", .path.display())]
    Io {
        /// Where.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
}

impl Format {
    /// By a file's ending.
    ///
    /// # Errors
    /// On an ending we do not know.
    pub fn of(path: &Path) -> Result<Self, WriteError> {
        match path.extension().map(|e| e.to_string_lossy().to_lowercase()).as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(WriteError::UnknownFormat(path.to_owned())),
        }
    }
}

/// Writes a file whole or not at all: to a temporary file beside it, which then takes its name.
///
/// # Errors
/// If any of it fails; nothing is left behind then.
pub fn write_whole(
    path: &Path,
    contents: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> std::io::Result<()>,
) -> Result<(), WriteError> {
    let fault = |source| WriteError::Io { path: path.to_owned(), source };
    if path.is_dir() {
        return Err(fault(std::io::Error::other("it is a directory")));
    }
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut file = tempfile::Builder::new().prefix(".terrell-").tempfile_in(folder).map_err(fault)?;
    let mut writer = BufWriter::new(file.as_file_mut());
    contents(&mut writer).and_then(|()| writer.flush()).map_err(fault)?;
    drop(writer);
    readable_by_all(file.as_file()).map_err(fault)?;
    file.persist(path).map_err(|e| fault(e.error))?;
    Ok(())
}

/// Temporary files are their owner's alone; finished ones are not.
fn readable_by_all(file: &std::fs::File) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    let _ = file;
    Ok(())
}

/// Writes the film in the format of the file's ending, whole or not at all.
///
/// # Errors
/// On an unknown ending, or if the file cannot be written.
pub fn write(film: &Film, path: &Path) -> Result<(), WriteError> {
    let format = Format::of(path)?;
    write_whole(path, |to| match format {
        Format::Png => write_png(film, to),
        Format::Exr => write_exr(film, to),
    })
}
