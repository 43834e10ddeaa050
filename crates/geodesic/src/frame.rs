//! The frames that meet; types without values.

/// Where a scene places things.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum World {}

/// The frame in which one body's mesh is static.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rest {}

/// The frame in which a lamp is what it is said to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamp {}

/// The camera's frame: its own motion, its own axes (x right, y up, z forward), its event as origin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observer {}
