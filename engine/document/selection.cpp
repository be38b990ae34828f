#include "engine/document/selection.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/geometry/bounds.h"
#include "engine/io/bytes.h"
#include "engine/io/io.h"
#include "engine/io/text.h"

namespace sinew::document {

namespace {

/// Indices of finite points for which `inside(i, p)` holds, p in the file's coordinates.
template <class Inside>
std::vector<Index> finite_points(const Shape& shape, const Inside& inside) {
  std::vector<Index> out;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (!shape.positions[i].allFinite()) continue;
    if (inside(i, Vec3(shape.positions[i] + shape.origin))) out.push_back(static_cast<Index>(i));
  }
  return out;
}

std::vector<Index> checked(const Shape& shape, const std::vector<Index>& indices, const Place& place) {
  for (const Index i : indices) {
    if (i >= shape.size())
      throw file_error(place.text, "indices below " + std::to_string(shape.size()) + ", the number of points",
                       std::to_string(i));
    if (!shape.positions[i].allFinite())
      throw file_error(place.text, "points with finite coordinates", "point " + std::to_string(i) + " without");
  }
  return indices;
}

std::vector<Index> nearest_point(const Shape& shape, const Vec3& to) {
  double best = std::numeric_limits<double>::infinity();
  std::vector<Index> out;
  finite_points(shape, [&](std::size_t i, const Vec3& p) {
    const double distance = (p - to).squaredNorm();
    if (distance < best) {
      best = distance;
      out.assign(1, static_cast<Index>(i));
    }
    return false;
  });
  return out;
}

/// One whole number a point, separated by white space; from # to the end of the line is a comment.
std::vector<std::int64_t> read_labels(const std::string& path, std::size_t points) {
  const std::vector<std::byte> bytes = io::load_bytes(path);
  io::TextCursor cursor(path, io::as_text(bytes));
  std::vector<std::int64_t> labels;
  for (io::Token token = cursor.next('#'); !token.text.empty(); token = cursor.next('#')) {
    std::int64_t label = 0;
    if (!io::parse(token.text, label)) throw cursor.error(token, "a whole number, the label of a point");
    labels.push_back(label);
  }
  if (labels.size() != points)
    throw file_error(path, std::to_string(points) + " labels, one a point", std::to_string(labels.size()));
  return labels;
}

Mat3 rotation_matrix(const Rotation& rotation) {
  const double radians = rotation.degrees * (std::numbers::pi / 180);
  return Eigen::AngleAxisd(radians, rotation.axis.stableNormalized()).toRotationMatrix();
}

}  // namespace

const std::vector<std::int64_t>& Selector::labels(const std::string& path) {
  const auto known = labels_.find(path);
  if (known != labels_.end()) return known->second;
  return labels_.emplace(path, read_labels(path, input_->size())).first->second;
}

std::vector<Index> Selector::select(const Selection& selection) {
  struct Select {
    Selector& selector;
    const Shape& shape;
    const Place& place;

    std::vector<Index> operator()(const SelectAll&) const {
      return finite_points(shape, [](std::size_t, const Vec3&) { return true; });
    }
    std::vector<Index> operator()(const SelectIndices& indices) const {
      return checked(shape, indices.points.get(), place);
    }
    std::vector<Index> operator()(const SelectBox& box) const {
      return finite_points(shape, [&](std::size_t, const Vec3& p) {
        return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
      });
    }
    std::vector<Index> operator()(const SelectSphere& sphere) const {
      return finite_points(shape, [&](std::size_t, const Vec3& p) {
        return (p - sphere.center).squaredNorm() <= sphere.radius * sphere.radius;
      });
    }
    std::vector<Index> operator()(const SelectNearest& nearest) const { return nearest_point(shape, nearest.to); }
    std::vector<Index> operator()(const SelectComponent& component) const {
      if (!selector.components_) selector.components_ = connected_components(shape);
      const Components& components = *selector.components_;
      if (component.number >= components.count)
        throw file_error(place.text, "a component below " + std::to_string(components.count),
                         std::to_string(component.number));
      return finite_points(shape,
                           [&](std::size_t i, const Vec3&) { return components.of_point[i] == component.number; });
    }
    std::vector<Index> operator()(const SelectLabels& labels) const {
      const std::vector<std::int64_t>& of_point = selector.labels(labels.path);
      return finite_points(shape, [&](std::size_t i, const Vec3&) { return of_point[i] == labels.value; });
    }
    std::vector<Index> operator()(const SelectPlaces&) const {
      throw file_error(place.text, "points of the shape (places are for handles alone)", "\"places\"");
    }
  };
  std::vector<Index> out = std::visit(Select{*this, *input_, selection.place}, selection.what);
  if (out.empty()) throw file_error(selection.place.text, "a selection of at least one point", "none");
  return out;
}

std::vector<Index> Selector::points(const Selection& selection) {
  return points(std::span(&selection, 1));
}

