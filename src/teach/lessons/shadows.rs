use super::{own, shipped};
use crate::figure::{Axis, Figure, Marker, Panel, Series, Stroke};
use crate::plan::Method;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "Moving every point to where it is seen shows bodies rightly. It cannot show a shadow: whether a point of the floor is lit depends on where the cube \
         was when *its* light would have passed, earlier than the moment at which the floor is seen, and earlier by another time for every point. \
         So rays have to be followed: from the eye back to the floor, and from there back to the lamp, each at the speed of light.",
    );
    let with = |method: Option<Method>, beta: f64| {
        let mut shot = shipped("shadow", beta)?;
        shot.method = method;
        Ok::<_, TeachError>(shot)
    };
    l.plates([
        Plate::shot("rest", "A cube over a floor under a lamp, at rest.", with(None, 0.0)?),
        Plate::shot(
            "polygons",
            "At 0.8c, by moved polygons: the cube is right, but there is no shadow.",
            with(Some(Method::Apparent), 0.8)?,
        ),
        Plate::shot(
            "rays",
            "By rays: the shadow is late, and not that of the shape that is seen.",
            with(None, 0.8)?,
        ),
        Plate::reel(
            "film",
            "The cube at 0.8c passing over the floor, and its shadow.",
            with(None, 0.8)?.reel(96, 24.0)?,
        ),
    ]);
    l.heading("Faster than light");
    let shadow = Shadow { lamp: 4.0, height: 1.1, beta: 0.8 };
    let beneath = l.fixed("speed of the shadow beneath the lamp", shadow.speed(0.0), 3);
    let coming = l.fixed("speed of the shadow far before", shadow.speed(-1e9), 3);
    let going = l.fixed("speed of the shadow far beyond", shadow.speed(1e9), 3);
    l.text(format!(
        "The lamp hangs at a height of {} over the floor, the cube’s middle flies at {}. The shadow of its middle is cast outwards like by a lever, and beneath \
         the lamp it runs at {beneath} c. Nothing is wrong with that: a shadow is not a thing, and one place of it does not cause the next. Far before the lamp, where light on \
         its way to the floor goes against the motion, it runs at {coming} c, far beyond it at {going} c.",
        shadow.lamp, shadow.height
    ));
    l.formula("v_shadow = H / ((H − h)/v + h sin α),   α: from the vertical to the ray");
    l.heading("Two images");
    let first = shadow.seen_first();
    let place = l.fixed("where the shadow is first seen", first * shadow.lever(), 2);
    let eye = 14.0;
    let moment = l.fixed("when the shadow is first seen", shadow.seen(first, eye), 2);
    l.text(format!(
        "Look at the floor from far along the way, from {eye} beyond the lamp. Where the shadow comes faster than light it outruns its own image: nearer places of it \
         are seen *earlier*. So it is first seen not far away but at {place}, where it slows down to the speed of light, at the time {moment}. From there two images run apart: \
         one comes, one goes *away*, backwards in time, towards where the shadow came from. An edge of a shadow has no image, or one, or two."
    ));
    let seen_at = shadow.seen(first, eye) + 1.0;
    let [back, forth] = shadow.images(seen_at, eye).map(|x| x * shadow.lever());
    let (back, forth) = (
        l.fixed("image that goes away, one later", back, 2),
        l.fixed("image that comes, one later", forth, 2),
    );
    l.text(format!("One unit of time later they are seen at {back} and {forth}."));
    l.plates([Plate::figure(
        "two_images",
        format!("When the shadow is at a place on the floor, and when it is seen there from {eye} beyond the lamp. A moment of looking, a horizontal line, meets the second curve twice (dots): two images."),
        figure(&shadow, eye),
    )]);
    let at = |name: &str, caption: &str, later: f64| -> Result<Plate, TeachError> {
        let mut shot = own(SCENE, 0.8)?;
        // The camera is higher and aside, and sees it a little later.
        shot.scene.view.set_time(moment_seen(&shadow) + later)?;
        Ok(Plate::shot(name, caption, shot))
    };
    l.plates([
        at("before", "No shadow yet, though the cube is in the light.", -2.6)?,
        at("begins", "It appears out of nothing, and grows both ways.", -0.9)?,
        at("two", "Two shadows of one cube.", 2.0)?,
    ]);
    l.attempt("terrell render shadow", "the scene, with rays");
    l.attempt("terrell render shadow --method apparent", "the same by polygons: a note says what is missing");
    l.attempt("terrell compare shadow -o shadow", "what the methods differ by");
    let other = Shadow { lamp: 2.0, height: 1.0, beta: 0.6 };
    let speed = l.fixed("answer: speed beneath a lamp at 2", other.speed(0.0), 2);
    l.ask(
        "A bird flies at 0.6c, halfway between a lamp and the ground. How fast does its shadow run right beneath the lamp?",
        format!("Twice as fast, {speed} c: there the light’s way from bird to ground does not change."),
    );
    Ok(lecture)
}

/// A cube that passes under a lamp, seen from far along its way.
const SCENE: &str = r#"
[camera]
position = [14, -5, 5]
look_at = [0, 0, 0]
fov_deg = 42

