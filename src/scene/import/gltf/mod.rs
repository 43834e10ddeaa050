//! glTF 2.0 and GLB: a scene's meshes with their node transforms, materials and textures, what moves by
//! `extras` and by animations, and the camera. Coordinates stay the file's own (y up).

mod buffers;
mod choice;
mod extras;
mod motion;
mod reader;
mod surface;

use super::{Choice, ImportError, Imported, ReadFile};
use crate::scene::room::Room;
use buffers::Buffers;
use reader::Reader;
use std::path::Path;

/// Reads a file's contents.
pub(super) fn parse(
    bytes: &[u8],
    path: &Path,
    choice: &Choice,
    read: ReadFile<'_>,
) -> Result<Imported, ImportError> {
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
    let not_there = |message: String| ImportError::Choice { path: path.to_owned(), message };
    let scene = choice::scene(&file, choice.scene.as_deref()).map_err(not_there)?;
    let buffers = Buffers::read(&file, path, read)?;
    let room = Room::new(bytes.len() + buffers.bytes_beside(&file), REMEDY);
    let mut reader = Reader::new(&file, buffers, room, path, read)?;
    if let Some(scene) = scene.as_ref().filter(|_| choice.scene.is_none()) {
        reader.note_scene(scene, file.scenes().len());
    }
    reader.scene(&file, scene).map_err(fault)?;
    reader.choose_camera(choice.camera.as_deref()).map_err(not_there)?;
    Ok(reader.finish())
}

/// What to do with files that use their meshes too often.
const REMEDY: &str = "use its meshes less often, or in files of their own";

/// Extensions a file may require that change nothing we read, or that the reader knows.
const KNOWN_EXTENSIONS: [&str; 4] = [
    "KHR_materials_unlit",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_texture_transform",
];

