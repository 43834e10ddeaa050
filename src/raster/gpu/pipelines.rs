use super::shaders;

/// The programs of a device.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub quads: wgpu::RenderPipeline,
    pub polygons: wgpu::RenderPipeline,
    pub develop: wgpu::ComputePipeline,
    pub tone: wgpu::ComputePipeline,
}

/// Numbers of the shapes that pixels see.
pub(super) const SEEN: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// How near they are.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl Pipelines {
    pub fn new(device: &wgpu::Device) -> Self {
        let [raster, develop, tone] = shaders().map(|(name, source)| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(name),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            })
        });
        let compute = |module, entry| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: None,
                module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        let draw = |vertex, fragment| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(vertex),
                layout: None,
                vertex: wgpu::VertexState {
                    module: &raster,
                    entry_point: Some(vertex),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &raster,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &[Some(SEEN.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        Self {
            quads: draw("quad", "inside_quad"),
            polygons: draw("polygon", "inside_polygon"),
            develop: compute(&develop, "develop"),
            tone: compute(&tone, "develop_to_picture"),
        }
    }
}
