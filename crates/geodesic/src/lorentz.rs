use crate::{Celerity, FourVector, Real};
use glam::{DMat3, DVec3};
use std::marker::PhantomData;
use std::ops::Mul;

/// A Lorentz map: takes components in the frame `From` to components in the frame `To`.
///
/// A full 4×4 matrix, so that boosts in different directions compose to what they are, a boost *and* a
/// rotation (Wigner). `S` sets the digits.
#[derive(Debug, PartialEq)]
pub struct Lorentz<To, From, S = f64> {
    rows: [[S; 4]; 4],
    frames: PhantomData<fn(From) -> To>,
}

impl<To, From, S: Copy> Copy for Lorentz<To, From, S> {}
impl<To, From, S: Copy> Clone for Lorentz<To, From, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<To, From, S: Real> Lorentz<To, From, S> {
    fn from_rows(rows: [[S; 4]; 4]) -> Self {
        Self { rows, frames: PhantomData }
    }

    /// The boost to the frame in which a body at rest in `From` moves with `celerity`, axes kept parallel:
    /// t = γt′ + u·x′, x = x′ + u(t′ + u·x′/(1 + γ)).
    pub fn boost(celerity: &Celerity) -> Self {
        let u = celerity.vector().to_array().map(S::from);
        let gamma: S = celerity.gamma_as();
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let mut rows = [[zero; 4]; 4];
        rows[0][0] = gamma;
        for i in 0..3 {
            rows[0][i + 1] = u[i];
            rows[i + 1][0] = u[i];
            for j in 0..3 {
                let unit = if i == j { one } else { zero };
                rows[i + 1][j + 1] = unit + u[i] * u[j] / (one + gamma);
            }
        }
        Self::from_rows(rows)
    }

    /// The change to new axes of the same rest frame: the rows of `axes` are the new unit vectors.
    pub fn rotation(axes: [DVec3; 3]) -> Self {
        let (zero, one) = (S::from(0.0), S::from(1.0));
        let mut rows = [[zero; 4]; 4];
        rows[0][0] = one;
        for (i, axis) in axes.iter().enumerate() {
            for j in 0..3 {
                rows[i + 1][j + 1] = axis[j].into();
            }
        }
        Self::from_rows(rows)
    }

    /// The map back: η Lᵀ η.
    pub fn inverse(&self) -> Lorentz<From, To, S> {
        let mut rows = self.rows;
        for (i, row) in rows.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let transposed = self.rows[j][i];
                *entry = if (i == 0) == (j == 0) { transposed } else { -transposed };
            }
        }
        Lorentz::from_rows(rows)
    }

    /// The same map with the digits of f64.
    pub fn rounded(&self) -> Lorentz<To, From, f64> {
        Lorentz::from_rows(self.rows.map(|row| row.map(S::value)))
    }

    /// The matrix, row by row: component `i` in `To` is the sum over `j` of `rows()[i][j]` times component
    /// `j` in `From`.
    pub fn rows(&self) -> [[S; 4]; 4] {
        self.rows
    }

    /// Relative Lorentz factor of the two frames.
    pub fn gamma(&self) -> S {
        self.rows[0][0]
    }

    /// Celerity with which a body at rest in `From` moves in `To`, in the axes of `From`: the map is this boost, then [`axes`](Self::axes).
    pub fn celerity_in_from(&self) -> [S; 3] {
        [self.rows[0][1], self.rows[0][2], self.rows[0][3]]
    }

    /// The rotation left when the boost by [`celerity_in_from`](Self::celerity_in_from) is taken off:
    /// R = L_ij − L_i0 L_0j/(1 + γ).
    pub fn axes(&self) -> [[S; 3]; 3] {
        let scale = S::from(1.0) + self.gamma();
        let entry =
            |i: usize, j: usize| self.rows[i + 1][j + 1] - self.rows[i + 1][0] * self.rows[0][j + 1] / scale;
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
    }

    /// Angle of that rotation in radians; the Wigner angle where the map is two boosts composed.
    pub fn rotation_angle(&self) -> f64 {
        let rows = self.axes().map(|row| DVec3::from_array(row.map(S::value)));
        let axes = DMat3::from_cols(rows[0], rows[1], rows[2]);
        // sin from the antisymmetric part, cos from the trace: accurate at both ends.
        let sine = 0.5
            * DVec3::new(
                axes.y_axis.z - axes.z_axis.y,
                axes.z_axis.x - axes.x_axis.z,
                axes.x_axis.y - axes.y_axis.x,
            )
            .length();
        let cosine = 0.5 * (axes.x_axis.x + axes.y_axis.y + axes.z_axis.z - 1.0);
        sine.atan2(cosine)
    }
}

impl<To, Mid, From, S: Real> Mul<Lorentz<Mid, From, S>> for Lorentz<To, Mid, S> {
    type Output = Lorentz<To, From, S>;