/// Parses and validates; what the validator underneath trusts is looked at first.
fn open(bytes: &[u8]) -> Result<gltf::Gltf, String> {
    let unchecked =
        gltf::Gltf::from_slice_without_validation(bytes).map_err(|e| format!("it is no glTF file: {e}"))?;
    let json = unchecked.document.into_json();
    let primitives = json.meshes.iter().flat_map(|mesh| &mesh.primitives);
    for accessor in primitives.flat_map(|primitive| primitive.attributes.values()) {
        if accessor.value() >= json.accessors.len() {
            return Err(format!("there is no accessor {}", accessor.value()));
        }
    }
    for (index, image) in json.images.iter().enumerate() {
        let whole = if image.buffer_view.is_some() { image.mime_type.is_some() } else { image.uri.is_some() };
        if !whole {
            return Err(format!("image {index} needs a URI, or a view and a type"));
        }
    }
    for (index, animation) in json.animations.iter().enumerate() {
        for target in animation.channels.iter().map(|channel| &channel.target) {
            if target.node.value() >= json.nodes.len()
                || target.path == gltf::json::validation::Checked::Invalid
            {
                return Err(format!("animation {index} moves a node or a property of it that there is not"));
            }
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
        load_choosing(json, &Choice::default())
    }

    fn load_choosing(json: &str, choice: &Choice) -> Result<Imported, ImportError> {
        parse(json.as_bytes(), Path::new("test.gltf"), choice, &|path| {
            Err(ImportError::UnknownFormat(path.to_owned()))
        })
    }

    /// One triangle (0,0,0) (1,0,0) (0,1,0) in a data URI, moved and scaled by two nodes.
    fn triangle(count: usize, extra: &str) -> String {
        let floats: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let bytes: Vec<u8> = floats.iter().flat_map(|f| f.to_le_bytes()).collect();
        let text = base64(&bytes);
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
            assert!(parse(&bytes, Path::new("a.glb"), &Choice::default(), &|_| Ok(vec![])).is_err());
        }
    }

    fn base64(bytes: &[u8]) -> String {
        const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        let digits = |c: &[u8]| {
            let byte = |i: usize| u32::from(c.get(i).copied().unwrap_or(0));
            let n = byte(0) << 16 | byte(1) << 8 | byte(2);
            let text: String =
                [18, 12, 6, 0].iter().map(|s| char::from(DIGITS[(n >> s & 63) as usize])).collect();
            text[..=c.len()].to_owned() + &"==="[c.len()..]
        };
        bytes.chunks(3).map(digits).collect()
    }

    /// A file of the triangle above with texture coordinates, whose buffer also holds a ramp of times (0, 1, 2) and
    /// three quarter turns about z.
    fn file(json: &str) -> Result<Imported, ImportError> {
        file_choosing(json, None, None)
    }

    fn file_choosing(json: &str, scene: Option<&str>, camera: Option<&str>) -> Result<Imported, ImportError> {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let corners = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let uv = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        let times = [0.0, 1.0, 2.0];
        let turns = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, half, half, 0.0, 0.0, 1.0, 0.0];
        let floats = [&corners[..], &uv, &times, &turns].concat();
        let bytes: Vec<u8> = floats.iter().flat_map(|f: &f32| f.to_le_bytes()).collect();
        let mut png = Vec::new();
        use image::ImageEncoder;
        image::codecs::png::PngEncoder::new(&mut png)
            .write_image(&[255, 0, 0, 0, 255, 0], 2, 1, image::ExtendedColorType::Rgb8)
            .unwrap();
        let choice = Choice { scene: scene.map(str::to_owned), camera: camera.map(str::to_owned) };
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}},
            "accessors": [
              {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
              {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}},
              {{"bufferView": 2, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [2]}},
              {{"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC4"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 24}},
              {{"buffer": 0, "byteOffset": 60, "byteLength": 12}}, {{"buffer": 0, "byteOffset": 72, "byteLength": 48}}],
            "buffers": [{{"byteLength": 120, "uri": "data:application/octet-stream;base64,{}"}}],
            "images": [{{"uri": "data:image/png;base64,{}", "name": "two"}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "material": 0}}]}}],
            {json} }}"#,
            base64(&bytes),
            base64(&png)
        );
        load_choosing(&text, &choice)
    }

    const PLAIN: &str = r#""materials": [{"doubleSided": true}]"#;

    #[test]
    fn materials_bring_textures_emission_and_transforms() {
        let mesh = file(
            r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}],
            "extensionsUsed": ["KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_unlit"],
            "extensionsRequired": ["KHR_texture_transform"],
            "materials": [{"name": "m", "emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 0},
              "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0,
                "extensions": {"KHR_texture_transform": {"offset": [0.25, 0], "rotation": 1.5707964, "scale": [2, 1]}}}},
              "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3}, "KHR_materials_unlit": {}}}]"#,
        )
        .unwrap()
        .into_mesh();
        let material = mesh.material_of(0).unwrap();
        assert_eq!((material.name.as_str(), material.base_color), ("m", [0.5; 3]));
        assert_eq!(material.emission, [3.0, 1.5, 0.0]);
        assert_eq!(material.surface, crate::scene::Surface::Luminous);
        assert!(material.one_sided && material.emission_texture.is_some());
        let texture = material.base_texture.as_ref().unwrap();
        use crate::scene::Wrap;
        assert_eq!((texture.wrap, texture.blocky), ([Wrap::Clamp, Wrap::Mirror], true));
        assert_eq!(texture.picture.size(), [2, 1]);
        // The extension's own matrix: translation · rotation · scale, the rotation (cos sin; −sin cos).
        let at = texture.transform.transform_point2(glam::DVec2::new(0.1, 0.2));
        assert!((at - glam::DVec2::new(0.25 + 0.2, -0.2)).length() < 1e-6, "{at}");
        // There the base is green, times a half; the emission, untransformed, red, times three.
        let color =
            mesh.color(0, [1.0, 0.0, 0.0], |t| t.at(glam::DVec2::new(0.1, 0.5), [glam::DVec2::ZERO; 2]));
        assert_eq!(color, [3.0, 0.5, 0.0]);
        assert_eq!(mesh.corner_uv(0).unwrap()[1], glam::DVec2::X);
    }

    #[test]
    fn velocities_in_extras_make_bodies_and_move_cameras() {
        let imported = file(&format!(
            r#""scenes": [{{"nodes": [0, 1, 3]}}], {PLAIN},
            "cameras": [{{"type": "perspective", "perspective": {{"yfov": 0.5, "znear": 0.1}}}}],
            "nodes": [{{"mesh": 0, "name": "ground"}},
              {{"name": "tram", "translation": [5, 0, 1], "rotation": [0, 0, 0.70710678, 0.70710678],
                "children": [2], "extras": {{"velocity": [0.6, 0, 0], "time": 2}}}},
              {{"mesh": 0, "translation": [1, 0, 0]}},
              {{"camera": 0, "translation": [0, 1, 9], "extras": {{"gamma": 2, "direction": [0, 1, 0]}}}}]"#
        ))
        .unwrap();
        assert!(imported.moves());
        let names: Vec<_> = imported.parts.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["test", "tram"]);
        let tram = &imported.parts[1];
        use glam::DVec3;
        assert!((tram.motion.celerity.vector() - DVec3::X * 0.75).length() < 1e-12);
        assert_eq!(tram.motion.origin, terrell_geodesic::Event::new(2.0, 5.0, 0.0, 1.0));
        // Turned by a quarter about z: what was along x is along y.
        assert!((tram.mesh.corners(0)[0] - DVec3::Y).length() < 1e-6, "{}", tram.mesh.corners(0)[0]);
        assert!((tram.mesh.corners(0)[1] - DVec3::Y * 2.0).length() < 1e-6);
        let view = imported.view.as_ref().unwrap();
        assert_eq!(view.event, terrell_geodesic::Event::new(0.0, 0.0, 1.0, 9.0));
        assert!((view.celerity.vector() - DVec3::Y * 3f64.sqrt()).length() < 1e-12);
        assert_eq!(view.aim, crate::scene::Aim::Forward(-DVec3::Z));
        assert!((view.fov_deg.unwrap() - 0.5f64.to_degrees()).abs() < 1e-6);
        // As one mesh, all of it is where the file puts it.
        let settled = imported.into_mesh();
        assert!((settled.corners(1)[0] - DVec3::new(5.0, 1.0, 1.0)).length() < 1e-6);
    }

    #[test]
    fn animated_nodes_become_clips() {
        let imported = file(&format!(
            r#""scenes": [{{"nodes": [0]}}], {PLAIN},
            "nodes": [{{"children": [1, 2], "translation": [0, 0, 7]}},
              {{"mesh": 0, "name": "wheel", "translation": [1, 0, 0]}}, {{"mesh": 0}}],
            "animations": [{{"channels": [{{"sampler": 0, "target": {{"node": 1, "path": "rotation"}}}}],
              "samplers": [{{"input": 2, "output": 3}}]}}]"#
        ))
        .unwrap();
        let names: Vec<_> = imported.parts.iter().map(|p| (p.name.as_str(), p.clip.is_some())).collect();
        assert_eq!(names, [("wheel", true), ("test", false)]);
        let wheel = &imported.parts[0];
        let clip = wheel.clip.as_ref().unwrap();
        use glam::DVec3;
        let tip = clip.pose(1.0).transform_point3(wheel.mesh.corners(0)[1]);
        assert!((tip - DVec3::new(1.0, 1.0, 7.0)).length() < 1e-6, "{tip}");
        assert_eq!(clip.period, 2.0);
        let scene = crate::scene::authored("a", imported, None, crate::scene::View::default());
        assert!(scene.check_animations().unwrap_err().to_string().contains("'wheel'"));
        let mut scene = scene;
        scene.set_animation_rate(0.01);
        assert!(scene.check_animations().is_ok());
    }

    /// Two scenes, the second with three cameras; nodes 1 and 3 hold the same one.
    const TWO_SCENES: &str = r#""scenes": [{"nodes": [0], "name": "day"}, {"nodes": [1, 4], "name": "night"}],
        "scene": 0, "materials": [{}],
        "cameras": [{"type": "perspective", "name": "lens", "perspective": {"yfov": 0.5, "znear": 0.1}},
          {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 0.1}}],
        "nodes": [{"mesh": 0}, {"camera": 1, "name": "plan", "children": [2]},
          {"camera": 0, "translation": [2, 0, 0]}, {"camera": 0, "name": "2", "translation": [3, 0, 0]},
          {"mesh": 0, "children": [3]}]"#;

    #[test]
    fn scenes_and_cameras_are_chosen_by_name_or_number() {
        let x = |scene, camera| {
            let imported = file_choosing(TWO_SCENES, scene, camera).unwrap();
            imported.view.map(|view| view.event.position().x)
        };
        assert_eq!(x(None, None), None);
        assert_eq!(x(Some("day"), None), None);
        // In the order in which they are met; the first with perspective.
        assert_eq!(x(Some("night"), None), Some(2.0));
        assert_eq!(x(Some("2"), Some("3")), Some(3.0));
        assert_eq!(x(Some("2"), Some("lens")), Some(2.0));
        // A name goes before a number.
        assert_eq!(x(Some("2"), Some("2")), Some(3.0));
        let notes = file(TWO_SCENES).unwrap().notes;
        assert!(notes[0].contains("of 2 scenes number 1 ('day') is shown; --file-scene"), "{notes:?}");
        let night = file_choosing(TWO_SCENES, Some("night"), None).unwrap();
        assert_eq!(night.cameras, 3);
        assert!(!night.notes.iter().any(|n| n.contains("scenes")), "{:?}", night.notes);
        for (scene, camera, parts) in [
            (Some("nigt"), None, ["no scene 'nigt'", "'night'"]),
            (Some("dusk and dawn"), None, ["dusk", "known: day, night"]),
            (Some("0"), None, ["no scene '0'", "from 1 to 2: day, night"]),
            (Some("3"), None, ["no scene '3'", "from 1 to 2: day, night"]),
            (None, Some("1"), ["no camera '1'", "there is none"]),
            (Some("night"), Some("plna"), ["no camera 'plna'", "'plan'"]),
            (Some("night"), Some("4"), ["no camera '4'", "from 1 to 3: plan, lens, 2"]),
            (Some("night"), Some("plan"), ["camera 'plan'", "perspective"]),
        ] {
            let error = file_choosing(TWO_SCENES, scene, camera).unwrap_err();
            assert!(matches!(error, ImportError::Choice { .. }), "{error}");
            parts.iter().for_each(|part| assert!(error.to_string().contains(part), "{error}"));
        }
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        for (json, part) in [
            (
                r#""extensionsUsed": ["KHR_lights_punctual"],
                "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb", "intensity": -2}]}},
                "scenes": [{"nodes": [0]}], "materials": [{}],
                "nodes": [{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}]"#,
                "light 'bulb': its intensity, -2,",
            ),
            (
                r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "n", "extras": {"velocity": [2, 0, 0]}}],
                "materials": [{}]"#,
                "node n: extras: velocity",
            ),
            (
                r#""scenes": [{"nodes": [0]}], "nodes": [{"children": [1]}, {"mesh": 0, "extras": {"gamma": 2}}],
                "materials": [{}],
                "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}],
                  "samplers": [{"input": 2, "output": 3}]}]"#,
                "animated",
            ),
            (
                r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "materials": [{}],
                "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                  "samplers": [{"input": 2, "output": 3}]}]"#,
                "accessor 3",
            ),
        ] {
            let message = file(json).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        // A picture that cannot be read is said, and done without.
        let imported = file(
            r#""scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "textures": [{"source": 0}, {}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 1}}}]"#,
        )
        .unwrap();
        assert!(imported.notes[0].contains("without a texture"), "{:?}", imported.notes);
    }
}
