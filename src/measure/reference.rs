use crate::film::Film;
use std::iter::zip;

/// What films are compared with: a film, or what a file has of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// What is seen; what is not [known](Self::known) is as on an empty film.
    pub film: Film,
    /// Which of the film's numbers there are; light there always is.
    pub known: Known,
    /// Where all corners of a pixel see the same, if the reference says so: where it cannot matter by how little an
    /// outline is off.
    pub inner: Option<Vec<bool>>,
    /// Of every pixel what its corners see, if that is known.
    pub corners: Option<Corners>,
    /// Pixels of which the reference has no finite numbers: nothing is said of them.
    pub left_out: Vec<bool>,
    /// Whether it may number the triangles of a body otherwise than films do.
    pub renumbered: bool,
}

/// Where a pixel's four corners see what its centre sees: what comes between is too thin to be met by any of the five.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Corners {
    /// Whether they see the same body.
    pub same_body: Vec<bool>,
    /// Whether they see the same face of it.
    pub same_face: Vec<bool>,
}

impl Corners {
    /// Of films of what is seen at the centres, and at each of the corners.
    ///
    /// # Panics
    /// If they are not of one size.
    pub fn new(centres: &Film, corners: &[Film; 4]) -> Self {
        let pixels = centres.body.len();
        assert!(corners.iter().all(|film| film.body.len() == pixels), "films of one size");
        let mut same = Self { same_body: vec![true; pixels], same_face: vec![true; pixels] };
        for film in corners {
            for (same, (a, b)) in zip(&mut same.same_body, zip(&film.body, &centres.body)) {
                *same &= a == b;
            }
            for (same, (a, b)) in zip(&mut same.same_face, zip(&film.face, &centres.face)) {
                *same &= a == b;
            }
        }
        for (face, body) in zip(&mut same.same_face, &same.same_body) {
            *face &= body;
        }
        same
    }
}

/// Which numbers there are besides light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Known {
    /// Apparent distances.
    pub distance: bool,
    /// Doppler factors.
    pub doppler: bool,
    /// Bodies, numbered as the scene has them.
    pub body: bool,
    /// Faces.
    pub face: bool,
}

impl From<Film> for Reference {
    /// A film of ours: all is known, and numbered as it is.
    fn from(film: Film) -> Self {
        let left_out = vec![false; film.color.len()];
        let known = Known { distance: true, doppler: true, body: true, face: true };
        Self { film, known, inner: None, corners: None, left_out, renumbered: false }
    }
}
