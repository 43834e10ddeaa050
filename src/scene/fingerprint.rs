use super::{Paint, Scene, SkyTexture};

/// A number that differs where what is drawn may differ: FNV-1a (G. Fowler, L. Noll, K.-P. Vo), 64 bits.
///
/// The same on all machines, so that it can be kept in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl std::fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl Fingerprint {
    /// With more bytes.
    #[must_use]
    pub fn with(self, bytes: impl IntoIterator<Item = u8>) -> Self {
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        Self(bytes.into_iter().fold(self.0, step))
    }

    /// With a value as it is written for debugging: all its digits.
    #[must_use]
    pub fn with_value(self, value: &impl std::fmt::Debug) -> Self {
        // A zero ends it, or "1" "23" would be "12" "3".
        self.with(format!("{value:?}\0").bytes())
    }

    fn with_numbers(self, numbers: &[f64]) -> Self {
        self.with(numbers.iter().flat_map(|v| v.to_le_bytes()))
    }
}

impl Scene {
    /// Of all that is drawn, and how the camera is there, but not of the view.
    pub fn fingerprint(&self) -> Fingerprint {
        let mut out = Fingerprint::default();
        for body in &self.bodies {
            let mesh = &body.mesh;
            out = out.with_value(&(&body.motion, &body.clip));
            out = out.with_numbers(&mesh.x).with_numbers(&mesh.y).with_numbers(&mesh.z);
            out =
                out.with(mesh.triangles.iter().flatten().chain(&mesh.material).flat_map(|v| v.to_le_bytes()));
            out = out.with(mesh.uv.iter().flatten().flat_map(|v| v.to_le_bytes()));
            let colors = match &mesh.paint {
                Paint::Uniform(color) => std::slice::from_ref(color),
                Paint::Faces(colors) | Paint::Vertices(colors) => colors,
            };
            out = out.with(colors.iter().flatten().flat_map(|v| v.to_le_bytes()));
            for material in &mesh.materials {
                for texture in [&material.base_texture, &material.emission_texture] {
                    out = out.with_value(&texture.is_some());
                    if let Some(texture) = texture {
                        out = out.with_value(&(texture.wrap, texture.blocky, texture.transform));
                        out = out.with(texture.picture.texels().iter().flatten().copied());
                    }
                }
                out = out.with_value(&(
                    material.base_color,
                    material.emission,
                    material.surface,
                    &material.spectrum,
                    material.law,
                    material.gloss,
                    material.one_sided,
                ));
            }
        }
        if let Some(sky) = &self.sky {
            out = out.with_value(&(sky.texture.describe(), &sky.spectrum, sky.rotation));
            if let SkyTexture::Picture(texture) = &sky.texture {
                out = out.with(texture.picture.texels().iter().flatten().copied());
            }
        }
        out.with_value(&(&self.lights, self.spacetime, self.view.stance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin_scenes;

    #[test]
    fn it_is_the_published_function() {
        // Test vectors of the authors.
        assert_eq!(Fingerprint::default().with(*b"a").to_string(), "af63dc4c8601ec8c");
        assert_eq!(Fingerprint::default().with(*b"foobar").to_string(), "85944171f73967e8");
    }

    #[test]
    fn scenes_that_differ_have_others() {
        let scene = builtin_scenes()[0].scene();
        let own = scene.fingerprint();
        assert_eq!(own, builtin_scenes()[0].scene().fingerprint());
        let mut other = scene.clone();
        other.set_speed(crate::scene::Speed::Along(0.1)).unwrap();
        assert_ne!(other.fingerprint(), own);
        let mut other = scene.clone();
        std::sync::Arc::make_mut(&mut other.bodies[0].mesh).z[3] += 1e-9;
        assert_ne!(other.fingerprint(), own);
        let mut other = scene.clone();
        std::sync::Arc::make_mut(&mut other.bodies[0].mesh).materials[1].base_color[0] += 1e-6;
        assert_ne!(other.fingerprint(), own);
    }
}
