#pragma once
/// BVH (Biovision): a skeleton of joints with the channels that move them, and rows of their values.
///
/// A joint's place in its parent's frame is its OFFSET, in which each position channel takes the stead of its own
/// coordinate; the order of position channels among others has no meaning. Its rotation is the product of its rotation
/// channels in their order, R = R_1 R_2 ..., each by degrees about an axis of the parent's frame turned by those
/// before. With R_i, p_i of the world: p_i = p_parent + R_parent place_i, R_i = R_parent R. Points of the trajectories
/// are the joints and ends ("NAME end") in the order of the file; the rest has all offsets and no rotations.
///
/// (Some programs add position channels to the OFFSET. Where channels move joints below the root, files repeat the
/// OFFSET in them, so that a sum would double each bone.)

#include "engine/io/motion.h"

namespace sinew::io {

/// Throws InputError.
Trajectories read_bvh(const std::string& path, std::span<const std::byte> bytes);

}  // namespace sinew::io
