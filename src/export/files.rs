use super::{ExportError, Format, Model, glb, obj, ply, pov};
use crate::picture::{self, Pending};
use crate::scene::Picture;
use image::ImageEncoder;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes a model in the format of the file's ending, to be [finished](Pending::finish); OBJ and POV-Ray with their
/// other files beside it. The one named comes last: what it names is there by then.
///
/// # Errors
/// On an unknown ending, on what the format cannot hold, or if a file cannot be written.
pub fn prepare(model: &Model, path: &Path) -> Result<Vec<Pending>, ExportError> {
    let format = Format::of(path)?;
    if format != Format::Glb && model.times.len() > 1 {
        return Err(ExportError::Still(path.to_owned()));
    }
    let mut files = match format {
        Format::Glb => vec![File { path: path.to_owned(), contents: glb::encode(model, path)? }],
        Format::Obj => obj::encode(model, path),
        Format::Ply => vec![File { path: path.to_owned(), contents: ply::encode(model, path)? }],
        Format::Pov => pov::encode(model, path),
    };
    files.reverse();
    let written = |file: &File| picture::prepare(&file.path, |to| to.write_all(&file.contents));
    Ok(files.iter().map(written).collect::<Result<_, _>>()?)
}

/// Writes a model in the format of the file's ending, all of it or nothing.
///
/// # Errors
/// As [`prepare`].
pub fn write(model: &Model, path: &Path) -> Result<(), ExportError> {
    Ok(prepare(model, path)?.into_iter().try_for_each(Pending::finish)?)
}

/// A file to be.
pub(super) struct File {
    pub path: PathBuf,
    pub contents: Vec<u8>,
}

/// The pictures a model uses, each once.
#[derive(Default)]
pub(super) struct Pictures {
    used: Vec<Arc<Picture>>,
    /// Whether they must not be the files they came from, which may be partly transparent.
    opaque: bool,
}

impl Pictures {
    /// Written anew, without what other programs may take for transparency.
    pub fn opaque() -> Self {
        Self { opaque: true, ..Self::default() }
    }

    /// Its number.
    pub fn number(&mut self, picture: &Arc<Picture>) -> usize {
        self.used.iter().position(|p| Arc::ptr_eq(p, picture)).unwrap_or_else(|| {
            self.used.push(picture.clone());
            self.used.len() - 1
        })
    }

    pub fn iter(&self) -> impl Iterator<Item = &Picture> {
        self.used.iter().map(|p| &**p)
    }

    /// As files beside the model's, named after it and numbered.
    pub fn files(&self, path: &Path) -> Vec<File> {
        let file = |(number, picture): (usize, &Picture)| {
            let contents = if self.opaque { png_of(picture) } else { file_of(picture) };
            File { path: path.with_file_name(self.name(number, path)), contents }
        };
        self.iter().enumerate().map(file).collect()
    }

    /// The name of a picture's file.
    pub fn name(&self, number: usize, path: &Path) -> String {
        let is_jpeg = !self.opaque && self.used[number].file.as_ref().is_some_and(|file| !is_png(file));
        format!("{}_{number}.{}", stem(path), if is_jpeg { "jpg" } else { "png" })
    }
}

/// The file's name without its ending, and without blanks, which not every reader of names takes.
pub(super) fn stem(path: &Path) -> String {
    name_of(&path.file_stem().unwrap_or_default().to_string_lossy())
}

/// Without blanks, quotes and control characters.
pub(super) fn name_of(name: &str) -> String {
    let plain = |c: char| if c.is_whitespace() || c.is_control() || "\"'#\\".contains(c) { '_' } else { c };
    name.chars().map(plain).collect()
}

pub(super) fn is_png(contents: &[u8]) -> bool {
    contents.starts_with(b"\x89PNG")
}

/// A picture's own file if it came from a PNG or JPEG, else a PNG of its texels.
pub(super) fn file_of(picture: &Picture) -> Vec<u8> {
    picture.file.clone().unwrap_or_else(|| png_of(picture))
}

fn png_of(picture: &Picture) -> Vec<u8> {
    let mut out = Vec::new();
    let [width, height] = picture.size();
    image::codecs::png::PngEncoder::new(&mut out)
        .write_image(picture.texels().as_flattened(), width, height, image::ExtendedColorType::Rgb8)
        .expect("a picture is as large as it says, and memory takes what is written to it");
    out
}
