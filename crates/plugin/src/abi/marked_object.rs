//! An object of the other side whose calls are marked.

use std::mem::ManuallyDrop;
use std::ops::{Deref, DerefMut};

use crate::calls::{Callee, Mark};

/// An object, and the strategy that it belongs to. Its drop is a call too.
pub struct MarkedObject<T> {
    object: ManuallyDrop<T>,
    callee: Option<&'static Callee>,
}

impl<T> MarkedObject<T> {
    /// An object that is lent: what lends it marks its own calls.
    pub fn lent(object: T) -> Self {
        Self {
            object: ManuallyDrop::new(object),
            callee: None,
        }
    }

    /// Gives the object to the strategy whose call is in progress: that call made it.
    pub fn belongs_to_the_call(&mut self) {
        self.callee = crate::calls::on_this_thread();
    }

    /// Marks a call of the object.
    pub fn enter(&self) -> Option<Mark> {
        self.callee.map(Callee::enter)
    }
}

impl<T> Deref for MarkedObject<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.object
    }
}

impl<T> DerefMut for MarkedObject<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.object
    }
}

impl<T> Drop for MarkedObject<T> {
    fn drop(&mut self) {
        let _mark = self.enter();
        // SAFETY: nothing else drops the object, and nobody can use it after this.
        unsafe { ManuallyDrop::drop(&mut self.object) };
    }
}
