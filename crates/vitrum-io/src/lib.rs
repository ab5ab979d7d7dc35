//! placeholder
pub mod diagnostic;
pub mod obj;
pub mod scene;
