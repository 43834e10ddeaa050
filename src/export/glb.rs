//! Binary glTF 2.0: one file, frames of an animation as morph targets.

use super::files::{Pictures, file_of, is_png};
use super::{ExportError, Eye, Frame, Model};
use crate::scene::{Material, Surface, Texture, Wrap};
use glam::{DMat3, DQuat, DVec3};
use serde_json::{Map, Value, json};
use std::path::Path;

const ARRAY: u32 = 34962;
const INDICES: u32 = 34963;
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;

/// The bytes of a file.
pub(super) fn encode(model: &Model, path: &Path) -> Result<Vec<u8>, ExportError> {
    let (low, high) = model.bounds();
    let size = low.abs().max(high.abs()).max_element();
    if size > f64::from(f32::MAX) / 4.0 {
        return Err(ExportError::TooLarge { path: path.to_owned(), size });
    }
    // Far from the origin 32-bit numbers would lose the shape.
    let centre = 0.5 * (low + high);
    let far = centre.length() > 16.0 * (high - low).length();
    let origin = if far { centre.as_vec3().as_dvec3() } else { DVec3::ZERO };
    let mut glb = Glb { origin, ..Glb::default() };
    let (mut nodes, mut meshes, mut channels, mut samplers) = (vec![], vec![], vec![], vec![]);
    let targets = model.times.len().saturating_sub(1);
    let moving = targets > 0;
    let times = moving.then(|| {
        let seconds: Vec<[f32; 1]> = model.times.iter().map(|t| [*t as f32]).collect();
        glb.floats(&seconds, None, true)
    });
    let mut turn_on = |node: usize, path: &str, output: usize, samplers: &mut Vec<Value>| {
        channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
        samplers.push(json!({ "input": times, "output": output, "interpolation": "LINEAR" }));
    };
    for object in &model.objects {
        let primitives: Vec<Value> = object.surfaces.iter().map(|s| glb.primitive(s)).collect();
        let node = nodes.len();
        nodes.push(json!({ "name": object.name, "mesh": meshes.len() }));
        let mut mesh = json!({ "name": object.name, "primitives": primitives });
        if moving {
            mesh["weights"] = json!(vec![0; targets]);
            // One target at a time, the first frame being the mesh itself.
            let weights: Vec<[f32; 1]> = (0..=targets)
                .flat_map(|frame| (1..=targets).map(move |target| [f32::from(u8::from(frame == target))]))
                .collect();
            let output = glb.floats(&weights, None, false);
            turn_on(node, "weights", output, &mut samplers);
        }
        meshes.push(mesh);
    }
    let mut document = Map::new();
    if let Some(eye) = &model.eye {
        let node = nodes.len();
        nodes.push(camera_node(eye, origin));
        document.insert("cameras".into(), json!([camera(eye, high - low, model)]));
        if moving && eye.positions.iter().any(|p| *p != eye.positions[0]) {
            let places: Vec<[f32; 3]> =
                eye.positions.iter().map(|p| (*p - origin).as_vec3().to_array()).collect();
            let output = glb.floats(&places, None, false);
            turn_on(node, "translation", output, &mut samplers);
        }
    }
    let mut roots: Vec<usize> = (0..nodes.len()).collect();
    if far {
        nodes.push(json!({ "name": "origin", "translation": origin.to_array(), "children": roots }));
        roots = vec![nodes.len() - 1];
    }
    let mut asset = json!({
        "version": "2.0",
        "generator": concat!("terrell ", env!("CARGO_PKG_VERSION")),
    });
    if !model.extras.is_empty() {
        asset["extras"] = Value::Object(model.extras.clone());
    }
    document.insert("asset".into(), asset);
    document.insert("scene".into(), json!(0));
    document.insert("scenes".into(), json!([{ "name": model.name, "nodes": roots }]));
    glb.pictures();
    let lists = [
        ("nodes", nodes),
        ("meshes", meshes),
        ("materials", std::mem::take(&mut glb.materials)),
        ("textures", std::mem::take(&mut glb.textures)),
        ("samplers", std::mem::take(&mut glb.samplers)),
        ("images", std::mem::take(&mut glb.images)),
        ("accessors", std::mem::take(&mut glb.accessors)),
        ("bufferViews", std::mem::take(&mut glb.views)),
        ("extensionsUsed", glb.extensions.iter().map(|e| json!(e)).collect()),
    ];
    for (key, list) in lists {
        if !list.is_empty() {
            document.insert(key.into(), Value::Array(list));
        }
    }
    document.insert("buffers".into(), json!([{ "byteLength": glb.bytes.len() }]));
    if !channels.is_empty() {
        let animation = json!({ "name": "seen", "channels": channels, "samplers": samplers });
        document.insert("animations".into(), json!([animation]));
    }
    packed(&Value::Object(document), glb.bytes).ok_or_else(|| ExportError::TooLong(path.to_owned()))
}

