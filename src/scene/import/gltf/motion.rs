use super::super::note_once;
use super::buffers::Buffers;
use crate::scene::room::Room;
use crate::scene::{Between, Joint, Track};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::animation::Interpolation;
use gltf::animation::util::ReadOutputs;
use std::collections::HashMap;

/// How nodes move by themselves: the channels of the file's first animation.
#[derive(Default)]
pub(super) struct Animated(HashMap<usize, Channels>);

#[derive(Default)]
struct Channels {
    translation: Option<Track<DVec3>>,
    rotation: Option<Track<DQuat>>,
    scale: Option<Track<DVec3>>,
}

impl Animated {
    pub fn read(
        file: &gltf::Gltf,
        buffers: &Buffers,
        room: &mut Room,
        notes: &mut Vec<String>,
    ) -> Result<Self, String> {
        let mut out = Self::default();
        let mut animations = file.animations();
        let Some(animation) = animations.next() else { return Ok(out) };
        if animations.next().is_some() {
            let name = animation.name().unwrap_or("0");
            note_once(notes, &format!("of several animations only the first, '{name}', is shown"));
        }
        for channel in animation.channels() {
            use gltf::animation::Property;
            let (sampler, node) = (channel.sampler(), channel.target().node().index());
            let allowed = match channel.target().property() {
                Property::Translation | Property::Scale => &VECTOR[..],
                Property::Rotation => &ROTATION[..],
                Property::MorphTargetWeights => {
                    note_once(notes, "morph targets are not animated");
                    continue;
                }
            };
            buffers.check(&sampler.input(), "times", &[(Dimensions::Scalar, DataType::F32)])?;
            buffers.check(&sampler.output(), "values", allowed)?;
            // Channels may share what they read, but each keeps it by itself.
            room.take(sampler.input().count().max(sampler.output().count()))?;
            let between = match sampler.interpolation() {
                Interpolation::Step => Between::Step,
                Interpolation::Linear => Between::Linear,
                Interpolation::CubicSpline => Between::Cubic,
            };
            let reader = channel.reader(|buffer| buffers.get(&buffer));
            let times: Vec<f64> = reader.read_inputs().into_iter().flatten().map(f64::from).collect();
            let fault = || format!("animation {}: a channel of node {node} is malformed", animation.index());
            let vectors = |values: &mut dyn Iterator<Item = [f32; 3]>| {
                let values = values.map(|v| DVec3::from_array(v.map(f64::from))).collect();
                Track::new(times.clone(), values, between).ok_or_else(fault)
            };
            let own = out.0.entry(node).or_default();
            match reader.read_outputs() {
                Some(ReadOutputs::Translations(mut values)) => own.translation = Some(vectors(&mut values)?),
                Some(ReadOutputs::Scales(mut values)) => own.scale = Some(vectors(&mut values)?),
                Some(ReadOutputs::Rotations(values)) => {
                    // Slopes of cubics are no rotations, and are not of length 1.
                    let turn = |(i, q): (usize, [f32; 4])| {
                        let q = DQuat::from_array(q.map(f64::from));
                        let is_slope = between == Between::Cubic && i % 3 != 1;
                        if is_slope || q.length_squared() == 0.0 { q } else { q.normalize() }
                    };
                    let values = values.into_f32().enumerate().map(turn).collect();
                    own.rotation = Some(Track::new(times, values, between).ok_or_else(fault)?);
                }
                _ => return Err(fault()),
            }
        }
        Ok(out)
    }

    /// The placement of a node that is animated.
    pub fn joint(&self, node: &gltf::Node<'_>) -> Option<Joint> {
        let own = self.0.get(&node.index())?;
        let (scale, rotation, translation) = placement(node).to_scale_rotation_translation();
        Some(Joint::Moving {
            translation: own.translation.clone().unwrap_or(Track::fixed(translation)),
            rotation: own.rotation.clone().unwrap_or(Track::fixed(rotation)),
            scale: own.scale.clone().unwrap_or(Track::fixed(scale)),
        })
    }
}

/// Where a node is within its parent when it is not animated.
pub(super) fn placement(node: &gltf::Node<'_>) -> DAffine3 {
    let columns = node.transform().matrix().map(|column| column.map(f64::from));
    DAffine3::from_mat4(DMat4::from_cols_array_2d(&columns))
}

const VECTOR: [(Dimensions, DataType); 1] = [(Dimensions::Vec3, DataType::F32)];
const ROTATION: [(Dimensions, DataType); 5] = [
    (Dimensions::Vec4, DataType::F32),
    (Dimensions::Vec4, DataType::I8),
    (Dimensions::Vec4, DataType::U8),
    (Dimensions::Vec4, DataType::I16),
    (Dimensions::Vec4, DataType::U16),
];
