//! The file of a complete map, whole or in ranges (RFC 9110), for programs that read it by
//! themselves.

use std::fs::File;
use std::io::{Error, ErrorKind, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

use axum::body::Bytes;
use axum::extract::State;
use axum::http::header::{
    ACCEPT_RANGES, CONTENT_DISPOSITION, CONTENT_LENGTH, CONTENT_RANGE, CONTENT_TYPE, ETAG,
    HeaderMap, HeaderValue, IF_RANGE, RANGE,
};
use axum::http::{Method, StatusCode};
use axum::response::{IntoResponse, Response};
use tokio::sync::OwnedSemaphorePermit;

use super::readers::{Maps, no_map};
use crate::maps::scan::Found;
use crate::serve::asked::Named;
use crate::serve::problem::{Denied, Problem};
use crate::serve::room::place;
use crate::serve::streamed::{Part, streamed};
use crate::store::regular;
use crate::store::stamp::Stamp;

/// The type of HDF5 files.
pub(super) const KIND: &str = "application/x-hdf5";
/// Bytes that are read at a time.
const PIECE: u64 = 1 << 16;

/// Why a file is not sent.
#[derive(utoipa::IntoResponses)]
#[allow(dead_code, reason = "only described")]
enum NoFile {
    /// There is no map of this id
    #[response(status = 404, content_type = "application/problem+json")]
    None(Problem),
    /// The map is not complete, or has just been replaced
    #[response(status = 409, content_type = "application/problem+json")]
    NotComplete(Problem),
    /// The range lies behind its end
    #[response(status = 416, content_type = "application/problem+json")]
    Range(Problem),
}

/// The file of a complete map
///
/// With one `Range` of bytes, a part of it. Its `ETag` changes when the map is replaced.
#[utoipa::path(
    get,
    path = "/api/v1/maps/{id}/file",
    tag = "maps",
    params(("id" = String, Path, description = "as the list has it")),
    responses(
        (status = 200, description = "The file", body = crate::serve::openapi::Encoded,
            content_type = "application/x-hdf5"),
        (status = 206, description = "A part", body = crate::serve::openapi::Encoded,
            content_type = "application/x-hdf5"),
        Denied,
        NoFile,
    ),
)]
pub(super) async fn file(
    State(maps): State<Arc<Maps>>,
    Named(id): Named,
    method: Method,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let (found, complete) = maps.list.complete(&id).await.ok_or_else(no_map)?;
    let complete = complete.ok_or_else(|| {
        let detail = "the map has not been looked at yet";
        Problem::of(StatusCode::SERVICE_UNAVAILABLE, detail)
    })?;
    if !complete {
        let detail = "the map is not complete, or cannot be read";
        return Err(Problem::of(StatusCode::CONFLICT, detail));
    }
    let place = place(&maps.sending, "too many files are sent already").await?;
    let (opened, stamp) = open(&found).await?;
    let (length, tag) = (stamp.length, tag(&stamp));
    let asked = match applies(&headers, &tag) {
        true => range(&headers, length),
        false => Asked::Whole,
    };
    let (status, range) = match asked {
        Asked::Whole => (StatusCode::OK, 0..length),
        Asked::Part(range) => (StatusCode::PARTIAL_CONTENT, range),
        Asked::Behind => return Ok(behind(length)),
    };
    let body = Sent {
        file: opened,
        range: range.clone(),
        _place: place,
    };
    let mut response = match method == Method::HEAD {
        true => status.into_response(),
        false => (status, streamed(body, Sent::next)).into_response(),
    };
    let told = response.headers_mut();
    told.insert(CONTENT_TYPE, HeaderValue::from_static(KIND));
    told.insert(ACCEPT_RANGES, HeaderValue::from_static("bytes"));
    told.insert(CONTENT_LENGTH, (range.end - range.start).into());
    told.extend(HeaderValue::from_str(&tag).map(|tag| (ETAG, tag)));
    told.extend(
        HeaderValue::from_str(&saved_as(&found.path)).map(|as_| (CONTENT_DISPOSITION, as_)),
    );
    if status == StatusCode::PARTIAL_CONTENT {
        let part = format!("bytes {}-{}/{length}", range.start, range.end - 1);
        told.extend(HeaderValue::from_str(&part).map(|part| (CONTENT_RANGE, part)));
    }
    Ok(response)
}

/// Opens the file of a map, if it is still the one that was found.
async fn open(found: &Found) -> Result<(File, Stamp), Problem> {
    let (path, mark) = (found.path.clone(), found.mark.file);
    let opened = tokio::task::spawn_blocking(move || {
        let file = regular::open(&path).ok()?;
        let stamp = Stamp::told(&file.metadata().ok()?);
        (Some(stamp) == mark).then_some((file, stamp))
    });
    opened.await.ok().flatten().ok_or_else(|| {
        let detail = "the map has just been replaced, or has gone";
        Problem::of(StatusCode::CONFLICT, detail)
    })
}

