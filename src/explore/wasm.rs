//! Requests and answers of a WebAssembly module without imports, for a page without a server.
//!
//! ```text
//! at = allocate(bytes of a name and of the text after it); write both there
//! at = answer(bytes of the name); read length() bytes there, of the status status()
//! release()
//! ```
//!
//! There is one request at a time, and no way to stop it: to stop waiting, end the module.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::problem::{Problem, Why};
use super::{Limits, Request};

/// The status of successful answers.
const FOUND: u32 = 200;

thread_local! {
    static ASKED: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWERED: RefCell<(u32, Vec<u8>)> = const { RefCell::new((0, Vec::new())) };
}

/// Allocates a request of `length` bytes and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(length: usize) -> *mut u8 {
    ASKED.with_borrow_mut(|asked| {
        *asked = vec![0; length];
        asked.as_mut_ptr()
    })
}

/// Answers the request, whose name has `name` bytes. Returns the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer(name: usize) -> *const u8 {
    let found = ASKED.with_borrow(|asked| answered(asked, name));
    let told = match found {
        Ok(bytes) => (FOUND, bytes),
        Err(problem) => {
            let text = serde_json::to_vec(&problem).unwrap_or_default();
            (problem.status.into(), text)
        }
    };
    ANSWERED.with_borrow_mut(|answered| {
        *answered = told;
        answered.1.as_ptr()
    })
}

/// The number of bytes of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn length() -> usize {
    ANSWERED.with_borrow(|answered| answered.1.len())
}

/// The status of the answer: 200, or that of a problem.
#[unsafe(no_mangle)]
pub extern "C" fn status() -> u32 {
    ANSWERED.with_borrow(|answered| answered.0)
}

/// Frees the memory of the request and of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn release() {
    ASKED.take();
    ANSWERED.take();
}

fn answered(asked: &[u8], name: usize) -> Result<Vec<u8>, Problem> {
    let refused = |detail| Problem::new(Why::Unprocessable, detail);
    let text = std::str::from_utf8(asked).map_err(|_| refused("the text is not UTF-8"))?;
    let parts = text.split_at_checked(name);
    let (name, text) = parts.ok_or_else(|| refused("the name has no end"))?;
    let request = Request::from_name(name).ok_or_else(|| refused("no such request"))?;
    let never = Arc::new(AtomicBool::new(false));
    super::answer(request, text, &Limits::default(), &never)
}
