use super::{passing, shipped};
use crate::scene::{Lens, Projection};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::DVec3;

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "A picture is flat and the sky is round, so every camera distorts. Since fast things gather ahead or need a wide view, pictures of relativity are \
         full of distortions that have nothing to do with relativity. To tell them apart, look at the same view at rest through the same camera.",
    );
    let cameras = [
        (
            "pinhole",
            Projection::Pinhole,
            Some(100.0),
            "pinhole: straight lines stay straight, but what is off the middle is drawn out",
        ),
        (
            "fisheye",
            Projection::Fisheye,
            Some(180.0),
            "fisheye: angles from the middle are true, lines across bend",
        ),
        (
            "panorama",
            Projection::Panorama,
            None,
            "panorama: the whole sky; what is above and below is drawn wide",
        ),
    ];
    for (name, projection, fov, caption) in cameras {
        let shot = |beta: f64| {
            let mut shot = shipped("lattice", beta)?;
            (shot.scene.view.projection, shot.scene.view.fov_deg) = (projection, fov);
            shot.scene.view.size = [640, if projection == Projection::Panorama { 320 } else { 480 }];
            Ok::<_, TeachError>(shot)
        };
        l.plates([
            Plate::shot(&format!("{name}_rest"), format!("At rest: {caption}."), shot(0.0)?),
            Plate::shot(name, "At 0.9c.", shot(0.9)?),
        ]);
    }
    l.heading("How much a camera draws things out");
    l.text(
        "Off the middle by an angle θ, small things are larger in the picture than in its middle, by these factors along the direction away from the middle and \
         across it. A circle of the sky, such as the outline of a sphere, becomes an ellipse of their ratio.",
    );
    let mut rows = Vec::new();
    for degrees in [30.0, 45.0, 60.0] {
        let mut row = vec![format!("{degrees:.0}°")];
        for (name, projection) in [("pinhole", Projection::Pinhole), ("fisheye", Projection::Fisheye)] {
            let [along, across] = stretch(projection, f64::to_radians(degrees))?;
            row.push(l.fixed(format!("{name} along at {degrees}°"), along, 3));
            row.push(l.fixed(format!("{name} across at {degrees}°"), across, 3));
        }
        rows.push([0, 1, 2, 3, 4].map(|i| row[i].clone()));
    }
    l.table(["θ", "pinhole, along", "across", "fisheye, along", "across"], rows);
    l.heading("What is relativity’s");
    l.text(
        "Aberration does none of this: it moves directions towards that of flight, and takes small shapes on the sky to shapes of the same form, only of another size. \
         So what looks bent through *every* camera, and is not bent at rest, is relativity’s; rods across the motion are. What is round at rest \
         and oval at speed is not: it has been moved to a part of the picture that the camera draws out.",
    );
    let map = passing(0.9)?;
    let seen = |n: DVec3| map.see(n).position.normalize();
    // A little cross on the sky of the rest frame, at 60° from the motion.
    let at = |a: f64, b: f64| {
        let (sine, cosine) = (60f64.to_radians() + a).sin_cos();
        seen(DVec3::new(-cosine * b.cos(), sine * b.cos(), b.sin()))
    };
    let size = 1e-4;
    let along = (at(size, 0.0) - at(-size, 0.0)).length() / (2.0 * size);
    let across = (at(0.0, size) - at(0.0, -size)).length() / (2.0 * size);
    let (a, b) = (
        l.fixed("aberration shrinks along by", along, 4),
        l.fixed("aberration shrinks across by", across, 4),
    );
    let d = l.fixed("one over D there", 1.0 / map.see(DVec3::new(-0.5, 0.75f64.sqrt(), 0.0)).doppler, 4);
    l.text(format!(
        "For example, what is 60° from straight ahead at rest is seen at 0.9c {a} times as large along the motion and {b} times across it: the same, and equal to 1/D = {d}. So \
         what is blue-shifted looks small, and what is red-shifted large."
    ));
    l.attempt(
        "terrell render lattice --color geometry --camera fisheye --fov 180 --size 900x900",
        "half the sky",
    );
    l.attempt("terrell render gate --color geometry --camera panorama --size 1600x800", "all of it");
    l.attempt(
        "terrell render street --color geometry --camera panorama --size 1600x800 --beta 0",
        "a panorama of things at rest: bent, too",
    );
    let [along, across] = stretch(Projection::Pinhole, 60f64.to_radians())?;
    let ratio = l.fixed("answer: pinhole at 60°, along over across", along / across, 2);
    l.ask(
        "Through a pinhole, a small sphere is seen 60° off the middle. How much longer than wide is it in the picture?",
        format!("1/cos²θ over 1/cosθ: 1/cos 60° = {ratio} times."),
    );
    Ok(lecture)
}

/// How much larger than in the middle a lens shows small things off it, along the way from the middle and across.
fn stretch(projection: Projection, off: f64) -> Result<[f64; 2], TeachError> {
    let lens = Lens::new(projection, 150.0, 1000, 1000)?;
    let pixel = |a: f64, b: f64| {
        let (sine, cosine) = a.sin_cos();
        lens.pixel(DVec3::new(sine * b.cos(), b.sin(), cosine * b.cos())).unwrap_or_default()
    };
    let size = 1e-4;
    let scale = |middle: f64| {
        let along = (pixel(middle + size, 0.0) - pixel(middle - size, 0.0)).length();
        [along, (pixel(middle, size) - pixel(middle, -size)).length()]
    };
    let (there, middle) = (scale(off), scale(0.0));
    Ok([there[0] / middle[0], there[1] / middle[1]])
}
