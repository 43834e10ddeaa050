use super::Field;
use crate::relativity::ApparentMap;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// What a straight edge looks like on the observer's sky: an arc of a circle, in closed form.
///
/// In the rest sky the edge is an arc of the great circle with the unit normal N′ (the plane through observer
/// and edge). Aberration takes circles to circles: ours has the geodesic curvature κ = γβ N′·û (û: unit
/// vector of the motion). With φ′ the angle along the rest-sky circle from the projection of û, and χ the
/// angle around our circle, tan(χ/2) = K tan(φ′/2), K² = (γ + γβm)/(γ − γβm), m = √(1 − (N′·û)²); one radian
/// of χ is 1/√(1 + κ²) of sky, and D = (1 + κ²)/(γ + γβ m cos χ).
///
/// A chord across dχ leaves the arc by κ dψ²/8 on the sky (dψ the sky length); the number of chords a
/// tolerance of ε pixels costs is the integral of √(F·scale·κ/(8ε)) dψ: ∝ 1/√ε.
#[derive(Clone, Copy, Debug)]
pub struct Arc {
    /// Geodesic curvature κ of the image, signed.
    curvature: f64,
    /// √(1 + κ²) = |M|.
    pole_length: f64,
    /// M = N′ + (γ − 1)(N′·û)û in the observer's axes: n·M + κ = 0 on the circle.
    pole: DVec3,
    /// n(χ) = centre + p cos χ + q sin χ.
    centre: DVec3,
    p: DVec3,
    q: DVec3,
    gamma: f64,
    /// γβ.
    speed: f64,
    /// γβ m.
    in_plane: f64,
    /// K.
    stretch: f64,
    /// φ′ at the first end, and from there to the second.
    phi_start: f64,
    phi_length: f64,
    /// Distances of the ends from the observer in the rest frame.
    start: f64,
    end: f64,
    /// χ at both ends; chi[0] < chi[1].
    chi: [f64; 2],
}

impl Arc {
    /// The image of the edge between two rest-frame offsets from the observer; none where the edge points at
    /// the observer (it is seen as a point) or passes through.
    pub fn new(map: &ApparentMap, from: DVec3, to: DVec3) -> Option<Self> {
        let axis = map.axis_rest();
        // Taken apart along and across the motion: at high speed both point along it to γ digits, and their product's
        // component there, which γ multiplies, would be lost.
        let [p, q] = [from, to].map(|v| axis.cross(v.cross(axis)));
        let along = axis.dot(p.cross(q));
        let normal = axis.cross(from.dot(axis) * q - to.dot(axis) * p) + along * axis;
        let area = normal.length();
        let (start, end) = (from.length(), to.length());
        // An angle of this few radians cannot be told from rounding noise of its ends, nor the direction of an end
        // this much nearer than the other.
        if area <= 4.0 * f64::EPSILON * start * end || start.min(end) <= 64.0 * f64::EPSILON * start.max(end)
        {
            return None;
        }
        let normal = normal / area;
        let (gamma, speed) = (map.gamma(), map.speed());
        let c = along / area;
        let across = axis - c * normal;
        let m = across.length();
        let curvature = speed * c;
        let pole_length = curvature.hypot(1.0);
        let in_plane = speed * m;
        let pole = normal + ((gamma - 1.0) * c) * axis;

        // φ′ is measured from e, the projection of û onto the edge's plane.
        let e = if m > 1e-12 { across / m } else { from / start };
        let g = normal.cross(e);
        let phi_start = from.dot(g).atan2(from.dot(e));
        let phi_length = area.atan2(from.dot(to));

        // D and n at φ′ = 0, without cancellation: γ − γβm = (1 + κ²)/(γ + γβm).
        let doppler = (1.0 + curvature * curvature) / (gamma + in_plane);
        let along = (m * m - curvature * curvature) / ((gamma * m + speed) * doppler);
        let along = if m > 1e-12 { along } else { -speed / gamma };
        let beside = if m > 1e-12 { -c * (normal - c * axis) / (m * doppler) } else { e / gamma };
        let first = along * axis + beside;
        let centre = -(curvature / (pole_length * pole_length)) * pole;
        let p = first - centre;
        let q = (pole / pole_length).cross(p);
        // Only now to the observer's axes, which may be left-handed as cross products go.
        let [pole, centre, p, q] = [pole, centre, p, q].map(|v| map.rotate(v));

        let mut arc = Self {
            curvature,
            pole_length,
            pole,
            centre,
            p,
            q,
            gamma,
            speed,
            in_plane,
            stretch: (gamma + in_plane) / pole_length,
            phi_start,
            phi_length,
            start,
            end,
            chi: [0.0; 2],
        };
        arc.chi = [arc.chi_of(phi_start), arc.chi_of(phi_start + phi_length)];
        Some(arc)
    }

