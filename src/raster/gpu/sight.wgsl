// What is the same for a whole pass: one sample of every pixel of a part of the picture.
struct Pass {
    // Of the picture's part: its first pixel and how many there are.
    corner: vec2<u32>,
    part: vec2<u32>,
    // The picture's middle, pixels a unit of tan θ or a radian (one over), and where in its pixel the sample lies.
    middle: vec2<f32>,
    inverse_focal: vec2<f32>,
    sample: vec2<f32>,
    projection: u32,
    coloring: u32,
    // What the sample counts.
    weight: f32,
    // Length of the unit distances are in.
    unit: f32,
    is_first: u32,
    // Light is multiplied by this, and goes through this curve.
    exposure: f32,
    tone: u32,
}

const PINHOLE: u32 = 0u;
const FISHEYE: u32 = 1u;
const PANORAMA: u32 = 2u;

// A body's sky: unit vectors across and along its motion in the observer's axes, k and 1/k, and a place of the picture that
// lines of sight are counted from.
struct Sky {
    first: vec3<f32>,
    k: f32,
    second: vec3<f32>,
    inverse_k: f32,
    axis: vec3<f32>,
    // Whether that place is the pole of the motion from which everything spreads.
    from_pole: u32,
    // The place, in pixels: a whole number and the rest.
    pixel: vec2<f32>,
    beside: vec2<f32>,
    // For a pinhole: its line of sight (X, Y, 1), the length of that, and the length in the rest frame. For a fisheye: the
    // way from the middle in radians, its length and cosine. For a panorama: the sine of the latitude.
    place: vec4<f32>,
}

// A line of sight in light-cone coordinates of a body's motion, less those of the sky's place.
struct Sight {
    // v·e₁, v·e₂, L + v·û, L − v·û.
    cone: vec4<f32>,
    // L, and L′ in the body's rest frame.
    length: f32,
    rest_length: f32,
    exists: bool,
}

struct Angle {
    sine: f32,
    cosine: f32,
}

// To the last digit up to ±8, which built-in functions need not be.
fn angle(x: f32) -> Angle {
    let quarters = round(x * 0.63661977);
    // π/2 in three parts, so that nothing is lost.
    let r = ((x - quarters * 1.5703125) - quarters * 4.837512969970703e-4) - quarters * 7.549789954891882e-8;
    let z = r * r;
    let sine = r + r * z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z / 362880.0)));
    let cosine = 1.0 + z * (-0.5 + z * (1.0 / 24.0 + z * (-1.0 / 720.0 + z * (1.0 / 40320.0 - z / 3628800.0))));
    switch i32(quarters) & 3 {
        case 0: { return Angle(sine, cosine); }
        case 1: { return Angle(cosine, -sine); }
        case 2: { return Angle(-sine, -cosine); }
        default: { return Angle(-cosine, sine); }
    }
}

// From the sky's place, in pixels.
fn from_place(sky: Sky, pixel: vec2<f32>, sample: vec2<f32>) -> vec2<f32> {
    return (pixel - sky.pixel) + (sample - sky.beside);
}

// Of a place on the picture: a whole pixel, and how far from its corner.
fn sight(pass_: Pass, sky: Sky, pixel: vec2<f32>, sample: vec2<f32>) -> Sight {
    switch pass_.projection {
        case PINHOLE: { return of_pinhole(pass_, sky, pixel, sample); }
        case FISHEYE: { return of_fisheye(pass_, sky, pixel, sample); }
        default: { return of_panorama(pass_, sky, pixel, sample); }
    }
}

fn of_pinhole(pass_: Pass, sky: Sky, pixel: vec2<f32>, sample: vec2<f32>) -> Sight {
    let step = from_place(sky, pixel, sample) * vec2(pass_.inverse_focal.x, -pass_.inverse_focal.x);
    let at = sky.place.xy + step;
    let length = sqrt(1.0 + dot(at, at));
    // L − L₀, v·û − v₀·û and so on, without a difference of large numbers.
    let longer = dot(step, step + 2.0 * sky.place.xy) / (length + sky.place.z);
    let across = vec2(dot(sky.first.xy, step), dot(sky.second.xy, step));
    let along = dot(sky.axis.xy, step);
    var plus = longer + along;
    let minus = longer - along;
    if sky.from_pole != 0u {
        let whole = along - sky.place.z;
        plus = select(dot(across, across) / (length - whole), length + whole, whole > 0.0);
    }
    let rest_length = sky.place.w + 0.5 * (sky.k * plus + sky.inverse_k * minus);
    return Sight(vec4(across, plus, minus), length, rest_length, true);
}

