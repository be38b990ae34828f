#pragma once
/// Keys: the motions of a layer's handles between and beyond the frames that they were set at.
///
/// A motion is taken relative to the mean c of the handle's points at the key's frame, and acts relative to the mean of
/// the same points at the frame asked for, so that an edit of one pose goes along with the animation:
///
///   p -> A (R (p - c - a) + a) + c + b + o_i + m
///
///   R  rotation about c + a      A  linear part of "matrix", b what it does to c      m  "move"
///   o_i  "to" less the point's place at the key's frame
///
/// Between two keys degrees, a, b, m and o_i are interpolated linearly (of the eased time); where the axes or pivots of
/// two rotations differ, the rotation goes the short way (slerp) about c and what it does to c is interpolated. A is
/// interpolated by its polar parts. Before the first key and after the last, their motion holds. At a key's own frame
/// the targets are exactly those of targets_of (selection.h).

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/document/project.h"

namespace sinew::document {

/// The keys that a frame lies between, and how far from the first to the second: 0 at the first; eased by the first
/// key's interpolation. Both are the same before the first and behind the last key.
struct KeySpan {
  std::size_t first = 0, second = 0;
  double u = 0;
};

/// `keys` ascending in frames and not empty. `frame` may lie between whole frames.
KeySpan span_of(std::span<const Key> keys, double frame);

/// The motion of one handle at a frame, as if it had a key there; the arguments are those of targets_between.
Motion motion_between(const Motion& first, const Motion& second, double u, std::span<const Vec3> at_first,
                      std::span<const Vec3> at_second, std::span<const Vec3> now, const Vec3& origin);

/// Targets of one handle at a frame. `now`: its points there, relative to `origin`; `at_first`, `at_second`: the same
/// points at the frames of the two keys.
std::vector<Vec3> targets_between(const Motion& first, const Motion& second, double u, std::span<const Vec3> at_first,
                                  std::span<const Vec3> at_second, std::span<const Vec3> now, const Vec3& origin);

/// Example weights between those of two keys; one that either leaves open is open.
std::vector<std::optional<double>> weights_between(std::span<const std::optional<double>> first,
                                                   std::span<const std::optional<double>> second, double u);

}  // namespace sinew::document