/// The tag of a file in this state.
fn tag(stamp: &Stamp) -> String {
    let since = stamp.modified.unwrap_or(SystemTime::UNIX_EPOCH);
    let since = since.duration_since(SystemTime::UNIX_EPOCH);
    let nanoseconds = since.unwrap_or_default().as_nanos();
    format!("\"{:x}-{nanoseconds:x}\"", stamp.length)
}

/// The name under which a browser saves a file.
fn saved_as(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "._-".contains(letter);
    let name: String = name
        .chars()
        .map(|letter| if plain(letter) { letter } else { '_' })
        .collect();
    format!("attachment; filename=\"{name}\"")
}

/// What a request asks for.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Asked {
    Whole,
    Part(Range<u64>),
    Behind,
}

/// Whether a range applies to a file of this tag.
fn applies(headers: &HeaderMap, tag: &str) -> bool {
    headers.get(IF_RANGE).is_none_or(|of| of == tag)
}

/// The range that a request asks for. Several, and what is no range, ask for the whole file.
fn range(headers: &HeaderMap, length: u64) -> Asked {
    let mut said = headers.get_all(RANGE).iter();
    let said = said.next().filter(|_| said.next().is_none());
    let said = said.and_then(|said| said.to_str().ok()).unwrap_or_default();
    let ends = said
        .trim()
        .strip_prefix("bytes=")
        .and_then(|range| range.split_once('-'));
    let Some((first, last)) = ends else {
        return Asked::Whole;
    };
    let (first, last) = (first.trim(), last.trim());
    let number = |digits: &str| match digits.bytes().all(|byte| byte.is_ascii_digit()) {
        // More digits than a number has lie behind every end.
        true => Some(digits.parse().unwrap_or(u64::MAX)),
        false => None,
    };
    let (Some(from), Some(to)) = (number(first), number(last)) else {
        return Asked::Whole;
    };
    let range = match (first.is_empty(), last.is_empty()) {
        (true, true) => return Asked::Whole,
        (true, false) => length.saturating_sub(to)..length,
        (false, true) => from..length,
        (false, false) if to < from => return Asked::Whole,
        (false, false) => from..to.saturating_add(1).min(length),
    };
    match range.is_empty() {
        true => Asked::Behind,
        false => Asked::Part(range),
    }
}

/// The refusal of a range behind the end.
fn behind(length: u64) -> Response {
    let detail = format!("the file has {length} bytes");
    let mut response = Problem::of(StatusCode::RANGE_NOT_SATISFIABLE, detail).into_response();
    let whole = HeaderValue::from_str(&format!("bytes */{length}"));
    response
        .headers_mut()
        .extend(whole.map(|whole| (CONTENT_RANGE, whole)));
    response
}

/// A file while it is sent.
struct Sent {
    file: File,
    range: Range<u64>,
    _place: OwnedSemaphorePermit,
}

impl Sent {
    /// The next bytes.
    async fn next(mut self) -> Part<Self> {
        if self.range.is_empty() {
            return Ok(None);
        }
        let read = tokio::task::spawn_blocking(move || {
            let count = PIECE.min(self.range.end - self.range.start);
            let mut bytes = vec![0; count as usize];
            self.file.seek(SeekFrom::Start(self.range.start))?;
            self.file.read_exact(&mut bytes)?;
            self.range.start += count;
            Ok(Some((Bytes::from(bytes), self)))
        });
        read.await
            .unwrap_or_else(|_| Err(Error::from(ErrorKind::Other)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_those_of_the_standard() {
        let asked = |said: &[&str], length| {
            let mut headers = HeaderMap::new();
            for said in said {
                headers.append(RANGE, HeaderValue::from_str(said).unwrap());
            }
            range(&headers, length)
        };
        for (said, expected) in [
            ("bytes=0-0", Asked::Part(0..1)),
            ("bytes=2-5", Asked::Part(2..6)),
            ("bytes=2-", Asked::Part(2..10)),
            ("bytes=-3", Asked::Part(7..10)),
            ("bytes=-30", Asked::Part(0..10)),
            ("bytes=9-99999999999999999999999", Asked::Part(9..10)),
            ("bytes=10-", Asked::Behind),
            ("bytes=99999999999999999999999-", Asked::Behind),
            ("bytes=-0", Asked::Behind),
            ("bytes=5-2", Asked::Whole),
            ("bytes=-", Asked::Whole),
            ("bytes=a-b", Asked::Whole),
            ("bytes=+1-2", Asked::Whole),
            ("bytes=0-1,4-5", Asked::Whole),
            ("lines=0-1", Asked::Whole),
            ("", Asked::Whole),
        ] {
            assert_eq!(asked(&[said], 10), expected, "{said}");
        }
        assert_eq!(asked(&["bytes=0-1", "bytes=4-5"], 10), Asked::Whole);
        assert_eq!(asked(&["bytes=0-"], 0), Asked::Behind);
        assert_eq!(asked(&[], 10), Asked::Whole);
    }
}
