//! A spacetime of your own from the second derivative of light's path alone (Nollert et al. 2000, Fig. 7): a mass
//! in Schwarzschild's coordinates, and how far it turns light that passes it.
//!
//! `cargo run --release -p terrell-geodesic --example second_derivative`

use glam::DVec3;
use terrell_geodesic::{Curved, End, Event, FourVector, Spacetime};

fn main() {
    // ẍ = −3 L² x/r⁵ in space, with L = x × ẋ; ẗ = −(2/r²) ṙ ṫ/(1 − 2/r). M = 1.
    let space = Curved::second_derivative(|[_, x, y, z], [t_rate, a, b, c]| {
        let (place, rate) = (DVec3::new(x, y, z), DVec3::new(a, b, c));
        let r = place.length();
        let pull = place * (-3.0 * place.cross(rate).length_squared() / r.powi(5));
        let slowing = -2.0 / (r * r) * (place.dot(rate) / r) * t_rate / (1.0 - 2.0 / r);
        [slowing, pull.x, pull.y, pull.z]
    });
    println!("{:>8} {:>14} {:>14}  segments", "passes at", "turns by", "4/b");
    for b in [100.0, 30.0, 10.0, 7.0, 5.5, 5.0] {
        let start = Event::new(0.0, 1e6, b, 0.0);
        let k = FourVector::seen_from(-DVec3::X);
        let mut ray = space.ray(start, k);
        let end = ray.follow();
        let segments = space.ray(start, k).count();
        match end {
            End::Sky { wave_vector } => {
                let turn = (-DVec3::X).angle_between(wave_vector.xyz());
                println!("{b:8} {turn:14.9} {:14.9}  {segments}", 4.0 / b);
            }
            // Nothing here knows of a horizon, so what falls in is told as what it is.
            other => println!("{b:8} the ray {other}"),
        }
    }
}
