//! Maps that are sound HDF5 files and odd as maps: other types, shapes, attributes, lengths and
//! numbers than slipmap writes.
//!
//! The bytes are read as choices, one after the other; 0, also after the last one, chooses what
//! slipmap writes.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use hdf5::types::{FixedAscii, FixedUnicode, VarLenUnicode};
use hdf5::{Dataset, File, Group, H5Type, Location};
use slipmap::maps::check::{Effort, Program, check};
use slipmap::report::preview::preview;
use slipmap::setting::SweepSpec;
use slipmap::store::MapFile;
use slipmap::sweep::Plan;

const SWEEP: &str = "fields = [\"n_unstable\", \"abscissa\"]\nbest = true\n[axes]\nmu_prime = [-0.2, -0.1]\n\
    alpha_v = [-1.0, -0.5, 0.0]\ntau = [1.0, 2.0, 3.0, 4.0]\n[fixed]\nalpha_n = 0.0\n";
const SHAPE: [usize; 3] = [2, 3, 4];
/// More values than this are not written, only claimed.
const MOST_WRITTEN: usize = 1000;

static HASH: LazyLock<String> = LazyLock::new(|| {
    let spec: SweepSpec = SWEEP.parse().unwrap();
    Plan::new(spec).unwrap().hash()
});

static FOLDER: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let memory = Path::new("/dev/shm");
    let folder = match memory.is_dir() {
        true => tempfile::tempdir_in(memory),
        false => tempfile::tempdir(),
    };
    folder.unwrap()
});

/// Makes a map as the bytes say, and reads all of it.
pub(super) fn map(data: &[u8]) {
    // Tests run side by side.
    let path: PathBuf = FOLDER
        .path()
        .join(format!("{:?}.h5", std::thread::current().id()));
    if write(&path, &mut Choices(data)).is_err() {
        // The library refuses to write some of what can be asked for.
        return;
    }
    let sound = data.iter().all(|&choice| choice == 0);
    match MapFile::open(&path) {
        // A second look at a cell takes longer than all the rest.
        Ok(map) => read(&map, sound, u64::from(data.len() % 32 == 1)),
        Err(error) => assert!(!sound, "{error}"),
    }
}

fn read(map: &MapFile, sound: bool, cells: u64) {
    assert!(map.cells() > 0 && !map.axes().is_empty());
    let mut ok = true;
    for field in map.fields() {
        let _ = map.field_unit(*field);
        ok &= map.summary(*field).is_ok();
        let index: Vec<usize> = map.axes().iter().map(|a| a.values.len() - 1).collect();
        for row in 0..index.len() {
            for column in 0..index.len() {
                let Ok(plane) = map.plane(*field, &index, (row, column), 3) else {
                    ok = false;
                    continue;
                };
                let expected = match row == column {
                    true => plane.columns.len(),
                    false => plane.rows.len() * plane.columns.len(),
                };
                assert_eq!(plane.cells.len(), expected);
            }
        }
    }
    ok &= map.status_counts().is_ok() && map.sizes().is_ok();
    match map.curves_where(|_| true) {
        Ok(curves) => ok &= curves.len() == 2,
        Err(error) => assert!(!error.to_string().is_empty() && !sound),
    }
    match map.best() {
        Ok(best) => ok &= best.len() == 2,
        Err(error) => assert!(!error.to_string().is_empty() && !sound),
    }
    let _ = (map.degree_unit(), map.scalars(), map.is_partial());
    ok &= preview(map, 60, false).is_ok();
    let effort = Effort { cells, tiles: 0 };
    let program = Program {
        version: "",
        revision: "",
    };
    let report = check(map, program, effort);
    ok &= report.is_ok();
    assert!(ok || !sound, "{report:?}");
}

/// Choices one after the other.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn next(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else {
            return 0;
        };
        self.0 = rest;
        first
    }

    /// Numbers to fill a dataset with.
    fn real(&mut self, sound: f64) -> f64 {
        match self.next() {
            0 => sound,
            1 => f64::NAN,
            2 => f64::INFINITY,
            3 => f64::NEG_INFINITY,
            4 => f64::MAX,
            5 => f64::MIN_POSITIVE / 3.0,
            6 => -0.0,
            7 => -1.0,
            8 => 65535.0,
            9 => 255.0,
            10 => 2_147_483_647.0,
            n => f64::from(n) - 128.0,
        }
    }
}

