use crate::film::Film;

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
    /// Pixels of which the reference has no finite numbers: nothing is said of them.
    pub left_out: Vec<bool>,
    /// Whether it may number the triangles of a body otherwise than films do.
    pub renumbered: bool,
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
        Self { film, known, inner: None, left_out, renumbered: false }
    }
}
