use super::random::Random;
use super::stage::Target;
use crate::light::SeenShading;
use glam::DVec3;

/// Triangles that shine by themselves, and light others: chosen by chance in proportion to their area and brightness.
pub(super) struct Emitters {
    triangles: Vec<Emitter>,
    /// Shares up to each, the last of them 1.
    shares: Vec<f64>,
    /// By target: the density a unit of area is chosen with, times what [`density`](Self::density) takes from a triangle.
    bright: Vec<Vec<f32>>,
}

struct Emitter {
    target: usize,
    /// Its leaf in the target's tree.
    leaf: u32,
}

/// A point of a triangle that shines.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    pub target: usize,
    pub leaf: u32,
    /// In the target's rest frame.
    pub x_rest: DVec3,
}

/// The most triangles that are told apart.
const MOST: usize = 2_000_000;

impl Emitters {
    pub fn new(targets: &[Target], shading: &SeenShading<'_>) -> Self {
        let (mut triangles, mut shares, mut whole) = (Vec::new(), Vec::new(), 0.0);
        let mut bright: Vec<Vec<f32>> = targets.iter().map(|_| Vec::new()).collect();
        for (index, target) in targets.iter().enumerate() {
            let shines = |leaf: &super::tree::Leaf| {
                let face = leaf.face as usize;
                let surface = shading.surface(target.body, target.mesh.material_index(face));
                let colors = target.mesh.colors(face, [1.0 / 3.0; 3], |_| [1.0; 3]);
                let source = surface.source(colors, 1.0, 1.0)?;
                let brightness = source.color.iter().sum::<f64>() * source.strength;
                (brightness > 0.0).then_some(brightness)
            };
            for (number, leaf) in target.tree.leaves.iter().enumerate() {
                let Some(brightness) = shines(leaf).filter(|_| triangles.len() < MOST) else { continue };
                let [a, b, c] = leaf.corners;
                let area = 0.5 * (b - a).cross(c - a).length();
                if !(area * brightness > 0.0 && area.is_finite()) {
                    continue;
                }
                bright[index].resize(target.tree.leaves.len(), 0.0);
                bright[index][number] = brightness as f32;
                whole += area * brightness;
                triangles.push(Emitter { target: index, leaf: number as u32 });
                shares.push(whole);
            }
        }
        shares.iter_mut().for_each(|share| *share /= whole);
        bright.iter_mut().flatten().for_each(|b| *b = (f64::from(*b) / whole) as f32);
        Self { triangles, shares, bright }
    }

    /// A point chosen by chance; none where nothing shines.
    pub fn choose(&self, targets: &[Target], random: &mut Random) -> Option<Spot> {
        if self.triangles.is_empty() {
            return None;
        }
        let place = random.unit();
        let index = self.shares.partition_point(|share| *share <= place).min(self.triangles.len() - 1);
        let Emitter { target, leaf } = self.triangles[index];
        let [a, b, c] = targets[target].tree.leaves[leaf as usize].corners;
        let (u, v) = (random.unit().sqrt(), random.unit());
        let x_rest = a + (b - a) * (u * (1.0 - v)) + (c - a) * (u * v);
        Some(Spot { target, leaf, x_rest })
    }

    /// The density a point of a triangle is chosen with, by its area at rest; 0 of what does not shine.
    pub fn density(&self, target: usize, leaf: u32) -> f64 {
        self.bright[target].get(leaf as usize).map_or(0.0, |b| f64::from(*b))
    }
}
