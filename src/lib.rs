pub mod linear;
pub mod model;
