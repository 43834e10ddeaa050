use super::kernel::{self, Constants, Halved, Lane, Points, PointsMut};
use super::motion::Motion;
use glam::{DMat3, DVec3};
use terrell_geodesic::{Real, Tetrad, Wide};

/// The map from a body's rest frame to what one observer sees of it (Nollert et al. 2000, Eq. 1, 3).
///
/// A rest-frame point at the offset x′ from the observer's event, at the distance r′ = |x′|, sent the light
/// that arrives now from the displacement (−r′, x′) on the past light cone. One boost of that null vector
/// gives (−r, x): x the apparent position, r the apparent distance, and D = r/r′ the Doppler factor
/// ν_observed/ν_emitted. Along the motion x = γ(x′ − βr′), Eq. 1.
///
/// Rays through the observer go to rays and D > 0, so the map keeps facing and depth order exactly, for any
/// mix of velocities.
///
/// Everything that is a difference of large numbers (the observer in the rest frame, the relative motion of
/// body and camera) is formed with 32 digits when the map is made; a vertex then costs some 80 operations
/// and its result is within 5·10⁻¹⁶ (f64) or 3·10⁻⁷ (f32) of the distance, times the conditioning of the
/// input, for γ up to 10⁹, near the axis included.
#[derive(Clone, Debug)]
pub struct ApparentMap {
    /// The observer in the rest frame.
    observer: [Wide; 3],
    f64: Constants<f64>,
    f32: Constants<f32>,
    gamma: f64,
    speed: f64,
    rotates: bool,
}

/// One point as seen, with the rest-frame side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Apparent position relative to the observer, in the observer's axes.
    pub position: DVec3,
    /// Apparent distance r (observer frame); light left the point r before the observer's event.
    pub distance: f64,
    /// D = ν_observed/ν_emitted = r/r′; NaN for a point at the observer.
    pub doppler: f64,
    /// Distance r′ from the observer's event in the rest frame.
    pub rest_distance: f64,
    /// Cosine of the angle between the body's velocity and observer → point in the body's rest frame (the θ
    /// with which Eq. 3 reads γ(1 − β cos θ)); NaN for a point at the observer.
    pub cos_theta_rest: f64,
    /// The same angle in the observer's frame: D = 1/(γ(1 + β cos θ)).
    pub cos_theta_observer: f64,
}

impl Sight {
    fn from_seen(seen: &kernel::Seen<f64>) -> Self {
        Self {
            position: seen.position.into(),
            distance: seen.distance,
            doppler: seen.doppler,
            rest_distance: seen.rest_distance,
            cos_theta_rest: seen.rest_along / seen.rest_distance,
            cos_theta_observer: seen.along / seen.distance,
        }
    }
}

impl ApparentMap {
    /// The map for a body in motion and an observer, moving or not.
    pub fn new(body: &Motion, observer: &Tetrad) -> Self {
        let world_from_rest = body.world_from_rest::<Wide>();
        let observer_rest = world_from_rest.inverse() * observer.event().since::<Wide>(body.origin);
        let observer_from_rest = observer.observer_from_world::<Wide>() * world_from_rest;

        let u = observer_from_rest.celerity_in_from();
        let speed = (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]).sqrt();
        let one = Wide::from(1.0);
        let axis = if speed.high > 0.0 { u.map(|c| c / speed) } else { [one, 0.0.into(), 0.0.into()] };
        let gamma = (one + speed * speed).sqrt();
        let k = gamma + speed;
        let observer = observer_rest.space;
        let along = observer[0] * axis[0] + observer[1] * axis[1] + observer[2] * axis[2];
        let across = [0, 1, 2].map(|i| observer[i] - along * axis[i]);
        // What 32 digits leave of a zero is noise; without it an unrotated observer is recognised.
        let axes =
            observer_from_rest.axes().map(|row| row.map(|c| if c.high.abs() < 1e-20 { 0.0 } else { c.high }));

        Self {
            observer,
            f64: Constants {
                across: across.map(f64::split_wide),
                along: f64::split_wide(along),
                axis: axis.map(f64::split_wide),
                k: f64::split_wide(k),
                inverse_k: f64::split_wide(one / k),
                axes,
            },
            f32: Constants {
                across: across.map(f32::split_wide),
                along: f32::split_wide(along),
                axis: axis.map(f32::split_wide),
                k: f32::split_wide(k),
                inverse_k: f32::split_wide(one / k),
                axes: axes.map(|row| row.map(|c| c as f32)),
            },
            gamma: gamma.high,
            speed: speed.high,
            rotates: axes != [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        }
    }

