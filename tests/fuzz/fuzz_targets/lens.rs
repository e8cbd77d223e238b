#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| turnpath_fuzz::lens::read(bytes));
