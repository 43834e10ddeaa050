use super::picture::decode;
use super::{ImportError, Imported, Part, ReadFile, beside, note_once, under_paint, without_textures};
use crate::scene::{Material, Mesh, Paint, Picture, Texture, Wrap};
use glam::{DAffine2, DVec2, DVec3};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// OBJ with MTL colours (taken as linear) and textures, or vertex colours; triangles are numbered in the file's
/// order, polygons cut into triangles.
pub(super) fn parse(bytes: &[u8], path: &Path, read: ReadFile<'_>) -> Result<Imported, ImportError> {
    let fault = |line, message: String| ImportError::Contents { path: path.to_owned(), line, message };
    if let Some(at) = bytes.iter().position(|&b| b == 0) {
        let line = 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count();
        return Err(fault(Some(line), "this is not text, so no OBJ file".into()));
    }
    // Names and comments may be in any encoding.
    let original = String::from_utf8_lossy(bytes);
    let (text, half_colored) = cleaned(&original);
    let text = &text;
    // The parser underneath computes with indices before it checks them all.
    if let Some(line) = faulty_line(text, bad_index) {
        return Err(fault(Some(line), format!("an index that leads nowhere in '{}'", line_of(text, line))));
    }
    let notes = RefCell::new(Vec::new());
    let options = tobj::LoadOptions { single_index: true, ..tobj::LoadOptions::default() };
    let libraries = RefCell::new(path.to_owned());
    let read_bytes = Cell::new(bytes.len());
    let named = RefCell::new(BTreeSet::new());
    let load_materials = |library: &Path| {
        let library = beside(path, library);
        // Named again, it brings nothing new.
        if !named.borrow_mut().insert(library.clone()) {
            return Ok(Default::default());
        }
        match read(&library) {
            Ok(bytes) => {
                read_bytes.set(read_bytes.get() + bytes.len());
                let (text, _) = cleaned(&String::from_utf8_lossy(&bytes));
                *libraries.borrow_mut() = library;
                tobj::load_mtl_buf(&mut without_odd_colors(&text).as_bytes())
            }
            Err(e) => {
                notes.borrow_mut().push(format!("no material colours: {e}"));
                Err(tobj::LoadError::OpenFileFailed)
            }
        }
    };
    let (models, materials) =
        tobj::load_obj_buf(&mut text.as_bytes(), &options, load_materials).map_err(|e| {
            let line = faulty_line(text, bad_number);
            let what = line.map(|l| format!(" in '{}'", line_of(text, l)));
            fault(line, format!("{e}{}", what.unwrap_or_default()))
        })?;
    let materials = materials.unwrap_or_else(|e| {
        if e != tobj::LoadError::OpenFileFailed {
            notes.borrow_mut().push(format!("no material colours: the material library is malformed ({e})"));
        }
        Vec::new()
    });
    let mut library =
        Library { folder: libraries.into_inner(), read, pictures: HashMap::new(), notes: notes.into_inner() };
    // Two more: for what has none, and for what has colours at its vertices.
    let mut made: Vec<Material> = materials.iter().map(|m| library.material(m)).collect();
    let (plain, white) = (made.len(), made.len() + 1);
    made.extend([Material { base_color: Paint::CLAY, ..Material::default() }, Material::default()]);

    let mut mesh = Mesh::default();
    let mut colored = false;
    for model in models {
        let source = model.mesh;
        let coordinate = |i: usize| source.positions.iter().skip(i).step_by(3).copied().collect();
        let triples = |values: &[f64]| -> Vec<[f32; 3]> {
            values.chunks_exact(3).map(|v| [v[0] as f32, v[1] as f32, v[2] as f32]).collect()
        };
        let material = source.material_id.filter(|id| *id < materials.len());
        let count = source.positions.len() / 3;
        let has_color = |id: usize| materials[id].diffuse.is_some() || made[id].is_textured();
        colored |= material.is_some_and(has_color) || !source.vertex_color.is_empty();
        let painted = !source.vertex_color.is_empty();
        let mut part = Mesh {
            x: coordinate(0),
            y: coordinate(1),
            z: coordinate(2),
            paint: if painted {
                Paint::Vertices(triples(&source.vertex_color))
            } else {
                Paint::Uniform([1.0; 3])
            },
            // Where only some corners have them, they cannot be told apart any more. MTL counts from below.
            uv: if source.texcoords.len() / 2 == count {
                source.texcoords.chunks_exact(2).map(|v| [v[0] as f32, (1.0 - v[1]) as f32]).collect()
            } else {
                Vec::new()
            },
            normals: if source.normals.len() / 3 == count { triples(&source.normals) } else { Vec::new() },
            ..Mesh::default()
        };
        let crossed;
        (part.triangles, crossed) = triangulated(&source.indices, &source.face_arities, &part);
        if crossed {
            library.note("a polygon crosses itself: what it covers is a guess");
        }
        let mut index = material.unwrap_or(plain);
        if painted {
            // Vertex colours stand for the material's own; a texture stays.
            index = match material {
                Some(id) => under_paint(&mut made, id),
                None => white,
            };
        }
        if part.uv.is_empty() && made[index].is_textured() {
            library.note("textures without texture coordinates are left out");
            index = without_textures(&mut made, index);
        }
        part.material = vec![index as u32; part.triangles.len()];
        if !part.triangles.is_empty() {
            mesh.append(part);
        }
    }
    mesh.materials = made;
    let names: HashSet<&str> = materials.iter().map(|m| m.name.as_str()).collect();
    let unknown = used_materials(text).find(|name| !names.contains(name));
    if let Some(name) = unknown.filter(|_| !materials.is_empty()) {
        library.note(&format!("there is no material '{name}' in the library; what uses it is grey"));
    }
    let mut notes = library.notes;
    if half_colored {
        notes.push("only some vertices have colours; they are left out".into());
    }
    if !colored {
        (mesh.materials, mesh.material) = (Vec::new(), Vec::new());
        mesh.paint_as_clay();
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let (parts, bytes) = (vec![Part::still(name, mesh)], read_bytes.get());
    Ok(Imported { parts, bytes, notes, ..Imported::default() })
}

/// The names of the materials that faces ask for.
fn used_materials(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter_map(|line| line.trim_start().strip_prefix("usemtl ")).map(str::trim)
}

/// Polygons as triangles: convex ones as fans, others by cutting ears off, so that what they leave open stays
/// open; and whether any crosses itself. Points and lines (one corner, two) are no surface.
fn triangulated(indices: &[u32], corners: &[u32], mesh: &Mesh) -> (Vec<[u32; 3]>, bool) {
    let (mut out, mut crossed) = (Vec::new(), false);
    let mut rest = indices;
    let all_triangles = corners.is_empty().then(|| std::iter::repeat_n(3, indices.len() / 3));
    let counts: Box<dyn Iterator<Item = usize>> = match all_triangles {
        Some(threes) => Box::new(threes),
        None => Box::new(corners.iter().map(|n| *n as usize)),
    };
    for count in counts {
        let Some((polygon, others)) = rest.split_at_checked(count) else { break };
        rest = others;
        match *polygon {
            [a, b, c] => out.push([a, b, c]),
            [a, _, _, ..] => match concave(polygon, mesh) {
                None => {
                    crossed |= is_balanced(polygon, mesh);
                    out.extend(polygon[1..].windows(2).map(|w| [a, w[0], w[1]]));
                }
                Some(flat) => {
                    let mut ears: Vec<u32> = Vec::new();
                    earcut::Earcut::new().earcut(flat.iter().map(|p| p.to_array()), &[], &mut ears);
                    crossed |= is_crossed(&flat, &ears);
                    out.extend(ears.chunks_exact(3).map(|t| {
                        let [p, q, r] = [0, 1, 2].map(|i| flat[t[i] as usize]);
                        let left = (q - p).perp_dot(r - p) >= 0.0;
                        let corner = |i: usize| polygon[t[i] as usize];
                        if left { [0, 1, 2].map(corner) } else { [0, 2, 1].map(corner) }
                    }));
                }
            },
            _ => {}
        }
    }
    (out, crossed)
}

/// A polygon's corners in its own plane, counter-clockwise, if it turns both ways there.
fn concave(polygon: &[u32], mesh: &Mesh) -> Option<Vec<DVec2>> {
    let at = |i: usize| mesh.vertex(polygon[i % polygon.len()]);
    // Twice the area, as a vector (Newell).
    let origin = at(0);
    let normal: DVec3 = (1..polygon.len() - 1).map(|i| (at(i) - origin).cross(at(i + 1) - origin)).sum();
    let normal = normal.try_normalize()?;
    let right = normal.any_orthonormal_vector();
    let up = normal.cross(right);
    let flat: Vec<DVec2> =
        (0..polygon.len()).map(|i| at(i) - origin).map(|p| DVec2::new(p.dot(right), p.dot(up))).collect();
    let corner = |i: usize| flat[i % flat.len()];
    let turns = |i: usize| {
        let (before, after) = (corner(i + 1) - corner(i), corner(i + 2) - corner(i + 1));
        before.perp_dot(after) < -1e-9 * before.length() * after.length()
    };
    // All turns to the left may still go round twice (a pentagram).
    let around: f64 = (0..flat.len())
        .map(|i| (corner(i + 1) - corner(i)).angle_to(corner(i + 2) - corner(i + 1)))
        .filter(|angle| angle.is_finite())
        .sum();
    let is_concave = (0..flat.len()).any(turns) || around > 7.0;
    (is_concave && !(flat.len() > MOST_TANGLED && is_tangled(&flat, around))).then_some(flat)
}

/// Whether a polygon goes round as much one way as the other, though its corners are in no line: a bow tie.
fn is_balanced(polygon: &[u32], mesh: &Mesh) -> bool {
    let at = |i: usize| mesh.vertex(polygon[i]) - mesh.vertex(polygon[0]);
    let parts = (1..polygon.len() - 1).map(|i| at(i).cross(at(i + 1)));
    let (whole, each) = parts.fold((DVec3::ZERO, 0.0), |(sum, each), p| (sum + p, each + p.length()));
    let size = (1..polygon.len()).map(|i| at(i).length_squared()).fold(0.0, f64::max);
    each > 1e-9 * size && whole.length() < 1e-9 * each
}

/// Whether triangles cover another area than their outline goes round: it crosses itself.
fn is_crossed(outline: &[DVec2], triangles: &[u32]) -> bool {
    let corner = |i: usize| outline[i % outline.len()];
    let around: f64 = (0..outline.len()).map(|i| 0.5 * corner(i).perp_dot(corner(i + 1))).sum();
    let area = |t: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|i| outline[t[i] as usize]);
        0.5 * (b - a).perp_dot(c - a).abs()
    };
    let covered: f64 = triangles.chunks_exact(3).map(area).sum();
    (covered - around.abs()).abs() > 1e-6 * covered.max(around.abs())
}

