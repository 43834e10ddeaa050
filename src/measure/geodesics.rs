use super::{Times, interleaved, schwarzschild_deflection};
use glam::DVec3;
use std::convert::Infallible;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::hint::black_box;
use std::time::Duration;
use terrell_geodesic::{
    Accuracy, ByMetric, Curved, DistantCamera, End, Event, FourVector, KerrSchild, KerrSky, Law, Method, Ray,
    Segment, Spacetime, World,
};

/// Which ways of following light past a black hole are compared, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct GeodesicSweep {
    /// Spins of the holes, of mass 1, −1 to 1.
    pub spins: Vec<f64>,
    /// Errors allowed in a step; see [`Accuracy::tolerance`].
    pub tolerances: Vec<f64>,
    /// How far chords may be from the ray, masses; see [`Accuracy::sagitta`].
    pub sagittas: Vec<f64>,
    /// Rays, of impact parameters from [`NEAREST`](Self::NEAREST) to [`FARTHEST`](Self::FARTHEST).
    pub rays: u32,
    /// How often each is timed.
    pub repeats: u32,
}

/// What a way of following light amounts to.
#[derive(Clone, Debug)]
pub struct GeodesicPoint {
    /// The hole's spin.
    pub spin: f64,
    /// How its law is known: "g alone", "by hand", or "lanes", where several rays share a register.
    pub law: &'static str,
    /// The integrator.
    pub method: Method,
    /// Error allowed in a step.
    pub tolerance: f64,
    /// ε, if chords were laid along the rays.
    pub sagitta: Option<f64>,
    /// Time of a ray, on one thread.
    pub times: Times,
    /// Mean number of chords of a ray, if there were any.
    pub chords: Option<f64>,
    /// Of chords their distance from the ray, masses; else what rays are off by on the sky, radians.
    pub worst: f64,
    /// Likewise, root of the mean square over rays (of chords: of each ray's worst).
    pub rms: f64,
    /// Rays that were not followed to the sky.
    pub lost: usize,
}

type Start = (Event<World>, FourVector<World>);

/// A way of following all rays.
struct Way<'a> {
    spin: f64,
    law: &'static str,
    accuracy: Accuracy,
    /// Whether chords are laid along them.
    chords: bool,
    rays: &'a [Start],
    follow: Box<dyn Fn() + 'a>,
    measure: Box<dyn Fn() -> Measured + 'a>,
}

/// How far rays, or their chords, are off.
struct Measured {
    errors: Vec<f64>,
    chords: Option<f64>,
    lost: usize,
}

impl Default for GeodesicSweep {
    fn default() -> Self {
        Self {
            spins: vec![0.0, 0.9],
            tolerances: (2..=6).map(|n| 10f64.powi(-2 * n)).collect(),
            sagittas: vec![1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001],
            rays: 64,
            repeats: 11,
        }
    }
}

impl GeodesicSweep {
    /// The least impact parameter, masses: 5 % above the one that is captured by a hole that does not rotate.
    pub const NEAREST: f64 = 5.5;
    /// The greatest.
    pub const FARTHEST: f64 = 40.0;
    /// Of the rays whose chords are measured.
    pub const CHORD_TOLERANCE: f64 = 1e-8;

    /// Measures all of them: times, interleaved, and what rays that come from infinity are off by on the sky. Without
    /// rotation that is told by the closed form ([`schwarzschild_deflection`]), else by rays followed by other equations,
    /// those of [`KerrSky`], to 10⁻¹⁴. `done` hears of parts of the work, and of how many there are.
    ///
    /// # Panics
    /// If there are no rays, or a spin is not within −1 to 1.
    pub fn run(&self, mut done: impl FnMut(usize)) -> Vec<GeodesicPoint> {
        assert!(self.rays > 0, "rays to be followed");
        let holes: Vec<KerrSchild> = self
            .spins
            .iter()
            .map(|spin| KerrSchild::new(1.0, *spin).expect("spins within −1 to 1"))
            .collect();
        let rays: Vec<Vec<Start>> = holes.iter().map(|hole| self.starts(*hole)).collect();
        let exact: Vec<Vec<End>> =
            holes.iter().zip(&rays).map(|(hole, rays)| self.exact(*hole, rays)).collect();
        let mut ways = Vec::new();
        for ((hole, rays), exact) in holes.iter().zip(&rays).zip(&exact) {
            self.add_ways(&mut ways, *hole, rays, exact);
        }
        let all = ways.len() * (self.repeats.max(1) as usize + 1);
        let run = |way: usize| {
            (ways[way].follow)();
            Ok::<_, Infallible>(())
        };
        let Ok(times) = interleaved(ways.len(), self.repeats, Duration::MAX, run, || done(all));
        ways.iter().zip(times).map(|(way, times)| way.point(&times)).collect()
    }