std::vector<Index> Selector::points(std::span<const Selection> selections) {
  std::vector<Index> out;
  for (const Selection& selection : selections) {
    const std::vector<Index> more = select(selection);
    out.insert(out.end(), more.begin(), more.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<Index> Selector::points_as_written(const Selection& selection) {
  std::vector<Index> out = select(selection), sorted = out;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw file_error(selection.place.text, "each index once, because \"to\" has a target for each",
                     std::to_string(*twice) + " again");
  return out;
}

Marked marked(const Layer& layer, std::size_t count,
              const std::function<std::vector<Index>(const Selection&, bool as_written)>& select) {
  constexpr Index none = ~Index{0}, fixed = none - 1;
  std::vector<Index> owner(count, none);
  Marked out;
  for (const Selection& selection : layer.fixed) {
    const std::vector<Index> more = select(selection, false);
    out.fixed.insert(out.fixed.end(), more.begin(), more.end());
  }
  std::sort(out.fixed.begin(), out.fixed.end());
  out.fixed.erase(std::unique(out.fixed.begin(), out.fixed.end()), out.fixed.end());
  for (const Index i : out.fixed) owner[i] = fixed;

  const auto name = [](Index h) { return h == fixed ? "of the fixed" : "of handle " + std::to_string(h + 1); };
  const auto check_targets = [](const Motion& motion, const Place& place, std::size_t points) {
    const std::size_t targets = motion.to.get().size();
    if (targets > 0 && targets != points)
      throw file_error(place.text, std::to_string(points) + " targets in \"to\", one a point", std::to_string(targets));
  };
  for (std::size_t h = 0; h < layer.handles.size(); ++h) {
    const HandleEdit& edit = layer.handles[h];
    bool as_written = !edit.motion.to.get().empty();
    for (const Key& key : layer.keys)
      as_written = as_written || (h < key.handles.size() && !key.handles[h].to.get().empty());
    const SelectPlaces* places = std::get_if<SelectPlaces>(&edit.points.what);
    std::vector<Index> points = places == nullptr ? select(edit.points, as_written) : std::vector<Index>{};
    const std::size_t size = places == nullptr ? points.size() : places->at.get().size();
    check_targets(edit.motion, edit.place, size);
    for (const Key& key : layer.keys)
      if (h < key.handles.size()) check_targets(key.handles[h], key.place, size);
    for (const Index i : points) {
      if (owner[i] != none)
        throw file_error(edit.place.text, "points of this handle alone",
                         "point " + std::to_string(i) + ", which is also one " + name(owner[i]));
      owner[i] = static_cast<Index>(h);
    }
    out.handles.push_back(std::move(points));
  }
  for (const Selection& selection : layer.rigid) out.rigid.push_back(select(selection, false));
  for (const Stiffness& edit : layer.stiffness) out.stiffness.push_back({select(edit.points, false), edit.factor});
  return out;
}

std::vector<Vec3> handle_places(const HandleEdit& handle, const Vec3& origin) {
  std::vector<Vec3> out;
  if (const SelectPlaces* places = std::get_if<SelectPlaces>(&handle.points.what))
    for (const Vec3& p : places->at.get()) out.push_back(p - origin);
  return out;
}

/// Whether a linear map stretches along axes, and neither turns nor mirrors.
static bool stretches(const Mat3& A) {
  return (A - A.transpose()).norm() <= 1e-12 * A.norm() && Eigen::LLT<Mat3>(A).info() == Eigen::Success;
}

std::optional<Vec3> turn_of(const Motion& motion) {
  if (!motion.to.get().empty() || (motion.matrix && !stretches(motion.matrix->topLeftCorner<3, 3>())))
    return std::nullopt;
  if (!motion.rotate) return Vec3(0, 0, 0);
  return motion.rotate->axis.stableNormalized() * (motion.rotate->degrees * (std::numbers::pi / 180));
}

Constraints Selector::constraints(const Layer& layer, std::span<const Vec3> rest) {
  CHECK(rest.size() == input_->size(), rest.size(), input_->size());
  const Marked points = marked(layer, rest.size(), [this](const Selection& selection, bool as_written) {
    return as_written ? points_as_written(selection) : this->points(selection);
  });
  Constraints out{points.fixed, {}, points.rigid, points.stiffness};
  for (std::size_t h = 0; h < layer.handles.size(); ++h) {
    const HandleEdit& edit = layer.handles[h];
    std::vector<Vec3> at, places = handle_places(edit, input_->origin);
    for (const Index i : points.handles[h]) at.push_back(rest[i]);
    at.insert(at.end(), places.begin(), places.end());
    out.handles.push_back(
        {points.handles[h], targets_of(edit.motion, at, input_->origin), std::move(places), turn_of(edit.motion)});
  }
  return out;
}

std::vector<Vec3> targets_of(const Motion& motion, std::span<const Vec3> rest, const Vec3& origin) {
  std::vector<Vec3> out(rest.begin(), rest.end());
  if (const std::vector<Vec3>& to = motion.to.get(); !to.empty()) {
    CHECK(to.size() == rest.size(), to.size(), rest.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = to[i] - origin;
    return out;
  }
  if (motion.rotate) {
    const Mat3 R = rotation_matrix(*motion.rotate);
    Vec3 about = std::accumulate(rest.begin(), rest.end(), Vec3(0, 0, 0)) / static_cast<double>(rest.size());
    if (motion.rotate->about) about = *motion.rotate->about - origin;
    for (Vec3& p : out) p = R * (p - about) + about;
  }
  if (motion.matrix) {
    // A (p + o) + t - o, with what is large taken together, so that the unit matrix keeps every bit.
    const Mat3 A = motion.matrix->topLeftCorner<3, 3>();
    const Vec3 t = (A - Mat3::Identity()) * origin + motion.matrix->topRightCorner<3, 1>();
    for (Vec3& p : out) p = A * p + t;
  }
  if (motion.move)
    for (Vec3& p : out) p += *motion.move;
  return out;
}

}  // namespace sinew::document
