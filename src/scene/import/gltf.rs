use super::{ImportError, Imported, ReadFile, beside};
use crate::scene::{Mesh, Paint};
use glam::{DAffine3, DMat4};
use gltf::accessor::{DataType, Dimensions};
use gltf::mesh::{Mode, Semantic};
use std::path::Path;

/// glTF 2.0 and GLB: the default scene's meshes with their node transforms, base colours, vertex colours and
/// sidedness. Coordinates stay the file's own (y up).
pub(super) fn parse(bytes: &[u8], path: &Path, read: ReadFile<'_>) -> Result<Imported, ImportError> {
    let fault = |message: String| ImportError::Contents { path: path.to_owned(), line: None, message };
    if bytes.is_empty() {
        return Err(fault("the file is empty".into()));
    }
    if bytes.starts_with(b"glTF") {
        check_glb(bytes).map_err(fault)?;
    }
    let file = open(bytes).map_err(fault)?;
    let required: Vec<&str> = file.extensions_required().filter(|e| !KNOWN_EXTENSIONS.contains(e)).collect();
    if !required.is_empty() {
        return Err(fault(format!(
            "it requires the extension {}, which is not supported",
            required.join(", ")
        )));
    }
    let buffers = file
        .buffers()
        .map(|buffer| {
            let contents = match buffer.source() {
                gltf::buffer::Source::Bin => {
                    file.blob.clone().ok_or_else(|| fault("its binary chunk is missing".into()))?
                }
                gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
                    Some(data) => {
                        base64(data).ok_or_else(|| fault("a data URI in it is not base64".into()))?
                    }
                    None => read(&beside(path, Path::new(&decoded(uri))))?,
                },
            };
            if contents.len() < buffer.length() {
                let (found, needed) = (contents.len(), buffer.length());
                return Err(fault(format!(
                    "buffer {} has {found} of {needed} bytes; is the file whole?",
                    buffer.index()
                )));
            }
            Ok(contents)
        })
        .collect::<Result<Vec<_>, _>>()?;

    let mut reader = Reader {
        buffers,
        mesh: Mesh::default(),
        notes: Vec::new(),
        colored: false,
        visited: vec![false; file.nodes().len()],
    };
    let scene = file.default_scene().or_else(|| file.scenes().next());
    match scene {
        Some(scene) => {
            for node in scene.nodes() {
                reader.tree(node).map_err(fault)?;
            }
        }
        None => {
            for mesh in file.meshes() {
                reader.mesh(&mesh, DMat4::IDENTITY).map_err(fault)?;
            }
        }
    }
    let Reader { mut mesh, mut notes, colored, .. } = reader;
    if !colored {
        mesh.paint_as_clay();
        notes.push("the mesh has no colours; painted in clay by the direction its faces look".into());
    }
    Ok(Imported { mesh, notes })
}