/// Header, JSON, binary chunk; none if lengths do not fit 32 bits.
fn packed(document: &Value, mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let length = u32::try_from(12 + 8 + text.len() + 8 + bytes.len()).ok()?;
    let mut out = Vec::with_capacity(length as usize);
    out.extend(b"glTF");
    out.extend([2, length].into_iter().flat_map(u32::to_le_bytes));
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", bytes)] {
        out.extend((chunk.len() as u32).to_le_bytes());
        out.extend(kind);
        out.extend(chunk);
    }
    Some(out)
}

fn camera(eye: &Eye, size: DVec3, model: &Model) -> Value {
    // Planes that hold everything, for those who need planes.
    let (low, high) = model.bounds();
    let corner = eye.positions.iter().map(|p| (*p - low).abs().max((*p - high).abs()).length());
    let reach = corner.fold(size.length(), f64::max).max(1e-30);
    json!({
        "type": "perspective",
        "perspective": {
            "yfov": eye.field as f32,
            "aspectRatio": f64::from(eye.size[0]) / f64::from(eye.size[1]),
            "znear": (1e-4 * reach) as f32,
            "zfar": (2.0 * reach) as f32,
        },
    })
}

fn camera_node(eye: &Eye, origin: DVec3) -> Value {
    let [right, up, forward] = eye.axes;
    let turn = DQuat::from_mat3(&DMat3::from_cols(right, up, -forward)).normalize().as_quat();
    let place = (eye.positions[0] - origin).as_vec3();
    json!({ "name": "camera", "camera": 0, "translation": place.to_array(), "rotation": turn.to_array() })
}

/// A file on its way.
#[derive(Default)]
struct Glb {
    origin: DVec3,
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    used: Pictures,
    /// The first of every list of materials that are equal.
    known: Vec<Material>,
    extensions: Vec<&'static str>,
}

