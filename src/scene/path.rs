use super::{Aim, View};
use glam::DVec3;
use terrell_geodesic::{Celerity, Event};

/// A camera's way through a scene, by keys: a smooth curve through their positions, whose velocity the camera has.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    keys: Vec<Key>,
    /// The camera's clock at the keys; it agrees with the world's at the first.
    clock: Vec<f64>,
}

/// The camera at a world time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// World time.
    pub time: f64,
    /// World position.
    pub position: DVec3,
    /// Where it looks.
    pub aim: Aim,
    /// Upward in the picture.
    pub up: DVec3,
    /// Full field in degrees; the view's if none.
    pub fov_deg: Option<f64>,
}

/// Why keys are no path; the number is the key's, from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// One key is no way.
    #[error("a camera path needs at least two keys")]
    TooFew,
    /// Times out of order.
    #[error("key {0} is not later than the one before it")]
    Order(usize),
    /// Two ways of looking.
    #[error("key {0} does not look as the first one does; give all of them look_at, or all forward")]
    Aim(usize),
    /// Faster than light.
    #[error(
        "between keys {0} and {next} the camera would go at {1:.3} of light speed; give it more time, or a shorter way",
        next = .0 + 1
    )]
    TooFast(usize, f64),
}

/// Pieces a stretch between keys is measured in.
const PIECES: usize = 64;

impl CameraPath {
    /// # Errors
    /// If the keys are fewer than two, not in order of time, look in different ways, or ask for the speed of light.
    pub fn new(keys: Vec<Key>) -> Result<Self, PathError> {
        if keys.len() < 2 {
            return Err(PathError::TooFew);
        }
        let looks_at = |key: &Key| matches!(key.aim, Aim::LookAt(_));
        for (i, key) in keys.iter().enumerate().skip(1) {
            if key.time <= keys[i - 1].time || key.time.is_nan() {
                return Err(PathError::Order(i));
            }
            if looks_at(key) != looks_at(&keys[0]) {
                return Err(PathError::Aim(i));
            }
        }
        let mut path = Self { clock: vec![keys[0].time], keys };
        for i in 0..path.keys.len() - 1 {
            let mut elapsed = 0.0;
            for (_, step, speed) in path.pieces(i) {
                if speed >= FASTEST || speed.is_nan() {
                    return Err(PathError::TooFast(i, speed));
                }
                elapsed += step * (1.0 - speed * speed).sqrt();
            }
            path.clock.push(path.clock[i] + elapsed);
        }
        Ok(path)
    }

    /// The camera's clock at its first and its last key.
    pub fn clock_range(&self) -> [f64; 2] {
        [self.clock[0], self.clock[self.clock.len() - 1]]
    }

    /// The camera when its clock shows `clock`: the view's lens, at that place of the path. It stays at its ends before
    /// and after.
    pub fn view(&self, view: &View, clock: f64) -> View {
        let [first, last] = self.clock_range();
        self.view_at_time(view, self.world_time(clock.clamp(first, last)))
    }

    /// The camera at a world time; as at its ends before and after.
    pub fn view_at_time(&self, view: &View, t: f64) -> View {
        let t = t.clamp(self.keys[0].time, self.keys[self.keys.len() - 1].time);
        let i = self.stretch(t);
        let (a, b) = (&self.keys[i], &self.keys[i + 1]);
        let part = (t - a.time) / (b.time - a.time);
        let aim = match (a.aim, b.aim) {
            (Aim::LookAt(from), Aim::LookAt(to)) => Aim::LookAt(from.lerp(to, part)),
            (Aim::Forward(from) | Aim::LookAt(from), Aim::Forward(to) | Aim::LookAt(to)) => {
                Aim::Forward(turned(from, to, part))
            }
        };
        // Below light speed it is a celerity.
        let celerity = Celerity::from_beta(self.velocity(t)).unwrap_or(Celerity::at_rest());
        let fov = |key: &Key| key.fov_deg.or(view.fov_deg);
        View {
            event: Event::at(t, self.position(t)),
            celerity,
            aim,
            up: turned(a.up, b.up, part),
            // Evenly in what is seen larger or smaller.
            fov_deg: match (fov(a), fov(b)) {
                (Some(from), Some(to)) => Some(from * (to / from).powf(part)),
                (one, other) => one.or(other),
            },
            nearest: None,
            ..view.clone()
        }
    }

    /// The greatest speed on the way, in units of that of light.
    pub fn greatest_speed(&self) -> f64 {
        let stretches = 0..self.keys.len() - 1;
        stretches.flat_map(|i| self.pieces(i)).map(|(_, _, speed)| speed).fold(0.0, f64::max)
    }

