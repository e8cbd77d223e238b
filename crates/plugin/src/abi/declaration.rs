//! One declaration of a trait gives both sides of the boundary.
//!
//! This declaration
//!
//! ```text
//! declare! {
//!     VelocitySolver => AbiVelocity, AbiVelocity_TO, IncomingVelocity<'b>;
//!     properties { dependence: Dependence, gives_exact_rates: bool = false }
//!     methods { fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()>; }
//!     later { fn warm_up(&self) -> Result<()> = Ok(()); }
//! }
//! ```
//!
//! expands to three items. The first is the trait that crosses, for abi_stable:
//!
//! ```text
//! #[sabi_trait]
//! pub trait AbiVelocity: Send + Sync {
//!     fn solve(&self, nodes: AbiNodes<'_>, out: AbiVelocities<'_>) -> Answer<()>;
//!     #[sabi(last_prefix_field)]
//!     fn properties(&self) -> Answer<RVec<u64>>;
//!     fn warm_up(&self) -> Answer<()> { … Ok(()) … }
//! }
//! ```
//!
//! The second is the author's side. It catches panics:
//!
//! ```text
//! impl<P: Deref<Target = dyn VelocitySolver>> AbiVelocity for Outgoing<P> {
//!     fn solve(&self, nodes: AbiNodes<'_>, out: AbiVelocities<'_>) -> Answer<()> {
//!         answer(|| { … self.0.solve(nodes.lend(), out.lend()) … })
//!     }
//!     …
//! }
//! ```
//!
//! The third is the caller's side, which reads the properties once and checks lengths:
//!
//! ```text
//! pub struct IncomingVelocity<'b, P> { object: AbiVelocity_TO<'b, P>, dependence: Dependence, … }
//!
//! impl<P> VelocitySolver for IncomingVelocity<'_, P> {
//!     fn solve(&self, nodes: Nodes<'_>, out: Velocities<'_>) -> Result<()> {
//!         … lengths.check()?; result(self.object.solve(nodes.lend(), out.lend())) …
//!     }
//!     …
//! }
//! ```
//!
//! - `properties` have no arguments and never change. They cross as one list of codes. A property
//!   that is added later stands last and has a default, for plugins that do not give it.
//! - `methods` are in every plugin of this version of the boundary.
//! - `later` has the methods that were added since, in the order in which they were added. A plugin
//!   without one gives the value after `=`.
//! - `path[&]: Path<'_>` declares an argument that the core's trait takes by reference.
//! - `kept { … } own { … }` adds fields to the caller's side, and methods of the core's trait that
//!   read them.

/// An object of the core, wrapped for the boundary.
pub struct Outgoing<P>(pub P);

