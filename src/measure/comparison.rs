use super::marks::marks;
use super::{Faces, Mark, Reference};
use crate::film::Film;

/// How far a film is from a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Of every pixel, whether both see the same.
    pub marks: Vec<Mark>,
    /// How faces were compared.
    pub faces: Faces,
    /// Of all pixels but those left out.
    pub whole: Figures,
    /// Of the reference's inner pixels alone, if it says which they are.
    pub inner: Option<Figures>,
}

/// What there is to say of some pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// How many are compared.
    pub pixels: usize,
    /// Those that see another body; none if the reference has no bodies.
    pub silhouette: Option<Disagreement>,
    /// Those that see the same body and another face of it; none if the reference has no faces.
    pub edges: Option<Disagreement>,
    /// Relative, where both see the same face (or body, if the reference has no faces).
    pub distance: Option<Worst>,
    /// Likewise.
    pub doppler: Option<Worst>,
    /// Linear light.
    pub radiance: Radiance,
    /// Linear light where both see the same face: without what outlines and edges bring in.
    pub radiance_same_face: Option<Radiance>,
    /// Pixels whose light is infinite or none in the film; they count for nothing else of light.
    pub not_finite: usize,
}

/// Pixels that see something else.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Disagreement {
    /// How many.
    pub pixels: usize,
    /// Of them, those where what is seen instead is seen by none of the reference's nine pixels around, nor do its
    /// [corners](super::Corners), where they are known, see several things: no outline that is off by up to a pixel
    /// explains them, unless by something that is too thin for the reference to see.
    pub beyond: usize,
    /// The first of the latter, column and row from the upper left, at most [`SHOWN`](Self::SHOWN).
    pub where_beyond: Vec<[u32; 2]>,
}

/// The greatest relative difference of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// |value/reference − 1|.
    pub relative: f64,
    /// Column and row of the pixel, from the upper left.
    pub at: [u32; 2],
}

/// How far light is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Radiance {
    /// √(Σ|Δ|²/Σ|reference|²) over pixels and channels; infinite if the reference is black and the film is not.
    pub relative_rms: f64,
    /// The greatest |Δ| of a channel, in units of the peak.
    pub worst: f64,
    /// Column and row of the pixel it is in, from the upper left.
    pub at: [u32; 2],
    /// The greatest channel of the reference among all pixels that are compared.
    pub peak: f64,
}

/// Films of different sizes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the reference has {}x{} pixels and the picture {}x{}; they must be of one size", .reference[0], .reference[1], .film[0], .film[1])]
pub struct SizesDiffer {
    /// Width and height.
    pub reference: [u32; 2],
    /// Width and height.
    pub film: [u32; 2],
}

impl Disagreement {
    /// The most pixels that are named.
    pub const SHOWN: usize = 16;

    fn of<'a>(film: &Film, marks: impl Iterator<Item = (usize, &'a Mark)>, near: Mark, beyond: Mark) -> Self {
        let mut found = Self::default();
        for (i, &mark) in marks.filter(|(_, mark)| [near, beyond].contains(mark)) {
            found.pixels += 1;
            if mark == beyond {
                found.beyond += 1;
                if found.where_beyond.len() < Self::SHOWN {
                    found.where_beyond.push(place(film, i));
                }
            }
        }
        found
    }
}

impl Comparison {
    /// Compares a film with a reference. A panorama's left and right sides count as apart.
    ///
    /// # Errors
    /// If they are not of one size.
    pub fn new(reference: &Reference, film: &Film) -> Result<Self, SizesDiffer> {
        let sizes = [&reference.film, film].map(|film| [film.width, film.height]);
        if sizes[0] != sizes[1] {
            return Err(SizesDiffer { reference: sizes[0], film: sizes[1] });
        }
        let (marks, faces) = marks(reference, film);
        let among = |included: &dyn Fn(usize) -> bool| {
            let pixels: Vec<usize> =
                (0..marks.len()).filter(|&i| marks[i] != Mark::LeftOut && included(i)).collect();
            figures(reference, film, &marks, faces, &pixels)
        };
        let whole = among(&|_| true);
        let inner = reference.inner.as_ref().map(|inner| among(&|i| inner[i]));
        Ok(Self { whole, inner, marks, faces })
    }
}

fn place(film: &Film, pixel: usize) -> [u32; 2] {
    let pixel = pixel as u64;
    let width = u64::from(film.width);
    [(pixel % width) as u32, (pixel / width) as u32]
}

