#pragma once
/// What goes between a program and sinew-tets, the process that runs TetGen: a request on its standard input, a reply
/// on its standard output, its outcome as exit status. Both are programs of one build on one machine, so numbers are as
/// in memory.

#include <cstdint>

namespace sinew::tets {

enum class Job : std::uint32_t {
  Fill = 1,        ///< tets of the surface's vertices (and the few that its edges and faces need inside)
  FillInside = 2,  ///< vertices inside are added for better tets
  Crossings = 3,   ///< which triangles cross others
};

constexpr std::uint64_t request_mark = 0x31716572'73746574;
constexpr std::uint64_t reply_mark = 0x31706572'73746574;

/// Then 3 doubles for each point and 3 std::uint32_t for each triangle, and the end of the input.
struct Request {
  std::uint64_t mark = request_mark;
  Job job = Job::Fill;
  std::uint32_t unused = 0;
  std::uint64_t points = 0, triangles = 0;
};

/// Then 3 doubles for each point that was added, 4 std::uint32_t for each tet (the added points follow the request's),
/// one more for each tet that numbers its region (what triangles separate from the rest), and one std::uint32_t for
/// each triangle that crosses another.
struct Reply {
  std::uint64_t mark = reply_mark;
  std::uint64_t added = 0, tets = 0, crossing = 0;
};

/// Exit status. The arguments are MAX_BYTES of memory and MAX_SECONDS of processor time.
enum Outcome : int {
  Done = 0,       ///< a reply was written
  BadUse = 2,     ///< arguments or request are not as described here
  Crossing = 10,  ///< the triangles cross each other, as far as TetGen noticed
  NoMemory = 11,
  Failed = 12,  ///< TetGen gave up
};

}  // namespace sinew::tets
