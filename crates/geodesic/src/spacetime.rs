use crate::{Event, FourVector, World};

/// A straight piece of a light ray, traversed backwards in time from the observer:
/// event(s) = `start` + s · `direction` for s in [0, `length`].
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Where the piece begins, on the observer's side.
    pub start: Event<World>,
    /// Wave vector along the piece; not normalised, so s is one affine parameter for a whole ray.
    pub direction: FourVector<World>,
    /// Affine length; infinite where light comes straight from the sky.
    pub length: f64,
}

impl Segment {
    /// The event at the affine parameter `s`.
    pub fn at(&self, s: f64) -> Event<World> {
        self.start + self.direction * s
    }
}

/// What stands between an observer and the things seen: turns an event and a backward wave vector into the
/// straight segments light followed (Nollert et al. 2000, section 3.4 and Fig. 7).
pub trait Spacetime {
    /// The segments of one ray, the observer's first.
    fn segments(&self, event: Event<World>, wave_vector: FourVector<World>) -> impl Iterator<Item = Segment>;
}