impl Glb {
    fn view(&mut self, bytes: impl IntoIterator<Item = u8>, target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let mut view = json!({ "buffer": 0, "byteOffset": start, "byteLength": self.bytes.len() - start });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.views.push(view);
        self.views.len() - 1
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]], target: Option<u32>, range: bool) -> usize {
        let view = self.view(values.iter().flatten().flat_map(|v| v.to_le_bytes()), target);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor =
            json!({ "bufferView": view, "componentType": FLOAT, "count": values.len(), "type": kind });
        if range && let Some(first) = values.first() {
            let of = |pick: fn(f32, f32) -> f32| {
                let both = |a: [f32; N], b: &[f32; N]| std::array::from_fn(|i| pick(a[i], b[i]));
                values.iter().fold(*first, both).to_vec()
            };
            accessor["min"] = json!(of(f32::min));
            accessor["max"] = json!(of(f32::max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn positions(&self, frame: &Frame) -> Vec<[f32; 3]> {
        frame.positions.iter().map(|p| (*p - self.origin).as_vec3().to_array()).collect()
    }

    fn primitive(&mut self, surface: &super::Surface) -> Value {
        let first = surface.first();
        let positions = self.positions(first);
        let mut attributes = json!({ "POSITION": self.floats(&positions, Some(ARRAY), true) });
        let normals: Vec<_> = first.normals.iter().map(|n| n.to_array()).collect();
        attributes["NORMAL"] = json!(self.floats(&normals, Some(ARRAY), false));
        if !surface.uv.is_empty() {
            attributes["TEXCOORD_0"] = json!(self.floats(&surface.uv, Some(ARRAY), false));
        }
        if !first.colors.is_empty() {
            let colors = clipped(&first.colors);
            attributes["COLOR_0"] = json!(self.floats(&colors, Some(ARRAY), false));
        }
        let doppler: Vec<_> = first.doppler.iter().map(|d| [*d]).collect();
        attributes["_DOPPLER"] = json!(self.floats(&doppler, Some(ARRAY), false));
        let targets: Vec<Value> = surface.frames[1..]
            .iter()
            .map(|frame| {
                let less = |to: &[[f32; 3]], from: &[[f32; 3]]| -> Vec<[f32; 3]> {
                    to.iter().zip(from).map(|(a, b)| [0, 1, 2].map(|i| a[i] - b[i])).collect()
                };
                let moved = less(&self.positions(frame), &positions);
                let turned: Vec<_> = frame.normals.iter().map(|n| n.to_array()).collect();
                let mut target = json!({ "POSITION": self.floats(&moved, Some(ARRAY), true) });
                target["NORMAL"] = json!(self.floats(&less(&turned, &normals), Some(ARRAY), false));
                if frame.colors != first.colors {
                    let colored = less(&clipped(&frame.colors), &clipped(&first.colors));
                    target["COLOR_0"] = json!(self.floats(&colored, Some(ARRAY), false));
                }
                target
            })
            .collect();
        let indices = surface.triangles.iter().flatten().flat_map(|v| v.to_le_bytes());
        let view = self.view(indices, Some(INDICES));
        let count = 3 * surface.triangles.len();
        self.accessors
            .push(json!({ "bufferView": view, "componentType": UNSIGNED, "count": count, "type": "SCALAR" }));
        let indices = self.accessors.len() - 1;
        let material = self.material(&surface.material);
        let mut primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        if !targets.is_empty() {
            primitive["targets"] = json!(targets);
        }
        primitive
    }

    fn material(&mut self, material: &Material) -> usize {
        if let Some(known) = self.known.iter().position(|m| m == material) {
            return known;
        }
        self.known.push(material.clone());
        let [r, g, b] = clipped(&[material.base_color])[0];
        // Neither metal nor gloss: the colours are the surface's own.
        let mut base =
            json!({ "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0, "roughnessFactor": 1 });
        if let Some(texture) = &material.base_texture {
            base["baseColorTexture"] = self.texture(texture);
        }
        let mut out = json!({ "pbrMetallicRoughness": base, "doubleSided": !material.one_sided });
        if !material.name.is_empty() {
            out["name"] = json!(material.name);
        }
        let mut extensions = Map::new();
        let brightest = material.emission.into_iter().fold(0.0, f32::max);
        if brightest > 0.0 {
            let strength = brightest.max(1.0);
            out["emissiveFactor"] = json!(material.emission.map(|v| (v / strength).clamp(0.0, 1.0)));
            if let Some(texture) = &material.emission_texture {
                out["emissiveTexture"] = self.texture(texture);
            }
            if strength > 1.0 {
                extensions.insert(
                    self.extension("KHR_materials_emissive_strength"),
                    json!({ "emissiveStrength": strength }),
                );
            }
        }
        if material.surface == Surface::Luminous {
            extensions.insert(self.extension("KHR_materials_unlit"), json!({}));
        }
        if !extensions.is_empty() {
            out["extensions"] = Value::Object(extensions);
        }
        self.materials.push(out);
        self.materials.len() - 1
    }

    fn extension(&mut self, name: &'static str) -> String {
        if !self.extensions.contains(&name) {
            self.extensions.push(name);
        }
        name.to_owned()
    }

    fn texture(&mut self, texture: &Texture) -> Value {
        let filter = if texture.blocky { 9728 } else { 9729 };
        let [s, t] = texture.wrap.map(|wrap| match wrap {
            Wrap::Repeat => 10497,
            Wrap::Mirror => 33648,
            Wrap::Clamp => 33071,
        });
        let sampler = json!({ "magFilter": filter, "minFilter": 9987, "wrapS": s, "wrapT": t });
        let sampler = place_of(&mut self.samplers, sampler);
        let source = self.used.number(&texture.picture);
        let index = place_of(&mut self.textures, json!({ "sampler": sampler, "source": source }));
        let mut info = json!({ "index": index });
        if texture.transform != glam::DAffine2::IDENTITY {
            // Translation · rotation · scale, the rotation (cos sin; −sin cos).
            let [x, y] = [texture.transform.matrix2.x_axis, texture.transform.matrix2.y_axis];
            let (sin, cos) = if x.length() > 0.0 { (-x.y, x.x) } else { (y.x, y.y) };
            let rotation = sin.atan2(cos);
            let scale = [x.length(), y.x * rotation.sin() + y.y * rotation.cos()];
            let moved = json!({
                "offset": texture.transform.translation.as_vec2().to_array(),
                "rotation": rotation as f32,
                "scale": scale.map(|v| v as f32),
            });
            info["extensions"] = json!({ self.extension("KHR_texture_transform"): moved });
        }
        info
    }

    fn pictures(&mut self) {
        let used = std::mem::take(&mut self.used);
        for picture in used.iter() {
            let contents = file_of(picture);
            let kind = if is_png(&contents) { "image/png" } else { "image/jpeg" };
            let view = self.view(contents, None);
            self.images.push(json!({ "name": picture.name, "bufferView": view, "mimeType": kind }));
        }
    }
}

/// What the format allows.
fn clipped(colors: &[[f32; 3]]) -> Vec<[f32; 3]> {
    colors.iter().map(|c| c.map(|v| v.clamp(0.0, 1.0))).collect()
}

fn place_of(list: &mut Vec<Value>, value: Value) -> usize {
    list.iter().position(|v| *v == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}
