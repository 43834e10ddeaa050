//! How fast and how accurately rays of a rotating black hole are followed, each way this crate can.
//!
//! `cargo bench -p terrell-geodesic` prints the tables of docs/curved-light.md; one thread, so rays/s are
//! rays/s/core.

use std::hint::black_box;
use std::time::Instant;
use terrell_geodesic::{
    Accuracy, ByMetric, BySecondDerivative, Curved, DistantCamera, Dual, End, Event, FourVector, KerrSchild,
    KerrSky, Law, Method, Metric, Ray, Segment, Spacetime, World,
};

const SPIN: f64 = 0.9;
const TAU: f64 = std::f64::consts::TAU;

type Start = (Event<World>, FourVector<World>);

/// A square of rays by impact parameters ±9 M seen from radius `r`, 60° from the axis.
fn rays(r: f64, side: u32) -> Vec<Start> {
    let hole = KerrSchild::new(1.0, SPIN).unwrap();
    let camera = DistantCamera::at_distance(hole, TAU / 6.0, r).unwrap();
    let at = |i: u32| 18.0 * ((f64::from(i) + 0.5) / f64::from(side) - 0.5);
    (0..side * side).map(|i| camera.ray(at(i % side), at(i / side)).unwrap()).collect()
}

/// Seconds of processor time this thread has had; where the system does not tell, seconds of the clock.
fn processor_time(start: &Instant) -> f64 {
    std::fs::read_to_string("/proc/thread-self/schedstat")
        .ok()
        .and_then(|text| text.split(' ').next()?.parse::<f64>().ok())
        .map_or_else(|| start.elapsed().as_secs_f64(), |nanoseconds| 1e-9 * nanoseconds)
}

/// Seconds of processor time a call takes, the best of several runs; each is long beside the few milliseconds by
/// which the system counts.
fn seconds(mut work: impl FnMut()) -> f64 {
    let clock = Instant::now();
    work();
    let repeats = (0.25 / clock.elapsed().as_secs_f64()).clamp(1.0, 1e6) as u32;
    (0..5)
        .map(|_| {
            let start = processor_time(&clock);
            for _ in 0..repeats {
                work();
            }
            (processor_time(&clock) - start) / f64::from(repeats)
        })
        .fold(f64::INFINITY, f64::min)
}

/// What one way of following all rays amounts to.
struct Row {
    name: String,
    rays_per_second: f64,
    evaluations: Option<f64>,
    steps: Option<f64>,
    chords: Option<f64>,
    errors: Vec<f64>,
    /// Rays that ended otherwise than the reference.
    otherwise: usize,
}

fn print(title: &str, unit: &str, rows: &mut [Row]) {
    println!("\n{title}\n");
    println!(
        "| way | krays/s/core | µs a ray | evaluations | steps | chords | median error, {unit} | 99 % | worst | ended otherwise |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for row in rows {
        row.errors.sort_by(f64::total_cmp);
        let at = |part: f64| row.errors[((row.errors.len() - 1) as f64 * part) as usize];
        let count = |value: Option<f64>| value.map_or_else(|| "–".into(), |value| format!("{value:.1}"));
        println!(
            "| {} | {:.1} | {:.2} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} | {} |",
            row.name,
            row.rays_per_second / 1e3,
            1e6 / row.rays_per_second,
            count(row.evaluations),
            count(row.steps),
            count(row.chords),
            at(0.5),
            at(0.99),
            at(1.0),
            row.otherwise
        );
    }
}

fn sky_errors(found: &[End], exact: &[End]) -> (Vec<f64>, usize) {
    let mut errors = Vec::new();
    let mut otherwise = 0;
    for pair in found.iter().zip(exact) {
        match pair {
            (End::Sky { wave_vector: a }, End::Sky { wave_vector: b }) => {
                errors.push((a.xyz().normalize() - b.xyz().normalize()).length());
            }
            (a, b) => otherwise += usize::from(a != b),
        }
    }
    (errors, otherwise)
}

