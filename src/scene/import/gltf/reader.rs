use super::super::{ImportError, Imported, Part, ReadFile, note_once, without_textures};
use super::buffers::{Buffers, INDEX_TYPES, allowed_types};
use super::choice::{self, Found};
use super::extras::Extras;
use super::motion::{Animated, placement};
use super::surface::Surfaces;
use crate::relativity::Motion;
use crate::scene::room::{Room, named_size, size};
use crate::scene::{Aim, Clip, Joint, Light, LightKind, Mesh, Paint, Projection, View};
use crate::spectrum::Spectrum;
use glam::{DAffine3, DVec3};
use gltf::mesh::Mode;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use terrell_geodesic::{Celerity, Event, FourVector, World};

/// A file on its way to parts.
pub(super) struct Reader<'a> {
    name: String,
    buffers: Buffers,
    surfaces: Surfaces,
    animated: Animated,
    /// Whether vectors in extras are in axes whose z is up.
    z_up: bool,
    parts: Vec<Part>,
    view: Option<View>,
    cameras: Vec<Found<'a>>,
    lights: Vec<Light>,
    notes: Vec<String>,
    /// Whether any primitive has a material or vertex colours.
    colored: bool,
    visited: Vec<bool>,
    room: Room,
}

/// Where the children of a node stand.
#[derive(Clone)]
struct Place {
    /// The part that is, or none that has a mesh yet.
    part: Option<usize>,
    /// What it is called, once it has one.
    name: Rc<str>,
    motion: Motion,
    /// Placements down to the last animated one, if any is.
    joints: Rc<[Joint]>,
    /// Within the last animated placement, or within the rest frame.
    within: DAffine3,
}

impl Place {
    fn clip(&self) -> Clip {
        Clip::new(self.joints.to_vec())
    }
}

impl<'a> Reader<'a> {
    pub fn new(
        file: &gltf::Gltf,
        buffers: Buffers,
        mut room: Room,
        path: &Path,
        read: ReadFile<'_>,
    ) -> Result<Self, ImportError> {
        let fault = |message| ImportError::Contents { path: path.to_owned(), line: None, message };
        let mut notes = Vec::new();
        let unknown: Vec<&str> =
            file.extensions_used().filter(|e| !super::KNOWN_EXTENSIONS.contains(e)).collect();
        if !unknown.is_empty() {
            notes.push(format!("left out, as it is not known here: {}", unknown.join(", ")));
        }
        let surfaces = Surfaces::read(file, &buffers, path, read, &mut notes);
        let animated = Animated::read(file, &buffers, &mut room, &mut notes).map_err(fault)?;
        let generator = file.document.as_json().asset.generator.as_deref().unwrap_or_default();
        Ok(Self {
            name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            buffers,
            surfaces,
            animated,
            z_up: generator.contains("Blender"),
            parts: Vec::new(),
            view: None,
            cameras: Vec::new(),
            lights: Vec::new(),
            notes,
            colored: false,
            visited: vec![false; file.nodes().len()],
            room,
        })
    }

    /// Tells which scene is shown of several, where none was asked for.
    pub fn note_scene(&mut self, scene: &gltf::Scene<'_>, count: usize) {
        if count > 1 {
            let name = scene.name().map_or(String::new(), |n| format!(" ('{n}')"));
            let number = scene.index() + 1;
            self.note(&format!(
                "of {count} scenes number {number}{name} is shown; --file-scene (file_scene in a [[body]]) takes another"
            ));
        }
    }

    /// Reads a scene; all meshes, where a file has none.
    pub fn scene(&mut self, file: &'a gltf::Gltf, scene: Option<gltf::Scene<'a>>) -> Result<(), String> {
        let still = Place {
            part: None,
            name: self.name.as_str().into(),
            motion: Motion::at_rest(DVec3::ZERO),
            joints: Rc::new([]),
            within: DAffine3::IDENTITY,
        };
        match scene {
            Some(scene) => {
                let mut waiting: Vec<_> = scene.nodes().map(|node| (node, still.clone())).collect();
                waiting.reverse();
                self.trees(waiting)?;
            }
            None => {
                let mut place = still;
                for mesh in file.meshes() {
                    self.mesh(&mesh, &mut place)?;
                }
            }
        }
        Ok(())
    }

