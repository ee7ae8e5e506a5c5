//! What needs other programs than slipmap: readers of its maps in other languages, and Node with
//! Rust for WebAssembly for the page without a server.

mod programs;
mod static_page;
