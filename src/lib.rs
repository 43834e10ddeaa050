//! wip
pub mod relativity;
pub mod scene;
pub mod apparent;
pub mod film;
pub use terrell_geodesic as geodesic;
