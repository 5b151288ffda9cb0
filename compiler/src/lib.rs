//! RMPL source to a delay STNU, or diagnostics.
