use crate::light::owns_boundary;
use glam::DVec3;

/// How many triangles are made ready together, side by side in vectors.
pub(super) const TOGETHER: usize = 4;

/// A number of each.
pub(super) type Each = [f64; TOGETHER];

/// The same, as rays are tested.
pub(super) type EachNarrow = [f32; TOGETHER];

/// Triangles as a beam meets them, side by side: functions c + a·u + b·v of slopes from the middle.
pub(super) struct Several {
    /// Whether a ray of the beam can hit it.
    pub is_met: [bool; TOGETHER],
    /// Of each edge, positive inside.
    pub functions: [[EachNarrow; 3]; 3],
    /// Where an edge itself belongs to the triangle 0, else the least number above.
    pub least: [EachNarrow; 3],
    /// 1/t.
    pub nearness: [EachNarrow; 3],
}

/// Where a beam looks.
pub(super) struct Window {
    /// Of the longest component, with which corners in the beam's order keep or change their winding.
    pub sign: f64,
    /// Slopes of the middle.
    pub middle: [f64; 2],
    /// From there to the ends.
    pub half: [f64; 2],
}

impl Several {
    /// Of corners in the beam's order. None is met that is seen edge-on or from the back it does not have.
    #[inline(always)]
    pub fn new(corners: &[[Each; 3]; 3], one_sided: [bool; TOGETHER], window: &Window) -> Self {
        let Window { sign, middle: [u0, v0], half: [half_u, half_v] } = *window;
        let [a, b, c] = corners;
        let planes = [cross(b, c), cross(c, a), cross(a, b)];
        let volume = dot(a, &planes[0]);
        let normal = cross(&difference(b, a), &difference(c, a));
        let distance = dot(&normal, a);
        let (mut flip, mut is_met) = (Each::default(), [false; TOGETHER]);
        for i in 0..TOGETHER {
            flip[i] = if volume[i] < 0.0 { -1.0 } else { 1.0 };
            let seen = !one_sided[i] | (volume[i] * sign < 0.0);
            // Also false for NaN.
            is_met[i] = seen & (volume[i].abs() > 0.0) & (volume[i].abs() < f64::INFINITY);
        }
        // Planes through the origin and an edge, their insides positive: normals in the beam's order.
        let mut functions = [[EachNarrow::default(); 3]; 3];
        let mut least = [EachNarrow::default(); 3];
        for (k, plane) in planes.iter().enumerate() {
            for i in 0..TOGETHER {
                let [x, u, v] = [plane[0][i] * flip[i], plane[1][i] * flip[i], plane[2][i] * flip[i]];
                let middle = x + (u * u0 + v * v0);
                // By more than f32 leaves over.
                let most = middle + (u.abs() * half_u + v.abs() * half_v) * 1.000_001;
                is_met[i] &= most >= 0.0;
                [functions[k][0][i], functions[k][1][i], functions[k][2][i]] =
                    [middle as f32, u as f32, v as f32];
                least[k][i] = f32::from_bits(u32::from(!owns_boundary(DVec3::new(x, u, v))));
            }
        }
        let mut nearness = [EachNarrow::default(); 3];
        for i in 0..TOGETHER {
            let over = 1.0 / distance[i];
            is_met[i] &= over.abs() < f64::INFINITY;
            nearness[0][i] = ((normal[0][i] + (normal[1][i] * u0 + normal[2][i] * v0)) * over) as f32;
            nearness[1][i] = (normal[1][i] * over) as f32;
            nearness[2][i] = (normal[2][i] * over) as f32;
        }
        Self { is_met, functions, least, nearness }
    }
}

/// Cross products. Like all that is done with several, loops of plain arithmetic, which compilers make vectors of.
#[inline(always)]
fn cross(a: &[Each; 3], b: &[Each; 3]) -> [Each; 3] {
    let mut product = [Each::default(); 3];
    for (k, product) in product.iter_mut().enumerate() {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        for i in 0..TOGETHER {
            product[i] = a[l][i] * b[m][i] - b[l][i] * a[m][i];
        }
    }
    product
}

#[inline(always)]
fn dot(a: &[Each; 3], b: &[Each; 3]) -> Each {
    let mut product = Each::default();
    for i in 0..TOGETHER {
        product[i] = a[0][i] * b[0][i] + a[1][i] * b[1][i] + a[2][i] * b[2][i];
    }
    product
}

#[inline(always)]
fn difference(a: &[Each; 3], b: &[Each; 3]) -> [Each; 3] {
    let mut difference = [Each::default(); 3];
    for k in 0..3 {
        for i in 0..TOGETHER {
            difference[k][i] = a[k][i] - b[k][i];
        }
    }
    difference
}
