// The minimum of the solid's energy against an independent implementation in numpy, where that is at hand, on the same
// tets.

#include <gtest/gtest.h>

#include <unistd.h>

#include "deformers/tet.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "tests/deformers/botsch_sorkine.h"
#include "tests/shared_data.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

/// NAME.node and NAME.ele.
void write_tets(const fs::path& base, const TetMesh& mesh) {
  std::ofstream nodes(base.string() + ".node"), tets(base.string() + ".ele");
  nodes.precision(17);
  nodes << mesh.vertices.size() << " 3 0 0\n";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) nodes << v << ' ' << mesh.vertices[v].transpose() << '\n';
  tets << mesh.tets.size() << " 4 0\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    tets << t;
    for (const Index v : mesh.tets[t]) tets << ' ' << v;
    tets << '\n';
  }
}

TEST(TetOracle, TheCactusEndsAtTheSameMinimum) {
  SHARED_DATA(data, "deform_benchmark");
  const fs::path script = shared_folder() / "reference" / "tet.py";
  if (!fs::exists(script)) GTEST_SKIP() << "no reference implementation";
  if (!test::has_numpy()) GTEST_SKIP() << "python3 with numpy and scipy is not installed";

  const test::Case c = test::read_case(data / "cactus");
  std::vector<std::string> notes;
  TetOptions options;
  options.mesh.vertices = 10000;
  const std::optional<TetMesh> mesh = tetrahedralized(*c.shape, options.mesh, notes);
  ASSERT_TRUE(mesh.has_value());
  ASSERT_EQ(mesh->vertices.size(), c.shape->size());

  // The reference asks a program named tetgen for tets: one of ours hands it these.
  const fs::path folder = fs::temp_directory_path() / ("sinew-tet-oracle-" + std::to_string(getpid()));
  fs::create_directories(folder);
  TetMesh in_order = *mesh;  // the reference takes vertices in the order of the points
  for (std::size_t v = 0; v < mesh->vertices.size(); ++v)
    in_order.vertices[mesh->points[v]] = mesh->vertices[v] + c.shape->origin;
  for (Tet& tet : in_order.tets)
    for (Index& v : tet) v = mesh->points[v];
  write_tets(folder / "tets", in_order);
  {
    std::ofstream fake(folder / "tetgen");
    fake << "#!/bin/sh\ncp " << (folder / "tets.node").string() << " \"${2%.smesh}.1.node\"\ncp "
         << (folder / "tets.ele").string() << " \"${2%.smesh}.1.ele\"\n";
  }
  fs::permissions(folder / "tetgen", fs::perms::owner_all);
  const std::string printed =
      test::output_of("PATH=" + folder.string() + ":$PATH PYTHONPATH=" + script.parent_path().string() + " " +
                      test::python + " " + script.string() + " " + (data / "cactus").string() + " --iterations 400");
  fs::remove_all(folder);
  const std::size_t line = printed.rfind("400: E ");
  ASSERT_NE(line, std::string::npos) << printed;
  double energy = 0;
  ASSERT_EQ(std::sscanf(printed.c_str() + line, "400: E %lf", &energy), 1) << printed;

  options.solid = nullptr;
  const auto deformer = make_tet_deformer(c.shape, options);
  const SolveReport report = deformer->solve(c.constraints, {});
  EXPECT_EQ(report.status, Status::Converged);
  const double diagonal = bounds_of(c.shape->positions).diagonal();
  const double ours = report.energy.front().second * diagonal * diagonal * diagonal;
  const Quality quality = quality_of(*c.shape, skin(*c.shape, deformer->weights(), deformer->pose()).positions);
  std::printf("cactus: energy %.9f after %d iterations, reference %.9f after 400; edge rms %.4f volume %+.2f %%\n",
              ours, report.iterations, energy, quality.edge_rms, 100 * quality.volume_change);
  EXPECT_LE(ours, energy * (1 + 1e-4));
  EXPECT_GT(ours, energy * (1 - 1e-2));  // the reference's tail is long
}

}  // namespace
}  // namespace sinew
