//! The calls into strategies that are in progress: who is to blame when one ends the process, or
//! does not end at all.
//!
//! The host marks each call that it makes. A mark is a few stores and no system call, and nothing
//! here allocates after a thread's first call, so that a signal handler may ask
//! [`on_this_thread`]. A loaded library has its own copy of this module, which stays empty.

use std::cell::Cell;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicU32, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Calls inside of calls that are listed: a feed asks the locus, which asks the compensator, which
/// asks the surface. A call that lies deeper counts as its caller.
const DEEPEST: usize = 16;

/// What the host calls: a strategy of a plugin, or the code that a library runs when it is loaded.
#[derive(Debug)]
pub struct Callee {
    text: String,
    loaded: bool,
    /// Its number in [`CALLEES`].
    number: u32,
}

/// All that was ever called. It grows with the strategies of all catalogues, each once.
static CALLEES: Mutex<Vec<&'static Callee>> = Mutex::new(Vec::new());
/// The calls of all threads that ever called. Threads that ended leave theirs to new ones.
static THREADS: Mutex<Vec<&'static Thread>> = Mutex::new(Vec::new());

thread_local! {
    /// What this thread calls. It has no destructor, so a signal handler may read it at any time.
    static CURRENT: Cell<Option<&'static Callee>> = const { Cell::new(None) };
    static THREAD: Cell<Option<&'static Thread>> = const { Cell::new(None) };
    static RETURN: Return = const { Return };
}

/// The calls that a thread is in, for the eyes of another thread.
#[derive(Debug, Default)]
struct Thread {
    in_use: AtomicUsize,
    depth: AtomicUsize,
    /// How many calls this thread has made.
    made: AtomicU64,
    calls: [Entry; DEEPEST],
}

#[derive(Debug, Default)]
struct Entry {
    callee: AtomicU32,
    number: AtomicU64,
}

/// A call in progress on some thread. Two looks at one call give equal values.
#[derive(Debug, Clone, Copy)]
pub struct Call {
    /// What is called.
    pub callee: &'static Callee,
    /// The thread, counted from 0.
    pub thread: usize,
    /// How many calls of the thread this call lies in.
    pub depth: usize,
    /// The number of the call on its thread.
    pub number: u64,
}

impl Callee {
    /// The callee of this description, such as "the sampler `x` of lab 0.1.0 (built in)"; `loaded`
    /// says that its code comes from a library, or that the program brought it as a value. The
    /// description must show no control characters.
    pub fn new(text: String, loaded: bool) -> &'static Self {
        let mut callees = lock(&CALLEES);
        let same = |known: &&&Self| known.text == text && known.loaded == loaded;
        if let Some(known) = callees.iter().find(same) {
            return known;
        }
        let number = u32::try_from(callees.len()).unwrap_or(u32::MAX);
        let callee: &'static Self = Box::leak(Box::new(Self {
            text,
            loaded,
            number,
        }));
        callees.push(callee);
        callee
    }

    /// The description.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether its code comes from a library, or from the program as a value.
    pub fn is_loaded(&self) -> bool {
        self.loaded
    }

    /// Marks a call on this thread until the mark is dropped.
    pub fn enter(&'static self) -> Mark {
        let thread = THREAD.get().unwrap_or_else(join);
        let depth = thread.depth.load(Ordering::Relaxed);
        let number = thread.made.load(Ordering::Relaxed) + 1;
        thread.made.store(number, Ordering::Relaxed);
        if let Some(entry) = thread.calls.get(depth) {
            entry.callee.store(self.number, Ordering::Relaxed);
            entry.number.store(number, Ordering::Relaxed);
        }
        thread.depth.store(depth + 1, Ordering::Release);
        Mark {
            thread,
            before: CURRENT.replace(Some(self)),
            stays_here: PhantomData,
        }
    }
}

/// A call in progress on this thread.
#[derive(Debug)]
#[must_use = "the mark ends when it is dropped"]
pub struct Mark {
    thread: &'static Thread,
    before: Option<&'static Callee>,
    /// A mark cannot go to another thread.
    stays_here: PhantomData<*const ()>,
}

impl Drop for Mark {
    fn drop(&mut self) {
        CURRENT.set(self.before);
        // Only this thread writes the depth, so a load and a store suffice.
        let depth = self.thread.depth.load(Ordering::Relaxed);
        self.thread.depth.store(depth - 1, Ordering::Release);
    }
}

/// What this thread calls, the innermost call. A signal handler may ask this.
pub fn on_this_thread() -> Option<&'static Callee> {
    CURRENT.get()
}

/// The calls in progress on all threads.
pub fn on_all_threads() -> Vec<Call> {
    let callees = lock(&CALLEES).clone();
    let threads = lock(&THREADS).clone();
    let mut calls = Vec::new();
    for (number, thread) in threads.iter().enumerate() {
        let depth = thread.depth.load(Ordering::Acquire);
        for (depth, entry) in thread.calls.iter().take(depth).enumerate() {
            let callee = entry.callee.load(Ordering::Relaxed) as usize;
            calls.extend(callees.get(callee).map(|callee| Call {
                callee,
                thread: number,
                depth,
                number: entry.number.load(Ordering::Relaxed),
            }));
        }
    }
    calls
}

