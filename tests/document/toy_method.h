#pragma once
/// A method for tests: one map, a translation, that moves half way to the mean motion of the handles at each iteration.

#include <chrono>
#include <span>
#include <thread>

#include "engine/geometry/deformer.h"
#include "engine/geometry/error.h"

namespace sinew {

class ToyDeformer : public Deformer {
 public:
  ToyDeformer(std::shared_ptr<const Shape> rest, double pause) : rest_(std::move(rest)), pause_(pause) {
    weights_ = bind_all(rest_->positions);
  }
  const SkinWeights& weights() const override { return weights_; }
  SkinWeights bind(std::span<const Vec3> points, Gradients) const override { return bind_all(points); }
  void follow(std::shared_ptr<const Shape> rest) override { rest_ = std::move(rest); }
  std::vector<double> map_energy() const override { return {0}; }
  std::unique_ptr<Deformer> refined() const override { return nullptr; }
  const Pose& pose() const override { return pose_; }
  void reset() override { pose_ = {identity_map()}; }
  void start_from(const Pose& pose) override { pose_ = pose; }
  Structure structure() const override { return {{Vec3(0, 0, 0)}, {}, {0}}; }
  Figures counts() const override { return {{"nodes", 1}}; }
  std::vector<std::string> notes() const override { return {"A note."}; }
  std::vector<Table> binding() const override { return {{"toy", 2, {1, 2, 3, 4}}}; }

  SolveReport solve(const Constraints& constraints, const SolveOptions& options) override {
    SolveReport report;
    report.counts = {{"unknowns", 3}};
    Vec3 wanted = Vec3::Zero();
    std::size_t count = 0;
    for (const Handle& handle : constraints.handles)
      for (std::size_t k = 0; k < handle.points.size(); ++k, ++count)
        wanted += handle.targets[k] - rest_->positions[handle.points[k]];
    if (count > 0) wanted /= static_cast<double>(count);
    for (; (wanted - pose_[0].col(3)).norm() > 1e-12; ++report.iterations) {
      if (report.iterations == options.max_iterations) {
        report.status = Status::MaxIterations;
        break;
      }
      pose_[0].col(3) += 0.5 * (wanted - pose_[0].col(3));
      std::this_thread::sleep_for(std::chrono::duration<double>(pause_));
      if (options.on_iteration && !options.on_iteration(pose_)) {
        report.status = Status::Stopped;
        break;
      }
    }
    report.energy = {{"total", (wanted - pose_[0].col(3)).squaredNorm()}};
    return report;
  }

  static SkinWeights bind_all(std::span<const Vec3> points) {
    SkinWeights out;
    for (std::size_t i = 0; i < points.size(); ++i) {
      out.maps.push_back(0);
      out.weights.push_back(1);
      out.offsets.push_back(i + 1);
    }
    return out;
  }

 private:
  std::shared_ptr<const Shape> rest_;
  double pause_;
  SkinWeights weights_;
  Pose pose_{identity_map()};
};

/// "toy", with a setting of each sort; `made` counts the deformers.
inline Method toy_method(int* made = nullptr) {
  Method method;
  method.name = "toy";
  method.help = "A translation.";
  method.settings = {{"pause", 0, 0, 1, "seconds", "Seconds of an iteration.", false, {}},
                     {"count", 5, 1, 10, "", "Nothing.", true, {}},
                     {"style", 0, 0, 1, "", "Nothing.", false, {"round", "square"}}};
  method.make = [made, settings = method.settings](
                    std::shared_ptr<const Shape> rest, const Settings& values, const StructureWishes&,
                    const std::function<bool(double)>& progress) -> std::unique_ptr<Deformer> {
    if (progress && !progress(0.5)) return nullptr;
    if (made != nullptr) ++*made;
    return std::make_unique<ToyDeformer>(std::move(rest), value_of(values, settings, "pause"));
  };
  method.bind = [](const std::vector<Deformer::Table>& binding, std::span<const Vec3> points, Gradients) {
    if (binding.size() != 1 || binding[0].name != "toy") throw InputError("expected a table \"toy\", found none");
    return ToyDeformer::bind_all(points);
  };
  return method;
}

/// n points on a line, 1 apart, at `origin`.
inline std::shared_ptr<const Shape> line_of_points(std::size_t n, const Vec3& origin = Vec3::Zero()) {
  auto shape = std::make_shared<Shape>();
  shape->origin = origin;
  for (std::size_t i = 0; i < n; ++i) shape->positions.emplace_back(static_cast<double>(i), 0, 0);
  return shape;
}

}  // namespace sinew