/// A relative URI as a path: %20 is a space.
fn decoded(uri: &str) -> String {
    let mut out = Vec::new();
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = tail.get(..2).and_then(|hex| u8::from_str_radix(std::str::from_utf8(hex).ok()?, 16).ok());
        match code {
            Some(byte) if *first == b'%' => {
                out.push(byte);
                rest = &tail[2..];
            }
            _ => {
                out.push(*first);
                rest = tail;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

/// Extensions a file may require that change nothing we read, or that the reader knows.
const KNOWN_EXTENSIONS: [&str; 4] = [
    "KHR_materials_unlit",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_texture_transform",
];

/// Parses and validates; the validator underneath trusts one index, so that is looked at first.
fn open(bytes: &[u8]) -> Result<gltf::Gltf, String> {
    let unchecked = gltf::Gltf::from_slice_without_validation(bytes).map_err(|e| e.to_string())?;
    let json = unchecked.document.into_json();
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    for accessor in primitives.flat_map(|primitive| primitive.attributes.values()) {
        if accessor.value() >= json.accessors.len() {
            return Err(format!("there is no accessor {}", accessor.value()));
        }
    }
    let document = gltf::Document::from_json(json).map_err(|e| e.to_string())?;
    Ok(gltf::Gltf { document, blob: unchecked.blob })
}

/// The lengths in a GLB's header against the bytes there are.
fn check_glb(bytes: &[u8]) -> Result<(), String> {
    let word =
        |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as usize);
    let (Some(version), Some(length), Some(json)) = (word(4), word(8), word(12)) else {
        return Err(format!("the file ends after {} bytes, within its header", bytes.len()));
    };
    if version != 2 {
        return Err(format!("GLB version {version} is not supported, only 2"));
    }
    if length > bytes.len() || length < 20 || json > length - 20 {
        return Err(format!(
            "its header claims {length} bytes with {json} of JSON, but the file has {}; is it whole?",
            bytes.len()
        ));
    }
    Ok(())
}

fn base64(data: &str) -> Option<Vec<u8>> {
    let (_, text) = data.split_once(";base64,")?;
    let mut out = Vec::with_capacity(text.len() / 4 * 3);
    let (mut bits, mut count) = (0u32, 0);
    for byte in text.bytes().filter(|&b| b != b'=') {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            out.push((bits >> count) as u8);
        }
    }
    Some(out)
}

struct Reader {
    buffers: Vec<Vec<u8>>,
    mesh: Mesh,
    notes: Vec<String>,
    /// Whether any primitive has a material or vertex colours.
    colored: bool,
    visited: Vec<bool>,
}

impl Reader {
    /// A tree of nodes, as deep as it may be.
    fn tree(&mut self, root: gltf::Node<'_>) -> Result<(), String> {
        let mut waiting = vec![(root, DMat4::IDENTITY)];
        while let Some((node, parent)) = waiting.pop() {
            // The format allows only trees; anything else could go round in circles.
            if std::mem::replace(&mut self.visited[node.index()], true) {
                return Err(format!("node {} has two parents", node.index()));
            }
            let own = node.transform().matrix().map(|column| column.map(f64::from));
            let world = parent * DMat4::from_cols_array_2d(&own);
            if let Some(mesh) = node.mesh() {
                self.mesh(&mesh, world)?;
            }
            // The last one waiting is next: children in order, before siblings.
            let first = waiting.len();
            waiting.extend(node.children().map(|child| (child, world)));
            waiting[first..].reverse();
        }
        Ok(())
    }

    fn mesh(&mut self, mesh: &gltf::Mesh<'_>, world: DMat4) -> Result<(), String> {
        for primitive in mesh.primitives() {
            let place = DAffine3::from_mat4(world);
            if let Some(part) = self.primitive(mesh, &primitive)? {
                if self.mesh.vertex_count() + part.vertex_count() > u32::MAX as usize {
                    return Err("it has more than 4 294 967 295 vertices".into());
                }
                self.mesh.append(part.placed(&place));
            }
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        mesh: &gltf::Mesh<'_>,
        primitive: &gltf::Primitive<'_>,
    ) -> Result<Option<Mesh>, String> {
        if matches!(primitive.mode(), Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.note("points and lines are not drawn");
            return Ok(None);
        }
        for (semantic, accessor) in primitive.attributes() {
            self.check(&accessor, &semantic.to_string(), allowed_types(&semantic))?;
        }
        if let Some(accessor) = primitive.indices() {
            self.check(&accessor, "indices", &INDEX_TYPES)?;
        }
        let material = primitive.material();
        if material.pbr_metallic_roughness().base_color_texture().is_some() {
            self.note("textures are not drawn; base colours stand for them");
        }
        let buffers = &self.buffers;
        let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
        let Some(positions) = reader.read_positions() else {
            return Err(format!("a primitive of mesh {} has no positions", mesh.index()));
        };
        let vertices: Vec<_> = positions.map(|p| glam::Vec3::from_array(p).as_dvec3()).collect();
        let indices: Vec<u32> = match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..vertices.len() as u32).collect(),
        };
        let triangles: Vec<[u32; 3]> = match primitive.mode() {
            Mode::TriangleStrip => {
                let turned = |(i, t): (usize, &[u32])| {
                    if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }
                };
                indices.windows(3).enumerate().map(turned).collect()
            }
            Mode::TriangleFan => {
                indices.get(1..).unwrap_or_default().windows(2).map(|t| [indices[0], t[0], t[1]]).collect()
            }
            _ => indices.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        };
        let [r, g, b, _] = material.pbr_metallic_roughness().base_color_factor();
        let paint = match reader.read_colors(0) {
            Some(colors) => {
                Paint::Vertices(colors.into_rgb_f32().map(|c| [c[0] * r, c[1] * g, c[2] * b]).collect())
            }
            None => Paint::Uniform([r, g, b]),
        };
        self.colored |= material.index().is_some() || matches!(paint, Paint::Vertices(_));
        let out = Mesh {
            paint,
            uv: reader.read_tex_coords(0).map(|uv| uv.into_f32().collect()).unwrap_or_default(),
            normals: reader.read_normals().map(Iterator::collect).unwrap_or_default(),
            one_sided: if material.double_sided() { Vec::new() } else { vec![true; triangles.len()] },
            ..Mesh::new(&vertices, triangles)
        };
        if out.triangles.is_empty() {
            return Ok(None);
        }
        out.check().map_err(|e| format!("mesh {}: {e}", mesh.index()))?;
        Ok(Some(out))
    }

    /// Once is enough.
    fn note(&mut self, note: &str) {
        if !self.notes.iter().any(|n| n == note) {
            self.notes.push(note.to_owned());
        }
    }

    /// The reader underneath trusts types and lengths; this does not.
    fn check(
        &self,
        accessor: &gltf::Accessor<'_>,
        what: &str,
        types: &[(Dimensions, DataType)],
    ) -> Result<(), String> {
        let found = (accessor.dimensions(), accessor.data_type());
        if !types.is_empty() && !types.contains(&found) {
            let index = accessor.index();
            return Err(format!(
                "accessor {index} ({what}) holds {found:?}, which the format does not allow there"
            ));
        }
        let fits = |view: &gltf::buffer::View<'_>, offset: usize, count: usize, size: usize| {
            let stride = view.stride().unwrap_or(size);
            let needed = count.checked_sub(1).and_then(|n| n.checked_mul(stride)?.checked_add(size));
            let end = needed.and_then(|n| n.checked_add(offset));
            let in_view = end.is_some_and(|end| end <= view.length());
            let there = self.buffers.get(view.buffer().index()).map_or(0, Vec::len);
            stride >= size
                && in_view
                && view.offset().checked_add(view.length()).is_some_and(|end| end <= there)
        };
        let mut good = match accessor.view() {
            Some(view) => fits(&view, accessor.offset(), accessor.count(), accessor.size()),
            // Zeros, as many as the file says: only as a ground for sparse values.
            None => accessor.sparse().is_some() && accessor.count() <= MOST_ZEROS,
        };
        if let Some(sparse) = accessor.sparse() {
            let indices = sparse.indices();
            good &= fits(&indices.view(), indices.offset(), sparse.count(), indices.index_type().size());
            good &= fits(&sparse.values().view(), sparse.values().offset(), sparse.count(), accessor.size());
        }
        if good {
            Ok(())
        } else {
            Err(format!("accessor {} reaches beyond its buffer; is the file whole?", accessor.index()))
        }
    }
}

