//! Films to files: one to a picture, many to a movie; and what films are compared with, from files.

mod exr;
mod frames;
mod movie;
mod output;
mod png;
mod read_exr;

pub use exr::write_exr;
pub use frames::{FrameFolder, FramesError};
pub use movie::{Movie, MovieError, MovieFormat};
pub use output::{Format, Pending, WriteError, prepare, prepare_picture, remove_unfinished, write};
pub use png::{pixels_srgb, write_png, write_png_pixels};
pub use read_exr::{ReadError, read_reference};
