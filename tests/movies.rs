//! Movies, read back by other code than wrote them.

use image::AnimationDecoder;
use image::codecs::{gif::GifDecoder, png::PngDecoder};
use std::io::{Cursor, Seek, SeekFrom, Write};
use std::path::Path;
use terrell::picture::{Movie, MovieError, MovieFormat};

/// A disc and a bar that cross a chequered floor on black, in as many colours as asked: frame `i`.
fn frame(width: usize, height: usize, i: usize, colors: usize) -> Vec<u8> {
    let mut rgb = Vec::with_capacity(3 * width * height);
    let (center_x, center_y) = ((5 * i + width / 4) % width, height / 2);
    for y in 0..height {
        for x in 0..width {
            let (dx, dy) = (x.abs_diff(center_x), y.abs_diff(center_y));
            let color = if 9 * (dx * dx + dy * dy) < height * height {
                let shade = (x * 7 + y * 31) % colors.saturating_sub(4).max(1);
                [200, (shade % 64) as u8 * 4, 40 + (shade / 64) as u8]
            } else if (x + width - 3 * i % width) % width < 9 {
                [30, 90, 220]
            } else if 4 * y > 3 * height {
                [[68; 3], [110, 110, 104]][(x / 8 + y / 8) % 2]
            } else {
                [0; 3]
            };
            rgb.extend(color);
        }
    }
    rgb
}

fn distinct(rgb: &[u8]) -> usize {
    rgb.as_chunks::<3>().0.iter().collect::<std::collections::HashSet<_>>().len()
}

fn frames(width: usize, height: usize, count: usize, colors: usize) -> Vec<Vec<u8>> {
    (0..count).map(|i| frame(width, height, i, colors)).collect()
}

fn movie(format: MovieFormat, size: (usize, usize), fps: f64, frames: &[Vec<u8>]) -> Vec<u8> {
    let to = Cursor::new(Vec::new());
    let mut movie = Movie::new(format, to, size.0 as u32, size.1 as u32, fps).unwrap();
    for frame in frames {
        movie.push(frame).unwrap();
    }
    movie.finish().unwrap().into_inner()
}

/// Pictures as a player shows them, with how long in milliseconds.
fn shown<'a>(decoder: impl AnimationDecoder<'a>) -> Vec<(Vec<u8>, f64)> {
    decoder
        .into_frames()
        .map(|frame| {
            let frame = frame.unwrap();
            let (up, down) = frame.delay().numer_denom_ms();
            assert!(frame.buffer().pixels().all(|p| p.0[3] == 255));
            let rgb = frame.buffer().pixels().flat_map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
            (rgb, f64::from(up) / f64::from(down))
        })
        .collect()
}

fn shown_gif(file: &[u8]) -> Vec<(Vec<u8>, f64)> {
    shown(GifDecoder::new(Cursor::new(file)).unwrap())
}

fn shown_apng(file: &[u8]) -> Vec<(Vec<u8>, f64)> {
    shown(PngDecoder::new(Cursor::new(file)).unwrap().apng().unwrap())
}

fn psnr_db(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let squares: f64 = a.iter().zip(b).map(|(&a, &b)| f64::from(a.abs_diff(b)).powi(2)).sum();
    10.0 * (255.0f64.powi(2) * a.len() as f64 / squares).log10()
}

#[test]
fn endings() {
    let of = |name: &str| MovieFormat::of(Path::new(name));
    assert_eq!(of("a.mp4"), Some(MovieFormat::Mp4));
    assert_eq!(of("b/a.GIF"), Some(MovieFormat::Gif));
    assert_eq!(of("a.png.Apng"), Some(MovieFormat::Apng));
    assert_eq!((of("a.png"), of("mp4"), of("a.mp4.txt")), (None, None, None));
}

#[test]
fn apng_is_exact() {
    let size = (61, 37);
    let mut frames = frames(size.0, size.1, 7, 5000);
    // Also twice the same, and nothing but one pixel different.
    frames.push(frames[6].clone());
    frames.push(frames[7].clone());
    *frames[8].last_mut().unwrap() ^= 1;
    let file = movie(MovieFormat::Apng, size, 29.97, &frames);
    let shown = shown_apng(&file);
    assert_eq!(shown.len(), frames.len());
    for (i, ((rgb, delay_ms), frame)) in shown.iter().zip(&frames).enumerate() {
        assert!(rgb == frame, "frame {i}");
        // The reader rounds it to whole milliseconds' parts; the file is looked at below.
        assert!((delay_ms - 1e3 / 29.97).abs() < 1.0, "{delay_ms}");
    }
    let reader = png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
    let control = reader.info().animation_control.unwrap();
    assert_eq!((control.num_frames, control.num_plays), (9, 0));
    let first = reader.info().frame_control.unwrap();
    assert_eq!((first.delay_num, first.delay_den), (100, 2997));
    assert_eq!(reader.info().srgb, Some(png::SrgbRenderingIntent::Perceptual));
}

