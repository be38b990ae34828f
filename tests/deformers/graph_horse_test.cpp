// Straight distance against distance along the surface on a real horse, whose legs come close to each other and to the
// belly: the rest pose is fitted to other poses of the same mesh through a few hundred vertices.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "deformers/graph.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

struct Fit {
  double edges_to_rest = 0, edges_to_pose = 0, worst_edge = 0;  ///< edge rms, against the pose also the largest
  double points_to_pose = 0;                                     ///< rms distance, of the diagonal
  double make = 0, solve = 0;                                    ///< seconds, the best of three
};

Fit fit(const std::shared_ptr<const Shape>& rest, const Shape& pose, const GraphOptions& options, std::size_t handles) {
  Constraints constraints;
  constraints.handles.emplace_back();
  for (std::size_t h = 0; h < handles; ++h) {
    const auto i = static_cast<Index>(h * rest->size() / handles);
    constraints.handles[0].points.push_back(i);
    constraints.handles[0].targets.push_back(pose.positions[i] + pose.origin - rest->origin);
  }
  Fit out;
  out.make = out.solve = 1e9;
  for (int run = 0; run < 3; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    const auto deformer = make_graph_deformer(rest, options);
    const auto made = std::chrono::steady_clock::now();
    const SolveReport report = deformer->solve(constraints, {});
    const auto solved = std::chrono::steady_clock::now();
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    out.make = std::min(out.make, std::chrono::duration<double>(made - begin).count());
    out.solve = std::min(out.solve, std::chrono::duration<double>(solved - made).count());
    if (run > 0) continue;
    const std::vector<Vec3> bent = skin(*rest, deformer->weights(), deformer->pose()).positions;
    out.edges_to_rest = quality_of(*rest, bent).edge_rms;
    const Quality quality = quality_of(pose, bent);
    out.edges_to_pose = quality.edge_rms;
    out.worst_edge = quality.edge_max;
    printf("iters %d rms %g nodes %g edges %g\n", report.iterations, report.handle_rms, report.counts[1].second, report.counts[2].second);
  }
  return out;
}

}  // namespace

TEST(GraphHorse, FollowsPosesBetterAlongTheSurface) {
  SHARED_DATA(folder, "poses/sumner_horse");
  for (const char* from : {"horse-poses", "1","3","5","8","10"}) {
  const auto rest = io::read((folder / (std::string(from)+".obj")).string()); printf("FROM %s\n", from);
  const int nodes = getenv("N") ? atoi(getenv("N")) : 280, handles = getenv("H") ? atoi(getenv("H")) : 300;
  for (const char* name : {"horse-poses", "1", "3", "5", "8", "10"}) {
    const auto pose = io::read((folder / (std::string(name) + ".obj")).string());
    Quality q = quality_of(*rest, pose->positions);
    printf("pose %s own edge rms %.4f\n", name, q.edge_rms);
    for (const bool surface : {false, true}) {
      GraphOptions options;
      options.nodes = nodes;
      options.surface = surface; if (getenv("W")) options.w_con = atof(getenv("W")); if (getenv("G")) options.w_reg = atof(getenv("G")); if (getenv("K")) options.neighbours = atoi(getenv("K"));
      const Fit f = fit(rest, *pose, options, handles);
      printf("%s %d rest %.4f pose %.4f max %.2f make %.1f solve %.1f\n", name, surface, f.edges_to_rest, f.edges_to_pose, f.worst_edge, f.make*1e3, f.solve*1e3);
    }
  }}
}

}  // namespace sinew
