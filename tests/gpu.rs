//! Drawing on a graphics processor shows what the CPU shows.
#![cfg(feature = "gpu")]

use terrell::raster::gpu::shaders;

/// Plain checks, without any device.
#[test]
fn shaders_are_valid() {
    for (name, source) in shaders() {
        let module = naga::front::wgsl::parse_str(&source)
            .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string_with_path(&source, name)));
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|e| panic!("{name}: {}", e.emit_to_string_with_path(&source, name)));
    }
}