/// See the module.
macro_rules! declare {
    (
        $core:ident: $deref:ident $as_ptr:ident, $($bound:ident)+ => $abi:ident, $object:ident, $incoming:ident<$b:lifetime>;
        properties { $($property:ident : $kind:ty $(= $default:expr)?),* $(,)? }
        methods { $(
            $(#[$doc:meta])*
            fn $method:ident $([$mut:tt])? (&self $(, $arg:ident $([$by:tt])? : $type:ty)* $(,)?) -> $reply:ty;
        )* }
        later { $(
            $(#[$later_doc:meta])*
            fn $later:ident(&self $(, $later_arg:ident $([$later_by:tt])? : $later_type:ty)* $(,)?)
                -> $later_reply:ty = $without:expr;
        )* }
        $(owned by $owned:ident)?
        $(kept { $field:ident : $field_type:ty } own { $($own:tt)* })?
    ) => {
        #[abi_stable::sabi_trait]
        pub trait $abi: $($bound +)+ {
            $(
                $(#[$doc])*
                fn $method(& $($mut)? self $(, $arg: $crate::abi::loan::Wire<'_, $type>)*)
                    -> $crate::abi::reply::Answer<<$reply as $crate::abi::reply::Reply>::Wire>;
            )*
            #[sabi(last_prefix_field)]
            fn properties(&self)
                -> $crate::abi::reply::Answer<abi_stable::std_types::RVec<u64>>;
            $(
                $(#[$later_doc])*
                fn $later(
                    &self
                    $(, $later_arg: $crate::abi::loan::Wire<'_, $later_type>)*
                ) -> $crate::abi::reply::Answer<<$later_reply as $crate::abi::reply::Reply>::Wire>
                {
                    $(let _ = $later_arg;)*
                    $crate::abi::reply::answer(|| {
                        let without: $later_reply = $without;
                        $crate::abi::reply::Reply::send(without)
                    })
                }
            )*
        }

        impl<'c, P> $abi for $crate::abi::declaration::Outgoing<P>
        where
            P: std::ops::$deref<Target = dyn $core + 'c> + $($bound +)+,
        {
            $crate::abi::declaration::outgoing! {
                $(fn $method $([$mut])? ($($arg $([$by])? : $type),*) -> $reply;)*
                $(fn $later($($later_arg $([$later_by])? : $later_type),*) -> $later_reply;)*
            }

            fn properties(&self)
                -> $crate::abi::reply::Answer<abi_stable::std_types::RVec<u64>>
            {
                $crate::abi::reply::answer(|| {
                    let codes: Vec<u64> =
                        vec![$($crate::abi::reply::Code::code(self.0.$property())),*];
                    Ok(codes.into())
                })
            }
        }

        /// The object of the other side, wrapped as one of the core.
        pub struct $incoming<$b, P: abi_stable::pointer_trait::AsPtr<PtrTarget = ()>> {
            object: $object<$b, P>,
            $($property: $kind,)*
            $($field: $field_type,)?
        }

        impl<$b, P: abi_stable::pointer_trait::AsPtr<PtrTarget = ()>> $incoming<$b, P> {
            /// Reads the object's properties and wraps it.
            pub fn new(
                object: $object<$b, P>,
                $($field: $field_type,)?
            ) -> turnpath_core::Result<Self> {
                let properties: &[&str] = &[$(stringify!($property)),*];
                // Most surfaces are lent for a short call, and they have no properties.
                let codes = if properties.is_empty() {
                    abi_stable::std_types::RVec::new()
                } else {
                    $crate::abi::reply::result(object.properties())?
                };
                let mut _codes = codes.iter().copied();
                Ok(Self {
                    $($property: $crate::abi::reply::property(
                        _codes.next(),
                        stringify!($property),
                        None$(.or(Some($default)))?,
                    )?,)*
                    $($field,)?
                    object,
                })
            }
        }

        impl<$b, P> $core for $incoming<$b, P>
        where
            P: abi_stable::pointer_trait::$as_ptr<PtrTarget = ()> + Send + Sync,
            $object<$b, P>: $($bound +)+,
        {
            $(fn $property(&self) -> $kind {
                self.$property
            })*

            $crate::abi::declaration::incoming! {
                $(fn $method $([$mut])? ($($arg $([$by])? : $type),*) -> $reply;)*
                $(fn $later($($later_arg $([$later_by])? : $later_type),*) -> $later_reply;)*
            }

            $($($own)*)?
        }

        $(
            /// An object that belongs to its plugin.
            pub type $owned = $object<'static, abi_stable::std_types::RBox<()>>;

            impl $crate::abi::reply::Value for Box<dyn $core> {
                type Wire = $owned;

                fn send(self) -> $owned {
                    let object = $crate::abi::panic_safe_box::PanicSafeBox::new(self);
                    $object::from_value(
                        $crate::abi::declaration::Outgoing(object),
                        abi_stable::sabi_trait::TD_Opaque,
                    )
                }

                fn receive(object: $owned) -> turnpath_core::Result<Self> {
                    Ok(Box::new($incoming::new(object)?))
                }
            }
        )?
    };
}

/// The author's side of each method.
macro_rules! outgoing {
    ($(fn $method:ident $([$mut:tt])? ($($arg:ident $([$by:tt])? : $type:ty),*) -> $reply:ty;)*) => {$(
        fn $method(& $($mut)? self $(, $arg: $crate::abi::loan::Wire<'_, $type>)*)
            -> $crate::abi::reply::Answer<<$reply as $crate::abi::reply::Reply>::Wire>
        {
            $crate::abi::reply::answer(|| {
                $(let mut $arg = $crate::abi::loan::Crossing::lender($arg)?;)*
                let reply: $reply = self.0.$method($(
                    $($by)? <$crate::abi::loan::Wire<'_, $type>
                        as $crate::abi::loan::Crossing>::lend(&mut $arg)
                ),*);
                let reply = $crate::abi::reply::Reply::send(reply)?;
                $(<$crate::abi::loan::Wire<'_, $type>
                    as $crate::abi::loan::Crossing>::settle($arg)?;)*
                Ok(reply)
            })
        }
    )*};
}

/// The caller's side of each method.
macro_rules! incoming {
    ($(fn $method:ident $([$mut:tt])? ($($arg:ident $([$by:tt])? : $type:ty),*) -> $reply:ty;)*) => {$(
        fn $method(& $($mut)? self $(, $arg: $($by)? $type)*) -> $reply {
            $crate::abi::reply::receive(|| {
                let mut _lengths = $crate::abi::loan::Lengths::default();
                $(
                    let $arg = $crate::abi::declaration::by_value!($arg $($by)?);
                    let mut $arg = $crate::abi::loan::Crossing::lender($arg)?;
                    <$type as $crate::abi::loan::Crossing>::count(&$arg, &mut _lengths);
                )*
                _lengths.check()?;
                let answer = self.object.$method($(
                    <$type as $crate::abi::loan::Crossing>::lend(&mut $arg)
                ),*);
                $(<$type as $crate::abi::loan::Crossing>::settle($arg)?;)*
                $crate::abi::reply::result(answer)
            })
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
