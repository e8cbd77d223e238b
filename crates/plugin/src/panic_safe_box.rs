//! The box that holds an author's object on the author's side of the boundary.
#![allow(unsafe_code)] // the box takes its content out in its own drop

use std::mem::ManuallyDrop;
use std::ops::{Deref, DerefMut};

use crate::guard::guarded;

/// A box that catches a panic from the drop of its content, so that the panic does not end the
/// program.
pub struct PanicSafeBox<T: ?Sized>(ManuallyDrop<Box<T>>);

impl<T: ?Sized> PanicSafeBox<T> {
    /// Puts an object into the box.
    pub fn new(object: Box<T>) -> Self {
        Self(ManuallyDrop::new(object))
    }
}

impl<T: ?Sized> Deref for PanicSafeBox<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: ?Sized> DerefMut for PanicSafeBox<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

impl<T: ?Sized> Drop for PanicSafeBox<T> {
    fn drop(&mut self) {
        // SAFETY: this is the only place that takes the object, and nobody can use the box after
        // its drop.
        let object = unsafe { ManuallyDrop::take(&mut self.0) };
        // The error goes nowhere: whoever drops a strategy no longer needs its answers.
        let _ = guarded(|| {
            drop(object);
            Ok(())
        });
    }
}
