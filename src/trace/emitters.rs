use super::random::Random;
use super::stage::{Stage, Target};
use crate::light::SeenShading;
use glam::DVec3;
use terrell_geodesic::{FourVector, Rest};

/// Triangles that shine by themselves, and light others: chosen by chance in proportion to their area and brightness.
pub(super) struct Emitters {
    triangles: Vec<Emitter>,
    /// Shares up to each, the last of them 1.
    sums: Vec<f64>,
    /// By target and leaf: the density a unit of area is chosen with.
    bright: Vec<Vec<f64>>,
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
        let (mut triangles, mut sums, mut whole) = (Vec::new(), Vec::new(), 0.0);
        let mut bright: Vec<Vec<f64>> = targets.iter().map(|_| Vec::new()).collect();
        for (index, target) in targets.iter().enumerate() {
            let shines = |leaf: &super::tree::Leaf| {
                let face = leaf.face as usize;
                let surface = shading.surface(target.body, target.mesh.material_index(face));
                let colors = target.mesh.colors(face, [1.0 / 3.0; 3], |_| [1.0; 3]);
                let source = surface.source(colors, 1.0, 1.0)?;
                let brightness = source.color.iter().sum::<f64>() * source.strength;
                (brightness > 0.0).then_some(brightness)
            };
            for (number, leaf) in target.tree.leaves().enumerate() {
                let Some(brightness) = shines(&leaf).filter(|_| triangles.len() < MOST) else { continue };
                let [a, b, c] = leaf.corners;
                let area = 0.5 * (b - a).cross(c - a).length();
                if !(area * brightness > 0.0 && area.is_finite()) {
                    continue;
                }
                bright[index].resize(target.tree.count(), 0.0);
                bright[index][number] = brightness;
                whole += area * brightness;
                triangles.push(Emitter { target: index, leaf: number as u32 });
                sums.push(whole);
            }
        }
        sums.iter_mut().for_each(|sum| *sum /= whole);
        bright.iter_mut().flatten().for_each(|b| *b /= whole);
        Self { triangles, sums, bright }
    }

    /// What a point of a target sees of them: shares to choose by. `event` is that of the point, from the observer's, in the
    /// target's rest frame.
    pub fn seen_from(&self, stage: &Stage, target: usize, event: FourVector<Rest>, shares: &mut Shares) {
        shares.sums.clear();
        if self.triangles.len() > FEW {
            return;
        }
        let mut whole = 0.0;
        for &Emitter { target: of, leaf } in &self.triangles {
            let place = (stage.between(of, target) * event).xyz();
            let shining = &stage.targets[of];
            let [a, b, c] = shining.tree.leaf(leaf).corners;
            let way = shining.map.offset_rest((a + b + c) / 3.0) - place;
            // From behind, a side of a closed body is hidden; from the front it counts by its angle.
            let facing = -(b - a).cross(c - a).dot(way);
            let counts = if facing > 0.0 { facing } else { -HIDDEN * facing };
            whole += self.bright[of][leaf as usize] * counts / way.length().powi(3);
            shares.sums.push(whole);
        }
        if whole > 0.0 && whole.is_finite() {
            shares.sums.iter_mut().for_each(|sum| *sum /= whole);
        } else {
            shares.sums.clear();
        }
    }

    /// A point chosen by chance; none where nothing shines.
    pub fn choose(&self, targets: &[Target], shares: &Shares, random: &mut Random) -> Option<Spot> {
        if self.triangles.is_empty() {
            return None;
        }
        let sums = if shares.sums.is_empty() { &self.sums } else { &shares.sums };
        let place = random.unit();
        let index = sums.partition_point(|sum| *sum <= place).min(self.triangles.len() - 1);
        let Emitter { target, leaf } = self.triangles[index];
        let [a, b, c] = targets[target].tree.leaf(leaf).corners;
        let (u, v) = (random.unit().sqrt(), random.unit());
        let x_rest = a + (b - a) * (u * (1.0 - v)) + (c - a) * (u * v);
        Some(Spot { target, leaf, x_rest })
    }

    /// The density a point of a triangle is chosen with, by its area at rest; 0 of what does not shine.
    pub fn density(&self, targets: &[Target], shares: &Shares, target: usize, leaf: u32) -> f64 {
        let bright = self.bright[target].get(leaf as usize).copied().unwrap_or(0.0);
        if bright == 0.0 || shares.sums.is_empty() {
            return bright;
        }
        let index = self.triangles.iter().position(|t| t.target == target && t.leaf == leaf);
        let share = index.map_or(0.0, |i| shares.sums[i] - if i > 0 { shares.sums[i - 1] } else { 0.0 });
        let [a, b, c] = targets[target].tree.leaf(leaf).corners;
        2.0 * share / (b - a).cross(c - a).length()
    }
}

/// Up to how many triangles each is weighed by how it is seen.
const FEW: usize = 48;

/// How much a triangle seen from behind counts.
const HIDDEN: f64 = 0.05;

/// Shares up to each triangle, the last of them 1; none where they are those of the whole.
#[derive(Default)]
pub(super) struct Shares {
    sums: Vec<f64>,
}
