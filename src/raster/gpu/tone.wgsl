@group(0) @binding(0) var<uniform> job: Pass;
@group(0) @binding(1) var<storage, read> film: array<Pixel>;
// 8-bit sRGB, red in the lowest byte.
@group(0) @binding(2) var<storage, read_write> picture: array<u32>;

const LINEAR: u32 = 0u;
const FILMIC: u32 = 1u;

fn within_gamut(color: vec3<f32>) -> vec3<f32> {
    let least = min(min(color.x, color.y), color.z);
    if !(least < 0.0) {
        return color;
    }
    let grey = dot(LUMINANCE, color);
    if grey <= 0.0 {
        return vec3(0.0);
    }
    return max(grey + grey / (grey - least) * (color - grey), vec3(0.0));
}

fn filmic(light: vec3<f32>) -> vec3<f32> {
    let v = min(light, vec3(1e4));
    return clamp(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14), vec3(0.0), vec3(1.0));
}

fn logarithmic(color: vec3<f32>) -> vec3<f32> {
    let bright = dot(LUMINANCE, color);
    if !(bright > 0.0) {
        return vec3(0.0);
    }
    let shown = clamp(1.0 + log2(bright) / LOG_OCTAVES, 0.0, 1.0);
    let light = select(pow((shown + 0.055) / 1.055, 2.4), shown / 12.92, shown <= 0.04045);
    return color / bright * light;
}

fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let v = clamp(linear, vec3(0.0), vec3(1.0));
    return select(1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, 12.92 * v, v <= vec3(0.0031308));
}

@compute @workgroup_size(8, 8)
fn develop_to_picture(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= job.part) {
        return;
    }
    let at = id.y * job.part.x + id.x;
    let exposed = within_gamut(film[at].color * job.exposure);
    var shown = exposed;
    if job.tone == FILMIC {
        shown = filmic(exposed);
    } else if job.tone != LINEAR {
        shown = logarithmic(exposed);
    }
    picture[at] = pack4x8unorm(vec4(encoded(shown), 1.0));
}