fn write(path: &Path, c: &mut Choices) -> hdf5::Result<()> {
    let file = File::create(path)?;
    put_version(&file, c)?;
    put_text(&file, "axes", "mu_prime alpha_v tau", c)?;
    put_text(&file, "sweep", SWEEP, c)?;
    put_text(&file, "plan_hash", &HASH, c)?;
    let missing = c.next();
    if missing != 0 {
        file.new_attr::<u64>()
            .shape(usize::from(missing % 3))
            .create("cells_missing")?;
    }
    let axes: [(&str, &[f64]); 3] = [
        ("mu_prime", &[-0.2, -0.1]),
        ("alpha_v", &[-1.0, -0.5, 0.0]),
        ("tau", &[1.0, 2.0, 3.0, 4.0]),
    ];
    for (name, values) in axes {
        put(
            &file,
            name,
            &[values.len()],
            |i| values.get(i).map_or(9.0 + i as f64, |v| *v),
            c,
        )?;
    }
    for name in ["n_unstable", "abscissa", "certificate_margin", "status"] {
        put(&file, name, &SHAPE, |i| (2 * (i % 2)) as f64, c)?;
    }
    match c.next() {
        0 => {}
        1 => put(&file, "boundaries", &[1], |_| 0.0, c)?,
        2 => put(&file, "vc", &SHAPE, |_| 0.0, c)?,
        3 => put(&file, "outcome", &SHAPE, |_| 0.0, c)?,
        4 => put(&file, "alpha_n", &[], |_| 0.0, c)?,
        5 => file.link_soft("/nowhere", "class")?,
        6 => file.link_soft("/status", "class")?,
        7 => drop(file.create_group("class")?),
        _ => return Ok(()),
    }
    put_curves(&file, c)?;
    put_best(&file, c)?;
    file.close()
}

fn put_curves(file: &File, c: &mut Choices) -> hdf5::Result<()> {
    let group = file.create_group("boundaries")?;
    put_text(&group, "plane", "alpha_v tau", c)?;
    for name in [
        "mu_prime",
        "degree_of_stability",
        "branch",
        "direction",
        "stable_side",
    ] {
        put(&group, name, &[2], |i| i as f64, c)?;
    }
    put(&group, "vertex_count", &[2], |i| 2.0 + i as f64, c)?;
    for name in ["alpha_v", "tau", "omega"] {
        put(&group, name, &[5], |i| i as f64, c)?;
    }
    Ok(())
}

fn put_best(file: &File, c: &mut Choices) -> hdf5::Result<()> {
    let group = file.create_group("best")?;
    put_text(&group, "plane", "alpha_v tau", c)?;
    let names = [
        "alpha_v",
        "tau",
        "abscissa",
        "frequency",
        "relaxation_time",
        "kind",
        "certified",
        "regions",
    ];
    for name in names {
        put(&group, name, &[2], |i| i as f64, c)?;
    }
    Ok(())
}

fn put_version(file: &File, c: &mut Choices) -> hdf5::Result<()> {
    let name = "slipmap_format_version";
    match c.next() {
        0 => file.new_attr_builder().with_data(&[2_i32]).create(name)?,
        1 => file.new_attr_builder().with_data(&[1_i32]).create(name)?,
        2 => file.new_attr_builder().with_data(&[2.0_f64]).create(name)?,
        3 => file
            .new_attr_builder()
            .with_data(&[2_u64, 2])
            .create(name)?,
        4 => file.new_attr::<i32>().shape(0).create(name)?,
        5 => return put_text(file, name, "2", c),
        _ => file.new_attr_builder().with_data(&[3_i8]).create(name)?,
    };
    Ok(())
}

/// A text attribute, or what stands in its place.
fn put_text(at: &Location, name: &str, text: &str, c: &mut Choices) -> hdf5::Result<()> {
    let changed = |from: &str, to: &str| text.replace(from, to);
    let other = match c.next() {
        0 => text.to_owned(),
        1 => return Ok(()),
        2 => {
            at.new_attr::<f64>().shape(3).create(name)?;
            return Ok(());
        }
        // Never written: a string without a pointer.
        3 => {
            at.new_attr::<VarLenUnicode>().create(name)?;
            return Ok(());
        }
        4 => return put_fixed(at, name, &[0xff; 8], 1),
        5 => return put_fixed(at, name, text.as_bytes(), 2),
        6 => return put_fixed(at, name, b"", 0),
        7 => changed("tau", "tau tau"),
        8 => changed("alpha_v", "v0"),
        9 => changed("alpha_v", "tau"),
        10 => changed("tau", ""),
        11 => changed("mu_prime", "tau"),
        12 => changed("2", "1e300"),
        13 => String::new(),
        14 => text.repeat(1 << 10),
        15 => changed(" ", "\u{2003}"),
        n => changed("a", &char::from(n).to_string()),
    };
    let text: Text = other
        .replace('\0', " ")
        .parse()
        .map_err(|e| hdf5::Error::from(format!("{e}")))?;
    let attribute = at.new_attr::<Text>().create(name)?;
    attribute.write_scalar(&text)
}