    /// The pieces of a stretch: when each begins, how long it takes, and the speed in its middle.
    fn pieces(&self, i: usize) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let (start, end) = (self.keys[i].time, self.keys[i + 1].time);
        let step = (end - start) / PIECES as f64;
        let begin = move |k: usize| start + k as f64 * step;
        (0..PIECES).map(move |k| (begin(k), step, self.velocity(begin(k) + 0.5 * step).length()))
    }

    fn stretch(&self, t: f64) -> usize {
        self.keys.partition_point(|k| k.time <= t).clamp(1, self.keys.len() - 1) - 1
    }

    /// The world time at which the camera's clock shows `clock`: dτ/dt = 1/γ, added up.
    fn world_time(&self, clock: f64) -> f64 {
        let i = self.clock.partition_point(|c| *c <= clock).clamp(1, self.clock.len() - 1) - 1;
        let mut shown = self.clock[i];
        for (begin, step, speed) in self.pieces(i) {
            let more = step * (1.0 - speed * speed).sqrt();
            if shown + more >= clock {
                return begin + (clock - shown) / more * step;
            }
            shown += more;
        }
        self.keys[i + 1].time
    }

    /// Slope at a key: that of the parabola through it and its neighbours; at the ends, of the stretch there.
    fn slope(&self, i: usize) -> DVec3 {
        let chord = |i: usize| {
            let (a, b) = (&self.keys[i], &self.keys[i + 1]);
            (b.position - a.position) / (b.time - a.time)
        };
        let last = self.keys.len() - 1;
        if i == 0 || i == last {
            return chord(i.min(last - 1));
        }
        let (before, after) =
            (self.keys[i].time - self.keys[i - 1].time, self.keys[i + 1].time - self.keys[i].time);
        (chord(i - 1) * after + chord(i) * before) / (before + after)
    }

    /// Cubic between keys, with its derivative.
    fn at(&self, t: f64) -> [DVec3; 2] {
        let i = self.stretch(t);
        let (a, b) = (&self.keys[i], &self.keys[i + 1]);
        let span = b.time - a.time;
        let s = (t - a.time) / span;
        let (start, end) = (self.slope(i) * span, self.slope(i + 1) * span);
        let way = b.position - a.position;
        // a + s·start + s²(3 way − 2 start − end) + s³(start + end − 2 way)
        let (second, third) = (3.0 * way - 2.0 * start - end, start + end - 2.0 * way);
        [
            a.position + s * (start + s * (second + s * third)),
            (start + s * (2.0 * second + s * 3.0 * third)) / span,
        ]
    }

    fn position(&self, t: f64) -> DVec3 {
        self.at(t)[0]
    }

    fn velocity(&self, t: f64) -> DVec3 {
        self.at(t)[1]
    }
}

/// The greatest speed of a path: what is closer to light's is given better as a motion.
const FASTEST: f64 = 0.9999;

/// A direction between two, by the shortest turn; half-way round, by way of nothing in particular.
fn turned(from: DVec3, to: DVec3, part: f64) -> DVec3 {
    let (from, to) = (from.normalize_or(DVec3::Y), to.normalize_or(DVec3::Y));
    let angle = from.angle_between(to);
    let axis = from.cross(to).try_normalize().unwrap_or(from.any_orthonormal_vector());
    if angle > 0.0 { glam::DQuat::from_axis_angle(axis, part * angle) * from } else { from }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(time: f64, position: DVec3) -> Key {
        Key { time, position, aim: Aim::Forward(DVec3::Y), up: DVec3::Z, fov_deg: None }
    }

    #[test]
    fn a_straight_way_is_uniform_motion_by_the_camera_s_own_clock() {
        let keys = [0.0, 1.0, 5.0, 10.0].map(|t| key(t, DVec3::X * (0.6 * t)));
        let path = CameraPath::new(keys.to_vec()).unwrap();
        assert!((path.clock_range()[1] - 8.0).abs() < 1e-12, "10/γ");
        assert!((path.greatest_speed() - 0.6).abs() < 1e-12);
        assert!((path.view_at_time(&View::default(), 7.3).event.t() - 7.3).abs() < 1e-9);
        for clock in [0.0, 0.3, 4.0, 7.9, 8.0] {
            let view = path.view(&View::default(), clock);
            assert!((view.event.t() - clock * 1.25).abs() < 1e-9);
            assert!((view.celerity.beta() - DVec3::X * 0.6).length() < 1e-12);
        }
    }

    #[test]
    fn it_goes_smoothly_through_its_keys() {
        let points = [DVec3::ZERO, DVec3::new(1.0, 0.5, 0.0), DVec3::new(1.0, 2.0, 1.0), DVec3::ZERO];
        let keys: Vec<_> = points.iter().enumerate().map(|(i, p)| key(20.0 * i as f64, *p)).collect();
        let path = CameraPath::new(keys).unwrap();
        for (i, point) in points.iter().enumerate() {
            let t = 20.0 * i as f64;
            assert!((path.position(t) - point).length() < 1e-12);
            let before = (path.position(t) - path.position(t - 1e-5)) / 1e-5;
            if i > 0 {
                assert!((before - path.velocity(t - 1e-9)).length() < 1e-5);
            }
        }
        let mut turn = key(0.0, DVec3::ZERO);
        turn.aim = Aim::Forward(DVec3::X);
        let path = CameraPath::new(vec![turn, key(1.0, DVec3::ZERO)]).unwrap();
        let Aim::Forward(middle) = path.view(&View::default(), 0.5).aim else { panic!() };
        assert!((middle - DVec3::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0)).length() < 1e-12);
    }

    #[test]
    fn what_is_no_path_is_refused() {
        let far = |t: f64, x: f64| key(t, DVec3::X * x);
        assert_eq!(CameraPath::new(vec![far(0.0, 0.0)]), Err(PathError::TooFew));
        assert_eq!(CameraPath::new(vec![far(0.0, 0.0), far(0.0, 1.0)]), Err(PathError::Order(1)));
        assert!(matches!(CameraPath::new(vec![far(0.0, 0.0), far(1.0, 1.5)]), Err(PathError::TooFast(0, _))));
        let mut other = far(9.0, 1.0);
        other.aim = Aim::LookAt(DVec3::Y);
        assert_eq!(CameraPath::new(vec![far(0.0, 0.0), other]), Err(PathError::Aim(1)));
    }
}