#[test]
fn gif_of_few_colors_is_exact() {
    // 5 colours; 255 and 256, beside which there is no room for "as before"; one frame; and after 400.
    for (count, colors) in [(9, 5), (5, 255), (5, 256), (1, 30)] {
        let size = (120, 80);
        let mut frames = frames(size.0, size.1, count, colors);
        assert!(frames.iter().all(|f| distinct(f) <= 256));
        assert!(colors < 255 || frames.iter().any(|f| distinct(f) >= 255), "{colors}");
        frames.push(frames[count - 1].clone());
        let shown = shown_gif(&movie(MovieFormat::Gif, size, 25.0, &frames));
        assert_eq!(shown.len(), frames.len());
        for (i, ((rgb, delay_ms), frame)) in shown.iter().zip(&frames).enumerate() {
            assert!(rgb == frame, "{colors} colours, frame {i}");
            assert_eq!(*delay_ms, 40.0);
        }
    }
    // What a frame of many colours left inexact, a frame of few puts right.
    let size = (120, 80);
    let mut mixed = vec![frame(size.0, size.1, 0, 2000), frame(size.0, size.1, 0, 2000)];
    for rgb in mixed[1].as_chunks_mut::<3>().0.iter_mut().skip(60 * 40) {
        *rgb = [9, 9, 9];
    }
    assert!(distinct(&mixed[0]) > 256 && distinct(&mixed[1]) <= 256);
    let shown = shown_gif(&movie(MovieFormat::Gif, size, 25.0, &mixed));
    assert!(shown[0].0 != mixed[0] && shown[1].0 == mixed[1]);
}

#[test]
fn gif_of_many_colors_is_near() {
    // All reds and greens, moving.
    let size = (256, 128);
    let frames: Vec<Vec<u8>> = (0..3)
        .map(|i| {
            (0..size.0 * size.1)
                .flat_map(|p| [(p % 256) as u8, (2 * (p / 256)) as u8, 40 * i as u8])
                .collect()
        })
        .collect();
    let file = movie(MovieFormat::Gif, size, 10.0, &frames);
    for ((rgb, _), frame) in shown_gif(&file).iter().zip(&frames) {
        // 255 colours on a square of 256: a cell is 16 wide, its mean square error 16²/12 in two of three channels.
        let grid = 10.0 * (255.0f64.powi(2) / (2.0 / 3.0 * 16.0f64.powi(2) / 12.0)).log10();
        let db = psnr_db(rgb, frame);
        // Near that, though no rule of the colours is known beforehand.
        assert!(db > grid - 3.0, "{db} dB, a grid has {grid}");
    }
}

#[test]
fn gif_keeps_its_mean_rate_and_loops() {
    let frames = frames(16, 16, 300, 3);
    let file = movie(MovieFormat::Gif, (16, 16), 30.0, &frames);
    let shown = shown_gif(&file);
    assert!(shown.iter().all(|(_, ms)| [30.0, 40.0].contains(ms)));
    assert_eq!(shown.iter().map(|(_, ms)| ms).sum::<f64>(), 10_000.0);
    let mut decoder = gif::DecodeOptions::new().read_info(Cursor::new(&file)).unwrap();
    while decoder.read_next_frame().unwrap().is_some() {}
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
}

/// The boxes of an MP4 file: kind and contents.
fn boxes(mut bytes: &[u8]) -> Vec<(&str, &[u8])> {
    let mut boxes = Vec::new();
    while !bytes.is_empty() {
        let long = u32_at(bytes, 0) == 1;
        let (head, size) = if long {
            (16, u64::from_be_bytes(bytes[8..16].try_into().unwrap()) as usize)
        } else {
            (8, u32_at(bytes, 0) as usize)
        };
        boxes.push((std::str::from_utf8(&bytes[4..8]).unwrap(), &bytes[head..size]));
        bytes = &bytes[size..];
    }
    boxes
}

