//! Reads values of a dataset that [`super::open`] has accepted.
//!
//! [`super::chunk_layout`] inflates the chunks. The library would inflate whatever a chunk holds,
//! up to a thousand times its bytes, before comparing that with the chunk's own size.

use std::ops::Range;

use hdf5::{Dataset, Datatype, H5Type, SliceOrIndex};
use hdf5_sys::h5::HADDR_UNDEF;
use hdf5_sys::h5d::{H5Dget_chunk_info_by_coord, H5Dread_chunk1};
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5P_DEFAULT;

use super::chunk_layout::ChunkLayout;
use super::open::{self, DEFLATE, SHUFFLE};
use super::picked::Picked;
use crate::setting::axis::MOST_POINTS;

unsafe extern "C" {
    /// A constant of HDF5 that the binding lacks.
    fn H5Dget_chunk_storage_size(dataset: hid_t, offset: *const u64, bytes: *mut u64) -> i32;
}

/// Numbers as they stand in maps: little-endian.
pub(super) trait Number: H5Type + Copy + Default {
    /// The number in these little-endian bytes, of its own size.
    fn of(bytes: &[u8]) -> Self;
}

macro_rules! number {
    ($($kind:ty),*) => {$(
        impl Number for $kind {
            fn of(bytes: &[u8]) -> Self {
                bytes.try_into().map_or(0 as $kind, <$kind>::from_le_bytes)
            }
        }
    )*};
}
number!(u8, u16, u32, u64, i8, i32, i64, f32, f64);

/// Whether a type in a file is the type `T`.
pub(super) fn is_of<T: H5Type>(kind: &hdf5::Result<Datatype>) -> bool {
    let Ok(kind) = kind else {
        return false;
    };
    Datatype::from_type::<T>().is_ok_and(|asked| asked == *kind)
}

/// A dataset stored in chunks.
#[derive(Debug)]
pub(super) struct Chunks {
    dataset: Dataset,
    layout: ChunkLayout,
}

impl Chunks {
    /// The chunks of a dataset; none where it is not stored in chunks.
    pub(super) fn of(dataset: &Dataset) -> hdf5::Result<Option<Self>> {
        let Some(chunk) = dataset.chunk() else {
            return Ok(None);
        };
        let shape = dataset.shape();
        if chunk.len() != shape.len() || chunk.contains(&0) {
            return Err("its chunks have another number of dimensions".into());
        }
        let filters = open::filters_of(dataset)?;
        let layout = ChunkLayout {
            shape,
            chunk,
            element: dataset.dtype()?.size(),
            deflated: filters.contains(&DEFLATE),
            shuffled: filters.contains(&SHUFFLE),
        };
        Ok(Some(Self {
            dataset: dataset.clone(),
            layout,
        }))
    }

    /// How the chunks are stored.
    pub(super) fn layout(&self) -> &ChunkLayout {
        &self.layout
    }

    /// Bytes of the chunk at `offset` in the file; none where there is no chunk.
    fn size(&self, offset: &[u64]) -> hdf5::Result<Option<u64>> {
        let (dataset, mut size) = (self.dataset.id(), 0);
        let found = hdf5::sync::sync(|| {
            // SAFETY: the dataset is open and chunked, and `offset` has one entry per dimension of
            // it.
            let found =
                unsafe { H5Dget_chunk_storage_size(dataset, offset.as_ptr(), &raw mut size) };
            // It also fails where there is no chunk; the error then says so.
            match found >= 0 {
                true => Some(size),
                false => is_not_allocated().then_some(0),
            }
        });
        if let Some(size) = found {
            return Ok(Some(size).filter(|&size| size > 0));
        }
        // Searching through all chunks gives a certain answer, but takes long.
        let (mut filters, mut address) = (0, 0);
        // SAFETY: as above, and the results are live.
        let looked = hdf5::sync::sync(|| unsafe {
            H5Dget_chunk_info_by_coord(
                dataset,
                offset.as_ptr(),
                &raw mut filters,
                &raw mut address,
                &raw mut size,
            )
        });
        match looked >= 0 && (size == 0 || address == HADDR_UNDEF) {
            true => Ok(None),
            false => Err("a chunk cannot be found".into()),
        }
    }