const INDEX_TYPES: [(Dimensions, DataType); 3] = [
    (Dimensions::Scalar, DataType::U8),
    (Dimensions::Scalar, DataType::U16),
    (Dimensions::Scalar, DataType::U32),
];

/// What glTF allows for the attributes that are read; empty for the others.
fn allowed_types(semantic: &Semantic) -> &'static [(Dimensions, DataType)] {
    use DataType::{F32, U8, U16};
    use Dimensions::{Vec2, Vec3, Vec4};
    match semantic {
        Semantic::Positions | Semantic::Normals => &[(Vec3, F32)],
        Semantic::TexCoords(_) => &[(Vec2, F32), (Vec2, U8), (Vec2, U16)],
        Semantic::Colors(_) => &[(Vec3, F32), (Vec3, U8), (Vec3, U16), (Vec4, F32), (Vec4, U8), (Vec4, U16)],
        _ => &[],
    }
}

/// Vertices an accessor without a buffer may stand for.
const MOST_ZEROS: usize = 1 << 24;

#[cfg(test)]
mod tests {
    use super::*;

    fn load(json: &str) -> Result<Imported, ImportError> {
        parse(json.as_bytes(), Path::new("test.gltf"), &|path| {
            Err(ImportError::UnknownFormat(path.to_owned()))
        })
    }

