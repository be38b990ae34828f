#include "engine/geometry/surface_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/geometry/bounds.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/surface_pieces.h"

namespace sinew {

namespace {

using Points = std::vector<Vec3>;

constexpr std::size_t samples = 600;  // places of the coarse stage
constexpr int coarse_iterations = 60, fine_iterations = 60;
constexpr std::size_t refined = 24;     // starts that get to the fine stage
constexpr double delta = 0.02;          // diagonals
constexpr double longest_piece = 0.02;  // diagonals

Vec3 mean_of(const Points& points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

Mat3 scatter_of(const Points& points) {
  const Vec3 mean = mean_of(points);
  Mat3 out = Mat3::Zero();
  for (const Vec3& p : points) out += (p - mean) * (p - mean).transpose();
  return out / static_cast<double>(points.size());
}

/// Weighted pairs p -> q, and the similarity that is nearest to them in least squares [Umeyama 1991, eq. 34-43].
class Pairs {
 public:
  void add(double weight, const Vec3& p, const Vec3& q) {
    w_ += weight;
    p_ += weight * p;
    q_ += weight * q;
    pp_ += weight * p.squaredNorm();
    qp_ += weight * q * p.transpose();
  }
  Similarity fit(std::optional<double> scale) const {
    const Vec3 p = p_ / w_, q = q_ / w_;
    const Mat3 S = qp_ / w_ - q * p.transpose();
    const double variance = pp_ / w_ - p.squaredNorm();
    const Eigen::JacobiSVD<Mat3, Eigen::ComputeFullU | Eigen::ComputeFullV> svd(S);
    Vec3 sign = Vec3::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) sign[2] = -1;
    Similarity out;
    out.R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
    out.scale = scale ? *scale : svd.singularValues().dot(sign) / variance;
    out.t = q - out.scale * (out.R * p);
    return out;
  }

 private:
  double w_ = 0, pp_ = 0;
  Vec3 p_ = Vec3::Zero(), q_ = Vec3::Zero();
  Mat3 qp_ = Mat3::Zero();
};

struct Candidate {
  Similarity map;
  double cost = std::numeric_limits<double>::infinity();
};

/// What both stages work on, in the surface's normalised coordinates.
struct Problem {
  Points points, places;
  const SurfacePieces* surface = nullptr;
  std::optional<double> scale;
};

/// One step of the coarse stage: pairs under `map`, and the root of their mean squared distances.
double pair_up(const Problem& problem, const Similarity& map, Pairs& pairs) {
  const std::size_t n = problem.points.size(), m = problem.places.size();
  Points laid(n);
  for (std::size_t i = 0; i < n; ++i) laid[i] = map(problem.points[i]);
  std::vector<std::size_t> place_of(n, 0);
  std::vector<double> distance_of(n, std::numeric_limits<double>::infinity());
  double sum = 0;
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const double d = (laid[i] - problem.places[k]).squaredNorm();
      if (d < least) {
        least = d;
        nearest = i;
      }
      if (d < distance_of[i]) {
        distance_of[i] = d;
        place_of[i] = k;
      }
    }
    pairs.add(1 / static_cast<double>(m), problem.points[nearest], problem.places[k]);
    sum += least / static_cast<double>(m);
  }
  for (std::size_t i = 0; i < n; ++i) {
    pairs.add(1 / static_cast<double>(n), problem.points[i], problem.places[place_of[i]]);
    sum += distance_of[i] / static_cast<double>(n);
  }
  return std::sqrt(sum);
}

Candidate coarse(const Problem& problem, Similarity map) {
  Candidate out;
  for (int i = 0; i < coarse_iterations; ++i) {
    Pairs pairs;
    const double cost = pair_up(problem, map, pairs);
    if (!(cost < out.cost * (1 - 1e-6))) break;
    out = {map, cost};
    map = pairs.fit(problem.scale);
    if (!(map.scale > 0)) break;
  }
  return out;
}

