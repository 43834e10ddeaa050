//! A POV-Ray scene: the meshes, shining by themselves, and the camera.

use super::files::{File, Pictures, name_of};
use super::{Eye, Model, Surface};
use crate::scene::{Material, Texture, Wrap};
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// The scene and its pictures. What POV-Ray cannot do is left out: mirrored textures, and emission where a
/// texture is involved besides the base colour's.
pub(super) fn encode(model: &Model, path: &Path) -> Vec<File> {
    let mut pictures = Pictures::opaque();
    let mut out = format!("// terrell {}: {}\n", env!("CARGO_PKG_VERSION"), name_of(&model.name));
    if let Some(eye) = &model.eye {
        let [width, height] = eye.size;
        let _ = writeln!(
            out,
            "// povray +I{} +W{width} +H{height} +A0.01",
            path.file_name().unwrap_or_default().to_string_lossy()
        );
    }
    out.push_str("#version 3.7;\nglobal_settings { assumed_gamma 1.0 }\nbackground { color rgb 0 }\n");
    let scale = scale_of(model);
    if scale != 1.0 {
        let _ = writeln!(out, "// all lengths times {scale:e}, as POV-Ray sees nothing beyond 1e7");
    }
    if let Some(eye) = &model.eye {
        look(&mut out, eye, scale);
    }
    for (name, surface) in model.surfaces() {
        let _ = writeln!(out, "// {}", name_of(name));
        mesh(&mut out, surface, scale, &mut pictures, path);
    }
    let mut files = vec![File { path: path.to_owned(), contents: out.into_bytes() }];
    files.extend(pictures.files(path));
    files
}

/// What brings everything to where POV-Ray sees it; a picture stays the same.
fn scale_of(model: &Model) -> f64 {
    const FAR: f64 = 1e5;
    let (low, high) = model.bounds();
    let eye = model.eye.as_ref().map_or(0.0, |eye| eye.positions[0].abs().max_element());
    let farthest = low.abs().max(high.abs()).max_element().max(eye);
    if farthest > FAR { 10f64.powf((FAR / farthest).log10().floor()) } else { 1.0 }
}

fn triple(v: [f64; 3]) -> String {
    format!("<{},{},{}>", v[0], v[1], v[2])
}

fn rgb(v: [f32; 3]) -> String {
    format!("rgb <{},{},{}>", v[0], v[1], v[2])
}

/// Explicit vectors: that POV-Ray's usual axes are left-handed has no say then.
fn look(out: &mut String, eye: &Eye, scale: f64) {
    let [right, up, forward] = eye.axes;
    let aspect = f64::from(eye.size[0]) / f64::from(eye.size[1]);
    let _ = writeln!(
        out,
        "camera {{\n  perspective\n  location {}\n  right {}\n  up {}\n  direction {}\n}}",
        triple((eye.positions[0] * scale).to_array()),
        triple((right * aspect).to_array()),
        triple(up.to_array()),
        triple((forward * (0.5 / (0.5 * eye.field).tan())).to_array())
    );
}

fn list(out: &mut String, keyword: &str, values: impl ExactSizeIterator<Item = String>) {
    let _ = write!(out, "  {keyword} {{\n    {}", values.len());
    for value in values {
        let _ = write!(out, ",\n    {value}");
    }
    out.push_str("\n  }\n");
}

fn mesh(out: &mut String, surface: &Surface, scale: f64, pictures: &mut Pictures, path: &Path) {
    let frame = surface.first();
    let textured = surface.material.base_texture.as_ref();
    out.push_str("mesh2 {\n");
    list(out, "vertex_vectors", frame.positions.iter().map(|p| triple((*p * scale).to_array())));
    list(out, "normal_vectors", frame.normals.iter().map(|n| triple(n.to_array().map(f64::from))));
    let placed = surface.placed_uv();
    if textured.is_some() {
        list(out, "uv_vectors", placed.iter().map(|uv| format!("<{},{}>", uv.x, 1.0 - uv.y)));
    }
    let has_colors = !frame.colors.is_empty() && textured.is_none();
    if has_colors {
        let mut known = HashMap::new();
        let mut shades = Vec::new();
        let shade: Vec<usize> = frame
            .colors
            .iter()
            .map(|paint| {
                let color = shown(&surface.material, *paint);
                // Steps too fine to be seen in 8 bits.
                let key = color.map(|v| (4096.0 * v.max(0.0).sqrt()) as i64);
                *known.entry(key).or_insert_with(|| {
                    shades.push(glow(&format!("color {}", rgb(color)), [1.0; 3]));
                    shades.len() - 1
                })
            })
            .collect();
        list(out, "texture_list", shades.into_iter());
        let faces = surface.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| shade[v as usize]);
            format!("<{},{},{}>,{a},{b},{c}", t[0], t[1], t[2])
        });
        list(out, "face_indices", faces);
    } else {
        list(out, "face_indices", surface.triangles.iter().map(|t| format!("<{},{},{}>", t[0], t[1], t[2])));
        match textured {
            Some(texture) => {
                let map = image_map(texture, pictures, path);
                let _ = writeln!(out, "  uv_mapping\n  {}", glow(&map, surface.material.base_color));
            }
            None => {
                let color = rgb(shown(&surface.material, [1.0; 3]));
                let _ = writeln!(out, "  {}", glow(&format!("color {color}"), [1.0; 3]));
            }
        }
    }
    out.push_str("}\n");
}

/// The colour of what has no texture.
fn shown(material: &Material, paint: [f32; 3]) -> [f32; 3] {
    let plain = Material { emission_texture: None, ..material.clone() };
    plain.color(paint, |_| [1.0; 3])
}

fn glow(pigment: &str, times: [f32; 3]) -> String {
    format!("texture {{ pigment {{ {pigment} }} finish {{ emission {} diffuse 0 ambient 0 }} }}", rgb(times))
}

fn image_map(texture: &Texture, pictures: &mut Pictures, path: &Path) -> String {
    let index = pictures.number(&texture.picture);
    let name = pictures.name(index, path);
    let once = if texture.wrap == [Wrap::Clamp; 2] { " once" } else { "" };
    let blend = if texture.blocky { "" } else { " interpolate 2" };
    format!("image_map {{ png \"{name}\" gamma srgb map_type 0{once}{blend} }}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn the_camera_sees_its_whole_field() {
        let axes = [DVec3::X, DVec3::Z, DVec3::Y];
        let eye = Eye { positions: vec![DVec3::ONE], axes, field: 90f64.to_radians(), size: [200, 100] };
        let mut out = String::new();
        look(&mut out, &eye, 1.0);
        assert!(out.contains("right <2,0,0>") && out.contains("up <0,0,1>"), "{out}");
        // Half the height at half the height's distance: 45° above and below.
        let direction = out.split("direction <0,").nth(1).unwrap();
        let y: f64 = direction.split(',').next().unwrap().parse().unwrap();
        assert!((y - 0.5).abs() < 1e-15, "{out}");
    }
}