fn figures(reference: &Reference, film: &Film, marks: &[Mark], faces: Faces, pixels: &[usize]) -> Figures {
    let (known, expected) = (reference.known, &reference.film);
    let marked = || pixels.iter().map(|&i| (i, &marks[i]));
    let has_faces = faces != Faces::Unknown;
    let silhouette =
        known.body.then(|| Disagreement::of(film, marked(), Mark::Silhouette, Mark::BeyondSilhouette));
    let edges = has_faces.then(|| Disagreement::of(film, marked(), Mark::Edge, Mark::BeyondEdge));
    // The sky is no face.
    let is_sky = |i: usize| known.body && expected.body[i] < 0;
    let same = || marked().filter(|(i, mark)| **mark == Mark::Same && !is_sky(*i)).map(|(i, _)| i);
    let worst = |known: bool, values: &[f32], expected: &[f32]| {
        known.then(|| worst(film, values, expected, same())).flatten()
    };
    let is_finite = |i: &usize| film.color[*i].iter().all(|v| v.is_finite());
    let finite: Vec<usize> = pixels.iter().copied().filter(is_finite).collect();
    let peak = finite.iter().flat_map(|&i| expected.color[i]).fold(0.0, f32::max);
    let radiance = |pixels: &mut dyn Iterator<Item = usize>| radiance(film, expected, peak.into(), pixels);
    Figures {
        pixels: pixels.len(),
        silhouette,
        edges,
        distance: worst(known.distance, &film.distance, &expected.distance),
        doppler: worst(known.doppler, &film.doppler, &expected.doppler),
        radiance: radiance(&mut finite.iter().copied()),
        radiance_same_face: has_faces.then(|| radiance(&mut same().filter(is_finite))),
        not_finite: pixels.len() - finite.len(),
    }
}

/// Where the reference is above 0: elsewhere nothing is seen. NaN is worst.
fn worst(
    film: &Film,
    values: &[f32],
    expected: &[f32],
    pixels: impl Iterator<Item = usize>,
) -> Option<Worst> {
    let off = |i: usize| (f64::from(values[i]) / f64::from(expected[i]) - 1.0).abs();
    let found = pixels
        .filter(|&i| expected[i] > 0.0)
        .map(|i| (off(i), i))
        .map(|(off, i)| (if off.is_nan() { f64::INFINITY } else { off }, i));
    found
        .reduce(|a, b| if b.0 > a.0 { b } else { a })
        .map(|(relative, i)| Worst { relative, at: place(film, i) })
}

fn radiance(film: &Film, expected: &Film, peak: f64, pixels: &mut dyn Iterator<Item = usize>) -> Radiance {
    let (mut off, mut all, mut worst) = (0.0, 0.0, (0.0, 0));
    for i in pixels {
        for (value, expected) in film.color[i].into_iter().zip(expected.color[i]) {
            let difference = f64::from(value) - f64::from(expected);
            off += difference * difference;
            all += f64::from(expected) * f64::from(expected);
            if difference.abs() > worst.0 {
                worst = (difference.abs(), i);
            }
        }
    }
    let ratio = |part: f64, whole: f64| if part == 0.0 { 0.0 } else { part / whole };
    Radiance {
        relative_rms: ratio(off, all).sqrt(),
        worst: ratio(worst.0, peak),
        at: place(film, worst.1),
        peak,
    }
}

#[cfg(test)]
mod tests {
    use super::super::Corners;
    use super::*;

    const SIZE: [u32; 2] = [8, 6];

    fn at(x: usize, y: usize) -> usize {
        y * SIZE[0] as usize + x
    }

    /// A body of two faces, side by side, in columns 2 and 3 and 4 and 5, before nothing.
    fn film() -> Film {
        let mut film = Film::new(SIZE[0], SIZE[1]);
        for y in 1..5 {
            for x in 2..6 {
                let i = at(x, y);
                (film.body[i], film.face[i]) = (0, i32::from(x > 3));
                (film.distance[i], film.doppler[i], film.color[i]) = (4.0, 2.0, [1.0, 0.5, 0.0]);
            }
        }
        film
    }

    fn see(film: &mut Film, i: usize, from: usize) {
        (film.body[i], film.face[i]) = (film.body[from], film.face[from]);
        (film.distance[i], film.doppler[i], film.color[i]) =
            (film.distance[from], film.doppler[from], film.color[from]);
    }