/// The 24 rotations that take the axes to each other.
std::vector<Mat3> turns_of_a_cube() {
  std::vector<Mat3> out;
  std::array<int, 3> axes{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Mat3 R = Mat3::Zero();
      for (int k = 0; k < 3; ++k) R(axes[static_cast<std::size_t>(k)], k) = (signs >> k & 1) != 0 ? -1 : 1;
      if (R.determinant() > 0) out.push_back(R);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return out;
}

std::vector<Similarity> starts_of(const Problem& problem) {
  const Mat3 own = scatter_of(problem.points), wanted = scatter_of(problem.places);
  const auto axes = [](const Mat3& scatter) {
    Mat3 out = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors();
    if (out.determinant() < 0) out.col(0) *= -1;
    return out;
  };
  const Mat3 own_axes = axes(own), wanted_axes = axes(wanted);
  std::vector<Similarity> out;
  const auto eighth = [](int axis) {
    return Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::Unit(axis)).toRotationMatrix();
  };
  for (const Mat3& turn : turns_of_a_cube())
    for (const Mat3& R : {turn, Mat3(eighth(0) * turn), Mat3(eighth(1) * turn), Mat3(eighth(2) * turn),
                          Mat3(wanted_axes * turn * own_axes.transpose())}) {
      Points turned;
      for (const Vec3& p : problem.points) turned.push_back(R * p);
      const Bounds from = bounds_of(turned), to = bounds_of(problem.places);
      const double by_spread = std::sqrt(wanted.trace() / own.trace()), by_box = to.diagonal() / from.diagonal();
      Similarity spread{problem.scale.value_or(by_spread), R, {}}, box{problem.scale.value_or(by_box), R, {}};
      spread.t = mean_of(problem.places) - spread.scale * mean_of(turned);
      box.t = to.centre() - box.scale * from.centre();
      out.push_back(spread);
      out.push_back(box);
    }
  return out;
}

double rho(double d) {
  return d * d / (1 + d * d / (delta * delta));
}

double robust_cost(const Problem& problem, const Similarity& map) {
  double sum = 0;
  for (const Vec3& p : problem.points) {
    const Vec3 q = map(p);
    sum += rho((q - problem.surface->nearest(q).at).norm());
  }
  return sum / static_cast<double>(problem.points.size());
}

/// JtJ and -Jtr of the distances along normals, by [turn about the mean of the laid points, move, log of the scale].
void assemble(const Problem& problem, const Similarity& map, const Vec3& centre, Eigen::Matrix<double, 7, 7>& JtJ,
              Eigen::Matrix<double, 7, 1>& minus_Jtr) {
  JtJ.setZero();
  minus_Jtr.setZero();
  for (const Vec3& p : problem.points) {
    const Vec3 q = map(p);
    const SurfacePieces::Place place = problem.surface->nearest(q);
    const Vec3 away = q - place.at;
    const double d = away.norm(), falls = 1 + d * d / (delta * delta), w = 1 / (falls * falls);
    // On the surface the way to it has no direction. A place of an edge or of a point alone has its own.
    const Vec3 n = d > 1e-9 ? Vec3(away / d) : place.normal;
    Eigen::Matrix<double, 7, 1> J;
    J << (q - centre).cross(n), n, problem.scale ? 0 : n.dot(q - centre);
    JtJ += w * J * J.transpose();
    minus_Jtr -= w * n.dot(away) * J;
  }
}

Similarity stepped(const Similarity& map, const Vec3& centre, const Eigen::Matrix<double, 7, 1>& x) {
  const Vec3 w = x.head<3>();
  const Mat3 turn = Eigen::AngleAxisd(w.norm(), w.stableNormalized()).toRotationMatrix();
  const double grown = std::exp(std::clamp(x[6], -0.5, 0.5));
  Similarity out;
  out.scale = map.scale * grown;
  out.R = turn * map.R;
  out.t = grown * (turn * (map.t - centre)) + centre + x.segment<3>(3);
  return out;
}

Candidate fine(const Problem& problem, Similarity map) {
  double cost = robust_cost(problem, map), damping = 1e-3;
  for (int i = 0; i < fine_iterations && damping < 1e6; ++i) {
    Vec3 centre = Vec3::Zero();
    for (const Vec3& p : problem.points) centre += map(p) / static_cast<double>(problem.points.size());
    Eigen::Matrix<double, 7, 7> JtJ;
    Eigen::Matrix<double, 7, 1> minus_Jtr;
    assemble(problem, map, centre, JtJ, minus_Jtr);
    const double size = JtJ.trace();
    bool taken = false;
    for (; !taken && damping < 1e6; damping = taken ? std::max(1e-12, damping / 10) : damping * 4) {
      Eigen::Matrix<double, 7, 7> damped = JtJ;
      damped.diagonal().array() += damping * size;
      const Similarity next = stepped(map, centre, damped.ldlt().solve(minus_Jtr));
      const double now = robust_cost(problem, next);
      taken = now < cost;
      if (!taken) continue;
      const bool settled = now > cost * (1 - 1e-9);
      map = next;
      cost = now;
      if (settled) return {map, cost};
    }
  }
  return {map, cost};
}