    /// Relative Lorentz factor of body and observer.
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// Relative speed as celerity γβ.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// The observer's position in the body's rest frame at the observer's event.
    pub fn observer_rest(&self) -> DVec3 {
        self.observer.map(|c| c.high).into()
    }

    /// Unit vector of the relative motion in rest-frame axes; x where nothing moves.
    pub fn axis_rest(&self) -> DVec3 {
        self.f64.axis.map(|c| c.high).into()
    }

    /// Unit vector of the relative motion in the observer's axes.
    pub fn axis_observer(&self) -> DVec3 {
        self.rotate(self.axis_rest())
    }

    /// A vector of the rest frame in the observer's axes: the rotation that is left when the boost is taken
    /// off.
    pub fn rotate(&self, v_rest: DVec3) -> DVec3 {
        self.axes().transpose() * v_rest
    }

    /// Columns: the observer's axes in the (unboosted) axes of the rest frame.
    pub(crate) fn axes(&self) -> DMat3 {
        let [right, up, forward] = self.f64.axes.map(DVec3::from_array);
        DMat3::from_cols(right, up, forward)
    }

    /// The offset x′ of a rest-frame point from the observer, before rounding noise of a large offset.
    #[inline]
    pub fn offset_rest(&self, x_rest: DVec3) -> DVec3 {
        let o = &self.observer;
        DVec3::new(
            (x_rest.x - o[0].high) - o[0].low,
            (x_rest.y - o[1].high) - o[1].low,
            (x_rest.z - o[2].high) - o[2].low,
        )
    }

    /// Where a rest-frame point is seen.
    pub fn see(&self, x_rest: DVec3) -> Sight {
        if self.speed == 0.0 {
            let offset = self.offset_rest(x_rest);
            let length = offset.length();
            let cosine = offset.x / length;
            return Sight {
                position: if self.rotates { self.rotate(offset) } else { offset },
                distance: length,
                doppler: if length > 0.0 { 1.0 } else { f64::NAN },
                rest_distance: length,
                cos_theta_rest: cosine,
                cos_theta_observer: cosine,
            };
        }
        Sight::from_seen(&if self.rotates {
            kernel::see::<f64, Halved, true>(&self.f64, x_rest.into())
        } else {
            kernel::see::<f64, Halved, false>(&self.f64, x_rest.into())
        })
    }

    /// The unit normal of the apparent surface, observer's axes, where the surface has the normal `normal_rest`
    /// in the rest frame at the point `x_rest`.
    ///
    /// The map's derivative, inverted and transposed, takes n′ to D n′⊥ + (n′·û)(û + γβ e⊥), up to a factor: û the
    /// unit vector of the motion, ⊥ what is across it, e the unit vector from the observer to the point.
    pub fn seen_normal(&self, x_rest: DVec3, normal_rest: DVec3) -> DVec3 {
        let sight = self.see(x_rest);
        if self.speed == 0.0 || sight.rest_distance == 0.0 {
            return self.rotate(normal_rest).normalize_or_zero();
        }
        let axis = self.axis_rest();
        let across = |v: DVec3| v - v.dot(axis) * axis;
        let e = self.offset_rest(x_rest) / sight.rest_distance;
        let along = normal_rest.dot(axis);
        let normal = sight.doppler * across(normal_rest) + along * (axis + self.speed * across(e));
        self.rotate(normal).normalize_or_zero()
    }

    /// Where a rest-frame point stored in f32 is seen, worked out in f32 throughout: position (observer's
    /// axes), distance, Doppler factor.
    pub fn see_f32(&self, x_rest: [f32; 3]) -> ([f32; 3], f32, f32) {
        let seen = kernel::see::<f32, Halved, true>(&self.f32, x_rest);
        (seen.position, seen.distance, seen.doppler)
    }

    /// The inverse: the rest-frame point seen at `apparent` (relative to the observer, in its axes). This is
    /// the "intelligent observer" of section 2.1.2, who knows the distance and infers the true shape:
    /// x′ = γ(x + βr).
    pub fn unsee(&self, apparent: DVec3) -> (DVec3, Sight) {
        let (x_rest, seen) = kernel::unsee(&self.f64, apparent.into());
        (x_rest.into(), Sight::from_seen(&seen))
    }

    /// D of whatever part of the body is seen in the direction `n` (any length, observer's axes).
    pub fn doppler_towards(&self, n: DVec3) -> f64 {
        let length = n.length();
        length / self.rest_sky().boosted(n, length).length
    }