    fn mul(self, first: Lorentz<Mid, From, S>) -> Self::Output {
        let mut rows = [[S::from(0.0); 4]; 4];
        for (row, of_self) in rows.iter_mut().zip(self.rows) {
            for (j, entry) in row.iter_mut().enumerate() {
                *entry = (0..4).fold(S::from(0.0), |sum, k| sum + of_self[k] * first.rows[k][j]);
            }
        }
        Lorentz::from_rows(rows)
    }
}

impl<To, From, S: Real> Mul<FourVector<From, S>> for Lorentz<To, From, S> {
    type Output = FourVector<To, S>;

    #[inline]
    fn mul(self, vector: FourVector<From, S>) -> Self::Output {
        let [x, y, z] = vector.space;
        let component = |row: [S; 4]| row[0] * vector.t + row[1] * x + row[2] * y + row[3] * z;
        let [t_row, x_row, y_row, z_row] = self.rows;
        FourVector::new(component(t_row), component(x_row), component(y_row), component(z_row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Observer, Rest, Wide, World};
    use proptest::prelude::*;

    fn celerity(limit: f64) -> impl Strategy<Value = Celerity> {
        let component = move || -limit..limit;
        (component(), component(), component())
            .prop_map(|(x, y, z)| Celerity::new(DVec3::new(x, y, z)).unwrap())
    }

    #[test]
    fn perpendicular_boosts_turn_by_the_wigner_angle() {
        // 0.6c then 0.8c at right angles: tan(angle) closed form gives 18.9246°.
        let first = Lorentz::<World, Rest>::boost(&Celerity::from_beta(DVec3::X * 0.6).unwrap());
        let second = Lorentz::<Observer, World>::boost(&Celerity::from_beta(DVec3::Y * 0.8).unwrap());
        let (g1, g2) = (1.25f64, 5.0 / 3.0);
        // cos ε = (γ₁ + γ₂)/(1 + γ₁γ₂) for perpendicular boosts.
        let expected = ((g1 + g2) / (1.0 + g1 * g2)).acos();
        let angle = (second * first).rotation_angle();
        assert!((angle - expected).abs() < 1e-14);
        assert!((angle.to_degrees() - 18.9).abs() < 0.05);
    }

    #[test]
    fn a_pure_boost_has_no_rotation() {
        let boost = Lorentz::<World, Rest>::boost(&Celerity::new(DVec3::new(3.0, -2.0, 0.5)).unwrap());
        assert!(boost.rotation_angle() < 1e-14);
    }

    proptest! {
        #[test]
        fn products_of_four_vectors_do_not_change(
            u in celerity(30.0), a in prop::array::uniform4(-5.0..5.0f64), b in prop::array::uniform4(-5.0..5.0f64),
        ) {
            let map = Lorentz::<World, Rest, Wide>::boost(&u);
            let [a, b] = [a, b].map(|v| FourVector::<Rest>::new(v[0], v[1], v[2], v[3]).widened::<Wide>());
            let off = (map * a).dot(map * b) - a.dot(b);
            // Wide rounds at 1e-32; γ² ≤ 2700 and products ≤ 100.
            prop_assert!(off.value().abs() < 1e-25, "{off:?}");
        }

        #[test]
        fn there_and_back_is_where_it_was(u in celerity(1e3), x in prop::array::uniform4(-5.0..5.0f64)) {
            let map = Lorentz::<World, Rest, Wide>::boost(&u);
            let event = FourVector::<Rest>::new(x[0], x[1], x[2], x[3]).widened();
            let off = (map.inverse() * (map * event) - event).rounded();
            prop_assert!(off.t.abs().max(off.xyz().length()) < 1e-22);
        }

        #[test]
        fn a_map_is_its_boost_and_then_its_rotation(u in celerity(50.0), v in celerity(50.0)) {
            let whole = Lorentz::<Observer, World, Wide>::boost(&v) * Lorentz::<World, Rest, Wide>::boost(&u);
            let w = DVec3::from_array(whole.celerity_in_from().map(Wide::value));
            let axes = whole.axes().map(|row| DVec3::from_array(row.map(Wide::value)));
            let rebuilt = Lorentz::<Observer, World>::rotation(axes)
                * Lorentz::<World, Rest>::boost(&Celerity::new(w).unwrap());
            let scale = whole.gamma().value();
            for (row, expected) in rebuilt.rows().iter().zip(whole.rows()) {
                for (entry, expected) in row.iter().zip(expected) {
                    prop_assert!((entry - expected.value()).abs() < 1e-14 * scale);
                }
            }
            // and the rotation is one
            for i in 0..3 {
                for j in 0..3 {
                    let unit = if i == j { 1.0 } else { 0.0 };
                    prop_assert!((axes[i].dot(axes[j]) - unit).abs() < 1e-15 * 8.0);
                }
            }
        }
    }
}