/// Corners of a polygon that crosses itself, beyond which it becomes a fan: cutting the ears off such a one takes
/// a time that grows as their cube.
const MOST_TANGLED: usize = 300;

/// Whether an outline surely is no plain one: it does not go round just once, or comes back again and again to
/// where it was (a hole that is joined to it makes it come back to two corners).
fn is_tangled(outline: &[DVec2], around: f64) -> bool {
    let places: HashSet<_> = outline.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
    (around - std::f64::consts::TAU).abs() > 0.1 || places.len() < outline.len() / 10 * 9
}

/// The materials of an OBJ file, and the pictures they name.
struct Library<'a> {
    /// The file that names them, for where they are.
    folder: PathBuf,
    read: ReadFile<'a>,
    pictures: HashMap<PathBuf, Option<Arc<Picture>>>,
    notes: Vec<String>,
}

impl Library<'_> {
    fn material(&mut self, source: &tobj::Material) -> Material {
        let texture = source.diffuse_texture.as_deref().and_then(|map| self.texture(map));
        let other = |key: &str| source.unknown_param.get(key).map(String::as_str);
        let emission_texture = other("map_Ke").and_then(|map| self.texture(map));
        let emission = source.emissive.map_or([0.0; 3], |c| c.map(|v| v as f32));
        if source.dissolve.is_some_and(|d| d < 1.0) {
            self.note("transparency is not drawn");
        }
        let color = source.diffuse.map(|c| c.map(|v| v as f32));
        Material {
            name: source.name.clone(),
            // Many programs write black where there is a texture, and do not mean it.
            base_color: match color {
                Some([0.0, 0.0, 0.0]) | None if texture.is_some() => [1.0; 3],
                color => color.unwrap_or(Paint::CLAY),
            },
            base_texture: texture,
            emission: if emission == [0.0; 3] && emission_texture.is_some() { [1.0; 3] } else { emission },
            emission_texture,
            ..Material::default()
        }
    }

    /// A texture statement: options, then the file's name, which may hold blanks.
    fn texture(&mut self, statement: &str) -> Option<Texture> {
        let mut words = statement.split_whitespace().peekable();
        let (mut scale, mut offset) = (DVec2::ONE, DVec2::ZERO);
        let mut wrap = Wrap::Repeat;
        let mut rest = statement.trim_start();
        while let Some(option) = words.next_if(|w| w.starts_with('-')) {
            let mut values = Vec::new();
            let most = match option {
                "-o" | "-s" | "-t" => 3,
                "-mm" => 2,
                _ => 1,
            };
            while values.len() < most {
                let is_number = |w: &&str| w.parse::<f64>().is_ok();
                match words.next_if(|w| is_number(w) || (most == 1 && values.is_empty())) {
                    Some(value) => values.push(value),
                    None => break,
                }
            }
            for word in std::iter::once(&option).chain(&values) {
                rest = rest.strip_prefix(word).unwrap_or(rest).trim_start();
            }
            let number = |i: usize, usual: f64| values.get(i).and_then(|v| v.parse().ok()).unwrap_or(usual);
            match option {
                "-s" => scale = DVec2::new(number(0, 1.0), number(1, 1.0)),
                "-o" => offset = DVec2::new(number(0, 0.0), number(1, 0.0)),
                "-clamp" if values == ["on"] => wrap = Wrap::Clamp,
                _ => {}
            }
        }
        let name = rest.trim().trim_matches('"').replace('\\', "/");
        let file = beside(&self.folder, Path::new(&name));
        let picture = match self.pictures.get(&file) {
            Some(picture) => picture.clone(),
            None => {
                let read = (self.read)(&file).map_err(|e| e.to_string());
                let picture = match read.and_then(|bytes| decode(&name, bytes)) {
                    Ok(picture) => Some(Arc::new(picture)),
                    Err(e) => {
                        self.note(&format!("without a texture: {e}"));
                        None
                    }
                };
                self.pictures.insert(file, picture.clone());
                picture
            }
        }?;
        // MTL has s·u + o with v upwards; here v goes down.
        let transform = DAffine2::from_scale_angle_translation(
            scale,
            0.0,
            DVec2::new(offset.x, 1.0 - scale.y - offset.y),
        );
        Some(Texture { wrap: [wrap; 2], transform, ..Texture::of(picture) })
    }

    /// Once is enough.
    fn note(&mut self, note: &str) {
        note_once(&mut self.notes, note);
    }
}

