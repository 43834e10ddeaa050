//! Meshes out of files.

mod gltf;
mod obj;

use super::{Mesh, MeshError};
use std::path::{Path, PathBuf};

/// A mesh file, read.
#[derive(Clone, Debug, Default)]
pub struct Imported {
    /// Everything in the file, in the file's own coordinates.
    pub mesh: Mesh,
    /// What was passed over, for people to read.
    pub notes: Vec<String>,
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
    /// Not a format we read.
    #[error("{}: only .obj, .gltf and .glb meshes can be read", .0.display())]
    UnknownFormat(PathBuf),
}

/// Whether a path has the ending of a mesh file we read.
pub fn is_mesh_file(path: &Path) -> bool {
    matches!(ending(path).as_str(), "obj" | "gltf" | "glb")
}

fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}

/// Reads an OBJ (with its MTL), glTF or GLB file.
///
/// # Errors
/// If it cannot be read, is malformed, or holds nothing that can be drawn.
pub fn import(path: &Path) -> Result<Imported, ImportError> {
    let contents = |path: &Path| {
        std::fs::read(path).map_err(|source| ImportError::Read { path: path.to_owned(), source })
    };
    let imported = match ending(path).as_str() {
        "obj" => obj::parse(&contents(path)?, path, &contents)?,
        "gltf" | "glb" => gltf::parse(&contents(path)?, path, &contents)?,
        _ => return Err(ImportError::UnknownFormat(path.to_owned())),
    };
    imported.mesh.check().map_err(|source| ImportError::Mesh { path: path.to_owned(), source })?;
    Ok(imported)
}

/// Reads an OBJ file held in memory, its material library beside it.
///
/// # Errors
/// As [`import`].
pub fn import_obj(obj: &str, mtl: &str, name: &str) -> Result<Imported, ImportError> {
    let path = Path::new(name);
    let imported = obj::parse(obj.as_bytes(), path, &|_| Ok(mtl.as_bytes().to_vec()))?;
    imported.mesh.check().map_err(|source| ImportError::Mesh { path: path.to_owned(), source })?;
    Ok(imported)
}

/// Reads the bytes of a file a mesh file names.
type ReadFile<'a> = &'a dyn Fn(&Path) -> Result<Vec<u8>, ImportError>;

/// A path written in a file, seen from where that file is.
fn beside(file: &Path, named: &Path) -> PathBuf {
    file.parent().unwrap_or(Path::new("")).join(named)
}
