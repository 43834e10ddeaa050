use super::{own, passing};
use crate::figure::{Axis, Figure, Panel, Point, Series, Stroke};
use crate::relativity::ApparentMap;
use crate::scene::{Mesh, Paint};
use crate::teach::lecture::Lecture;
use crate::teach::plate::{Plate, Shot, TeachError};
use glam::{DVec2, DVec3};
use std::sync::Arc;

const SPEEDS: [f64; 3] = [0.5, 0.9, 0.99];
/// Degrees by which cubes are photographed from above, so that their tops show: they are tipped by that around the line of
/// flight, which is the same.
pub(super) const ABOVE: f64 = 20.0;
/// Fields of the chequer along an edge.
const FIELDS: u32 = 4;

fn scene(distance: f64) -> String {
    // A field that shows it equally large.
    let fov = 2.0 * (0.9 / distance).atan().to_degrees();
    format!(
        "[camera]\nposition = [0, 0, 0]\nforward = [0, 1, 0]\nfov_deg = {fov}\nnearest = \"cube\"\n\n[[body]]\nname = \"cube\"\n\
         mesh = \"cube\"\nposition = [0, {distance}, 0]\nvelocity = [0.9, 0, 0]\n\
         rotation = {{ axis = [1, 0, 0], angle_deg = {ABOVE} }}\n"
    )
}

/// A cube that far away.
fn cube(distance: f64, beta: f64) -> Result<Shot, TeachError> {
    Ok(chequered(own(&scene(distance), beta)?))
}

/// The same with its cubes' sides in a chequer, which shows how they are turned and sheared.
pub(super) fn chequered(mut shot: Shot) -> Shot {
    for body in &mut shot.scene.bodies {
        let mesh = &body.mesh;
        let (mut vertices, mut triangles, mut colors) = (Vec::new(), Vec::new(), Vec::new());
        // A side is two triangles, which begin at one corner.
        for side in (0..mesh.triangles.len()).step_by(2) {
            let ([a, b, _], [_, _, d]) = (mesh.corners(side), mesh.corners(side + 1));
            let color = mesh.color(side, [1.0, 0.0, 0.0], |_| [1.0; 3]);
            let part = |i: u32| f64::from(i) / f64::from(FIELDS);
            let at = |i: u32, j: u32| a + part(i) * (b - a) + part(j) * (d - a);
            for (i, j) in (0..FIELDS * FIELDS).map(|field| (field / FIELDS, field % FIELDS)) {
                let first = vertices.len() as u32;
                vertices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|v: u32| first + v)));
                let dark = color.map(|c| 0.4 * c);
                colors.extend([if (i + j) % 2 == 0 { color } else { dark }; 2]);
            }
        }
        body.mesh = Arc::new(Mesh { paint: Paint::Faces(colors), ..Mesh::new(&vertices, triangles) });
    }
    shot
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
            l.fixed(format!("arcsin of {beta}, degrees"), beta.asin().to_degrees(), 2),
        ]);
    }
    l.table(["β", "near side is seen", "back is seen", "looks turned by (°)", "arcsin β (°)"], rows);
    l.text(format!(
        "These are measured in the image of a cube {far} edges away, by the map of Eq. 1. The pictures show a chequered cube from {ABOVE}° above, so that \
         its top is in view as well: green is the side towards you, yellow the back. The turn is around the upright of the picture."
    ));
    let mut plates = vec![Plate::shot("rest", "At rest.", cube(30.0, 0.0)?)];
    for beta in SPEEDS {
        let name = format!("{}", (100.0 * beta) as u32);
        plates.push(Plate::shot(&name, format!("At {beta}c."), cube(30.0, beta)?));
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
        "Near by, lines of sight are not parallel and the two differ. How far, at worst, corners of the cube that is seen are in the picture from \
         those of a cube at rest that is turned by arcsin β, in edge lengths at its distance (of all eight, both cubes upright, on a level with you):",
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
    l.plates([
        Plate::shot("near_rest", "1.5 edges away, at rest.", cube(1.5, 0.0)?),
        Plate::shot("near", "At 0.9c: no turned cube looks so.", cube(1.5, 0.9)?),
    ]);
    let reel = cube(4.0, 0.9)?.reel(72, 24.0)?;
    l.plates([Plate::reel("film", "Passing at 0.9c: it seems to turn all the way as it passes.", reel)]);
    l.attempt("terrell render cube --beta 0.99 --color geometry", "Fig. 2: the cube of the paper");
    l.attempt("terrell render your.glb --beta 0.9 --color geometry", "anything of your own, turned");
    l.attempt("terrell render cube --beta 0.99", "the same with its light: shifted to the red and dark");
    let seen = Abreast::new(0.8, far)?;
    let [near, back] = [[0.5, -0.5, -0.5, -0.5], [-0.5, -0.5, -0.5, 0.5]]
        .map(|[a, b, c, d]| seen.across(a, b) - seen.across(c, d));
    let (near, back) =
        (l.fixed("answer: near side at 0.8c", near, 2), l.fixed("answer: back at 0.8c", back, 2));
    let turn = l.fixed("answer: arcsin of 0.8, degrees", 0.8f64.asin().to_degrees(), 2);
    l.ask(
        "How wide are the near side and the back of a small distant cube of edge 1 seen at 0.8c, and by which angle does it seem to be turned?",
        format!("{near} and {back}; arcsin 0.8 = {turn}°."),
    );
    Ok(lecture)
}

