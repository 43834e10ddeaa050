use super::cluster::Cluster;
use super::fronts::Fronts;
use crate::scene::Mesh;
use glam::{DVec3, Vec3A};
use obvhs::aabb::Aabb;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::{Boundable, BvhBuildParams};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};
use std::time::Duration;

/// A bounding volume hierarchy of a mesh at rest: whatever moves, it is built once.
///
/// Boxes are single precision, rounded outward, in units in which the mesh is 1 across around its middle, so that no
/// mesh is too large or too small for them; corners of triangles are exact.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    branches: Vec<Branch>,
    /// In the order of the boxes that hold them.
    leaves: Vec<Indexed>,
    /// The corners of these, in the order in which they are met first, so that what is near in space is near in memory.
    vertices: Vec<DVec3>,
    /// Where there are no boxes: leaves are the mesh's triangles in its order, and are made as they are asked for.
    mesh: Option<Arc<Mesh>>,
    /// Of the leaves, where these are listed.
    clusters: Vec<Cluster>,
    /// A branch each, made when they are first asked for.
    fronts: OnceLock<Vec<Fronts>>,
    /// The mesh's middle.
    pub centre: DVec3,
    /// 1 over its greatest side.
    pub scale: f64,
    /// Of a sphere about the middle with everything in it.
    pub radius: f64,
}

/// How many boxes are looked at together.
pub(super) const WIDE: usize = 4;

/// A number of each.
pub(super) type EachBox = [f64; WIDE];

/// Boxes side by side, and what is in them. Those that are not needed are empty, and turned inside out.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Branch {
    pub min: [[f32; WIDE]; 3],
    pub max: [[f32; WIDE]; 3],
    inside: [Inside; WIDE],
}

/// What is in a box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inside {
    /// Number of a branch, or of the first of some triangles.
    first: u32,
    /// How many triangles there are, or [`BRANCH`].
    count: u32,
}

/// No box has as many triangles.
const BRANCH: u32 = u32::MAX;

/// What is in a box that is met, still to be looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Where the box begins.
    pub near: f64,
    pub inside: Inside,
}

/// A box as trees are built of them; its children, which lie side by side, or its triangles.
#[derive(Clone, Copy, Debug)]
struct Node {
    min: [f32; 3],
    max: [f32; 3],
    /// Of the children, or of the triangles.
    first: u32,
    /// How many triangles; 0 where there are children.
    count: u32,
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

/// As it is kept.
#[derive(Clone, Copy, Debug)]
struct Indexed {
    corners: [u32; 3],
    /// Number of the triangle in the mesh, or [`ONE_SIDED`] more.
    face: u32,
}

/// No mesh has as many triangles.
const ONE_SIDED: u32 = 1 << 31;

struct Bounds(Aabb);

impl Boundable for Bounds {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Tree {
    pub fn new(mesh: &Mesh) -> Self {
        let empty = Self::empty(mesh);
        let Self { centre, scale, .. } = empty;
        let bounds: Vec<Bounds> = (0..mesh.triangles.len())
            .map(|t| {
                let corners = mesh.corners(t).map(|c| (c - centre) * scale);
                let low = corners[0].min(corners[1]).min(corners[2]);
                let high = corners[0].max(corners[1]).max(corners[2]);
                if !corners.iter().all(|c| c.abs().max_element() < 1e30 && c.is_finite()) {
                    return Bounds(Aabb::new(Vec3A::ZERO, Vec3A::ZERO));
                }
                // A rounding of the difference, and one more.
                let out = |v: DVec3, way: f64| (v + way * 2e-7 * (v.abs() + 1e-30)).as_vec3a();
                Bounds(Aabb::new(out(low, -1.0) - Vec3A::splat(1e-30), out(high, 1.0) + Vec3A::splat(1e-30)))
            })
            .collect();
        let (nodes, order) = if crowd(&bounds) > CROWD { halved(&bounds) } else { built(&bounds) };
        let mut numbers = vec![u32::MAX; mesh.vertex_count()];
        let mut vertices = Vec::with_capacity(mesh.vertex_count());
        let mut number = |vertex: u32| {
            let number = &mut numbers[vertex as usize];
            if *number == u32::MAX {
                *number = vertices.len() as u32;
                vertices.push(mesh.vertex(vertex));
            }
            *number
        };
        let leaf = |&face: &u32| {
            let side = if mesh.is_one_sided(face as usize) { ONE_SIDED } else { 0 };
            Indexed { corners: mesh.triangles[face as usize].map(&mut number), face: face | side }
        };
        let leaves = order.iter().map(leaf).collect();
        Self { branches: branches(&nodes), leaves, vertices, ..empty }
    }