/// Every ray to the sky or the horizon.
fn to_the_sky<L: Law>(name: &str, space: &Curved<L>, rays: &[Start], exact: &[End]) -> Row {
    let ends: Vec<End> = rays.iter().map(|&(event, k)| space.ray(event, k).follow()).collect();
    let (errors, otherwise) = sky_errors(&ends, exact);
    let (mut evaluations, mut steps) = (0.0, 0.0);
    for &(event, k) in rays {
        let mut ray = space.ray(event, k);
        ray.follow();
        evaluations += f64::from(ray.monitor().evaluations);
        steps += f64::from(ray.monitor().steps);
    }
    let time = seconds(|| {
        for &(event, k) in rays {
            black_box(space.ray(event, k).follow());
        }
    });
    let count = rays.len() as f64;
    Row {
        name: name.into(),
        rays_per_second: count / time,
        evaluations: Some(evaluations / count),
        steps: Some(steps / count),
        chords: None,
        errors,
        otherwise,
    }
}

/// The first equatorial crossing within 40 M; the end of the ray if there is none.
fn disc_hit<L: Law>(space: &Curved<L>, hole: &KerrSchild, (event, k): Start) -> (Option<[f64; 4]>, [f64; 3]) {
    let mut ray = space.ray(event, k);
    let mut hit = None;
    while let Some(Segment { start, direction, from, length }) = ray.next() {
        let (z, slope) = (start.position().z, direction.space[2]);
        if length.is_infinite() || z * (z + slope * length) > 0.0 || z == 0.0 {
            continue;
        }
        // Newton on the exact ray, from where its chord crosses.
        let mut s = from - z / slope;
        for _ in 0..4 {
            let (at, k) = ray.at(s);
            s -= at.position().z / k.space[2];
        }
        let at = ray.at(s).0;
        if hole.radius(at.position().to_array()) < 40.0 {
            hit = Some(at.coordinates().into());
            break;
        }
    }
    let monitor = ray.monitor();
    (hit, [monitor.evaluations.into(), monitor.steps.into(), monitor.segments.into()])
}

fn to_the_disc<L: Law>(name: &str, space: &Curved<L>, rays: &[Start], exact: &[Option<[f64; 4]>]) -> Row {
    let hole = KerrSchild::new(1.0, SPIN).unwrap();
    let mut errors = Vec::new();
    let mut otherwise = 0;
    let mut sums = [0.0; 3];
    for (&ray, exact) in rays.iter().zip(exact) {
        let (hit, costs) = disc_hit(space, &hole, ray);
        for (sum, cost) in sums.iter_mut().zip(costs) {
            *sum += cost / rays.len() as f64;
        }
        match (hit, exact) {
            (Some([_, x, y, z]), Some([_, a, b, c])) => {
                let off = ((x - a).powi(2) + (y - b).powi(2) + (z - c).powi(2)).sqrt();
                errors.push(off / (a * a + b * b + c * c).sqrt());
            }
            (a, b) => otherwise += usize::from(a.is_some() != b.is_some()),
        }
    }
    let time = seconds(|| {
        for &ray in rays {
            black_box(disc_hit(space, &hole, ray));
        }
    });
    Row {
        name: name.into(),
        rays_per_second: rays.len() as f64 / time,
        evaluations: Some(sums[0]),
        steps: Some(sums[1]),
        chords: Some(sums[2]),
        errors,
        otherwise,
    }
}

/// −Γ^μ_αβ k^α k^β of Kerr, as a user might write it who has only derivatives of g: what the second derivative
/// costs when it is not worked out by hand.
fn christoffel(hole: KerrSchild) -> impl Fn([f64; 4], [f64; 4]) -> [f64; 4] + Sync {
    move |x, k| {
        let g = Metric::covariant(&hole, Dual::coordinates(x));
        // ∂_ν g_μα k^ν k^α − ½ ∂_μ g_αβ k^α k^β, then the index raised by g⁻¹ = η − f l l.
        let mut lowered = [0.0; 4];
        for m in 0..4 {
            for a in 0..4 {
                let along: f64 = (0..4).map(|n| g[m][a].gradient[n] * k[n]).sum();
                lowered[m] -= along * k[a];
                for b in 0..4 {
                    lowered[m] += 0.5 * g[a][b].gradient[m] * k[a] * k[b];
                }
            }
        }
        // g_tμ = η_tμ + f l_μ with l_t = 1.
        let f = g[0][0].value + 1.0;
        let l = [1.0, g[0][1].value / f, g[0][2].value / f, g[0][3].value / f];
        let raised = [-1.0, l[1], l[2], l[3]];
        let dot: f64 = (0..4).map(|i| raised[i] * lowered[i]).sum();
        std::array::from_fn(|i| if i == 0 { -lowered[0] } else { lowered[i] } - f * dot * raised[i])
    }
}