    /// The bytes of the chunk whose first value is at `offset`, as stored in the file; none where
    /// there is no chunk.
    ///
    /// # Errors
    /// Where they cannot be read, are more than a chunk can have, or the file tells readers to skip
    /// a filter of this chunk.
    pub(super) fn stored(&self, offset: &[usize]) -> hdf5::Result<Option<Vec<u8>>> {
        let offset: Vec<u64> = offset.iter().map(|&o| o as u64).collect();
        let Some(size) = self.size(&offset)? else {
            return Ok(None);
        };
        // Deflate lengthens nothing by more than a thousandth and a few bytes.
        let most = self.layout.bytes() + self.layout.bytes() / 8 + 1024;
        let size = usize::try_from(size).ok().filter(|&size| size <= most);
        let mut bytes = vec![0; size.ok_or("a chunk has more bytes than it can have")?];
        let mut skipped = 0;
        let read = hdf5::sync::sync(|| {
            // SAFETY: as above, and the buffer has the size that the library has just reported.
            unsafe {
                H5Dread_chunk1(
                    self.dataset.id(),
                    H5P_DEFAULT,
                    offset.as_ptr(),
                    &raw mut skipped,
                    bytes.as_mut_ptr().cast(),
                )
            }
        });
        if read < 0 {
            return Err("a chunk cannot be read".into());
        }
        if skipped != 0 {
            return Err("filters of a chunk are to be skipped".into());
        }
        Ok(Some(bytes))
    }

    /// The decoded values of that chunk as bytes, including those beyond the dataset's edges.
    fn values(&self, offset: &[usize]) -> hdf5::Result<Option<Vec<u8>>> {
        let Some(bytes) = self.stored(offset)? else {
            return Ok(None);
        };
        Ok(Some(self.layout.decoded(bytes)?))
    }

    /// The values of a hyperslab, row by row; fill values where a chunk is missing.
    pub(super) fn read<T: Number>(&self, slab: &[SliceOrIndex]) -> hdf5::Result<Vec<T>> {
        let picked: Option<Vec<Picked>> = slab.iter().map(Picked::of).collect();
        let picked = picked.filter(|picked| {
            let inside = |(p, &end): (&Picked, &usize)| p.count == 0 || p.index(p.count - 1) < end;
            let shape = &self.layout.shape;
            picked.len() == shape.len() && picked.iter().zip(shape).all(inside)
        });
        let picked = picked.ok_or("a part of a dataset that is not there")?;
        let fill = self.dataset.create_plist()?.get_fill_value_as::<T>()?;
        let mut out = filled(&picked, fill.unwrap_or_default())?;
        let parts: Vec<_> = picked
            .iter()
            .zip(&self.layout.chunk)
            .map(|(p, &c)| p.by_chunk(c))
            .collect();
        let mut place = vec![0; parts.len()];
        if parts.iter().any(Vec::is_empty) {
            return Ok(out);
        }
        loop {
            let here: Vec<_> = parts
                .iter()
                .zip(&place)
                .map(|(part, &n)| &part[n])
                .collect();
            let offset: Vec<usize> = here.iter().map(|(start, _)| *start).collect();
            if let Some(bytes) = self.values(&offset)? {
                let numbers: Vec<_> = here.iter().map(|(_, numbers)| numbers.clone()).collect();
                let picker = Picker {
                    picked: &picked,
                    chunk: &self.layout.chunk,
                    offset,
                    numbers,
                };
                picker.along(0, (0, 0), &bytes, &mut out);
            }
            let Some(axis) = (0..parts.len()).rfind(|&axis| place[axis] + 1 < parts[axis].len())
            else {
                return Ok(out);
            };
            place[axis] += 1;
            place[axis + 1..].fill(0);
        }
    }
}

/// Whether the library's last error is that there is no chunk.
fn is_not_allocated() -> bool {
    let stack = hdf5::Error::query().ok().and_then(|error| error.stack());
    // The innermost frame is the cause.
    let cause = stack.as_ref().and_then(|frames| frames.last());
    cause.is_some_and(|frame| frame.desc().contains("not allocated"))
}

/// As many fill values as values are picked.
fn filled<T: Number>(picked: &[Picked], fill: T) -> hdf5::Result<Vec<T>> {
    let mut counts = picked.iter().map(|p| p.count);
    let count = counts
        .try_fold(1, usize::checked_mul)
        .ok_or("too many values")?;
    let mut out = Vec::new();
    let room = out.try_reserve_exact(count);
    room.map_err(|error| error.to_string())?;
    out.resize(count, fill);
    Ok(out)
}

/// Copies the picked values out of a chunk.
struct Picker<'a> {
    picked: &'a [Picked],
    chunk: &'a [usize],
    offset: Vec<usize>,
    numbers: Vec<Range<usize>>,
}