/// The contents of the box at a path of kinds, where `skip` of the last one's parent stand before its boxes.
fn inner<'a>(mut bytes: &'a [u8], path: &[(&str, usize)]) -> &'a [u8] {
    for &(kind, skip) in path {
        let found = boxes(bytes).into_iter().find(|b| b.0 == kind);
        bytes = &found.unwrap_or_else(|| panic!("no {kind}")).1[skip..];
    }
    bytes
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap())
}

const TABLES: [(&str, usize); 5] = [("moov", 0), ("trak", 0), ("mdia", 0), ("minf", 0), ("stbl", 0)];

fn table<'a>(file: &'a [u8], kind: &str) -> &'a [u8] {
    inner(file, &[&TABLES[..], &[(kind, 4)]].concat())
}

/// avc1: eight bytes of the table's head, 78 of its own before the boxes in it.
fn description(file: &[u8]) -> &[u8] {
    inner(table(file, "stsd"), &[]).get(4..).map(|entries| inner(entries, &[("avc1", 78)])).unwrap()
}

/// The stream of an MP4 file as start codes and units, as its tables say.
fn stream(file: &[u8]) -> Vec<u8> {
    let mut stream = Vec::new();
    let mut unit = |unit: &[u8]| {
        stream.extend([0, 0, 0, 1]);
        stream.extend_from_slice(unit);
    };
    let avcc = inner(description(file), &[("avcC", 0)]);
    assert_eq!((avcc[0], avcc[4] & 3, avcc[5] & 31), (1, 3, 1), "lengths of four bytes, one parameter set");
    let sps = usize::from(u16::from_be_bytes([avcc[6], avcc[7]]));
    let pps = usize::from(u16::from_be_bytes([avcc[9 + sps], avcc[10 + sps]]));
    assert_eq!(avcc[1..4], avcc[9..12], "profile and level are those of the parameter set");
    unit(&avcc[8..8 + sps]);
    unit(&avcc[11 + sps..11 + sps + pps]);
    let (sizes, chunks) = (table(file, "stsz"), table(file, "stco"));
    assert_eq!((u32_at(sizes, 0), u32_at(chunks, 0)), (0, 1));
    let mut at = u32_at(chunks, 4) as usize;
    for i in 0..u32_at(sizes, 4) as usize {
        let end = at + u32_at(sizes, 8 + 4 * i) as usize;
        while at < end {
            let length = u32_at(file, at) as usize;
            assert!(length > 0 && at + 4 + length <= end);
            unit(&file[at + 4..at + 4 + length]);
            at += 4 + length;
        }
    }
    stream
}

#[test]
fn mp4_boxes_say_what_there_is() {
    for (size, fps, count) in
        [((64, 48), 25.0, 120), ((62, 46), 29.97, 7), ((33, 31), 0.5, 2), ((64, 64), 60.0, 1)]
    {
        let file = movie(MovieFormat::Mp4, size, fps, &frames(size.0, size.1, count, 40));
        let kinds: Vec<_> = boxes(&file).into_iter().map(|b| b.0).collect();
        // The index first.
        assert_eq!(kinds, ["ftyp", "moov", "free", "mdat"]);
        let header = inner(&file, &[("moov", 0), ("trak", 0), ("mdia", 0), ("mdhd", 4)]);
        let (scale, duration) = (f64::from(u32_at(header, 8)), f64::from(u32_at(header, 12)));
        assert!((duration / scale - count as f64 / fps).abs() < 1e-9, "{duration}/{scale}");
        let movie_header = inner(&file, &[("moov", 0), ("mvhd", 4)]);
        assert_eq!(movie_header[8..16], header[8..16]);
        assert_eq!(u32_at(table(&file, "stsz"), 4), count as u32);
        let times = table(&file, "stts");
        assert_eq!((u32_at(times, 0), u32_at(times, 4)), (1, count as u32));
        assert_eq!(f64::from(u32_at(times, 8)) * count as f64, duration);
        // A frame that can be sought to every two seconds.
        let every = (2.0 * fps).round() as usize;
        let expected: Vec<_> = (1..=count as u32).step_by(every).collect();
        if expected.len() < count {
            let keys = table(&file, "stss");
            let numbers: Vec<_> = (0..u32_at(keys, 0) as usize).map(|i| u32_at(keys, 4 + 4 * i)).collect();
            assert_eq!(numbers, expected);
        } else {
            // Without the table all are.
            assert!(boxes(inner(&file, &TABLES)).iter().all(|b| b.0 != "stss"));
        }
        let color = inner(description(&file), &[("colr", 0)]);
        assert_eq!(
            color, *b"nclx\0\x01\0\x0d\0\x01\0",
            "BT.709 primaries, sRGB, BT.709 matrix, limited range"
        );
    }
}

