use glam::DVec3;

/// A straight edge of a body as one observer meets it, for how far apparent chords are from it, in lengths.
///
/// A point of the edge at s from the foot of the perpendicular, the distance h from the observer, is at
/// r′ = √(h² + s²). A straight apparent line drawn for the part from s₀ to s₁ is off along the motion, by exactly
/// γβ times the chord of r′ less r′. With a = √(r′ − s), b = √(r′ + s), so that ab = h, the greatest of it is
/// γβ a₀a₁(b₁ − b₀)²/(a₀a₁ + b₀b₁), where r′ has the slope of its chord.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// γβ.
    speed: f64,
    /// h.
    height: f64,
    /// s of the beginning.
    start: f64,
    length: f64,
}

/// A place on a [`Line`].
#[derive(Clone, Copy)]
struct Place {
    s: f64,
    r: f64,
    a: f64,
    b: f64,
}

impl Line {
    /// The edge between two rest-frame offsets from the observer, whose speed relative to it is the celerity `speed`.
    pub fn new(speed: f64, from: DVec3, to: DVec3) -> Self {
        let along = to - from;
        let length = along.length();
        if length == 0.0 {
            return Self { speed, height: 0.0, start: 0.0, length };
        }
        // A line that passes nearer than this goes through the observer, where a or b would be 0.
        let least = 1e-17 * from.length().max(to.length());
        Self {
            speed,
            height: (from.cross(along).length() / length).max(least),
            start: from.dot(along) / length,
            length,
        }
    }

    fn at(&self, t: f64) -> Place {
        let s = self.start + t * self.length;
        let r = self.height.hypot(s);
        // Of the two, the one that would cancel is had from the other.
        let larger = (r + s.abs()).sqrt();
        let smaller = self.height / larger;
        let (a, b) = if s < 0.0 { (larger, smaller) } else { (smaller, larger) };
        Place { s, r, a, b }
    }

    /// Greatest distance between the chord of the part from `from` to `to` (0 to 1) and what is seen.
    pub fn deviation(&self, from: f64, to: f64) -> f64 {
        if self.length == 0.0 || self.speed == 0.0 {
            return 0.0;
        }
        let (p, q) = (self.at(from), self.at(to));
        let slope = (p.s + q.s) / (p.r + q.r);
        let step = (to - from) * self.length;
        // a₀a₁(b₁ − b₀)² = b₀b₁(a₀ − a₁)².
        let gap = if slope < 0.0 {
            let fall = step * (1.0 - slope) / (p.a + q.a);
            fall * fall * p.b * q.b
        } else {
            let rise = step * (1.0 + slope) / (p.b + q.b);
            rise * rise * p.a * q.a
        };
        self.speed * gap / (p.a * q.a + p.b * q.b)
    }

    /// How far a chord from `from` may go until it is off by `tolerance`; infinite if it never is.
    ///
    /// With E = b₁/b₀ that is (1 − x)E² − 2E + (1 − y) = 0, x = ε/a₀², y = ε/b₀², ε = tolerance/γβ.
    pub fn reach(&self, from: f64, tolerance: f64) -> f64 {
        if self.length == 0.0 || self.speed == 0.0 {
            return f64::INFINITY;
        }
        let p = self.at(from);
        let slack = tolerance / self.speed;
        let (x, y) = (slack / (p.a * p.a), slack / (p.b * p.b));
        if x >= 1.0 {
            return f64::INFINITY;
        }
        // E − 1, without cancellation.
        let growth = ((x + y - x * y).sqrt() + x) / (1.0 - x);
        let factor = 1.0 + growth;
        let squares = p.b * p.b + (p.a / factor) * (p.a / factor);
        from + 0.5 * growth * (factor + 1.0) * squares / self.length
    }
}

/// Where an edge is cut.
#[derive(Clone, Debug, Default)]
pub(super) struct Cuts {
    /// Positions along the edge, 0 to 1, increasing, without its ends.
    pub at: Vec<f64>,
    /// How much of a piece's allowance every piece uses up, as a number of pieces (0 to 1).
    pub fill: f64,
}

