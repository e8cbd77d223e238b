//! What `turnpath-maps` reads: files made by a script apart, and files that are wrong.

mod against_files;
mod any_bytes;
mod malformed;