impl Picker<'_> {
    /// Copies the values along the axes from `axis` on. `from` is the position in the chunk and
    /// `to` the position among the picked values, both counted over the axes before it.
    fn along<T: Number>(
        &self,
        axis: usize,
        (from, to): (usize, usize),
        bytes: &[u8],
        out: &mut [T],
    ) {
        let (picked, numbers) = (&self.picked[axis], self.numbers[axis].clone());
        let inside = |number: usize| picked.index(number) - self.offset[axis];
        let (from, to) = (from * self.chunk[axis], to * picked.count);
        if axis + 1 < self.picked.len() {
            for number in numbers {
                let ahead = (from + inside(number), to + number);
                self.along(axis + 1, ahead, bytes, out);
            }
            return;
        }
        let size = size_of::<T>();
        let row = bytes[(from + inside(numbers.start)) * size..].chunks_exact(size);
        let places = out[to + numbers.start..to + numbers.end].iter_mut();
        for (place, value) in places.zip(row.step_by(picked.step)) {
            *place = T::of(value);
        }
    }
}

/// The values of a hyperslab of a dataset, row by row.
///
/// # Errors
/// Where the values have another type than `T`, or are damaged.
pub(super) fn read<T: Number>(dataset: &Dataset, slab: &[SliceOrIndex]) -> hdf5::Result<Vec<T>> {
    if !is_of::<T>(&dataset.dtype()) {
        return Err("its values are of another type".into());
    }
    let chunks = Chunks::of(dataset)?.ok_or("it is not stored in chunks")?;
    chunks.read(slab)
}

/// The largest factor by which deflate shrinks data: 258 bytes in two bits.
const MOST_DEFLATED: u64 = 1032;
/// The most bytes of values read at once: those of the longest axis.
const MOST_AT_ONCE: u64 = 8 * MOST_POINTS;

/// The number of values of a dataset other than of cells. A dataset that claims more values than
/// its bytes in the file can hold is refused before memory or time is spent on it.
fn count<T: Number>(dataset: &Dataset) -> hdf5::Result<usize> {
    if !is_of::<T>(&dataset.dtype()) {
        return Err("its values are of another type".into());
    }
    let mut lengths = dataset.shape().into_iter();
    let claimed = lengths.try_fold(1, usize::checked_mul);
    let stored = dataset.storage_size().min(dataset.file()?.size());
    let most = stored.saturating_mul(MOST_DEFLATED) / size_of::<T>() as u64;
    let claimed = claimed.filter(|&count| count as u64 <= most);
    claimed.ok_or_else(|| "it claims more values than its bytes can hold".into())
}

/// All values of a dataset.
///
/// # Errors
/// As for [`read`], and where there are more values than are read at once.
pub(super) fn whole<T: Number>(dataset: &Dataset) -> hdf5::Result<Vec<T>> {
    let count = count::<T>(dataset)?;
    if (count * size_of::<T>()) as u64 > MOST_AT_ONCE {
        return Err("it has more values than are read at once".into());
    }
    if let Some(chunks) = Chunks::of(dataset)? {
        let all = |count| SliceOrIndex::SliceCount {
            start: 0,
            step: 1,
            count,
            block: 1,
        };
        let slab: Vec<_> = dataset.shape().into_iter().map(all).collect();
        return chunks.read(&slab);
    }
    let mut values = Vec::new();
    let room = values.try_reserve_exact(count);
    room.map_err(|error| error.to_string())?;
    values.resize(count, T::default());
    dataset.as_reader().read_into_raw(&mut values)?;
    Ok(values)
}

/// Visits the values of a dataset; those of a one-dimensional dataset in chunks come chunk by
/// chunk.
///
/// # Errors
/// As for [`whole`], and those of `visit`.
pub(super) fn for_each_part<T: Number>(
    dataset: &Dataset,
    mut visit: impl FnMut(&[T]) -> hdf5::Result<()>,
) -> hdf5::Result<()> {
    let (shape, chunk) = (dataset.shape(), dataset.chunk());
    let ([length], Some([chunk])) = (&shape[..], chunk.as_deref()) else {
        return visit(&whole(dataset)?);
    };
    count::<T>(dataset)?;
    for start in (0..*length).step_by((*chunk).max(1)) {
        let count = (length - start).min(*chunk);
        let part = SliceOrIndex::SliceCount {
            start,
            step: 1,
            count,
            block: 1,
        };
        visit(&read::<T>(dataset, &[part])?)?;
    }
    Ok(())
}
