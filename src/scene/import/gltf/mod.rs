//! glTF 2.0 and GLB: the default scene's meshes with their node transforms, materials and textures, what moves by
//! `extras` and by animations, and the camera. Coordinates stay the file's own (y up).

mod buffers;
mod extras;
mod motion;
mod reader;
mod surface;

use super::{ImportError, Imported, ReadFile};
use buffers::Buffers;
use reader::Reader;
use std::path::Path;

/// Reads a file's contents.
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
    let buffers = Buffers::read(&file, path, read)?;
    Reader::new(&file, buffers, path, read)?.scene(&file).map_err(fault)
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
        let mesh = load(&triangle(3, "")).unwrap().into_mesh();
        assert_eq!(mesh.corners(0)[1], glam::DVec3::new(3.0, 2.0, 3.0));
        assert_eq!(mesh.corners(0)[2], glam::DVec3::new(1.0, 4.0, 3.0));
        assert_eq!(mesh.material_of(0).unwrap().base_color, [0.1, 0.2, 0.3]);
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
