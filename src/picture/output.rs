use super::{write_exr, write_png};
use crate::film::Film;
use crate::tone::Development;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

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

/// A file that is written, but does not have its name yet.
#[derive(Debug)]
pub struct Pending {
    path: PathBuf,
    /// None where the path is no plain file (a device, a pipe) and has been written to directly.
    file: Option<(tempfile::NamedTempFile, Unfinished)>,
}

/// Temporary files there are now.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes away what is written but not finished: for a program that is about to end without more ado.
pub fn remove_unfinished() {
    for path in unfinished().drain(..) {
        // There is no one left to tell.
        let _ = std::fs::remove_file(path);
    }
}

/// Known to be unfinished as long as it lives.
#[derive(Debug)]
struct Unfinished(PathBuf);

impl Unfinished {
    fn new(path: &Path) -> Self {
        unfinished().push(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

fn io_error(path: &Path) -> impl Fn(std::io::Error) -> WriteError {
    move |source| WriteError::Io { path: path.to_owned(), source }
}

/// Writes to a temporary file beside `path`; [`Pending::finish`] gives it its name. A link is followed; what is no
/// plain file is written to directly.
///
/// # Errors
/// If any of it fails; nothing is left behind then.
pub fn prepare(
    path: &Path,
    contents: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> std::io::Result<()>,
) -> Result<Pending, WriteError> {
    let fault = io_error(path);
    if path.is_dir() {
        return Err(fault(std::io::Error::other("it is a directory")));
    }
    let fill = |file: &mut std::fs::File| {
        let mut writer = BufWriter::new(file);
        contents(&mut writer).and_then(|()| writer.flush())
    };
    let target = resolved(path).map_err(&fault)?;
    let there = target.metadata().ok();
    if there.as_ref().is_some_and(|m| !m.is_file()) {
        let mut device = std::fs::OpenOptions::new().write(true).open(&target).map_err(&fault)?;
        fill(&mut device).map_err(&fault)?;
        return Ok(Pending { path: target, file: None });
    }
    if there.as_ref().is_some_and(|m| m.permissions().readonly()) {
        return Err(fault(std::io::Error::other("it is there already, and read-only")));
    }
    let folder = match target.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".terrell-");
    #[cfg(unix)]
    let everyone = {
        use std::os::unix::fs::PermissionsExt;
        // Less the umask, as for any new file.
        std::fs::Permissions::from_mode(0o666)
    };
    #[cfg(unix)]
    builder.permissions(everyone);
    // The temporary name would only puzzle.
    let mut file = builder.tempfile_in(folder).map_err(|e| fault(e.kind().into()))?;
    let mark = Unfinished::new(file.path());
    fill(file.as_file_mut()).map_err(&fault)?;
    if let Some(there) = there {
        file.as_file().set_permissions(there.permissions()).map_err(&fault)?;
    }
    Ok(Pending { path: target, file: Some((file, mark)) })
}

/// The one name a file has: links followed, folders resolved.
fn resolved(path: &Path) -> std::io::Result<PathBuf> {
    if path.exists() {
        return path.canonicalize();
    }
    if path.is_symlink() {
        return Err(std::io::Error::other("it is a link that leads nowhere"));
    }
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent.canonicalize()?,
        _ => Path::new(".").canonicalize()?,
    };
    Ok(folder.join(path.file_name().unwrap_or_default()))
}

impl Pending {
    /// Where it will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name, over whatever had it.
    ///
    /// # Errors
    /// If the system refuses; nothing is left behind then.
    pub fn finish(self) -> Result<(), WriteError> {
        match self.file {
            None => Ok(()),
            Some((file, _)) => file.persist(&self.path).map(drop).map_err(|e| io_error(&self.path)(e.error)),
        }
    }
}

/// Writes the film in the format of the file's ending, to be [finished](Pending::finish); an EXR has the light as it is,
/// undeveloped.
///
/// # Errors
/// On an unknown ending, or if the file cannot be written.
pub fn prepare_picture(film: &Film, development: &Development, path: &Path) -> Result<Pending, WriteError> {
    match Format::of(path)? {
        Format::Png => prepare(path, |to| write_png(film, development, to)),
        Format::Exr => {
            // The writer goes back and forth, which not everything that can be written to allows.
            let mut bytes = std::io::Cursor::new(Vec::new());
            write_exr(film, &mut bytes).map_err(io_error(path))?;
            prepare(path, |to| to.write_all(bytes.get_ref()))
        }
    }
}

/// As [`prepare_picture`], whole or not at all.
///
/// # Errors
/// On an unknown ending, or if the file cannot be written.
pub fn write(film: &Film, development: &Development, path: &Path) -> Result<(), WriteError> {
    prepare_picture(film, development, path)?.finish()
}
