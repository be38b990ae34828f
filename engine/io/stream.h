#pragma once
/// Bends a file of any length, block by block, in memory that does not grow with it.
///
/// Binary PLY to PLY, where the points have no lists and no lists come before them, is streamed: points in blocks of at
/// most 2^17 and 16 MiB; values that differ afterwards are replaced, everything else is copied as it is, and what
/// follows the points is not looked at. Every other file comes whole, as one block.

#include <functional>
#include <string>

#include "engine/io/io.h"

namespace sinew::io {

struct StreamOptions {
  Vec3 origin = Vec3::Zero();  ///< that positions of blocks are relative to
  bool force = false;          ///< an existing file may be replaced
  std::string as;              ///< extension that stands for "-"
  /// Called with 0..1 after each block; false cancels: stream throws Cancelled and nothing is written. May be empty.
  std::function<bool(double)> progress;
};

/// Reads `in`, calls bend with each block in the order of the file, and writes `out` whole or not at all (only to
/// standard output it goes as it comes). bend changes positions and values of attributes, never how many there are.
/// Throws InputError or Cancelled.
WriteReport stream(const std::string& in, const std::string& out, const StreamOptions& options,
                   const std::function<void(Shape& block)>& bend);

}  // namespace sinew::io
