// The minimum of the shell's energy against an independent implementation in numpy, where that is at hand, and against
// minima known from it.

#include <gtest/gtest.h>

#include <unistd.h>

#include "deformers/shell.h"
#include "engine/geometry/topology.h"
#include "tests/deformers/botsch_sorkine.h"
#include "tests/deformers/shell_shapes.h"
#include "tests/shared_data.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

ShellOptions all_vertices() {
  ShellOptions options;
  options.vertices = 0;
  return options;
}

/// NAME.off, NAME.sel and NAME.def as the reference reads them: a cylinder bent by a quarter.
void write_case(const fs::path& base, const Shape& shape, const Eigen::Matrix4d& motion) {
  std::ofstream off(base.string() + ".off"), labels(base.string() + ".sel"), matrix(base.string() + ".def");
  off.precision(17);
  off << "OFF\n" << shape.size() << ' ' << shape.faces.size() << " 0\n";
  for (const Vec3& p : shape.positions) off << p.transpose() << '\n';
  for (std::size_t f = 0; f < shape.faces.size(); ++f)
    off << "3 " << shape.faces[f][0] << ' ' << shape.faces[f][1] << ' ' << shape.faces[f][2] << '\n';
  labels << "# labels\n# of points\n";
  const test::Ends ends = test::ends_of(shape);
  std::vector<int> label(shape.size(), 1);
  for (const Index i : ends.low) label[i] = 0;
  for (const Index i : ends.high) label[i] = 2;
  for (const int l : label) labels << l << '\n';
  matrix.precision(17);
  matrix << motion << '\n';
}

TEST(ShellOracle, ASmallCylinderEndsAtTheSameMinimum) {
  const fs::path script = shared_folder() / "reference" / "shell.py";
  if (!fs::exists(script)) GTEST_SKIP() << "no reference implementation";
  if (!test::has_numpy()) GTEST_SKIP() << "python3 with numpy and scipy is not installed";
  const auto shape = test::small_cylinder();
  const fs::path folder = fs::temp_directory_path() / ("sinew-shell-oracle-" + std::to_string(getpid()));
  fs::create_directories(folder);
  Eigen::Matrix4d motion = Eigen::Matrix4d::Identity();
  motion.topLeftCorner<3, 3>() = Eigen::AngleAxisd(-1.2, Vec3::UnitZ()).toRotationMatrix();
  motion.topRightCorner<3, 1>() = Vec3(-0.3, 0.3, 0);
  write_case(folder / "cylinder", *shape, motion);
  const std::string printed = test::output_of("PYTHONPATH=" + script.parent_path().string() + " " + test::python + " " +
                                              script.string() + " " + (folder / "cylinder").string());
  fs::remove_all(folder);
  int iterations = 0;
  double energy = 0;
  ASSERT_EQ(std::sscanf(printed.c_str(), "%d iterations, energy %lf", &iterations, &energy), 2) << printed;

  const auto deformer = make_shell_deformer(shape, {}, all_vertices());
  const SolveReport report = deformer->solve(
      test::moved_end(
          *shape,
          [&](const Vec3& p) { return Vec3(motion.topLeftCorner<3, 3>() * p + motion.topRightCorner<3, 1>()); }),
      {});
  EXPECT_EQ(report.status, Status::Converged);
  // The reference stops sooner.
  EXPECT_LE(report.energy[0].second, energy * (1 + 1e-6));
  EXPECT_GE(report.energy[0].second, energy * (1 - 1e-2));
}

TEST(ShellOracle, TheCactusEndsAtTheMinimumThatIsKnown) {
  SHARED_DATA(data, "deform_benchmark");
  const test::Case c = test::read_case(data / "cactus");
  const auto deformer = make_shell_deformer(c.shape, {}, all_vertices());
  const SolveReport report = deformer->solve(c.constraints, {});
  EXPECT_EQ(report.status, Status::Converged);
  // The reference finds 95.11 along another way; there are several minima side by side.
  EXPECT_NEAR(report.energy[0].second, 95.11, 0.2);
  const Quality quality = quality_of(*c.shape, test::bent(*c.shape, *deformer));
  EXPECT_NEAR(quality.edge_rms, 0.005, 0.0005);
  EXPECT_NEAR(quality.volume_change, -0.117, 0.002);
}

}  // namespace
}  // namespace sinew