[[light]]
name = "lamp"
kind = "point"
position = [0, 0, 4]
strength = 160

[[light]]
name = "fill"
kind = "ambient"
strength = 0.25

[material.floor]
color = [0.75, 0.72, 0.66]

[[body]]
name = "floor"
mesh = "plate"
scale = 60
material = "floor"

[[body]]
name = "cube"
mesh = "cube"
position = [0, 0, 1.1]
velocity = [0.8, 0, 0]
"#;

/// The shadow on the floor of a point that flies at a height, under a lamp over x = 0; the point is there at time 0.
struct Shadow {
    lamp: f64,
    height: f64,
    beta: f64,
}

impl Shadow {
    /// How much farther the shadow is than the point.
    fn lever(&self) -> f64 {
        self.lamp / (self.lamp - self.height)
    }

    /// Sine of the angle from the vertical of light that passes the point at x.
    fn sine(&self, x: f64) -> f64 {
        x / x.hypot(self.lamp - self.height)
    }

    /// When light that passes the point at x is at the floor.
    fn time(&self, x: f64) -> f64 {
        let way = x.hypot(self.lamp - self.height);
        x / self.beta + way * self.height / (self.lamp - self.height)
    }

    /// The speed of the shadow then.
    fn speed(&self, x: f64) -> f64 {
        self.lamp / ((self.lamp - self.height) / self.beta + self.height * self.sine(x))
    }

    /// When it is seen by someone on the floor, `eye` beyond the lamp.
    fn seen(&self, x: f64, eye: f64) -> f64 {
        self.time(x) + (eye - x * self.lever()).abs()
    }

    /// Where the point is when its shadow is as fast as light.
    fn seen_first(&self) -> f64 {
        let sine = (self.lamp - (self.lamp - self.height) / self.beta) / self.height;
        (self.lamp - self.height) * sine / (1.0 - sine * sine).sqrt()
    }

    /// Where the point was whose shadows are seen at a time: before the first one seen and after it.
    fn images(&self, time: f64, eye: f64) -> [f64; 2] {
        [-1.0, 1.0].map(|side| {
            let (mut near, mut far) = (self.seen_first(), side * 1e3);
            if side > 0.0 {
                far = eye / self.lever();
            }
            for _ in 0..200 {
                let middle = 0.5 * (near + far);
                if self.seen(middle, eye) < time { near = middle } else { far = middle }
            }
            near
        })
    }
}

/// When the camera of the scene first sees the shadow of the cube's middle.
fn moment_seen(shadow: &Shadow) -> f64 {
    let seen = |x: f64| {
        let floor = glam::DVec3::new(x * shadow.lever(), 0.0, 0.0);
        shadow.time(x) + floor.distance(glam::DVec3::new(14.0, -5.0, 5.0))
    };
    (-2000..2000).map(|i| seen(f64::from(i) / 200.0)).fold(f64::INFINITY, f64::min)
}

fn figure(shadow: &Shadow, eye: f64) -> Figure {
    let places = || (-80..=95).map(|i| f64::from(i) / 10.0);
    let there = places().map(|x| [x * shadow.lever(), shadow.time(x)]);
    let seen = places().map(|x| [x * shadow.lever(), shadow.seen(x, eye)]);
    let line = shadow.seen(shadow.seen_first(), eye) + 1.0;
    let [back, forth] = shadow.images(line, eye).map(|x| x * shadow.lever());
    // Its ends are beyond the axes, where there are no markers.
    let two = Series {
        marked: true,
        marker: Some(Marker::Circle),
        ink: Some([130; 3]),
        ..Series::line("a moment of looking", [-12.0, back, forth, 14.0].map(|x| [x, line]))
    };
    let there = Series { stroke: Stroke::Dashed, ..Series::line("shadow is there", there) };
    let panel = Panel {
        x: Axis::linear("place on the floor, along the motion").from_to(-11.0, 13.0),
        y: Axis::linear("time").from_to(-10.0, 22.0),
        series: vec![there, Series::line("shadow is seen there", seen), two],
        ..Panel::default()
    };
    Figure { rows: vec![vec![panel]], panel_size: [520.0, 360.0], ..Figure::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_are_slopes_and_images_are_seen_when_they_are() {
        let shadow = Shadow { lamp: 4.0, height: 1.1, beta: 0.8 };
        for x in [-5.0, -1.0, 0.0, 0.7, 4.0] {
            let h = 1e-5;
            let slope = 2.0 * h * shadow.lever() / (shadow.time(x + h) - shadow.time(x - h));
            // Central differences: h² times a third derivative of order 1, and rounding over h.
            assert!((slope - shadow.speed(x)).abs() < 1e-9, "{x}");
        }
        let first = shadow.seen_first();
        assert!((shadow.speed(first) - 1.0).abs() < 1e-12);
        let time = shadow.seen(first, 14.0) + 0.7;
        for x in shadow.images(time, 14.0) {
            assert!((shadow.seen(x, 14.0) - time).abs() < 1e-9);
        }
    }
}
