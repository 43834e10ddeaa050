use super::{own, passing};
use crate::figure::{Axis, Figure, Panel, Point, Series, Stroke};
use crate::relativity::ApparentMap;
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, TeachError};
use glam::{DVec2, DVec3};

const SPEEDS: [f64; 3] = [0.5, 0.9, 0.99];

fn scene(distance: f64) -> String {
    // A field that shows it equally large.
    let fov = 2.0 * (0.8 / distance).atan().to_degrees();
    format!(
        "[camera]\nposition = [0, 0, 0]\nforward = [0, 1, 0]\nfov_deg = {fov}\nnearest = \"cube\"\n\n[[body]]\nname = \"cube\"\n\
         mesh = \"cube\"\nposition = [0, {distance}, 0]\nvelocity = [0.9, 0, 0]\n"
    )
}

pub(super) fn lecture() -> Result<Lecture, TeachError> {
    let mut lecture = Lecture::default();
    let l = &mut lecture;
    l.text(
        "A cube far away passes, and is photographed when it looks to be abreast. Its near side is contracted to 1/γ. Light from its far edge left \
         one edge length earlier, when the cube was β further back: so the far edge is seen shifted by β, and the back comes into view, β wide. In \
         the picture that is just how a cube at rest looks that is turned by the angle whose sine is β, since cos(arcsin β) = 1/γ.",
    );
    let far = 1000.0;
    let mut rows = Vec::new();
    for beta in SPEEDS {
        let seen = Abreast::new(beta, far)?;
        let near = seen.across(0.5, -0.5) - seen.across(-0.5, -0.5);
        let back = seen.across(-0.5, -0.5) - seen.across(-0.5, 0.5);
        rows.push([
            format!("{beta}"),
            l.fixed(format!("near side at {beta}"), near, 4),
            l.fixed(format!("back at {beta}"), back, 4),
            l.fixed(format!("turn at {beta}, degrees"), back.atan2(near).to_degrees(), 2),
        ]);
    }
    l.table(["β", "near side is seen", "back is seen", "looks turned by (°)"], rows);
    l.text("These are measured in the image of a cube 1000 edges away, by the map of Eq. 1; arcsin β is 30°, 64.16° and 81.89°.");
    let text = scene(30.0);
    let mut plates = vec![Plate::shot("rest", "At rest.", own(&text, 0.0)?)];
    for beta in SPEEDS {
        let name = format!("{}", (100.0 * beta) as u32);
        plates.push(Plate::shot(&name, format!("At {beta}c."), own(&text, beta)?));
    }
    l.plates(plates);
    l.heading("Sheared, not turned");
    l.text(
        "Nothing has turned. Seen from above, the apparent cube is a sheared box: its far edge lies exactly behind, as far away as at rest, only \
         shifted. A turned cube has its far edge elsewhere; both merely send the same rays to a distant camera. In Figs. 4 and 5 of the paper \
         their outlines coincide.",
    );
    l.plates([Plate::figure(
        "plan",
        "From above, at 0.9c. Left: 100 edges away all lines of sight are parallel, and both shapes have corners on the same ones. \
         Right: 2 edges away they have not.",
        Figure { rows: vec![vec![plan(100.0)?, plan(2.0)?]], panel_size: [320.0, 320.0], ..Figure::default() },
    )]);
    l.heading("When it fails");
    l.text(
        "Near by, lines of sight are not parallel and the two differ. How far, at worst, corners of the cube that is seen are from those of a cube at rest \
         that is turned by arcsin β, in edge lengths at its distance:",
    );
    let distances = [100.0, 30.0, 10.0, 3.0, 1.5];
    let mut rows = Vec::new();
    for distance in distances {
        let mut worst = |beta: f64| {
            let worst = Abreast::new(beta, distance)?.worst();
            Ok::<_, TeachError>(l.fixed(format!("misfit at {distance} and {beta}"), worst, 3))
        };
        rows.push([format!("{distance}"), worst(0.5)?, worst(0.9)?, worst(0.99)?]);
    }
    l.table(["distance, edges", "0.5c", "0.9c", "0.99c"], rows);
    l.text(
        "It falls as one over the distance: “a moving cube looks turned” is a statement about small things.",
    );
    let near = scene(1.5);
    l.plates([
        Plate::shot("near_rest", "1.5 edges away, at rest.", own(&near, 0.0)?),
        Plate::shot("near", "At 0.9c: no turned cube looks so.", own(&near, 0.9)?),
    ]);
    let reel = own(&scene(4.0), 0.9)?.reel(72, 24.0)?;
    l.plates([Plate::reel("film", "Passing at 0.9c: it seems to turn all the way as it passes.", reel)]);
    l.attempt("terrell render cube --beta 0.99 --color geometry", "Fig. 2: the cube of the paper");
    l.attempt("terrell render your.glb --beta 0.9 --color geometry", "anything of your own, turned");
    l.attempt("terrell render cube --beta 0.99", "the same with its light: shifted to the red and dark");
    let seen = Abreast::new(0.8, far)?;
    let [near, back] = [[0.5, -0.5, -0.5, -0.5], [-0.5, -0.5, -0.5, 0.5]]
        .map(|[a, b, c, d]| seen.across(a, b) - seen.across(c, d));
    let (near, back) =
        (l.fixed("answer: near side at 0.8c", near, 2), l.fixed("answer: back at 0.8c", back, 2));
    l.ask(
        "How wide are the near side and the back of a small distant cube of edge 1 seen at 0.8c, and by which angle does it seem to be turned?",
        format!("{near} and {back}; arcsin 0.8 = 53.13°."),
    );
    Ok(lecture)
}

