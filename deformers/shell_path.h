#pragma once
/// The way of what is held from where it is to its targets: rigid bodies turn and move evenly, all else goes straight.

#include <optional>
#include <span>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

class ShellPath {
 public:
  explicit ShellPath(std::size_t points) : from_(points), to_(points) {}

  void set(Index point, const Vec3& from, const Vec3& to);
  /// Points that go as one body. `turn`: how far it turns, where that is known (axis times radians, of any length);
  /// else the rotation that fits best. `unit`: the length that a stretch of the way is measured in.
  void add_body(std::vector<Index> points, std::optional<Vec3> turn, double unit);

  std::vector<Vec3> at(double share) const;  ///< of the way: 0 is `from`, 1 is `to`, exactly
  /// In how many stretches of at most 20 degrees, and 0.15 units, the bodies go there: 1 to 40.
  int stretches() const { return stretches_; }

 private:
  struct Body {
    std::vector<Index> points;
    Vec3 centre = Vec3::Zero(), move = Vec3::Zero(), turn = Vec3::Zero();
  };
  std::vector<Vec3> from_, to_;
  std::vector<Body> bodies_;
  int stretches_ = 1;
};

}  // namespace sinew
