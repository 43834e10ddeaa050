use super::{ExportError, Format, Model, glb, obj, ply, pov};
use crate::picture::{Pending, prepare};
use crate::scene::Picture;
use image::ImageEncoder;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes a model in the format of the file's ending; OBJ and POV-Ray with their pictures beside it. All of it or
/// nothing. Gives the paths of all files.
///
/// # Errors
/// On an unknown ending, on what the format cannot hold, or if a file cannot be written.
pub fn write(model: &Model, path: &Path) -> Result<Vec<PathBuf>, ExportError> {
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
    let paths = files.iter().map(|file| file.path.clone()).collect();
    // The one the user named comes last: what it names is there by then.
    files.reverse();
    let pending: Vec<Pending> = files
        .iter()
        .map(|file| prepare(&file.path, |to| to.write_all(&file.contents)))
        .collect::<Result<_, _>>()?;
    pending.into_iter().try_for_each(Pending::finish)?;
    Ok(paths)
}

/// A file to be.
pub(super) struct File {
    pub path: PathBuf,
    pub contents: Vec<u8>,
}

/// The pictures a model uses, each once.
#[derive(Default)]
pub(super) struct Pictures(Vec<Arc<Picture>>);

impl Pictures {
    /// Its number.
    pub fn number(&mut self, picture: &Arc<Picture>) -> usize {
        self.0.iter().position(|p| Arc::ptr_eq(p, picture)).unwrap_or_else(|| {
            self.0.push(picture.clone());
            self.0.len() - 1
        })
    }

    pub fn iter(&self) -> impl Iterator<Item = &Picture> {
        self.0.iter().map(|p| &**p)
    }

    /// As files beside the model's, named after it and numbered.
    pub fn files(&self, path: &Path) -> Vec<File> {
        let file = |(number, picture): (usize, &Picture)| {
            let contents = file_of(picture);
            let path = path.with_file_name(picture_name(path, number, &contents));
            File { path, contents }
        };
        self.iter().enumerate().map(file).collect()
    }

    /// The names of these files.
    pub fn names(&self, path: &Path) -> Vec<String> {
        self.iter()
            .enumerate()
            .map(|(i, p)| picture_name(path, i, p.file.as_deref().unwrap_or(PNG)))
            .collect()
    }
}

const PNG: &[u8] = b"\x89PNG";

fn picture_name(path: &Path, number: usize, contents: &[u8]) -> String {
    format!("{}_{number}.{}", stem(path), if is_png(contents) { "png" } else { "jpg" })
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
    contents.starts_with(PNG)
}

/// A picture's own file if it came from a PNG or JPEG, else a PNG of its texels.
pub(super) fn file_of(picture: &Picture) -> Vec<u8> {
    picture.file.clone().unwrap_or_else(|| {
        let mut out = Vec::new();
        let [width, height] = picture.size();
        image::codecs::png::PngEncoder::new(&mut out)
            .write_image(picture.texels().as_flattened(), width, height, image::ExtendedColorType::Rgb8)
            .expect("a picture is as large as it says, and memory takes what is written to it");
        out
    })
}
