//! The straight segments laid along rays: as near as promised, and no more of them than needed.

mod common;

use common::{number, reference, rows};
use glam::DVec3;
use proptest::prelude::*;
use terrell_geodesic::{
    Accuracy, Curved, DistantCamera, End, Event, KerrSchild, LightRay, Ray, Segment, Spacetime,
};

fn hole(accuracy: Accuracy) -> Curved<KerrSchild> {
    Curved::kerr(1.0, 0.0).unwrap().with(accuracy)
}

fn segments(space: &Curved<KerrSchild>, r: f64, b: f64) -> (Vec<Segment>, LightRay<'_, KerrSchild>) {
    let camera = DistantCamera::at_distance(*space.law(), 90f64.to_radians(), r).unwrap();
    let (event, k) = camera.ray(b, 0.0).unwrap();
    let mut ray = space.ray(event, k);
    (ray.by_ref().collect(), ray)
}

/// Within 1.3 of the fewest chords that any choice of ends could do with, and of course not below.
#[test]
fn there_are_as_few_chords_as_can_be() {
    for row in rows(&reference("chord_count_optimal")["rows"]) {
        let b = number(&row["b"]);
        for (name, sagitta) in
            [("N_eps_0.1", 0.1), ("N_eps_0.01", 0.01), ("N_eps_0.001", 0.001), ("N_eps_0.0001", 1e-4)]
        {
            let fewest = number(&row[name]);
            let space = hole(Accuracy::new(1e-9, sagitta));
            let (segments, _) = segments(&space, 60.0, b);
            // Chords that begin within r = 60, the last one as far as it is within.
            let mut count = 0.0;
            for segment in segments {
                let (start, end) =
                    (segment.start.position().length(), segment.at(segment.to()).position().length());
                if start > 60.0 * (1.0 + 1e-12) {
                    break;
                }
                count += if end > 60.0 { ((60.0 - start) / (end - start)).clamp(0.0, 1.0) } else { 1.0 };
            }
            assert!(count < 1.3 * fewest, "b {b} ε {sagitta}: {count} chords where {fewest} would do");
            // The count for ever smaller pieces may be beaten by less than one whole chord.
            assert!(count > fewest - 1.0, "b {b} ε {sagitta}: {count} chords are fewer than {fewest}");
        }
    }
}

/// Distance from the exact ray to the chord, and of the times, anywhere on it.
fn check(space: &Curved<KerrSchild>, ray: &mut LightRay<'_, KerrSchild>) -> usize {
    let mut last: Option<Segment> = None;
    let mut count = 0;
    while let Some(segment) = ray.next() {
        count += 1;
        if let Some(last) = last {
            // from + length, rounded.
            assert!((last.to() - segment.from).abs() <= 2.0 * f64::EPSILON * segment.from);
            let gap = last.at(last.to()) - segment.start;
            // The same event, but for the rounding of start + length · direction.
            let size = 1.0 + segment.start.position().length() + segment.start.t().abs();
            assert!(gap.xyz().length() < 1e-13 * size && gap.t.abs() < 1e-13 * size, "{gap:?}");
        } else {
            assert_eq!(segment.from, 0.0);
        }
        last = Some(segment);
        if segment.length.is_infinite() {
            break;
        }
        assert!(segment.length > 0.0);
        let along = segment.direction.xyz().normalize();
        for part in 0..=60 {
            let s = segment.from + segment.length * f64::from(part) / 60.0;
            let off = ray.at(s).0 - segment.at(s);
            let aside = off.xyz().reject_from_normalized(along).length();
            assert!(aside <= space.sagitta(), "{aside:e} off, of {:e} allowed", space.sagitta());
            assert!(off.t.abs() <= space.lag());
        }
    }
    count
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]
    #[test]
    fn no_chord_is_farther_from_the_ray_than_allowed(
        spin in -1.0..=1.0f64, inclination in 0.0..3.1f64, r in 3.0..3000.0f64,
        alpha in -1.0..1.0f64, beta in -1.0..1.0f64, digits in 1.0..5.0f64, tolerance in 4.0..11.0f64,
    ) {
        let accuracy = Accuracy::new(10f64.powf(-tolerance), 10f64.powf(-digits));
        let space = Curved::new(KerrSchild::new(1.0, spin).unwrap()).with(accuracy);
        let camera = DistantCamera::at_distance(*space.law(), inclination, r).unwrap();
        let size = 12f64.min(0.7 * r);
        if let Ok((event, k)) = camera.ray(size * alpha, size * beta) {
            let mut ray = space.ray(event, k);
            let count = check(&space, &mut ray);
            prop_assert!(!ray.end().unwrap().is_failure());
            prop_assert_eq!(count as u32, ray.monitor().segments);
            // Followed without chords it ends as with them.
            let end = space.ray(event, k).follow();
            match (ray.end().unwrap(), end) {
                (End::Sky { wave_vector: a }, End::Sky { wave_vector: b }) => prop_assert_eq!(a, b),
                (a, b) => prop_assert_eq!(a, b),
            }
        }
    }
}

#[test]
fn far_from_the_mass_one_chord_is_enough() {
    // Looking away from the hole, with an impact parameter of 10.
    let space = hole(Accuracy { lag: f64::INFINITY, ..Accuracy::new(1e-8, 0.01) });
    let (outward, _) = {
        let event = Event::new(0.0, 1e4, 0.0, 0.0);
        let k = common::null_to_past(&space, event, DVec3::new(1.0, 0.001, 0.0));
        let mut ray = space.ray(event, k);
        (ray.by_ref().collect::<Vec<_>>(), ray)
    };
    // One to where nothing is left to bend it, and the one to infinity.
    assert!(outward.len() <= 2, "{}", outward.len());
    // The way from r = 1e5 down to r = 100 is nearly straight.
    let (inward, _) = segments(&space, 1e5, 6.0);
    assert!(inward[0].at(inward[0].to()).position().length() < 200.0, "{:?}", inward[0]);
}

#[test]
fn chords_grow_like_one_over_the_root_of_the_sagitta() {
    let count = |sagitta: f64| segments(&hole(Accuracy::new(1e-9, sagitta)), 60.0, 6.0).0.len() as f64;
    let ratio = count(1e-6) / count(1e-4);
    assert!((ratio - 10.0).abs() < 0.5, "{ratio}");
}

#[test]
fn time_may_be_kept_as_well() {
    let loose = hole(Accuracy::new(1e-9, 0.1));
    let strict = hole(Accuracy { lag: 1e-3, ..Accuracy::new(1e-9, 0.1) });
    let (event, k) = DistantCamera::at_distance(*strict.law(), 1.5, 60.0).unwrap().ray(6.0, 2.0).unwrap();
    let few = check(&loose, &mut loose.ray(event, k));
    let many = check(&strict, &mut strict.ray(event, k));
    assert!(many > 3 * few, "{few} {many}");
}
