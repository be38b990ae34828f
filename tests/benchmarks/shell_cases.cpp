#include "tests/benchmarks/shell_cases.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "apps/samples/foal.h"
#include "apps/samples/poses.h"
#include "deformers/shell_pose.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "engine/io/poses.h"
#include "tests/shared_folder.h"

namespace sinew::benchmarks {

ShellPoses posed_foal(double cell) {
  ShellPoses out{"foal", std::make_shared<Shape>(samples::foal(cell)), {}, {}};
  for (samples::NamedShape& pose : samples::foal_poses(cell)) {
    out.names.push_back(pose.name);
    out.poses.push_back(std::make_shared<Shape>(std::move(pose.shape)));
  }
  return out;
}

std::optional<ShellPoses> poses_of_data(const std::string& name) {
  const std::filesystem::path folder = shared_folder() / "data" / "poses" / ("sumner_" + name);
  const std::filesystem::path rest = folder / (name + "-poses.obj");
  if (!std::filesystem::exists(rest)) return std::nullopt;
  ShellPoses out{name, io::read(rest.string()), {}, {}};
  for (const io::NamedPose& pose : io::read_poses(folder.string())) {
    if (pose.path == rest.string()) continue;
    auto shape = std::make_shared<Shape>(*pose.shape);
    for (Vec3& p : shape->positions) p += shape->origin - out.rest->origin;
    shape->origin = out.rest->origin;
    out.names.push_back(pose.name);
    out.poses.push_back(std::move(shape));
  }
  return out;
}

std::vector<std::vector<Index>> patches_along(const Shape& shape, std::size_t count, std::size_t size) {
  std::vector<std::vector<Index>> neighbours(shape.size());
  for (const auto& [a, b] : edges_of(shape.faces)) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  std::vector<double> to_centres(shape.size(), INFINITY);
  std::vector<std::vector<Index>> out;
  Index centre = 0;
  for (std::size_t patch = 0; patch < count; ++patch) {
    std::vector<double> distance(shape.size(), INFINITY);
    std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> open;
    open.emplace(distance[centre] = 0, centre);
    std::vector<Index>& nearest = out.emplace_back();
    while (!open.empty()) {
      const auto [d, v] = open.top();
      open.pop();
      if (d > distance[v]) continue;
      if (nearest.size() < size) nearest.push_back(v);
      for (const Index w : neighbours[v]) {
        const double further = d + (shape.positions[v] - shape.positions[w]).norm();
        if (further < distance[w]) open.emplace(distance[w] = further, w);
      }
    }
    for (Index v = 0; v < shape.size(); ++v) to_centres[v] = std::min(to_centres[v], distance[v]);
    centre = static_cast<Index>(std::max_element(to_centres.begin(), to_centres.end()) - to_centres.begin());
  }
  return out;
}

Case held_foal(std::shared_ptr<const Shape> foal) {
  Case c;
  c.diagonal = bounds_of(foal->positions).diagonal();
  Handle handle;
  for (Index i = 0; i < foal->size(); ++i) {
    const Vec3& p = foal->positions[i];
    if (p.y() < 0.03) c.constraints.fixed.push_back(i);
    if ((p - Vec3(0.96, 1.1, 0)).norm() > 0.05) continue;
    handle.points.push_back(i);
    handle.targets.push_back(p);
  }
  c.shape = std::move(foal);
  c.constraints.handles.push_back(std::move(handle));
  return c;
}

std::vector<Triangle> triangle_list(const Shape& shape) {
  const std::vector<Index> corners = triangles_of(shape.faces);
  std::vector<Triangle> out;
  for (std::size_t c = 0; c < corners.size(); c += 3) out.push_back({corners[c], corners[c + 1], corners[c + 2]});
  return out;
}

double hausdorff(std::span<const Vec3> a, std::span<const Vec3> b, const std::vector<Triangle>& triangles) {
  double out = 0;
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
    for (const ShellSurface::Foot& foot : ShellSurface({to.begin(), to.end()}, triangles).feet(from))
      out = std::max(out, foot.distance);
  return out;
}

double rms_between(std::span<const Vec3> a, std::span<const Vec3> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.size()));
}

std::vector<Vec3> bent_by(const Deformer& deformer, const Shape& shape) {
  return skin(shape, deformer.weights(), deformer.pose()).positions;
}

}  // namespace sinew::benchmarks