// Of a unit vector, by its products with the axes.
fn of_unit(sky: Sky, across: vec2<f32>, along: f32) -> Sight {
    let larger = 1.0 + abs(along);
    let smaller = dot(across, across) / larger;
    let plus = select(larger, smaller, along < 0.0);
    let minus = select(smaller, larger, along < 0.0);
    return Sight(vec4(across, plus, minus), 1.0, 0.5 * (sky.k * plus + sky.inverse_k * minus), true);
}

fn of_fisheye(pass_: Pass, sky: Sky, pixel: vec2<f32>, sample: vec2<f32>) -> Sight {
    let at = ((pixel - pass_.middle) + sample) * pass_.inverse_focal;
    let theta = length(at);
    let turn = angle(theta);
    let sinc = select(1.0, turn.sine / theta, theta > 0.0);
    let n = vec3(sinc * at.x, -sinc * at.y, turn.cosine);
    var across = vec2(dot(sky.first, n), dot(sky.second, n));
    if sky.from_pole != 0u {
        // Spherical trigonometry from the pole, near to which nothing cancels.
        let step = from_place(sky, pixel, sample) * pass_.inverse_focal;
        let pole = sky.place.xy;
        let height = sky.place.z;
        let farther = dot(step, at + pole) / (theta + height);
        let beside = pole.x * step.y - pole.y * step.x;
        let product = theta * height;
        let inner = dot(at, pole);
        // θ(1 − cos ψ), ψ between the ways from the middle.
        let turned = select(theta - inner / height, beside * beside / (height * (product + inner)), inner > 0.0);
        across = vec2(angle(farther).sine - sinc * sky.place.w * turned, sinc * beside / height);
    }
    var seen = of_unit(sky, across, dot(sky.axis, n));
    seen.exists = theta <= 3.14159265;
    return seen;
}

fn of_panorama(pass_: Pass, sky: Sky, pixel: vec2<f32>, sample: vec2<f32>) -> Sight {
    let at = ((pixel - pass_.middle) + sample) * pass_.inverse_focal;
    let step = from_place(sky, pixel, sample) * pass_.inverse_focal;
    let longitude = angle(at.x);
    let latitude = angle(-at.y);
    let n = vec3(latitude.cosine * longitude.sine, latitude.sine, latitude.cosine * longitude.cosine);
    let half = angle(0.5 * step.x).sine;
    let across = vec2(
        latitude.cosine * angle(step.x).sine,
        angle(-step.y).sine + 2.0 * latitude.cosine * sky.place.x * half * half,
    );
    return of_unit(sky, across, dot(sky.axis, n));
}

// A triangle as lines of sight meet it: functions f·cone + f₀ of those.
struct Shape {
    // Positive inside.
    edges: array<vec4<f32>, 3>,
    edges_constant: vec3<f32>,
    // Which edges belong to it themselves (three bits), and its body.
    owns_and_body: u32,
    // 1/s.
    plane: vec4<f32>,
    plane_constant: f32,
    // Least and greatest 1/r.
    least: f32,
    greatest: f32,
    face: u32,
}

fn edge(shape: Shape, which: u32, seen: Sight) -> f32 {
    return dot(shape.edges[which], seen.cone) + shape.edges_constant[which];
}

fn is_inside(shape: Shape, seen: Sight) -> bool {
    var inside = seen.exists;
    for (var i = 0u; i < 3u; i++) {
        let e = edge(shape, i, seen);
        let owns = (shape.owns_and_body >> i & 1u) == 1u;
        inside &= e > 0.0 || (owns && e == 0.0);
    }
    return inside;
}

fn nearness(shape: Shape, seen: Sight) -> f32 {
    let plain = dot(shape.plane, seen.cone) + shape.plane_constant;
    return min(max(plain, shape.least * seen.length), shape.greatest * seen.length);
}
