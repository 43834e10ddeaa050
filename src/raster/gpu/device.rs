use super::GpuError;
use super::guard::{Guard, one_line, wait};
use super::load::Load;
use super::pipelines::{DEPTH, Pipelines, SEEN};
use super::records::{PassRecord, PixelRecord};
use crate::color::Coloring;
use crate::film::{Film, Samples};
use crate::scene::{Lens, Projection};
use crate::tone::{Development, Tone};
use bytemuck::Pod;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A graphics processor, ready to draw.
#[derive(Debug)]
pub struct Gpu {
    name: String,
    is_hardware: bool,
    device: wgpu::Device,
    queue: wgpu::Queue,
    pipelines: Pipelines,
    /// Of the picture drawn last, for the next; held while one is drawn.
    targets: Mutex<Option<Targets>>,
    /// Why the device is lost, once it is.
    lost: Arc<OnceLock<String>>,
}

/// The longest side of a part of a picture.
const PART: u32 = 2048;

/// Pixels of the side of a shader's work group.
const GROUP: u32 = 8;

/// What a part of a picture is drawn on.
#[derive(Debug)]
struct Targets {
    size: [u32; 2],
    seen: wgpu::TextureView,
    depth: wgpu::TextureView,
    film: wgpu::Buffer,
    /// As four bytes a pixel.
    picture: wgpu::Buffer,
    /// What either is read back through.
    copy: wgpu::Buffer,
}

/// What shaders read of a scene, where they read it.
struct Uploaded {
    skies: wgpu::Buffer,
    shapes: wgpu::Buffer,
    figures: wgpu::Buffer,
    vertices: wgpu::Buffer,
    faces: wgpu::Buffer,
    materials: wgpu::Buffer,
    nodes: wgpu::Buffer,
    words: wgpu::Buffer,
    /// Vertices to be drawn.
    corners: u32,
    polygons: bool,
}

impl Gpu {
    /// The best there is, software if nothing else is there.
    ///
    /// # Errors
    /// If there is none, or it cannot do what is needed.
    pub fn open() -> Result<Self, GpuError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = wait(instance.request_adapter(&options)).map_err(|_| GpuError::NoAdapter)?;
        let info = adapter.get_info();
        let name = info.name.clone();
        let unfit = |why: String| GpuError::Unfit { adapter: name.clone(), why };
        let usage = adapter.get_texture_format_features(SEEN).allowed_usages;
        if !usage.contains(wgpu::TextureUsages::RENDER_ATTACHMENT) {
            return Err(unfit("it cannot draw on targets of 32-bit numbers".into()));
        }
        // As much as it has, of what scenes may be large in.
        let most = adapter.limits();
        let required_limits = wgpu::Limits {
            max_buffer_size: most.max_buffer_size,
            max_storage_buffer_binding_size: most.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
        let (device, queue) = wait(adapter.request_device(&descriptor)).map_err(|e| unfit(one_line(&e)))?;
        let lost = Arc::new(OnceLock::new());
        let told = lost.clone();
        device.set_device_lost_callback(move |_, why| {
            let _ = told.set(why);
        });
        let is_hardware = !matches!(info.device_type, wgpu::DeviceType::Cpu | wgpu::DeviceType::Other);
        let guarded = Guard::new(&device);
        let pipelines = Pipelines::new(&device);
        guarded.finish(&name, &lost)?;
        Ok(Self { name, is_hardware, device, queue, pipelines, targets: Mutex::default(), lost })
    }

