#pragma once
/// Fluid: particles in a box that flow by position based fluids [Macklin and Müller, "Position Based Fluids", SIGGRAPH
/// 2013]. SI units, y up. Per step, of dt seconds:
///
///   predict    v += dt g, p = x + dt v
///   correct    iterations times: C_i = sum_j W(p_i - p_j) / rho0 - 1 where that is positive (eq. 1), lambda_i =
///              -C_i / (sum_k |dC_i/dp_k|^2 + eps) (eq. 11), p_i += sum_j (lambda_i + lambda_j) grad W / rho0 (eq. 12),
///              then p back into the box
///   move       u = (p - x) / dt, x = p; v = u + viscosity sum_j W(p_i - p_j) (u_j - u_i) / rho0 (eq. 17)
///
/// W(r) = (1 - |r| / h)^3 within h = 2 spacings, for density and gradient both; rho0 is its sum over a cubic lattice.
/// Unlike the paper, what lies beyond a wall of the box counts as fluid at rest: to C_i it adds the part of W's
/// integral there, 3/2 t^5 - t^6 with t = 1 - distance / h. So fluid at a wall is no denser than elsewhere. Only sums,
/// products, quotients and square roots are used, and each particle adds up its neighbours in the order of the grid's
/// cells: the same bits on any machine with any number of threads.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/geometry/bounds.h"
#include "engine/geometry/shape.h"

namespace sinew::samples {

struct Particle {
  Vec3 x = Vec3::Zero();
  Vec3 v = Vec3::Zero();  ///< metres a second
  std::uint32_t id = 0;
  double age = 0;  ///< seconds
};

class Fluid {
 public:
  struct Settings {
    double spacing = 0.02;  ///< metres between particles of the fluid at rest
    Bounds box;             ///< particles stay within
    double dt = 1.0 / 240;
    int iterations = 3;
    double viscosity = 0.05;  ///< within the fluid, part of the way to the neighbours' mean velocity, a step
    double grip = 0;  ///< part of its speed along the floor that a particle within a spacing of it loses in a step
  };
  explicit Fluid(const Settings& settings);

  void add(const Particle& particle);  ///< flows with the others from here on
  void remove_if(const std::function<bool(const Particle&)>& gone);
  void step();

  std::size_t size() const { return states_.size(); }

  /// The particles as they were before the last step, by ascending id. v is the mean of the steps before and after that
  /// moment, a central difference: in free flight the exact one.
  std::vector<Particle> before_last_step() const;

 private:
  struct State {
    Particle now;
    Vec3 x_before = Vec3::Zero();  ///< before the last step
    Vec3 u_before = Vec3::Zero();  ///< of the step before the last
    Vec3 u = Vec3::Zero();         ///< of the last step
  };
  /// Neighbours of a block of particles, one particle's after the other's.
  struct Block {
    std::vector<Index> neighbours;
    std::vector<std::size_t> ends;
  };
  /// Calls body(i, its neighbours) for every particle, on all threads.
  template <class Body>
  void each(const Body& body) const;

  void predict();
  void sort_into_cells();
  void find_neighbours();
  void correct();
  void move();
  void keep_in_box(Vec3& p) const;
  std::array<std::size_t, 3> cell_of(const Vec3& p) const;
  std::size_t number_of(const std::array<std::size_t, 3>& cell) const;
  double weight(double r) const;  ///< W
  /// What the fluid beyond the walls adds to C at p, and its gradient.
  struct Beyond {
    double share = 0;
    Vec3 gradient = Vec3::Zero();
  };
  Beyond beyond_walls(const Vec3& p) const;

  Settings settings_;
  double h_, rho0_ = 0, eps_ = 0;
  std::array<std::size_t, 3> cells_{};
  std::vector<State> states_;
  std::vector<Vec3> p_;  ///< of each state: predicted, then corrected
  std::vector<Vec3> u_;
  std::vector<double> lambda_;
  std::vector<std::size_t> cell_begin_;  ///< the first state of each cell, and their number
  std::vector<Block> blocks_;
};

}  // namespace sinew::samples