    /// Trees of nodes, as deep as they may be; the last is next.
    fn trees(&mut self, mut waiting: Vec<(gltf::Node<'a>, Place)>) -> Result<(), String> {
        // What is still belongs together, wherever it is in the tree.
        let mut still = None;
        while let Some((node, mut place)) = waiting.pop() {
            // The format allows only trees; anything else could go round in circles.
            if std::mem::replace(&mut self.visited[node.index()], true) {
                return Err(format!("node {} has two parents", node.index()));
            }
            let fault = |e: String| format!("node {}: extras: {e}", named(&node));
            let extras = Extras::read(node.extras(), self.z_up).map_err(fault)?;
            if let Some(celerity) = extras.celerity {
                if self.z_up {
                    self.note("velocities are taken in Blender's axes (z up), as Blender wrote the file");
                }
                self.set_off(&mut place, &node, celerity, extras.time)?;
            }
            let own = placement(&node);
            match self.animated.joint(&node) {
                Some(joint) => {
                    self.room.take(place.joints.len() + 2)?;
                    let joints = place.joints.iter().cloned().chain([Joint::Fixed(place.within), joint]);
                    place.joints = joints.collect();
                    (place.part, place.within) = (None, DAffine3::IDENTITY);
                    place.name = named(&node).into();
                }
                None => place.within *= own,
            }
            let is_still = place.joints.is_empty() && place.motion == Motion::at_rest(DVec3::ZERO);
            if is_still {
                place.part = still;
            }
            if let Some(mesh) = node.mesh() {
                self.mesh(&mesh, &mut place)?;
            }
            if is_still {
                still = place.part;
            }
            if node.mesh().is_some_and(|mesh| mesh.primitives().any(|p| p.morph_targets().len() > 0)) {
                self.note("morph targets are left out");
            }
            if node.skin().is_some() {
                self.note("skins are not animated: the mesh is drawn as it was bound");
            }
            if let Some(light) = node.light() {
                self.light(&node, &light, &place)?;
            }
            if let Some(camera) = node.camera() {
                self.camera(&node, &camera, &place, &extras);
            }
            // Children in order, before siblings.
            let first = waiting.len();
            waiting.extend(node.children().map(|child| (child, place.clone())));
            waiting[first..].reverse();
        }
        Ok(())
    }

    /// Makes a node and all below it a body of its own: its rest frame's origin is where the node is.
    fn set_off(
        &self,
        place: &mut Place,
        node: &gltf::Node<'_>,
        celerity: Celerity,
        time: f64,
    ) -> Result<(), String> {
        if !place.joints.is_empty() {
            return Err(format!(
                "node {} has a velocity of its own, but hangs on an animated node; take one of the two off",
                named(node)
            ));
        }
        let at = (place.within * placement(node)).translation;
        let event = event(&place.motion, at);
        let origin = Event::at(time + event.t(), event.position());
        place.within = DAffine3::from_translation(-at) * place.within;
        place.motion = Motion { celerity, origin };
        (place.part, place.name) = (None, named(node).into());
        Ok(())
    }

    fn mesh(&mut self, mesh: &gltf::Mesh<'_>, place: &mut Place) -> Result<(), String> {
        for primitive in mesh.primitives() {
            let Some(read) = self.primitive(mesh, &primitive)? else { continue };
            let part = match place.part {
                Some(part) => part,
                None => {
                    self.room.take(named_size(&place.name) + place.joints.len())?;
                    let clip = (!place.joints.is_empty()).then(|| place.clip());
                    let name = self.unused(&place.name);
                    let (motion, mesh) = (place.motion, Mesh::default());
                    self.parts.push(Part { name, mesh: Arc::new(mesh), motion, clip });
                    *place.part.insert(self.parts.len() - 1)
                }
            };
            let whole = Arc::make_mut(&mut self.parts[part].mesh);
            let materials = read.material.first().map(|m| &self.surfaces.materials[*m as usize]);
            self.room.take(size(&read) + materials.map_or(0, |material| named_size(&material.name)))?;
            whole.append(read.placed(&place.within));
        }
        Ok(())
    }

    /// A name no part has yet.
    fn unused(&self, name: &str) -> String {
        let taken = |name: &str| self.parts.iter().any(|p| p.name == name);
        if !taken(name) {
            return name.to_owned();
        }
        (self.parts.len()..).map(|i| format!("{name}.{i}")).find(|n| !taken(n)).unwrap_or_default()
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
            self.buffers.check(&accessor, &semantic.to_string(), allowed_types(&semantic))?;
        }
        if let Some(accessor) = primitive.indices() {
            self.buffers.check(&accessor, "indices", &INDEX_TYPES)?;
        }
        let given = primitive.material().index();
        let mut material = given.unwrap_or(self.surfaces.materials.len() - 1);
        let Some(&uv_set) = self.surfaces.uv_sets.get(material) else {
            return Err(format!("mesh {} is of material {material}, which is not there", mesh.index()));
        };
        let buffers = &self.buffers;
        let reader = primitive.reader(|buffer| buffers.get(&buffer));
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
        let paint = match reader.read_colors(0) {
            Some(colors) => Paint::Vertices(colors.into_rgb_f32().collect()),
            None => Paint::Uniform([1.0; 3]),
        };
        self.colored |= given.is_some() || matches!(paint, Paint::Vertices(_));
        let uv: Vec<_> = reader.read_tex_coords(uv_set).map(|uv| uv.into_f32().collect()).unwrap_or_default();
        let mut out = Mesh {
            paint,
            normals: reader.read_normals().map(Iterator::collect).unwrap_or_default(),
            uv,
            ..Mesh::new(&vertices, triangles)
        };
        if out.triangles.is_empty() {
            return Ok(None);
        }
        out.check().map_err(|e| format!("mesh {}: {e}", mesh.index()))?;
        if out.uv.is_empty() && self.surfaces.materials[material].is_textured() {
            self.note("textures without texture coordinates are left out");
            material = without_textures(&mut self.surfaces.materials, material);
        }
        out.material = vec![material as u32; out.triangles.len()];
        Ok(Some(out))
    }