/// The text without what the parser underneath does not know: a byte order mark, comments behind statements,
/// lines continued on the next, colours on only some of the vertices. Lines keep their numbers.
///
/// Also says whether colours were taken off.
fn cleaned(text: &str) -> (String, bool) {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines: Vec<String> = Vec::new();
    let mut continued: Option<usize> = None;
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default().trim_end();
        let (line, goes_on) = line.strip_suffix('\\').map_or((line, false), |l| (l, true));
        match continued {
            Some(first) => {
                lines[first].push(' ');
                lines[first].push_str(line);
                lines.push(String::new());
            }
            None => lines.push(line.to_owned()),
        }
        continued = goes_on.then(|| continued.unwrap_or(lines.len() - 1));
    }
    let numbers = |line: &str| {
        let mut words = line.split_whitespace();
        (words.next() == Some("v")).then(|| words.count())
    };
    let colored = |line: &String| numbers(line).is_some_and(|n| n >= 6);
    let plain = |line: &String| numbers(line).is_some_and(|n| n < 6);
    let half_colored = lines.iter().any(colored) && lines.iter().any(plain);
    if half_colored {
        for line in lines.iter_mut().filter(|l| colored(l)) {
            *line = line.split_whitespace().take(4).collect::<Vec<_>>().join(" ");
        }
    }
    (lines.join("\n") + "\n", half_colored)
}

