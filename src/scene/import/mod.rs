//! Meshes out of files.

mod gltf;
mod obj;
mod picture;

use super::{Body, Clip, Light, Material, Mesh, MeshError, Paint, View};
use crate::relativity::Motion;
use glam::{DAffine3, DVec3};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A mesh file, read, in the file's own coordinates.
#[derive(Clone, Debug, Default)]
pub struct Imported {
    /// What moves alike, together.
    pub parts: Vec<Part>,
    /// The camera in it, if any.
    pub view: Option<View>,
    /// How many cameras there are to choose from.
    pub cameras: usize,
    /// The lights in it.
    pub lights: Vec<Light>,
    /// Bytes of the files that were read, pictures left out.
    pub bytes: usize,
    /// The files that were read.
    pub files: Vec<PathBuf>,
    /// What was passed over, for people to read.
    pub notes: Vec<String>,
}

/// Which scene and camera of a glTF file, by name or number from 1; a name goes before a number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// The scene; if none is asked for, the file's own default, else its first.
    pub scene: Option<String>,
    /// The camera, numbered as they are met in the scene's tree; if none is asked for, the first with perspective.
    pub camera: Option<String>,
}

/// Something in a mesh file that moves on its own.
#[derive(Clone, Debug)]
pub struct Part {
    /// What the file calls it.
    pub name: String,
    /// At rest; where it is animated, before its [`Clip`] poses it.
    pub mesh: Arc<Mesh>,
    /// How it moves.
    pub motion: Motion,
    /// How it is animated, slowly, within its rest frame.
    pub clip: Option<Clip>,
}

impl Part {
    /// What neither moves nor is animated.
    pub(super) fn still(name: String, mesh: Mesh) -> Self {
        Self { name, mesh: Arc::new(mesh), motion: Motion::at_rest(DVec3::ZERO), clip: None }
    }

    /// Moves and turns it within its rest frame.
    pub(super) fn place(&mut self, place: DAffine3) {
        match self.clip.take() {
            Some(clip) => self.clip = Some(clip.placed(place)),
            None => {
                let mesh = Arc::unwrap_or_clone(std::mem::take(&mut self.mesh));
                self.mesh = Arc::new(mesh.placed(&place));
            }
        }
    }

    /// Least and greatest coordinates in the rest frame; of what is animated, as at its beginning.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        match &self.clip {
            Some(clip) => Mesh::clone(&self.mesh).placed(&clip.pose(0.0)).bounds(),
            None => self.mesh.bounds(),
        }
    }

    /// As a body of a scene.
    pub fn into_body(self) -> Body {
        Body { name: self.name, mesh: self.mesh, motion: self.motion, clip: self.clip.map(Arc::new) }
    }
}

impl Imported {
    /// Whether the file says that anything in it moves.
    pub fn moves(&self) -> bool {
        self.parts.iter().any(|p| p.motion.celerity.moves())
    }

    /// All meshes in one, as they are where nothing moves and nothing is animated.
    pub fn into_mesh(self) -> Mesh {
        let mut all = Mesh::default();
        for Part { mesh, clip, .. } in self.settled().parts {
            let mesh = Arc::unwrap_or_clone(mesh);
            all.append(match clip {
                Some(clip) => mesh.placed(&clip.pose(0.0)),
                None => mesh,
            });
        }
        all
    }

    /// Everything where the file puts it, at rest; animations stay.
    pub fn settled(mut self) -> Self {
        for part in &mut self.parts {
            let moved = DAffine3::from_translation(part.motion.origin.position());
            if moved != DAffine3::IDENTITY {
                part.place(moved);
            }
            part.motion = Motion::at_rest(DVec3::ZERO);
        }
        self
    }
}

/// Why a mesh file cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file (or one it names) cannot be opened or read.
    #[error("{}: {source}", .path.display())]
    Read {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The contents are not what the format allows.
    #[error("{}{}: {message}", .path.display(), .line.map(|l| format!(":{l}")).unwrap_or_default())]
    Contents {
        /// Which file.
        path: PathBuf,
        /// Which line, where there are lines.
        line: Option<usize>,
        /// What is wrong and what to try.
        message: String,
    },
    /// The mesh in it cannot be drawn.
    #[error("{}: {source}", .path.display())]
    Mesh {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: MeshError,
    },
    /// The scene or camera asked for is not there, or cannot be used.
    #[error("{}: {message}", .path.display())]
    Choice {
        /// Which file.
        path: PathBuf,
        /// What is wrong and what there is.
        message: String,
    },
    /// Not a format we read.
    #[error("{}: only .obj, .gltf and .glb meshes can be read", .0.display())]
    UnknownFormat(PathBuf),
}

