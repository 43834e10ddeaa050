//! nullgeo 0.2 on the second task of benches/geodesics.rs: Kerr a = 0.9, camera at r = 1000 M and 60° from the
//! axis, 24 × 24 rays within 0.02 rad, to the first crossing of the equator between 2.4 M and 40 M.
//!
//! Errors are against its own rays at a tolerance of 1e-13.

use nullgeo::geometry::Vec4;
use nullgeo::integrator::Tolerances;
use nullgeo::spacetimes::Kerr;
use nullgeo::{
    Camera, CameraPose, CameraSpec, EquatorialAnnulus, PhasePoint, Termination, TraceConfig, trace,
};
use std::time::Instant;

fn config(tolerance: f64, longest: f64) -> TraceConfig {
    TraceConfig {
        tol: Tolerances { rtol: tolerance, atol: tolerance },
        dl_max: longest,
        dl_init: longest.min(100.0),
        escape_radius: 1100.0,
        disk: Some(EquatorialAnnulus { r_in: 2.4, r_out: 40.0 }),
        ..TraceConfig::default()
    }
}

fn hits(kerr: &Kerr, rays: &[PhasePoint], config: &TraceConfig) -> Vec<Option<Vec4>> {
    rays.iter()
        .map(|&ray| match trace(kerr, ray, config) {
            Termination::HitSurface { state } => Some(state.x),
            _ => None,
        })
        .collect()
}

/// Seconds of processor time this thread has had; where the system does not tell, seconds of the clock.
fn processor_time(start: &Instant) -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse::<f64>().ok())
        .map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

fn main() {
    let clock = Instant::now();
    let kerr = Kerr::new(1.0, 0.9).expect("a black hole");
    let (sine, cosine) = (std::f64::consts::FRAC_PI_3).sin_cos();
    let camera = Camera::new(
        CameraSpec {
            fov_deg: 0.02f64.to_degrees(),
            res: (24, 24),
            energy: 1.0,
            supersample: 1,
            supersample_max: 1,
            jitter: false,
        },
        CameraPose {
            position: Vec4::new(0.0, 1000.0 * sine, 0.0, 1000.0 * cosine),
            look_at: [0.0; 3],
            up: [0.0, 0.0, 1.0],
            velocity: [0.0; 3],
        },
    )
    .expect("a camera");
    let rays = camera.pixel_rays(&kerr).expect("rays");
    let exact = hits(&kerr, &rays, &config(1e-13, 5.0));
    println!(
        "| tolerance | longest step | µs a ray | median error, of r | 99 % | worst | hits | ended otherwise |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (tolerance, longest) in
        [(1e-9, 5.0), (1e-5, 1e3), (1e-6, 1e3), (1e-7, 1e3), (1e-8, 1e3), (1e-9, 1e3), (1e-10, 1e3)]
    {
        let config = config(tolerance, longest);
        let found = hits(&kerr, &rays, &config);
        let mut errors: Vec<f64> = found
            .iter()
            .zip(&exact)
            .filter_map(|pair| match pair {
                (Some(a), Some(b)) => {
                    let off = |i: usize| (a[i] - b[i]).powi(2);
                    let size = |i: usize| b[i].powi(2);
                    Some(((off(1) + off(2) + off(3)) / (size(1) + size(2) + size(3))).sqrt())
                }
                _ => None,
            })
            .collect();
        errors.sort_by(f64::total_cmp);
        let otherwise = found.iter().zip(&exact).filter(|(a, b)| a.is_some() != b.is_some()).count();
        let best = (0..8)
            .map(|_| {
                let start = processor_time(&clock);
                for _ in 0..3 {
                    std::hint::black_box(hits(&kerr, &rays, &config));
                }
                (processor_time(&clock) - start) / 3.0
            })
            .fold(f64::INFINITY, f64::min);
        let at = |part: f64| errors[((errors.len() - 1) as f64 * part) as usize];
        println!(
            "| {tolerance:e} | {longest} | {:.1} | {:.1e} | {:.1e} | {:.1e} | {} | {otherwise} |",
            1e6 * best / rays.len() as f64,
            at(0.5),
            at(0.99),
            at(1.0),
            errors.len()
        );
    }
}
