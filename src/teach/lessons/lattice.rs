use super::{passing, shipped};
use crate::color::Coloring;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::DVec3;

const SPEEDS: [(f64, &str); 4] = [(0.0, "at rest"), (0.5, "0.5c"), (0.9, "0.9c"), (0.99, "0.99c")];

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "A lattice of balls and rods, one length apart, passes overhead; the camera looks up at where it comes from. Orange rods lie along the \
         motion, green ones level across it, blue ones upright.",
    );
    let mut plates = Vec::new();
    for (beta, name) in SPEEDS {
        plates.push(Plate::shot(
            &format!("{}", (100.0 * beta) as u32),
            format!("{name}."),
            shipped("lattice", beta)?,
        ));
    }
    l.plates(plates);
    l.text(
        "All four are taken when the same ball would look to be at the same place. Orange rods stay straight and grow long where they come; green \
         and blue ones become hyperbolas. Balls keep round outlines on the sky, whatever the lattice does: see the lesson *The sphere stays round*. A pinhole draws out \
         those off the middle of the picture, as in the first picture, where nothing moves: see *Fields of view*.",
    );
    l.heading("From outside");
    l.text(
        "Imagine detectors all over the camera’s frame, each at rest, that record what passes them. Of every point they know how far away it is seen: as far as its light is \
         old. So the apparent shape is a thing in space, which can be looked at from anywhere, like a statue. Here it is, from the right, above and behind; the yellow \
         pyramid is the camera. Red is what is seen redder, blue bluer.",
    );
    let mut plates = Vec::new();
    for (beta, name) in SPEEDS {
        let shot = shipped("lattice", beta)?.colored(Coloring::Doppler).from_aside()?;
        plates.push(Plate::shot(
            &format!("outside{}", (100.0 * beta) as u32),
            format!("{name}, from outside."),
            shot,
        ));
    }
    l.plates(plates);
    l.heading("Where the balls are seen");
    l.text(
        "Balls of one row along the line of flight, one length apart in their own frame; the row passes 1 beside you. Listed is where along the \
         motion they are seen (negative: still to come). The gap between neighbours goes from √((1 + β)/(1 − β)) far ahead to one \
         over that far behind.",
    );
    let places = [-4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 4.0];
    let mut rows = Vec::new();
    for place in places {
        let seen =
            |beta: f64| Ok::<_, TeachError>(passing(beta)?.see(DVec3::new(place, 1.0, 0.0)).position.x);
        rows.push([
            super::whole(place),
            l.fixed(format!("ball at {place}, 0.5c"), seen(0.5)?, 3),
            l.fixed(format!("ball at {place}, 0.9c"), seen(0.9)?, 3),
            l.fixed(format!("ball at {place}, 0.99c"), seen(0.99)?, 3),
        ]);
    }
    l.table(["x′", "0.5c", "0.9c", "0.99c"], rows);
    let first = l.fixed("first ball that is seen behind, 0.99c", 0.99 / (1.0f64 - 0.99 * 0.99).sqrt(), 2);
    let fast = passing(0.99)?;
    let count = |is: &dyn Fn(f64) -> bool| places.into_iter().filter(|place| is(*place)).count() as f64;
    let coming = |place: f64| fast.see(DVec3::new(place, 1.0, 0.0)).position.x < 0.0;
    let coming = l.fixed("balls that are seen coming, 0.99c", count(&coming), 0);
    let past = l.fixed("balls that are past", count(&|place| place > 0.0), 0);
    l.text(format!(
        "At 0.99c {coming} of the {} balls in the table are still seen coming. {past} of them are past you, and one is abreast: a ball 1 beside the \
         line of flight is seen abreast only where x′ = γβ = {first}.",
        places.len()
    ));
    l.heading("In motion");
    let reel = shipped("lattice", 0.9)?.reel(96, 24.0)?;
    l.plates([Plate::reel("film", "The lattice at 0.9c, from afar until it has passed.", reel)]);
    l.attempt(
        "terrell render lattice --beta 0.99 --color geometry --camera fisheye --size 900x900",
        "all of it, ahead and behind",
    );
    l.attempt(
        "terrell render lattice --beta 0.99 --color geometry --detectors=30,10,-20",
        "the shape itself, from another place",
    );
    l.attempt("terrell animate lattice --color geometry --beside-standard", "beside slow motion");
    let map = passing(0.6)?;
    let at = |x: f64| map.see(DVec3::new(x, 1.0, 0.0)).position.x;
    let seen = l.fixed("answer: ball that is abreast at 0.6c", at(map.speed()), 3);
    let abreast = l.fixed("answer: x′ of that ball", map.speed(), 2);
    l.ask(
        "At 0.6c, which x′ has the ball that is seen exactly abreast, if its row passes 1 beside you?",
        format!(
            "x′ = β r′ with r′² = x′² + 1 gives x′ = γβ = {abreast}. Indeed Eq. 1 puts it at x = {seen}."
        ),
    );
    Ok(lecture)
}
