#include "apps/samples/foal.h"

#include <algorithm>
#include <cmath>

#include "apps/samples/implicit.h"
#include "apps/samples/meshes.h"
#include "apps/samples/turns.h"
#include "engine/geometry/topology.h"

namespace sinew::samples {

const Joints& joints_of(int leg) {
  static const Joints front{Vec3(0.22, 0.97, 0), Vec3(0.265, 0.66, 0), Vec3(0.290, 0.40, 0), Vec3(0.280, 0.15, 0),
                            Vec3(0.33, 0.02, 0)};
  static const Joints hind{Vec3(-0.33, 0.90, 0), Vec3(-0.250, 0.66, 0), Vec3(-0.425, 0.43, 0), Vec3(-0.400, 0.15, 0),
                           Vec3(-0.35, 0.02, 0)};
  return is_front(leg) ? front : hind;
}

namespace {

double side_of(int leg) {
  return leg % 2 == 0 ? -1 : 1;
}

struct Knot {
  Vec3 p;
  double r;
};

/// Capsules from knot to knot, made of (Capsule::material) a bone.
void add_chain(std::vector<Capsule>& parts, int bone, std::initializer_list<Knot> knots, double blend,
               double flat = 1) {
  for (const Knot* knot = knots.begin(); knot + 1 != knots.end(); ++knot)
    parts.push_back({knot[0].p, knot[1].p, knot[0].r, knot[1].r, blend, Vec3::UnitZ(), flat, bone});
}

void add_trunk(std::vector<Capsule>& parts) {
  add_chain(parts, Chest, {{{0.27, 0.86, 0}, 0.165}, {{0.02, 0.83, 0}, 0.165}}, 0.05, 0.85);
  add_chain(parts, Pelvis, {{{0.02, 0.83, 0}, 0.165}, {{-0.31, 0.90, 0}, 0.160}}, 0.06, 0.85);
  add_chain(parts, Chest, {{{0.24, 1.00, 0}, 0.070}, {{0.05, 0.955, 0}, 0.060}}, 0.08);
  add_chain(parts, LowerNeck, {{{0.34, 0.93, 0}, 0.130}, {{0.52, 1.15, 0}, 0.090}}, 0.08, 0.75);
  add_chain(parts, UpperNeck, {{{0.52, 1.15, 0}, 0.090}, {{0.66, 1.36, 0}, 0.072}}, 0.04, 0.75);
  add_chain(parts, Head, {{{0.68, 1.385, 0}, 0.076}, {{0.83, 1.26, 0}, 0.062}}, 0.04, 0.85);
  add_chain(parts, Head, {{{0.83, 1.26, 0}, 0.060}, {{0.945, 1.12, 0}, 0.046}}, 0.03, 0.9);
  add_chain(parts, Head, {{{0.70, 1.29, 0}, 0.060}, {{0.86, 1.15, 0}, 0.036}}, 0.03, 0.8);
  // The mane, in two parts: it bends with the neck.
  add_chain(parts, LowerNeck, {{{0.27, 1.06, 0}, 0.045}, {{0.43, 1.23, 0}, 0.042}}, 0.02, 0.5);
  add_chain(parts, UpperNeck, {{{0.43, 1.23, 0}, 0.042}, {{0.59, 1.43, 0}, 0.042}}, 0.02, 0.5);
  for (const double side : {-1.0, 1.0}) {
    const Vec3 listen = Vec3(0.8, 0.3, 0.4 * side).normalized();
    parts.push_back(
        {{0.655, 1.435, 0.040 * side}, {0.640, 1.500, 0.052 * side}, 0.026, 0.032, 0.015, listen, 0.6, Head});
    parts.push_back(
        {{0.640, 1.500, 0.052 * side}, {0.640, 1.560, 0.050 * side}, 0.032, 0.014, 0.010, listen, 0.6, Head});
    parts.push_back(
        {{0.775, 1.335, 0.048 * side}, {0.785, 1.325, 0.048 * side}, 0.020, 0.020, 0.012, Vec3::UnitZ(), 1, Head});
    parts.push_back(
        {{0.960, 1.105, 0.018 * side}, {0.968, 1.095, 0.020 * side}, 0.026, 0.024, 0.015, Vec3::UnitZ(), 1, Head});
  }
  add_chain(parts, Tail, {{{-0.44, 0.97, 0}, 0.042}, {{-0.53, 0.90, 0}, 0.038}, {{-0.57, 0.74, 0}, 0.044}}, 0.03);
  add_chain(parts, TailEnd, {{{-0.57, 0.74, 0}, 0.044}, {{-0.585, 0.56, 0}, 0.046}, {{-0.595, 0.42, 0}, 0.018}}, 0.02);
}

void add_leg(std::vector<Capsule>& parts, int leg) {
  const Joints& joint = joints_of(leg);
  const auto at = [&](const Vec3& p, double z) { return Vec3(p.x(), p.y(), z * side_of(leg)); };
  const double z = is_front(leg) ? 0.095 : 0.100;
  if (is_front(leg)) {
    add_chain(parts, bone_of_leg(leg, 0), {{{0.29, 0.86, 0.075 * side_of(leg)}, 0.105}, {at(joint[1], z), 0.072}},
              0.06);
    add_chain(parts, bone_of_leg(leg, 1), {{at(joint[1], z), 0.068}, {at(joint[2], z), 0.039}}, 0.03);
  } else {
    add_chain(parts, bone_of_leg(leg, 0), {{at({-0.33, 0.87, 0}, 0.070), 0.125}, {at(joint[1], z), 0.088}}, 0.07);
    add_chain(parts, bone_of_leg(leg, 1), {{at(joint[1] - Vec3(0.02, 0.01, 0), z), 0.078}, {at(joint[2], z), 0.040}},
              0.03);
  }
  add_chain(parts, bone_of_leg(leg, 2),
            {{at(joint[2], z), 0.041}, {at(joint[2] - Vec3(0, 0.06, 0), z), 0.033}, {at(joint[3], z), 0.029}}, 0.02);
  const Vec3 coronet = joint[3] + Vec3(0.036, -0.095, 0);
  add_chain(parts, bone_of_leg(leg, 3), {{at(joint[3], z), 0.034}, {at(coronet, z), 0.031}}, 0.02);
  add_chain(parts, bone_of_leg(leg, 3), {{at(coronet, z), 0.040}, {at(joint[4], z), 0.050}}, 0.01);
}

const Implicit& skin() {
  static const Implicit surface = [] {
    std::vector<Capsule> parts;
    add_trunk(parts);
    for (int leg = 0; leg < legs; ++leg) add_leg(parts, leg);
    return Implicit(std::move(parts), true);
  }();
  return surface;
}

/// The rotation about z that carries the direction a to b.
Mat3 turn_between(const Vec3& a, const Vec3& b) {
  const double length = std::sqrt(a.squaredNorm() * b.squaredNorm());
  const double c = a.dot(b) / length, s = (a.x() * b.y() - a.y() * b.x()) / length;
  return (Mat3() << c, -s, 0, s, c, 0, 0, 0, 1).finished();
}

}  // namespace

Shape foal() {
  return foal(foal_cell);
}

Shape foal(double cell) {
  return polygonized(skin(), cell);
}

Mat3 turn_z(double degrees) {
  const auto [c, s] = cos_sin(degrees / 360);
  return (Mat3() << c, -s, 0, s, c, 0, 0, 0, 1).finished();
}
Mat3 turn_x(double degrees) {
  const auto [c, s] = cos_sin(degrees / 360);
  return (Mat3() << 1, 0, 0, 0, c, -s, 0, s, c).finished();
}
Mat3 turn_y(double degrees) {
  const auto [c, s] = cos_sin(degrees / 360);
  return (Mat3() << c, 0, s, 0, 1, 0, -s, 0, c).finished();
}

Placed hung(const Placed& parent, const Vec3& rest, const Mat3& turn) {
  return {parent.turn * turn, rest, parent(rest)};
}

void plant_leg(Skeleton& skeleton, int leg, const Vec3& foot, double hoof) {
  const Joints& joint = joints_of(leg);
  const auto bone = [&](int k) -> Placed& { return skeleton[static_cast<std::size_t>(bone_of_leg(leg, k))]; };
  const Vec3 top = bone(0)(joint[1]);
  const double upper = (joint[2] - joint[1]).norm(), lower = (joint[3] - joint[2]).norm();
  const double apart = std::min((foot - top).norm(), 0.999 * (upper + lower));
  const Vec3 along = (foot - top).normalized();
  const double a = (upper * upper - lower * lower + apart * apart) / (2 * apart);
  const double b = std::sqrt(std::max(upper * upper - a * a, 0.0));
  const Vec3 ahead(-along.y(), along.x(), 0);
  const Vec3 middle = top + a * along + (is_front(leg) ? b : -b) * ahead, end = top + apart * along;
  bone(1) = {turn_between(joint[2] - joint[1], middle - top), joint[1], top};
  bone(2) = {turn_between(joint[3] - joint[2], end - middle), joint[2], middle};
  bone(3) = {turn_z(hoof), joint[3], end};
}

FoalSkin::FoalSkin(const Shape& rest) : rest_(rest.positions), weights_(rest.size(), Weights{}) {
  const Implicit::Parts parts = skin().all();
  for (std::size_t i = 0; i < rest.size(); ++i)
    weights_[i][static_cast<std::size_t>(skin().material(rest.positions[i], parts))] = 1;
  const auto edges = edges_of(rest.faces);
  std::vector<double> degree(rest.size(), 0);
  for (const auto& [a, b] : edges) {
    ++degree[a];
    ++degree[b];
  }
  // Less in the thin legs, whose joints are short.
  for (int round = 0; round < 40; ++round) {
    std::vector<Weights> sum(rest.size(), Weights{});
    for (const auto& [a, b] : edges)
      for (std::size_t k = 0; k < bone_count; ++k) {
        sum[a][k] += weights_[b][k];
        sum[b][k] += weights_[a][k];
      }
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const double share = std::clamp(1.6 * (rest.positions[i].y() - 0.15), 0.12, 0.9);
      for (std::size_t k = 0; k < bone_count; ++k) weights_[i][k] += share * (sum[i][k] / degree[i] - weights_[i][k]);
    }
  }
}

std::vector<Vec3> FoalSkin::posed(const Skeleton& skeleton) const {
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    Vec3 p = Vec3::Zero();
    for (std::size_t k = 0; k < bone_count; ++k)
      if (weights_[i][k] > 0) p += weights_[i][k] * skeleton[k](rest_[i]);
    out.push_back((Vec3(std::round(p.x() * 1e7), std::round(p.y() * 1e7), std::round(p.z() * 1e7)) / 1e7)
                      .cast<float>()
                      .cast<double>());
  }
  return out;
}

}  // namespace sinew::samples