/// Calls `found` with each callee of a loaded library that any thread is in; one that several threads
/// are in may come several times. A signal handler may ask this: it waits for nothing and allocates
/// nothing.
pub fn each_of_a_library(mut found: impl FnMut(&'static Callee)) {
    let (Ok(callees), Ok(threads)) = (CALLEES.try_lock(), THREADS.try_lock()) else {
        return;
    };
    for thread in threads.iter() {
        let depth = thread.depth.load(Ordering::Acquire);
        for entry in thread.calls.iter().take(depth) {
            let number = entry.callee.load(Ordering::Relaxed) as usize;
            let callee = callees.get(number).copied();
            callee
                .filter(|callee| callee.loaded)
                .into_iter()
                .for_each(&mut found);
        }
    }
}

/// The list of this thread's calls, on its first one.
#[cold]
fn join() -> &'static Thread {
    let mut threads = lock(&THREADS);
    let free = threads
        .iter()
        .find(|thread| thread.in_use.load(Ordering::Acquire) == 0);
    let thread = match free {
        Some(thread) => *thread,
        None => {
            let thread: &'static Thread = Box::leak(Box::default());
            threads.push(thread);
            thread
        }
    };
    thread.in_use.store(1, Ordering::Release);
    THREAD.set(Some(thread));
    // A thread that calls while it ends keeps its list: there are few of these.
    let _ = RETURN.try_with(|_| ());
    thread
}

/// Leaves a thread's list to another thread when the thread ends.
struct Return;

impl Drop for Return {
    fn drop(&mut self) {
        // `exit` in a plugin ends the thread within a call, and somebody will ask for it.
        let ended = |thread: &&Thread| thread.depth.load(Ordering::Relaxed) == 0;
        if let Some(thread) = THREAD.get().filter(ended) {
            THREAD.set(None);
            thread.in_use.store(0, Ordering::Release);
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // Nothing panics while it holds one of these locks, and each value is whole at any time.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What this thread is in, as another thread sees it, outermost first.
    fn seen(texts: &[&str]) -> Vec<(String, usize)> {
        let texts = texts.to_vec();
        std::thread::scope(|scope| {
            let look = scope.spawn(move || {
                let mut calls = on_all_threads();
                calls.retain(|call| texts.contains(&call.callee.text()));
                calls.sort_by_key(|call| call.depth);
                calls
                    .iter()
                    .map(|call| (call.callee.text().to_owned(), call.depth))
                    .collect()
            });
            look.join().unwrap()
        })
    }

    #[test]
    fn the_innermost_call_is_known_and_the_outer_one_comes_back() {
        let (feed, surface) = (
            Callee::new("a feed".into(), false),
            Callee::new("a surface".into(), true),
        );
        let text = || on_this_thread().map(Callee::text);
        let both = ["a feed", "a surface"];
        assert_eq!(text(), None);
        let outer = feed.enter();
        assert_eq!(text(), Some("a feed"));
        let inner = surface.enter();
        assert_eq!(text(), Some("a surface"));
        assert_eq!(
            seen(&both),
            [("a feed".to_owned(), 0), ("a surface".to_owned(), 1)]
        );
        drop(inner);
        assert_eq!(text(), Some("a feed"));
        drop(outer);
        assert_eq!((text(), seen(&both)), (None, Vec::new()));
    }

    #[test]
    fn each_call_has_its_own_number() {
        let callee = Callee::new("asked often".into(), false);
        let number = || {
            let _mark = callee.enter();
            let mut calls = on_all_threads().into_iter();
            calls
                .find(|call| std::ptr::eq(call.callee, callee))
                .map(|call| call.number)
        };
        let (first, second) = (number(), number());
        assert!(first.is_some() && first != second);
    }

    #[test]
    fn calls_deeper_than_the_list_are_those_of_this_thread_alone() {
        let callee = Callee::new("deep".into(), false);
        let marks: Vec<Mark> = (0..DEEPEST + 3).map(|_| callee.enter()).collect();
        assert_eq!(seen(&["deep"]).len(), DEEPEST);
        for mark in marks.into_iter().rev() {
            drop(mark);
        }
        assert!(on_this_thread().is_none() && seen(&["deep"]).is_empty());
    }

    #[test]
    fn calls_into_libraries_are_found_on_all_threads_and_at_all_depths() {
        let callee = |text: &str, loaded| Callee::new(text.into(), loaded);
        let outer = callee("a sampler of a library", true);
        let inner = callee("a built-in surface below it", false);
        let other = callee("a feed of another library", true);
        let of_libraries = || {
            let mut texts = Vec::new();
            each_of_a_library(|callee| texts.push(callee.text()));
            texts.retain(|text| [outer.text(), inner.text(), other.text()].contains(text));
            texts.sort_unstable();
            texts
        };
        let marks = (outer.enter(), inner.enter());
        std::thread::scope(|scope| {
            let look = scope.spawn(|| {
                let _mark = other.enter();
                of_libraries()
            });
            assert_eq!(look.join().unwrap(), [other.text(), outer.text()]);
        });
        drop(marks);
        assert!(of_libraries().is_empty());
    }

    #[test]
    fn one_description_is_one_callee() {
        let callee = |loaded| Callee::new("twice".into(), loaded);
        assert!(std::ptr::eq(callee(true), callee(true)));
        assert!(!std::ptr::eq(callee(true), callee(false)));
    }

    #[test]
    fn threads_that_ended_leave_their_lists_to_others() {
        let callee = Callee::new("many threads".into(), false);
        let before = lock(&THREADS).len();
        for _ in 0..100 {
            std::thread::spawn(|| drop(callee.enter())).join().unwrap();
        }
        // Other tests run beside this one, on threads of their own.
        assert!(lock(&THREADS).len() < before + 50);
    }
}
