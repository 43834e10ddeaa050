use super::rate::Rate;
use super::yuv::Planes;
use super::{MovieError, avc};
use rusty_h264_common::YuvPlanes;
use rusty_h264_encoder::{Encoder, EncoderConfig, Preset};
use shiguredo_mp4::boxes::{Avc1Box, AvccBox, SampleEntry, UnknownBox, VisualSampleEntryFields};
use shiguredo_mp4::mux::{Mp4FileMuxer, Mp4FileMuxerOptions, Sample};
use shiguredo_mp4::{BoxSize, BoxType, TrackKind, Uint};
use std::io::{Seek, SeekFrom, Write};
use std::num::NonZeroU32;

/// 50 dB on scenes of flat colours, which stay clean; docs/formats.md has its neighbours.
const QUANTISER: u8 = 22;

/// A second one saves an eighth of the file and costs no time to speak of.
const REFERENCES: u32 = 2;

/// Between frames that can be sought to.
const SECONDS_BETWEEN_KEYS: f64 = 2.0;

/// Kept free before the pictures for the index, which then stands first, so that players can begin before they have
/// the whole file: enough for 8000 frames. The index of a longer film stands last.
const INDEX_BYTES: usize = 1 << 15;

/// Ticks a frame for each second of [`Rate::seconds`]: some players take a scale below some hundreds badly.
const TICKS: u32 = 1000;

/// A film as H.264 (High profile) in MP4. Of each frame written only its entry in the index is kept, 32
/// bytes.
pub(super) struct Mp4<W> {
    to: W,
    encoder: Encoder,
    planes: Planes,
    muxer: Mp4FileMuxer,
    /// Where the next frame goes.
    at: u64,
    scale: NonZeroU32,
    ticks: u32,
    described: bool,
}

fn encoder_fault(why: impl std::fmt::Display) -> MovieError {
    MovieError::Encoder { codec: "H.264", why: why.to_string() }
}

fn muxer_fault(why: impl std::fmt::Display) -> MovieError {
    MovieError::Encoder { codec: "MP4", why: why.to_string() }
}

impl<W: Write + Seek> Mp4<W> {
    pub fn new(mut to: W, width: usize, height: usize, rate: Rate) -> Result<Self, MovieError> {
        let planes = Planes::new(width, height);
        let Some(level) = avc::level(planes.width, planes.height, rate) else {
            return Err(MovieError::Size {
                width,
                height,
                why: "no level of H.264 holds pictures of that size at that rate",
            });
        };
        let fps = f64::from(rate.frames) / f64::from(rate.seconds);
        let mut config = EncoderConfig::new(planes.width, planes.height);
        config.level_idc = level;
        config.framerate = fps as f32;
        config.preset = Preset::Balanced;
        config.qp = QUANTISER;
        config.num_ref_frames = REFERENCES;
        config.gop_size = (SECONDS_BETWEEN_KEYS * fps).round().clamp(1.0, 250.0) as u32;
        // Each would have frames wait for later ones.
        (config.mbtree, config.bframes, config.lookahead, config.scenecut) = (false, 0, 0, 0);
        let encoder = Encoder::new(config).map_err(encoder_fault)?;
        let options = Mp4FileMuxerOptions { reserved_moov_box_size: INDEX_BYTES, ..Default::default() };
        let muxer = Mp4FileMuxer::with_options(options).map_err(muxer_fault)?;
        to.write_all(muxer.initial_boxes_bytes())?;
        Ok(Self {
            at: muxer.initial_boxes_bytes().len() as u64,
            to,
            encoder,
            planes,
            muxer,
            scale: NonZeroU32::new(TICKS * u32::from(rate.frames)).expect("a rate has frames"),
            ticks: TICKS * u32::from(rate.seconds),
            described: false,
        })
    }

