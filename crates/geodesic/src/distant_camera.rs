use crate::mino::{Constants, Pack, SIZE, place};
use crate::{BoyerLindquist, Event, FourVector, KerrSchild, Method, World};

/// A camera far from a rotating black hole, whose picture is told in impact parameters (Nollert et al. 2000,
/// section 3.3): the place (α, β) on the plane through the hole square to the line of sight where a straight
/// ray would pass, α to the right and β towards the axis of rotation.
///
/// It looks at the hole from azimuth 0 and sees light of energy 1 with L = −α sin ι and
/// Q = β² + (α² − a²) cos² ι; light with α > 0 passes where a hole with a > 0 turns away from the camera.
///
/// Source: J. M. Bardeen, in *Black Holes* (Les Houches 1972), p. 215.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistantCamera {
    hole: KerrSchild,
    inclination: f64,
    distance: f64,
}

/// Why a distant camera cannot be, or sees no such light.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum DistantCameraError {
    /// The inclination is not within 0 to π.
    #[error("the inclination {0} is not an angle from the axis, 0 to π")]
    Inclination(f64),
    /// The distance is not one outside of the horizon.
    #[error("the camera's distance {0} is not outside of the horizon")]
    Distance(f64),
    /// An impact parameter is not finite.
    #[error("the impact parameters ({0}, {1}) are not finite")]
    NotFinite(f64, f64),
    /// No light with these impact parameters comes as far as the camera.
    #[error(
        "light with impact parameters ({alpha}, {beta}) does not come as near as the camera's distance {distance}; put the camera farther away"
    )]
    OutOfReach {
        /// α.
        alpha: f64,
        /// β.
        beta: f64,
        /// Boyer–Lindquist radius of the camera.
        distance: f64,
    },
}

impl DistantCamera {
    /// A camera infinitely far away, `inclination` from the axis of rotation (0 to π).
    ///
    /// # Errors
    /// If the inclination is not such an angle.
    pub fn at_infinity(hole: KerrSchild, inclination: f64) -> Result<Self, DistantCameraError> {
        if !(0.0..=std::f64::consts::PI).contains(&inclination) {
            return Err(DistantCameraError::Inclination(inclination));
        }
        Ok(Self { hole, inclination, distance: f64::INFINITY })
    }

    /// A camera at a Boyer–Lindquist radius, at φ = 0 and t = 0. Its rays have the constants of motion that (α, β)
    /// have for a camera infinitely far away.
    ///
    /// # Errors
    /// If the inclination is not within 0 to π, or the distance not outside of the horizon.
    pub fn at_distance(
        hole: KerrSchild,
        inclination: f64,
        distance: f64,
    ) -> Result<Self, DistantCameraError> {
        if distance.is_nan() || distance <= hole.horizon() {
            return Err(DistantCameraError::Distance(distance));
        }
        Ok(Self { distance, ..Self::at_infinity(hole, inclination)? })
    }

    /// Where to begin following the light seen at (α, β), and its wave vector there, which points back along
    /// the light; frequencies are in units of that infinitely far away.
    ///
    /// From a camera at infinity the ray is taken up where it comes within 100 M and a few impact parameters, to
    /// rounding; the event's time is counted so that the light arrives at retarded time t − r = 0.
    ///
    /// # Errors
    /// If α or β is not finite, or such light never is at the camera's distance.
    pub fn ray(
        &self,
        alpha: f64,
        beta: f64,
    ) -> Result<(Event<World>, FourVector<World>), DistantCameraError> {
        if !(alpha.is_finite() && beta.is_finite()) {
            return Err(DistantCameraError::NotFinite(alpha, beta));
        }
        let hole = &self.hole;
        let a = hole.spin();
        let (sine, cosine) = self.inclination.sin_cos();
        let constants = Constants {
            angular_momentum: -alpha * sine,
            carter: beta * beta + (alpha * alpha - a * a) * cosine * cosine,
        };
        // N′ = −β e_θ + α e_φ: no pole even on the axis.
        let direction = [-beta * cosine, alpha, beta * sine];
        let begin = |w: f64, w_slope: f64, twist: f64| {
            let [x, y, z] = direction;
            [w, w_slope, sine, 0.0, cosine, x, y, z, twist]
        };
        if self.distance.is_finite() {
            let w = 1.0 / self.distance;
            let square = constants.radial(hole, w);
            if square < 0.0 {
                return Err(DistantCameraError::OutOfReach { alpha, beta, distance: self.distance });
            }
            let at = BoyerLindquist { t: 0.0, r: self.distance, theta: self.inclination, phi: 0.0 };
            let event = hole.from_boyer_lindquist(at);
            let here = hole.azimuth(at);
            let (_, k) = place(hole, constants, &begin(w, square.sqrt(), here));
            return Ok((event, k.into()));
        }
        let start = begin(0.0, 1.0, 0.0);
        let (state, retarded) = self.fall_in(constants, start, 100.0 * hole.mass() + 4.0 * alpha.hypot(beta));
        let ([_, x, y, z], k) = place(hole, constants, &state);
        Ok((Event::new(retarded + 1.0 / state[0], x, y, z), k.into()))
    }

    /// The state at radius `r` of a ray that begins at infinity, and the retarded time t − r there.
    ///
    /// (t − r)′ = −(1 + a²w²)(Q + (L − a)²)/(1 + a(a − L)w² + w′) − aL + a²(1 − N_z²), which stays finite.
    fn fall_in(&self, constants: Constants, start: [f64; SIZE], r: f64) -> ([f64; SIZE], f64) {
        let a = self.hole.spin();
        let l = constants.angular_momentum;
        let pack = Pack::new(&self.hole, [constants]);
        let f = |y: &[f64; SIZE + 1]| {
            let mut slope = pack.derivative(y);
            let (w2, nz) = (y[0] * y[0], y[4]);
            let binding = constants.carter + (l - a) * (l - a);
            slope[SIZE] = a * (a * (1.0 - nz * nz) - l)
                - (1.0 + a * a * w2) * binding / (1.0 + a * (a - l) * w2 + y[1]);
            slope
        };
        let mut y = [0.0; SIZE + 1];
        y[..SIZE].copy_from_slice(&start);
        // w ≈ λ: so few, and the ray turns by so little, that equal steps of order 8 are right to rounding.
        const STEPS: u32 = 8;
        let mut left = 1.0 / r;
        for step in (1..=STEPS).rev() {
            let h = left / f64::from(step);
            y = Method::Dop853.step(&f, &y, &f(&y), h).end;
            // What is left of w at the speed it has now.
            left = (1.0 / r - y[0]) / y[1];
        }
        let state = std::array::from_fn(|i| y[i]);
        (state, y[SIZE])
    }
}
