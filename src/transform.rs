//! A scene to the shapes its bodies seem to have: the paper's map as a tool.

use crate::apparent::{Cutting, CuttingError, Moment, see_vertices};
use crate::color::Coloring;
use crate::export::{Eye, Frame, Model, Object, Surface};
use crate::light::{Point, SeenShading, Shading, ShadingError, TableInfo};
use crate::relativity::ApparentMap;
use crate::scene::{Body, Camera, Material, Mesh, Paint, Projection, Scene, Surface as Shines};
use crate::tone::{Development, Tone};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use terrell_geodesic::{Tetrad, TetradError};

/// The usual tolerance, in diagonals of the body.
pub const USUAL_TOLERANCE: f64 = 3e-4;

/// How to transform.
#[derive(Clone, Debug)]
pub struct Options {
    /// Largest distance between what is written and what is seen, in the scene's lengths; none for
    /// [`USUAL_TOLERANCE`] of each body's own diagonal.
    pub tolerance: Option<f64>,
    /// The most triangles all bodies together may be cut into.
    pub most_pieces: usize,
    /// The axes of what comes out.
    pub axes: Axes,
    /// What the colours are: the surfaces' own, or as they are seen at the vertices.
    pub coloring: Coloring,
    /// Exposure of colours as they are seen; none for one that makes the brightest white but for one in twenty.
    pub ev: Option<f32>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: None,
            most_pieces: 10_000_000,
            axes: Axes::World,
            coloring: Coloring::Geometry,
            ev: None,
        }
    }
}

/// Axes, right-handed, of what comes out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// The world's, as a pure boost takes them to the camera's frame, around the camera's place in the world:
    /// without motion everything is where it was.
    World,
    /// x right, y up, the camera at the origin looking along −z.
    Camera,
}

/// What was done and what it took.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The tolerance kept; if each body had its own, the largest.
    pub tolerance: f64,
    /// Triangles of the meshes.
    pub triangles: usize,
    /// Triangles after cutting.
    pub pieces: usize,
    /// Vertices, split where colours, materials or hard edges need it.
    pub vertices: usize,
    /// Least and greatest Doppler factor of a vertex.
    pub doppler: Option<[f32; 2]>,
    /// Exposure of the colours.
    pub ev: f32,
    /// The tables these come from.
    pub tables: Vec<TableInfo>,
    /// Time for mapping and cutting.
    pub subdivision: Duration,
}

/// Why a scene cannot be transformed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransformError {
    /// The tolerance.
    #[error(transparent)]
    Cutting(#[from] CuttingError),
    /// The axes.
    #[error("the camera cannot be set up: {0}")]
    Axes(#[from] TetradError),
    /// A spectrum that cannot be.
    #[error(transparent)]
    Shading(#[from] ShadingError),
    /// Bent light.
    #[error(
        "in curved spacetime a body can be seen in several places at once, so it has no one apparent shape; draw it with `terrell render`"
    )]
    Curved,
}

