//! Light in a spacetime of one's own: a metric by its components alone, and the same by the second derivative of rays alone
//! (Nollert, Kraus and Ruder 2000, Eq. 6 and Fig. 7).
//!
//! ```sh
//! cargo run --release --example custom_metric
//! ```

use std::error::Error;
use terrell::geodesic::{Accuracy, Curved, End, Event, FourVector, Metric, Number, Ray, Spacetime};

/// A star of mass M in the weak field: g = diag(−(1 − 2M/r), 1 + 2M/r, 1 + 2M/r, 1 + 2M/r).
struct WeakField {
    mass: f64,
}

impl Metric for WeakField {
    fn covariant<S: Number>(&self, [_, x, y, z]: [S; 4]) -> [[S; 4]; 4] {
        let potential = S::from(2.0 * self.mass) / (x * x + y * y + z * z).sqrt();
        let zero = S::from(0.0);
        let (time, space) = (potential - 1.0, potential + 1.0);
        [
            [time, zero, zero, zero],
            [zero, space, zero, zero],
            [zero, zero, space, zero],
            [zero, zero, zero, space],
        ]
    }

    fn scale(&self) -> f64 {
        // Where it changes most for rays that pass outside of the star.
        1.0
    }
}

/// How far a ray is bent that passes at a distance, in either spacetime; and of how many straight pieces it is.
fn deflection(space: &impl Spacetime, impact: f64) -> Result<(f64, usize), Box<dyn Error>> {
    // Backwards in time, along −x from far away.
    let start = Event::new(0.0, 1e7, impact, 0.0);
    let k = FourVector::new(-1.0, -1.0, 0.0, 0.0);
    let mut ray = space.ray(start, k);
    let pieces = ray.by_ref().count();
    match ray.end() {
        Some(End::Sky { wave_vector }) => {
            let n = wave_vector.xyz().normalize();
            Ok((n.y.abs().atan2(-n.x), pieces))
        }
        end => Err(format!("the ray ended otherwise: {end:?}").into()),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mass = 1e-3;
    let accuracy = Accuracy::new(1e-11, 1e-3);
    let by_metric = Curved::metric(WeakField { mass }).with(accuracy);
    // The same to first order of M: ẍ = −2M (x k² − k (x·k))/r³, twice Newton's pull across the ray.
    let second = move |[_, x, y, z]: [f64; 4], [_, kx, ky, kz]: [f64; 4]| {
        let r2 = x * x + y * y + z * z;
        let pull = -2.0 * mass / (r2 * r2.sqrt());
        let (k2, along) = (kx * kx + ky * ky + kz * kz, x * kx + y * ky + z * kz);
        [0.0, pull * (x * k2 - kx * along), pull * (y * k2 - ky * along), pull * (z * k2 - kz * along)]
    };
    let by_second = Curved::second_derivative(second).with(accuracy);
    for impact in [1.0, 2.0, 5.0] {
        let ((a, pieces), (b, _)) = (deflection(&by_metric, impact)?, deflection(&by_second, impact)?);
        let einstein = 4.0 * mass / impact;
        println!(
            "at {impact}: bent by {a:.6} (g alone, {pieces} pieces), {b:.6} (second derivative alone); 4M/b is {einstein:.6}"
        );
    }
    Ok(())
}
