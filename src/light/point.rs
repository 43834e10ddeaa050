use glam::DVec3;

/// A point of a surface in its body's rest frame. All vectors but `offset` are unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// From the observer's event to it, in space; as long ago as it is far away.
    pub offset: DVec3,
    /// The surface's normal, on the side the observer sees.
    pub normal: DVec3,
}

impl Point {
    /// A point whose mesh has the normal `normal`, on a surface that lies square to `facing`: both are turned so that the
    /// observer sees the surface's side they are on.
    pub fn new(offset: DVec3, facing: DVec3, normal: DVec3) -> Self {
        let facing = if facing.dot(offset) > 0.0 { -facing } else { facing };
        let normal = if normal.dot(facing) < 0.0 { -normal } else { normal };
        Self { offset, normal: normal.normalize_or(facing.normalize_or(DVec3::Z)) }
    }

    /// The direction the light leaves in.
    pub(super) fn to_eye(self) -> DVec3 {
        -self.offset.normalize_or(DVec3::Z)
    }
}
