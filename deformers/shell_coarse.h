#pragma once
/// The coarse mesh that a large shell is solved on, and the way back to the fine one [Froehlich, Botsch 2011,
/// section 7].
///
/// The coarse vertices are vertices of the fine mesh. While something moves, a fine vertex has the maps of the coarse
/// triangle that it lies on, blended; the answer that stays is reconstructed from the coarse vertices
/// (shell_detail.h). A handle may be any fine vertex: one that is not coarse is tied to its place beside its triangle.

#include <memory>
#include <optional>

#include "deformers/pose_decimate.h"
#include "deformers/shell_detail.h"
#include "deformers/shell_energy.h"
#include "deformers/shell_mesh.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

class ShellCoarse {
 public:
  static constexpr Index none = ~Index{0};

  /// About `count` vertices. Null where progress said false.
  static std::unique_ptr<ShellCoarse> make(const ShellMesh& fine, std::size_t count,
                                           const std::function<bool(double)>& progress);

  const std::vector<Index>& vertices() const { return vertices_; }       ///< as fine ones
  const std::vector<Triangle>& triangles() const { return triangles_; }  ///< of coarse vertices
  Index number_of(Index fine) const { return number_[fine]; }            ///< among coarse vertices, or none
  std::vector<Vec3> coarse_of(std::span<const Vec3> fine) const;         ///< values of the coarse vertices

  /// Where a fine vertex is beside its coarse triangle. `rest`: the fine mesh at rest.
  ShellTie tie_of(Index fine, std::span<const Vec3> rest) const;

  /// Of each fine vertex, from those of coarse ones.
  Pose fine_maps(const Pose& coarse) const;
  std::vector<double> fine_values(std::span<const double> coarse) const;

  /// The fine surface where coarse vertices are at x and `held`, fine ones, at `targets` (met exactly). What depends
  /// on `rest` and `held` alone is kept. Empty where that failed, or progress said false.
  std::vector<Vec3> reconstruct(const ShellMesh& fine, std::span<const Vec3> x, std::span<const Index> held,
                                std::span<const Vec3> targets, const std::function<bool(double)>& progress);
  void forget_rest() { detail_.reset(); }  ///< the fine mesh at rest is another now

 private:
  std::vector<Index> vertices_, number_;
  std::vector<Triangle> triangles_;
  std::vector<PoseDecimated::Place> places_;
  std::unique_ptr<ShellDetail> detail_;
  std::vector<Index> detail_held_;
};

}  // namespace sinew
