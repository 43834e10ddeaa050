@group(0) @binding(0) var<uniform> job: Pass;
@group(0) @binding(1) var<storage, read> skies: array<Sky>;
@group(0) @binding(2) var<storage, read> shapes: array<Shape>;
// Of a quad: columns and rows of pixels, 16 bits each, its shape. Of a polygon: its vertices and its shape.
@group(0) @binding(3) var<storage, read> figures: array<vec4<u32>>;
// Rest-frame offsets from the observer in light-cone coordinates: x′·e₁, x′·e₂, r′ + x′·û, r′ − x′·û.
@group(0) @binding(4) var<storage, read> vertices: array<vec4<f32>>;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) shape: u32,
}

struct Seen {
    // Number of the shape, from 1 on.
    @location(0) shape: u32,
    @builtin(frag_depth) depth: f32,
}

// The pixels a triangle may be seen in.
@vertex
fn quad(@builtin(vertex_index) index: u32) -> Corner {
    let figure = figures[index / 6u];
    let corner = index % 6u;
    let right = corner == 1u || corner == 2u || corner == 4u;
    let below = corner == 2u || corner == 4u || corner == 5u;
    let x = select(figure.x & 0xffffu, figure.x >> 16u, right);
    let y = select(figure.y & 0xffffu, figure.y >> 16u, below);
    let at = (vec2<f32>(vec2(x, y)) - vec2<f32>(job.corner)) * 2.0 / vec2<f32>(job.part) - 1.0;
    return Corner(vec4(at.x, -at.y, 0.5, 1.0), figure.z);
}

// A corner of an apparent triangle where the observer sees it (Nollert et al. 2000, Eq. 1): the light-cone coordinates of
// where it is at rest over k and times k, before a pinhole.
@vertex
fn polygon(@builtin(vertex_index) index: u32) -> Corner {
    let figure = figures[index / 3u];
    let sky = skies[shapes[figure.w].owns_and_body >> 3u];
    let rest = vertices[figure[index % 3u]];
    let along = 0.5 * (rest.z * sky.inverse_k - rest.w * sky.k);
    let seen = rest.x * sky.first + rest.y * sky.second + along * sky.axis;
    let middle = job.middle - vec2<f32>(job.corner) + 0.5 - job.sample;
    let pixel = vec2(seen.x, -seen.y) / job.inverse_focal.x + middle * seen.z;
    let at = 2.0 * pixel / vec2<f32>(job.part) - seen.z;
    return Corner(vec4(at.x, -at.y, 0.5 * seen.z, seen.z), figure.w);
}

// Order is that of the numbers' bits, and half of them is a number below 2.
fn depth_of(nearness: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(nearness) >> 1u);
}

fn pixel_of(position: vec4<f32>) -> vec2<f32> {
    return floor(position.xy) + vec2<f32>(job.corner);
}

@fragment
fn inside_quad(corner: Corner) -> Seen {
    let shape = shapes[corner.shape];
    let seen = sight(job, skies[shape.owns_and_body >> 3u], pixel_of(corner.position), job.sample);
    if !is_inside(shape, seen) {
        discard;
    }
    return Seen(corner.shape + 1u, depth_of(nearness(shape, seen)));
}

@fragment
fn inside_polygon(corner: Corner) -> Seen {
    let shape = shapes[corner.shape];
    let seen = sight(job, skies[shape.owns_and_body >> 3u], pixel_of(corner.position), job.sample);
    return Seen(corner.shape + 1u, depth_of(nearness(shape, seen)));
}
