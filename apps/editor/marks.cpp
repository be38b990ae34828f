#include "apps/editor/marks.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>

#include "engine/geometry/rotation.h"
#include "engine/geometry/skin.h"
#include "shaders/shared.h"

namespace sinew::editor {

namespace {

using document::HandleEdit;
using document::Layer;
using document::LayerResult;
using document::Motion;
using document::Rotation;
using document::SelectIndices;
using document::Selection;
using document::Shared;

Mat3 matrix_of(const Vec3& axis, double degrees) {
  return Eigen::AngleAxisd(degrees * (std::numbers::pi / 180), axis.stableNormalized()).toRotationMatrix();
}

Selection selection_of(std::vector<Index> points, std::optional<int> frame = std::nullopt) {
  return {SelectIndices{Shared<Index>(std::move(points))}, {}, frame};
}

bool any_in(std::span<const Index> points, const PointSet& set) {
  return std::any_of(points.begin(), points.end(), [&](Index i) { return set[i]; });
}

std::vector<Index> without(std::span<const Index> points, const PointSet& set) {
  std::vector<Index> out;
  std::copy_if(points.begin(), points.end(), std::back_inserter(out), [&](Index i) { return !set[i]; });
  return out;
}

/// The fixed selections after marking: those that were drawn as boxes or spheres stay what they are where they can.
std::vector<Selection> fixed_after(const Layer& layer, const LayerPoints& points, const PointSet& set, bool fix,
                                   std::optional<int> frame) {
  std::vector<Selection> out;
  PointSet loose(set.size());
  if (fix) loose = set;
  for (std::size_t s = 0; s < layer.fixed.size(); ++s) {
    const bool drawn = !std::holds_alternative<SelectIndices>(layer.fixed[s].what);
    const bool elsewhere = points.fixed[s].empty();
    if (elsewhere) out.push_back(layer.fixed[s]);
    if (elsewhere) continue;
    if (drawn && (fix || !any_in(points.fixed[s], set))) {
      out.push_back(layer.fixed[s]);
      for (const Index i : points.fixed[s])
        if (loose[i]) loose.remove(i);
    } else {
      for (const Index i : points.fixed[s])
        if (fix || !set[i]) loose.add(i);
    }
  }
  if (!loose.empty()) out.push_back(selection_of(loose.indices(), frame));
  return out;
}

/// Removes `set` from a handle; its targets go with the points.
HandleEdit handle_without(const HandleEdit& handle, std::span<const Index> points, const PointSet& set) {
  HandleEdit out = handle;
  out.points = selection_of(without(points, set), handle.points.frame);
  if (const std::vector<Vec3>& to = handle.motion.to.get(); !to.empty()) {
    std::vector<Vec3> kept;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (!set[points[k]]) kept.push_back(to[k]);
    out.motion.to = Shared<Vec3>(std::move(kept));
  }
  return out;
}

/// A group of points that are given as indices from here on.
Selection selection_without(const Selection& selection, std::span<const Index> points, const PointSet& set) {
  return selection_of(without(points, set), selection.frame);
}

/// The rigid groups without `set`.
std::vector<Selection> rigid_after(const Layer& layer, const LayerPoints& points, const PointSet& set) {
  std::vector<Selection> out;
  for (std::size_t g = 0; g < layer.rigid.size(); ++g) {
    if (!any_in(points.rigid[g], set)) {
      out.push_back(layer.rigid[g]);
      continue;
    }
    Selection rest = selection_without(layer.rigid[g], points.rigid[g], set);
    if (!std::get<SelectIndices>(rest.what).points.get().empty()) out.push_back(std::move(rest));
  }
  return out;
}

/// Factors of points add up as a product; those of `set` become `times` of what they were. 0: none.
std::vector<document::Stiffness> stiffness_after(const Layer& layer, const LayerPoints& points, const PointSet& set,
                                                 double times, std::optional<int> frame) {
  std::vector<document::Stiffness> out;
  std::vector<double> factors(set.size(), 1);
  for (std::size_t s = 0; s < layer.stiffness.size(); ++s) {
    const document::Stiffness& stiff = layer.stiffness[s];
    if (!any_in(points.stiff[s], set)) {
      out.push_back(stiff);
      continue;
    }
    for (const Index i : points.stiff[s]) factors[i] *= stiff.factor;
    document::Stiffness rest{selection_without(stiff.points, points.stiff[s], set), stiff.factor};
    if (!std::get<SelectIndices>(rest.points.what).points.get().empty()) out.push_back(std::move(rest));
  }
  if (times == 0) return out;
  std::map<double, std::vector<Index>> groups;
  set.each([&](std::size_t i) {
    const double factor = std::clamp(factors[i] * times, 1 / stiffest, stiffest);
    if (factor != 1) groups[factor].push_back(static_cast<Index>(i));
  });
  for (auto& [factor, group] : groups) out.push_back({selection_of(std::move(group), frame), factor});
  return out;
}

/// The rotation by `turn` with whole turns added: the nearest to `near` (axis times degrees). Where it turns by less
/// than `least` degrees it says nothing about the axis, and that of `near` is taken, by whole turns.
Rotation nearest_turn(const Eigen::AngleAxisd& turn, const Vec3& near, double least) {
  const double degrees = turn.angle() * (180 / std::numbers::pi);
  if (degrees < least && near.norm() > 180)
    return {near.normalized(), 360 * std::round(near.norm() / 360), std::nullopt};
  return {turn.axis(), degrees + 360 * std::round((near.dot(turn.axis()) - degrees) / 360), std::nullopt};
}

struct BentPoint {
  Vec3 position;
  Mat3 M;
};

}  // namespace

Vec3 Transform::operator()(const Vec3& p) const {
  if (!turns() && !stretches()) return p + move;
  const Vec3 arm = turns() ? Vec3(matrix_of(axis, degrees) * (p - pivot)) : Vec3(p - pivot);
  return stretch * arm + pivot + move;
}

LayerPoints points_of(const Layer& layer, document::Selector& selector, std::optional<int> frame) {
  LayerPoints out;
  const auto elsewhere = [&](const Selection& selection) { return frame && selection.frame != frame; };
  for (const Selection& selection : layer.fixed)
    out.fixed.push_back(elsewhere(selection) ? std::vector<Index>{} : selector.points(selection));
  for (const HandleEdit& handle : layer.handles) {
    std::vector<Index>& points = out.handles.emplace_back();
    if (elsewhere(handle.points) || std::holds_alternative<document::SelectPlaces>(handle.points.what)) continue;
    points =
        handle.motion.to.get().empty() ? selector.points(handle.points) : selector.points_as_written(handle.points);
  }
  for (const Selection& selection : layer.rigid)
    out.rigid.push_back(elsewhere(selection) ? std::vector<Index>{} : selector.points(selection));
  for (const document::Stiffness& stiff : layer.stiffness)
    out.stiff.push_back(elsewhere(stiff.points) ? std::vector<Index>{} : selector.points(stiff.points));
  return out;
}

/// Without `set` among fixed points and handles; those that have no other points go. `fix`: all of it is fixed then.
static Layer without_points(const Layer& layer, const LayerPoints& points, const PointSet& set, bool fix,
                            std::optional<int> frame) {
  Layer out = layer;
  out.fixed = fixed_after(layer, points, set, fix, frame);
  for (std::size_t h = layer.handles.size(); h-- > 0;) {
    if (!any_in(points.handles[h], set)) continue;
    out.handles[h] = handle_without(layer.handles[h], points.handles[h], set);
    const bool empty = std::all_of(points.handles[h].begin(), points.handles[h].end(), [&](Index i) { return set[i]; });
    if (empty) out = without_handle(out, h);
  }
  return out;
}

static void append(const HandleEdit& handle, Layer& layer) {
  for (document::Key& key : layer.keys)
    if (key.handles.size() == layer.handles.size()) key.handles.push_back(handle.motion);
  layer.handles.push_back(handle);
}

Layer marked(const Layer& layer, const LayerPoints& points, const PointSet& set, Mark mark, const Motion& motion,
             std::optional<int> frame) {
  Layer out = layer;
  if (mark == Mark::Free || mark == Mark::Rigid) out.rigid = rigid_after(layer, points, set);
  if (mark == Mark::Rigid && !set.empty()) out.rigid.push_back(selection_of(set.indices(), frame));
  if (mark == Mark::Free) out.stiffness = stiffness_after(layer, points, set, 0, frame);
  if (mark == Mark::Stiffer) out.stiffness = stiffness_after(layer, points, set, 2, frame);
  if (mark == Mark::Softer) out.stiffness = stiffness_after(layer, points, set, 0.5, frame);
  if (mark == Mark::Rigid || mark == Mark::Stiffer || mark == Mark::Softer) return out;
  out = without_points(out, points, set, mark == Mark::Fixed, frame);
  if (mark != Mark::Handle || set.empty()) return out;
  HandleEdit handle;
  handle.points = selection_of(set.indices(), frame);
  handle.motion = motion;
  const bool moves = motion.move || motion.rotate || motion.matrix || !motion.to.get().empty();
  if (!moves) handle.motion.move = Vec3(0, 0, 0);
  append(handle, out);
  return out;
}

Layer with_handles(const Layer& layer, const LayerPoints& points, const PointSet& set,
                   std::span<const HandleEdit> handles, std::optional<int> frame) {
  Layer out = without_points(layer, points, set, false, frame);
  for (const HandleEdit& handle : handles) append(handle, out);
  return out;
}

int base_frame(const Layer& layer, int first) {
  return layer.frame.value_or(layer.keys.empty() ? first : layer.keys.front().frame);
}

Layer with_key(const Layer& layer, int frame, int first, std::span<const Motion> motions) {
  CHECK(motions.size() == layer.handles.size(), motions.size(), layer.handles.size());
  Layer out = layer;
  const auto moves = [](const HandleEdit& handle) {
    const Motion& m = handle.motion;
    return m.rotate || m.matrix || !m.to.get().empty() || (m.move && *m.move != Vec3(0, 0, 0));
  };
  const auto set = [&](int at, std::vector<Motion> of) {
    auto place =
        std::find_if(out.keys.begin(), out.keys.end(), [&](const document::Key& key) { return key.frame >= at; });
    if (place == out.keys.end() || place->frame != at) {
      place = out.keys.emplace(place);
      place->frame = at;
    }
    place->handles = std::move(of);
  };
  out.frame = base_frame(layer, first);
  for (document::Key& key : out.keys)
    for (std::size_t h = key.handles.size(); h < out.handles.size(); ++h) key.handles.push_back(out.handles[h].motion);
  if (out.keys.empty() && std::any_of(out.handles.begin(), out.handles.end(), moves)) {
    std::vector<Motion> own;
    for (const HandleEdit& handle : out.handles) own.push_back(handle.motion);
    set(*out.frame, std::move(own));
  }
  set(frame, {motions.begin(), motions.end()});
  // What the keys say now would only be said twice.
  for (HandleEdit& handle : out.handles) {
    handle.motion = {};
    handle.motion.move = Vec3(0, 0, 0);
  }
  return out;
}

const Motion& motion_at(const Layer& layer, std::size_t handle, int frame) {
  for (const document::Key& key : layer.keys)
    if (key.frame == frame && handle < key.handles.size()) return key.handles[handle];
  return layer.handles[handle].motion;
}

Motion& motion_at(Layer& layer, std::size_t handle, int frame) {
  return const_cast<Motion&>(motion_at(std::as_const(layer), handle, frame));
}

Layer without_handle(const Layer& layer, std::size_t handle) {
  CHECK(handle < layer.handles.size(), handle, layer.handles.size());
  Layer out = layer;
  const auto at = static_cast<std::ptrdiff_t>(handle);
  for (document::Key& key : out.keys)
    if (key.handles.size() == out.handles.size()) key.handles.erase(key.handles.begin() + at);
  out.handles.erase(out.handles.begin() + at);
  return out;
}

void forget_starts(document::Project& project, std::size_t from) {
  for (std::size_t i = from; i < project.layers.size(); ++i) project.layers[i].start = {};
}

Layer with_pivots(const Layer& layer, std::span<const Vec3> centres, const Vec3& origin) {
  CHECK(centres.size() == layer.handles.size(), centres.size(), layer.handles.size());
  Layer out = layer;
  for (std::size_t h = 0; h < centres.size(); ++h)
    if (auto& rotate = out.handles[h].motion.rotate; rotate && !rotate->about) rotate->about = centres[h] + origin;
  return out;
}

namespace {

/// `now` turned on by R, which is about `turn` (axis times degrees).
Rotation turned(const Rotation& now, const Mat3& R, const Vec3& turn) {
  const Vec3 axis = now.axis.stableNormalized();
  const Eigen::AngleAxisd both(Mat3(R * matrix_of(now.axis, now.degrees)));
  Rotation out = nearest_turn(both, axis * now.degrees + turn, 1e-7);
  out.about = now.about;
  return out;
}

/// M (R1 (p - c) + c + ...) = P Q R1 (p - c) + c', where P Q is the left polar form of M: P symmetric, about c.
Motion stretched(const Motion& before, const Transform& by, const Vec3& centre, const Vec3& origin) {
  const Mat3 A = before.matrix ? Mat3(before.matrix->topLeftCorner<3, 3>()) : Mat3(Mat3::Identity());
  const Mat3 R = by.turns() ? matrix_of(by.axis, by.degrees) : Mat3(Mat3::Identity());
  const Mat3 M = by.stretch * R * A;
  Rotation rotate = before.rotate.value_or(Rotation{by.axis, 0, std::nullopt});
  const Vec3 c = rotate.about ? Vec3(*rotate.about - origin) : centre;
  const Vec3 at = by(document::targets_of({before.move, std::nullopt, before.matrix, {}}, std::span(&c, 1), origin)[0]);
  Motion out;
  Mat3 P = M;
  if (M.determinant() > 0) {  // else there is a mirror in it, and it stays as it is
    const Mat3 Q = nearest_rotation(M);
    P = M * Q.transpose();
    P = Mat3(0.5 * (P + P.transpose()));
    // The turn that was asked for says how often it goes round, the polar form only where it ends.
    const Eigen::AngleAxisd rest(Mat3(Q * R.transpose()));
    rotate.about = c + origin;
    if (by.turns() || rest.angle() > 1e-9)
      rotate = turned(rotate, Q,
                      by.turns() ? Vec3(by.axis.stableNormalized() * by.degrees)
                                 : Vec3(rest.axis() * (rest.angle() * 180 / std::numbers::pi)));
  }
  if (rotate.degrees != 0) out.rotate = rotate;
  if ((P - Mat3::Identity()).norm() > 1e-12) {
    out.matrix = Eigen::Matrix4d::Identity();
    out.matrix->topLeftCorner<3, 3>() = P;
    out.matrix->topRightCorner<3, 1>() = (Mat3::Identity() - P) * (c + origin);
  }
  out.move = Vec3(at - c);
  return out;
}

}  // namespace

Motion moved(const Motion& before, const Transform& by, const Vec3& centre, const Vec3& origin) {
  Motion out = before;
  if (const std::vector<Vec3>& to = before.to.get(); !to.empty()) {
    std::vector<Vec3> targets;
    for (const Vec3& p : to) targets.push_back(by(p - origin) + origin);
    out.to = Shared<Vec3>(std::move(targets));
    return out;
  }
  const Vec3 move = before.move.value_or(Vec3(0, 0, 0));
  if (!by.turns() && !by.stretches()) {
    out.move = Vec3(move + by.move);
    return out;
  }
  if (before.matrix || by.stretches()) return stretched(before, by, centre, origin);
  const Mat3 R = matrix_of(by.axis, by.degrees);
  // R (R1 (p - c) + c + m - pivot) + pivot + move = R R1 (p - c) + c + m', so the rotation keeps its own pivot c.
  Rotation rotate = before.rotate.value_or(Rotation{by.axis, 0, std::nullopt});
  const Vec3 c = rotate.about ? Vec3(*rotate.about - origin) : centre;
  rotate.about = c + origin;
  const Vec3 axis = rotate.axis.stableNormalized();
  const double same = axis.dot(by.axis.stableNormalized());
  if (rotate.degrees == 0 || std::abs(same) > 1 - 1e-12) {
    rotate.axis = rotate.degrees == 0 ? by.axis : rotate.axis;
    rotate.degrees += rotate.degrees == 0 || same > 0 ? by.degrees : -by.degrees;
  } else {
    rotate = turned(rotate, R, by.axis.stableNormalized() * by.degrees);
  }
  out.rotate = rotate;
  out.move = Vec3(R * (c + move - by.pivot) + by.pivot - c + by.move);
  return out;
}

Motion wound(const Motion& motion, const Vec3& turn, const Vec3& centre, const Vec3& origin) {
  if (motion.matrix || !motion.to.get().empty()) return motion;
  Motion out = motion;
  if (motion.rotate) {
    const double radians = motion.rotate->degrees * (std::numbers::pi / 180);
    const Eigen::AngleAxisd once(Mat3(Eigen::AngleAxisd(radians, motion.rotate->axis.stableNormalized())));
    out.rotate = nearest_turn(once, turn, 1);
    out.rotate->about = motion.rotate->about;
  } else if (turn.norm() > 180) {
    out.rotate = nearest_turn(Eigen::AngleAxisd(0, Vec3::UnitZ()), turn, 1);
    out.rotate->about = centre + origin;
  }
  return out;
}

Motion rigid_fit(std::span<const Vec3> from, std::span<const Vec3> to, double tolerance, const Vec3& origin) {
  CHECK(from.size() == to.size() && !from.empty(), from.size(), to.size());
  Motion out;
  out.move = Vec3(0, 0, 0);
  double farthest = 0;
  for (std::size_t i = 0; i < from.size(); ++i) farthest = std::max(farthest, (to[i] - from[i]).norm());
  if (farthest <= tolerance) return out;
  const auto mean = [](std::span<const Vec3> points) {
    return Vec3(std::accumulate(points.begin(), points.end(), Vec3(0, 0, 0)) / static_cast<double>(points.size()));
  };
  const Vec3 a = mean(from), b = mean(to);
  Mat3 H = Mat3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) H += (from[i] - a) * (to[i] - b).transpose();
  const Eigen::JacobiSVD<Mat3> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 D = Mat3::Identity();
  D(2, 2) = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1;
  const Eigen::AngleAxisd turn(Mat3(svd.matrixV() * D * svd.matrixU().transpose()));
  if (turn.angle() > 1e-9)
    out.rotate = Rotation{turn.axis(), turn.angle() * (180 / std::numbers::pi), Vec3(a + origin)};
  out.move = Vec3(b - a);
  return out;
}

