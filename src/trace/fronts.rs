use super::random::mix;
use super::tree::{Tree, WIDE};
use glam::DVec3;

/// Which way the fronts of all triangles in the boxes of a branch face: cones of directions, side by side.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fronts {
    /// Zero where they face too many ways.
    axes: [[f32; WIDE]; 3],
    /// Of the greatest angle to the axis.
    cosines: [f32; WIDE],
    sines: [f32; WIDE],
}

/// Directions by their axis and the greatest angle to it.
#[derive(Clone, Copy, Debug)]
struct Cone {
    axis: DVec3,
    angle: f64,
}

/// Cosines nearer to each other are not told apart: f32 leaves some 10⁻⁷ over.
const ROUNDING: f32 = 1e-5;

impl Fronts {
    const EMPTY: Self = Self { axes: [[0.0; WIDE]; 3], cosines: [0.0; WIDE], sines: [1.0; WIDE] };

    /// Of every branch of a tree, if its triangles [are closed](are_closed); else none.
    pub fn of(tree: &Tree) -> Vec<Self> {
        if !are_closed(tree) {
            return Vec::new();
        }
        let mut cones = vec![[None; WIDE]; tree.branches().len()];
        // What is in a branch comes after it.
        for (number, branch) in tree.branches().iter().enumerate().rev() {
            cones[number] = std::array::from_fn(|i| match tree.look(branch.inside(i)) {
                Ok(_) => Cone::around(cones[branch.inside(i).number()].iter().flatten().copied()),
                Err(leaves) => Cone::around(leaves.filter_map(|number| {
                    let [a, b, c] =
                        tree.leaf(number).corners.map(|corner| (corner - tree.centre) * tree.scale);
                    // What has no area is not hit.
                    let axis = (b - a).cross(c - a).try_normalize()?;
                    Some(Cone { axis, angle: 0.0 })
                })),
            });
        }
        cones.iter().map(Self::new).collect()
    }

    fn new(cones: &[Option<Cone>; WIDE]) -> Self {
        let mut fronts = Self::EMPTY;
        for (i, cone) in cones.iter().enumerate() {
            let Some(Cone { axis, angle }) = cone.filter(|cone| cone.angle < 1.5) else { continue };
            for (to, component) in fronts.axes.iter_mut().zip(axis.to_array()) {
                to[i] = component as f32;
            }
            (fronts.sines[i], fronts.cosines[i]) = (angle.sin() as f32, angle.cos() as f32);
        }
        fronts
    }

    /// In which boxes all triangles show their backs to whoever looks along directions up to an angle, less than a right one,
    /// from an axis of length 1.
    #[inline(always)]
    pub fn are_behind(&self, axis: [f32; 3], cosine: f32, sine: f32) -> [bool; WIDE] {
        let [x, y, z] = &self.axes;
        std::array::from_fn(|i| {
            // Of both angles together, which are to be less than a right one.
            let both = [
                self.cosines[i] * cosine - self.sines[i] * sine,
                self.sines[i] * cosine + self.cosines[i] * sine,
            ];
            let along = x[i] * axis[0] + y[i] * axis[1] + z[i] * axis[2];
            (both[0] > 0.0) & (along > both[1] + ROUNDING)
        })
    }
}

impl Cone {
    fn around(cones: impl Iterator<Item = Self> + Clone) -> Option<Self> {
        let axis = cones.clone().map(|cone| cone.axis).sum::<DVec3>().normalize_or_zero();
        let angle = |cone: Self| cone.angle + cone.axis.dot(axis).clamp(-1.0, 1.0).acos();
        cones.map(angle).reduce(f64::max).map(|angle| Self { axis, angle })
    }
}

/// Corners are one if they are nearer to each other than about one over this, of the mesh's size: as near as rays begin to
/// the surface that they come from.
const STEPS: f64 = (1u64 << 36) as f64;