/// Longer than any text here.
type Text = FixedUnicode<1024>;

fn put_fixed(at: &Location, name: &str, bytes: &[u8], count: usize) -> hdf5::Result<()> {
    // SAFETY: the bytes are only copied; that they are no ASCII is the point.
    let text = unsafe { FixedAscii::<32>::from_ascii_unchecked(&bytes[..bytes.len().min(32)]) };
    let attribute = at.new_attr::<FixedAscii<32>>().shape(count).create(name)?;
    attribute.write_raw(&vec![text; count])
}

/// A dataset, or what stands in its place.
fn put(
    at: &Group,
    name: &str,
    sound: &[usize],
    value: impl Fn(usize) -> f64,
    c: &mut Choices,
) -> hdf5::Result<()> {
    let shape = match c.next() {
        0 => sound.to_vec(),
        1 => return Ok(()),
        2 => return at.create_group(name).map(drop),
        3 => return at.link_soft(name, name),
        4 => Vec::new(),
        5 => vec![0],
        6 => vec![1 << 40],
        7 => vec![1 << 31, 1 << 31],
        8 => sound.iter().map(|n| n << 10).collect(),
        9 => sound.iter().map(|n| n + 1).collect(),
        10 => sound.iter().rev().copied().collect(),
        11 => vec![sound.iter().product()],
        12 => [&[1], sound].concat(),
        13 => vec![10_000_000],
        n => vec![usize::from(n)],
    };
    let kind = match c.next() {
        0 => sound_kind(name),
        kind => kind,
    };
    match kind {
        1 => put_as::<f32>(at, name, &shape, |x| x as f32, value, c),
        2 => put_as::<i8>(at, name, &shape, |x| x as i8, value, c),
        3 => put_as::<u8>(at, name, &shape, |x| x as u8, value, c),
        4 => put_as::<u16>(at, name, &shape, |x| x as u16, value, c),
        5 => put_as::<i32>(at, name, &shape, |x| x as i32, value, c),
        6 => put_as::<i64>(at, name, &shape, |x| x as i64, value, c),
        7 => put_as::<u64>(at, name, &shape, |x| x as u64, value, c),
        8 => put_as::<bool>(at, name, &shape, |x| x > 0.5, value, c),
        9 => put_as::<[f64; 3]>(at, name, &shape, |x| [x; 3], value, c),
        10 => describe(
            &at.new_dataset::<VarLenUnicode>()
                .shape(shape)
                .create(name)?,
            c,
        ),
        11 => describe(
            &at.new_dataset::<FixedAscii<8>>()
                .shape(shape)
                .create(name)?,
            c,
        ),
        _ => put_as::<f64>(at, name, &shape, |x| x, value, c),
    }
}

/// The choice of the type that slipmap gives a dataset.
fn sound_kind(name: &str) -> u8 {
    match name {
        "direction" | "stable_side" | "kind" | "certified" => 2,
        "status" => 3,
        "n_unstable" => 4,
        "vertex_count" | "regions" => 5,
        "branch" => 6,
        _ => 0,
    }
}

fn put_as<T: H5Type>(
    at: &Group,
    name: &str,
    shape: &[usize],
    convert: impl Fn(f64) -> T,
    value: impl Fn(usize) -> f64,
    c: &mut Choices,
) -> hdf5::Result<()> {
    let cells = shape.iter().fold(1_usize, |n, &l| n.saturating_mul(l));
    let builder = at.new_dataset::<T>();
    let storage = c.next();
    let builder = match storage {
        1 => builder.deflate(1),
        2 => builder.shuffle().deflate(1),
        _ => builder,
    };
    let dataset = match storage {
        _ if cells > MOST_WRITTEN => builder
            .chunk(shape.iter().map(|&n| n.min(1 << 7)).collect::<Vec<_>>())
            .shape(shape),
        3 => builder.chunk(vec![1; shape.len()]).shape(shape),
        4 => builder.chunk(vec![1000; shape.len()]).shape(shape),
        5 => builder.no_chunk().shape(shape),
        // As slipmap writes datasets of cells of this size.
        0 if shape.len() > 1 || at.name() == "/boundaries" => {
            builder.chunk(shape.to_vec()).shape(shape)
        }
        _ => builder.shape(shape),
    }
    .create(name)?;
    if cells <= MOST_WRITTEN && storage != 6 {
        let sound = c.next() == 0;
        let number = |i: usize| match sound {
            true => value(i),
            false => c.real(value(i)),
        };
        let values: Vec<T> = (0..cells).map(number).map(convert).collect();
        dataset.write_raw(&values)?;
    }
    describe(&dataset, c)
}

fn describe(dataset: &Dataset, c: &mut Choices) -> hdf5::Result<()> {
    put_text(dataset, "units", "1", c)
}