/// A material library without the lines the parser underneath would stumble over: colours that are not three
/// numbers (MTL has others, `Kd spectral …`).
fn without_odd_colors(text: &str) -> String {
    let good = |line: &&str| {
        let mut words = line.split_whitespace();
        let keyword = words.next().unwrap_or_default();
        if keyword.starts_with("map_") || keyword.starts_with("norm") || keyword.starts_with("bump") {
            return words.next().is_some();
        }
        let is_color = matches!(keyword, "Ka" | "Kd" | "Ks" | "Ke");
        !is_color || words.take(3).filter(|word| word.parse::<f64>().is_ok()).count() == 3
    };
    text.lines().filter(good).flat_map(|line| [line, "\n"]).collect()
}

fn line_of(text: &str, number: usize) -> &str {
    text.lines().nth(number - 1).unwrap_or_default().trim()
}

/// Positions, texture coordinates and normals so far.
type Counts = [u64; 3];

/// The first line (from 1) of which `is_bad`, given its keyword, the rest, and the counts before it.
fn faulty_line(text: &str, is_bad: fn(&str, &str, &Counts) -> bool) -> Option<usize> {
    let mut counts = Counts::default();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let (keyword, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if is_bad(keyword, rest, &counts) {
            return Some(number + 1);
        }
        if let Some(which) = ["v", "vt", "vn"].iter().position(|k| keyword == *k) {
            counts[which] += 1;
        }
    }
    None
}

