// Straight distance against distance along the surface on real poses of a horse. In pose 10 legs stand beside each
// other and the head is at the neck, so straight influence joins what other poses take apart; the reference pose has
// its parts well apart. A rest pose is fitted to the others, whose vertices correspond, through every 28th vertex.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "deformers/graph.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"

namespace sinew {

namespace {

struct Fit {
  double to_rest = 0, to_pose = 0;  ///< edge rms of the result against the rest, and against the pose that was fitted
  double make = 0, solve = 0;       ///< seconds, the best of three
};

Fit fit(const std::shared_ptr<const Shape>& rest, const Shape& pose, bool surface) {
  constexpr std::size_t handles = 300;
  Constraints constraints;
  constraints.handles.emplace_back();
  for (std::size_t h = 0; h < handles; ++h) {
    const auto i = static_cast<Index>(h * rest->size() / handles);
    constraints.handles[0].points.push_back(i);
    constraints.handles[0].targets.push_back(pose.positions[i] + pose.origin - rest->origin);
  }
  GraphOptions options;
  options.nodes = 280;
  options.surface = surface;
  Fit out{0, 0, HUGE_VAL, HUGE_VAL};
  for (int run = 0; run < 3; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    const auto deformer = make_graph_deformer(rest, options);
    const auto made = std::chrono::steady_clock::now();
    const SolveReport report = deformer->solve(constraints, {});
    const auto solved = std::chrono::steady_clock::now();
    EXPECT_EQ(report.status, Status::Converged) << report.message;
    out.make = std::min(out.make, std::chrono::duration<double>(made - begin).count());
    out.solve = std::min(out.solve, std::chrono::duration<double>(solved - made).count());
    const std::vector<Vec3> bent = skin(*rest, deformer->weights(), deformer->pose()).positions;
    out.to_rest = quality_of(*rest, bent).edge_rms;
    out.to_pose = quality_of(pose, bent).edge_rms;
  }
  return out;
}

/// Sums over the other poses; prints a row for each.
std::pair<Fit, Fit> fit_all(const std::filesystem::path& folder, const std::string& rest_name) {
  const auto rest = io::read((folder / (rest_name + ".obj")).string());
  std::pair<Fit, Fit> sums;
  std::printf("rest %-11s | edge rms to rest  | edge rms to pose  | make + solve, ms\n", rest_name.c_str());
  std::printf("            pose | straight  surface | straight  surface | straight     surface      times\n");
  for (const std::string name : {"horse-poses", "1", "3", "5", "8", "10"}) {
    if (name == rest_name) continue;
    const auto pose = io::read((folder / (name + ".obj")).string());
    const Fit a = fit(rest, *pose, false), b = fit(rest, *pose, true);
    for (const auto& [sum, one] : {std::pair{&sums.first, &a}, std::pair{&sums.second, &b}}) {
      sum->to_rest += one->to_rest;
      sum->to_pose += one->to_pose;
      sum->make += one->make;
      sum->solve += one->solve;
    }
    std::printf("%16s | %8.4f %8.4f | %8.4f %8.4f | %4.0f + %4.0f  %4.0f + %4.0f  %5.2f\n", name.c_str(), a.to_rest,
                b.to_rest, a.to_pose, b.to_pose, 1e3 * a.make, 1e3 * a.solve, 1e3 * b.make, 1e3 * b.solve,
                (b.make + b.solve) / (a.make + a.solve));
  }
  std::printf("all together take %.2f times as long\n",
              (sums.second.make + sums.second.solve) / (sums.first.make + sums.first.solve));
  return sums;
}

}  // namespace

TEST(GraphHorse, WithItsLegsTogetherFollowsFarBetterAlongTheSurface) {
  SHARED_DATA(folder, "poses/sumner_horse");
  const auto [straight, surface] = fit_all(folder, "10");
  EXPECT_LT(surface.to_rest, 0.55 * straight.to_rest);
  EXPECT_LT(surface.to_pose, 0.7 * straight.to_pose);
}

TEST(GraphHorse, WithItsPartsApartFollowsNoWorseAlongTheSurface) {
  SHARED_DATA(folder, "poses/sumner_horse");
  const auto [straight, surface] = fit_all(folder, "horse-poses");
  EXPECT_LT(surface.to_rest, 0.95 * straight.to_rest);
  EXPECT_LT(surface.to_pose, straight.to_pose);
}

}  // namespace sinew