    /// Without boxes, for who knows where to look.
    pub fn flat(mesh: &Arc<Mesh>) -> Self {
        Self { mesh: Some(mesh.clone()), ..Self::empty(mesh) }
    }

    /// The same to be listed.
    #[must_use]
    pub fn listed(mut self) -> Self {
        self.clusters = Cluster::of(&self);
        self
    }

    /// What is known of some leaves at a time, where these are [`listed`](Self::listed).
    pub fn clusters(&self) -> &[Cluster] {
        &self.clusters
    }

    /// How many leaves there are.
    pub fn count(&self) -> usize {
        self.mesh.as_ref().map_or(self.leaves.len(), |mesh| mesh.triangles.len())
    }

    /// A leaf.
    #[inline(always)]
    pub fn leaf(&self, number: u32) -> Leaf {
        match &self.mesh {
            None => {
                let Indexed { corners: [a, b, c], face } = self.leaves[number as usize];
                let corner = |i: u32| self.vertices[i as usize];
                Leaf {
                    corners: [corner(a), corner(b), corner(c)],
                    face: face & !ONE_SIDED,
                    one_sided: face >= ONE_SIDED,
                }
            }
            Some(mesh) => Leaf {
                corners: mesh.corners(number as usize),
                face: number,
                one_sided: mesh.is_one_sided(number as usize),
            },
        }
    }

    /// The number of a leaf's triangle in the mesh.
    #[inline]
    pub fn face(&self, number: u32) -> usize {
        match &self.mesh {
            None => (self.leaves[number as usize].face & !ONE_SIDED) as usize,
            Some(_) => number as usize,
        }
    }

    /// All of them.
    pub fn leaves(&self) -> impl Iterator<Item = Leaf> {
        (0..self.count() as u32).map(|number| self.leaf(number))
    }

    fn empty(mesh: &Mesh) -> Self {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let centre = 0.5 * (low + high);
        let size = (high - low).max_element();
        // Of what a clip has made of it, no number may be left; none of that is ever hit.
        let (centre, size) = if size.is_finite() { (centre, size) } else { (DVec3::ZERO, 0.0) };
        let scale = if size > 0.0 { 1.0 / size } else { 1.0 };
        let vertices = (0..mesh.vertex_count() as u32).into_par_iter().with_min_len(1 << 12);
        let radius = vertices.map(|v| mesh.vertex(v).distance(centre)).reduce(|| 0.0, f64::max);
        let (branches, leaves, vertices, clusters, fronts) = Default::default();
        Self { branches, leaves, vertices, mesh: None, clusters, fronts, centre, scale, radius }
    }

    pub fn branches(&self) -> &[Branch] {
        &self.branches
    }

    /// Which way the triangles of every branch face; none if they are not closed.
    pub fn fronts(&self) -> &[Fronts] {
        self.fronts.get_or_init(|| Fronts::of(self))
    }

    /// Whether what lies between two corners, in the tree's units, is outside of the box around all.
    pub fn is_outside(&self, low: [f32; 3], high: [f32; 3]) -> bool {
        let Some(Branch { min, max, .. }) = self.branches.first() else { return true };
        (0..3).any(|k| min[k].iter().all(|min| high[k] < *min) || max[k].iter().all(|max| low[k] > *max))
    }

    /// All of it, if there is anything.
    pub fn root(&self) -> Option<Inside> {
        (!self.branches.is_empty()).then_some(Inside { first: 0, count: BRANCH })
    }

    /// What is in a box: other boxes, or triangles.
    #[inline(always)]
    pub fn look(&self, inside: Inside) -> Result<&Branch, std::ops::Range<u32>> {
        let Inside { first, count } = inside;
        if count == BRANCH { Ok(&self.branches[first as usize]) } else { Err(first..first + count) }
    }

