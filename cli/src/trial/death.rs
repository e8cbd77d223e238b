//! How a child died, and whether somebody outside did it.

use std::process::ExitStatus;

/// The cause in words.
#[cfg(unix)]
pub fn cause(status: &ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    let name = |signal| match signal {
        libc::SIGABRT => "SIGABRT".to_owned(),
        libc::SIGBUS => "SIGBUS".to_owned(),
        libc::SIGFPE => "SIGFPE".to_owned(),
        libc::SIGILL => "SIGILL".to_owned(),
        libc::SIGSEGV => "SIGSEGV".to_owned(),
        libc::SIGTRAP => "SIGTRAP".to_owned(),
        other => format!("signal {other}"),
    };
    match status.signal() {
        Some(signal) => name(signal),
        None => "it calls exit".to_owned(),
    }
}

#[cfg(not(unix))]
pub fn cause(status: &ExitStatus) -> String {
    status.to_string()
}

/// Whether the signal is one that people and systems send, and not one of a fault: the user, a
/// shutdown, or a system without memory.
#[cfg(unix)]
pub fn is_from_outside(status: &ExitStatus) -> bool {
    use std::os::unix::process::ExitStatusExt;
    let outside = [libc::SIGKILL, libc::SIGINT, libc::SIGTERM, libc::SIGHUP];
    status
        .signal()
        .is_some_and(|signal| outside.contains(&signal))
}

#[cfg(not(unix))]
pub fn is_from_outside(_: &ExitStatus) -> bool {
    false
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::process::ExitStatusExt;

    use super::*;

    #[test]
    fn a_fault_is_the_librarys_and_a_signal_of_people_is_not() {
        for (signal, name) in [(libc::SIGSEGV, "SIGSEGV"), (libc::SIGTRAP, "SIGTRAP")] {
            let status = ExitStatus::from_raw(signal);
            assert_eq!(cause(&status), name);
            assert!(!is_from_outside(&status));
        }
        for signal in [libc::SIGKILL, libc::SIGINT, libc::SIGTERM, libc::SIGHUP] {
            assert!(is_from_outside(&ExitStatus::from_raw(signal)), "{signal}");
        }
        assert_eq!(cause(&ExitStatus::from_raw(7 << 8)), "it calls exit");
    }
}