/// Whether a path has the ending of a mesh file we read.
pub fn is_mesh_file(path: &Path) -> bool {
    matches!(ending(path).as_str(), "obj" | "gltf" | "glb")
}

/// Whether a path has the ending of a file that may hold several scenes and cameras.
pub fn has_scenes(path: &Path) -> bool {
    matches!(ending(path).as_str(), "gltf" | "glb")
}

fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Reads an OBJ (with its MTL), glTF or GLB file.
///
/// # Errors
/// If it cannot be read, is malformed, or holds nothing that can be drawn.
pub fn import(path: &Path) -> Result<Imported, ImportError> {
    import_choosing(path, &Choice::default())
}

/// Reads an OBJ, glTF or GLB file; of a glTF file, the scene and the camera asked for.
///
/// # Errors
/// As [`import`]; and if there is no such scene or camera, or the file is of a format that has none.
pub fn import_choosing(path: &Path, choice: &Choice) -> Result<Imported, ImportError> {
    if *choice != Choice::default() && !has_scenes(path) {
        let message = "only .gltf and .glb files have scenes and cameras to choose from".to_owned();
        return Err(ImportError::Choice { path: path.to_owned(), message });
    }
    let files = RefCell::new(Vec::new());
    let contents = |path: &Path| {
        files.borrow_mut().push(path.to_owned());
        read_plain(path).map_err(|source| ImportError::Read { path: path.to_owned(), source })
    };
    let mut imported = match ending(path).as_str() {
        "obj" => obj::parse(&contents(path)?, path, &contents)?,
        "gltf" | "glb" => gltf::parse(&contents(path)?, path, choice, &contents)?,
        _ => return Err(ImportError::UnknownFormat(path.to_owned())),
    };
    imported.files = files.into_inner();
    checked(imported, path)
}

pub(super) use picture::{decode, is_picture_file};

/// The contents of a plain file: devices and pipes may never end.
pub fn read_plain(path: &Path) -> std::io::Result<Vec<u8>> {
    let about = std::fs::metadata(path)?;
    if about.is_dir() {
        return Err(std::io::Error::other("it is a folder"));
    }
    if !about.is_file() {
        return Err(std::io::Error::other("it is no plain file"));
    }
    std::fs::read(path)
}

fn checked(mut imported: Imported, path: &Path) -> Result<Imported, ImportError> {
    let fault = |source| ImportError::Mesh { path: path.to_owned(), source };
    if imported.parts.is_empty() {
        return Err(fault(MeshError::Empty));
    }
    imported.parts.iter().try_for_each(|part| part.mesh.check()).map_err(fault)?;
    if imported.parts.iter().any(|part| part.mesh.clay) {
        if imported.lights.is_empty() {
            imported.notes.push(CLAY_NOTE.to_owned());
        } else {
            // Light shows its shape.
            imported.parts.iter_mut().for_each(|part| Arc::make_mut(&mut part.mesh).repaint(Paint::CLAY));
        }
    }
    Ok(imported)
}

/// Said of what has no colours.
pub(super) const CLAY_NOTE: &str = "the mesh has no colours; painted in clay by the direction its faces look";

/// Reads an OBJ file held in memory, its material library beside it.
///
/// # Errors
/// As [`import`].
pub fn import_obj(obj: &str, mtl: &str, name: &str) -> Result<Imported, ImportError> {
    let path = Path::new(name);
    let imported = obj::parse(obj.as_bytes(), path, &|_| Ok(mtl.as_bytes().to_vec()))?;
    checked(imported, path)
}

/// Reads the bytes of a file a mesh file names.
type ReadFile<'a> = &'a dyn Fn(&Path) -> Result<Vec<u8>, ImportError>;

/// Once is enough.
fn note_once(notes: &mut Vec<String>, note: &str) {
    if !notes.iter().any(|n| n == note) {
        notes.push(note.to_owned());
    }
}

/// The material of that index in plain colours, for what has no texture coordinates: its index.
fn without_textures(materials: &mut Vec<Material>, index: usize) -> usize {
    let plain = Material { base_texture: None, emission_texture: None, ..materials[index].clone() };
    place_of(materials, plain)
}

/// The material of that index where colours at vertices stand for its own: its index.
fn under_paint(materials: &mut Vec<Material>, index: usize) -> usize {
    let white = Material { base_color: [1.0; 3], ..materials[index].clone() };
    place_of(materials, white)
}

fn place_of(materials: &mut Vec<Material>, material: Material) -> usize {
    materials.iter().position(|m| *m == material).unwrap_or_else(|| {
        materials.push(material);
        materials.len() - 1
    })
}

/// A path written in a file, seen from where that file is.
fn beside(file: &Path, named: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(named)
}