    fn compare(film: &Film) -> Comparison {
        Comparison::new(&self::film().into(), film).unwrap()
    }

    #[test]
    fn a_film_is_as_it_is() {
        let same = compare(&film());
        assert!(same.marks.iter().all(|m| *m == Mark::Same) && same.inner.is_none());
        let Figures { pixels, silhouette, edges, distance, doppler, radiance, .. } = same.whole;
        assert_eq!(
            (pixels, silhouette, edges),
            (48, Some(Disagreement::default()), Some(Disagreement::default()))
        );
        assert_eq!([distance.unwrap().relative, doppler.unwrap().relative], [0.0; 2]);
        assert_eq!(radiance, Radiance { relative_rms: 0.0, worst: 0.0, at: [0, 0], peak: 1.0 });
    }

    #[test]
    fn an_outline_one_pixel_off_is_a_silhouette_and_a_hole_is_not() {
        let mut moved = film();
        see(&mut moved, at(2, 2), at(0, 0));
        see(&mut moved, at(6, 3), at(5, 3));
        let silhouette = compare(&moved).whole.silhouette.unwrap();
        assert_eq!((silhouette.pixels, silhouette.beyond), (2, 0));
        // Two off, and a hole whose surroundings see the body alone.
        see(&mut moved, at(7, 3), at(5, 3));
        see(&mut moved, at(3, 3), at(0, 0));
        let silhouette = compare(&moved).whole.silhouette.unwrap();
        assert_eq!((silhouette.pixels, silhouette.beyond), (4, 2));
        assert_eq!(silhouette.where_beyond, [[3, 3], [7, 3]]);
        // At a silhouette, but a body that is nowhere near.
        let mut other = film();
        other.body[at(2, 2)] = 7;
        assert_eq!(compare(&other).whole.silhouette.unwrap().beyond, 1);
    }

    /// Something thin, which no pixel's centre sees, but a corner.
    #[test]
    fn corners_tell_of_what_centres_do_not_see() {
        let thin = Film::new(SIZE[0], SIZE[1]);
        let mut met = thin.clone();
        (met.body[at(4, 4)], met.face[at(4, 4)]) = (3, 5);
        let silhouette = |corners: Option<Corners>| {
            let reference = Reference { corners, ..Reference::from(thin.clone()) };
            Comparison::new(&reference, &met).unwrap().whole.silhouette.unwrap()
        };
        assert_eq!((silhouette(None).pixels, silhouette(None).beyond), (1, 1));
        let corners = |corner: &Film| {
            Some(Corners::new(&thin, &[thin.clone(), corner.clone(), thin.clone(), thin.clone()]))
        };
        assert_eq!(silhouette(corners(&thin)).beyond, 1);
        assert_eq!((silhouette(corners(&met)).pixels, silhouette(corners(&met)).beyond), (1, 0));
        // Of faces likewise, and only there.
        let mut other = film();
        other.face[at(2, 4)] = 9;
        let mut corner = film();
        corner.face[at(2, 4)] = 9;
        let edges = |corner: &Film, got: &Film| {
            let corners = Corners::new(&film(), &[film(), film(), film(), corner.clone()]);
            let reference = Reference { corners: Some(corners), ..Reference::from(film()) };
            Comparison::new(&reference, got).unwrap().whole.edges.unwrap()
        };
        assert_eq!((edges(&film(), &other).beyond, edges(&corner, &other).beyond), (1, 0));
        assert_eq!(edges(&corner, &film()).pixels, 0);
    }

    #[test]
    fn faces_count_where_the_body_is_the_same() {
        let mut moved = film();
        see(&mut moved, at(4, 2), at(3, 2));
        see(&mut moved, at(2, 4), at(4, 4));
        let figures = compare(&moved).whole;
        let edges = figures.edges.unwrap();
        assert_eq!((edges.pixels, edges.beyond, edges.where_beyond), (2, 1, vec![[2, 4]]));
        assert_eq!(figures.silhouette.unwrap().pixels, 0);
    }