/// Cuts one edge, as several observers (or one at several moments) meet it, into the fewest pieces that keep within
/// `tolerance` of what each of them sees, all pieces about equally good; none if they are more than `most`.
///
/// r′ is convex, so that a piece is the worse the longer it is, and going from one end as far as possible each time
/// gives the fewest. Their number grows as 1/√tolerance.
pub(super) fn cuts(lines: &[Line], tolerance: f64, most: usize) -> Option<Cuts> {
    let off = lines.iter().map(|line| line.deviation(0.0, 1.0)).fold(0.0, f64::max);
    if off <= tolerance {
        return Some(Cuts { at: Vec::new(), fill: (off / tolerance).sqrt() });
    }
    let mut at = greedy(lines, tolerance, most)?;
    // The same number for the least tolerance: no stub at the end.
    let pieces = at.len() + 1;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        match greedy(lines, middle * tolerance, pieces) {
            Some(better) => (at, high) = (better, middle),
            None => low = middle,
        }
    }
    Some(Cuts { at, fill: f64::sqrt(high) })
}

fn greedy(lines: &[Line], tolerance: f64, most: usize) -> Option<Vec<f64>> {
    let mut at = Vec::new();
    let mut here = 0.0;
    loop {
        let next = lines.iter().map(|line| line.reach(here, tolerance)).fold(f64::INFINITY, f64::min);
        if next >= 1.0 {
            return Some(at);
        }
        // A step too small for the digits would go on for ever.
        if at.len() + 1 >= most || next <= here {
            return None;
        }
        at.push(next);
        here = next;
    }
}

