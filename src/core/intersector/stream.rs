//! Searches of many rays at once: in packets and interleaved. Only the kernels of the tiers have them, because each
//! search is compiled for every SIMD level.

use super::method::Method;
use super::packet::PacketMethod;
use super::tree::TreeIntersector;
use crate::bvh::Stacks;
use crate::ray::{Hit, Ray};

/// The searches of a method for many rays at once.
pub(super) struct StreamSearches<M: Method> {
    /// Finds the nearest hits of coherent rays.
    pub nearest_of_packets: fn(&TreeIntersector<M>, &[Ray], &mut [Option<Hit>]),
    /// Finds any hits of coherent rays.
    pub any_of_packets: fn(&TreeIntersector<M>, &[Ray], &mut [bool]),
    /// Finds the nearest hits of any rays, interleaved.
    pub nearest_interleaved: NearestInterleaved<M>,
    /// Finds any hits of any rays, interleaved.
    pub any_interleaved: AnyInterleaved<M>,
}

type NearestInterleaved<M> =
    fn(&TreeIntersector<M>, &[Ray], &mut [Option<Hit>], &mut <M as Method>::Batch, &mut Stacks);

type AnyInterleaved<M> = fn(&TreeIntersector<M>, &[Ray], &mut [bool], &mut Stacks);

impl<M: PacketMethod> StreamSearches<M> {
    pub const NEW: Self = Self {
        nearest_of_packets: TreeIntersector::nearest_of_packets,
        any_of_packets: TreeIntersector::any_of_packets,
        nearest_interleaved: TreeIntersector::nearest_interleaved,
        any_interleaved: TreeIntersector::any_interleaved,
    };
}