    pub fn push(&mut self, rgb: &[u8], width: usize) -> Result<(), MovieError> {
        self.planes.fill(rgb, width);
        let Planes { width, height, y, cb, cr } = &self.planes;
        let (width, height) = (*width, *height);
        let planes = YuvPlanes { width, height, y, u: cb, v: cr, stride_y: width, stride_c: width / 2 };
        let coded = self.encoder.encode_planes(&planes).map_err(encoder_fault)?;
        let (mut frame, mut sps, mut pps, mut keyframe) =
            (Vec::with_capacity(coded.len()), None, None, false);
        for unit in avc::units(&coded) {
            match unit[0] & 31 {
                // Parameter sets stand in the index, and nowhere else.
                7 => sps = Some(unit),
                8 => pps = Some(unit),
                kind => {
                    keyframe |= kind == 5;
                    frame.extend_from_slice(&(unit.len() as u32).to_be_bytes());
                    frame.extend_from_slice(unit);
                }
            }
        }
        let sample_entry = match (self.described, sps, pps) {
            (false, Some(sps), Some(pps)) => Some(self.description(sps, pps)?),
            (false, ..) => return Err(encoder_fault("the first frame has no parameter sets")),
            _ => None,
        };
        self.to.write_all(&frame)?;
        let sample = Sample {
            track_kind: TrackKind::Video,
            sample_entry,
            keyframe,
            timescale: self.scale,
            duration: self.ticks,
            composition_time_offset: None,
            data_offset: self.at,
            data_size: frame.len(),
        };
        self.muxer.append_sample(&sample).map_err(muxer_fault)?;
        self.described = true;
        self.at += frame.len() as u64;
        Ok(())
    }

    fn description(&self, sps: &[u8], pps: &[u8]) -> Result<SampleEntry, MovieError> {
        let [profile, constraints, level] = *sps
            .get(1..4)
            .and_then(|head| head.first_chunk())
            .ok_or_else(|| encoder_fault("a sequence parameter set is cut short"))?;
        let sps = avc::with_usability(sps, REFERENCES)
            .ok_or_else(|| encoder_fault("a sequence parameter set is not as expected"))?;
        // 16 bits a number, then the flag for full range and seven zeros.
        let color = [b"nclx".as_slice(), &avc::COLOR.map(|n| [0, n]).concat(), &[0]].concat();
        Ok(SampleEntry::Avc1(Avc1Box {
            visual: VisualSampleEntryFields {
                data_reference_index: VisualSampleEntryFields::DEFAULT_DATA_REFERENCE_INDEX,
                // No level of H.264 goes beyond.
                width: self.planes.width as u16,
                height: self.planes.height as u16,
                horizresolution: VisualSampleEntryFields::DEFAULT_HORIZRESOLUTION,
                vertresolution: VisualSampleEntryFields::DEFAULT_VERTRESOLUTION,
                frame_count: VisualSampleEntryFields::DEFAULT_FRAME_COUNT,
                compressorname: VisualSampleEntryFields::NULL_COMPRESSORNAME,
                depth: VisualSampleEntryFields::DEFAULT_DEPTH,
            },
            avcc_box: AvccBox {
                avc_profile_indication: profile,
                profile_compatibility: constraints,
                avc_level_indication: level,
                length_size_minus_one: Uint::new(3),
                sps_list: vec![sps],
                pps_list: vec![pps.to_vec()],
                // 4:2:0, eight bits.
                chroma_format: Some(Uint::new(1)),
                bit_depth_luma_minus8: Some(Uint::new(0)),
                bit_depth_chroma_minus8: Some(Uint::new(0)),
                sps_ext_list: Vec::new(),
            },
            unknown_boxes: vec![UnknownBox {
                box_type: BoxType::Normal(*b"colr"),
                box_size: BoxSize::U32(8 + color.len() as u32),
                payload: color,
            }],
        }))
    }

    pub fn finish(mut self) -> Result<W, MovieError> {
        for (at, bytes) in self.muxer.finalize().map_err(muxer_fault)?.offset_and_bytes_pairs() {
            self.to.seek(SeekFrom::Start(at))?;
            self.to.write_all(bytes)?;
        }
        self.to.seek(SeekFrom::End(0))?;
        Ok(self.to)
    }
}