namespace {

/// p + sum_j w_ij ((A_j - I) p + t_j), layer after layer, and the product of their matrices.
BentPoint bend_one(const Vec3& rest, std::span<const LayerResult> layers, std::size_t end, std::size_t i) {
  BentPoint out{rest, Mat3::Identity()};
  for (const LayerResult& layer : layers) {
    if (layer.layer >= end || layer.pose == nullptr || layer.weights == nullptr) continue;
    Vec3 displacement(0, 0, 0);
    Mat3 M = Mat3::Identity();
    for (std::uint64_t e = layer.weights->offsets[i]; e < layer.weights->offsets[i + 1]; ++e) {
      const Affine& A = (*layer.pose)[layer.weights->maps[e]];
      const double w = layer.weights->weights[e];
      const Mat3 change = w * (A.leftCols<3>() - Mat3::Identity());
      displacement += change * out.position + w * A.col(3);
      M += change;
    }
    out.position += displacement;
    out.M = M * out.M;
  }
  return out;
}

}  // namespace

std::vector<Vec3> bent(const Shape& input, std::span<const LayerResult> layers, std::size_t end,
                       std::span<const Index> indices) {
  std::vector<Vec3> out;
  out.reserve(indices.size());
  for (const Index i : indices) out.push_back(bend_one(input.positions[i], layers, end, i).position);
  return out;
}