    /// The body's sky by the observer's directions.
    pub fn rest_sky(&self) -> RestSky {
        RestSky { axis: self.axis_observer(), k: self.f64.k.high, inverse_k: self.f64.inverse_k.high }
    }

    /// A vector of the observer's axes in the axes of the rest frame; the inverse of [`rotate`](Self::rotate).
    pub fn rotate_back(&self, v_observer: DVec3) -> DVec3 {
        self.axes() * v_observer
    }

    /// Maps points stored as separate x, y, z; output positions are in the observer's axes.
    ///
    /// Uses AVX2 and FMA where the processor has them. Coordinates must lie within 10^±150 (f64) or 10^±18
    /// (f32) of 1, or their squares leave the range of the number.
    ///
    /// # Panics
    /// If the slices differ in length.
    pub fn see_all<R: MapLane>(&self, rest: Points<'_, R>, seen: PointsMut<'_, R>) {
        R::run(self, rest, seen, true);
    }

    /// As [`see_all`](Self::see_all) in the instructions every x86-64 has, to measure one against the other.
    pub fn see_all_base<R: MapLane>(&self, rest: Points<'_, R>, seen: PointsMut<'_, R>) {
        R::run(self, rest, seen, false);
    }
}

/// What a direction of the observer's is in the rest frame of one body: the boost of the null vector (−L, v), v
/// along the line of sight and L its length.
///
/// It decides everything a line of sight can meet: D = L/L′ depends on the direction alone, and s·v meets the
/// body where s·v′ does in its rest frame, for one and the same s. L′ = ½[k(L + v·û) + (L − v·û)/k], with
/// L + v·û taken from the sine where it cancels: good to 4·10⁻¹⁶ at every γ.
#[derive(Clone, Copy, Debug)]
pub struct RestSky {
    axis: DVec3,
    k: f64,
    inverse_k: f64,
}

/// A boosted line of sight; across the motion it is what it was.
#[derive(Clone, Copy, Debug)]
pub struct BoostedSight {
    /// v′·û.
    pub along: f64,
    /// L′ = |v′|.
    pub length: f64,
}

impl RestSky {
    /// Unit vector of the motion, observer's axes.
    pub fn axis(&self) -> DVec3 {
        self.axis
    }

    /// What the boost multiplies L + v·û by, and 1 over it: what it multiplies L − v·û by.
    #[cfg(feature = "gpu")]
    pub(crate) fn stretches(&self) -> [f64; 2] {
        [self.k, self.inverse_k]
    }

    /// The line of sight `v` (observer's axes), whose length is `length`, in the rest frame.
    #[inline]
    pub fn boosted(&self, v: DVec3, length: f64) -> BoostedSight {
        self.boosted_parts(v.dot(self.axis), v.cross(self.axis).length_squared(), length)
    }

    /// The same as a vector, in the observer's axes, boosted along the motion.
    #[inline]
    pub fn boosted_direction(&self, v: DVec3, length: f64) -> DVec3 {
        v + (self.boosted(v, length).along - v.dot(self.axis)) * self.axis
    }

    /// As [`boosted`](Self::boosted), of a line of sight given by v·û and |v × û|².
    #[inline(always)]
    pub fn boosted_parts(&self, along: f64, across_squared: f64, length: f64) -> BoostedSight {
        let larger = length + along.abs();
        let smaller = across_squared / larger;
        let (plus, minus) = if along < 0.0 { (smaller, larger) } else { (larger, smaller) };
        let (plus, minus) = (self.k * plus, self.inverse_k * minus);
        BoostedSight { along: 0.5 * (plus - minus), length: 0.5 * (plus + minus) }
    }
}

/// A [`Lane`] the map has constants for.
pub trait MapLane: Lane {
    #[doc(hidden)]
    fn run(map: &ApparentMap, rest: Points<'_, Self>, seen: PointsMut<'_, Self>, vectors: bool);
}

impl MapLane for f64 {
    fn run(map: &ApparentMap, rest: Points<'_, f64>, seen: PointsMut<'_, f64>, vectors: bool) {
        if map.rotates {
            kernel::run::<f64, true>(&map.f64, rest, seen, vectors);
        } else {
            kernel::run::<f64, false>(&map.f64, rest, seen, vectors);
        }
    }
}

impl MapLane for f32 {
    fn run(map: &ApparentMap, rest: Points<'_, f32>, seen: PointsMut<'_, f32>, vectors: bool) {
        if map.rotates {
            kernel::run::<f32, true>(&map.f32, rest, seen, vectors);
        } else {
            kernel::run::<f32, false>(&map.f32, rest, seen, vectors);
        }
    }
}
