//! Searches of several rays at once, for the kernels of the tiers. Each of them is code for every SIMD level.

use super::method::Method;
use super::packet::PacketMethod;
use super::tree::TreeIntersector;
use crate::bvh::Stacks;
use crate::ray::{Hit, Ray};

/// The searches of several rays at once.
pub(super) struct Several<M: Method> {
    /// Finds the nearest hits of coherent rays.
    pub nearest_of_packets: fn(&TreeIntersector<M>, &[Ray], &mut [Option<Hit>]),
    /// Finds any hits of coherent rays.
    pub any_of_packets: fn(&TreeIntersector<M>, &[Ray], &mut [bool]),
    /// Finds the nearest hits in turns.
    pub nearest_in_turns: NearestInTurns<M>,
    /// Finds any hits in turns.
    pub any_in_turns: AnyInTurns<M>,
}

type NearestInTurns<M> =
    fn(&TreeIntersector<M>, &[Ray], &mut [Option<Hit>], &mut <M as Method>::Batch, &mut Stacks);

type AnyInTurns<M> = fn(&TreeIntersector<M>, &[Ray], &mut [bool], &mut Stacks);

impl<M: PacketMethod> Several<M> {
    pub const NEW: Self = Self {
        nearest_of_packets: TreeIntersector::nearest_of_packets,
        any_of_packets: TreeIntersector::any_of_packets,
        nearest_in_turns: TreeIntersector::nearest_in_turns,
        any_in_turns: TreeIntersector::any_in_turns,
    };
}