/// A cube of edge 1 on a level with who looks, whose middle looks to be abreast.
struct Abreast {
    map: ApparentMap,
    beta: f64,
    distance: f64,
}

impl Abreast {
    fn new(beta: f64, distance: f64) -> Result<Self, TeachError> {
        Ok(Self { map: passing(beta)?, beta, distance })
    }

    /// Where a point of it is seen: along the motion, away and up.
    fn seen(&self, point: DVec3) -> DVec3 {
        // x′ = β r′ is seen at x = 0.
        let middle = DVec3::new(self.map.speed() * self.distance, self.distance, 0.0);
        self.map.see(middle + point).position
    }

    /// Where the same point of a cube at rest is that is turned by arcsin β.
    fn turned(&self, point: DVec3) -> DVec3 {
        let (sine, cosine) = (self.beta, (1.0 - self.beta * self.beta).sqrt());
        let DVec3 { x, y, z } = point;
        DVec3::new(cosine * x - sine * y, self.distance + sine * x + cosine * y, z)
    }

    /// Where what is seen there is in the picture, in lengths at its distance.
    fn pictured(&self, at: DVec3) -> DVec2 {
        DVec2::new(at.x, at.z) * (self.distance / at.y)
    }

    /// Where a point half way up is in the picture along the motion.
    fn across(&self, x: f64, y: f64) -> f64 {
        self.pictured(self.seen(DVec3::new(x, y, 0.0))).x
    }

    /// How far corners of both are apart in the picture, at worst.
    fn worst(&self) -> f64 {
        let side = |corner: u32, axis: u32| if (corner >> axis) & 1 == 0 { -0.5 } else { 0.5 };
        let apart = (0..8).map(|corner| {
            let point = DVec3::new(side(corner, 0), side(corner, 1), side(corner, 2));
            self.pictured(self.seen(point)).distance(self.pictured(self.turned(point)))
        });
        apart.fold(0.0, f64::max)
    }
}

fn plan(distance: f64) -> Result<Panel, TeachError> {
    let square = Abreast::new(0.9, distance)?;
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)];
    let local = |p: DVec3| [p.x, p.y - distance];
    let level = |(x, y): (f64, f64)| DVec3::new(x, y, 0.0);
    let seen = corners.windows(2).flat_map(|side| {
        (0..=16).map(|i| {
            let t = f64::from(i) / 16.0;
            let (a, b) = (side[0], side[1]);
            local(square.seen(level(a).lerp(level(b), t)))
        })
    });
    let mut series = vec![
        Series::line("seen", seen.collect::<Vec<_>>()),
        Series {
            stroke: Stroke::Dashed,
            ..Series::line("turned", corners.map(|corner| local(square.turned(level(corner)))))
        },
    ];
    // Lines of sight through the corners that are seen.
    for corner in &corners[..4] {
        let at = square.seen(level(*corner));
        let towards = at / at.y;
        let ends = [-1.3, 1.3].map(|away| [towards.x * (distance + away), away]);
        series.push(Series { ink: Some([190; 3]), ..Series::line("", ends) });
    }
    let dots = corners[..4].iter().map(|corner| {
        let [x, y] = local(square.seen(level(*corner)));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chequered_cube_is_a_cube() {
        let shot = cube(3.0, 0.9).unwrap();
        let mesh = &shot.scene.bodies[0].mesh;
        assert_eq!(mesh.triangles.len() as u32, 6 * 2 * FIELDS * FIELDS);
        let corners = || (0..mesh.triangles.len()).map(|t| mesh.corners(t));
        let volume: f64 = corners().map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
        let surface: f64 = corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum();
        // The scene's rotation is of f64; the cube that ships has few digits.
        assert!((volume - 1.0).abs() < 1e-9 && (surface - 6.0).abs() < 1e-9, "{volume} {surface}");
        let Paint::Faces(colors) = &mesh.paint else { panic!("{:?}", mesh.paint) };
        assert_eq!(colors.len(), mesh.triangles.len());
        // Six sides, bright and dark.
        let different: std::collections::HashSet<_> = colors.iter().map(|c| c.map(f32::to_bits)).collect();
        assert_eq!(different.len(), 12);
    }
}
