#pragma once
/// Example-driven discrete shells [Froehlich, Botsch: Example-Driven Deformations Based on Discrete Shells, 2011] as a
/// Deformer: bends surfaces, interpolates between poses, and finds the pose between examples that suits the handles
/// (mesh-based inverse kinematics).
///
/// Works on the faces of the shape. A map of the pose is a vertex's (shell_pose.h); the shape's points at the vertices
/// follow one map exactly. A large shape is solved on a coarse mesh (shell_coarse.h): while it moves the rest follows
/// that, and the final answer is reconstructed from it. Fixed points and handles, any of them, are met exactly.

#include <memory>

#include "deformers/shell_energy.h"
#include "engine/geometry/deformer.h"

namespace sinew {

struct ShellOptions {
  /// About how many vertices it is solved with where there are more than twice as many [section 7]; 0: all of them.
  std::size_t vertices = 1000;
  /// How the final answer of a shape that was solved coarse comes to all vertices: reconstructed, or solved for from
  /// there, in a few Gauss-Newton steps with all of them.
  enum class Finish { Reconstructed, Solved } finish = Finish::Reconstructed;
  ShellStiffness stiffness;
};

/// Examples correspond to the shape (shell_mesh.h). Throws InputError where there is no surface, or an example does not
/// correspond. Null where progress said false. `source`: what the examples are poses of; null: the shape itself.
std::unique_ptr<Deformer> make_shell_deformer(std::shared_ptr<const Shape> rest,
                                              std::span<const std::shared_ptr<const Shape>> examples,
                                              const ShellOptions& options,
                                              const std::function<bool(double)>& progress = {},
                                              const Shape* source = nullptr);

/// The row of the methods table.
Method shell_method();

}  // namespace sinew
