//! Wavefront OBJ and its material library.

use super::files::{File, Pictures, name_of, stem};
use super::{Model, Surface};
use crate::scene::{Material, Texture, Wrap};
use std::collections::HashMap;
use std::fmt::Write;
use std::path::Path;

/// Lines of one kind, each once, numbered from 1.
#[derive(Default)]
struct Lines<const N: usize> {
    numbers: HashMap<[u64; N], usize>,
    text: String,
}

impl<const N: usize> Lines<N> {
    fn number(&mut self, keyword: &str, values: [f64; N]) -> usize {
        let next = self.numbers.len() + 1;
        *self.numbers.entry(values.map(f64::to_bits)).or_insert_with(|| {
            self.text.push_str(keyword);
            for value in values {
                let _ = write!(self.text, " {value}");
            }
            self.text.push('\n');
            next
        })
    }
}

/// The mesh, its materials, and the pictures of these. What OBJ cannot carry is left out: the Doppler factor, unlit
/// and one-sided materials, a picture's colour where there are vertex colours too.
pub(super) fn encode(model: &Model, path: &Path) -> Vec<File> {
    let mut pictures = Pictures::default();
    let mut materials: Vec<&Material> = Vec::new();
    let (mut plain, mut colored) = (Lines::<3>::default(), Lines::<6>::default());
    let (mut uvs, mut normals) = (Lines::<2>::default(), Lines::<3>::default());
    let mut faces = String::new();
    // Readers take colours only if every vertex has them.
    let has_colors = model.surfaces().any(|(_, s)| !s.first().colors.is_empty());
    for object in &model.objects {
        let _ = writeln!(faces, "o {}", name_of(&object.name));
        for surface in &object.surfaces {
            let material = materials.iter().position(|m| **m == surface.material).unwrap_or_else(|| {
                materials.push(&surface.material);
                materials.len() - 1
            });
            let _ = writeln!(faces, "usemtl {}", material_name(material, &surface.material));
            let frame = surface.first();
            let placed = surface.placed_uv();
            let vertices: Vec<String> = (0..frame.positions.len())
                .map(|i| {
                    let position = frame.positions[i].to_array();
                    let vertex = if has_colors {
                        let [x, y, z] = position;
                        let [r, g, b] = vertex_color(surface, i).map(short);
                        colored.number("v", [x, y, z, r, g, b])
                    } else {
                        plain.number("v", position)
                    };
                    let uv = placed.get(i).map(|uv| uvs.number("vt", [uv.x, 1.0 - uv.y]).to_string());
                    let normal = normals.number("vn", frame.normals[i].to_array().map(short));
                    format!("{vertex}/{}/{normal}", uv.unwrap_or_default())
                })
                .collect();
            for triangle in &surface.triangles {
                let [a, b, c] = triangle.map(|v| &vertices[v as usize]);
                let _ = writeln!(faces, "f {a} {b} {c}");
            }
        }
    }
    let mut library = format!("# terrell {}\n", env!("CARGO_PKG_VERSION"));
    for (number, material) in materials.iter().enumerate() {
        describe(&mut library, number, material, &mut pictures, path);
    }
    let library_name = format!("{}.mtl", stem(path));
    let obj = format!(
        "# terrell {}: {}\nmtllib {library_name}\n{}{}{}{}{faces}",
        env!("CARGO_PKG_VERSION"),
        name_of(&model.name),
        plain.text,
        colored.text,
        uvs.text,
        normals.text
    );
    let mut files = vec![
        File { path: path.to_owned(), contents: obj.into_bytes() },
        File { path: path.with_file_name(library_name), contents: library.into_bytes() },
    ];
    files.extend(pictures.files(path));
    files
}

/// The shortest decimal that reads as the same f32.
fn short(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(0.0)
}

/// Vertex colours stand for the material's own.
fn vertex_color(surface: &Surface, vertex: usize) -> [f32; 3] {
    let paint = surface.first().colors.get(vertex).copied().unwrap_or([1.0; 3]);
    let base = surface.material.base_color;
    [0, 1, 2].map(|i| paint[i] * base[i])
}

fn material_name(number: usize, material: &Material) -> String {
    let name = name_of(&material.name);
    if name.is_empty() { format!("material{number}") } else { format!("{name}.{number}") }
}

fn describe(out: &mut String, number: usize, material: &Material, pictures: &mut Pictures, path: &Path) {
    let rgb = |c: [f32; 3]| format!("{} {} {}", c[0], c[1], c[2]);
    let _ = writeln!(out, "newmtl {}\nKd {}", material_name(number, material), rgb(material.base_color));
    let emits = material.emission != [0.0; 3];
    if emits {
        let _ = writeln!(out, "Ke {}", rgb(material.emission));
    }
    let mut map = |keyword: &str, texture: &Option<Texture>| {
        if let Some(texture) = texture {
            let index = pictures.number(&texture.picture);
            let clamp = if texture.wrap == [Wrap::Clamp; 2] { "-clamp on " } else { "" };
            let _ = writeln!(out, "{keyword} {clamp}{}", pictures.name(index, path));
        }
    };
    map("map_Kd", &material.base_texture);
    if emits {
        map("map_Ke", &material.emission_texture);
    }
}