/// A square of edge 1, seen from above, whose middle looks to be abreast.
struct Abreast {
    map: ApparentMap,
    beta: f64,
    distance: f64,
}

impl Abreast {
    fn new(beta: f64, distance: f64) -> Result<Self, TeachError> {
        Ok(Self { map: passing(beta)?, beta, distance })
    }

    /// Where a point of it is seen, along the motion and away.
    fn seen(&self, x: f64, y: f64) -> DVec2 {
        // x′ = β r′ is seen at x = 0.
        let middle = DVec3::new(self.map.speed() * self.distance, self.distance, 0.0);
        let at = self.map.see(middle + DVec3::new(x, y, 0.0)).position;
        DVec2::new(at.x, at.y)
    }

    /// Where a point of it is in the picture, in lengths at its distance.
    fn across(&self, x: f64, y: f64) -> f64 {
        let at = self.seen(x, y);
        self.distance * at.x / at.y
    }

    /// Where the same point of a square at rest is that is turned by arcsin β.
    fn turned(&self, x: f64, y: f64) -> DVec2 {
        let (sine, cosine) = (self.beta, (1.0 - self.beta * self.beta).sqrt());
        DVec2::new(cosine * x - sine * y, self.distance + sine * x + cosine * y)
    }

    /// How far corners of both are apart in the picture, at worst.
    fn worst(&self) -> f64 {
        let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
        let apart = corners.map(|(x, y)| {
            let turned = self.turned(x, y);
            (self.across(x, y) - self.distance * turned.x / turned.y).abs()
        });
        apart.into_iter().fold(0.0, f64::max)
    }
}

fn plan(distance: f64) -> Result<Panel, TeachError> {
    let square = Abreast::new(0.9, distance)?;
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)];
    let local = |p: DVec2| [p.x, p.y - distance];
    let seen = corners.windows(2).flat_map(|side| {
        (0..=16).map(|i| {
            let t = f64::from(i) / 16.0;
            let (a, b) = (side[0], side[1]);
            local(square.seen(a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)))
        })
    });
    let mut series = vec![
        Series::line("seen", seen.collect::<Vec<_>>()),
        Series {
            stroke: Stroke::Dashed,
            ..Series::line("turned", corners.map(|(x, y)| local(square.turned(x, y))))
        },
    ];
    // Lines of sight through the corners that are seen.
    for (x, y) in &corners[..4] {
        let towards = square.seen(*x, *y) / square.seen(*x, *y).y;
        let ends = [-1.3, 1.3].map(|away| [towards.x * (distance + away), away]);
        series.push(Series { ink: Some([190; 3]), ..Series::line("", ends) });
    }
    let dots = corners[..4].iter().map(|(x, y)| {
        let [x, y] = local(square.seen(*x, *y));
        Point { x, y, ..Point::default() }
    });
    series.push(Series { ink: Some([30; 3]), ..Series::points("", dots.collect()) });
    Ok(Panel {
        title: format!("{distance} edges away"),
        x: Axis::linear("along the motion").from_to(-1.3, 1.3),
        y: Axis::linear("away, from its middle").from_to(-1.3, 1.3),
        series,
        ..Panel::default()
    })
}
