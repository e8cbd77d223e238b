//! One declaration of a trait gives both sides of the boundary.
//!
//! ```text
//! declare! {
//!     VelocitySolver: Deref AsPtr, Send Sync => AbiVelocity, AbiVelocity_TO, IncomingVelocity<'b>;
//!     properties { dependence: Dependence, gives_exact_rates: bool = false }
//!     methods { fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()>; }
//!     later { fn warm_up(&self) -> Result<()> = Ok(()); }
//!     owned by OwnedVelocity
//! }
//! ```
//!
//! expands to the trait that crosses, to the author's side, which catches panics, and to the caller's
//! side, which checks lengths:
//!
//! ```text
//! #[sabi_trait]
//! pub trait AbiVelocity: Send + Sync {
//!     fn solve(&self, nodes: AbiNodes<'_>, out: AbiVelocities<'_>) -> Answer<()>;
//!     #[sabi(last_prefix_field)]
//!     fn properties(&self) -> Answer<RString>;
//!     fn warm_up(&self) -> Answer<()> { answer(|| Ok(())) }
//! }
//! impl<P: Deref<Target = dyn VelocitySolver>> AbiVelocity for AuthorObject<P> { … }
//! impl<P> VelocitySolver for IncomingVelocity<'_, P> { … }
//! ```
//!
//! - `properties` have no arguments and never change. They cross as one text, which the caller's
//!   side reads once. One that is added later has a default, for plugins that do not give it.
//! - `methods` are in every plugin of this number of the boundary.
//! - `later` has the methods that were added since, in the order in which they were added. A plugin
//!   without one gives the value after `=`.
//! - `fn extend[mut](&self)` takes `&mut self`, and `path[&]: Path<'_>` is `&Path<'_>` in the core.
//! - `owned by` lets boxed objects be the values of answers.
//! - The caller's side marks each call of an object that it owns, and what a call gives belongs to
//!   the same strategy.
//! - `kept { … } own { … }` adds a field to the caller's side, and methods that read it.

/// The names that the expansion of [`declare`] uses.
pub mod prelude {
    pub use std::ops::{Deref, DerefMut};

    pub use abi_stable::pointer_trait::{AsMutPtr, AsPtr};
    pub use abi_stable::sabi_trait;
    pub use abi_stable::sabi_trait::TD_Opaque;
    pub use abi_stable::std_types::{RBox, RString};
    pub use serde_json::{Value as Json, json};

    pub use super::super::loan::{Crossing, Lengths, Wire};
    pub use super::super::marked_object::MarkedObject;
    pub use super::super::reply::{Answer, Reply, Returned, answer, property, result};
    pub(crate) use super::super::text;
    pub use super::AuthorObject;
    pub(crate) use super::{by_value, declare, incoming, outgoing};
    pub use crate::panic_safe_box::PanicSafeBox;
}

/// An object of the core, wrapped for the boundary.
pub struct AuthorObject<P>(pub P);