    /// An impact parameter a ray, evenly by its logarithm.
    fn impact(&self, ray: u32) -> f64 {
        let part = (f64::from(ray) + 0.5) / f64::from(self.rays);
        Self::NEAREST * (Self::FARTHEST / Self::NEAREST).powf(part)
    }

    /// Without rotation in one plane, else from all around the hole.
    fn starts(&self, hole: KerrSchild) -> Vec<Start> {
        let (inclination, turn) =
            if hole.spin() == 0.0 { (FRAC_PI_2, 0.0) } else { (TAU / 6.0, GOLDEN_ANGLE) };
        let camera = DistantCamera::at_infinity(hole, inclination).expect("an inclination within 0 to π");
        let start = |ray: u32| {
            let (sine, cosine) = (turn * f64::from(ray)).sin_cos();
            let b = self.impact(ray);
            camera.ray(b * cosine, b * sine).expect("light that comes from infinity")
        };
        (0..self.rays).map(start).collect()
    }

    fn exact(&self, hole: KerrSchild, rays: &[Start]) -> Vec<End> {
        let known = KerrSky::new(hole, 1e-14).trace(rays);
        if hole.spin() != 0.0 {
            return known;
        }
        // Only on which side the light passes is taken from there.
        let turned = |(ray, end): (u32, End)| {
            let (sine, cosine) = schwarzschild_deflection(self.impact(ray)).sin_cos();
            let side = direction(&end).map_or(1.0, |n| n.y.signum());
            End::Sky { wave_vector: FourVector::from_parts(1.0, DVec3::new(-cosine, side * sine, 0.0)) }
        };
        (0..).zip(known).map(turned).collect()
    }

    fn add_ways<'a>(&self, ways: &mut Vec<Way<'a>>, hole: KerrSchild, rays: &'a [Start], exact: &'a [End]) {
        for method in [Method::Dop853, Method::Dopri5] {
            for &tolerance in &self.tolerances {
                let accuracy = Accuracy { method, ..Accuracy::new(tolerance, 1.0) };
                let (metric, by_hand) = (Curved::new(ByMetric(hole)), Curved::new(hole));
                ways.push(of_rays(hole, "g alone", metric.with(accuracy), rays, exact));
                ways.push(of_rays(hole, "by hand", by_hand.with(accuracy), rays, exact));
            }
            for &sagitta in &self.sagittas {
                let accuracy = Accuracy { method, ..Accuracy::new(Self::CHORD_TOLERANCE, sagitta) };
                let (metric, by_hand) = (Curved::new(ByMetric(hole)), Curved::new(hole));
                ways.push(of_chords(hole, "g alone", metric.with(accuracy), rays));
                ways.push(of_chords(hole, "by hand", by_hand.with(accuracy), rays));
            }
        }
        for &tolerance in &self.tolerances {
            let sky = KerrSky::new(hole, tolerance);
            ways.push(Way {
                spin: hole.spin(),
                law: "lanes",
                accuracy: Accuracy::new(tolerance, 1.0),
                chords: false,
                rays,
                follow: Box::new(move || drop(black_box(sky.trace(rays)))),
                measure: Box::new(move || on_the_sky(&sky.trace(rays), exact)),
            });
        }
    }
}

impl Way<'_> {
    fn point(&self, times: &Times) -> GeodesicPoint {
        let Measured { errors, chords, lost } = (self.measure)();
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        GeodesicPoint {
            spin: self.spin,
            law: self.law,
            method: self.accuracy.method,
            tolerance: self.accuracy.tolerance,
            sagitta: self.chords.then_some(self.accuracy.sagitta),
            times: times.divided(self.rays.len() as u32),
            chords,
            worst: errors.iter().copied().fold(0.0, f64::max),
            rms: (squares / errors.len().max(1) as f64).sqrt(),
            lost,
        }
    }
}

