//! What shaders read and write, word for word.

use bytemuck::{Pod, Zeroable};

/// One sample of every pixel of a part of the picture.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct PassRecord {
    pub corner: [u32; 2],
    pub part: [u32; 2],
    pub middle: [f32; 2],
    pub inverse_focal: [f32; 2],
    pub sample: [f32; 2],
    pub projection: u32,
    pub coloring: u32,
    pub weight: f32,
    pub unit: f32,
    pub is_first: u32,
    pub exposure: f32,
    pub tone: u32,
    pub unused: u32,
}

/// A body's sky.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct SkyRecord {
    pub first: [f32; 3],
    pub k: f32,
    pub second: [f32; 3],
    pub inverse_k: f32,
    pub axis: [f32; 3],
    pub from_pole: u32,
    pub pixel: [f32; 2],
    pub beside: [f32; 2],
    pub place: [f32; 4],
}

/// A triangle, or a piece of one, as lines of sight meet it.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct ShapeRecord {
    pub edges: [[f32; 4]; 3],
    pub edges_constant: [f32; 3],
    pub owns_and_body: u32,
    pub plane: [f32; 4],
    pub plane_constant: f32,
    pub least: f32,
    pub greatest: f32,
    pub face: u32,
}

/// A triangle of a mesh, as it looks.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct FaceRecord {
    pub weights: [f32; 3],
    pub plane: f32,
    pub number: u32,
    pub material: u32,
    pub word: u32,
    pub shape: u32,
}

/// What a surface shines with.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct MaterialRecord {
    pub red: [f32; 3],
    pub strength: f32,
    pub green: [f32; 3],
    pub law: u32,
    pub blue: [f32; 3],
    pub paint: u32,
    pub law_numbers: [f32; 2],
    pub start: f32,
    pub inverse_step: f32,
    pub node: u32,
    pub count: u32,
    pub unused: [u32; 2],
}

/// A pixel of the film.
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
#[repr(C)]
pub(super) struct PixelRecord {
    pub color: [f32; 3],
    pub distance: f32,
    pub doppler: f32,
    pub body: i32,
    pub face: i32,
    pub unused: u32,
}
