/// The splash of the shared data, bent along its path: ids and counts stay, velocities are those of the bent motion.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "tests/document/moving.h"
#include "tests/shared_data.h"
#include "tests/usda_points.h"

namespace sinew::document {

namespace {

/// Frames 101 to 108 as files; `shift` seconds later or earlier each particle flies on along its velocity.
Sequence splash(const std::filesystem::path& folder, double shift = 0) {
  Sequence out;
  out.frames.clear();
  for (int frame = 101; frame <= 108; ++frame) out.frames.push_back(frame);
  out.load = [folder, shift](int frame) {
    auto shape =
        std::make_shared<Shape>(*read_usda_points(folder / ("Particles_Splash." + std::to_string(frame) + ".usd")));
    for (std::size_t i = 0; shift != 0 && i < shape->size(); ++i) shape->positions[i] += shift * velocity(*shape, i);
    return std::shared_ptr<const Shape>(shape);
  };
  return out;
}

/// Holds where the stream begins, and pulls its far end aside.
Layer pull(const Shape& last) {
  const Bounds bounds = bounds_of(last.positions);
  int axis = 0;
  (bounds.max - bounds.min).maxCoeff(&axis);
  const double length = bounds.max[axis] - bounds.min[axis];
  SelectBox low{bounds.min + last.origin, bounds.max + last.origin}, high = low;
  low.max[axis] = low.min[axis] + 0.15 * length;
  high.min[axis] = high.max[axis] - 0.15 * length;
  Layer layer;
  layer.settings = {{"neighbours", 3.0, {}}};
  layer.path = ParticlePath{};
  layer.fixed.push_back({low, {}, 108});
  HandleEdit handle;
  handle.points = {high, {}, 108};
  handle.motion.move = Vec3(0.3 * length * Vec3::Unit((axis + 1) % 3));
  layer.handles = {handle};
  return layer;
}

}  // namespace

TEST(RealStreams, TheSplashIsBentAndItsVelocitiesWithIt) {
  SHARED_DATA(folder, "particles/usd_splash");
  const auto input = std::make_shared<const Sequence>(splash(folder));
  const std::vector<Layer> layers{pull(*input->load(108))};
  // The same field of maps a moment before and after: what the bent particles do in between is their velocity.
  constexpr double moment = 1e-4;
  const auto before = std::make_shared<const Sequence>(splash(folder, -moment));
  const auto after = std::make_shared<const Sequence>(splash(folder, moment));
  std::vector<Layer> same = layers;
  Workspace workspace(input, methods());
  const UpdateResult solved = workspace.update(layers, {});
  Deformer& deformer = const_cast<Deformer&>(*workspace.deformer(0));

  for (const int frame : {102, 105, 108}) {
    const std::shared_ptr<const Shape> rest = input->load(frame);
    const Evaluation bent = evaluate(workspace, layers, frame);
    ASSERT_EQ(bent.shape->size(), rest->size());
    EXPECT_TRUE(bent.shape->find("id")->values == rest->find("id")->values);
    const auto at = [&](const Sequence& sequence) {
      std::vector<Vec3> points = sequence.load(frame)->positions;
      const Vec3 shift = sequence.load(frame)->origin - bent.shape->origin;
      for (Vec3& p : points) p += shift;
      skin_points(deformer.bind(points, Gradients::No), *solved.layers[0].pose, points, points);
      return points;
    };
    const std::vector<Vec3> p = at(*before), q = at(*after);
    double error = 0, plain = 0, size = 0, moved = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3 difference = (q[i] - p[i]) / (2 * moment);
      error += (velocity(*bent.shape, i) - difference).squaredNorm();
      plain += (velocity(*rest, i) - difference).squaredNorm();
      size += difference.squaredNorm();
      moved = std::max(moved, (bent.shape->positions[i] - rest->positions[i]).norm());
    }
    EXPECT_LT(std::sqrt(error / size), 0.01) << frame;
    RecordProperty("velocity_error_" + std::to_string(frame), std::to_string(std::sqrt(error / size)));
    if (frame == 108) EXPECT_GT(std::sqrt(plain / size), 0.02) << "the edit is too small to tell";
    EXPECT_GT(moved, 0) << frame;
  }
}

}  // namespace sinew::document
