@group(0) @binding(0) var<uniform> job: Pass;
@group(0) @binding(1) var<storage, read> skies: array<Sky>;
@group(0) @binding(2) var<storage, read> shapes: array<Shape>;
@group(0) @binding(3) var<storage, read> faces: array<Face>;
@group(0) @binding(4) var<storage, read> materials: array<Material>;
// Of tables of colours: three columns a node.
@group(0) @binding(5) var<storage, read> nodes: array<vec4<f32>>;
// Colours of materials, faces or corners.
@group(0) @binding(6) var<storage, read> words: array<u32>;
@group(0) @binding(7) var<storage, read_write> film: array<Pixel>;
@group(0) @binding(8) var seen_shapes: texture_2d<u32>;

struct Face {
    // What edge functions are to be multiplied by to be barycentric coordinates, up to a factor.
    weights: vec3<f32>,
    // Distance of its plane from the observer, in the rest frame.
    plane: f32,
    // Number of the triangle in its mesh, of its material, where its words begin, and its shape uncut.
    number: u32,
    material: u32,
    word: u32,
    shape: u32,
}

struct Material {
    // Unshifted colours of what shines in red, green and blue.
    red: vec3<f32>,
    strength: f32,
    green: vec3<f32>,
    // How light depends on direction.
    law: u32,
    blue: vec3<f32>,
    // What words are there of a face: one colour, or three of corners.
    paint: u32,
    law_numbers: vec2<f32>,
    // The table: ln D of its second node, steps a unit, its first node, and how many there are; none for 0.
    start: f32,
    inverse_step: f32,
    node: u32,
    count: u32,
    unused: vec2<u32>,
}

const SPECTRAL: u32 = 0u;
const FLAT: u32 = 1u;
const BOLOMETRIC: u32 = 2u;
const GEOMETRY: u32 = 3u;
const DOPPLER: u32 = 4u;

const ISOTROPIC: u32 = 0u;
const COSINE: u32 = 1u;

// To the last digit, which the built-in function need not be.
fn ln(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    var exponent = f32(i32(bits >> 23u) - 127);
    var significand = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u);
    if significand > 1.4142135 {
        significand *= 0.5;
        exponent += 1.0;
    }
    let s = (significand - 1.0) / (significand + 1.0);
    let z = s * s;
    return exponent * 0.69314718 + 2.0 * s * (1.0 + z * (1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z / 9.0))));
}

fn word3(at: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(vec3(words[at], words[at + 1u], words[at + 2u]));
}

// The colour seen at ln D of what shines in a colour: the cubic through four nodes.
fn shifted(material: Material, ln_doppler: f32, own: vec3<f32>) -> vec3<f32> {
    let place = clamp((ln_doppler - material.start) * material.inverse_step, 0.0, f32(material.count - 3u));
    let low = min(u32(place), material.count - 4u);
    let t = place - f32(low);
    let a = t + 1.0;
    let b = t - 1.0;
    let c = t - 2.0;
    let weights = vec4(-t * b * c / 6.0, a * b * c / 2.0, -a * t * c / 2.0, a * t * b / 6.0);
    var sum = vec3(0.0);
    for (var i = 0u; i < 4u; i++) {
        let node = material.node + 3u * (low + i);
        let color = own.x * nodes[node].xyz + own.y * nodes[node + 1u].xyz + own.z * nodes[node + 2u].xyz;
        sum += weights[i] * color;
    }
    return sum;
}

fn false_color(doppler: f32) -> vec3<f32> {
    var stops = FALSE_STOPS;
    var colors = FALSE_COLORS;
    let at = clamp(ln(doppler) / (0.69314718 * FALSE_OCTAVES), -1.0, 1.0);
    var above = 1u;
    while above < FALSE_COUNT - 1u && at > stops[above] {
        above += 1u;
    }
    let t = (at - stops[above - 1u]) / (stops[above] - stops[above - 1u]);
    return mix(colors[above - 1u], colors[above], t);
}

fn shines(material: Material, doppler: f32, own: vec3<f32>) -> vec3<f32> {
    if job.coloring == SPECTRAL && material.count > 0u {
        return shifted(material, ln(doppler), own);
    }
    if job.coloring == BOLOMETRIC {
        let square = doppler * doppler;
        return vec3(dot(LUMINANCE, own * material.strength) * square * square);
    }
    let unshifted = material.red * own.x + material.green * own.y + material.blue * own.z;
    return select(unshifted, unshifted * (doppler * doppler * doppler), job.coloring == FLAT);
}

fn law(material: Material, cosine: f32) -> f32 {
    let mu = clamp(cosine, 0.0, 1.0);
    if material.law == ISOTROPIC {
        return 1.0;
    }
    if material.law == COSINE {
        return select(0.0, pow(mu, material.law_numbers.x), mu > 0.0);
    }
    let less = 1.0 - mu;
    return max(1.0 - material.law_numbers.x * less - material.law_numbers.y * less * less, 0.0);
}

// Barycentric coordinates of the mesh's triangle.
fn weights(face: Face, seen: Sight) -> vec3<f32> {
    let shape = shapes[face.shape];
    let all = vec3(edge(shape, 0u, seen), edge(shape, 1u, seen), edge(shape, 2u, seen)) * face.weights;
    let clamped = max(all, vec3(0.0));
    let sum = clamped.x + clamped.y + clamped.z;
    return select(vec3(1.0, 0.0, 0.0), clamped / sum, sum > 0.0);
}

fn own_color(face: Face, material: Material, seen: Sight) -> vec3<f32> {
    if material.paint == 1u {
        return word3(face.word);
    }
    let w = weights(face, seen);
    return w.x * word3(face.word) + w.y * word3(face.word + 3u) + w.z * word3(face.word + 6u);
}

// What can be averaged and written.
fn finite(color: vec3<f32>) -> vec3<f32> {
    let most = vec3(1e35);
    let is_nan = (bitcast<vec3<u32>>(color) & vec3(0x7fffffffu)) > vec3(0x7f800000u);
    return select(clamp(color, -most, most), vec3(0.0), is_nan);
}

@compute @workgroup_size(8, 8)
fn develop(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= job.part) {
        return;
    }
    let at = id.y * job.part.x + id.x;
    if job.is_first == 1u {
        film[at] = Pixel(vec3(0.0), 0.0, 0.0, -1, -1, 0u);
    }
    let number = textureLoad(seen_shapes, vec2<i32>(id.xy), 0).x;
    if number == 0u {
        return;
    }
    let shape = shapes[number - 1u];
    let face = faces[shape.face];
    let body = shape.owns_and_body >> 3u;
    let material = materials[face.material];
    let seen = sight(job, skies[body], vec2<f32>(id.xy + job.corner), job.sample);
    let near = nearness(shape, seen);
    let doppler = seen.length / seen.rest_length;
    var color: vec3<f32>;
    if job.coloring == DOPPLER {
        color = false_color(doppler);
    } else {
        // Of the angle to the normal in the rest frame.
        let cosine = face.plane * near / seen.rest_length;
        color = shines(material, doppler, own_color(face, material, seen)) * law(material, cosine);
    }
    film[at].color += job.weight * finite(color);
    if job.is_first == 1u {
        film[at].distance = job.unit * (seen.length / near);
        film[at].doppler = doppler;
        film[at].body = i32(body);
        film[at].face = i32(face.number);
    }
}
