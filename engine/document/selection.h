#pragma once
/// Selector: selections of an edit as point indices of a shape, and handles as targets.

#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/document/project.h"
#include "engine/geometry/deformer.h"
#include "engine/geometry/topology.h"

namespace sinew::document {

/// Points of a layer's marks, in the order of the layer's handles.
struct Marked {
  std::vector<Index> fixed;
  std::vector<std::vector<Index>> handles;  ///< of a handle of places: none
  std::vector<std::vector<Index>> rigid;
  std::vector<Stiff> stiffness;
};

/// The places of a handle that has such, relative to `origin`; else none.
std::vector<Vec3> handle_places(const HandleEdit& handle, const Vec3& origin);

/// Makes the selections of a layer by `select` (of a selection; true: indices in their written order). `count`: of all
/// points. Throws InputError where a point belongs to two handles, or to a handle and the fixed, or a "to" has another
/// number of targets than the handle has points.
Marked marked(const Layer& layer, std::size_t count,
              const std::function<std::vector<Index>(const Selection&, bool as_written)>& select);

/// Selections are made on the input, before any edit; points that are not finite belong to none. Components and label
/// files are computed or read once. Throws InputError (PLACE: expected ..., found ...): an index beyond the points, a
/// component that is not there, a label file that is missing or of another length, an empty selection.
class Selector {
 public:
  explicit Selector(std::shared_ptr<const Shape> input) : input_(std::move(input)) {}

  /// Ascending, each once; never empty.
  std::vector<Index> points(const Selection& selection);
  /// Of all of them together; empty only where there are none.
  std::vector<Index> points(std::span<const Selection> selections);

  /// As points(), but indices in their written order; an index given twice is an error.
  std::vector<Index> points_as_written(const Selection& selection);

  /// Fixed points and handles of a layer. Targets are the motions of `rest`, the layer's rest positions relative to the
  /// input's origin. A point of two handles, or of a handle and the fixed, is an error.
  Constraints constraints(const Layer& layer, std::span<const Vec3> rest);

 private:
  std::vector<Index> select(const Selection& selection);
  const std::vector<std::int64_t>& labels(const std::string& path);

  std::shared_ptr<const Shape> input_;
  std::optional<Components> components_;
  std::unordered_map<std::string, std::vector<std::int64_t>> labels_;
};

/// How far a motion turns, where that is said: the rotation's axis times radians (Handle::turn); zero where it only
/// moves or stretches (a symmetric matrix, positive definite). Any other matrix and targets do not say it.
std::optional<Vec3> turn_of(const Motion& motion);

/// Targets of points at `rest` (relative to `origin`) under a motion in the file's coordinates; relative to `origin`
/// again. rest.size() == motion.to.size() where the motion has `to`.
std::vector<Vec3> targets_of(const Motion& motion, std::span<const Vec3> rest, const Vec3& origin);

}  // namespace sinew::document
