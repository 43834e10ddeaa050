//! Meshes to files of other programs: GLB, OBJ, PLY and POV-Ray. What the meshes are is of no concern here.
//!
//! Everything is right-handed; units and axes are the caller's.

mod files;
mod glb;
mod obj;
mod ply;
mod pov;

use crate::scene::{Material, Texture};
use glam::{DVec2, DVec3, Vec3};
use std::path::{Path, PathBuf};

pub use files::{prepare, write};

/// What is written to a file.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// What it is called.
    pub name: String,
    /// In the scene's order.
    pub objects: Vec<Object>,
    /// From where it is looked at.
    pub eye: Option<Eye>,
    /// Seconds at which every frame is shown, from 0 up; one for what stands still.
    pub times: Vec<f64>,
    /// What it was made with, for programs.
    pub extras: serde_json::Map<String, serde_json::Value>,
}

/// A mesh of one or several materials.
#[derive(Clone, Debug, Default)]
pub struct Object {
    /// What it is called.
    pub name: String,
    /// One a material.
    pub surfaces: Vec<Surface>,
}

/// Triangles of one material, with vertices of their own.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// What they are made of.
    pub material: Material,
    /// Vertex numbers, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Texture coordinates, one a vertex, v downwards; or none.
    pub uv: Vec<[f32; 2]>,
    /// At every time of the model.
    pub frames: Vec<Frame>,
}

/// A surface at one time.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Of the vertices.
    pub positions: Vec<DVec3>,
    /// Unit normals, one a vertex.
    pub normals: Vec<Vec3>,
    /// Linear colours times the material's, one a vertex; or none.
    pub colors: Vec<[f32; 3]>,
    /// Doppler factor, one a vertex.
    pub doppler: Vec<f32>,
}

/// A pinhole camera.
#[derive(Clone, Debug)]
pub struct Eye {
    /// At every time of the model.
    pub positions: Vec<DVec3>,
    /// Right, up and forward in the picture; right-handed with forward turned round.
    pub axes: [DVec3; 3],
    /// Full vertical field in radians.
    pub field: f64,
    /// Pixels across and down.
    pub size: [u32; 2],
}

/// Formats that are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Binary glTF 2.0, one file.
    Glb,
    /// Wavefront OBJ, with an MTL file and pictures beside it.
    Obj,
    /// Binary PLY, vertex colours only.
    Ply,
    /// A complete POV-Ray scene, with pictures beside it.
    Pov,
}

/// Why a model cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// An ending we do not know.
    #[error("{}: unknown mesh format{}; write to a .glb, .obj, .ply or .pov file", .0.display(), .0.extension().map(|e| format!(" '.{}'", e.to_string_lossy())).unwrap_or_default())]
    UnknownFormat(PathBuf),
    /// Coordinates the format cannot hold.
    #[error("{}: coordinates of {size:.1e} are beyond the 32-bit numbers of the format; scale the scene down", .path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The greatest.
        size: f64,
    },
    /// More data than the format can hold.
    #[error("{}: the file would be larger than 4 GB, which the format cannot hold; use a larger tolerance or fewer frames", .0.display())]
    TooLong(PathBuf),
    /// A format for still meshes.
    #[error("{}: only .glb files can hold an animation", .0.display())]
    Still(PathBuf),
    /// The place cannot be written to.
    #[error(transparent)]
    Write(#[from] crate::picture::WriteError),
}

impl Format {
    /// By a file's ending.
    ///
    /// # Errors
    /// On an ending we do not know.
    pub fn of(path: &Path) -> Result<Self, ExportError> {
        match path.extension().map(|e| e.to_string_lossy().to_lowercase()).as_deref() {
            Some("glb") => Ok(Self::Glb),
            Some("obj") => Ok(Self::Obj),
            Some("ply") => Ok(Self::Ply),
            Some("pov") => Ok(Self::Pov),
            _ => Err(ExportError::UnknownFormat(path.to_owned())),
        }
    }
}

impl Model {
    /// All surfaces, with the names of their objects.
    fn surfaces(&self) -> impl Iterator<Item = (&str, &Surface)> {
        self.objects.iter().flat_map(|o| o.surfaces.iter().map(|s| (o.name.as_str(), s)))
    }

    /// How many vertices there are.
    pub fn vertex_count(&self) -> usize {
        self.surfaces().map(|(_, s)| s.vertex_count()).sum()
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.surfaces().map(|(_, s)| s.triangles.len()).sum()
    }

    /// Least and greatest coordinates of all vertices at all times; zeros if there are none.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let frames = self.surfaces().flat_map(|(_, s)| &s.frames);
        let both = |range: Option<(DVec3, DVec3)>, p: &DVec3| {
            Some(range.map_or((*p, *p), |(low, high)| (low.min(*p), high.max(*p))))
        };
        frames.flat_map(|f| &f.positions).fold(None, both).unwrap_or_default()
    }
}

impl Surface {
    fn vertex_count(&self) -> usize {
        self.frames.first().map_or(0, |f| f.positions.len())
    }

    /// As it is at the beginning.
    fn first(&self) -> &Frame {
        &self.frames[0]
    }

    /// Texture coordinates as the base picture counts, else the emission's: its transform done.
    fn placed_uv(&self) -> Vec<DVec2> {
        let texture = self.material.base_texture.as_ref().or(self.material.emission_texture.as_ref());
        let place = |t: &Texture, uv: DVec2| t.transform.transform_point2(uv);
        let uv = |uv: &[f32; 2]| DVec2::from_array(uv.map(f64::from));
        self.uv.iter().map(|c| texture.map_or(uv(c), |t| place(t, uv(c)))).collect()
    }
}
