#pragma once
/// The foal, a sample that can be posed: one closed mesh, and bones that its vertices follow. Metres, y up, the ground
/// at y = 0, looking along +x.
///
/// The skin is the zero set of an Implicit at rest. Each vertex has weights over rigid bones: first the bone of the
/// part of the surface that it lies on, then evened out along the mesh, so that what is near but not joined (a leg
/// beside a leg) stays apart. A pose is p' = sum_b w_b (R_b (p - rest_b) + joint_b).

#include <array>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::samples {

constexpr double foal_cell = 0.0207;  ///< metres
/// The foal at rest: about 8,400 vertices, as the horse of Sumner, Schmid and Pauly, Figure 8, has.
Shape foal();
/// With cells of another size (see polygonized).
Shape foal(double cell);

/// Bones by number; each leg has four, from the body to the hoof, from its first one on.
enum Bone : int { Pelvis, Chest, LowerNeck, UpperNeck, Head, Tail, TailEnd, FirstLeg };
constexpr int bones_a_leg = 4, legs = 4, bone_count = FirstLeg + legs * bones_a_leg;

/// Legs: left front, right front, left hind, right hind.
inline int bone_of_leg(int leg, int k) {
  return FirstLeg + leg * bones_a_leg + k;
}
inline bool is_front(int leg) {
  return leg < 2;
}

/// Where a leg bends, at z = 0: the pivot in the body, elbow or stifle, knee or hock, fetlock, tip of the hoof.
using Joints = std::array<Vec3, 5>;
const Joints& joints_of(int leg);

/// A rotation about an axis, counter-clockwise seen from its end. About z: what hangs down swings forwards.
Mat3 turn_x(double degrees);
Mat3 turn_y(double degrees);
Mat3 turn_z(double degrees);

struct Placed {
  Mat3 turn = Mat3::Identity();
  Vec3 rest = Vec3::Zero(), joint = Vec3::Zero();
  Vec3 operator()(const Vec3& p) const { return turn * (p - rest) + joint; }
};
using Skeleton = std::array<Placed, bone_count>;

/// A bone that turns about `rest`, a point of the one that it hangs on.
Placed hung(const Placed& parent, const Vec3& rest, const Mat3& turn);

/// The two bones between elbow or stifle and fetlock, the first bone of the leg in its place: they meet where the
/// circles of their lengths do, at a knee forwards, at a hock backwards. `foot` is where the fetlock is to be, as far
/// as the leg reaches; the last bone turns by so many degrees.
void plant_leg(Skeleton& skeleton, int leg, const Vec3& foot, double hoof);

/// What a skeleton does to a foal of any cells.
class FoalSkin {
 public:
  explicit FoalSkin(const Shape& rest);
  /// Positions, to 1e-7.
  std::vector<Vec3> posed(const Skeleton& skeleton) const;

 private:
  using Weights = std::array<double, bone_count>;
  std::vector<Vec3> rest_;
  std::vector<Weights> weights_;  ///< of each vertex, positive, with sum 1
};

}  // namespace sinew::samples
