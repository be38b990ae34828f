// The minimum of the graph's energy against an independent implementation in numpy, where that is at hand.

#include <gtest/gtest.h>

#include <algorithm>

#include "deformers/graph.h"
#include "deformers/graph_weights.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "tests/deformers/botsch_sorkine.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

using test::Case;
using test::output_of;
namespace fs = std::filesystem;

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

std::string case_name(const testing::TestParamInfo<std::string>& parameter) {
  return parameter.param;
}

class GraphOracle : public testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(GraphOracle, TheSameMinimumWithTheSameNodes) {
  SHARED_DATA(data, "deform_benchmark");
  const fs::path reference = shared_folder() / "reference";
  if (!fs::exists(reference / "graph.py")) GTEST_SKIP() << "no reference implementation";
  if (!test::has_numpy()) GTEST_SKIP() << "python3 with numpy and scipy is not installed";

  const Case c = test::read_case(data / GetParam());
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
  const std::string printed =
      output_of(test::python + std::string(" ") + SINEW_SOURCE_DIR "/tests/deformers/graph_oracle.py " + arguments);
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