#[test]
fn mp4_shows_what_was_given() {
    // Even, odd, no multiple of 16; several seconds, so that there is more than one key frame.
    for (size, count) in [((128, 96), 60), ((75, 51), 12)] {
        let frames = frames(size.0, size.1, count, 6);
        let file = movie(MovieFormat::Mp4, size, 25.0, &frames);
        let shown = rusty_h264_decoder::Decoder::new().decode_stream(&stream(&file)).unwrap();
        assert_eq!(shown.len(), count);
        for (i, (picture, frame)) in shown.iter().zip(&frames).enumerate() {
            assert_eq!((picture.width, picture.height), (size.0 + size.0 % 2, size.1 + size.1 % 2));
            let mut rows = picture.y.chunks(picture.width);
            let luma: Vec<u8> = rows.by_ref().take(size.1).flat_map(|row| row[..size.0].to_vec()).collect();
            let expected: Vec<u8> = frame
                .as_chunks::<3>()
                .0
                .iter()
                .map(|rgb| {
                    let [r, g, b] = rgb.map(f64::from);
                    (16.0 + (0.2126 * r + 0.7152 * g + 0.0722 * b) * 219.0 / 255.0).round() as u8
                })
                .collect();
            // Beyond what the eye can tell from the original.
            let db = psnr_db(&luma, &expected);
            assert!(db > 45.0, "{size:?}, frame {i}: {db} dB");
            // The colour of the bar, at its middle; chroma is shared by two columns.
            let (x, y) = ((3 * i + 4) % size.0 / 2, size.1 / 8);
            if (3 * i) % size.0 + 9 < size.0 && frame[3 * (2 * y * size.0 + 2 * x)..][..3] == [30, 90, 220] {
                let at = y * picture.width / 2 + x;
                assert!(picture.u[at].abs_diff(191) <= 6 && picture.v[at].abs_diff(96) <= 6, "frame {i}");
            }
        }
        // The repeated last column.
        if size.0 % 2 == 1 {
            let row = &shown[0].y[..picture_width(size)];
            assert!(row[size.0].abs_diff(row[size.0 - 1]) <= 3);
        }
    }
}

fn picture_width(size: (usize, usize)) -> usize {
    size.0.next_multiple_of(2)
}

#[test]
fn long_mp4_has_its_index_last() {
    let count = 9000;
    let still = frame(16, 16, 0, 3);
    let mut movie = Movie::new(MovieFormat::Mp4, Cursor::new(Vec::new()), 16, 16, 60.0).unwrap();
    for _ in 0..count {
        movie.push(&still).unwrap();
    }
    let file = movie.finish().unwrap().into_inner();
    let kinds: Vec<_> = boxes(&file).into_iter().map(|b| b.0).collect();
    assert_eq!(kinds, ["ftyp", "free", "mdat", "moov"]);
    assert_eq!(u32_at(table(&file, "stsz"), 4), count);
}

#[test]
fn refusals_say_why() {
    let new =
        |format, width, height, fps| Movie::new(format, Cursor::new(Vec::new()), width, height, fps).err();
    let all = [MovieFormat::Mp4, MovieFormat::Gif, MovieFormat::Apng];
    let said = |error: Option<MovieError>| error.expect("an error").to_string();
    for format in all {
        for fps in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-7, 1e7] {
            assert!(said(new(format, 16, 16, fps)).contains("frames a second"), "{fps}");
        }
        assert!(said(new(format, 0, 16, 25.0)).contains("0x16"));
        for fps in [25.0, 30.0, 29.97, 0.5, 24000.0 / 1001.0] {
            assert!(new(format, 16, 16, fps).is_none(), "{fps}");
        }
        let mut movie = Movie::new(format, Cursor::new(Vec::new()), 4, 2, 25.0).unwrap();
        let error = movie.push(&[0; 23]).unwrap_err().to_string();
        assert!(error.contains("23") && error.contains("24"), "{error}");
        assert!(matches!(movie.finish(), Err(MovieError::Empty)));
    }
    assert!(said(new(MovieFormat::Gif, 16, 16, 60.0)).contains("at most 50"));
    assert!(new(MovieFormat::Gif, 16, 16, 50.0).is_none());
    assert!(said(new(MovieFormat::Gif, 16, 16, 0.005)).contains("hundred seconds"));
    assert!(said(new(MovieFormat::Apng, 16, 16, 100.0)).contains("at most 90"));
    assert!(new(MovieFormat::Mp4, 16, 16, 240.0).is_none());
    assert!(said(new(MovieFormat::Gif, 65536, 1, 25.0)).contains("65536x1"));
    assert!(said(new(MovieFormat::Mp4, 17000, 16, 25.0)).contains("level"));
    assert!(said(new(MovieFormat::Mp4, 7680, 4320, 200.0)).contains("level"));
}

