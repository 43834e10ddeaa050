use super::super::picture::decode;
use super::super::{ReadFile, note_once};
use super::buffers::{Buffers, at_uri};
use crate::scene::{Gloss, Material, Picture, Surface, Texture, Wrap};
use glam::{DAffine2, DMat2, DVec2};
use gltf::material::AlphaMode;
use gltf::texture::{MagFilter, WrappingMode};
use std::path::Path;
use std::sync::Arc;

/// What the format has surfaces that are no metals reflect at right angles.
const DIELECTRIC: f32 = 0.04;

/// The materials of a file.
pub(super) struct Surfaces {
    /// In the file's order, then the one of what has none.
    pub materials: Vec<Material>,
    /// Which texture coordinates each uses.
    pub uv_sets: Vec<u32>,
}

impl Surfaces {
    pub fn read(
        file: &gltf::Gltf,
        buffers: &Buffers,
        path: &Path,
        read: ReadFile<'_>,
        notes: &mut Vec<String>,
    ) -> Self {
        let mut out = Self { materials: Vec::new(), uv_sets: Vec::new() };
        let mut pictures: Vec<Option<Option<Arc<Picture>>>> = vec![None; file.images().len()];
        for material in file.materials() {
            let base = material.pbr_metallic_roughness();
            let mut uv_set = None;
            let mut texture = |info: Option<gltf::texture::Info<'_>>| {
                let info = info?;
                let image = info.texture().source();
                let Some(image) = image else {
                    note_once(notes, "without a texture: it has no picture in a format that can be read");
                    return None;
                };
                let slot = pictures.get_mut(image.index())?;
                let picture = match slot {
                    Some(picture) => picture.clone(),
                    None => {
                        let decoded = picture(&image, buffers, path, read);
                        let picture = match decoded {
                            Ok(picture) => Some(Arc::new(picture)),
                            Err(e) => {
                                note_once(notes, &format!("without a texture: {e}"));
                                None
                            }
                        };
                        slot.insert(picture).clone()
                    }
                }?;
                let moved = info.texture_transform();
                let set = moved.as_ref().and_then(|t| t.tex_coord()).unwrap_or(info.tex_coord());
                if *uv_set.get_or_insert(set) != set {
                    note_once(
                        notes,
                        "a second set of texture coordinates in one material is taken for the first",
                    );
                }
                let sampler = info.texture().sampler();
                Some(Texture {
                    wrap: [sampler.wrap_s(), sampler.wrap_t()].map(|wrap| match wrap {
                        WrappingMode::Repeat => Wrap::Repeat,
                        WrappingMode::MirroredRepeat => Wrap::Mirror,
                        WrappingMode::ClampToEdge => Wrap::Clamp,
                    }),
                    blocky: sampler.mag_filter() == Some(MagFilter::Nearest),
                    transform: moved.map_or(DAffine2::IDENTITY, |t| {
                        let [offset, scale] = [t.offset(), t.scale()].map(|v| DVec2::from(v.map(f64::from)));
                        // The extension turns the other way than v, which goes down, makes look natural.
                        let (sin, cos) = f64::from(t.rotation()).sin_cos();
                        let turn = DMat2::from_cols(DVec2::new(cos, -sin), DVec2::new(sin, cos));
                        DAffine2::from_mat2_translation(turn * DMat2::from_diagonal(scale), offset)
                    }),
                    ..Texture::of(picture)
                })
            };
            let base_texture = texture(base.base_color_texture());
            let emission_texture = texture(material.emissive_texture());
            if material.normal_texture().is_some() || material.occlusion_texture().is_some() {
                note_once(notes, "textures of normals and of occlusion are left out");
            }
            if base.metallic_roughness_texture().is_some() {
                note_once(notes, "textures of metal and roughness are left out");
            }
            let strength = material.emissive_strength().unwrap_or(1.0);
            let [r, g, b, alpha] = base.base_color_factor();
            if material.alpha_mode() != AlphaMode::Opaque && (alpha < 1.0 || base_texture.is_some()) {
                note_once(notes, "transparency is not drawn");
            }
            out.materials.push(Material {
                name: material.name().unwrap_or_default().to_owned(),
                base_color: [r, g, b],
                base_texture,
                emission: material.emissive_factor().map(|v| v * strength),
                emission_texture,
                surface: if material.unlit() { Surface::Luminous } else { Surface::Auto },
                gloss: Gloss {
                    reflectance: DIELECTRIC,
                    roughness: base.roughness_factor(),
                    metallic: base.metallic_factor(),
                },
                one_sided: !material.double_sided(),
                ..Material::default()
            });
            out.uv_sets.push(uv_set.unwrap_or(0));
        }
        out.materials.push(Material { one_sided: true, ..Material::default() });
        out.uv_sets.push(0);
        out
    }
}

fn picture(
    image: &gltf::Image<'_>,
    buffers: &Buffers,
    path: &Path,
    read: ReadFile<'_>,
) -> Result<Picture, String> {
    use gltf::image::Source;
    let numbered = || format!("image {}", image.index());
    match image.source() {
        Source::Uri { uri, .. } => {
            let embedded = uri.starts_with("data:");
            let name =
                if embedded { image.name().map_or_else(numbered, str::to_owned) } else { uri.to_owned() };
            decode(&name, at_uri(uri, path, read).map_err(|e| e.to_string())?)
        }
        Source::View { view, .. } => {
            let name = image.name().map_or_else(numbered, str::to_owned);
            let bytes = buffers.view(&view).ok_or_else(|| format!("{name} reaches beyond its buffer"))?;
            decode(&name, bytes.to_vec())
        }
    }
}
