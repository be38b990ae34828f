#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <vector>

#include "apps/samples/edits.h"
#include "apps/samples/fluid.h"
#include "apps/samples/streams.h"
#include "apps/samples/walk.h"
#include "engine/document/edit.h"
#include "engine/document/selection.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/topology.h"
#include "tests/apps/samples_figures.h"

namespace sinew::samples {

namespace {

using Frames = std::vector<Shape>;

template <class MakeFrames>
Frames frames_of(const MakeFrames& make, int count) {
  Frames frames;
  make(count, [&](int frame, const Shape& shape) {
    frames.push_back(shape);
    EXPECT_EQ(frame, static_cast<int>(frames.size()));
  });
  return frames;
}

const Frames& walk() {
  static const Frames frames = frames_of(make_walk, walk_cycle + 1);
  return frames;
}

const Frames& jet() {
  static const Frames frames = frames_of(make_jet, 72);
  return frames;
}

/// Rows of a particle stream by id.
std::map<double, std::size_t> rows_by_id(const Shape& shape) {
  std::map<double, std::size_t> rows;
  const Attribute& id = *shape.find("id");
  for (std::size_t i = 0; i < shape.size(); ++i) rows[id.number(i, 0)] = i;
  return rows;
}

Vec3 velocity_of(const Shape& shape, std::size_t i) {
  const Attribute& velocity = *shape.find("velocity");
  return {velocity.number(i, 0), velocity.number(i, 1), velocity.number(i, 2)};
}

Fluid::Settings settings_of_box(double side, double spacing) {
  Fluid::Settings settings;
  settings.spacing = spacing;
  settings.box.add(Vec3::Zero());
  settings.box.add(Vec3::Constant(side));
  return settings;
}

/// count^3 particles, `apart` from each other, from `corner` on.
void add_cube(Fluid& fluid, int count, double apart, const Vec3& corner) {
  for (int i = 0; i < count * count * count; ++i)
    fluid.add({corner + apart * Vec3(i % count, i / count % count, i / count / count), Vec3::Zero(),
               static_cast<std::uint32_t>(i), 0});
}

}  // namespace

TEST(Walk, FoalIsOneClosedMesh) {
  const Shape shape = foal();
  EXPECT_NEAR(double(shape.size()), 8431, 150);
  EXPECT_EQ(connected_components(shape).count, 1u);
  EXPECT_TRUE(quality_of(shape, shape.positions).closed);
  EXPECT_EQ(shape.size() - edges_of(shape.faces).size() + shape.faces.size(), 2u) << "Euler: no handles";
  EXPECT_GT(volume6(shape), 0);
}

TEST(Walk, VerticesMoveAndNothingTears) {
  const Shape rest = foal();
  for (const Shape& frame : walk()) {
    EXPECT_TRUE(all_finite(frame));
    ASSERT_EQ(frame.faces.points, rest.faces.points);
    const Quality quality = quality_of(rest, frame.positions);
    EXPECT_LT(quality.edge_rms, 0.15);
    EXPECT_LT(std::abs(quality.volume_change), 0.05);
  }
  EXPECT_EQ(walk().back().positions, walk().front().positions) << "a cycle";
}

TEST(Walk, FeetStandOnTheGroundAndTheHeadNods) {
  const Shape rest = foal();
  const auto muzzle =
      static_cast<std::size_t>(std::max_element(rest.positions.begin(), rest.positions.end(),
                                                [](const Vec3& a, const Vec3& b) { return a.x() < b.x(); }) -
                               rest.positions.begin());
  Bounds of_muzzle;
  for (const Shape& frame : walk()) {
    of_muzzle.add(frame.positions[muzzle]);
    // Each hoof apart: at least two stand, and none goes far below.
    int standing = 0;
    for (int hoof = 0; hoof < 4; ++hoof) {
      double lowest = 1;
      for (std::size_t i = 0; i < rest.size(); ++i) {
        const Vec3& p = rest.positions[i];
        if (p.y() < 0.05 && (p.x() > 0) == (hoof < 2) && (p.z() > 0) == (hoof % 2 == 0))
          lowest = std::min(lowest, frame.positions[i].y());
      }
      EXPECT_GT(lowest, -0.02);
      standing += lowest < 0.02;
    }
    EXPECT_GE(standing, 2);
    EXPECT_LE(standing, 4);
  }
  EXPECT_GT(of_muzzle.max.y() - of_muzzle.min.y(), 0.05);
}

TEST(Walk, MovesWithoutJerks) {
  const Frames& frames = walk();
  for (std::size_t i = 0; i < frames[0].size(); i += 7)
    for (std::size_t f = 1; f + 1 < frames.size(); ++f) {
      const Vec3 jerk = frames[f - 1].positions[i] - 2 * frames[f].positions[i] + frames[f + 1].positions[i];
      ASSERT_LT(jerk.norm(), 0.09) << "vertex " << i << ", frame " << f + 1;
    }
}

TEST(Walk, EditHasAKeyThatLengthensLegsAndNeck) {
  const document::Project edit = document::parse_edit("walk.edit.json", edit_of("walk"));
  ASSERT_EQ(edit.layers.size(), 1u);
  const document::Layer& layer = edit.layers[0];
  ASSERT_EQ(layer.keys.size(), 1u);
  EXPECT_EQ(layer.keys[0].frame, 1);
  ASSERT_EQ(layer.keys[0].handles.size(), layer.handles.size());
  for (std::size_t h = 0; h < layer.handles.size(); ++h)
    EXPECT_EQ(layer.keys[0].handles[h], layer.handles[h].motion) << "the still is edited as the pose with the key is";

  const Shape& first = walk().front();
  document::Selector selector(std::make_shared<const Shape>(first));
  const Constraints constraints = selector.constraints(layer, first.positions);
  ASSERT_EQ(constraints.handles.size(), 2u);
  // All four hooves are held, the one in the air too.
  std::array<bool, 4> held{};
  for (const Index i : constraints.fixed) {
    const Vec3& p = first.positions[i];
    EXPECT_LT(p.y(), 0.17);
    held[(p.x() > 0 ? 2u : 0u) + (p.z() > 0 ? 1u : 0u)] = true;
  }
  EXPECT_EQ(held, (std::array{true, true, true, true}));
  for (const Handle& handle : constraints.handles) {
    EXPECT_GT(handle.points.size(), 300u);
    for (std::size_t k = 0; k < handle.points.size(); ++k)
      ASSERT_GT(handle.targets[k].y(), first.positions[handle.points[k]].y() + 0.29);
  }
}

TEST(Fluid, AParticleFliesOnAParabola) {
  Fluid fluid(settings_of_box(100, 1));
  const Vec3 x(10, 50, 10), v(3, 4, 1);
  fluid.add({x, v, 7, 0});
  constexpr double dt = 1.0 / 240;
  std::vector<Particle> states;
  for (int step = 0; step < 100; ++step) {
    fluid.step();
    states.push_back(fluid.before_last_step()[0]);
  }
  for (std::size_t step = 1; step + 1 < states.size(); ++step) {
    const Vec3 central = (states[step + 1].x - states[step - 1].x) / (2 * dt);
    ASSERT_NEAR((central - states[step].v).norm(), 0, 1e-9);
    ASSERT_NEAR(states[step].age, double(step) * dt, 1e-12);
  }
  const double t = 99 * dt;
  EXPECT_NEAR((states.back().x - (x + t * v - 0.5 * 9.81 * t * t * Vec3::UnitY())).norm(), 0, 0.01);
  EXPECT_EQ(states.back().id, 7u);
}

TEST(Fluid, PressurePartsParticlesAndKeepsTheirMomentum) {
  Fluid fluid(settings_of_box(10, 0.1));
  constexpr int count = 5;
  add_cube(fluid, count, 0.085, Vec3::Constant(5));  // six tenths of the room that they need
  const auto mean = [](const std::vector<Particle>& particles) {
    Vec3 sum = Vec3::Zero();
    for (const Particle& particle : particles) sum += particle.x;
    return Vec3(sum / double(particles.size()));
  };
  fluid.step();
  const Vec3 before = mean(fluid.before_last_step());
  for (int step = 0; step < 60; ++step) fluid.step();
  const std::vector<Particle> particles = fluid.before_last_step();
  const Vec3 moved = mean(particles) - before;
  EXPECT_NEAR(moved.x(), 0, 1e-9);
  EXPECT_NEAR(moved.z(), 0, 1e-9);
  constexpr double dt = 1.0 / 240;
  EXPECT_NEAR(moved.y(), -9.81 * dt * dt * 60 * 61 / 2, 1e-9);
  double nearest = 1;
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, (particles[i].x - particles[j].x).norm());
  EXPECT_GT(nearest, 0.08);
}

