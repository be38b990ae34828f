#pragma once
/// Bends a file of any length, block by block, in memory that does not grow with it.
///
/// Binary PLY to PLY, where the points have no lists and no lists come before them, is streamed: points in blocks of at
/// most 2^17 and 16 MiB; values that differ afterwards are replaced, everything else is copied as it is, and what
/// follows the points is not looked at. Every other file comes whole, as one block.
///
/// Several processes, on any machines that see the same files, can share such a PLY on a disk: each bends a range of
/// the points and writes it where it belongs in one output (shared_file.h). The first of them also writes what comes
/// before the points, the last what follows. They run in any order, at once or not, and one that was ended in the
/// middle is run again; once every one of them has come to its end the output has the bytes of one run for all.

#include <functional>
#include <optional>
#include <string>

#include "engine/io/io.h"
#include "engine/io/share.h"

namespace sinew::io {

struct StreamOptions {
  Vec3 origin = Vec3::Zero();  ///< that positions of blocks are relative to
  bool force = false;          ///< an existing file may be replaced
  std::string as;              ///< extension that stands for "-"
  /// Called with 0..1 after each block; false cancels: stream throws Cancelled and nothing is written. May be empty.
  std::function<bool(double)> progress;
  std::optional<Share> share;  ///< this process bends and writes points [first, last) only
};

/// Reads `in`, calls bend with each block in the order of the file, and writes `out` whole or not at all (only to
/// standard output it goes as it comes, and with a share it is written in place). bend changes positions and values of
/// attributes, never how many there are, and each point by itself alone. Throws InputError or Cancelled; with a share
/// also where `in` is no file on a disk that can be streamed, where `out` is that same file or no file on a disk, or
/// where it is there with another size or header and `force` is not given.
WriteReport stream(const std::string& in, const std::string& out, const StreamOptions& options,
                   const std::function<void(Shape& block)>& bend);

}  // namespace sinew::io
