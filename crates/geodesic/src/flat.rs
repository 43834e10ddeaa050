use crate::{End, Event, FourVector, Monitor, Ray, Segment, Spacetime, World};

/// Flat spacetime: one exact segment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flat;

/// A ray of flat spacetime.
#[derive(Clone, Copy, Debug)]
pub struct FlatRay {
    segment: Segment,
    given: bool,
}

impl Spacetime for Flat {
    type Ray<'a> = FlatRay;

    fn ray(&self, event: Event<World>, wave_vector: FourVector<World>) -> FlatRay {
        let segment = Segment { start: event, direction: wave_vector, from: 0.0, length: f64::INFINITY };
        FlatRay { segment, given: false }
    }

    fn product(&self, _: Event<World>, a: FourVector<World>, b: FourVector<World>) -> f64 {
        a.dot(b)
    }

    fn fault(&self, at: Event<World>) -> Option<End> {
        let finite = at.t().is_finite() && at.position().is_finite();
        (!finite).then_some(End::NotANumber)
    }

    fn sagitta(&self) -> f64 {
        0.0
    }

    fn lag(&self) -> f64 {
        0.0
    }
}

impl Iterator for FlatRay {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        (!std::mem::replace(&mut self.given, true)).then_some(self.segment)
    }
}

impl Ray for FlatRay {
    fn at(&self, s: f64) -> (Event<World>, FourVector<World>) {
        (self.segment.at(s), self.segment.direction)
    }

    fn end(&self) -> Option<End> {
        self.given.then_some(End::Sky { wave_vector: self.segment.direction })
    }

    fn monitor(&self) -> Monitor {
        Monitor { segments: self.given.into(), ..Monitor::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn light_runs_back_in_time_on_the_null_cone() {
        let here = Event::new(5.0, 1.0, 2.0, 3.0);
        let n = DVec3::new(0.0, 0.6, -0.8);
        let mut ray = Flat.ray(here, FourVector::seen_from(n));
        assert_eq!(ray.end(), None);
        let segments: Vec<_> = ray.by_ref().collect();
        assert_eq!(segments.len(), 1);
        assert_eq!(ray.end(), Some(End::Sky { wave_vector: FourVector::seen_from(n) }));
        let emission = segments[0].at(10.0);
        assert_eq!(emission, ray.at(10.0).0);
        assert_eq!(emission, Event::at(-5.0, here.position() + 10.0 * n));
        assert!(Flat.product(here, emission - here, emission - here).abs() < 1e-13);
    }
}