/// Moves every body to where `camera` sees it (Nollert et al. 2000, Eq. 1), cut until flat triangles are nowhere
/// off by more than the tolerance; nothing is left out.
///
/// With several `moments` (of the same camera, the first its own) one set of triangles serves all; `times` are
/// their seconds. Normals are those of the apparent surface: the normals of the mesh, or where it has none those of
/// its flat faces, by the derivative of the map.
///
/// # Errors
/// If the tolerance cannot be kept, or spacetime is curved.
///
/// # Panics
/// If there is no moment.
pub fn transform(
    scene: &Scene,
    camera: &Camera,
    moments: &[Tetrad],
    times: &[f64],
    options: &Options,
) -> Result<(Model, Report), TransformError> {
    let start = Instant::now();
    if scene.spacetime.is_curved() {
        return Err(TransformError::Curved);
    }
    let observers: Vec<Observer> =
        moments.iter().map(|m| Observer::new(m, options.axes)).collect::<Result<_, _>>()?;
    let diagonal = |body: &Body| body.mesh.bounds().map_or(0.0, |(low, high)| (high - low).length());
    let shading = Shading::new(scene, moments, options.coloring)?;
    let shadings: Vec<_> = moments.iter().map(|m| shading.seen_by(m)).collect();
    let mut report = Report { tables: shading.tables().to_vec(), ..Report::default() };
    let mut objects = Vec::with_capacity(scene.bodies.len());
    for (index, body) in scene.bodies.iter().enumerate() {
        let left = options.most_pieces.saturating_sub(report.pieces);
        let size = diagonal(body);
        let usual = if size > 0.0 { USUAL_TOLERANCE * size } else { USUAL_TOLERANCE };
        let tolerance = options.tolerance.unwrap_or(usual);
        report.tolerance = report.tolerance.max(tolerance);
        let seen: Vec<(Arc<Mesh>, ApparentMap)> = moments
            .iter()
            .zip(&observers)
            .map(|(moment, observer)| {
                (body.mesh_seen(moment), ApparentMap::new(&body.motion, &observer.tetrad))
            })
            .collect();
        let of: Vec<_> = seen.iter().map(|(mesh, map)| Moment { mesh, map }).collect();
        let cutting = Cutting::new(&of, tolerance, left).map_err(|e| match e {
            CuttingError::TooMany { tolerance, .. } => {
                CuttingError::TooMany { tolerance, most: options.most_pieces }
            }
            other => other,
        })?;
        report.triangles += body.mesh.triangles.len();
        report.pieces += cutting.triangles.len();
        let seen = Seen { index, moments: &of, observers: &observers, shadings: &shadings };
        objects.push(object(&body.name, &seen, &cutting, options.coloring));
    }
    if options.coloring.is_beamed() {
        report.ev = expose(&mut objects, options.ev);
    }
    let frames = objects.iter().flat_map(|o| &o.surfaces).flat_map(|s| &s.frames);
    let range = |range: Option<[f32; 2]>, d: &f32| {
        Some(range.map_or([*d; 2], |[low, high]| [low.min(*d), high.max(*d)]))
    };
    report.doppler = frames.flat_map(|f| &f.doppler).fold(None, range);
    report.subdivision = start.elapsed();
    let model = Model {
        name: scene.name.clone(),
        objects,
        eye: eye(camera, &observers, options.axes),
        times: times.to_vec(),
        extras: serde_json::Map::new(),
    };
    report.vertices = model.vertex_count();
    Ok((model, report))
}

/// Someone whose axes x, y, −z are those of what comes out.
pub(crate) struct Observer {
    tetrad: Tetrad,
    place: DVec3,
}

impl Observer {
    fn new(moment: &Tetrad, axes: Axes) -> Result<Self, TetradError> {
        Ok(match axes {
            Axes::World => Self {
                tetrad: Tetrad::new(moment.event(), moment.celerity(), -DVec3::Z, DVec3::Y)?,
                place: moment.event().position(),
            },
            Axes::Camera => Self { tetrad: *moment, place: DVec3::ZERO },
        })
    }

    /// Components in the observer's (left-handed) axes to those of what comes out, and back.
    pub(crate) fn turned(v: DVec3) -> DVec3 {
        DVec3::new(v.x, v.y, -v.z)
    }
}

/// The camera in what comes out; none if it is no pinhole.
fn eye(camera: &Camera, observers: &[Observer], axes: Axes) -> Option<Eye> {
    let lens = &camera.lens;
    (lens.projection() == Projection::Pinhole).then(|| Eye {
        positions: observers.iter().map(|o| o.place).collect(),
        axes: match axes {
            Axes::World => camera.observer.axes(),
            Axes::Camera => [DVec3::X, DVec3::Y, -DVec3::Z],
        },
        field: 2.0 * (lens.middle().y / lens.focal().y).atan(),
        size: [lens.width(), lens.height()],
    })
}

