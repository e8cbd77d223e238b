//! Arguments on their way across: what stays with the caller, and what the other side gets.
//!
//! One trait carries an argument across and unpacks it on arrival. A [`Crossing`] value gives a
//! lender, which holds whatever must live during the call, and the lender lends the other form. A
//! slice of the core, for example, lends an `RSlice`, and an `RSlice` lends a slice.

use abi_stable::std_types::{RSlice, RSliceMut, RVec};
use turnpath_core::{Result, StrategyError};

/// An argument that crosses, in the form of one side.
pub trait Crossing: Sized {
    /// The form of the other side.
    type Wire<'w>;
    /// What holds the argument during the call.
    type Lender;

    /// Moves the argument to its lender, and reports the length of each batch.
    fn lender(self, lengths: &mut Lengths) -> Result<Self::Lender>;

    /// Lends the argument.
    fn lend(lender: &mut Self::Lender) -> Self::Wire<'_>;

    /// Brings back what the other side wrote.
    fn settle(_: Self::Lender) -> Result<()> {
        Ok(())
    }
}

/// The form of an argument `T` of the core between both sides.
pub type Wire<'w, T> = <T as Crossing>::Wire<'w>;

/// The lengths of a call's batches. A plugin may rely on equal lengths, so the host must check them.
#[derive(Debug, Default)]
pub struct Lengths {
    first: Option<usize>,
    differ: bool,
}

impl Lengths {
    /// Adds the length of one batch.
    pub fn add(&mut self, length: usize) {
        self.differ |= *self.first.get_or_insert(length) != length;
    }

    /// Checks that all lengths are the same.
    pub fn check(&self) -> Result<()> {
        if self.differ {
            let message = "the slices of a call differ in length";
            return Err(StrategyError::failed(message));
        }
        Ok(())
    }
}

/// Implements [`Crossing`] from one form to the other: what the lender is and what it lends.
macro_rules! crossing {
    ($(
        [$($life:tt)*] $from:ty => $to:ty,
        $lender:ty: |$given:ident $(, $lengths:ident)?| $new:expr, |$it:ident| $lend:expr;
    )*) => {$(
        impl<$($life)*> $crate::abi::loan::Crossing for $from {
            type Wire<'w> = $to;
            type Lender = $lender;

            fn lender(
                self,
                _lengths: &mut $crate::abi::loan::Lengths,
            ) -> turnpath_core::Result<$lender> {
                let $given = self;
                $(let $lengths = _lengths;)?
                Ok($new)
            }

            fn lend<'w>($it: &'w mut $lender) -> Self::Wire<'w> {
                $lend
            }
        }
    )*};
}

crossing! {
    ['a, T: 'static] &'a [T] => RSlice<'w, T>, &'a [T]:
        |slice, lengths| { lengths.add(slice.len()); slice }, |slice| RSlice::from_slice(slice);
    ['a, T: 'static] &'a mut [T] => RSliceMut<'w, T>, &'a mut [T]:
        |slice, lengths| { lengths.add(slice.len()); slice }, |slice| RSliceMut::from_mut_slice(slice);
    ['a, T: 'static] RSlice<'a, T> => &'w [T], RSlice<'a, T>: |slice| slice,
        |slice| slice.as_slice();
    ['a, T: 'static] RSliceMut<'a, T> => &'w mut [T], RSliceMut<'a, T>: |slice| slice,
        |slice| slice.as_mut_slice();
    [] f64 => f64, f64: |number| number, |number| *number;
    [] usize => usize, usize: |number| number, |number| *number;
}

/// Declares the form of a struct of the core, field by field, and lets both forms cross.
macro_rules! composite {
    ($($core:ident => $abi:ident { $($field:ident: $type:ty),+ $(,)? })*) => {$(
        #[repr(C)]
        #[derive(abi_stable::StableAbi)]
        pub struct $abi<'a> {
            $($field: $crate::abi::loan::Wire<'a, $type>,)+
        }

        $crate::abi::loan::composite!(@from $core to $abi with $($field: $type),+);
        $crate::abi::loan::composite!(
            @from $abi to $core with $($field: $crate::abi::loan::Wire<'a, $type>),+
        );
    )*};
    (@from $from:ident to $to:ident with $($field:ident: $type:ty),+) => {
        $crate::abi::loan::crossing! {
            ['a] $from<'a> => $to<'w>,
            ($(<$type as $crate::abi::loan::Crossing>::Lender,)+):
                |from, lengths| (
                    $($crate::abi::loan::Crossing::lender(from.$field, lengths)?,)+
                ),
                |lender| {
                    let ($($field,)+) = lender;
                    $to { $($field: <$type as $crate::abi::loan::Crossing>::lend($field),)+ }
                };
        }
    };
}

/// Lets lists cross that the other side writes to: what it gets, and what it gives back.
macro_rules! lists {
    ($(
        $home:ty => $away:ty: |$list:ident| $get:expr, |$place:ident, $back:ident| $settle:expr;
    )*) => {$(
        impl<'a> $crate::abi::loan::Crossing for &'a mut $home {
            type Wire<'w> = &'w mut $away;
            type Lender = (&'a mut $home, $away);

            fn lender(
                self,
                _: &mut $crate::abi::loan::Lengths,
            ) -> turnpath_core::Result<Self::Lender> {
                let $list = &mut *self;
                let away = $get;
                Ok((self, away))
            }

            fn lend(lender: &mut Self::Lender) -> &mut $away {
                &mut lender.1
            }

            fn settle(($place, $back): Self::Lender) -> turnpath_core::Result<()> {
                $settle;
                Ok(())
            }
        }
    )*};
}

lists! {
    Vec<f64> => RVec<f64>: |list| RVec::from(std::mem::take(list)),
        |list, changed| *list = changed.into_vec();
    RVec<f64> => Vec<f64>: |list| list.to_vec(),
        |list, changed| *list = changed.into();
}

pub(crate) use {composite, crossing, lists};
