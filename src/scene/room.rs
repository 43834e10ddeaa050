use super::{Material, Mesh};

/// The most vertices, or triangles where there are more, that may be kept of so many bytes of files.
///
/// A few words of a file can use a mesh any number of times, and every use may have to be kept by itself: memory stays
/// in proportion to what is read only if that is bounded, here far beyond what scenes made by people use.
pub(super) fn most_vertices(bytes: usize) -> usize {
    bytes.saturating_mul(16).saturating_add(2_000_000)
}

/// What is kept of files, against the most that may be.
#[derive(Debug)]
pub(super) struct Room {
    bytes: usize,
    kept: usize,
    remedy: &'static str,
}

impl Room {
    /// Room for what so many bytes hold; `remedy` says what to do where that is more than may be kept.
    pub fn new(bytes: usize, remedy: &'static str) -> Self {
        Self { bytes, kept: 0, remedy }
    }

    /// How many bytes were read.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// More was read.
    pub fn widen(&mut self, bytes: usize) {
        self.bytes = self.bytes.saturating_add(bytes);
    }

    /// Takes room for so many vertices, or what needs about as much memory.
    ///
    /// # Errors
    /// With what was counted, the limit, and what to try.
    pub fn take(&mut self, count: usize) -> Result<(), String> {
        self.kept = self.kept.saturating_add(count);
        let (kept, most, bytes) = (self.kept, most_vertices(self.bytes), self.bytes);
        if kept <= most {
            return Ok(());
        }
        Err(format!(
            "with every use of its meshes counted it has {kept} vertices or triangles at least, but {bytes} bytes of \
             scenes and meshes may have {most} at most (2000000, and 16 a byte); {}",
            self.remedy
        ))
    }
}

/// What a mesh takes of a [`Room`].
pub(super) fn size(mesh: &Mesh) -> usize {
    // A vertex takes some 64 bytes.
    let own = size_of::<Material>() / 64;
    let materials: usize = mesh.materials.iter().map(|material| own + named_size(&material.name)).sum();
    mesh.vertex_count().max(mesh.triangles.len()).max(materials)
}

/// What something small takes of a [`Room`]; names may be long, and used often.
pub(super) fn named_size(name: &str) -> usize {
    1 + name.len() / 64
}
