// Real closed meshes as solids: posed, and driven by captured motion.

#include <gtest/gtest.h>

#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/document/markers.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/error.h"
#include "engine/geometry/surface_fit.h"
#include "engine/io/io.h"
#include "tests/geometry/lobed_body.h"
#include "tests/shared_data.h"

namespace sinew::document {
namespace {

/// Its lower fifth along the longest axis held, its upper fifth turned by 40 degrees about that axis.
Layer twist(const Shape& shape) {
  const Bounds bounds = bounds_of(shape.positions);
  const Vec3 extent = bounds.max - bounds.min;
  int axis = 0;
  extent.maxCoeff(&axis);
  const Vec3 far = 2 * extent;
  Layer layer;
  layer.method = "tet";
  layer.settings.push_back({"vertices", 2000.0, {}});
  layer.settings.push_back({"close_holes", 100.0, {}});
  SelectBox low{bounds.min - far, bounds.max + far}, high = low;
  low.max[axis] = bounds.min[axis] + 0.2 * extent[axis];
  high.min[axis] = bounds.max[axis] - 0.2 * extent[axis];
  for (SelectBox* box : {&low, &high}) {
    box->min += shape.origin;
    box->max += shape.origin;
  }
  layer.fixed.push_back({low, {}});
  Motion motion;
  motion.rotate = Rotation{Vec3::Unit(axis), 40, std::nullopt};
  layer.handles.push_back({{high, {}}, motion, {}});
  return layer;
}

class RealSolids : public testing::TestWithParam<const char*> {};

TEST_P(RealSolids, KeepTheirVolumeWhenTwisted) {
  SHARED_DATA(data, "meshes");
  const auto shape = io::read((data / GetParam()).string());
  const std::vector<Layer> layers{twist(*shape)};
  const Evaluation bent = evaluate(shape, layers, methods(), {{}, true});
  const LayerReport& report = bent.reports[0];
  std::printf("%s: %d iterations, edge rms %.4f, volume %+.2f %%, handle rms %.2e\n", GetParam(),
              report.solve.iterations, report.quality.edge_rms, 100 * report.quality.volume_change, report.handle_rms);
  EXPECT_NE(report.solve.status, Status::Failed) << report.solve.message;
  EXPECT_LT(report.quality.edge_rms, 0.15);
  EXPECT_LT(std::abs(report.quality.volume_change), 0.05);
  EXPECT_LT(report.handle_rms, 0.01);
}

std::string name_of_mesh(const testing::TestParamInfo<const char*>& parameter) {
  std::string name = parameter.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Meshes, RealSolids,
                         testing::Values("armadillo.obj", "bunny.off", "horse_quad.obj", "cheburashka.off"),
                         name_of_mesh);

TEST(RealMotion, ADanceOfFortyMarkersDrivesABody) {
  SHARED_DATA(data, "mocap");
  const auto body = io::read((data.parent_path() / "meshes" / "armadillo.obj").string());
  Layer layer;
  layer.method = "tet";
  layer.settings.push_back({"vertices", 1500.0, {}});
  layer.markers = MarkersEdit{};
  layer.markers->path = (data / "c3d" / "Dance.c3d").string();
  layer.markers->corresponding = true;
  const std::pair<const char*, Vec3> matches[] = {
      {"Channel101", {0.03, 0.33, -0.12}},  {"Channel103", {-0.04, 0.33, 0.1}},   {"Channel110", {0, 0.15, 0.12}},
      {"Channel163", {0, 0.12, -0.2}},      {"Channel113", {-0.08, -0.12, 0}},    {"Channel159", {0.05, -0.12, -0.19}},
      {"Channel117", {-0.16, 0.23, -0.05}}, {"Channel118", {-0.29, 0.12, -0.05}}, {"Channel125", {-0.35, 0.22, 0.1}},
      {"Channel156", {0.16, 0.23, -0.05}},  {"Channel154", {0.28, 0.12, 0}},      {"Channel145", {0.33, 0.22, 0.2}},
      {"Channel123", {-0.2, -0.3, -0.02}},  {"Channel129", {-0.22, -0.55, 0.02}}, {"Channel150", {0.22, -0.3, -0.01}},
      {"Channel141", {0.27, -0.55, 0.04}}};
  for (const auto& [name, place] : matches) layer.markers->matches.push_back({name, place, {}});
  const std::vector<Layer> layers{layer};
  const auto still = sinew::still(body);
  const auto frames = std::make_shared<const Sequence>(with_frames_of_markers(still, layers));
  EXPECT_EQ(frames->frames.size(), 499u);
  Workspace workspace(frames, methods());
  for (const int frame : {1, 200, 400}) {
    const Evaluation bent = evaluate(workspace, layers, frame, {{}, true});
    EXPECT_NE(bent.reports[0].solve.status, Status::Failed);
    EXPECT_LT(bent.reports[0].handle_rms, 1e-3) << frame;
    EXPECT_GT(bent.reports[0].handle_rms, 0) << frame;
    EXPECT_LT(bent.reports[0].quality.edge_rms, 0.4) << frame;
  }
}

TEST(RealMotion, ADancerIsNotLaidOnABodyThatStandsInAnotherPose) {
  SHARED_DATA(data, "mocap");
  const auto body = io::read((data.parent_path() / "meshes" / "armadillo.obj").string());
  MarkersEdit edit;
  edit.path = (data / "c3d" / "Dance.c3d").string();
  for (const int first : {1, 100, 200, 300, 400}) {
    edit.first = first;
    try {
      const Markers markers(edit, *body);
      ADD_FAILURE() << first << ": " << markers.notes().back();
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("markers of which 85 % come near the shape"), std::string::npos)
          << error.what();
    }
  }
}

TEST(RealMotion, MarkersOnARealBodyAreLaidOnItAgain) {
  SHARED_DATA(data, "meshes");
  for (const char* name : {"armadillo.obj", "horse_quad.obj", "bunny.off"}) {
    const auto body = io::read((data / name).string());
    const double diagonal = bounds_of(body->positions).diagonal();
    std::size_t right = 0;
    constexpr std::size_t rounds = 5;
    for (std::uint64_t seed = 1; seed <= rounds; ++seed) {
      const std::vector<Vec3> places = test::places_on(*body, 40, seed);
      std::vector<Vec3> captured;
      for (const Vec3& p : places) captured.push_back(1000 * Vec3(p.z(), p.x(), p.y()) + Vec3(30, -20, 100));
      const auto fit = fit_to_surface(captured, *body, std::nullopt);
      ASSERT_TRUE(fit.has_value());
      double most = 0;
      for (std::size_t i = 0; i < places.size(); ++i)
        most = std::max(most, (fit->map(captured[i]) - places[i]).norm() / diagonal);
      if (most < 2e-4) ++right;
    }
    EXPECT_EQ(right, rounds) << name;
  }
}

}  // namespace
}  // namespace sinew::document