    /// Puts what is in those boxes of a branch that are met onto a stack, the nearest on top.
    #[inline(always)]
    pub fn push(&self, branch: &Branch, near: &EachBox, met: [bool; WIDE], stack: &mut Vec<Part>) {
        let bottom = stack.len();
        for i in 0..WIDE {
            if !met[i] {
                continue;
            }
            let part = Part { near: near[i], inside: branch.inside[i] };
            self.fetch(part.inside);
            let mut place = stack.len();
            stack.push(part);
            while place > bottom && stack[place - 1].near < part.near {
                stack[place] = stack[place - 1];
                place -= 1;
            }
            stack[place] = part;
        }
    }

    /// Asks for what is in a box, which will be needed soon.
    #[inline(always)]
    pub fn fetch(&self, inside: Inside) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            let first = inside.first as usize;
            let ask = |address: *const i8| {
                // SAFETY: any processor has it, and any address will do.
                unsafe { _mm_prefetch::<_MM_HINT_T0>(address) }
            };
            if inside.count == BRANCH {
                let branch: *const i8 = self.branches.as_ptr().wrapping_add(first).cast();
                ask(branch);
                ask(branch.wrapping_add(64));
            } else {
                ask(self.leaves.as_ptr().wrapping_add(first).cast());
            }
        }
    }
}

impl Inside {
    /// Of the branch, or of the first triangle.
    #[inline(always)]
    pub fn number(self) -> usize {
        self.first as usize
    }
}

impl Branch {
    const EMPTY: Self = Self {
        min: [[f32::INFINITY; WIDE]; 3],
        max: [[f32::NEG_INFINITY; WIDE]; 3],
        inside: [Inside { first: 0, count: 0 }; WIDE],
    };

    /// What is in one of the boxes.
    #[inline(always)]
    pub fn inside(&self, i: usize) -> Inside {
        self.inside[i]
    }
}

impl Node {
    fn area(&self) -> f32 {
        let [x, y, z] = std::array::from_fn(|k| self.max[k] - self.min[k]);
        x * y + y * z + z * x
    }
}

/// The tree of nodes, with as many boxes at a time as are looked at together: the largest are replaced by what is in them.
fn branches(nodes: &[Node]) -> Vec<Branch> {
    let mut branches = Vec::new();
    if nodes.is_empty() {
        return branches;
    }
    branches.push(Branch::EMPTY);
    // Branches to be filled, and from which node.
    let mut stack = vec![(0, 0)];
    while let Some((number, node)) = stack.pop() {
        let (mut boxes, mut count) = ([node; WIDE], 1);
        while count < WIDE {
            let opened = (0..count).filter(|i| nodes[boxes[*i]].count == 0);
            let area = |i: &usize| nodes[boxes[*i]].area();
            let Some(largest) = opened.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
            let first = nodes[boxes[largest]].first as usize;
            (boxes[largest], boxes[count]) = (first, first + 1);
            count += 1;
        }
        for (i, node) in boxes[..count].iter().enumerate() {
            let Node { min, max, first, count } = nodes[*node];
            let inside = if count > 0 {
                Inside { first, count }
            } else {
                let below = branches.len();
                branches.push(Branch::EMPTY);
                stack.push((below, *node));
                Inside { first: below as u32, count: BRANCH }
            };
            let branch: &mut Branch = &mut branches[number];
            for k in 0..3 {
                (branch.min[k][i], branch.max[k][i]) = (min[k], max[k]);
            }
            branch.inside[i] = inside;
        }
    }
    branches
}

/// More boxes with their middles in one place than a tree for good meshes is built of: it would become a chain.
const CROWD: usize = 256;

/// The most boxes with their middles in one place, to a two-millionth of the mesh.
fn crowd(bounds: &[Bounds]) -> usize {
    let place = |b: &Bounds| {
        let steps = (b.0.min + b.0.max + Vec3A::ONE) * (0.5 * (1 << 21) as f32);
        let [x, y, z] = steps.to_array().map(|c| c as u64);
        x << 42 | y << 21 | z
    };
    let mut places: Vec<u64> = bounds.par_iter().with_min_len(1 << 12).map(place).collect();
    places.par_sort_unstable();
    places.chunk_by(|a, b| a == b).map(<[u64]>::len).max().unwrap_or(0)
}

