use super::Texture;

/// What a surface is made of, shared by any number of triangles. Colours are linear sRGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What the file calls it; may be empty.
    pub name: String,
    /// Colour of the surface itself, times [`Paint`](super::Paint).
    pub base_color: [f32; 3],
    /// Times this, where there is one.
    pub base_texture: Option<Texture>,
    /// Light the surface gives off besides.
    pub emission: [f32; 3],
    /// Times this, where there is one.
    pub emission_texture: Option<Texture>,
    /// Whether lamps leave it as it is.
    pub unlit: bool,
    /// Whether it is seen from the front only.
    pub one_sided: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 3],
            base_texture: None,
            emission: [0.0; 3],
            emission_texture: None,
            unlit: false,
            one_sided: false,
        }
    }
}

impl Material {
    /// Whether a texture is on it.
    #[inline]
    pub fn is_textured(&self) -> bool {
        self.base_texture.is_some() || self.emission_texture.is_some()
    }

    /// The surface's colour where its paint is `paint`; `look` gives a texture's colour there.
    #[inline]
    pub fn color(&self, paint: [f32; 3], look: impl Fn(&Texture) -> [f32; 3]) -> [f32; 3] {
        let times = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|i| a[i] * b[i]);
        let textured =
            |color, texture: &Option<Texture>| texture.as_ref().map_or(color, |t| times(color, look(t)));
        let base = times(paint, textured(self.base_color, &self.base_texture));
        if self.emission == [0.0; 3] {
            return base;
        }
        let emission = textured(self.emission, &self.emission_texture);
        [0, 1, 2].map(|i| base[i] + emission[i])
    }

    /// Whether all its numbers are such.
    pub(super) fn is_finite(&self) -> bool {
        self.base_color.iter().chain(&self.emission).all(|v| v.is_finite())
    }
}
