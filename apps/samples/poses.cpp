#include "apps/samples/poses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "apps/samples/foal.h"
#include "apps/samples/turns.h"

namespace sinew::samples {

namespace {

/// Degrees about z and y against the bone before.
struct Bend {
  double z = 0, y = 0;
};

struct Leg {
  enum Kind { Planted, Free } kind = Planted;
  /// Planted: the leg's first bone by so many degrees, the fetlock as far ahead of its place at rest and as high (m),
  /// the hoof by so many degrees. Free: the four bones, each by so many degrees against the one before it.
  std::array<double, 4> by{};
};

struct FoalPose {
  const char* name;
  double pitch = 0;        ///< of the body about `pivot`, degrees; up in front
  Vec3 pivot{0, 0.86, 0};  ///< a point of the body
  Vec3 move{0, 0, 0};
  double arch = 0;  ///< of the loins, degrees
  Bend lower_neck{}, upper_neck{}, head{};
  double tail = 0;
  std::array<Leg, legs> leg{};  ///< left front, right front, left hind, right hind
};

std::vector<FoalPose> poses() {
  constexpr Leg::Kind planted = Leg::Planted, free = Leg::Free;
  const Vec3 shoulder(0.22, 0.97, 0), hip(-0.33, 0.90, 0);
  return {
      {.name = "stride-left",
       .lower_neck = {-8},
       .head = {6},
       .tail = -14,
       .leg = {{{planted, {24, 0.22, 0, 0}},
                {planted, {-14, -0.17, 0, 0}},
                {planted, {-18, -0.20, 0, 0}},
                {planted, {20, 0.20, 0, 0}}}}},
      {.name = "stride-right",
       .lower_neck = {-8},
       .head = {6},
       .tail = -14,
       .leg = {{{planted, {-14, -0.17, 0, 0}},
                {planted, {24, 0.22, 0, 0}},
                {planted, {20, 0.20, 0, 0}},
                {planted, {-18, -0.20, 0, 0}}}}},
      {.name = "head-down",
       .pitch = -2,
       .pivot = hip,
       .lower_neck = {-68},
       .upper_neck = {-26},
       .head = {24},
       .leg = {{{planted, {16, 0.16, 0, 0}}, {planted, {-6, -0.07, 0, 0}}, {}, {}}}},
      {.name = "head-up", .pitch = 2, .pivot = hip, .lower_neck = {16}, .upper_neck = {14}, .head = {20}, .tail = -40},
      {.name = "leg-lifted", .lower_neck = {6}, .leg = {{{}, {}, {free, {26, -52, 60, -50}}, {}}}},
      {.name = "kick",
       .pitch = -20,
       .pivot = shoulder,
       .move = {0, -0.01, 0},
       .lower_neck = {-14},
       .head = {12},
       .tail = -60,
       .leg = {{{planted, {16, 0.03, 0, 0}},
                {planted, {12, 0.01, 0, 0}},
                {free, {-48, 18, -22, -30}},
                {free, {-42, 14, -26, -30}}}}},
      {.name = "rear",
       .pitch = 42,
       .pivot = hip,
       .move = {0, -0.04, 0},
       .upper_neck = {-16},
       .head = {-18},
       .tail = -20,
       .leg = {{{free, {22, 20, -92, -50}},
                {free, {6, 26, -100, -50}},
                {planted, {14, 0.13, 0, 0}},
                {planted, {10, 0.10, 0, 0}}}}},
      {.name = "sit",
       .pitch = 34,
       .pivot = shoulder,
       .move = {-0.02, -0.02, 0},
       .arch = -8,
       .lower_neck = {-22},
       .upper_neck = {-6},
       .head = {-4},
       .tail = -60,
       .leg = {{{planted, {14, 0.02, 0, 0}},
                {planted, {14, 0.04, 0, 0}},
                {planted, {52, 0.24, -0.02, 0}},
                {planted, {52, 0.26, -0.02, 0}}}}},
      {.name = "turn-left", .lower_neck = {-4, 34}, .upper_neck = {-4, 32}, .head = {0, 18}},
      {.name = "turn-right", .lower_neck = {-4, -34}, .upper_neck = {-4, -32}, .head = {0, -18}},
  };
}

Mat3 turn_of(const Bend& bend) {
  return turn_y(bend.y) * turn_z(bend.z);
}

Skeleton skeleton_of(const FoalPose& pose) {
  Skeleton skeleton;
  skeleton[Chest] = {turn_z(pose.pitch), pose.pivot, pose.pivot + pose.move};
  skeleton[Pelvis] = hung(skeleton[Chest], {-0.12, 0.90, 0}, turn_z(pose.arch));
  skeleton[LowerNeck] = hung(skeleton[Chest], {0.33, 0.95, 0}, turn_of(pose.lower_neck));
  skeleton[UpperNeck] = hung(skeleton[LowerNeck], {0.52, 1.16, 0}, turn_of(pose.upper_neck));
  skeleton[Head] = hung(skeleton[UpperNeck], {0.67, 1.36, 0}, turn_of(pose.head));
  skeleton[Tail] = hung(skeleton[Pelvis], {-0.44, 0.96, 0}, turn_z(pose.tail));
  skeleton[TailEnd] = hung(skeleton[Tail], {-0.57, 0.74, 0}, turn_z(0.4 * pose.tail));
  for (int leg = 0; leg < legs; ++leg) {
    const Joints& joint = joints_of(leg);
    const auto& [kind, by] = pose.leg[static_cast<std::size_t>(leg)];
    const auto bone = [&](int k) -> Placed& { return skeleton[static_cast<std::size_t>(bone_of_leg(leg, k))]; };
    const Placed& body = skeleton[is_front(leg) ? Chest : Pelvis];
    if (kind == Leg::Planted) {
      bone(0) = {turn_z(by[0]), joint[0], body(joint[0])};
      plant_leg(skeleton, leg, joint[3] + Vec3(by[1], by[2], 0), by[3]);
    } else {
      for (int k = 0; k < bones_a_leg; ++k)
        bone(k) = hung(k == 0 ? body : bone(k - 1), joint[static_cast<std::size_t>(k)],
                       turn_z(by[static_cast<std::size_t>(k)]));
    }
  }
  return skeleton;
}

/// A ring of the tube: how far along it is, as a share of its length. 61 of them; a third of the way they stand three
/// times as close as elsewhere.
constexpr int sides = 10, rings = 61;
std::vector<double> ring_places() {
  const auto step = [](int k) { return k / 10 % 2 == 0 ? 3.0 : 1.0; };
  double length = 0, at = 0;
  for (int k = 0; k + 1 < rings; ++k) length += step(k);
  std::vector<double> out;
  for (int k = 0; k < rings; ++k) {
    out.push_back(at / length);
    at += step(k);
  }
  return out;
}

Faces tube_faces() {
  Faces faces;
  const auto at = [](int ring, int i) { return static_cast<Index>(1 + ring * sides + i % sides); };
  for (int i = 0; i < sides; ++i) {
    faces.add(std::array{Index{0}, at(0, i), at(0, i + 1)});
    for (int ring = 0; ring + 1 < rings; ++ring) {
      faces.add(std::array{at(ring, i), at(ring + 1, i), at(ring + 1, i + 1)});
      faces.add(std::array{at(ring, i), at(ring + 1, i + 1), at(ring, i + 1)});
    }
    faces.add(std::array{at(rings, 0), at(rings - 1, i + 1), at(rings - 1, i)});
  }
  return faces;
}

constexpr double tube_length = 2, tube_radius = 0.035;

/// To 1e-7, as floats.
Vec3 rounded(const Vec3& p) {
  return (Vec3(std::round(p.x() * 1e7), std::round(p.y() * 1e7), std::round(p.z() * 1e7)) / 1e7)
      .cast<float>()
      .cast<double>();
}

/// A tube around a curve: where it is after a share of its length, and what is across it there.
struct Across {
  Vec3 middle, u, v;
};
template <class Curve>
Shape tube_around(const Curve& curve) {
  Shape shape;
  const auto add = [&](const Vec3& p) { shape.positions.push_back(rounded(p)); };
  const std::vector<double> places = ring_places();
  add(curve(0.0).middle);
  for (const double place : places) {
    const Across at = curve(place);
    for (int i = 0; i < sides; ++i) {
      const auto [c, s] = cos_sin(double(i) / sides);
      add(at.middle + tube_radius * (c * at.u + s * at.v));
    }
  }
  add(curve(1.0).middle);
  shape.faces = tube_faces();
  return shape;
}

}  // namespace

std::vector<NamedShape> foal_poses() {
  return foal_poses(foal_cell);
}

std::vector<NamedShape> foal_poses(double cell) {
  const Shape rest = foal(cell);
  const FoalSkin skin(rest);
  std::vector<NamedShape> out;
  for (const FoalPose& pose : poses()) {
    Shape shape = rest;
    shape.positions = skin.posed(skeleton_of(pose));
    out.push_back({pose.name, std::move(shape)});
  }
  return out;
}

Shape foal_turned() {
  std::vector<NamedShape> all = foal_poses();
  const auto down = std::ranges::find(all, "head-down", &NamedShape::name);
  const Mat3 turn = turn_y(140);
  for (Vec3& p : down->shape.positions) p = rounded(turn * p);
  return std::move(down->shape);
}

Shape tube() {
  return tube_around([](double share) {
    return Across{Vec3(0, tube_length * share, 0), Vec3::UnitX(), Vec3::UnitZ()};
  });
}

Shape helix(double turns) {
  constexpr double radius = 0.09;
  const double around = 2 * std::numbers::pi * radius * turns;
  const double height = std::sqrt(tube_length * tube_length - around * around);
  return tube_around([&](double share) {
    const auto [c, s] = cos_sin(turns * share);
    const Vec3 outwards(c, 0, -s);
    const Vec3 along = (Vec3(-s, 0, -c) * around + Vec3(0, height, 0)) / tube_length;
    return Across{radius * outwards + Vec3(-radius, height * share, 0), outwards, outwards.cross(along)};
  });
}

}  // namespace sinew::samples
