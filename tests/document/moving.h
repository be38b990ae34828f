#pragma once
/// Small things that move: a tube that waves, a stream of particles along an arc, and edits of them.

#include <cmath>
#include <map>
#include <numbers>

#include "engine/document/project.h"
#include "engine/geometry/shape.h"

namespace sinew::document {

/// A tube along x of length 4 and radius 0.3, its far end waving up and down; frames 1 to `frames`. Point 0 lies at the
/// held end, the last at the other.
inline Sequence waving_tube(int frames) {
  Sequence out;
  out.frames.clear();
  for (int f = 1; f <= frames; ++f) out.frames.push_back(f);
  out.load = [](int frame) {
    constexpr int along = 41, around = 12;
    const double wave = 0.5 * std::sin(0.7 * frame);
    auto shape = std::make_shared<Shape>();
    for (int i = 0; i < along; ++i)
      for (int k = 0; k < around; ++k) {
        const double x = 0.1 * i, angle = 2 * std::numbers::pi * k / around;
        shape->positions.emplace_back(x, 0.3 * std::cos(angle) + wave * x * x / 16, 0.3 * std::sin(angle));
      }
    for (int i = 0; i + 1 < along; ++i)
      for (int k = 0; k < around; ++k) {
        const auto at = [&](int a, int b) { return static_cast<Index>((i + a) * around + (k + b) % around); };
        const Index corners[] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        shape->faces.add(corners);
      }
    return std::shared_ptr<const Shape>(std::move(shape));
  };
  return out;
}

/// Holds one end of the tube; the handle is the other.
inline Layer tube_layer() {
  Layer layer;
  layer.settings = {{"nodes", 40.0, {}}};
  layer.fixed.push_back({SelectBox{Vec3(-1, -9, -9), Vec3(0.45, 9, 9)}, {}});
  HandleEdit handle;
  handle.points.what = SelectIndices{Shared<Index>({480, 481, 482, 483, 484, 485, 486, 487, 488, 489, 490, 491})};
  handle.motion.move = Vec3(0, 0, 0);
  layer.handles = {handle};
  return layer;
}

/// Where particle `id` is at a time in seconds: born at id / 192 s, it flies along an arc and spreads a little.
inline Vec3 arc_position(int id, double seconds) {
  const double age = seconds - id / 192.0, side = 0.1 * std::sin(2.4 * id), up = 0.1 * std::cos(3.1 * id);
  return {6 * age, 6 * age - 6 * age * age + up * (1 + age), side * (1 + age)};
}
inline Vec3 arc_velocity(int id, double seconds) {
  const double age = seconds - id / 192.0, side = 0.1 * std::sin(2.4 * id), up = 0.1 * std::cos(3.1 * id);
  return {6, 6 - 12 * age + up, side};
}

/// Eight particles are born each 24th of a second and live for 16 of them: ids, velocities. `fine`: frames in a 24th.
inline Sequence arc_stream(int frames, int fine = 1) {
  Sequence out;
  out.frames.clear();
  for (int f = 1; f <= frames * fine; ++f) out.frames.push_back(f);
  out.rate = 24.0 * fine;
  out.load = [fine](int frame) {
    const double seconds = frame / (24.0 * fine);
    auto shape = std::make_shared<Shape>();
    Attribute id, velocity;
    id.name = "id";
    id.fields = {"id"};
    id.kind = Kind::Id;
    id.type = Type::Int32;
    velocity.name = "velocity";
    velocity.fields = {"vx", "vy", "vz"};
    velocity.kind = Kind::Velocity;
    velocity.type = Type::Float32;
    velocity.components = 3;
    const int first = std::max(0, 8 * (frame - 16 * fine) / fine), last = 8 * frame / fine;
    id.values.resize(static_cast<std::size_t>(last - first) * id.row_size());
    velocity.values.resize(static_cast<std::size_t>(last - first) * velocity.row_size());
    for (int p = first; p < last; ++p) {
      const auto i = static_cast<std::size_t>(p - first);
      shape->positions.push_back(arc_position(p, seconds));
      id.set_number(i, 0, p);
      for (int c = 0; c < 3; ++c) velocity.set_number(i, c, arc_velocity(p, seconds)[c]);
    }
    shape->attributes = {id, velocity};
    return std::shared_ptr<const Shape>(std::move(shape));
  };
  return out;
}

/// A graph along the path of the longest-lived particle; its beginning is fixed, the stream's far end is the handle.
inline Layer path_layer(int every) {
  Layer layer;
  layer.settings = {{"neighbours", 3.0, {}}};
  layer.path = ParticlePath{};
  layer.path->every = every;
  layer.fixed.push_back({SelectBox{Vec3(-1, -1, -1), Vec3(0.8, 2, 1)}, {}, 16});
  HandleEdit handle;
  handle.points = {SelectBox{Vec3(2.6, -9, -9), Vec3(9, 9, 9)}, {}, 16};
  handle.motion.move = Vec3(0, 0, 0);
  layer.handles = {handle};
  return layer;
}

inline Vec3 velocity(const Shape& shape, std::size_t i) {
  const Attribute& v = *shape.find("velocity");
  return {v.number(i, 0), v.number(i, 1), v.number(i, 2)};
}

/// The row of a particle; the count of all where it is not there.
inline std::size_t row_of(const Shape& shape, int id) {
  const Attribute& ids = *shape.find("id");
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (ids.number(i, 0) == id) return i;
  return shape.size();
}

/// (after - before) / seconds of each particle that is in both.
inline std::map<int, Vec3> central_differences(const Shape& before, const Shape& after, double seconds) {
  std::map<int, Vec3> out;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const int id = static_cast<int>(before.find("id")->number(i, 0));
    const std::size_t j = row_of(after, id);
    if (j < after.size()) out[id] = (after.positions[j] - before.positions[i]) / seconds;
  }
  return out;
}

}  // namespace sinew::document
