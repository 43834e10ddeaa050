use super::SceneError;
use super::light::Finish;
use super::source::{Source, VelocityKeys, did_you_mean, velocity_keys};
use super::tables::{BodyTable, RotationTable, Scale};
use crate::relativity::Motion;
use crate::scene::import::{CLAY_NOTE, Choice, ImportError, has_scenes, import_choosing, is_mesh_file};
use crate::scene::room::{Room, named_size, size};
use crate::scene::{Body, Part, builtin_mesh, builtin_meshes};
use glam::{DAffine3, DQuat, DVec3};
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::Spanned;

/// The bodies of a scene file, read one after another.
pub(super) struct Bodies<'a> {
    source: &'a Source<'a>,
    finishes: &'a BTreeMap<&'a str, Finish>,
    /// Meshes so far; what looks alike is kept once.
    looks: HashMap<Look, Vec<Part>>,
    room: Room,
    pub files: Vec<PathBuf>,
    pub notes: Vec<String>,
}

/// What makes meshes of bodies alike.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Look {
    mesh: String,
    file_scene: Option<String>,
    /// Name of the material.
    material: Option<String>,
    /// Scale and rotation, by their bits.
    place: [u64; 12],
}

/// What to do with scenes whose bodies have too many meshes of their own.
const REMEDY: &str =
    "use fewer bodies, or give them the same scale, rotation and material: then they share one mesh";

impl<'a> Bodies<'a> {
    /// `files` are those read so far.
    pub fn new(source: &'a Source<'a>, finishes: &'a BTreeMap<&'a str, Finish>, files: Vec<PathBuf>) -> Self {
        let room = Room::new(source.text.len(), REMEDY);
        Self { source, finishes, looks: HashMap::new(), room, files, notes: Vec::new() }
    }

    /// The next body; of a file in which something is animated, more than one.
    pub fn read(&mut self, index: usize, table: &BodyTable) -> Result<Vec<Body>, SceneError> {
        let source = self.source;
        let mut parts = self.parts(table)?;
        if let Some(rate) = &table.animation_rate {
            let seconds = source.finite("animation_rate", rate)?;
            parts.iter_mut().filter_map(|part| part.clip.as_mut()).for_each(|clip| clip.rate = seconds);
        }
        let motion = Motion {
            celerity: source.celerity(&velocity_keys!(table))?,
            origin: source.event(&table.time, &table.position)?,
        };
        let stem = Path::new(table.mesh.get_ref()).file_stem().unwrap_or_default().to_string_lossy();
        let name = table.name.clone().unwrap_or(match index {
            0 => stem.into_owned(),
            _ => format!("{stem}{index}"),
        });
        // Bodies need room, too, and what moves them.
        let joints = |part: &Part| part.clip.as_ref().map_or(0, |clip| clip.joints.len());
        let sizes = parts.iter().map(|part| named_size(&name) + named_size(&part.name) + joints(part));
        self.take(table, sizes.sum())?;
        // What is animated within it goes by its own name, too.
        let named = |(i, part): (usize, Part)| Body {
            name: if i == 0 { name.clone() } else { format!("{name}.{}", part.name) },
            motion,
            ..part.into_body()
        };
        Ok(parts.into_iter().enumerate().map(named).collect())
    }

    /// A body's meshes, as its material, scale and rotation make them; shared with all that look alike.
    fn parts(&mut self, table: &BodyTable) -> Result<Vec<Part>, SceneError> {
        let file_scene = table.file_scene.as_ref().map(|scene| scene.get_ref().to_string());
        let plain = Look {
            mesh: table.mesh.get_ref().clone(),
            file_scene,
            material: None,
            place: DAffine3::IDENTITY.to_cols_array().map(f64::to_bits),
        };
        if !self.looks.contains_key(&plain) {
            let parts = self.read_mesh(table)?;
            let sizes = parts.iter().map(|part| size(&part.mesh)).sum();
            self.take(table, sizes)?;
            self.looks.insert(plain.clone(), parts);
        }
        let finish = self.finish(table)?;
        let place = place(self.source, table)?;
        let look = Look {
            material: table.material.as_ref().map(|name| name.get_ref().clone()),
            place: place.to_cols_array().map(f64::to_bits),
            ..plain.clone()
        };
        if !self.looks.contains_key(&look) {
            let mut parts = self.looks[&plain].clone();
            // What is animated is placed by its clip.
            let copied = parts.iter().filter(|part| finish.is_some() || part.clip.is_none());
            let sizes = copied.map(|part| size(&part.mesh)).sum();
            self.take(table, sizes)?;
            for part in &mut parts {
                if let Some(finish) = finish {
                    finish.apply(Arc::make_mut(&mut part.mesh));
                }
                if place != DAffine3::IDENTITY {
                    part.place(place);
                }
                part.mesh.check().map_err(|e| self.source.at(&table.mesh, e))?;
            }
            self.looks.insert(look.clone(), parts);
        }
        Ok(self.looks[&look].clone())
    }