    /// One triangle (0,0,0) (1,0,0) (0,1,0) in a data URI, moved and scaled by two nodes.
    fn triangle(count: usize, extra: &str) -> String {
        let floats: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let bytes: Vec<u8> = floats.iter().flat_map(|f| f.to_le_bytes()).collect();
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let text: String = bytes
            .chunks(3)
            .flat_map(|c| {
                let n = u32::from(c[0]) << 16 | u32::from(c[1]) << 8 | u32::from(c[2]);
                [18, 12, 6, 0].map(|s| char::from(DIGITS[(n >> s & 63) as usize]))
            })
            .collect();
        format!(
            r#"{{"asset": {{"version": "2.0"}}, {extra} "scene": 0, "scenes": [{{"nodes": [0]}}],
            "nodes": [{{"translation": [1, 2, 3], "children": [1]}}, {{"scale": [2, 2, 2], "mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "material": 0}}]}}],
            "materials": [{{"pbrMetallicRoughness": {{"baseColorFactor": [0.1, 0.2, 0.3, 1]}}, "doubleSided": true}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": {count}, "type": "VEC3",
              "min": [0, 0, 0], "max": [1, 1, 0]}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
            "buffers": [{{"byteLength": 36, "uri": "data:application/octet-stream;base64,{text}"}}]}}"#
        )
    }

    #[test]
    fn nodes_place_their_meshes_and_materials_colour_them() {
        let mesh = load(&triangle(3, "")).unwrap().mesh;
        assert_eq!(mesh.corners(0)[1], glam::DVec3::new(3.0, 2.0, 3.0));
        assert_eq!(mesh.corners(0)[2], glam::DVec3::new(1.0, 4.0, 3.0));
        assert_eq!(mesh.paint, Paint::Uniform([0.1, 0.2, 0.3]));
        assert!(!mesh.is_one_sided(0));
    }

    #[test]
    fn an_accessor_beyond_its_buffer_is_an_error() {
        let message = load(&triangle(300, "")).unwrap_err().to_string();
        assert!(message.contains("accessor 0"), "{message}");
    }

    #[test]
    fn a_required_extension_we_do_not_know_is_named() {
        let message = load(&triangle(3, r#""extensionsRequired": ["KHR_draco_mesh_compression"], "extensionsUsed": ["KHR_draco_mesh_compression"],"#))
            .unwrap_err()
            .to_string();
        assert!(message.contains("KHR_draco_mesh_compression"), "{message}");
    }

    #[test]
    fn glb_headers_that_lie_are_errors() {
        let glb = |version: u32, length: u32, json: u32| {
            let mut bytes = b"glTF".to_vec();
            for word in [version, length, json, 0x4e4f_534a] {
                bytes.extend(word.to_le_bytes());
            }
            bytes
        };
        for bytes in [
            b"glTF".to_vec(),
            glb(2, 4_000_000_000, 10),
            glb(2, 20, 4_000_000_000),
            glb(2, 3, 0),
            glb(1, 20, 0),
            glb(2, 20, 0),
        ] {
            assert!(parse(&bytes, Path::new("a.glb"), &|_| Ok(vec![])).is_err());
        }
    }
}
