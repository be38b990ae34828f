#pragma once
/// Stage: a session's shape as the device has it, kept up to date, and the scene that shows it.

#include <optional>

#include "apps/editor/coloring.h"
#include "apps/editor/onion.h"
#include "apps/editor/session.h"
#include "apps/editor/theme.h"
#include "apps/editor/view.h"
#include "engine/gpu/paths.h"
#include "engine/gpu/renderer.h"
#include "engine/gpu/solid.h"
#include "engine/gpu/splats.h"

namespace sinew::editor {

class Stage {
 public:
  /// `wake` is called from other threads when poll() has something to take.
  Stage(const gpu::Device& device, const gpu::Paths& paths, std::function<void()> wake)
      : device_(device), paths_(paths), painter_(wake), onion_(std::move(wake)) {}

  /// Remembers what is to be handed to the device by the next update().
  void note(const Changed& changed);
  /// True where colours or ghosts were found that the next update() takes.
  bool poll();
  /// The colours alone, for who draws them elsewhere.
  void update_colors(Session& session, const View& view) {
    if (session.has_input()) pending_.marks |= painter_.update(session, view);
  }
  /// Between begin_frame and submit.
  void update(gpu::Frame& frame, Session& session, const View& view);

  /// The scene of this frame; `count` of the points are drawn (level of detail).
  gpu::Scene scene(Session& session, const View& view, const Theme& theme, std::size_t count) const;

  std::size_t points() const { return points_ ? points_->count : 0; }
  bool is_mesh() const { return triangles_.count > 0; }
  bool is_splats() const { return splats_.has_value(); }
  const Coloring& coloring() const { return painter_.coloring(); }

 private:
  void take_input(const Shape& shape);
  void take_marks(Session& session);
  void take_pose(gpu::Frame& frame, Session& session);
  void bend_splats(Session& session);
  void color_splats(Session& session);
  void add_structure(gpu::Scene& scene, const Session& session, const View& view) const;
  void take_solid(Session& session, const View& view);
  void take_onion(Session& session, const View& view);

  struct Ghost {
    gpu::Points points;
    gpu::Triangles triangles;
    int away = 1;  ///< steps from the frame shown; below 0: before
  };

  const gpu::Device& device_;
  const gpu::Paths& paths_;
  Changed pending_;
  std::optional<gpu::Points> points_;
  gpu::Triangles triangles_;
  std::optional<gpu::Splats> splats_;             ///< bent, with marks; drawn in place of the points
  std::vector<Eigen::Vector3f> splat_harmonics_;  ///< of splats_, without marks
  std::vector<float> splat_opacities_;            ///< of splats_, hidden ones too
  bool only_moved_ = false;                       ///< splats_ have their new centres and their old covariances
  Painter painter_;
  bool colored_ = false;  ///< by an attribute or a heat map
  OnionSkin onion_;
  std::vector<Ghost> ghosts_;
  const SkinWeights* weights_ = nullptr;  ///< that the device has

  /// The cut structure of a solid; null while none is shown.
  std::shared_ptr<const Deformer::Structure> solid_structure_;
  gpu::Section section_;
  gpu::SolidFaces solid_faces_;
  std::vector<Vec3> solid_at_;
  std::optional<gpu::SolidItem> solid_;
};

}  // namespace sinew::editor
