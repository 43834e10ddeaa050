// A pixel of the film.
struct Pixel {
    color: vec3<f32>,
    distance: f32,
    doppler: f32,
    body: i32,
    face: i32,
    unused: u32,
}
