//! How an author's object is held on its own side of the boundary.

use std::mem::ManuallyDrop;
use std::ops::{Deref, DerefMut};

use crate::guard::guarded;

/// A box; a panic when its content is dropped ends here instead of ending the program.
pub struct Contained<T: ?Sized>(ManuallyDrop<Box<T>>);

impl<T: ?Sized> Contained<T> {
    /// Holds it.
    pub fn new(held: Box<T>) -> Self {
        Self(ManuallyDrop::new(held))
    }
}

impl<T: ?Sized> Deref for Contained<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: ?Sized> DerefMut for Contained<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

impl<T: ?Sized> Drop for Contained<T> {
    fn drop(&mut self) {
        // SAFETY: taken here only, and nobody asks for it after its holder's drop.
        let held = unsafe { ManuallyDrop::take(&mut self.0) };
        // There is nobody to tell: whoever drops a strategy is done with it.
        let _ = guarded(|| {
            drop(held);
            Ok(())
        });
    }
}