/// What tells two corners at one vertex apart: the direction of the face, where the mesh has no normals, and its
/// colour.
type CornerKey = (u32, [i32; 3], [u32; 3]);

/// Corners of one material, each once.
#[derive(Default)]
struct Group {
    numbers: HashMap<CornerKey, u32>,
    /// Vertex and face of each.
    corners: Vec<(u32, u32)>,
    triangles: Vec<[u32; 3]>,
}

/// A body at all moments.
struct Seen<'a> {
    /// Its number in the scene.
    index: usize,
    moments: &'a [Moment<'a>],
    observers: &'a [Observer],
    shadings: &'a [SeenShading<'a>],
}

/// One exposure for all colours; returns it.
fn expose(objects: &mut [Object], ev: Option<f32>) -> f32 {
    let frames = |objects: &[Object]| -> Vec<[f32; 3]> {
        let frames = objects.iter().flat_map(|o| &o.surfaces).flat_map(|s| &s.frames);
        frames.flat_map(|f| f.colors.iter().copied()).collect()
    };
    let ev = ev.unwrap_or_else(|| Tone::Linear.metered(frames(objects)));
    let development = Development { ev, tone: Tone::Linear };
    let frames = objects.iter_mut().flat_map(|o| &mut o.surfaces).flat_map(|s| &mut s.frames);
    frames.flat_map(|f| &mut f.colors).for_each(|color| *color = development.shown(*color));
    ev
}

fn object(name: &str, seen: &Seen<'_>, cutting: &Cutting, coloring: Coloring) -> Object {
    let mesh = seen.moments[0].mesh;
    let own_colors = coloring == Coloring::Geometry;
    let has_materials = coloring != Coloring::Doppler;
    let face_normals = face_normals(mesh);
    let mut groups: Vec<Group> = Vec::new();
    groups.resize_with(if has_materials { mesh.materials.len().max(1) } else { 1 }, Group::default);
    for (triangle, &face) in cutting.triangles.iter().zip(&cutting.face) {
        let material = if has_materials { mesh.material_index(face as usize) } else { 0 };
        let direction = if mesh.normals.is_empty() {
            // Faces of one plane differ by rounding.
            face_normals[face as usize].map(|v| (v * 1e5).round() as i32)
        } else {
            [0; 3]
        };
        let color = match &mesh.paint {
            Paint::Faces(colors) if has_materials => colors[face as usize].map(f32::to_bits),
            _ => [0; 3],
        };
        let Group { numbers, corners, triangles } = &mut groups[material];
        triangles.push(triangle.map(|vertex| {
            *numbers.entry((vertex, direction, color)).or_insert_with(|| {
                corners.push((vertex, face));
                (corners.len() - 1) as u32
            })
        }));
    }
    let cut = cutting.apply(mesh);
    let mut surfaces: Vec<Surface> = groups
        .iter()
        .enumerate()
        .filter(|(_, group)| !group.triangles.is_empty())
        .map(|(material, group)| Surface {
            material: material_of(mesh, material, coloring),
            triangles: group.triangles.clone(),
            uv: match &cut.uv {
                uv if uv.is_empty() || !has_materials => Vec::new(),
                uv => group.corners.iter().map(|(vertex, _)| uv[*vertex as usize]).collect(),
            },
            frames: Vec::new(),
        })
        .collect();
    groups.retain(|group| !group.triangles.is_empty());
    for ((moment, observer), shading) in seen.moments.iter().zip(seen.observers).zip(seen.shadings) {
        let cut = cutting.apply(moment.mesh);
        let normals = self::face_normals(moment.mesh);
        let (positions_seen, doppler) = see_vertices(&cut, moment.map);
        for (surface, group) in surfaces.iter_mut().zip(&groups) {
            let positions = group
                .corners
                .iter()
                .map(|(v, _)| observer.place + Observer::turned(positions_seen[*v as usize]));
            // Of a point at the observer there is no Doppler factor.
            let doppler_of = |v: u32| Some(doppler[v as usize]).filter(|d| d.is_finite()).unwrap_or(1.0);
            let normal_rest = |vertex: u32, face: u32| match cut.normals.get(vertex as usize) {
                Some(normal) if *normal != [0.0; 3] => DVec3::from_array(normal.map(f64::from)),
                _ => DVec3::from_array(normals[face as usize]),
            };
            let colors = match &cut.paint {
                _ if !own_colors => {
                    let light = |(v, face): &(u32, u32)| {
                        let face_index = *face as usize;
                        let paint = match &cut.paint {
                            Paint::Faces(_) => face_color(mesh, *face),
                            paint => paint.at(0, [*v; 3], [1.0, 0.0, 0.0]),
                        };
                        // A texture stays a texture, times what is seen of white there.
                        let colors = || {
                            let plain = crate::scene::Colors { base: paint, ..Default::default() };
                            mesh.material_of(face_index).map_or(plain, |m| m.colors(paint, |_| [1.0; 3]))
                        };
                        let point = || {
                            let facing = DVec3::from_array(normals[face_index]);
                            let offset = moment.map.offset_rest(cut.vertex(*v));
                            Point::new(offset, facing, normal_rest(*v, *face))
                        };
                        let material = mesh.material_index(face_index);
                        shading.radiance(seen.index, material, doppler_of(*v), colors, point)
                    };
                    group.corners.iter().map(light).collect()
                }
                Paint::Uniform(_) => Vec::new(),
                Paint::Vertices(colors) => group.corners.iter().map(|(v, _)| colors[*v as usize]).collect(),
                // The pieces have their faces' colours; these are asked here.
                Paint::Faces(_) => group.corners.iter().map(|(_, f)| face_color(mesh, *f)).collect(),
            };
            let normal = |(vertex, face): &(u32, u32)| {
                let rest = normal_rest(*vertex, *face);
                let seen = moment.map.seen_normal(cut.vertex(*vertex), rest);
                Observer::turned(seen).as_vec3().normalize_or(Vec3::Y)
            };
            surface.frames.push(Frame {
                positions: positions.collect(),
                normals: group.corners.par_iter().map(normal).collect(),
                colors,
                doppler: group.corners.iter().map(|(v, _)| doppler_of(*v) as f32).collect(),
            });
        }
    }
    Object { name: name.to_owned(), surfaces }
}