    /// φ′ to χ, continuous from −π to 2π.
    fn chi_of(&self, phi: f64) -> f64 {
        let (sin, cos) = (0.5 * phi).sin_cos();
        2.0 * (self.stretch * sin).atan2(cos)
    }

    fn phi_of(&self, chi: f64) -> f64 {
        let (sin, cos) = (0.5 * chi).sin_cos();
        2.0 * sin.atan2(self.stretch * cos)
    }

    /// Position along the edge, 0 to 1, of the point seen at χ.
    fn parameter(&self, chi: f64) -> f64 {
        let angle = (self.phi_of(chi) - self.phi_start).clamp(0.0, self.phi_length);
        let (a, b) = (self.start * angle.sin(), self.end * (self.phi_length - angle).sin());
        // Where both vanish the edge runs straight away from the observer.
        if a + b > 0.0 { a / (a + b) } else { 0.5 }
    }

    /// The direction in which the part at χ is seen, observer's axes, unit length.
    #[inline]
    fn direction(&self, chi: f64) -> DVec3 {
        let (sin, cos) = chi.sin_cos();
        self.centre + cos * self.p + sin * self.q
    }

    /// D at χ: (1 + κ²)/(γ + γβ m cos χ), the sum taken without cancellation near χ = π.
    #[inline]
    fn doppler(&self, chi: f64) -> f64 {
        let square = self.pole_length * self.pole_length;
        let half = (0.5 * chi).cos();
        square / (square / (self.gamma + self.in_plane) + 2.0 * self.in_plane * half * half)
    }

    /// Chords a radian of χ that keep the drawn line within `tolerance` pixels of the edge's image.
    fn outline_density(&self, field: &Field, tolerance: f64, chi: f64) -> f64 {
        let n = self.direction(chi);
        let binormal = self.pole + self.curvature * n;
        let scale = field.focal() * field.scale_across(n, binormal);
        (self.curvature.abs() * scale / (8.0 * field.tolerance_at(n, tolerance))).sqrt() / self.pole_length
    }

    /// Chords a radian of χ that keep every *point* of the edge within `tolerance` pixels of where it is seen,
    /// and its depth in proportion.
    ///
    /// A chord across the rest angle φ′ displaces points along the motion by γβ r′φ′²/8. Of the apparent
    /// distance that is γβ D φ²/8; where D > 1 depth is stretched D-fold along with the error, so that
    /// relative to the body's own shape it counts D times less: γβ min(1, D).
    fn warp_density(&self, field: &Field, tolerance: f64, chi: f64) -> f64 {
        let n = self.direction(chi);
        let scale = field.focal() * field.scale(n);
        let warp = self.speed * self.doppler(chi).min(1.0);
        (warp * scale / (8.0 * field.tolerance_at(n, tolerance))).sqrt() / self.pole_length
    }

