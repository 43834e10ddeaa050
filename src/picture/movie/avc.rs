//! What H.264 needs said beside the pictures: a level, and what the colours are.

use super::rate::Rate;
use rusty_h264_common::{
    BitReader, BitWriter,
    nal::{emulation_prevent_into, emulation_unprevent},
};

/// Colour primaries, transfer and matrix by their numbers in H.273: BT.709, sRGB (so is every byte we are given),
/// BT.709. The same in VUI and `colr`.
pub(super) const COLOR: [u8; 3] = [1, 13, 1];

/// Table A-1 of H.264: level × 10, macroblocks a second, macroblocks a frame.
const LEVELS: [(u8, u64, u64); 19] = [
    (10, 1_485, 99),
    (11, 3_000, 396),
    (12, 6_000, 396),
    (13, 11_880, 396),
    (20, 11_880, 396),
    (21, 19_800, 792),
    (22, 20_250, 1_620),
    (30, 40_500, 1_620),
    (31, 108_000, 3_600),
    (32, 216_000, 5_120),
    (40, 245_760, 8_192),
    (41, 245_760, 8_192),
    (42, 522_240, 8_704),
    (50, 589_824, 22_080),
    (51, 983_040, 36_864),
    (52, 2_073_600, 36_864),
    (60, 4_177_920, 139_264),
    (61, 8_355_840, 139_264),
    (62, 16_711_680, 139_264),
];

/// The lowest level (× 10) that holds pictures of this size at this rate.
pub(super) fn level(width: usize, height: usize, rate: Rate) -> Option<u8> {
    let (columns, rows) = (width.div_ceil(16) as u64, height.div_ceil(16) as u64);
    let blocks = columns * rows;
    LEVELS.iter().find_map(|&(level, a_second, a_frame)| {
        let holds = blocks <= a_frame
            && columns.max(rows).pow(2) <= 8 * a_frame
            && blocks * u64::from(rate.frames) <= a_second * u64::from(rate.seconds);
        holds.then_some(level)
    })
}

/// The NAL units of an Annex B stream, without start codes.
pub(super) fn units(stream: &[u8]) -> impl Iterator<Item = &[u8]> {
    let start = |from: usize| stream[from..].windows(3).position(|w| w == [0, 0, 1]).map(|at| from + at);
    let mut next = start(0);
    std::iter::from_fn(move || {
        let first = next? + 3;
        next = start(first);
        let unit = &stream[first..next.unwrap_or(stream.len())];
        // The fourth byte of a start code is a zero before it; a unit itself never ends in one.
        Some(&unit[..unit.iter().rposition(|&b| b != 0).map_or(0, |last| last + 1)])
    })
}

/// A sequence parameter set with video usability information: what the colours are, and that frames are shown in the
/// order they are coded, so that players need not hold any back. None if it has such information already.
pub(super) fn with_usability(sps: &[u8], references: u32) -> Option<Vec<u8>> {
    let (&head, payload) = sps.split_first()?;
    let payload = emulation_unprevent(payload);
    // The last bits are vui_parameters_present_flag and the stop bit.
    let stop = 8 * payload.len() - 1 - payload.last()?.trailing_zeros() as usize;
    let (mut from, mut to) = (BitReader::new(&payload), BitWriter::new());
    for _ in 0..stop - 1 {
        to.write_bit(from.read_bit().ok()?);
    }
    if from.read_bit().ok()? {
        return None;
    }
    to.write_bit(true); // vui_parameters_present_flag
    to.write_bit(false); // aspect_ratio_info_present_flag
    to.write_bit(false); // overscan_info_present_flag
    to.write_bit(true); // video_signal_type_present_flag
    to.write_bits(5, 3); // video_format: unspecified
    to.write_bit(false); // video_full_range_flag
    to.write_bit(true); // colour_description_present_flag
    for number in COLOR {
        to.write_bits(u32::from(number), 8);
    }
    to.write_bit(true); // chroma_loc_info_present_flag
    to.write_ue(1); // top field: in the middle of the four pixels
    to.write_ue(1); // bottom field
    to.write_bit(false); // timing_info_present_flag: the container has it
    to.write_bit(false); // nal_hrd_parameters_present_flag
    to.write_bit(false); // vcl_hrd_parameters_present_flag
    to.write_bit(false); // pic_struct_present_flag
    to.write_bit(true); // bitstream_restriction_flag
    to.write_bit(true); // motion_vectors_over_pic_boundaries_flag
    to.write_ue(0); // max_bytes_per_pic_denom: no limit
    to.write_ue(0); // max_bits_per_mb_denom: no limit
    to.write_ue(15); // log2_max_mv_length_horizontal
    to.write_ue(15); // log2_max_mv_length_vertical
    to.write_ue(0); // max_num_reorder_frames
    to.write_ue(references); // max_dec_frame_buffering
    to.rbsp_trailing_bits();
    let mut unit = vec![head];
    emulation_prevent_into(&to.into_bytes(), &mut unit);
    Some(unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels() {
        let rate = |frames, seconds| Rate { frames, seconds };
        assert_eq!(level(1280, 720, rate(30, 1)), Some(31));
        assert_eq!(level(1280, 720, rate(60, 1)), Some(32));
        assert_eq!(level(1920, 1080, rate(30, 1)), Some(40));
        assert_eq!(level(3840, 2160, rate(2997, 100)), Some(51));
        assert_eq!(level(7680, 4320, rate(60, 1)), Some(61));
        assert_eq!(level(1280, 720, rate(5000, 1)), None);
        // Fewer blocks than a level has, but all in one row.
        assert_eq!(level(16896, 16, rate(1, 1)), None);
    }

    #[test]
    fn units_of_a_stream() {
        let stream = [0, 0, 0, 1, 7, 8, 0, 0, 3, 0, 9, 0, 0, 0, 1, 5, 0, 0, 1, 6];
        assert_eq!(units(&stream).collect::<Vec<_>>(), [&[7, 8, 0, 0, 3, 0, 9][..], &[5], &[6]]);
        assert_eq!(units(&[]).count(), 0);
    }
}
