#pragma once
/// The tetrahedral editor timed on the solids of Table 3.1 of its report, and on the Botsch-Sorkine samples.

#include <map>
#include <string>

#include "tests/benchmarks/solids.h"

namespace sinew::benchmarks {

/// Medians, in seconds unless said otherwise, and REF as it was before and after, in the mean.
struct SolidTimes {
  double ref = 0;
  std::size_t input = 0, vertices = 0, tets = 0;  ///< sizes reached
  double fact = 0;                                ///< L assembled, ordered, analysed and factorized
  double numeric = 0;                             ///< of which the numbers alone
  double values = 0;                              ///< of the factor
  double plain = 0;  ///< the report's frame: new right-hand side with rotations by polar decomposition, linear solve
  double iteration = 0;                          ///< ours, in a mouse move of 1 % of the diagonal
  double move = 0, iterations = 0;               ///< the whole of it, and how many it takes
  double trans = 0, recons = 0, recons_one = 0;  ///< transfer coefficients; all points, all cores and one
  double influences = 0;                         ///< of a point, in the mean
};
SolidTimes time_solid(const SolidRow& row);

/// A sample cold from rest to the limit.
struct ColdSolve {
  double ref = 0, seconds = 0;
  std::size_t tets = 0;
  int iterations = 0;
  double energy = 0, edge_rms = 0, edge_max = 0, volume = 0;
};
/// "bar", "cylinder", "cactus", or "plane" for the bumpy slab.
ColdSolve time_cold_solve(const std::string& name, bool inside);

/// Prints both tables; the figures by row and name, in milliseconds where they are times.
std::map<std::string, std::map<std::string, double>> print_solids();

}  // namespace sinew::benchmarks