    /// Largest distance in pixels between the image of the part from χ₀ to χ₁ and the straight line drawn for
    /// it, and the tolerance that applies there: both exact, from the two first-order trigonometric
    /// polynomials that direction and depth are.
    pub(super) fn deviation(&self, field: &Field, tolerance: f64, chi: [f64; 2]) -> (f64, f64) {
        let [n0, n1] = chi.map(|c| self.direction(c));
        let plane = n0.cross(n1);
        let parts = |v: DVec3| [v.dot(self.centre), v.dot(self.p), v.dot(self.q)];
        let ([c0, c1, c2], [f0, f1, f2]) = (parts(plane), [self.centre.z, self.p.z, self.q.z]);
        // Extremum of (plane·n)/n_z over χ.
        let (constant, cos, sin) = (c2 * f1 - c1 * f2, c2 * f0 - c0 * f2, c0 * f1 - c1 * f0);
        let middle = 0.5 * (chi[0] + chi[1]);
        let (phase, reach) = (sin.atan2(cos), (-constant / cos.hypot(sin)).clamp(-1.0, 1.0).acos());
        let nearest = |angle: f64| middle + (angle - middle + PI).rem_euclid(TAU) - PI;
        let screen = [phase + reach, phase - reach]
            .map(nearest)
            .into_iter()
            .filter(|c| (chi[0]..=chi[1]).contains(c))
            .fold(middle, |_, c| c);
        // The tolerance of the part nearest to the picture's middle.
        let top = nearest(f2.atan2(f1));
        let nearest_part = if (chi[0]..=chi[1]).contains(&top) {
            self.direction(top)
        } else if n0.z > n1.z {
            n0
        } else {
            n1
        };
        let n_sky = self.direction(middle);
        let binormal = self.pole + self.curvature * n_sky;
        let deviation = field.deviation(
            [n0, n1],
            n_sky,
            binormal,
            self.direction(screen),
            field.is_outside(nearest_part),
        );
        (deviation, field.tolerance_at(nearest_part, tolerance))
    }

    /// Where to cut the edge so that its outline is drawn within `tolerance` pixels (χ of the inner cuts),
    /// with as few pieces as the closed form knows; checked piece by piece.
    pub(super) fn outline_cuts(&self, field: &Field, tolerance: f64) -> Cuts {
        self.checked_cuts(field, tolerance, |_| 0.0)
    }

    /// As [`outline_cuts`](Self::outline_cuts), also good for attributes and depth to `warp_tolerance`.
    pub(super) fn surface_cuts(&self, field: &Field, tolerance: f64, warp_tolerance: f64) -> Cuts {
        self.checked_cuts(field, tolerance, |chi| self.warp_density(field, warp_tolerance, chi))
    }

    fn checked_cuts(&self, field: &Field, tolerance: f64, least: impl Fn(f64) -> f64) -> Cuts {
        // How much too far a piece is drawn: the closed form is the limit of small pieces.
        let excess = |ends: [f64; 2]| {
            let (deviation, allowed) = self.deviation(field, tolerance, ends);
            deviation / allowed
        };
        let pairs = |cuts: &[f64]| -> Vec<[f64; 2]> {
            let ends = [&self.chi[..1], cuts, &self.chi[1..]].concat();
            ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
        };
        let mut factor = 1.0;
        let mut cuts = Cuts::default();
        for _ in 0..3 {
            cuts = self.cuts(|chi| (factor * self.outline_density(field, tolerance, chi)).max(least(chi)));
            let worst = pairs(&cuts.chi).into_iter().map(excess).fold(0.0, f64::max);
            if worst <= 1.0 {
                return cuts;
            }
            if worst > 1.5 {
                break;
            }
            factor *= 1.001 * worst.sqrt();
        }
        // What is left are single pieces where the picture ends: halve those.
        for _ in 0..40 {
            let wrong: Vec<f64> = pairs(&cuts.chi)
                .into_iter()
                .filter(|&p| excess(p) > 1.0)
                .map(|[a, b]| 0.5 * (a + b))
                .collect();
            if wrong.is_empty() || cuts.chi.len() > MOST_CUTS {
                break;
            }
            cuts.total += wrong.len() as f64;
            cuts.chi.extend(wrong);
            cuts.chi.sort_by(f64::total_cmp);
        }
        cuts
    }

    /// Cuts for an edge that is nobody's outline.
    pub(super) fn inner_cuts(&self, field: &Field, warp_tolerance: f64) -> Cuts {
        self.cuts(|chi| self.warp_density(field, warp_tolerance, chi))
    }

