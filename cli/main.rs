//! The `kirk` binary.
fn main() {}
