//! What a scene file may hold, key by key.

use serde::Deserialize;
use std::collections::BTreeMap;
use toml::{Spanned, Value};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub spacetime: Option<SpacetimeTable>,
    pub camera: Option<CameraTable>,
    pub sky: Option<SkyTable>,
    #[serde(default)]
    pub body: Vec<BodyTable>,
    #[serde(default)]
    pub material: BTreeMap<String, MaterialTable>,
    #[serde(default)]
    pub light: Vec<LightTable>,
    pub animation: Option<AnimationTable>,
}

pub(super) type Vector = Spanned<[f64; 3]>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    pub time: Option<Spanned<f64>>,
    pub position: Option<Vector>,
    pub look_at: Option<Vector>,
    pub forward: Option<Vector>,
    pub up: Option<Vector>,
    pub velocity: Option<Vector>,
    pub celerity: Option<Vector>,
    pub beta: Option<Spanned<f64>>,
    pub gamma: Option<Spanned<f64>>,
    pub rapidity: Option<Spanned<f64>>,
    pub direction: Option<Vector>,
    pub projection: Option<Spanned<String>>,
    pub fov_deg: Option<Spanned<f64>>,
    pub size: Option<Spanned<[u32; 2]>>,
    pub nearest: Option<Spanned<String>>,
    pub observer: Option<Spanned<String>>,
    pub at_infinity: Option<Spanned<InfinityTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InfinityTable {
    pub inclination_deg: Spanned<f64>,
    pub azimuth_deg: Option<Spanned<f64>>,
    pub height: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpacetimeTable {
    pub metric: Spanned<String>,
    pub mass: Option<Spanned<f64>>,
    pub spin: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SkyTable {
    pub texture: Spanned<String>,
    pub strength: Option<Spanned<f64>>,
    pub spectrum: Option<Spanned<Value>>,
    pub beyond: Option<Spanned<String>>,
    pub rotation: Option<RotationTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyTable {
    pub name: Option<String>,
    pub mesh: Spanned<String>,
    pub file_scene: Option<Spanned<Name>>,
    pub time: Option<Spanned<f64>>,
    pub position: Option<Vector>,
    pub velocity: Option<Vector>,
    pub celerity: Option<Vector>,
    pub beta: Option<Spanned<f64>>,
    pub gamma: Option<Spanned<f64>>,
    pub rapidity: Option<Spanned<f64>>,
    pub direction: Option<Vector>,
    pub rotation: Option<RotationTable>,
    pub scale: Option<Spanned<Scale>>,
    pub animation_rate: Option<Spanned<f64>>,
    pub material: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RotationTable {
    pub axis: Vector,
    pub angle_deg: Spanned<f64>,
}

/// A name, or a number.
#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Name {
    Text(String),
    Number(u32),
}

impl std::fmt::Display for Name {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Text(text) => f.write_str(text),
            Self::Number(number) => number.fmt(f),
        }
    }
}

#[derive(Clone, Copy, Deserialize)]
#[serde(untagged)]
pub(super) enum Scale {
    Same(f64),
    Each([f64; 3]),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    pub color: Option<Spanned<Color>>,
    pub emission: Option<Spanned<Color>>,
    pub spectrum: Option<Spanned<Value>>,
    pub luminance: Option<Spanned<f64>>,
    pub radiance: Option<Spanned<f64>>,
    pub beyond: Option<Spanned<String>>,
    pub surface: Option<Spanned<String>>,
    pub law: Option<Spanned<Value>>,
    pub gloss: Option<GlossTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GlossTable {
    pub reflectance: Option<Spanned<f64>>,
    pub roughness: Option<Spanned<f64>>,
    pub metallic: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    pub name: Option<String>,
    pub kind: Spanned<String>,
    pub towards: Option<Vector>,
    pub cone_deg: Option<Spanned<[f64; 2]>>,
    pub strength: Option<Spanned<f64>>,
    pub power: Option<Spanned<f64>>,
    pub color: Option<Spanned<Color>>,
    pub spectrum: Option<Spanned<Value>>,
    pub beyond: Option<Spanned<String>>,
    pub time: Option<Spanned<f64>>,
    pub position: Option<Vector>,
    pub velocity: Option<Vector>,
    pub celerity: Option<Vector>,
    pub beta: Option<Spanned<f64>>,
    pub gamma: Option<Spanned<f64>>,
    pub rapidity: Option<Spanned<f64>>,
    pub direction: Option<Vector>,
}

#[derive(Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Color {
    /// Linear sRGB.
    Linear([f32; 3]),
    /// #rrggbb, sRGB as in a browser.
    Hex(String),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AnimationTable {
    pub frames: Option<Spanned<u32>>,
    pub fps: Option<Spanned<f64>>,
    pub time: Option<Spanned<[f64; 2]>>,
    pub apparent: Option<Spanned<String>>,
    pub range: Option<Spanned<[f64; 2]>>,
    #[serde(default)]
    pub key: Vec<KeyTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyTable {
    pub time: Spanned<f64>,
    pub position: Option<Vector>,
    pub look_at: Option<Vector>,
    pub forward: Option<Vector>,
    pub up: Option<Vector>,
    pub fov_deg: Option<Spanned<f64>>,
}