/// Takes so many bytes, then has no room.
struct Full(Cursor<Vec<u8>>, u64);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.0.position() + bytes.len() as u64 > self.1 {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Seek for Full {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn a_full_disk_is_an_error() {
    for format in [MovieFormat::Mp4, MovieFormat::Gif, MovieFormat::Apng] {
        let whole = movie(format, (40, 30), 25.0, &frames(40, 30, 3, 500)).len() as u64;
        for room in [0, 20, whole / 2, whole - 1] {
            let written =
                Movie::new(format, Full(Cursor::new(Vec::new()), room), 40, 30, 25.0).and_then(|mut m| {
                    for frame in frames(40, 30, 3, 500) {
                        m.push(&frame)?;
                    }
                    m.finish()
                });
            match written.map(drop) {
                Err(MovieError::Io(e)) => assert_eq!(e.kind(), std::io::ErrorKind::StorageFull),
                other => panic!("{format:?}, room for {room} of {whole}: {other:?}"),
            }
        }
    }
}

#[test]
#[ignore = "needs ffmpeg"]
fn ffmpeg_shows_what_was_given() {
    use std::process::Command;
    let folder = tempfile::tempdir().unwrap();
    // 4:2:0 halves the colours' resolution: an exact comparison needs pairs of equal pixels.
    let size = (128, 96);
    let frames: Vec<Vec<u8>> = frames(size.0 / 2, size.1 / 2, 60, 5)
        .iter()
        .map(|small| {
            let rows = small.chunks(3 * size.0 / 2).map(|row| row.as_chunks::<3>().0.concat_twice());
            rows.flat_map(|row| [row.clone(), row].concat()).collect()
        })
        .collect();
    for (name, format, least_db) in [
        ("movie.mp4", MovieFormat::Mp4, 42.0),
        ("movie.gif", MovieFormat::Gif, f64::INFINITY),
        ("movie.apng", MovieFormat::Apng, f64::INFINITY),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, movie(format, size, 25.0, &frames)).unwrap();
        let run = |program: &str, arguments: &[&str]| {
            let output = Command::new(program).args(arguments).output().expect(program);
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success() && said.is_empty(), "{name}: {said}");
            output.stdout
        };
        let path = path.to_str().unwrap();
        let fields = "stream=width,height,color_range,color_space,avg_frame_rate,nb_read_frames";
        let said = run(
            "ffprobe",
            &["-v", "error", "-count_frames", "-show_entries", fields, "-of", "default=nk=0:nw=1", path],
        );
        let said = String::from_utf8(said).unwrap();
        let mut expected = vec!["width=128", "height=96", "nb_read_frames=60"];
        if format == MovieFormat::Mp4 {
            expected.extend(["color_range=tv", "color_space=bt709", "avg_frame_rate=25/1"]);
        }
        for line in expected {
            assert!(said.lines().any(|l| l == line), "{name}: {said}");
        }
        // Every frame once, whatever its time; chroma as it is for the four pixels that share it.
        let pairs = "scale=flags=neighbor+full_chroma_int+accurate_rnd,format=rgb24";
        let raw = run(
            "ffmpeg",
            &[
                &["-v", "error", "-i", path, "-fps_mode", "passthrough", "-vf", pairs][..],
                &["-f", "rawvideo", "-"],
            ]
            .concat(),
        );
        assert_eq!(raw.len(), frames.len() * frames[0].len(), "{name}");
        for (i, (shown, given)) in raw.chunks(frames[0].len()).zip(&frames).enumerate() {
            let db = psnr_db(shown, given);
            assert!(db >= least_db, "{name}, frame {i}: {db} dB");
        }
    }
}

trait ConcatTwice {
    /// Every pixel twice.
    fn concat_twice(&self) -> Vec<u8>;
}

impl ConcatTwice for [[u8; 3]] {
    fn concat_twice(&self) -> Vec<u8> {
        self.iter().flat_map(|&pixel| [pixel, pixel].concat()).collect()
    }
}