/// Indices of a face count from 1, or backwards from −1.
fn bad_index(keyword: &str, rest: &str, counts: &Counts) -> bool {
    keyword == "f"
        && rest.split_whitespace().any(|corner| {
            corner.split('/').enumerate().any(|(which, index)| match index.parse::<i64>() {
                Ok(i) => which > 2 || i == 0 || i.unsigned_abs() > counts[which],
                Err(_) => !(index.is_empty() && which > 0),
            })
        })
}

fn bad_number(keyword: &str, rest: &str, _: &Counts) -> bool {
    let needed = match keyword {
        "v" | "vn" => 3,
        "vt" => 1,
        _ => return false,
    };
    let numbers = rest.split_whitespace().map(str::parse::<f64>);
    let good = numbers.clone().filter(Result::is_ok).count();
    good < needed || good < numbers.count()
}

#[cfg(test)]
mod tests {
    use super::super::import_obj;
    use super::*;

    const SQUARE: &str =
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\nusemtl none\nf -4 -3 -2\n";

    #[test]
    fn triangles_are_numbered_as_in_the_file_and_coloured_by_their_material() {
        let mesh = import_obj(SQUARE, "newmtl red\nKd 0.7 0.1 0.2\n", "square.obj").unwrap().into_mesh();
        assert_eq!(mesh.triangles.len(), 3);
        let notes = import_obj(SQUARE, "newmtl red\nKd 0.7 0.1 0.2\n", "square.obj").unwrap().notes;
        assert!(notes.iter().any(|n| n.contains("'none'")), "{notes:?}");
        let color = |t: usize| mesh.material_of(t).unwrap().base_color;
        assert_eq!(color(0), [0.7, 0.1, 0.2]);
        assert_eq!(color(1), color(0));
        assert_ne!(color(2), color(0));
        assert_eq!(mesh.corners(0).map(|c| (c.x, c.y)), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]);
    }

    #[test]
    fn a_bad_line_is_named() {
        for (text, line) in [
            ("v 0 0 0\nv 1 x 0\n", 2),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", 4),
            ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 zwei\n", 4),
            ("v 0 0\n", 1),
        ] {
            let message = import_obj(text, "", "bad.obj").unwrap_err().to_string();
            assert!(message.starts_with(&format!("bad.obj:{line}: ")), "{message}");
        }
    }

    #[test]
    fn nothing_to_draw_is_an_error() {
        for text in ["", "# empty\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"]
        {
            assert!(import_obj(text, "", "bad.obj").is_err(), "{text:?}");
        }
        assert!(parse(&[0xff, 0xfe, 0x00], Path::new("bad.obj"), &|_| Ok(vec![])).is_err());
    }

    #[test]
    fn what_other_programs_write_is_read() {
        let text = "\u{feff}v 0 0 0 # origin\r\nv 1 0 0 1 0 0\r\nv 0 1 \\\r\n0\r\nf 1 2 \\\r\n 3 # all\r\n";
        let mesh = import_obj(text, "", "a.obj").unwrap().into_mesh();
        assert_eq!(mesh.corners(0), [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y]);
    }

    #[test]
    fn vertex_colours_are_read() {
        let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
        let mesh = import_obj(text, "", "a.obj").unwrap().into_mesh();
        assert_eq!(mesh.paint.at(0, [0, 1, 2], [0.5, 0.25, 0.25]), [0.5, 0.25, 0.25]);
    }

    /// Area, with its sign by the direction it faces along z.
    fn area(mesh: &Mesh) -> f64 {
        let of = |[a, b, c]: [glam::DVec3; 3]| 0.5 * (b - a).cross(c - a).z;
        (0..mesh.triangles.len()).map(|t| of(mesh.corners(t))).sum()
    }

    #[test]
    fn polygons_that_turn_both_ways_keep_their_shape() {
        // An L, a frame with a slit from its hole to its rim, the L the other way round.
        let l = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
        let frame = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\n";
        for (text, expected) in [
            (format!("{l}f 1 2 3 4 5 6\n"), 3.0),
            (format!("{l}f 4 5 6 1 2 3\n"), 3.0),
            (format!("{l}f 6 5 4 3 2 1\n"), -3.0),
            (format!("{frame}f 1 2 3 4 1 5 6 7 8 5\n"), 8.0),
        ] {
            let mesh = import_obj(&text, "", "l.obj").unwrap().into_mesh();
            assert!((area(&mesh) - expected).abs() < 1e-12, "{text}: {}", area(&mesh));
            let covered: f64 = (0..mesh.triangles.len())
                .map(|t| mesh.corners(t))
                .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
                .sum();
            assert!((covered - expected.abs()).abs() < 1e-12, "{text}: nothing twice, {covered}");
        }
    }

    #[test]
    fn polygons_that_cross_themselves_are_told_of() {
        let bow = "v 0 0 0\nv 2 1 0\nv 2 0 0\nv 0 2 0\nf 1 2 3 4\n";
        let notes = import_obj(bow, "", "b.obj").unwrap().notes;
        assert!(notes.iter().any(|n| n.contains("crosses itself")), "{notes:?}");
    }

    #[test]
    fn textures_are_read_with_their_options() {
        let mut png = Vec::new();
        use image::ImageEncoder;
        image::codecs::png::PngEncoder::new(&mut png)
            .write_image(&[255, 0, 0, 0, 0, 255], 1, 2, image::ExtendedColorType::Rgb8)
            .unwrap();
        let mtl = "newmtl a\nKd 0 0 0\nmap_Kd -s 2 3 1 -o 0.5 0 -clamp on -bm 1 my pictures\\a b.png\nKe 0.1 0.2 0.3\n";
        let obj =
            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n";
        let asked = RefCell::new(Vec::new());
        let read = |path: &Path| {
            asked.borrow_mut().push(path.to_owned());
            Ok(if path.ends_with("a.mtl") { mtl.as_bytes().to_vec() } else { png.clone() })
        };
        let imported = parse(obj.as_bytes(), Path::new("in/a.obj"), &read).unwrap();
        assert_eq!(asked.borrow()[1], Path::new("in/my pictures/a b.png"));
        let mesh = imported.into_mesh();
        let material = mesh.material_of(0).unwrap();
        assert_eq!((material.base_color, material.emission), ([1.0; 3], [0.1, 0.2, 0.3]));
        let texture = material.base_texture.as_ref().unwrap();
        assert_eq!(texture.wrap, [Wrap::Clamp; 2]);
        // (u, v) = (0, 1), counted from below, is our (0, 0): 2·0 + 0.5 and, from above, 1 − (3·1 + 0).
        assert_eq!(mesh.corner_uv(0).unwrap()[2], DVec2::ZERO);
        assert_eq!(texture.transform.transform_point2(DVec2::ZERO), DVec2::new(0.5, -2.0));
    }
}
