use crate::scene::Mesh;
use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};
use std::time::Duration;

/// A bounding volume hierarchy of a mesh at rest: whatever moves, it is built once.
///
/// Boxes are single precision, rounded outward, in units in which the mesh is 1 across around its middle, so that no
/// mesh is too large or too small for them; corners of triangles are exact.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub nodes: Vec<Node>,
    pub leaves: Vec<Leaf>,
    /// The mesh's middle.
    pub centre: DVec3,
    /// 1 over its greatest side.
    pub scale: f64,
    /// Of a sphere about the middle with everything in it.
    pub radius: f64,
}

/// A box; its children, which lie side by side, or its triangles.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Node {
    pub min: [f32; 3],
    /// Of the children, or of the triangles.
    pub first: u32,
    pub max: [f32; 3],
    /// How many triangles; 0 where there are children.
    pub count: u32,
}

/// A triangle, where it is looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    pub corners: [DVec3; 3],
    /// Number of the triangle in the mesh.
    pub face: u32,
    /// Whether only its front is seen.
    pub one_sided: bool,
}

struct Bounds(Aabb);

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Tree {
    pub fn new(mesh: &Mesh) -> Self {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let centre = 0.5 * (low + high);
        let size = (high - low).max_element();
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        let bounds: Vec<Bounds> = (0..mesh.triangles.len())
            .map(|t| {
                let corners = mesh.corners(t).map(|c| (c - centre) * scale);
                let low = corners[0].min(corners[1]).min(corners[2]);
                let high = corners[0].max(corners[1]).max(corners[2]);
                // A rounding of the difference, and one more.
                let out = |v: DVec3, way: f64| (v + way * 2e-7 * (v.abs() + 1e-30)).as_vec3a();
                Bounds(Aabb::new(out(low, -1.0) - Vec3A::splat(1e-30), out(high, 1.0) + Vec3A::splat(1e-30)))
            })
            .collect();
        let params = if bounds.len() > 200_000 {
            BvhBuildParams::fast_build()
        } else {
            BvhBuildParams::medium_build()
        };
        let tree = build_bvh2(&bounds, params, &mut Duration::default());
        let nodes = tree
            .nodes
            .iter()
            .map(|n| Node {
                min: n.aabb().min.to_array(),
                first: n.first_index,
                max: n.aabb().max.to_array(),
                count: n.prim_count,
            })
            .collect();
        let leaves = tree
            .primitive_indices
            .iter()
            .map(|&face| Leaf {
                corners: mesh.corners(face as usize),
                face,
                one_sided: mesh.is_one_sided(face as usize),
            })
            .collect();
        let farthest = (0..mesh.vertex_count()).map(|v| mesh.vertex(v as u32).distance(centre));
        Self { nodes, leaves, centre, scale, radius: farthest.fold(0.0, f64::max) }
    }
}

impl Tree {
    /// Asks for what is below a node, which will be needed soon.
    #[inline(always)]
    pub fn fetch(&self, node: &Node) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            let first = node.first as usize;
            let ask = |address: *const i8| {
                // SAFETY: any processor has it, and any address will do.
                unsafe { _mm_prefetch::<_MM_HINT_T0>(address) }
            };
            if node.count == 0 {
                ask(self.nodes.as_ptr().wrapping_add(first).cast());
            } else {
                let leaf = self.leaves.as_ptr().wrapping_add(first).cast::<i8>();
                ask(leaf);
                ask(leaf.wrapping_add(64));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shapes;

    /// Every triangle is in a leaf, and in all boxes around it.
    #[test]
    fn boxes_hold_what_is_in_them() {
        for mesh in [shapes::cube(), shapes::gate(), shapes::sphere(4)] {
            for factor in [1.0, 1e-40, 1e40] {
                let mesh = mesh.clone().placed(&glam::DAffine3::from_scale(DVec3::splat(factor)));
                let tree = Tree::new(&mesh);
                let mut found = vec![0; mesh.triangles.len()];
                let mut stack = vec![(0usize, vec![])];
                while let Some((index, mut around)) = stack.pop() {
                    let node = tree.nodes[index];
                    around.push(node);
                    if node.count == 0 {
                        stack.push((node.first as usize, around.clone()));
                        stack.push((node.first as usize + 1, around));
                        continue;
                    }
                    for leaf in &tree.leaves[node.first as usize..][..node.count as usize] {
                        found[leaf.face as usize] += 1;
                        for corner in mesh.corners(leaf.face as usize) {
                            let at = (corner - tree.centre) * tree.scale;
                            for node in &around {
                                assert!((0..3).all(|i| {
                                    f64::from(node.min[i]) <= at[i] && at[i] <= f64::from(node.max[i])
                                }));
                            }
                        }
                    }
                }
                assert!(found.iter().all(|n| *n == 1), "{factor}");
            }
        }
    }
}
