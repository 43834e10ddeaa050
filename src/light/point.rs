use glam::DVec3;
use terrell_geodesic::{FourVector, Rest};

/// A point of a surface at one moment, in its body's rest frame.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// From the observer's event to it, in space.
    pub offset: DVec3,
    /// How long ago, in the rest frame's time: what is seen directly, as long as it is far away.
    pub ago: f64,
    /// The surface's normal, a unit vector, on the side that is seen.
    pub normal: DVec3,
    /// The direction the light leaves in, a unit vector.
    pub to_eye: DVec3,
}

impl Point {
    /// A point the observer sees, whose mesh has the normal `normal`, on a surface that lies square to `facing`: both are
    /// turned so that the observer sees the surface's side they are on.
    pub fn new(offset: DVec3, facing: DVec3, normal: DVec3) -> Self {
        let length = offset.length();
        let to_eye = if length > 0.0 && length.is_finite() { -offset / length } else { -DVec3::Z };
        Self::seen_from(FourVector::from_parts(-length, offset), to_eye, facing, normal)
    }

    /// A point at any event, from the observer's, that is seen from the direction `to_eye`, a unit vector.
    pub fn seen_from(event: FourVector<Rest>, to_eye: DVec3, facing: DVec3, normal: DVec3) -> Self {
        let unit = |normal: DVec3| turned(to_eye, facing, normal).try_normalize();
        let normal = unit(normal).or_else(|| unit(facing)).unwrap_or(DVec3::Z);
        Self { offset: event.xyz(), ago: -event.t, normal, to_eye }
    }

    /// From the observer's event to it.
    pub fn event(&self) -> FourVector<Rest> {
        FourVector::from_parts(-self.ago, self.offset)
    }
}

/// A normal of a surface that lies square to `facing`, on the side that is seen.
#[inline]
pub(super) fn turned(to_eye: DVec3, facing: DVec3, normal: DVec3) -> DVec3 {
    // On the side of `facing`, which is on that of the eye.
    if (normal.dot(facing) < 0.0) == (facing.dot(to_eye) < 0.0) { normal } else { -normal }
}