TEST(Fluid, ComesToRestAtItsVolume) {
  Fluid::Settings settings = settings_of_box(1, 0.1);
  settings.viscosity = 0.1;
  Fluid fluid(settings);
  add_cube(fluid, 10, 0.099, Vec3::Constant(0.05));
  fluid.remove_if([](const Particle& particle) { return particle.x.y() > 0.5; });  // half full
  EXPECT_EQ(fluid.size(), 500u);
  for (int step = 0; step < 600; ++step) fluid.step();
  double speed = 0, height = 0;
  for (const Particle& particle : fluid.before_last_step()) {
    ASSERT_TRUE((particle.x.array() >= 0).all() && (particle.x.array() <= 1).all());
    speed += particle.v.norm() / 500;
    height += 2 * particle.x.y() / 500;
  }
  EXPECT_LT(speed, 0.1);
  EXPECT_NEAR(height, 0.5, 0.05);
}

TEST(Streams, JetHasAsManyParticlesAsThePapersFluid) {
  double sum = 0;
  std::size_t most = 0, least = 1u << 30;
  for (const Shape& frame : jet()) {
    EXPECT_TRUE(all_finite(frame));
    EXPECT_STREQ(representation(frame), "point cloud");
    EXPECT_EQ(frame.find("velocity")->kind, Kind::Velocity);
    EXPECT_EQ(frame.find("id")->kind, Kind::Id);
    sum += double(frame.size());
    most = std::max(most, frame.size());
    least = std::min(least, frame.size());
    for (const Vec3& p : frame.positions) ASSERT_GE(p.y(), 0);
  }
  EXPECT_NEAR(sum / double(jet().size()), 1070, 70);
  EXPECT_GT(most, least) << "the count changes";
}

