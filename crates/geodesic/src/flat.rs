use crate::{Event, FourVector, Segment, Spacetime, World};

/// Flat spacetime: one exact segment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Flat;

impl Spacetime for Flat {
    fn segments(&self, event: Event<World>, wave_vector: FourVector<World>) -> impl Iterator<Item = Segment> {
        std::iter::once(Segment { start: event, direction: wave_vector, length: f64::INFINITY })
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
        let segments: Vec<_> = Flat.segments(here, FourVector::seen_from(n)).collect();
        assert_eq!(segments.len(), 1);
        let emission = segments[0].at(10.0);
        assert_eq!(emission, Event::at(-5.0, here.position() + 10.0 * n));
        assert!((emission - here).dot(emission - here).abs() < 1e-13);
    }
}