/// Between rays around a hole: none is seen from the same side as another.
const GOLDEN_ANGLE: f64 = TAU * 0.381_966_011_250_105_2;

fn direction(end: &End) -> Option<DVec3> {
    if let End::Sky { wave_vector } = end { Some(wave_vector.xyz().normalize()) } else { None }
}

fn on_the_sky(found: &[End], exact: &[End]) -> Measured {
    let (mut errors, mut lost) = (Vec::new(), 0);
    for (found, exact) in found.iter().zip(exact) {
        match (direction(found), direction(exact)) {
            (Some(a), Some(b)) => errors.push(a.distance(b)),
            _ => lost += usize::from(found != exact),
        }
    }
    Measured { errors, chords: None, lost }
}

fn of_rays<'a, L: Law + Copy + 'a>(
    hole: KerrSchild,
    law: &'static str,
    space: Curved<L>,
    rays: &'a [Start],
    exact: &'a [End],
) -> Way<'a> {
    let ends = move || rays.iter().map(|&(event, k)| space.ray(event, k).follow()).collect::<Vec<_>>();
    Way {
        spin: hole.spin(),
        law,
        accuracy: space.accuracy(),
        chords: false,
        rays,
        follow: Box::new(move || drop(black_box(ends()))),
        measure: Box::new(move || on_the_sky(&ends(), exact)),
    }
}

fn of_chords<'a, L: Law + Copy + 'a>(
    hole: KerrSchild,
    law: &'static str,
    space: Curved<L>,
    rays: &'a [Start],
) -> Way<'a> {
    let follow = move || {
        for &(event, k) in rays {
            space.ray(event, k).for_each(|segment| {
                black_box(segment);
            });
        }
    };
    Way {
        spin: hole.spin(),
        law,
        accuracy: space.accuracy(),
        chords: true,
        rays,
        follow: Box::new(follow),
        measure: Box::new(move || beside_chords(&space, rays)),
    }
}

/// How far rays are from their chords at most, at seven places of each.
fn beside_chords<L: Law>(space: &Curved<L>, rays: &[Start]) -> Measured {
    let (mut errors, mut chords, mut lost) = (Vec::new(), 0u32, 0);
    for &(event, k) in rays {
        let (mut ray, mut worst) = (space.ray(event, k), 0.0);
        while let Some(segment) = ray.next() {
            if segment.length.is_finite() {
                worst = (1..8).map(|i| off_chord(&ray, &segment, f64::from(i) / 8.0)).fold(worst, f64::max);
            }
        }
        errors.push(worst);
        chords += ray.monitor().segments;
        lost += usize::from(ray.end().is_none_or(|end| end.is_failure()));
    }
    Measured { errors, chords: Some(f64::from(chords) / rays.len() as f64), lost }
}

fn off_chord(ray: &impl Ray, segment: &Segment, part: f64) -> f64 {
    let s = segment.from + part * segment.length;
    let off = ray.at(s).0.position() - segment.at(s).position();
    off.reject_from(segment.direction.xyz()).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_go_with_tolerances_and_chords_keep_their_distance() {
        let sweep = GeodesicSweep {
            spins: vec![0.0, 0.9],
            tolerances: vec![1e-6, 1e-10],
            sagittas: vec![0.1, 0.01],
            rays: 8,
            repeats: 1,
        };
        let points = sweep.run(|_| ());
        assert_eq!(points.len(), 2 * (2 * 2 * (2 + 2) + 2));
        for point in &points {
            assert_eq!(point.lost, 0, "{point:?}");
            match point.sagitta {
                // Errors of whole rays are of the tolerance's size or a little more; what is left of the light cone at
                // impact parameters so near the critical one is amplified by b/(b − b_c), some 20.
                None => assert!(point.worst < 100.0 * point.tolerance, "{point:?}"),
                Some(sagitta) => assert!(point.worst <= sagitta && point.worst > 0.1 * sagitta, "{point:?}"),
            }
        }
    }
}