TEST(Streams, ParticlesOfTheJetAreBornAndDieAndKeepTheirIds) {
  std::map<double, int> life;  // frames of each id
  double newest = -1;
  for (const Shape& frame : jet()) {
    const auto rows = rows_by_id(frame);
    ASSERT_EQ(rows.size(), frame.size()) << "each id once";
    std::size_t row = 0;
    for (const auto& [id, i] : rows) {
      ASSERT_EQ(i, row++) << "in the order of ids";
      ++life[id];
    }
    EXPECT_GT(rows.rbegin()->first, newest) << "some are born in every frame";
    newest = rows.rbegin()->first;
    EXPECT_LT(rows.begin()->first, newest - 800);
  }
  int longest = 0;
  for (const auto& [id, frames] : life) longest = std::max(longest, frames);
  EXPECT_NEAR(longest, 1.4 * 24, 1.5);
}

TEST(Streams, VelocitiesOfTheJetAreTheDerivativeOfItsPath) {
  std::vector<double> errors;
  for (std::size_t f = 1; f + 1 < jet().size(); ++f) {
    const Shape &last = jet()[f - 1], &now = jet()[f], &next = jet()[f + 1];
    const auto before = rows_by_id(last), after = rows_by_id(next);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double id = now.find("id")->number(i, 0);
      if (!before.contains(id) || !after.contains(id)) continue;
      const Vec3 a = last.positions[before.at(id)], b = next.positions[after.at(id)];
      if (a.y() < 0.15 || b.y() < 0.15) continue;  // in the air
      const Vec3 velocity = velocity_of(now, i);
      errors.push_back((0.5 * 24 * (b - a) - velocity).norm() / velocity.norm());
    }
  }
  ASSERT_GT(errors.size(), 20'000u);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.01);
  EXPECT_LT(errors[errors.size() * 9 / 10], 0.04);
}

TEST(Streams, AreTheSameForAnyNumberOfThreads) {
  const auto dam = [](int frames, const TakeFrame& take) { make_dam_break({25, 10, 15}, frames, take); };
  set_thread_count(1);
  const Frames one = frames_of(dam, 2);
  set_thread_count(3);
  const Frames three = frames_of(dam, 2);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_EQ(one[f].size(), 7500u);
    EXPECT_EQ(hash_of(one[f]), hash_of(three[f]));
  }
}

TEST(Streams, WaterOfADamBreakMeetsInTheMiddle) {
  const Frames frames = frames_of([](int n, const TakeFrame& take) { make_dam_break({20, 10, 10}, n, take); }, 3);
  for (const Shape& frame : frames) {
    ASSERT_EQ(frame.size(), 4000u);
    EXPECT_TRUE(all_finite(frame));
    std::size_t in_middle = 0;
    const double middle = 0.5 * 2.5 * 20 * 0.025;
    for (const Vec3& p : frame.positions) in_middle += std::abs(p.x() - middle) < 0.1;
    EXPECT_GT(in_middle, 300u);
  }
}

TEST(Motion, IsTheSameOnEveryMachine) {
  EXPECT_EQ(hash_of(foal()), 12041110660696799705u);
  EXPECT_EQ(hash_of(walk()[7]), 10178321206065396954u);
  EXPECT_EQ(hash_of(jet().front()), 17920527838343730767u);
  EXPECT_EQ(hash_of(jet().back()), 14634702207546976413u);
  EXPECT_EQ(hash_of(frames_of(
                [](int n, const TakeFrame& take) {
                  make_dam_break({20, 10, 10}, n, take);
                },
                1)[0]),
            3080572020954424497u);
}

}  // namespace sinew::samples