/// See the module.
macro_rules! declare {
    (
        $core:ident: $deref:ident $as_ptr:ident, $($bound:ident)+
            => $abi:ident, $object:ident, $incoming:ident<$b:lifetime>;
        $(properties { $($property:ident: $kind:ty $(= $default:expr)?),* $(,)? })?
        methods { $(
            fn $method:ident $([$mut:tt])? (&self $(, $arg:ident $([$by:tt])?: $type:ty)* $(,)?)
                -> $reply:ty;
        )* }
        $(later { $(
            fn $later:ident(&self $(, $later_arg:ident $([$later_by:tt])?: $later_type:ty)* $(,)?)
                -> $later_reply:ty = $without:expr;
        )* })?
        $(owned by $owned:ident)?
        $(kept { $field:ident: $field_type:ty } own { $($own:tt)* })?
    ) => {
        #[sabi_trait]
        pub trait $abi: $($bound +)+ {
            $(fn $method(& $($mut)? self $(, $arg: Wire<'_, $type>)*)
                -> Answer<<$reply as Reply>::Wire>;)*

            #[sabi(last_prefix_field)]
            fn properties(&self) -> Answer<RString>;

            $($(fn $later(&self $(, $later_arg: Wire<'_, $later_type>)*)
                -> Answer<<$later_reply as Reply>::Wire>
            {
                $(let _ = $later_arg;)*
                answer(|| <$later_reply as Reply>::send($without))
            })*)?
        }

        impl<'c, P: $deref<Target = dyn $core + 'c> + $($bound +)+> $abi for AuthorObject<P> {
            outgoing! {
                $(fn $method $([$mut])? ($($arg $([$by])?: $type),*) -> $reply;)*
                $($(fn $later($($later_arg $([$later_by])?: $later_type),*) -> $later_reply;)*)?
            }

            fn properties(&self) -> Answer<RString> {
                answer(|| {
                    let properties = json!({
                        $($((stringify!($property)): self.0.$property()),*)?
                    });
                    Ok(text::write(&properties))
                })
            }
        }

        /// The object of the other side, wrapped as one of the core.
        pub struct $incoming<$b, P: AsPtr<PtrTarget = ()>> {
            object: MarkedObject<$object<$b, P>>,
            $($($property: $kind,)*)?
            $($field: $field_type,)?
        }

        impl<$b, P: AsPtr<PtrTarget = ()>> $incoming<$b, P> {
            /// Reads the object's properties and wraps it.
            pub fn new(object: $object<$b, P> $(, $field: $field_type)?) -> Result<Self> {
                let names: &[&str] = &[$($(stringify!($property)),*)?];
                // Surfaces are lent for short calls and have none.
                let _properties = if names.is_empty() {
                    Json::Null
                } else {
                    text::read(&result(object.properties())?, "list of properties")?
                };
                Ok(Self {
                    $($($property: property(
                        &_properties,
                        stringify!($property),
                        None$(.or(Some($default)))?,
                    )?,)*)?
                    $($field,)?
                    object: MarkedObject::lent(object),
                })
            }
        }

        impl<$b, P: $as_ptr<PtrTarget = ()> + Send + Sync> $core for $incoming<$b, P>
        where
            $object<$b, P>: $($bound +)+,
        {
            $($(fn $property(&self) -> $kind {
                self.$property
            })*)?

            incoming! {
                $(fn $method $([$mut])? ($($arg $([$by])?: $type),*) -> $reply;)*
                $($(fn $later($($later_arg $([$later_by])?: $later_type),*) -> $later_reply;)*)?
            }

            $($($own)*)?
        }

        $(
            /// An object that belongs to its plugin.
            pub type $owned = $object<'static, RBox<()>>;

            impl Returned for Box<dyn $core> {
                type Wire = $owned;

                fn send(self) -> $owned {
                    $object::from_value(AuthorObject(PanicSafeBox::new(self)), TD_Opaque)
                }

                fn receive(object: $owned) -> Result<Self> {
                    let mut incoming = $incoming::new(object)?;
                    incoming.object.belongs_to_the_call();
                    Ok(Box::new(incoming))
                }
            }
        )?
    };
}

/// The author's side of each method.
macro_rules! outgoing {
    ($(
        fn $method:ident $([$mut:tt])? ($($arg:ident $([$by:tt])?: $type:ty),*) -> $reply:ty;
    )*) => {$(
        fn $method(& $($mut)? self $(, $arg: Wire<'_, $type>)*)
            -> Answer<<$reply as Reply>::Wire>
        {
            answer(|| {
                let mut _lengths = Lengths::default();
                $(let mut $arg = Crossing::lender($arg, &mut _lengths)?;)*
                let reply = self.0.$method(
                    $($($by)? <Wire<'_, $type> as Crossing>::lend(&mut $arg)),*
                );
                let reply = <$reply as Reply>::send(reply)?;
                $(<Wire<'_, $type> as Crossing>::settle($arg)?;)*
                Ok(reply)
            })
        }
    )*};
}

/// The caller's side of each method.
macro_rules! incoming {
    ($(
        fn $method:ident $([$mut:tt])? ($($arg:ident $([$by:tt])?: $type:ty),*) -> $reply:ty;
    )*) => {$(
        fn $method(& $($mut)? self $(, $arg: $($by)? $type)*) -> $reply {
            let _mark = self.object.enter();
            Reply::receive((|| {
                let mut _lengths = Lengths::default();
                $(let mut $arg = Crossing::lender(by_value!($arg $($by)?), &mut _lengths)?;)*
                _lengths.check()?;
                let answer = self.object.$method($(<$type as Crossing>::lend(&mut $arg)),*);
                $(<$type as Crossing>::settle($arg)?;)*
                result(answer)
            })())
        }
    )*};
}

/// An argument by value, whether the core's trait takes it by reference or not.
macro_rules! by_value {
    ($arg:ident &) => {
        *$arg
    };
    ($arg:ident) => {
        $arg
    };
}

pub(crate) use {by_value, declare, incoming, outgoing};
