//! The gallery shows what it says: every scene renders, and what the pictures 1 and 3 to 7 claim is checked against a
//! closed form or against another picture.

mod bubble;
mod compound;
mod depth;
mod matched;
mod page;
mod prism;
mod snell_window;
mod stage;
#[path = "../../examples/tree_growth/table.rs"]
mod table;
mod tree_growth;