    /// The one that all of a program share; opened when it is first asked for, and again if it was lost.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn shared() -> Result<Arc<Self>, GpuError> {
        static SHARED: Mutex<Option<Arc<Gpu>>> = Mutex::new(None);
        let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(gpu) = shared.as_ref().filter(|gpu| gpu.lost.get().is_none()) {
            return Ok(gpu.clone());
        }
        let gpu = Arc::new(Self::open()?);
        *shared = Some(gpu.clone());
        Ok(gpu)
    }

    /// What its driver calls it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Gives the device back: whatever is asked of it from now on is an error.
    pub fn close(&self) {
        self.device.destroy();
        let _ = self.lost.set("it was closed".to_owned());
    }

    /// Whether it is more than a program on the CPU.
    pub fn is_hardware(&self) -> bool {
        self.is_hardware
    }

    /// Draws on a film, which is cleared first.
    pub(super) fn expose(
        &self,
        load: &Load,
        lens: &Lens,
        samples: &Samples,
        coloring: Coloring,
        film: &mut Film,
    ) -> Result<(), GpuError> {
        film.clear(lens.width(), lens.height());
        let pass = pass(lens, coloring, load.unit);
        self.in_parts(load, &pass, samples, lens, |part, targets| {
            let [left, top] = part.corner.map(|c| c as usize);
            let [width, height] = part.part.map(|c| c as usize);
            self.read_back(targets, &targets.film, width * height, |pixels: &[PixelRecord]| {
                let rows = film.bands(1).skip(top).take(height).enumerate();
                rows.for_each(|(line, rows)| {
                    for (i, pixel) in (left..).zip(&pixels[line * width..(line + 1) * width]) {
                        rows.color[i] = pixel.color;
                        rows.distance[i] = pixel.distance;
                        rows.doppler[i] = pixel.doppler;
                        rows.body[i] = pixel.body;
                        rows.face[i] = pixel.face;
                    }
                });
            })
        })
    }

    /// A picture, three bytes a pixel.
    pub(super) fn picture(
        &self,
        load: &Load,
        lens: &Lens,
        samples: &Samples,
        coloring: Coloring,
        development: &Development,
    ) -> Result<Vec<u8>, GpuError> {
        let exposure = development.ev.exp2();
        let tone = match development.tone {
            Tone::Linear => 0,
            Tone::Filmic => 1,
            Tone::Log => 2,
        };
        let pass = PassRecord { exposure, tone, ..pass(lens, coloring, load.unit) };
        let whole = lens.width() as usize;
        let mut picture = vec![0; 3 * whole * lens.height() as usize];
        self.in_parts(load, &pass, samples, lens, |part, targets| {
            self.tone(part, targets)?;
            let [left, top] = part.corner.map(|c| c as usize);
            let [width, height] = part.part.map(|c| c as usize);
            self.read_back(targets, &targets.picture, width * height, |pixels: &[[u8; 4]]| {
                for (line, pixels) in pixels.chunks(width).enumerate() {
                    let row = &mut picture[3 * ((top + line) * whole + left)..][..3 * width];
                    for (to, from) in row.chunks_exact_mut(3).zip(pixels) {
                        to.copy_from_slice(&from[..3]);
                    }
                }
            })
        })?;
        Ok(picture)
    }

    /// Draws part by part; `done` takes each from its targets.
    fn in_parts(
        &self,
        load: &Load,
        pass: &PassRecord,
        samples: &Samples,
        lens: &Lens,
        mut done: impl FnMut(&PassRecord, &Targets) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        let uploaded = self.checked(|| self.upload(load))?;
        let size = [lens.width(), lens.height()];
        let largest = size.map(|side| side.min(PART));
        let mut kept = self.targets.lock().unwrap_or_else(PoisonError::into_inner);
        let targets = match kept.take().filter(|targets| targets.size == largest) {
            Some(targets) => targets,
            None => self.checked(|| Ok(self.targets(largest)))?,
        };
        for y in (0..size[1]).step_by(PART as usize) {
            for x in (0..size[0]).step_by(PART as usize) {
                let part = [(size[0] - x).min(PART), (size[1] - y).min(PART)];
                let part = PassRecord { corner: [x, y], part, ..*pass };
                self.checked(|| {
                    self.draw_part(&part, samples, &uploaded, &targets)?;
                    done(&part, &targets)
                })?;
            }
        }
        *kept = Some(targets);
        Ok(())
    }

    /// All samples of a part, onto its film.
    fn draw_part(
        &self,
        part: &PassRecord,
        samples: &Samples,
        uploaded: &Uploaded,
        targets: &Targets,
    ) -> Result<(), GpuError> {
        let count = samples.offsets().len();
        let weight = 1.0 / count as f32;
        for (index, offset) in samples.offsets().iter().enumerate() {
            let pass = PassRecord {
                sample: offset.map(|c| c as f32),
                weight,
                is_first: u32::from(index == 0),
                ..*part
            };
            let job = self.buffer("pass", &[pass], wgpu::BufferUsages::UNIFORM)?;
            let mut encoder = self.device.create_command_encoder(&Default::default());
            self.encode_raster(&mut encoder, &job, uploaded, targets, part.part);
            let develop = self.bound(
                &self.pipelines.develop,
                [
                    job.as_entire_binding(),
                    uploaded.skies.as_entire_binding(),
                    uploaded.shapes.as_entire_binding(),
                    uploaded.faces.as_entire_binding(),
                    uploaded.materials.as_entire_binding(),
                    uploaded.nodes.as_entire_binding(),
                    uploaded.words.as_entire_binding(),
                    targets.film.as_entire_binding(),
                    wgpu::BindingResource::TextureView(&targets.seen),
                ],
            );
            compute(&mut encoder, &self.pipelines.develop, &develop, part.part);
            self.queue.submit([encoder.finish()]);
        }
        Ok(())
    }

    /// Which shape each pixel of the part sees.
    fn encode_raster(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        job: &wgpu::Buffer,
        uploaded: &Uploaded,
        targets: &Targets,
        [width, height]: [u32; 2],
    ) {
        let Pipelines { quads, polygons, .. } = &self.pipelines;
        let pipeline = if uploaded.polygons { polygons } else { quads };
        let mut entries = vec![
            job.as_entire_binding(),
            uploaded.skies.as_entire_binding(),
            uploaded.shapes.as_entire_binding(),
            uploaded.figures.as_entire_binding(),
        ];
        if uploaded.polygons {
            entries.push(uploaded.vertices.as_entire_binding());
        }
        let layout = pipeline.get_bind_group_layout(0);
        let entries = entries
            .into_iter()
            .zip(0..)
            .map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource })
            .collect::<Vec<_>>();
        let group = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &entries,
        });
        let nothing = wgpu::Color { r: 0.0, g: 0.0, b: 0.0, a: 0.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &targets.seen,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(nothing), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
        pass.set_scissor_rect(0, 0, width, height);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..uploaded.corners, 0..1);
    }

    /// A part's film to its picture.
    fn tone(&self, part: &PassRecord, targets: &Targets) -> Result<(), GpuError> {
        let job = self.buffer("pass", &[*part], wgpu::BufferUsages::UNIFORM)?;
        let resources = [&job, &targets.film, &targets.picture].map(|buffer| buffer.as_entire_binding());
        let group = self.bound(&self.pipelines.tone, resources);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        compute(&mut encoder, &self.pipelines.tone, &group, part.part);
        self.queue.submit([encoder.finish()]);
        Ok(())
    }

    fn bound<const N: usize>(
        &self,
        pipeline: &wgpu::ComputePipeline,
        resources: [wgpu::BindingResource<'_>; N],
    ) -> wgpu::BindGroup {
        let mut binding = 0;
        let entries = resources.map(|resource| {
            binding += 1;
            wgpu::BindGroupEntry { binding: binding - 1, resource }
        });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }

    fn upload(&self, load: &Load) -> Result<Uploaded, GpuError> {
        let storage = wgpu::BufferUsages::STORAGE;
        let polygons = !load.vertices.is_empty();
        let corners = load.figures.len() as u64 * if polygons { 3 } else { 6 };
        let most = u64::from(u32::MAX);
        let too_large =
            GpuError::TooLarge { adapter: self.name.clone(), what: "triangles", bytes: corners, most };
        Ok(Uploaded {
            skies: self.buffer("bodies", &load.skies, storage)?,
            shapes: self.buffer("triangles", &load.shapes, storage)?,
            figures: self.buffer("triangles", &load.figures, storage)?,
            vertices: self.buffer("vertices", &load.vertices, storage)?,
            faces: self.buffer("triangles", &load.faces, storage)?,
            materials: self.buffer("materials", &load.looks.materials, storage)?,
            nodes: self.buffer("tables of colours", &load.looks.nodes, storage)?,
            words: self.buffer("colours", &load.looks.words, storage)?,
            corners: u32::try_from(corners).map_err(|_| too_large)?,
            polygons,
        })
    }

    /// With these contents; never quite empty, which shaders could not read.
    fn buffer<T: Pod>(
        &self,
        what: &'static str,
        contents: &[T],
        usage: wgpu::BufferUsages,
    ) -> Result<wgpu::Buffer, GpuError> {
        let bytes: &[u8] = bytemuck::cast_slice(contents);
        let size = (bytes.len() as u64).max(std::mem::size_of::<T>() as u64).max(16);
        let limits = self.device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if size > most {
            return Err(GpuError::TooLarge { adapter: self.name.clone(), what, bytes: size, most });
        }
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: true };
        let buffer = self.device.create_buffer(&descriptor);
        // Where there is no memory, the error is told by the scope around.
        if let Ok(mut mapped) = buffer.get_mapped_range_mut(..bytes.len() as u64) {
            mapped.copy_from_slice(bytes);
        }
        buffer.unmap();
        Ok(buffer)
    }

    fn targets(&self, [width, height]: [u32; 2]) -> Targets {
        let texture = |format, more| {
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | more,
                view_formats: &[],
            });
            texture.create_view(&Default::default())
        };
        let pixels = u64::from(width) * u64::from(height);
        let buffer = |bytes: usize, usage| {
            let size = bytes as u64 * pixels;
            let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
            self.device.create_buffer(&descriptor)
        };
        let drawn = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
        let film = std::mem::size_of::<PixelRecord>();
        Targets {
            size: [width, height],
            seen: texture(SEEN, wgpu::TextureUsages::TEXTURE_BINDING),
            depth: texture(DEPTH, wgpu::TextureUsages::empty()),
            film: buffer(film, drawn),
            picture: buffer(4, drawn),
            copy: buffer(film, wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
        }
    }

    /// So many of what a buffer has, once everything before is drawn.
    fn read_back<T: Pod>(
        &self,
        targets: &Targets,
        buffer: &wgpu::Buffer,
        count: usize,
        take: impl FnOnce(&[T]),
    ) -> Result<(), GpuError> {
        let (copy, bytes) = (&targets.copy, (count * std::mem::size_of::<T>()) as u64);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, copy, 0, bytes);
        self.queue.submit([encoder.finish()]);
        let mapped = Arc::new(OnceLock::new());
        let told = mapped.clone();
        copy.map_async(wgpu::MapMode::Read, ..bytes, move |done| {
            let _ = told.set(done);
        });
        let refused = |why: String| GpuError::Refused { adapter: self.name.clone(), why };
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| refused(one_line(&e)))?;
        if !matches!(mapped.get(), Some(Ok(()))) {
            return Err(refused("what was drawn cannot be read back".into()));
        }
        take(bytemuck::cast_slice(&copy.get_mapped_range(..bytes).map_err(|e| refused(one_line(&e)))?));
        copy.unmap();
        Ok(())
    }

    /// Does something with what goes wrong on the device as an error.
    fn checked<T>(&self, work: impl FnOnce() -> Result<T, GpuError>) -> Result<T, GpuError> {
        let guard = Guard::new(&self.device);
        let done = work();
        guard.finish(&self.name, &self.lost)?;
        done
    }
}

/// What all samples and parts have in common.
fn pass(lens: &Lens, coloring: Coloring, unit: f64) -> PassRecord {
    PassRecord {
        middle: lens.middle().as_vec2().to_array(),
        inverse_focal: lens.focal().recip().as_vec2().to_array(),
        projection: match lens.projection() {
            Projection::Pinhole => 0,
            Projection::Fisheye => 1,
            Projection::Panorama => 2,
        },
        coloring: match coloring {
            Coloring::Spectral => 0,
            Coloring::Flat => 1,
            Coloring::Bolometric => 2,
            Coloring::Geometry => 3,
            Coloring::Doppler => 4,
        },
        unit: unit as f32,
        exposure: 1.0,
        ..PassRecord::default()
    }
}

fn compute(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    group: &wgpu::BindGroup,
    [width, height]: [u32; 2],
) {
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, group, &[]);
    pass.dispatch_workgroups(width.div_ceil(GROUP), height.div_ceil(GROUP), 1);
}
