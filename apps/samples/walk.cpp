#include "apps/samples/walk.h"

#include <array>
#include <cmath>

#include "apps/samples/foal.h"
#include "apps/samples/turns.h"

namespace sinew::samples {

namespace {

/// 1 at whole turns, -1 halfway between.
double wave(double turns) {
  return cos_sin(turns).cos;
}

/// Where a foot is in its cycle: how far ahead of its place at rest, how high, and how far into its swing, 0 to 1 to 0.
struct Step {
  double ahead, lift, swing;
};
Step step_at(double phase) {
  constexpr double reach = 0.19, stance = 0.62, height = 0.11;
  phase -= std::floor(phase);
  if (phase < stance) return {reach * (1 - 2 * phase / stance), 0, 0};
  // A cubic that leaves and meets the ground at the ground's own speed.
  const double u = (phase - stance) / (1 - stance), speed = -2 * reach * (1 - stance) / stance;
  const double cubic = u * u * (3 - 2 * u), ends = u * (1 - u) * (1 - 2 * u);
  const double swing = 16 * u * u * (1 - u) * (1 - u);
  return {reach * (2 * cubic - 1) + speed * ends, height * swing, swing};
}

void pose_leg(Skeleton& skeleton, int leg, double phase) {
  // The order of a walk: left hind, left front, right hind, right front.
  constexpr std::array<double, legs> begins{0.25, 0.75, 0, 0.5};
  const Step step = step_at(phase - begins[static_cast<std::size_t>(leg)]);
  const Joints& joint = joints_of(leg);
  const bool front = is_front(leg);

  const double swung = front ? 100 * step.ahead + 3 * step.swing : 78 * step.ahead + 16 * step.swing;  // degrees
  const Placed& body = skeleton[front ? Chest : Pelvis];
  skeleton[static_cast<std::size_t>(bone_of_leg(leg, 0))] = {turn_z(swung), joint[0], body(joint[0])};
  plant_leg(skeleton, leg, joint[3] + Vec3(step.ahead, step.lift, 0), -65 * step.swing);
}

Skeleton skeleton_at(double phase) {
  Skeleton skeleton;
  const double twice = wave(2 * phase);
  const Vec3 bob(0, -0.014 + 0.008 * wave(2 * phase + 0.1), 0);
  const Vec3 middle(0, 0.86, 0);
  skeleton[Pelvis] = {turn_z(1.2 * twice), middle, middle + bob};
  skeleton[Chest] = {turn_z(-1.2 * twice), middle, middle + bob};
  skeleton[LowerNeck] = hung(skeleton[Chest], {0.33, 0.95, 0}, turn_z(-3 + 5.5 * wave(2 * phase - 0.1)));
  skeleton[UpperNeck] = hung(skeleton[LowerNeck], {0.52, 1.16, 0}, turn_z(-2 + 4.5 * wave(2 * phase - 0.16)));
  skeleton[Head] = hung(skeleton[UpperNeck], {0.67, 1.36, 0}, turn_z(3 - 7 * wave(2 * phase - 0.22)));
  skeleton[Tail] = hung(skeleton[Pelvis], {-0.44, 0.96, 0}, turn_x(9 * wave(phase)) * turn_z(-8 - 3 * twice));
  skeleton[TailEnd] = hung(skeleton[Tail], {-0.57, 0.74, 0}, turn_x(14 * wave(phase - 0.12)) * turn_z(-6 - 4 * twice));
  for (int leg = 0; leg < legs; ++leg) pose_leg(skeleton, leg, phase);
  return skeleton;
}

}  // namespace

void make_walk(int frames, const TakeFrame& take) {
  Shape shape = foal();
  const FoalSkin skin(shape);
  for (int frame = 1; frame <= frames; ++frame) {
    shape.positions = skin.posed(skeleton_at(double((frame - 1) % walk_cycle) / walk_cycle));
    take(frame, shape);
  }
}

}  // namespace sinew::samples
