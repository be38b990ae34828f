#pragma once
/// Runs sinew-tets, the process that fills a surface with tets (deformers/tet_protocol.h), so that whatever becomes of
/// it ends in an answer or a sentence.

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "deformers/tet_protocol.h"
#include "engine/geometry/shape.h"

namespace sinew {

using Triangle = std::array<Index, 3>;

struct TetLimits {
  std::chrono::steady_clock::time_point end;  ///< the process is ended then
  double seconds = 0;                         ///< what was allowed until then, for the sentence
  std::size_t bytes = 0;
};

struct TetAnswer {
  enum class How { Done, Crossing, Failed } how = How::Done;  ///< Failed: it ended in another way, as `why` says
  std::string why;
  std::vector<Vec3> added;
  std::vector<Tet> tets;        ///< indices within points and added ones
  std::vector<Index> regions;   ///< of each tet, what triangles separate from the rest has a number of its own
  std::vector<Index> crossing;  ///< triangles, ascending
};

/// Throws InputError where the program isn't found or doesn't start, where the limits are reached, and where the answer
/// isn't one. Null where progress said false.
std::optional<TetAnswer> run_tets(tets::Job job, const std::vector<Vec3>& points,
                                  const std::vector<Triangle>& triangles, const TetLimits& limits,
                                  const std::function<bool(double)>& progress);

}  // namespace sinew
