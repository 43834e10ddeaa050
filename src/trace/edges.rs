use crate::light::owns_boundary;
use glam::DVec3;

/// A triangle as a beam meets it: functions c + a·u + b·v of slopes from the middle.
pub(super) struct Edges {
    /// Positive inside.
    pub functions: [[f32; 3]; 3],
    /// Where an edge itself belongs to the triangle 0, else the least number above.
    pub least: [f32; 3],
    /// 1/t.
    pub nearness: [f32; 3],
}

/// How many triangles are made ready together, side by side in vectors.
pub(super) const TOGETHER: usize = 4;

/// A number of each.
pub(super) type Each = [f64; TOGETHER];

/// Triangles as a beam meets them, side by side.
pub(super) struct Several {
    /// Whether a ray of the beam can hit it.
    pub is_met: [bool; TOGETHER],
    /// Planes through the origin and an edge, their insides positive: normals in the beam's order.
    planes: [[Each; 3]; 3],
    /// Of the middle of the beam.
    middles: [Each; 3],
    /// 1/t: in the middle, and by slopes from there.
    nearness: [Each; 3],
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
        let mut planes = [cross(b, c), cross(c, a), cross(a, b)];
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
        let mut middles = [Each::default(); 3];
        for (plane, middle) in planes.iter_mut().zip(&mut middles) {
            for i in 0..TOGETHER {
                let [x, u, v] = [plane[0][i] * flip[i], plane[1][i] * flip[i], plane[2][i] * flip[i]];
                [plane[0][i], plane[1][i], plane[2][i]] = [x, u, v];
                middle[i] = x + (u * u0 + v * v0);
                // By more than f32 leaves over.
                let most = middle[i] + (u.abs() * half_u + v.abs() * half_v) * 1.000_001;
                is_met[i] &= most >= 0.0;
            }
        }
        let mut nearness = [Each::default(); 3];
        for i in 0..TOGETHER {
            let over = 1.0 / distance[i];
            is_met[i] &= over.abs() < f64::INFINITY;
            nearness[0][i] = (normal[0][i] + (normal[1][i] * u0 + normal[2][i] * v0)) * over;
            nearness[1][i] = normal[1][i] * over;
            nearness[2][i] = normal[2][i] * over;
        }
        Self { is_met, planes, middles, nearness }
    }

    #[inline(always)]
    pub fn edges(&self, i: usize) -> Edges {
        let function = |k: usize| {
            let [_, u, v] = &self.planes[k];
            [self.middles[k][i] as f32, u[i] as f32, v[i] as f32]
        };
        let least = |k: usize| {
            let [x, y, z] = &self.planes[k];
            if owns_boundary(DVec3::new(x[i], y[i], z[i])) { 0.0 } else { f32::from_bits(1) }
        };
        Edges {
            functions: [function(0), function(1), function(2)],
            least: [least(0), least(1), least(2)],
            nearness: [self.nearness[0][i] as f32, self.nearness[1][i] as f32, self.nearness[2][i] as f32],
        }
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
