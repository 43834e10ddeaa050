use super::{ImportError, Imported, ReadFile, beside};
use crate::scene::{Mesh, Paint};
use std::cell::RefCell;
use std::path::Path;

/// OBJ with MTL diffuse colours (taken as linear) or vertex colours; triangles are numbered in the file's
/// order, polygons cut into fans.
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
    let options =
        tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let load_materials = |library: &Path| {
        let library = beside(path, library);
        match read(&library) {
            Ok(bytes) => {
                let (library, _) = cleaned(&String::from_utf8_lossy(&bytes));
                tobj::load_mtl_buf(&mut without_odd_colors(&library).as_bytes())
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

    let mut mesh = Mesh::default();
    let mut colored = false;
    for model in models {
        let source = model.mesh;
        let coordinate = |i: usize| source.positions.iter().skip(i).step_by(3).copied().collect();
        let triples = |values: &[f64]| -> Vec<[f32; 3]> {
            values.chunks_exact(3).map(|v| [v[0] as f32, v[1] as f32, v[2] as f32]).collect()
        };
        let material = source.material_id.and_then(|id| materials.get(id));
        let count = source.positions.len() / 3;
        let diffuse = material.and_then(|m| m.diffuse);
        colored |= diffuse.is_some() || !source.vertex_color.is_empty();
        let paint = if source.vertex_color.is_empty() {
            diffuse.map_or_else(Paint::default, |c| Paint::Uniform(c.map(|v| v as f32)))
        } else {
            Paint::Vertices(triples(&source.vertex_color))
        };
        mesh.append(Mesh {
            x: coordinate(0),
            y: coordinate(1),
            z: coordinate(2),
            triangles: source.indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
            paint,
            // Where only some corners have them, they cannot be told apart any more.
            uv: if source.texcoords.len() / 2 == count {
                source.texcoords.chunks_exact(2).map(|v| [v[0] as f32, v[1] as f32]).collect()
            } else {
                Vec::new()
            },
            normals: if source.normals.len() / 3 == count { triples(&source.normals) } else { Vec::new() },
            one_sided: Vec::new(),
        });
    }
    let mut notes = notes.into_inner();
    if materials.iter().any(|m| m.diffuse_texture.is_some()) {
        notes.push("textures are not drawn; material colours stand for them".into());
    }
    if half_colored {
        notes.push("only some vertices have colours; they are left out".into());
    }
    if !colored {
        mesh.paint_as_clay();
        notes.push("the mesh has no colours; painted in clay by the direction its faces look".into());
    }
    Ok(Imported { mesh, notes })
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
        let is_color = words.next().is_some_and(|keyword| matches!(keyword, "Ka" | "Kd" | "Ks" | "Ke"));
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
        let mesh = import_obj(SQUARE, "newmtl red\nKd 0.7 0.1 0.2\n", "square.obj").unwrap().mesh;
        assert_eq!(mesh.triangles.len(), 3);
        let Paint::Faces(colors) = &mesh.paint else { panic!("{:?}", mesh.paint) };
        assert_eq!(colors[0], [0.7, 0.1, 0.2]);
        assert_eq!(colors[1], colors[0]);
        assert_ne!(colors[2], colors[0]);
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
        let mesh = import_obj(text, "", "a.obj").unwrap().mesh;
        assert_eq!(mesh.corners(0), [glam::DVec3::ZERO, glam::DVec3::X, glam::DVec3::Y]);
    }

    #[test]
    fn vertex_colours_are_read() {
        let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";
        let mesh = import_obj(text, "", "a.obj").unwrap().mesh;
        assert_eq!(mesh.paint.at(0, [0, 1, 2], [0.5, 0.25, 0.25]), [0.5, 0.25, 0.25]);
    }
}
