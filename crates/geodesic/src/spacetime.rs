use crate::{Event, FourVector, World};

/// A straight piece of a light ray, traversed backwards in time from the observer:
/// event(s) = `start` + (s − `from`) · `direction` for s in [`from`, `from` + `length`].
///
/// s is one affine parameter for the whole ray: it is 0 at the observer, and a piece begins where the one
/// before it ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where the piece begins, on the observer's side.
    pub start: Event<World>,
    /// Wave vector along the piece, not normalised; in curved spacetime the chord from end to end.
    pub direction: FourVector<World>,
    /// Affine parameter of `start`.
    pub from: f64,
    /// Affine length; infinite where light comes straight from the sky.
    pub length: f64,
}

impl Segment {
    /// The event at the affine parameter `s` of the ray.
    pub fn at(&self, s: f64) -> Event<World> {
        self.start + self.direction * (s - self.from)
    }

    /// The affine parameter at which the piece ends.
    pub fn to(&self) -> f64 {
        self.from + self.length
    }
}

/// What stands between an observer and the things seen: turns an event and a backward wave vector into the
/// straight segments light followed (Nollert et al. 2000, section 3.4 and Fig. 7).
pub trait Spacetime: Sync {
    /// The segments of one ray, and the exact ray along them.
    type Ray<'a>: Ray
    where
        Self: 'a;

    /// The ray seen at `event` with `wave_vector`, which points back along the light.
    fn ray(&self, event: Event<World>, wave_vector: FourVector<World>) -> Self::Ray<'_>;

    /// The product g(a, b) of two vectors at an event.
    fn product(&self, at: Event<World>, a: FourVector<World>, b: FourVector<World>) -> f64;

    /// Why no ray can begin at an event and no observer be there; `None` where all is well.
    fn fault(&self, at: Event<World>) -> Option<End>;

    /// How far (coordinate length) an exact ray may be from its segments: ε, by which whoever looks for hits
    /// has to widen things. The last, infinite segment is exact in direction, not in place.
    fn sagitta(&self) -> f64;

    /// How far (coordinate time) the time on a segment may be from the exact ray's at the same parameter; what
    /// moves with speed v has to be widened by v times this as well.
    fn lag(&self) -> f64;
}

/// One ray: an iterator over its segments, the observer's first.
pub trait Ray: Iterator<Item = Segment> {
    /// Event and wave vector at the affine parameter `s` on the exact ray, not on its chord.
    ///
    /// Right to the tolerance of the integration within the segment returned last, its ends included. Beyond
    /// it the nearest piece known is continued.
    fn at(&self, s: f64) -> (Event<World>, FourVector<World>);

    /// Why the ray ended; `None` while there are segments to come.
    fn end(&self) -> Option<End>;

    /// What the ray has cost, and how well it kept to the light cone.
    fn monitor(&self) -> Monitor;
}

/// Why a ray ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// It came from infinity.
    Sky {
        /// The wave vector there, null in flat spacetime: its space part points to the place on the sky,
        /// |t| is the frequency far away for the unit in which the ray began.
        wave_vector: FourVector<World>,
    },
    /// It came out of a horizon: black.
    Horizon,
    /// It left the region in which the spacetime is described.
    Edge,
    /// It took more steps than allowed, or its steps became too small to add anything.
    StepLimit,
    /// Its wave vector drifted off the light cone by more than allowed.
    Drift,
    /// Something became NaN or infinite.
    NotANumber,
    /// The metric became singular, or is not a metric of one time and three spaces.
    SingularMetric,
}

impl End {
    /// Whether the ray failed, so that nothing is known of where it came from.
    pub fn is_failure(&self) -> bool {
        !matches!(self, Self::Sky { .. } | Self::Horizon | Self::Edge)
    }
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Sky { .. } => "came from the sky",
            Self::Horizon => "came out of a horizon",
            Self::Edge => "left the region that is described",
            Self::StepLimit => "took more steps than allowed",
            Self::Drift => "drifted off the light cone",
            Self::NotANumber => "became not a number",
            Self::SingularMetric => "met a metric that is singular, or not of one time and three spaces",
        })
    }
}

/// What a ray has cost, and how well it kept to the light cone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Monitor {
    /// Steps accepted.
    pub steps: u32,
    /// Steps refused, to be tried again shorter.
    pub refused: u32,
    /// Evaluations of the right-hand side.
    pub evaluations: u32,
    /// Segments handed out.
    pub segments: u32,
    /// Greatest change of k·k seen, as a fraction of the terms it is the sum of.
    pub drift: f64,
}