/// Whether the triangles have no rim, because along each side of each of them another has one the other way: so that they are
/// all the surface of something solid, or of several such, which may overlap. Sides are added up, each as a random number
/// of its own or, the other way, as one less than nothing: that is nothing for other reasons once in 2⁶⁴ times.
fn are_closed(tree: &Tree) -> bool {
    let mut sum = 0u64;
    for leaf in (0..tree.count() as u32).map(|number| tree.leaf(number)) {
        // No corner of those that people make lies between two steps exactly.
        let places = leaf.corners.map(|c| ((c - tree.centre) * tree.scale + 0.123_456_789) * STEPS);
        if !places.iter().all(|place| place.is_finite() && place.abs().max_element() < 1e18) {
            return false;
        }
        let corners = places.map(|place| {
            place.to_array().into_iter().fold(0, |mixed, p| mix(p.floor() as i64 as u64 ^ mixed))
        });
        for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(i, k)| (corners[i], corners[k])) {
            match from.cmp(&to) {
                std::cmp::Ordering::Less => sum = sum.wrapping_add(mix(from ^ mix(to))),
                std::cmp::Ordering::Equal => {}
                std::cmp::Ordering::Greater => sum = sum.wrapping_sub(mix(to ^ mix(from))),
            }
        }
    }
    sum == 0
}

#[cfg(test)]
mod tests {
    use super::super::beam::tests::random;
    use super::*;
    use crate::scene::{Mesh, shapes};
    use glam::{DAffine3, DQuat};

    fn is_closed(mesh: &Mesh) -> bool {
        are_closed(&Tree::new(mesh))
    }

    #[test]
    fn what_has_a_rim_is_not_closed() {
        for mesh in [shapes::cube(), shapes::sphere(3)] {
            for scale in [1.0, 1e-20, 1e20] {
                let turn = DQuat::from_rotation_x(0.4) * DQuat::from_rotation_z(1.0);
                let place = DAffine3::from_scale_rotation_translation(
                    DVec3::new(scale, 0.3 * scale, -scale),
                    turn,
                    DVec3::splat(3.0 * scale),
                );
                let mesh = mesh.clone().placed(&place);
                assert!(is_closed(&mesh));
                let mut two = mesh.clone();
                two.append(mesh.clone().placed(&DAffine3::from_translation(DVec3::splat(0.2 * scale))));
                assert!(is_closed(&two));
                // With corners of its own for every triangle, a rounding beside each other.
                let number = mesh.triangles.len() as u32;
                let mut corners: Vec<DVec3> = (0..number as usize).flat_map(|t| mesh.corners(t)).collect();
                corners[4] *= 1.0 + f64::EPSILON;
                let each = |corners: &[DVec3]| {
                    Mesh::new(corners, (0..number).map(|t| [0, 1, 2].map(|k| 3 * t + k)).collect())
                };
                assert!(is_closed(&each(&corners)));
                corners[4].x += 1e-6 * scale;
                assert!(!is_closed(&each(&corners)));
                let mut open = mesh.clone();
                open.triangles.pop();
                assert!(!is_closed(&open));
                let mut turned = mesh.clone();
                turned.triangles[1].swap(0, 2);
                assert!(!is_closed(&turned));
            }
        }
        let mut broken = shapes::cube();
        broken.x[3] = f64::NAN;
        assert!(!is_closed(&broken));
        assert!(!is_closed(&shapes::plate()) && !is_closed(&shapes::gate()));
    }

    /// What is said to be behind is, from every direction of any cone, and much of what is behind is said to be.
    #[test]
    fn backs_are_told() {
        let mut random = random(9);
        let mesh = shapes::sphere(4).placed(&DAffine3::from_scale(DVec3::new(1.0, 0.2, 2.0)));
        let tree = Tree::new(&mesh);
        let [mut said, mut are] = [0, 0];
        for round in 0..300 {
            let mut point = || DVec3::from_array([0; 3].map(|_| random() - 0.5));
            let axis = point().normalize();
            let angle = [1e-3, 0.3, 1.0][round % 3];
            let directions: Vec<DVec3> = (0..20)
                .map(|_| {
                    let around = axis.cross(point()).normalize();
                    DQuat::from_axis_angle(around, angle) * axis
                })
                .collect();
            let [cosine, sine] = [angle.cos(), angle.sin()].map(|v| v as f32);
            for (branch, fronts) in tree.branches().iter().zip(tree.fronts()) {
                let behind = fronts.are_behind(axis.as_vec3().to_array(), cosine, sine);
                for (i, behind) in behind.into_iter().enumerate() {
                    let Err(leaves) = tree.look(branch.inside(i)) else { continue };
                    let is_behind = |number: u32| {
                        let [a, b, c] = tree.leaf(number).corners;
                        directions.iter().all(|d| (b - a).cross(c - a).dot(*d) > 0.0)
                    };
                    let all = !leaves.is_empty() && leaves.clone().all(is_behind);
                    assert!(all || !behind);
                    (said, are) = (said + u32::from(behind), are + u32::from(all));
                }
            }
        }
        assert!(said > are / 2 && are > 1000, "{said} {are}");
    }
}