bool alike(const Similarity& a, const Similarity& b) {
  const double cosine = ((a.R.transpose() * b.R).trace() - 1) / 2;
  return cosine > std::cos(0.1) && std::abs(std::log(a.scale / b.scale)) < 0.05 && (a.t - b.t).norm() < 0.05;
}

/// The best few of the coarse stage, each far from the others.
std::vector<Candidate> best_of(std::vector<Candidate> all) {
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  std::vector<Candidate> out;
  for (const Candidate& c : all) {
    if (out.size() == refined || !std::isfinite(c.cost)) break;
    if (std::none_of(out.begin(), out.end(), [&](const Candidate& o) { return alike(o.map, c.map); })) out.push_back(c);
  }
  return out;
}

SurfaceFit measured(const Problem& problem, const Similarity& map) {
  SurfaceFit out{map};
  const double share = 1 / static_cast<double>(problem.points.size());
  double sum = 0;
  std::size_t near = 0;
  for (const Vec3& p : problem.points) {
    const Vec3 q = map(p);
    const double d = (q - problem.surface->nearest(q).at).norm();
    if (d <= delta) ++near;
    sum += share * d * d;
    out.max = std::max(out.max, d);
  }
  out.near = static_cast<double>(near) / static_cast<double>(problem.points.size());
  out.rms = std::sqrt(sum);
  return out;
}

/// What both say: points far from the surface, and surface far from points.
double judged(const Problem& problem, const Similarity& map) {
  Pairs unused;
  return std::sqrt(robust_cost(problem, map)) * pair_up(problem, map, unused);
}

}  // namespace

std::optional<SurfaceFit> fit_to_surface(std::span<const Vec3> points, const Shape& surface,
                                         std::optional<double> scale) {
  const Normalization normal = normalization_of(bounds_of(surface.positions));
  if (points.size() < 3 || !(bounds_of(surface.positions).diagonal() > 0)) return std::nullopt;
  Shape unit;
  unit.faces = surface.faces;
  for (const Vec3& p : surface.positions) unit.positions.push_back(normal.apply(p));
  const SurfacePieces pieces(unit, longest_piece);
  if (pieces.empty()) return std::nullopt;

  Problem problem{{points.begin(), points.end()}, pieces.spread(samples), &pieces, {}};
  std::sort(problem.points.begin(), problem.points.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  const Vec3 own_centre = mean_of(problem.points);
  const Mat3 scatter = scatter_of(problem.points);
  const Vec3 extents = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvalues();
  if (!(extents[1] > 1e-10 * extents[2])) return std::nullopt;
  const double own_size = std::sqrt(scatter.trace());
  for (Vec3& p : problem.points) p = (p - own_centre) / own_size;
  if (scale) problem.scale = *scale * own_size * normal.scale;

  const std::vector<Similarity> starts = starts_of(problem);
  std::vector<Candidate> all(starts.size());
  parallel_for(starts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) all[i] = coarse(problem, starts[i]);
  });
  std::vector<Candidate> best = best_of(std::move(all));
  parallel_for(best.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Similarity map = fine(problem, best[i].map).map;
      // One that has shrunk into the surface lies well on it and tells nothing.
      const double grown = map.scale / best[i].map.scale;
      best[i] = {map, grown > 0.5 && grown < 2 ? judged(problem, map) : std::numeric_limits<double>::infinity()};
    }
  });
  const auto least =
      std::min_element(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  if (least == best.end() || !std::isfinite(least->cost)) return std::nullopt;
  SurfaceFit out = measured(problem, least->map);
  out.map.scale = least->map.scale / (own_size * normal.scale);
  out.map.t = normal.undo(least->map.t) - out.map.scale * (out.map.R * own_centre);
  return out;
}

}  // namespace sinew