    fn take(&mut self, table: &BodyTable, count: usize) -> Result<(), SceneError> {
        self.room.take(count).map_err(|e| self.source.at(&table.mesh, e))
    }

    fn finish(&self, table: &BodyTable) -> Result<Option<&'a Finish>, SceneError> {
        let Some(word) = &table.material else { return Ok(None) };
        let name = word.get_ref();
        let finish = self.finishes.get(name.as_str()).ok_or_else(|| {
            let known = self.finishes.keys().copied();
            self.source.at(word, format!("there is no [material.{name}]; {}", did_you_mean(name, known)))
        })?;
        Ok(Some(finish))
    }

    fn read_mesh(&mut self, table: &BodyTable) -> Result<Vec<Part>, SceneError> {
        let (source, word, name) = (self.source, &table.mesh, table.mesh.get_ref());
        let builtin = builtin_mesh(name);
        let scene = table.file_scene.as_ref();
        if let Some(scene) = scene.filter(|_| builtin.is_some() || !has_scenes(Path::new(name))) {
            let message =
                format!("file_scene chooses within a .gltf or .glb file, and mesh '{name}' is none");
            return Err(source.at(scene, message));
        }
        if let Some(mesh) = builtin {
            return Ok(vec![Part::still(name.clone(), mesh)]);
        }
        if !is_mesh_file(Path::new(name)) {
            let message = format!(
                "there is no mesh '{name}' built in ({}), and only .obj, .gltf and .glb files can be read",
                did_you_mean(name, builtin_meshes())
            );
            return Err(source.at(word, message));
        }
        let file = source.path.parent().unwrap_or(Path::new("")).join(name);
        let choice = Choice { scene: scene.map(|scene| scene.get_ref().to_string()), camera: None };
        let imported = import_choosing(&file, &choice).map_err(|e| match (&e, scene) {
            (ImportError::Choice { .. }, Some(scene)) => source.at(scene, format!("file_scene: {e}")),
            _ => source.at(word, e),
        })?;
        if imported.moves() {
            let note = "velocities in it are left out; a [[body]] moves as a whole";
            self.notes.push(format!("{name}: {note}"));
        }
        if !imported.lights.is_empty() {
            self.notes.push(format!("{name}: lights in it are left out; a scene's are its [[light]]s"));
        }
        // Another scene of the same file is nothing more to read.
        if !self.files.contains(&file) {
            self.room.widen(imported.bytes);
        }
        let imported = imported.settled();
        // Whether it stays so is known when all is read.
        self.notes.extend(imported.notes.into_iter().filter(|note| note != CLAY_NOTE));
        self.files.extend(imported.files);
        Ok(imported.parts)
    }
}

/// Where scale and rotation put a body's mesh in its rest frame.
fn place(source: &Source<'_>, table: &BodyTable) -> Result<DAffine3, SceneError> {
    let scale = table.scale.as_ref().map_or(Ok(DVec3::ONE), |scale| read_scale(source, scale))?;
    let rotation =
        table.rotation.as_ref().map_or(Ok(DQuat::IDENTITY), |table| read_rotation(source, table))?;
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation, DVec3::ZERO))
}

fn read_scale(source: &Source<'_>, place: &Spanned<Scale>) -> Result<DVec3, SceneError> {
    let scale = match *place.get_ref() {
        Scale::Same(s) => DVec3::splat(s),
        Scale::Each(s) => DVec3::from_array(s),
    };
    if !scale.is_finite() || scale.min_element().abs().min(scale.max_element().abs()) == 0.0 {
        return Err(source.at(place, "scale must be finite and not zero"));
    }
    Ok(scale)
}

pub(super) fn read_rotation(source: &Source<'_>, table: &RotationTable) -> Result<DQuat, SceneError> {
    let axis = source.vector("rotation.axis", &table.axis)?.normalize_or_zero();
    if axis == DVec3::ZERO {
        return Err(source.at(&table.axis, "rotation.axis has length zero"));
    }
    let angle_deg = source.finite("rotation.angle_deg", &table.angle_deg)?;
    Ok(DQuat::from_axis_angle(axis, angle_deg.to_radians()))
}