fn face_normals(mesh: &Mesh) -> Vec<[f64; 3]> {
    let normal = |face: usize| {
        let [a, b, c] = mesh.corners(face);
        // Scaled first: the product of small sides may leave the range of the numbers.
        (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or_zero().to_array()
    };
    (0..mesh.triangles.len()).into_par_iter().map(normal).collect()
}

fn face_color(mesh: &Mesh, face: u32) -> [f32; 3] {
    mesh.paint.at(face as usize, mesh.triangles[face as usize], [1.0, 0.0, 0.0])
}

/// What a group is made of, with the mesh's one colour in it, if it has one. Paint alone shines by itself, and so do colours
/// as they are seen: of the material only the texture is left.
fn material_of(mesh: &Mesh, index: usize, coloring: Coloring) -> Material {
    if coloring != Coloring::Geometry {
        let textured = coloring != Coloring::Doppler;
        let own = mesh.materials.get(index).cloned().unwrap_or_default();
        return Material {
            name: own.name,
            base_texture: own.base_texture.or(own.emission_texture).filter(|_| textured),
            surface: Shines::Luminous,
            ..Material::default()
        };
    }
    let usual = || Material { surface: Shines::Luminous, ..Material::default() };
    let mut material = mesh.materials.get(index).cloned().unwrap_or_else(usual);
    if let Paint::Uniform(color) = mesh.paint {
        material.base_color = [0, 1, 2].map(|i| material.base_color[i] * color[i]);
    }
    material
}
