//! Spectra, and the colours they have when they are shifted.
//!
//! Light of a body in motion is seen with every frequency times D, and I_ν/ν³ the same for all observers (Nollert et
//! al. 2000, Eq. 5): I_ν(ν) = D³ I′_ν(ν/D), and by wavelength I_λ(λ) = D⁵ I′_λ(Dλ). What the eye makes of it is
//! linear in the spectrum, so that the colours of a whole mesh under a shift are one 3×3 matrix: see [`Response`] and
//! [`DopplerTable`].

mod basis;
mod constants;
mod cubic;
mod observer;
mod response;
mod shape;
mod table;
mod tabulated;

pub use basis::{Beyond, reflectances};
pub(crate) use cubic::cubic;
pub(crate) use observer::matching_at;
pub use observer::{XYZ_FROM_RGB, luminance, rgb_from_xyz, xyz_of_black_body};
pub(crate) use response::of_line;
pub use response::{Matrix, Response};
pub use shape::{Shape, Spectrum, SpectrumError, Strength};
pub use table::{DopplerTable, RowTable};
pub(crate) use table::{Near, NearRows};
pub use tabulated::{Tabulated, TabulatedError};