    /// A camera to choose from.
    fn camera(&mut self, node: &gltf::Node<'a>, camera: &gltf::Camera<'a>, place: &Place, extras: &Extras) {
        let names = [node.name(), camera.name()];
        let animated = !place.joints.is_empty();
        let gltf::camera::Projection::Perspective(lens) = camera.projection() else {
            self.cameras.push(Found { names, view: None, animated });
            return;
        };
        let within = place.clip().pose(0.0) * place.within;
        let event = event(&place.motion, within.translation);
        // With a velocity, it is the time of its motion, and in there already.
        let time = if extras.celerity.is_some() { 0.0 } else { extras.time };
        let direction = |v: DVec3| within.transform_vector3(v);
        let view = View {
            event: Event::at(event.t() + time, event.position()),
            celerity: place.motion.celerity,
            aim: Aim::Forward(direction(-DVec3::Z)),
            up: direction(DVec3::Y),
            projection: Projection::Pinhole,
            fov_deg: Some(f64::from(lens.yfov()).to_degrees()),
            nearest: extras.nearest.clone(),
            ..View::default()
        };
        self.cameras.push(Found { names, view: Some(view), animated });
    }

    /// The camera asked for becomes the view; else the first with perspective.
    pub fn choose_camera(&mut self, wanted: Option<&str>) -> Result<(), String> {
        if wanted.is_none() && self.cameras.iter().any(|camera| camera.view.is_none()) {
            self.note("a camera without perspective is left out");
        }
        let Some(found) = choice::camera(&self.cameras, wanted)? else { return Ok(()) };
        self.view = found.view.clone();
        if found.animated {
            self.note("the camera's animation is not followed: it stays as at its beginning");
        }
        Ok(())
    }

    fn light(
        &mut self,
        node: &gltf::Node<'_>,
        light: &gltf::khr_lights_punctual::Light<'_>,
        place: &Place,
    ) -> Result<(), String> {
        use gltf::khr_lights_punctual::Kind;
        let within = place.clip().pose(0.0) * place.within;
        // Lights look along −z.
        let direction = within.transform_vector3(-DVec3::Z).normalize_or_zero();
        let position = within.translation;
        let name = light.name().map_or_else(|| named(node), str::to_owned);
        self.room.take(named_size(&name))?;
        let (strength, color) = (f64::from(light.intensity()), light.color());
        if light.range().is_some() {
            self.note("lights reach as far as they do: their range is left out");
        }
        if !place.joints.is_empty() {
            self.note("a light's animation is not followed: it stays as at its beginning");
        }
        let possible = |v: f64| (0.0..=1e12).contains(&v);
        if !possible(strength) || !color.iter().all(|v| possible((*v).into())) {
            return Err(format!(
                "light '{name}': its intensity, {strength}, and its colour must lie between 0 and 1e12"
            ));
        }
        self.lights.push(Light {
            name,
            kind: match light.kind() {
                Kind::Directional => LightKind::Distant { direction },
                Kind::Point => LightKind::Point { position },
                Kind::Spot { inner_cone_angle, outer_cone_angle } => {
                    LightKind::Spot { position, direction, cone: [inner_cone_angle, outer_cone_angle] }
                }
            },
            color,
            spectrum: Spectrum::default(),
            // Lux and candela.
            strength,
            motion: place.motion,
        });
        Ok(())
    }

    pub fn finish(mut self) -> Imported {
        for part in &mut self.parts {
            // Of all materials those it uses, in their order.
            let mut new = vec![None; self.surfaces.materials.len()];
            let mesh = Arc::make_mut(&mut part.mesh);
            for index in &mut mesh.material {
                let old = *index as usize;
                *index = *new[old].get_or_insert_with(|| {
                    mesh.materials.push(self.surfaces.materials[old].clone());
                    mesh.materials.len() as u32 - 1
                });
            }
            if !self.colored {
                mesh.paint_as_clay();
            }
        }
        Imported {
            parts: self.parts,
            view: self.view,
            cameras: self.cameras.len(),
            lights: self.lights,
            bytes: self.room.bytes(),
            notes: self.notes,
            ..Imported::default()
        }
    }

    fn note(&mut self, note: &str) {
        note_once(&mut self.notes, note);
    }
}

fn named(node: &gltf::Node<'_>) -> String {
    node.name().map_or_else(|| format!("node{}", node.index()), str::to_owned)
}

/// Where a point of a body's rest frame is at rest-frame time 0.
fn event(motion: &Motion, x_rest: DVec3) -> Event<World> {
    motion.origin + motion.world_from_rest::<f64>() * FourVector::from_parts(0.0, x_rest)
}