Mat3 bent_matrix(std::span<const LayerResult> layers, const Vec3& rest, std::size_t i, Vec3& position) {
  const BentPoint point = bend_one(rest, layers, ~std::size_t{0}, i);
  position = point.position;
  return point.M;
}

void bend_all(const Shape& input, std::span<const LayerResult> layers, std::span<Vec3> out) {
  std::span<const Vec3> in = input.positions;
  for (const LayerResult& layer : layers) {
    if (layer.pose == nullptr || layer.weights == nullptr) continue;
    skin_points(*layer.weights, *layer.pose, in, out);
    in = out;
  }
  if (in.data() != out.data()) std::copy(in.begin(), in.end(), out.begin());
}

std::vector<std::uint8_t> mark_bits(const LayerPoints& points, const PointSet& selection, const PointSet& hidden) {
  std::vector<std::uint8_t> out(selection.size(), 0);
  const auto mark = [&](const std::vector<std::vector<Index>>& lists, unsigned bit) {
    for (const std::vector<Index>& list : lists)
      for (const Index i : list) out[i] = static_cast<std::uint8_t>(out[i] | bit);
  };
  mark(points.fixed, gpu::shared::mark_fixed);
  mark(points.handles, gpu::shared::mark_handle);
  mark(points.rigid, gpu::shared::mark_rigid);
  selection.each([&](std::size_t i) { out[i] = static_cast<std::uint8_t>(out[i] | gpu::shared::mark_selected); });
  hidden.each([&](std::size_t i) { out[i] = static_cast<std::uint8_t>(out[i] | gpu::shared::mark_hidden); });
  return out;
}

std::vector<float> stiffness_factors(const Layer& layer, const LayerPoints& points, std::size_t n) {
  if (layer.stiffness.empty()) return {};
  std::vector<float> out(n, 1);
  for (std::size_t s = 0; s < layer.stiffness.size(); ++s)
    for (const Index i : points.stiff[s]) out[i] *= static_cast<float>(layer.stiffness[s].factor);
  return out;
}

}  // namespace sinew::editor