/// Nodes, and the boxes in the order they are kept in.
fn built(bounds: &[Bounds]) -> (Vec<Node>, Vec<u32>) {
    let params =
        if bounds.len() > 200_000 { BvhBuildParams::fast_build() } else { BvhBuildParams::medium_build() };
    // A box costs half of what a triangle does.
    let params = BvhBuildParams { max_prims_per_leaf: 4, collapse_traversal_cost: 0.5, ..params };
    let tree = build_bvh2(bounds, params, &mut Duration::default());
    let node = |n: &obvhs::bvh2::node::Bvh2Node| Node {
        min: n.aabb().min.to_array(),
        first: n.first_index,
        max: n.aabb().max.to_array(),
        count: n.prim_count,
    };
    (tree.nodes.iter().map(node).collect(), tree.primitive_indices)
}

/// The same, for any boxes: halves by number, along the longest side of where their middles are, so that it is never deep.
fn halved(bounds: &[Bounds]) -> (Vec<Node>, Vec<u32>) {
    const LEAVES: usize = 4;
    let mut order: Vec<u32> = (0..bounds.len() as u32).collect();
    let hole = Node { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 };
    let mut nodes = vec![hole];
    let mut stack = vec![(0, 0..bounds.len())];
    while let Some((index, range)) = stack.pop() {
        let of = |i: &u32| bounds[*i as usize].0;
        let nowhere = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);
        let around = |(low, high): (Vec3A, Vec3A), min: Vec3A, max: Vec3A| (low.min(min), high.max(max));
        let part = &mut order[range.clone()];
        let (min, max) = part.iter().map(of).fold(nowhere, |all, b| around(all, b.min, b.max));
        let (min, max) = (min.to_array(), max.to_array());
        if part.len() <= LEAVES {
            nodes[index] = Node { min, first: range.start as u32, max, count: part.len() as u32 };
            continue;
        }
        let middle = |i: &u32| of(i).min + of(i).max;
        let (low, high) = part.iter().map(middle).fold(nowhere, |all, m| around(all, m, m));
        let sides = (high - low).to_array();
        let longest = (0..3).fold(0, |a, b| if sides[b] > sides[a] { b } else { a });
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| middle(a)[longest].total_cmp(&middle(b)[longest]));
        let first = nodes.len();
        nodes[index] = Node { min, first: first as u32, max, count: 0 };
        nodes.extend([hole; 2]);
        let half = range.start + half;
        stack.extend([(first, range.start..half), (first + 1, half..range.end)]);
    }
    (nodes, order)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Paint, shapes};

    /// Every triangle is in a leaf, and in all boxes around it.
    #[test]
    fn boxes_hold_what_is_in_them() {
        // Hundreds of triangles in each place.
        let triangles = shapes::cube().triangles.iter().flat_map(|t| [*t; 300]).collect();
        let crowded = Mesh { triangles, paint: Paint::Uniform([1.0; 3]), ..shapes::cube() };
        for mesh in [shapes::cube(), shapes::gate(), shapes::sphere(4), crowded] {
            for factor in [1.0, 1e-40, 1e40] {
                let mesh = mesh.clone().placed(&glam::DAffine3::from_scale(DVec3::splat(factor)));
                let tree = Tree::new(&mesh);
                let mut found = vec![0; mesh.triangles.len()];
                let mut stack = vec![(tree.root().unwrap(), vec![])];
                while let Some((inside, around)) = stack.pop() {
                    let leaves = match tree.look(inside) {
                        Ok(branch) => {
                            for i in 0..WIDE {
                                let [min, max] =
                                    [&branch.min, &branch.max].map(|c| c.map(|c| f64::from(c[i])));
                                let mut around = around.clone();
                                around.push((min, max));
                                stack.push((branch.inside(i), around));
                            }
                            continue;
                        }
                        Err(leaves) => leaves,
                    };
                    for leaf in leaves.map(|number| tree.leaf(number)) {
                        found[leaf.face as usize] += 1;
                        for corner in mesh.corners(leaf.face as usize) {
                            let at = (corner - tree.centre) * tree.scale;
                            for (min, max) in &around {
                                assert!((0..3).all(|i| min[i] <= at[i] && at[i] <= max[i]));
                            }
                        }
                    }
                }
                assert!(found.iter().all(|n| *n == 1), "{factor}");
            }
        }
    }
}
