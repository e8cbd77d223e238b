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

    /// Moves the argument to its lender.
    fn lender(self) -> Result<Self::Lender>;

    /// Lends the argument.
    fn lend(lender: &mut Self::Lender) -> Self::Wire<'_>;

    /// Reports the length of each batch.
    fn count(_: &Self::Lender, _: &mut Lengths) {}

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
            return Err(StrategyError::failed(
                "the slices of a call differ in length",
            ));
        }
        Ok(())
    }
}

/// Implements [`Crossing`] for arguments that are their own lenders.
macro_rules! crossing {
    ($([$($generics:tt)*] $from:ty => $to:ty, |$lender:ident| $lend:expr
        $(, |$counted:ident, $lengths:ident| $count:expr)?;)*) => {$(
        impl<$($generics)*> $crate::abi::loan::Crossing for $from {
            type Wire<'w> = $to;
            type Lender = Self;

            fn lender(self) -> turnpath_core::Result<Self> {
                Ok(self)
            }

            fn lend($lender: &mut Self) -> Self::Wire<'_> {
                $lend
            }

            $(fn count($counted: &Self, $lengths: &mut $crate::abi::loan::Lengths) {
                $count
            })?
        }
    )*};
}
pub(crate) use crossing;

crossing! {
    ['a, T: 'static] &'a [T] => RSlice<'w, T>, |slice| RSlice::from_slice(slice),
        |slice, lengths| lengths.add(slice.len());
    ['a, T: 'static] &'a mut [T] => RSliceMut<'w, T>, |slice| RSliceMut::from_mut_slice(slice),
        |slice, lengths| lengths.add(slice.len());
    ['a, T: 'static] RSlice<'a, T> => &'w [T], |slice| slice.as_slice();
    ['a, T: 'static] RSliceMut<'a, T> => &'w mut [T], |slice| slice.as_mut_slice();
    [] f64 => f64, |number| *number;
}

/// A list that the other side changes in place, such as the state of a sequential strategy.
pub struct ListLender<'a> {
    home: &'a mut Vec<f64>,
    away: RVec<f64>,
}

impl<'a> Crossing for &'a mut Vec<f64> {
    type Wire<'w> = &'w mut RVec<f64>;
    type Lender = ListLender<'a>;

    fn lender(self) -> Result<ListLender<'a>> {
        let away = RVec::from(std::mem::take(self));
        Ok(ListLender { home: self, away })
    }

    fn lend<'l>(lender: &'l mut ListLender<'a>) -> &'l mut RVec<f64> {
        &mut lender.away
    }

    fn settle(lender: ListLender<'a>) -> Result<()> {
        *lender.home = lender.away.into_vec();
        Ok(())
    }
}

/// The same list on the other side.
pub struct ListReader<'a> {
    home: &'a mut RVec<f64>,
    away: Vec<f64>,
}

impl<'a> Crossing for &'a mut RVec<f64> {
    type Wire<'w> = &'w mut Vec<f64>;
    type Lender = ListReader<'a>;

    fn lender(self) -> Result<ListReader<'a>> {
        let away = self.to_vec();
        Ok(ListReader { home: self, away })
    }

    fn lend<'l>(lender: &'l mut ListReader<'a>) -> &'l mut Vec<f64> {
        &mut lender.away
    }

    fn settle(lender: ListReader<'a>) -> Result<()> {
        *lender.home = lender.away.into();
        Ok(())
    }
}

/// Declares the form in which a struct of output slices crosses, and carries it across in both
/// directions.
macro_rules! columns {
    ($($core:ident => $abi:ident { $($column:ident),+ } of $number:ty;)*) => {$(
        #[repr(C)]
        #[derive(abi_stable::StableAbi)]
        pub struct $abi<'a> {
            $($column: abi_stable::std_types::RSliceMut<'a, $number>,)+
        }

        $crate::abi::loan::crossing! {
            ['a] turnpath_core::$core<'a> => $abi<'w>,
                |out| $abi { $($column: (&mut *out.$column).into(),)+ },
                |out, lengths| { $(lengths.add(out.$column.len());)+ };
            ['a] $abi<'a> => turnpath_core::$core<'w>,
                |out| turnpath_core::$core { $($column: out.$column.as_mut_slice(),)+ };
        }
    )*};
}
pub(crate) use columns;
