#pragma once
/// Minimises the energy of a solid (tet_energy.h) under constraints: the loop of Stoll, de Aguiar, Theobalt, Seidel
/// 2007, section 2.3.2. Solve with the factor of L, rotations by polar decomposition, new differential coordinates, and
/// again.
///
/// Faster to the same limit: a step of the loop is -L^-1 (dE/dx) / 2, so L is a fixed approximation of half the
/// Hessian, and limited-memory BFGS around it learns what L lacks [Nocedal and Wright 2006, algorithm 7.4]. E never
/// rises: a step that would raise it is halved.
///
/// Rotation interpolation: where a handle turns, its rotation relative to now is spread over the tets by harmonic
/// fields, h_k = 1 on handle k and 0 on what else is held, blended as quaternions, and put before the present R_j. It
/// is done in steps of at most 30 degrees, so that twists of any number of turns come out.

#include <optional>
#include <vector>

#include "deformers/tet_energy.h"
#include "engine/geometry/deformer.h"

namespace sinew {

/// Which vertices are held, and how; indices of the solver's vertices.
struct TetHandle {
  std::vector<Index> vertices;  ///< exactly at their targets
  std::vector<TetTie> ties;     ///< points between vertices, near theirs
  bool operator==(const TetHandle&) const = default;
};
inline bool operator==(const TetTie& a, const TetTie& b) {
  return a.vertices == b.vertices && a.weights == b.weights;
}

struct TetConstraints {
  std::vector<Index> fixed;  ///< vertices that stay
  std::vector<TetHandle> handles;
  std::vector<std::vector<Index>> groups;  ///< tets that turn as one
  std::vector<double> stiffness;           ///< factor of each tet; empty: 1
  bool operator==(const TetConstraints&) const = default;
};

/// Where a handle is to be: a target for each vertex, then each tie, in normalised coordinates, and Handle::turn.
struct TetTarget {
  std::vector<Vec3> positions;
  std::optional<Vec3> turn;
};

class TetSolver {
 public:
  /// Tets of positive volume; vertices in normalised coordinates (the bounding-box diagonal is 1).
  TetSolver(std::vector<Vec3> vertices, std::vector<Tet> tets);

  /// Which vertices are held. Factors L where that changed. A part of the solid where nothing is held rests.
  void prepare(TetConstraints constraints);

  SolveReport solve(std::span<const TetTarget> targets, const SolveOptions& options,
                    const std::function<bool()>& on_iteration);

  const std::vector<Vec3>& rest() const { return rest_; }
  const std::vector<Vec3>& x() const { return x_; }
  const std::vector<Tet>& tets() const { return tets_; }
  /// x as given; R nearest to it. Turns of handles are then told from x.
  void set_x(std::vector<Vec3> x);
  /// x and R to rest; the next turns count from there.
  void reset();
  void set_interpolation(bool on) { interpolate_ = on; }
  /// For tests of recovery: R_j as given, whatever x is, when the next solve begins [section 3.3].
  void set_rotations(std::span<const Mat3> R);

  TetEnergy& energy() { return energy_; }
  const TetEnergy& energy() const { return energy_; }
  std::size_t free_vertices() const { return free_.size(); }
  std::size_t resting_parts() const { return resting_parts_; }

 private:
  void hold_resting_parts(std::vector<bool>& held);
  void make_fields();
  void place(std::span<const TetTarget> targets);
  std::vector<Vec3> turns_to(std::span<const TetTarget> targets) const;
  void turn_rotations(std::span<const Vec3> turns);
  void turn_handles(std::span<const TetTarget> targets, std::span<const Vec3> turns);
  bool linear_step(TetEnergy::Rotations rotations);

  std::vector<Vec3> rest_, x_;
  std::vector<Tet> tets_;
  TetEnergy energy_;
  TetConstraints constraints_;
  bool prepared_ = false, from_rest_ = true, given_rotations_ = false, interpolate_ = true;
  std::vector<Index> free_;     ///< vertices that are solved for
  std::vector<bool> oriented_;  ///< of each handle: its held vertices fix a rotation
  SparseCholesky cholesky_;
  std::size_t resting_parts_ = 0;
  std::vector<std::vector<float>> fields_;  ///< h_k of each handle in each tet; empty until a handle turns
  std::vector<std::optional<Vec3>> last_turns_;
};

}  // namespace sinew
