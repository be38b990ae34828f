#pragma once
/// Limited-memory BFGS around a fixed approximation of the Hessian [Nocedal 1980; Nocedal and Wright 2006,
/// algorithm 7.4]: what the last steps told of the curvature that the approximation lacks.

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace sinew {

class Curvature {
 public:
  using Vector = Eigen::VectorXd;

  /// Keeps the last `memory` pairs. A pair whose s'y is not above `least` |s| |y| says nothing of use and is passed
  /// over.
  Curvature(std::size_t memory, double least) : memory_(memory), least_(least) {}

  bool empty() const { return pairs_.empty(); }
  void clear() { pairs_.clear(); }

  /// The gradient changed by y over the step s.
  void add(Vector s, Vector y) {
    const double sy = s.dot(y);
    if (!(sy > least_ * s.norm() * y.norm())) return;
    if (pairs_.size() == memory_) pairs_.erase(pairs_.begin());
    pairs_.push_back({std::move(s), std::move(y), 1 / sy});
  }

  /// step <- -(approximate Hessian)^-1 g; inverse(v): v <- (fixed approximation)^-1 v.
  template <class Inverse>
  void solve(const Inverse& inverse, const Vector& g, Vector& step) const {
    step = -g;
    std::vector<double> a(pairs_.size());
    for (std::size_t i = pairs_.size(); i-- > 0;) {
      a[i] = pairs_[i].rho * pairs_[i].s.dot(step);
      step -= a[i] * pairs_[i].y;
    }
    inverse(step);
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      step += (a[i] - pairs_[i].rho * pairs_[i].y.dot(step)) * pairs_[i].s;
  }

 private:
  struct Pair {
    Vector s, y;
    double rho;
  };
  std::size_t memory_;
  double least_;
  std::vector<Pair> pairs_;
};

}  // namespace sinew
