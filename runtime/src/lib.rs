//! Executes a proven network.
