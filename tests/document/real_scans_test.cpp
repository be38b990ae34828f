// Real scans, from file to bent file: only positions and normals may differ, and the handles are reached.

#include <gtest/gtest.h>

#include <filesystem>

#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/bounds.h"
#include "engine/io/io.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::document {

namespace {

namespace fs = std::filesystem;

/// The lowest fifth along the longest side is fixed, the highest twentieth (tips of ears, a head) leans over.
Layer lean(const Shape& shape) {
  const Bounds bounds = bounds_of(shape.positions);
  Eigen::Index axis = 1;
  (bounds.max - bounds.min).maxCoeff(&axis);
  if (!shape.parts.empty()) axis = 1;  // the bunny stands on y = 0 once its scans are together
  const double length = bounds.max[axis] - bounds.min[axis];
  const auto box = [&](double from, double to) {
    SelectBox out{bounds.min + shape.origin, bounds.max + shape.origin};
    out.min[axis] = bounds.min[axis] + from * length + shape.origin[axis];
    out.max[axis] = bounds.min[axis] + to * length + shape.origin[axis];
    return Selection{out, {}};
  };
  Layer layer;
  layer.fixed.push_back(box(0, 0.3));
  HandleEdit handle;
  handle.points = box(0.95, 1);
  Rotation rotation;
  rotation.axis = Vec3::Unit((axis + 1) % 3);
  rotation.degrees = 10;
  handle.motion.rotate = rotation;
  handle.motion.move = 0.05 * bounds.diagonal() * Vec3::Unit((axis + 2) % 3);
  layer.handles.push_back(handle);
  return layer;
}

void expect_only_positions_and_normals_differ(const Shape& before, const Shape& after) {
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after.position_type, before.position_type);
  EXPECT_EQ(after.faces.points, before.faces.points);
  EXPECT_EQ(after.faces.offsets, before.faces.offsets);
  ASSERT_EQ(after.attributes.size(), before.attributes.size());
  for (std::size_t a = 0; a < before.attributes.size(); ++a) {
    EXPECT_EQ(after.attributes[a].name, before.attributes[a].name);
    EXPECT_EQ(after.attributes[a].type, before.attributes[a].type);
    if (before.attributes[a].kind != Kind::Normal) {
      EXPECT_EQ(after.attributes[a].values, before.attributes[a].values) << before.attributes[a].name;
    }
  }
}

double largest_distance(const Shape& a, const Shape& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a.positions[i].allFinite())
      largest = std::max(largest, (a.positions[i] + a.origin - b.positions[i] - b.origin).norm());
  return largest;
}

class RealScans : public testing::TestWithParam<std::string> {};

std::string case_name(const testing::TestParamInfo<std::string>& parameter) {
  std::string name = fs::path(parameter.param).filename();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

}  // namespace

TEST_P(RealScans, AreReadBentAndWritten) {
  SHARED_DATA(path, "scans/" + GetParam());
  const auto before = io::read(path.string());
  const double diagonal = bounds_of(before->positions).diagonal();
  std::vector<Layer> layers = {lean(*before)};
  // The paper's weight of 100 leaves single points at the border of a handle 1.4e-3 away (rms 2e-4).
  if (GetParam().starts_with("stanford")) layers[0].settings.push_back({"constraint", 1000.0, {}});
  const Evaluation bent = evaluate(before, layers, methods());
  const LayerReport& report = bent.reports.at(0);
  EXPECT_EQ(report.solve.status, Status::Converged) << report.solve.message;
  std::printf("handles within %.1e of the diagonal (rms %.1e), %d iterations\n", report.handle_max, report.handle_rms,
              report.solve.iterations);
  EXPECT_LT(report.handle_max, GetParam().starts_with("stanford") ? 1e-3 : 1e-2);

  const TemporaryFolder folder;
  const bool set = !before->parts.empty();
  const std::string out = folder.path() / (set ? "merged.ply" : "bent" + path.extension().string());
  io::write(out, *bent.shape);
  const auto after = io::read(out);
  EXPECT_GT(largest_distance(*before, *after), 0.04 * diagonal);
  EXPECT_LT(largest_distance(*bent.shape, *after), 1e-6 * diagonal);
  if (!set) {
    expect_only_positions_and_normals_differ(*before, *after);
    return;
  }
  // Back to one file a scan, each in its own frame: read through the set again, it is the bent one.
  io::write_parts(folder.path() / "parts", *bent.shape);
  const auto again = io::read(folder.path() / "parts" / path.filename());
  expect_only_positions_and_normals_differ(*before, *again);
  EXPECT_LT(largest_distance(*bent.shape, *again), 1e-6 * diagonal);
}

INSTANTIATE_TEST_SUITE_P(
    All, RealScans,
    testing::Values("stanford_bunny/bun.conf", "stanford_bunny/bun000.ply", "stanford_bunny/bun045.ply",
                    "stanford_bunny/bun090.ply", "stanford_bunny/bun315.ply", "meshlab_rangemaps/lato000.ply",
                    "pcl_scenes/lamppost.pcd", "pcl_scenes/room_scan1.pcd", "pcl_scenes/room_scan2.pcd",
                    "pcl_small/colored_cloud.pcd", "pcl_small/pcl_logo.pcd",
                    "pcl_template_alignment/object_template_0.pcd", "pcl_template_alignment/object_template_2.pcd",
                    "pcl_template_alignment/object_template_4.pcd", "pcl_template_alignment/person.pcd"),
    case_name);

}  // namespace sinew::document
