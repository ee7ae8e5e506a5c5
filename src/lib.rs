pub mod linear;
pub mod model;
pub mod report;
pub mod store;
pub mod sweep;
