//! PLY: one list of vertices, colours at these alone.

use super::{ExportError, Model};
use crate::color::encoded;
use glam::{DVec2, DVec3};
use std::path::Path;

/// Little-endian: x y z nx ny nz u v as 32-bit numbers, red green blue as 8-bit sRGB, doppler.
pub(super) fn encode(model: &Model, path: &Path) -> Result<Vec<u8>, ExportError> {
    let (low, high) = model.bounds();
    let size = low.abs().max(high.abs()).max_element();
    if size > f64::from(f32::MAX) {
        return Err(ExportError::TooLarge { path: path.to_owned(), size });
    }
    if model.vertex_count() > u32::MAX as usize {
        return Err(ExportError::TooLong(path.to_owned()));
    }
    let properties: String =
        ["x", "y", "z", "nx", "ny", "nz", "u", "v"].map(|name| format!("property float {name}\n")).concat();
    let mut out = format!(
        "ply\nformat binary_little_endian 1.0\ncomment terrell {}\nelement vertex {}\n{properties}property uchar red\n\
         property uchar green\nproperty uchar blue\nproperty float doppler\nelement face {}\n\
         property list uchar uint vertex_indices\nend_header\n",
        env!("CARGO_PKG_VERSION"),
        model.vertex_count(),
        model.triangle_count()
    )
    .into_bytes();
    for (_, surface) in model.surfaces() {
        let frame = surface.first();
        for (i, position) in frame.positions.iter().enumerate() {
            let uv = surface.uv.get(i).copied().unwrap_or_default();
            let paint = frame.colors.get(i).copied().unwrap_or([1.0; 3]);
            let look = |texture: &crate::scene::Texture| {
                texture.at(DVec2::from_array(uv.map(f64::from)), [DVec2::ZERO; 2])
            };
            let color = surface.material.color(paint, look).map(encoded);
            let DVec3 { x, y, z } = *position;
            let numbers = [x as f32, y as f32, z as f32].into_iter();
            // Counted from below, as PLY readers do.
            let numbers = numbers.chain(frame.normals[i].to_array()).chain([uv[0], 1.0 - uv[1]]);
            out.extend(numbers.flat_map(f32::to_le_bytes));
            out.extend(color);
            out.extend(frame.doppler[i].to_le_bytes());
        }
    }
    let mut shift = 0;
    for (_, surface) in model.surfaces() {
        for triangle in &surface.triangles {
            out.push(3);
            out.extend(triangle.iter().flat_map(|v| (v + shift).to_le_bytes()));
        }
        shift += surface.vertex_count() as u32;
    }
    Ok(out)
}