    /// χ at which the integral of `density` from the start passes each whole N-th part of its total, N the
    /// total rounded up.
    fn cuts(&self, density: impl Fn(f64) -> f64) -> Cuts {
        let [from, to] = self.chi;
        // Densities are smooth on the scale of a radian, a little less where the picture ends.
        let panels = ((to - from) / 0.12).ceil().clamp(1.0, 54.0) as usize;
        // A chord replaces less than half a circle of the sky, or it runs the other way around.
        let sky = (to - from) / self.pole_length;
        let least = if sky > LONGEST { 1.0 / (LONGEST * self.pole_length) } else { 0.0 };
        let density = |chi: f64| density(chi).max(least);
        let step = (to - from) / panels as f64;
        let mut below = [0.0; 55];
        let mut left = density(from);
        for i in 0..panels {
            let at = from + i as f64 * step;
            let right = density(at + step);
            below[i + 1] = below[i] + step / 6.0 * (left + 4.0 * density(at + 0.5 * step) + right);
            left = right;
        }
        let total = below[panels];
        if total.is_nan() || total <= 1.0 {
            return Cuts { chi: Vec::new(), total };
        }
        let pieces = total.ceil().min(MOST_CUTS as f64 + 2.0) as usize;
        let mut panel = 0;
        let chi = (1..pieces)
            .map(|k| {
                let target = total * k as f64 / pieces as f64;
                while below[panel + 1] < target && panel + 1 < panels {
                    panel += 1;
                }
                let part = (target - below[panel]) / (below[panel + 1] - below[panel]);
                from + (panel as f64 + part) * step
            })
            .collect();
        Cuts { chi, total }
    }

    /// Cuts as positions along the edge, 0 to 1, increasing.
    pub(super) fn parameters(&self, cuts: &Cuts) -> impl Iterator<Item = f64> {
        cuts.chi.iter().map(|&chi| self.parameter(chi))
    }
}

/// Where an arc is to be cut.
#[derive(Debug, Default)]
pub(super) struct Cuts {
    /// χ of the cuts, increasing.
    chi: Vec<f64>,
    /// How many pieces it takes, before rounding up.
    pub total: f64,
}

/// No piece is longer, in radians of sky.
const LONGEST: f64 = 2.0;

/// No edge is cut into more pieces; a picture of 32 768 pixels needs 1 000 for a thousandth of a pixel.
pub(super) const MOST_CUTS: usize = 100_000;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::relativity::Motion;
    use terrell_geodesic::{Celerity, Event, Tetrad};

    /// The closed form is the map: direction and D at χ are those of the edge's point there.
    #[test]
    fn the_circle_is_where_the_edge_is_seen() {
        for (speed, tolerance) in [(0.1, 1e-13), (0.75, 1e-13), (7.0, 1e-12), (1e3, 1e-9), (1e6, 1e-4)] {
            for (from, to) in [
                (DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 1.0, 0.5)),
                (DVec3::new(-1.0, 0.1, 0.1), DVec3::new(1.0, 0.2, -0.1)),
                (DVec3::new(0.0, 1.0, 2.0), DVec3::new(0.0, -2.0, 1.0)),
                (DVec3::new(2.0, 3.0, 0.0), DVec3::new(-5.0, -1.0, 0.0)),
            ] {
                for direction in [DVec3::X, -DVec3::X, DVec3::new(0.6, 0.48, 0.64)] {
                    let celerity = Celerity::new(direction * speed).unwrap();
                    let motion = Motion { celerity, origin: Event::origin() };
                    let observer =
                        Tetrad::new(Event::origin(), Celerity::at_rest(), DVec3::Y, DVec3::Z).unwrap();
                    let map = ApparentMap::new(&motion, &observer);
                    let arc = Arc::new(&map, from, to).unwrap();
                    assert!(arc.chi[0] < arc.chi[1]);
                    for i in 0..=20 {
                        let chi = arc.chi[0] + (arc.chi[1] - arc.chi[0]) * f64::from(i) / 20.0;
                        let sight = map.see(from.lerp(to, arc.parameter(chi)));
                        let n = sight.position / sight.distance;
                        assert!(
                            (n - arc.direction(chi)).length() < tolerance,
                            "{speed} {from} {to} {chi}: {n} {}",
                            arc.direction(chi)
                        );
                        assert!(
                            (sight.doppler / arc.doppler(chi) - 1.0).abs()
                                < tolerance.max(1e-12) * speed.max(1.0)
                        );
                    }
                }
            }
        }
    }
}
