// The minimum of the graph's energy against an independent implementation in numpy, where that is at hand.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "deformers/graph.h"
#include "deformers/graph_weights.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

namespace fs = std::filesystem;

/// A Botsch-Sorkine case: NAME.off, NAME.sel (0 fixed, 2 handle), NAME.def (4x4 of the handle).
struct Case {
  std::shared_ptr<const Shape> shape;
  Constraints constraints;
};

std::vector<double> numbers_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<double> out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    for (double x; words >> x;) out.push_back(x);
  }
  return out;
}

Case read_case(const fs::path& base) {
  Case c{io::read(base.string() + ".off"), {}};
  const std::vector<double> labels = numbers_of(base.string() + ".sel"), m = numbers_of(base.string() + ".def");
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> motion(m.data());
  Handle handle;
  for (Index i = 0; i < c.shape->size(); ++i) {
    if (labels[i] == 0) c.constraints.fixed.push_back(i);
    if (labels[i] != 2) continue;
    const Vec3 p = c.shape->positions[i] + c.shape->origin;
    handle.points.push_back(i);
    handle.targets.push_back(motion.topLeftCorner<3, 3>() * p + motion.topRightCorner<3, 1>() - c.shape->origin);
  }
  c.constraints.handles.push_back(std::move(handle));
  return c;
}

/// `count` points, each the farthest from those before, from point 0.
std::vector<Index> farthest_points(const Shape& shape, std::size_t count) {
  std::vector<Index> nodes{0};
  std::vector<double> distance(shape.size(), HUGE_VAL);
  while (nodes.size() < count) {
    for (std::size_t i = 0; i < shape.size(); ++i)
      distance[i] = std::min(distance[i], (shape.positions[i] - shape.positions[nodes.back()]).norm());
    nodes.push_back(static_cast<Index>(std::max_element(distance.begin(), distance.end()) - distance.begin()));
  }
  return nodes;
}

/// What a command prints; empty where it fails.
std::string output_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return out;
  char buffer[256];
  while (std::fgets(buffer, sizeof(buffer), pipe) != nullptr) out += buffer;
  return pclose(pipe) == 0 ? out : std::string();
}

std::string case_name(const testing::TestParamInfo<std::string>& parameter) {
  return parameter.param;
}

class GraphOracle : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(GraphOracle, TheSameMinimumWithTheSameNodes) {
  SHARED_DATA(data, "deform_benchmark");
  const fs::path reference = shared_folder() / "reference";
  if (!fs::exists(reference / "graph.py")) GTEST_SKIP() << "no reference implementation";
  const std::string python = "/usr/bin/python3";
  if (output_of(python + " -c 'import numpy, scipy; print(1)' 2>/dev/null").empty())
    GTEST_SKIP() << "python3 with numpy and scipy is not installed";

  const Case c = read_case(data / GetParam());
  GraphOptions options;
  options.given = farthest_points(*c.shape, 300);
  const auto deformer = make_graph_deformer(c.shape, options);
  const SolveReport report = deformer->solve(c.constraints, {});
  EXPECT_EQ(report.status, Status::Converged);
  const Quality quality = quality_of(*c.shape, skin(*c.shape, deformer->weights(), deformer->pose()).positions);

  const fs::path folder = fs::temp_directory_path() / ("sinew-oracle-" + GetParam());
  fs::create_directories(folder);
  {
    std::ofstream nodes(folder / "nodes"), weights(folder / "weights"), edges(folder / "edges");
    weights.precision(9);
    for (const Index i : options.given) nodes << i << '\n';
    const SkinWeights& w = deformer->weights();
    for (std::size_t i = 0; i < w.size(); ++i)
      for (std::uint64_t e = w.offsets[i]; e < w.offsets[i + 1]; ++e)
        weights << i << ' ' << w.maps[e] << ' ' << w.weights[e] << '\n';
    for (const auto& [j, k] : deformer->structure().edges) edges << j << ' ' << k << '\n';
  }
  const std::string arguments = reference.string() + " " + (data / GetParam()).string() + " " +
                                (folder / "nodes").string() + " " + (folder / "weights").string() + " " +
                                (folder / "edges").string();
  const std::string printed = output_of(python + " " SINEW_SOURCE_DIR "/tests/deformers/graph_oracle.py " + arguments);
  fs::remove_all(folder);
  int iterations = 0;
  double energy = 0;
  ASSERT_EQ(std::sscanf(printed.c_str(), "%d %lf", &iterations, &energy), 2) << printed;
  const double ours = report.energy.front().second;
  std::printf(
      "%s: energy %.9f, reference %.9f (%d iterations); edge rms %.4f max %.3f volume %+.2f %% handle rms %.1e\n",
      GetParam().c_str(), ours, energy, iterations, quality.edge_rms, quality.edge_max, 100 * quality.volume_change,
      report.handle_rms);
  EXPECT_NEAR(ours, energy, 1e-6 * energy);
}

INSTANTIATE_TEST_SUITE_P(BotschSorkine, GraphOracle, testing::Values("bar", "cactus"), case_name);

}  // namespace sinew
