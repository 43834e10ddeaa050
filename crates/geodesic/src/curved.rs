use crate::law::product_at;
use crate::{
    ByMetric, BySecondDerivative, End, Event, FourVector, KerrError, KerrSchild, Law, LightRay, Method,
    Metric, Spacetime, World,
};

/// A curved spacetime: a law of motion for light, and how accurately to follow it.
///
/// Two tolerances that have nothing to do with each other: the [`accuracy`](Self::accuracy) of the rays, and the
/// [`sagitta`](Spacetime::sagitta) of the straight segments laid along them for whoever looks for hits.
#[derive(Clone, Copy, Debug)]
pub struct Curved<L> {
    law: L,
    accuracy: Accuracy,
}

/// How accurately rays are followed and how finely they are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The integrator.
    pub method: Method,
    /// Error allowed in one step: of the position as a fraction of the distance from the origin (plus the
    /// metric's scale), of the wave vector as a fraction of itself. Usually 10⁻⁶ to 10⁻¹⁰; evaluations grow like
    /// tolerance^(−1/8) with DOP853. Errors of whole rays are of this size or a little more.
    pub tolerance: f64,
    /// ε, how far a chord may be from the ray, in the metric's units of length. Chords grow like ε^(−1/2).
    pub sagitta: f64,
    /// How far the time on a chord may be from the ray's at the same parameter; usually 100 ε, since time
    /// matters only to what moves, and far out differs from a straight line by 2M/r where space has long become
    /// straight.
    pub lag: f64,
    /// Steps, refused ones included, after which a ray is given up.
    pub steps: u32,
    /// Change of k·k, as a fraction of its terms, beyond which a ray is given up.
    pub drift: f64,
}

impl Accuracy {
    /// DOP853 to `tolerance`, chords to `sagitta`, and limits that only a ray gone wrong meets.
    pub fn new(tolerance: f64, sagitta: f64) -> Self {
        Self {
            method: Method::Dop853,
            tolerance,
            sagitta,
            lag: 100.0 * sagitta,
            steps: 10_000,
            drift: (1e4 * tolerance).clamp(1e-6, 1e-2),
        }
    }
}

impl Default for Accuracy {
    /// A tolerance of 10⁻⁸ and chords to 0.01.
    fn default() -> Self {
        Self::new(1e-8, 0.01)
    }
}

impl<L: Law> Curved<L> {
    /// From a law of motion, at the default [`Accuracy`].
    pub fn new(law: L) -> Self {
        Self { law, accuracy: Accuracy::default() }
    }

    /// The same spacetime followed otherwise.
    pub fn with(self, accuracy: Accuracy) -> Self {
        Self { accuracy, ..self }
    }

    /// The law of motion.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// How rays are followed.
    pub fn accuracy(&self) -> Accuracy {
        self.accuracy
    }
}

impl<M: Metric> Curved<ByMetric<M>> {
    /// From a metric known as g alone.
    pub fn metric(metric: M) -> Self {
        Self::new(ByMetric(metric))
    }
}

impl<F: Fn([f64; 4], [f64; 4]) -> [f64; 4] + Sync> Curved<BySecondDerivative<F>> {
    /// From the second derivative ẍ(x, ẋ) alone.
    pub fn second_derivative(acceleration: F) -> Self {
        Self::new(BySecondDerivative::new(acceleration))
    }
}

impl Curved<KerrSchild> {
    /// A black hole of any mass and spin; chords to 0.01 M.
    ///
    /// # Errors
    /// As [`KerrSchild::new`].
    pub fn kerr(mass: f64, spin: f64) -> Result<Self, KerrError> {
        Ok(Self::new(KerrSchild::new(mass, spin)?).with(Accuracy::new(1e-8, 0.01 * mass)))
    }
}

impl<L: Law> Spacetime for Curved<L> {
    type Ray<'a>
        = LightRay<'a, L>
    where
        L: 'a;

    fn ray(&self, event: Event<World>, wave_vector: FourVector<World>) -> LightRay<'_, L> {
        LightRay::new(&self.law, self.accuracy, event, wave_vector)
    }

    fn product(&self, at: Event<World>, a: FourVector<World>, b: FourVector<World>) -> f64 {
        product_at(&self.law, at.coordinates().into(), a.into(), b.into())
    }

    fn fault(&self, at: Event<World>) -> Option<End> {
        let x: [f64; 4] = at.coordinates().into();
        self.law.stop(x).map(End::from).or_else(|| self.law.fault(x))
    }

    fn sagitta(&self) -> f64 {
        self.accuracy.sagitta
    }

    fn lag(&self) -> f64 {
        self.accuracy.lag
    }
}