/// Where within a flat triangle (offsets of its corners from the observer, rest frame) it is farthest from what is
/// seen, as barycentric coordinates, and how far; none if that is on one of its sides.
///
/// The error γβ(Σ λᵢ r′ᵢ − r′) is concave over the triangle, so that its one stationary point is its greatest: there
/// r′ = h/√(1 − g²), g the gradient of the linear part and h the distance of the plane.
pub(super) fn bulge(speed: f64, offsets: [DVec3; 3]) -> Option<([f64; 3], f64)> {
    let [a, b, c] = offsets;
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    if square == 0.0 {
        return None;
    }
    let [ra, rb, rc] = offsets.map(DVec3::length);
    let rise = |along: DVec3, sum: DVec3, radii: f64| along.dot(sum) / radii;
    // The basis dual to the two sides.
    let (to_b, to_c) = (ac.cross(normal) / square, normal.cross(ab) / square);
    let gradient = rise(ab, a + b, ra + rb) * to_b + rise(ac, a + c, ra + rc) * to_c;
    let flat = 1.0 - gradient.length_squared();
    if flat.is_nan() || flat <= 0.0 {
        return None;
    }
    let foot = normal * (normal.dot(a) / square);
    let from_a = foot + gradient * (foot.length() / flat.sqrt()) - a;
    let (v, w) = (to_b.dot(from_a), to_c.dot(from_a));
    let weights = [1.0 - v - w, v, w];
    if !weights.iter().all(|w| *w > 1e-9) {
        return None;
    }
    // Σ λᵢ r′ᵢ − r′ = Σ λᵢ |xᵢ × x|²/(r′(r′ᵢr′ + xᵢ·x)) for any point x = Σ λᵢ xᵢ, without cancellation.
    let from_a = v * ab + w * ac;
    let at = a + from_a;
    let r = at.length();
    let gap = |i: usize, to: DVec3| {
        let corner = offsets[i];
        let below = r * (corner.length() * r + corner.dot(at));
        // At the observer, and of a corner opposite, it is what it was before taking it apart.
        let gap = if below > 0.0 { corner.cross(to).length_squared() / below } else { corner.length() };
        weights[i] * gap
    };
    let off = speed * (gap(0, from_a) + gap(1, from_a - ab) + gap(2, from_a - ac));
    Some((weights, off))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines() -> Vec<Line> {
        let mut out = Vec::new();
        for (from, to) in [
            (DVec3::new(-3.0, 1.0, 0.0), DVec3::new(5.0, 1.0, 0.0)),
            (DVec3::new(-3.0, 1e-6, 0.0), DVec3::new(5.0, 1e-6, 0.0)),
            (DVec3::new(2.0, 0.3, 0.0), DVec3::new(5.0, 0.1, 4.0)),
            (DVec3::new(9.0, 0.3, 1.0), DVec3::new(1.0, 0.1, 0.0)),
            (DVec3::new(-2.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)),
            (DVec3::new(2.0, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.0)),
        ] {
            out.extend([0.1, 1.0, 7.0, 1e3].map(|speed| Line::new(speed, from, to)));
        }
        out
    }

    /// The formula against 20 000 points of the definition.
    #[test]
    fn the_deviation_is_the_greatest_there_is() {
        for line in lines() {
            for (from, to) in [(0.0, 1.0), (0.2, 0.3), (0.7, 0.9), (0.0, 0.6)] {
                let (p, q) = (line.at(from), line.at(to));
                let off = |i: u32| {
                    let t = f64::from(i) / 20_000.0;
                    line.speed * (p.r + t * (q.r - p.r) - line.at(from + t * (to - from)).r)
                };
                let greatest = (0..=20_000).map(off).fold(0.0, f64::max);
                let formula = line.deviation(from, to);
                // The differences above round at this; the corner of a line through the observer lies between points.
                let noise = 1e-15 * line.speed * (p.r + q.r);
                assert!(greatest <= formula * (1.0 + 1e-12) + noise, "{line:?}: {greatest} {formula}");
                assert!(formula <= greatest + 1e-4 * formula + noise, "{line:?}: {greatest} {formula}");
            }
        }
    }

    #[test]
    fn a_chord_as_long_as_can_be_uses_the_tolerance_up() {
        for line in lines() {
            for from in [0.0, 0.1, 0.5] {
                for tolerance in [1e-6, 1e-3, 0.1] {
                    let to = line.reach(from, tolerance);
                    if to < 1e6 {
                        let off = line.deviation(from, to);
                        assert!((off / tolerance - 1.0).abs() < 1e-6, "{line:?} {from} {to}: {off}");
                    } else {
                        assert!(line.deviation(from, 1e6) <= tolerance * (1.0 + 1e-9), "{line:?}");
                    }
                }
            }
        }
    }

    /// The least number of pieces by an independent search: the farthest end for which the deviation, sampled from
    /// its definition, holds.
    #[test]
    fn rods_take_as_few_pieces_as_can_be() {
        for line in lines().into_iter().filter(|l| l.speed < 100.0) {
            let tolerance = 3e-3;
            let sampled = |from: f64, to: f64| {
                let (p, q) = (line.at(from), line.at(to));
                let off = |i: u32| {
                    let t = f64::from(i) / 300.0;
                    line.speed * (p.r + t * (q.r - p.r) - line.at(from + t * (to - from)).r)
                };
                (0..=300).map(off).fold(0.0, f64::max)
            };
            let (mut here, mut pieces) = (0.0, 0);
            while here < 1.0 {
                let (mut good, mut bad) = (here, 1.0);
                if sampled(here, 1.0) <= tolerance {
                    good = 1.0;
                }
                while bad - good > 1e-12 {
                    let middle = 0.5 * (good + bad);
                    if sampled(here, middle) <= tolerance { good = middle } else { bad = middle }
                }
                here = good;
                pieces += 1;
            }
            let cuts = cuts(&[line], tolerance, 10_000).unwrap();
            assert_eq!(cuts.at.len() + 1, pieces, "{line:?}");
            let ends = [&[0.0], &cuts.at[..], &[1.0]].concat();
            for piece in ends.windows(2) {
                assert!(line.deviation(piece[0], piece[1]) <= tolerance * (1.0 + 1e-9), "{line:?}");
            }
        }
    }

    #[test]
    fn the_bulge_is_the_worst_point() {
        let triangles = [
            [DVec3::new(-1.0, -0.8, 0.3), DVec3::new(1.0, -0.7, 0.3), DVec3::new(0.1, 1.2, 0.3)],
            [DVec3::new(-1.0, -0.8, 1e-9), DVec3::new(1.0, -0.7, -1e-9), DVec3::new(0.1, 1.2, 0.0)],
            [DVec3::new(3.0, 1.0, 2.0), DVec3::new(4.0, 1.5, 2.0), DVec3::new(3.2, 2.5, 2.3)],
        ];
        for offsets in triangles {
            let [a, b, c] = offsets;
            let (_, worst) = bulge(7.0, offsets).unwrap();
            let mut greatest = 0.0f64;
            for i in 0..=400 {
                for j in 0..=400 - i {
                    let (v, w) = (f64::from(i) / 400.0, f64::from(j) / 400.0);
                    let u = 1.0 - v - w;
                    let flat = u * a.length() + v * b.length() + w * c.length();
                    greatest = greatest.max(7.0 * (flat - (u * a + v * b + w * c).length()));
                }
            }
            assert!(greatest <= worst * (1.0 + 1e-12) && worst < 1.005 * greatest, "{greatest} {worst}");
        }
    }
}
