#pragma once
/// Marks and motions as functions on a Layer: what the user does to fixed points and handles, as plain data. Indices
/// are points of the input; world coordinates are relative to the input's origin.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "apps/editor/point_set.h"
#include "engine/document/project.h"
#include "engine/document/selection.h"
#include "engine/document/workspace.h"

namespace sinew::editor {

/// Rigid points turn as one group; Stiffer and Softer double and halve how stiff the material around points is.
enum class Mark { Free, Fixed, Handle, Rigid, Stiffer, Softer };
inline constexpr double stiffest = 256;  ///< factors of Stiffer and Softer stay within it and its inverse

/// What a drag does: a rotation about `pivot`, a stretch about it, a move, in this order. World coordinates.
struct Transform {
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double degrees = 0;
  Vec3 pivot = Vec3::Zero();
  Vec3 move = Vec3::Zero();
  Mat3 stretch = Mat3::Identity();  ///< symmetric, its eigenvalues (how many times as long) above 0

  bool turns() const { return degrees != 0; }
  bool stretches() const { return stretch != Mat3::Identity(); }
  Vec3 operator()(const Vec3& p) const;
};

/// Points of each selection of a layer, as indices: what a Selector says.
struct LayerPoints {
  std::vector<std::vector<Index>> fixed;    ///< of each of Layer::fixed
  std::vector<std::vector<Index>> handles;  ///< of each of Layer::handles
  std::vector<std::vector<Index>> rigid;    ///< of each of Layer::rigid
  std::vector<std::vector<Index>> stiff;    ///< of each of Layer::stiffness
};
/// `frame`: of a stream, the selector's; selections of other frames have no points here.
LayerPoints points_of(const document::Layer& layer, document::Selector& selector,
                      std::optional<int> frame = std::nullopt);

/// Marks `points`: Fixed and Handle take them from the fixed and the handles, Rigid from other groups, Free from all;
/// a handle or group without points goes. Fixed points that are given as indices are kept as one selection. Handle
/// makes one new handle with `motion` (that keeps the points where they are), Rigid one new group. Free of points that
/// are already free changes nothing. `frame`: of a stream, where new selections belong; a list of no points is one of
/// another frame and stays.
document::Layer marked(const document::Layer& layer, const LayerPoints& points, const PointSet& set, Mark mark,
                       const document::Motion& motion = {}, std::optional<int> frame = std::nullopt);

/// The layer with these handles at its end, also in its keys. Their points, `set`, are taken from the fixed and from
/// the other handles.
document::Layer with_handles(const document::Layer& layer, const LayerPoints& points, const PointSet& set,
                             std::span<const document::HandleEdit> handles, std::optional<int> frame = std::nullopt);

/// Layer::frame, or where the layer's structure is made while it names none.
int base_frame(const document::Layer& layer, int first);

/// The layer with a key at `frame` whose motions are these, one a handle; a key that is there is replaced. A layer
/// whose handles have moved without keys gets one for that, too, at its own frame. It names that frame then, so that
/// its structure and selections stay where they are.
document::Layer with_key(const document::Layer& layer, int frame, int first, std::span<const document::Motion> motions);

/// Of a handle, what a drag at `frame` changes: the motion of the key there, or the handle's own where there is none.
document::Motion& motion_at(document::Layer& layer, std::size_t handle, int frame);
const document::Motion& motion_at(const document::Layer& layer, std::size_t handle, int frame);

document::Layer without_handle(const document::Layer& layer, std::size_t handle);

/// Rotations about the mean of a handle's points name it: `centres` of each handle where the layer starts from, world.
/// So the motion stays what it is when the handle loses points.
document::Layer with_pivots(const document::Layer& layer, std::span<const Vec3> centres, const Vec3& origin);

/// `before`, then `by`, as few members as can be: a move stays a move, turns about one axis add their degrees, and what
/// is scaled has its turn as "rotate" and its stretch, symmetric, as "matrix": so both are interpolated as what they
/// are. `centre`: mean of the handle's points where the layer starts from, world; `origin`: the input's.
document::Motion moved(const document::Motion& before, const Transform& by, const Vec3& centre, const Vec3& origin);

/// `motion`, whole turns added to its rotation: the one that ends where it does and is nearest to `turn` (axis times
/// degrees). A rotation by whole turns alone is about `centre`, world.
document::Motion wound(const document::Motion& motion, const Vec3& turn, const Vec3& centre, const Vec3& origin);

/// The rigid motion that takes `from` nearest to `to` in least squares; exactly none where they are equal within
/// `tolerance`. Same sizes, at least one.
document::Motion rigid_fit(std::span<const Vec3> from, std::span<const Vec3> to, double tolerance, const Vec3& origin);

/// Layers from `from` on start from rest: the pose that a layer starts from holds only for the structure that it was
/// found with, and that follows from the layer's own settings and from all below it.
void forget_starts(document::Project& project, std::size_t from);

/// Points of the input after the first layers of an answer: all results whose `layer` is below `end`. indices: which.
std::vector<Vec3> bent(const Shape& input, std::span<const document::LayerResult> layers, std::size_t end,
                       std::span<const Index> indices);
/// The product of a point's blended matrices over all layers, and where the point is; `rest`: where it rests.
Mat3 bent_matrix(std::span<const document::LayerResult> layers, const Vec3& rest, std::size_t i, Vec3& position);
/// All of them; out: n.
void bend_all(const Shape& input, std::span<const document::LayerResult> layers, std::span<Vec3> out);

/// Bits of shared.h (mark_handle 1, mark_fixed 2, mark_rigid 4, mark_selected 8, mark_hidden 16) of each point; n.
std::vector<std::uint8_t> mark_bits(const LayerPoints& points, const PointSet& selection, const PointSet& hidden);
/// How stiff the material around each point is; n, or none where all of it is as it was.
std::vector<float> stiffness_factors(const document::Layer& layer, const LayerPoints& points, std::size_t n);

}  // namespace sinew::editor