fn main() {
    let hole = KerrSchild::new(1.0, SPIN).unwrap();
    let accuracy = |tolerance| Accuracy::new(tolerance, 0.01);
    let dopri5 = |tolerance| Accuracy { method: Method::Dopri5, ..accuracy(tolerance) };
    let by_second = |tolerance| {
        Curved::new(BySecondDerivative::new(christoffel(hole)).with_metric(hole)).with(accuracy(tolerance))
    };

    let near = rays(50.0, 48);
    let exact = KerrSky::new(hole, 1e-14).trace(&near);
    let mut rows = Vec::new();
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let metric = Curved::new(ByMetric(hole)).with(accuracy(tolerance));
        rows.push(to_the_sky(&format!("g alone, DOP853 {tolerance:e}"), &metric, &near, &exact));
    }
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let by_hand = Curved::new(hole).with(accuracy(tolerance));
        rows.push(to_the_sky(&format!("by hand, DOP853 {tolerance:e}"), &by_hand, &near, &exact));
    }
    let metric = Curved::new(ByMetric(hole)).with(dopri5(1e-6));
    rows.push(to_the_sky("g alone, DOPRI5 1e-6", &metric, &near, &exact));
    rows.push(to_the_sky("second derivative alone, DOP853 1e-8", &by_second(1e-8), &near, &exact));
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let sky = KerrSky::new(hole, tolerance);
        for (name, baseline) in [("lanes, baseline", true), ("lanes, best the processor has", false)] {
            let trace = |rays: &[Start]| if baseline { sky.trace_baseline(rays) } else { sky.trace(rays) };
            let (errors, otherwise) = sky_errors(&trace(&near), &exact);
            let time = seconds(|| {
                black_box(trace(&near));
            });
            rows.push(Row {
                name: format!("{name} {tolerance:e}"),
                rays_per_second: near.len() as f64 / time,
                evaluations: None,
                steps: None,
                chords: None,
                errors,
                otherwise,
            });
        }
    }
    print("Kerr a = 0.9, from r = 50 M to the sky or the horizon", "rad", &mut rows);

    let far = rays(1000.0, 24);
    let reference = Curved::new(hole).with(accuracy(1e-13));
    let exact: Vec<_> = far.iter().map(|&ray| disc_hit(&reference, &hole, ray).0).collect();
    let mut rows = Vec::new();
    for tolerance in [1e-5, 3e-6, 1e-6, 1e-7, 1e-8, 5e-9, 1e-9, 1e-10] {
        let metric = Curved::new(ByMetric(hole)).with(accuracy(tolerance));
        rows.push(to_the_disc(&format!("g alone, DOP853 {tolerance:e}"), &metric, &far, &exact));
    }
    for tolerance in [1e-6, 1e-8, 1e-10] {
        let by_hand = Curved::new(hole).with(accuracy(tolerance));
        rows.push(to_the_disc(&format!("by hand, DOP853 {tolerance:e}"), &by_hand, &far, &exact));
    }
    for tolerance in [1e-6, 1e-7] {
        let metric = Curved::new(ByMetric(hole)).with(dopri5(tolerance));
        rows.push(to_the_disc(&format!("g alone, DOPRI5 {tolerance:e}"), &metric, &far, &exact));
    }
    rows.push(to_the_disc("second derivative alone, DOP853 1e-8", &by_second(1e-8), &far, &exact));
    print(
        "Kerr a = 0.9, from r = 1000 M to the first crossing of the equator within 40 M, in chords of 0.01 M",
        "of r",
        &mut rows,
    );
}
