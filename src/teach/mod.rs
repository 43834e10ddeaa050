//! Lessons: what relativistic motion looks like, and why, in words, numbers and pictures.
//!
//! A [`Lesson`] is worked out as a [`Lecture`], whose numbers are computed then, by this library, each under a name; its
//! pictures, figures and films are drawn when they are asked for. A lecture is told as text for a terminal, or as a page that
//! needs nothing else.

mod html;
mod lecture;
mod lessons;
mod markup;
mod plate;
mod told;

pub use html::{index_page, page};
pub use lecture::{Lecture, Number, Part, Question, Table, Try};
pub use lessons::{Lesson, NoSuchLesson, lesson, lessons};
pub use plate::{Drawn, Kind, Plate, Reel, Shot, TeachError, What};
pub use told::{answer, listed, told};
