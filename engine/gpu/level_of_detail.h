#pragma once
/// Level of detail: an order of points in which every beginning is an even sample of the whole, so that drawing the
/// first N of it is a good coarse picture while something moves.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace sinew::gpu {

/// A permutation of 0..n-1: one point of each cell of a coarse grid, then of ever finer ones; within a level shuffled
/// by a hash. Points that are not finite come last. Deterministic; about 0.2 s for a million points.
std::vector<std::uint32_t> progressive_order(std::span<const Eigen::Vector3d> points);

/// How many points to draw so that the next picture takes `wanted_ms`, from how long one of `drawn` points took. Moves
/// by at most a factor of two and never below `least` (all of them where there are fewer).
std::size_t next_count(std::size_t drawn, double taken_ms, double wanted_ms, std::size_t least, std::size_t most);

}  // namespace sinew::gpu
