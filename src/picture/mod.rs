//! Films to files.

mod exr;
mod output;
mod png;

pub use exr::write_exr;
pub use output::{Format, WriteError, write, write_whole};
pub use png::{linear, pixels_srgb, write_png};
