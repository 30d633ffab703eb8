//! Bundles of signals that have one base name everywhere.

/// Declares a bundle of values and flags, generic over the reading, that can name and list its members.
macro_rules! bundle {
    ($(#[$doc:meta])* $name:ident { $($(#[doc = $vdoc:literal])* $value:ident),* $(,)? } { $($(#[doc = $fdoc:literal])* $flag:ident),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name<S: $crate::signal::Signal> {
            $($(#[doc = $vdoc])* pub $value: S,)*
            $($(#[doc = $fdoc])* pub $flag: S::Bool,)*
        }

        impl<S: $crate::signal::Signal> $name<S> {
            /// Names of the numbers, in order.
            pub const VALUES: &'static [&'static str] = &[$(stringify!($value)),*];
            /// Names of the flags, in order.
            pub const FLAGS: &'static [&'static str] = &[$(stringify!($flag)),*];

            /// What the member of this name is, in a sentence.
            pub fn meaning(name: &str) -> Option<&'static str> {
                match name {
                    $(stringify!($value) => Some(concat!($($vdoc),*).trim_ascii()),)*
                    $(stringify!($flag) => Some(concat!($($fdoc),*).trim_ascii()),)*
                    _ => None,
                }
            }

            /// Builds the bundle, member by member.
            pub fn build(
                mut value: impl FnMut(&'static str) -> S,
                mut flag: impl FnMut(&'static str) -> S::Bool,
            ) -> Self {
                let _ = (&mut value, &mut flag);
                Self { $($value: value(stringify!($value)),)* $($flag: flag(stringify!($flag)),)* }
            }

            /// The number of this name.
            pub fn value(&self, name: &str) -> Option<S> {
                match name { $(stringify!($value) => Some(self.$value),)* _ => None }
            }

            /// The flag of this name.
            pub fn flag(&self, name: &str) -> Option<S::Bool> {
                match name { $(stringify!($flag) => Some(self.$flag),)* _ => None }
            }
        }
    };
}

pub(crate) use bundle;
