#pragma once
/// The minimum of a shell's energy, over its free vertices and the weights of its examples together [Froehlich, Botsch
/// 2011, section 6].
///
/// Gauss-Newton (gauss_newton.h). The volume's row and the examples' weights would make J'J dense: with A of the sparse
/// rows,
///
///   J'J = [A B; B' C] + u u'     solved by A alone: Schur complement C - B' A^-1 B, then Sherman-Morrison
///   (section 6.2)
///
/// Held vertices are no unknowns. A part of the surface of which nothing is held or tied rests, unless there are
/// examples; then it takes their shape, and is laid over the blend of their positions by a rigid fit (over the rest
/// shape, where they are poses of another).

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "deformers/gauss_newton.h"
#include "deformers/shell_energy.h"

namespace sinew {

/// What is held and how stiff the shell is: all that does not change while a handle is dragged.
struct ShellHeld {
  std::vector<Index> vertices;    ///< each once
  std::vector<ShellTie> ties;     ///< points between vertices
  std::vector<double> stiffness;  ///< of each vertex, 1: as it is; empty: everywhere
  std::vector<std::optional<double>>
      weights;  ///< of examples; those missing or without a number are unknowns, or where nothing is held that
                ///< could tell, stay as they are: 0 after rest
  bool operator==(const ShellHeld&) const = default;
};

class ShellSolver {
 public:
  /// Poses in normalised coordinates: at rest, then the examples.
  /// `source` as of ShellEnergy.
  ShellSolver(std::vector<std::vector<Vec3>> poses, std::vector<Triangle> triangles, ShellStiffness stiffness,
              std::vector<Vec3> source = {});
  ~ShellSolver();

  /// Analyses the pattern where what is held changed.
  void prepare(const ShellHeld& held);

  /// Where what is held is to be after a share 0..1 of its way: held vertices, then ties.
  using Path = std::function<std::vector<Vec3>(double share)>;

  /// From the present x and alpha (from rest, where nothing is held and more than half of an example is asked for, from
  /// that), along the path in so many stretches: a step that pushed what is held all the way at
  /// once would fold the surface beside it, and a fold stays. Each stretch begins with what the free vertices do to
  /// first order as the held ones go. None: what is held is at once where it is to be, as in the paper.
  SolveReport solve(const Path& path, int stretches, const SolveOptions& options,
                    const std::function<bool()>& on_iteration);

  const std::vector<Vec3>& rest() const { return poses_.front(); }
  const std::vector<Vec3>& x() const { return x_; }
  const std::vector<double>& alpha() const { return alpha_; }
  const ShellEnergy& energy() const { return energy_; }
  std::size_t free_vertices() const { return count_; }
  std::size_t resting_parts() const { return resting_; }

  /// Solves both ways from where it is, and keeps the lower minimum: thin shells have many, side by side.
  SolveReport solve_twice(const Path& path, int stretches, const SolveOptions& options,
                          const std::function<bool()>& on_iteration);

  void reset();                     ///< to rest, alpha to 0 where it is not pinned
  void set_x(std::vector<Vec3> x);  ///< with the alpha that suits it best

 private:
  struct Model;
  void number_unknowns();
  GaussNewtonModel model();
  void go_to(std::span<const Vec3> targets);
  void begin_near_a_pose();
  void set_tie_targets(std::span<const Vec3> targets);
  void snap_to(std::span<const Vec3> targets);
  void take_best(const GaussNewtonModel& gn, std::span<const double> step, std::span<const Vec3> targets);
  void lay_free_parts();

  std::vector<std::vector<Vec3>> poses_;
  std::vector<Vec3> base_;  ///< what the examples are poses of
  double base_scale_ = 1;   ///< size of the rest shape in units of that
  std::vector<Triangle> triangles_;
  ShellEnergy energy_;
  std::vector<Index> part_;  ///< of each vertex
  std::size_t parts_ = 0;
  ShellHeld held_;
  std::vector<bool> loose_;    ///< of each part: it moves, and nothing of it is held
  std::vector<Index> number_;  ///< of each vertex among the unknowns
  Index count_ = 0;
  std::size_t resting_ = 0;
  KeptFactor kept_;
  std::unique_ptr<Model> model_;  ///< beside the factor
  std::vector<Vec3> x_;
  std::vector<double> alpha_;
};

}  // namespace sinew