    #[test]
    fn light_in_closed_form() {
        let mut off = film();
        // One channel of one of 16 pixels of |c|² = 1.25, by 0.1.
        off.color[at(3, 2)][0] = 1.125;
        let light = compare(&off).whole.radiance;
        assert!((light.relative_rms - 0.125 / 20f64.sqrt()).abs() < 1e-15, "{light:?}");
        assert_eq!((light.worst, light.at, light.peak), (0.125, [3, 2], 1.0));
        // A silhouette counts, but not as what the same face shines with.
        let mut moved = film();
        see(&mut moved, at(2, 2), at(0, 0));
        let figures = compare(&moved).whole;
        assert_eq!(figures.radiance.worst, 1.0);
        assert!((figures.radiance.relative_rms - (1.0f64 / 16.0).sqrt()).abs() < 1e-15);
        assert_eq!(figures.radiance_same_face.unwrap().worst, 0.0);
        // Light where there was none at all.
        let dark = Reference::from(Film::new(SIZE[0], SIZE[1]));
        let light = Comparison::new(&dark, &film()).unwrap().whole.radiance;
        assert!(light.relative_rms.is_infinite() && light.worst.is_infinite());
        let mut broken = film();
        broken.color[0][1] = f32::NAN;
        let figures = compare(&broken).whole;
        assert_eq!((figures.not_finite, figures.radiance.worst), (1, 0.0));
    }

    #[test]
    fn distances_and_shifts_count_where_the_same_is_seen() {
        let mut off = film();
        off.distance[at(5, 4)] = 4.5;
        off.doppler[at(2, 1)] = 1.5;
        // Another face: it is that face's distance.
        see(&mut off, at(3, 3), at(4, 3));
        off.distance[at(3, 3)] = 9.0;
        let figures = compare(&off).whole;
        assert_eq!(figures.distance, Some(Worst { relative: 0.125, at: [5, 4] }));
        assert_eq!(figures.doppler, Some(Worst { relative: 0.25, at: [2, 1] }));
        off.doppler[at(3, 1)] = f32::NAN;
        assert_eq!(compare(&off).whole.doppler.unwrap().relative, f64::INFINITY);
    }

    #[test]
    fn what_the_reference_does_not_know_is_not_said() {
        let mut reference = Reference::from(film());
        reference.left_out[at(3, 3)] = true;
        let mut hole = film();
        see(&mut hole, at(3, 3), at(0, 0));
        let found = Comparison::new(&reference, &hole).unwrap();
        assert_eq!((found.whole.pixels, found.marks[at(3, 3)]), (47, Mark::LeftOut));
        assert_eq!((found.whole.silhouette.unwrap().pixels, found.whole.radiance.worst), (0, 0.0));
        reference.inner = Some((0..48).map(|i| i == at(3, 2)).collect());
        assert_eq!(Comparison::new(&reference, &hole).unwrap().inner.unwrap().pixels, 1);
        reference.known.face = false;
        let without = Comparison::new(&reference, &hole).unwrap();
        assert_eq!((without.faces, without.whole.edges), (Faces::Unknown, None));
        assert!(without.whole.radiance_same_face.is_none() && without.whole.distance.is_some());
        reference.known.body = false;
        assert_eq!(Comparison::new(&reference, &hole).unwrap().whole.silhouette, None);
        let other = Comparison::new(&reference, &Film::new(4, 4)).unwrap_err();
        assert!(other.to_string().contains("8x6") && other.to_string().contains("4x4"), "{other}");
    }

    #[test]
    fn faces_numbered_otherwise_are_told_by_what_they_cover() {
        let mut reference = Reference::from(film());
        // One polygon of both triangles, and a number we do not have.
        reference.film.face.iter_mut().filter(|face| **face >= 0).for_each(|face| *face = 40);
        reference.renumbered = true;
        let found = Comparison::new(&reference, &film()).unwrap();
        assert_eq!((found.faces, found.whole.edges.unwrap().pixels), (Faces::Renumbered, 0));
        // Two faces, exchanged, of which one pixel is wrong.
        let mut reference = Reference { renumbered: true, ..Reference::from(film()) };
        reference.film.face.iter_mut().filter(|face| **face >= 0).for_each(|face| *face = 1 - *face);
        let mut moved = film();
        see(&mut moved, at(4, 2), at(3, 2));
        assert_eq!(Comparison::new(&reference, &moved).unwrap().whole.edges.unwrap().pixels, 1);
        // The same numbers are taken for the same.
        let reference = Reference { renumbered: true, ..Reference::from(film()) };
        let found = Comparison::new(&reference, &moved).unwrap();
        assert_eq!((found.faces, found.whole.edges.unwrap().pixels), (Faces::Numbered, 1));
    }
}
