#include "deformers/tet_energy.h"

#include <Eigen/LU>
#include <algorithm>
#include <cstring>
#include <numeric>

#include "engine/geometry/check.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/rotation.h"

namespace sinew {

namespace {

constexpr std::size_t W = lane_count;
constexpr std::size_t block_run = 256 / W;  ///< blocks of one step of a parallel loop
constexpr std::size_t vertex_run = 512;     ///< vertices of one
constexpr std::size_t few = 1024;           ///< tets that are not worth waking other threads for

/// As parallel_for, but without its cost where there is little to do.
template <class Body>
void for_runs(std::size_t n, std::size_t run, bool small, const Body& body) {
  if (small)
    body(std::size_t{0}, n);
  else
    parallel_for(n, run, body);
}

/// Place in the forces of component r of corner i of a tet.
std::size_t force_at(std::size_t block, std::size_t corner, std::size_t r, std::size_t lane) {
  return ((block * 4 + corner) * 3 + r) * W + lane;
}

typedef double Quad __attribute__((vector_size(4 * sizeof(double))));

/// (x, y, z, 0): whole vectors are moved, not their numbers one by one.
Quad quad(const Vec3& p) {
  return Quad{p.x(), p.y(), p.z(), 0};
}

/// Four points as rows -> their x, their y, their z.
void transpose(Quad (&d)[4]) {
  const Quad a = __builtin_shufflevector(d[0], d[1], 0, 4, 2, 6), b = __builtin_shufflevector(d[0], d[1], 1, 5, 3, 7);
  const Quad c = __builtin_shufflevector(d[2], d[3], 0, 4, 2, 6), e = __builtin_shufflevector(d[2], d[3], 1, 5, 3, 7);
  d[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  d[1] = __builtin_shufflevector(b, e, 0, 1, 4, 5);
  d[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
}

}  // namespace

TetEnergy::TetEnergy(std::span<const Vec3> vertices, std::span<const Tet> tets)
    : vertex_count_(vertices.size()), tet_count_(tets.size()), blocks_((tets.size() + W - 1) / W) {
  std::vector<std::vector<std::size_t>> incident(vertex_count_);
  for (Block& block : blocks_)
    for (const std::size_t k : {0, 4, 8}) block.R[k] = Lanes{} + 1.0;
  for (std::size_t j = 0; j < tets.size(); ++j) {
    Block& block = blocks_[j / W];
    const std::size_t lane = j % W;
    Mat3 D;  // rows p_i - p_4, eq. 2.3
    for (int i = 0; i < 3; ++i) D.row(i) = vertices[tets[j][static_cast<std::size_t>(i)]] - vertices[tets[j][3]];
    // An animation may flatten a tet on its way (Deformer::follow): it then has no say.
    const double volume = std::abs(D.determinant()) / 6, size = D.norm();
    const bool flat = !(volume > 1e-12 * size * size * size);
    const Mat3 g = flat ? Mat3(Mat3::Zero()) : Mat3(D.inverse());  // column i: gradient of shape function i
    for (std::size_t k = 0; k < 9; ++k) block.g[k][lane] = g.data()[k];
    block.volume[lane] = block.w[lane] = flat ? 0 : volume;
    for (std::size_t c = 0; c < 4; ++c) {
      block.v[c][lane] = tets[j][c];
      incident[tets[j][c]].push_back(force_at(j / W, c, 0, lane));
    }
  }
  for (const std::vector<std::size_t>& places : incident) {
    incident_.insert(incident_.end(), places.begin(), places.end());
    first_.push_back(incident_.size());
  }
  group_of_.assign(blocks_.size() * W, none);
  energies_.resize(blocks_.size());
  tet_energies_.resize(blocks_.size());
  forces_.resize(blocks_.size() * 12 * W);
  set_ties({});
}

Eigen::Matrix<double, 3, 4> TetEnergy::gradients(Index tet) const {
  const Block& block = blocks_[tet / W];
  Eigen::Matrix<double, 3, 4> out;
  for (std::size_t k = 0; k < 9; ++k) out.data()[k] = block.g[k][tet % W];
  out.col(3) = -out.leftCols<3>().rowwise().sum();
  return out;
}

void TetEnergy::set_stiffness(std::span<const double> factors) {
  CHECK(factors.size() == tet_count_, factors.size(), tet_count_);
  for (std::size_t j = 0; j < tet_count_; ++j)
    blocks_[j / W].w[j % W] = factors[j] * factors[j] * blocks_[j / W].volume[j % W];
}

void TetEnergy::set_groups(std::vector<std::vector<Index>> groups) {
  groups_ = std::move(groups);
  std::fill(group_of_.begin(), group_of_.end(), none);
  for (Index g = 0; g < groups_.size(); ++g)
    for (const Index tet : groups_[g]) group_of_[tet] = g;
  group_rotations_.assign(groups_.size(), Mat3::Identity());
}

void TetEnergy::set_ties(std::vector<TetTie> ties) {
  ties_ = std::move(ties);
  targets_.assign(ties_.size(), Vec3::Zero());
  std::vector<double> diagonal(vertex_count_, 0);
  for (std::size_t j = 0; j < tet_count_; ++j) {
    const Eigen::Matrix<double, 3, 4> g = gradients(static_cast<Index>(j));
    for (int c = 0; c < 4; ++c)
      diagonal[blocks_[j / W].v[static_cast<std::size_t>(c)][j % W]] +=
          blocks_[j / W].w[j % W] * g.col(c).squaredNorm();
  }
  largest_diagonal_ = diagonal.empty() ? 0 : *std::max_element(diagonal.begin(), diagonal.end());
}

void TetEnergy::set_targets(std::vector<Vec3> targets) {
  CHECK(targets.size() == ties_.size(), targets.size(), ties_.size());
  targets_ = std::move(targets);
}

BlockMatrix TetEnergy::laplacian(std::span<const Index> number, Index count, Ties ties) const {
  CHECK(number.size() == vertex_count_, number.size(), vertex_count_);
  struct Entry {
    Index row, column;
    double value;
  };
  std::vector<Entry> entries;
  const auto add = [&](Index a, Index b, double value) {
    const Index i = number[a], j = number[b];
    if (i != none && j != none && i >= j) entries.push_back({i, j, value});
  };
  for (std::size_t j = 0; j < tet_count_; ++j) {
    const Block& block = blocks_[j / W];
    const Eigen::Matrix<double, 3, 4> g = gradients(static_cast<Index>(j));
    const Eigen::Matrix4d K = block.w[j % W] * g.transpose() * g;  // eq. 2.4
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        add(block.v[a][j % W], block.v[b][j % W], K(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
  }
  const std::span<const TetTie> tied = ties == Ties::Yes ? std::span<const TetTie>(ties_) : std::span<const TetTie>();
  for (const TetTie& tie : tied)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < 4; ++b)
        add(tie.vertices[a], tie.vertices[b], tie_weight * largest_diagonal_ * tie.weights[a] * tie.weights[b]);
  std::vector<std::pair<Index, Index>> pairs;
  pairs.reserve(entries.size());
  for (const Entry& e : entries) pairs.emplace_back(e.row, e.column);
  BlockMatrix H = block_pattern(1, count, pairs);
  for (const Entry& e : entries) {
    const auto begin = H.rows.begin() + H.offsets[e.column], end = H.rows.begin() + H.offsets[e.column + 1];
    H.values[static_cast<std::size_t>(std::lower_bound(begin, end, e.row) - H.rows.begin())] += e.value;
  }
  return H;
}

BlockMatrix TetEnergy::laplacian() const {
  std::vector<Index> number(vertex_count_);
  std::iota(number.begin(), number.end(), Index{0});
  return laplacian(number, static_cast<Index>(vertex_count_), Ties::No);
}

Mat3Lanes TetEnergy::maps(const Block& block, std::span<const Vec3> x) const {
  std::array<Lanes, 9> e;  // x_i - x_4, corner by corner
  for (std::size_t l = 0; l < W; l += 4) {
    Quad last[4];
    for (std::size_t k = 0; k < 4; ++k) last[k] = quad(x[block.v[3][l + k]]);
    for (std::size_t i = 0; i < 3; ++i) {
      Quad d[4];
      for (std::size_t k = 0; k < 4; ++k) d[k] = quad(x[block.v[i][l + k]]) - last[k];
      transpose(d);
      for (std::size_t r = 0; r < 3; ++r)
        std::memcpy(reinterpret_cast<double*>(&e[3 * i + r]) + l, &d[r], sizeof(Quad));
    }
  }
  Mat3Lanes T;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 3; ++r)
      T[3 * c + r] = e[r] * block.g[c] + e[3 + r] * block.g[3 + c] + e[6 + r] * block.g[6 + c];
  return T;
}

void TetEnergy::maps(std::span<const Vec3> x, std::span<Mat3> out) const {
  CHECK(x.size() == vertex_count_ && out.size() == tet_count_, x.size(), out.size());
  for_runs(blocks_.size(), block_run, tet_count_ < few, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Mat3Lanes T = maps(blocks_[b], x);
      for (std::size_t l = 0; l < std::min(W, tet_count_ - b * W); ++l)
        for (std::size_t k = 0; k < 9; ++k) out[b * W + l].data()[k] = T[k][l];
    }
  });
}

void TetEnergy::turn_groups(std::span<const Vec3> x) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    Mat3 sum = Mat3::Zero();
    for (const Index tet : groups_[g]) sum += blocks_[tet / W].w[tet % W] * map(tet, x);
    if (sum.squaredNorm() > 0) group_rotations_[g] = nearest_rotation(sum);
  }
}

double TetEnergy::evaluate_block(std::size_t b, std::span<const Vec3> x, Rotations rotations) {
  Block& block = blocks_[b];
  const Mat3Lanes T = maps(block, x);
  if (rotations == Rotations::Nearest) {
    nearest_rotations(T, block.R);
    if (!groups_.empty())
      for (std::size_t l = 0; l < W; ++l)
        if (const Index g = group_of_[b * W + l]; g != none)
          for (std::size_t k = 0; k < 9; ++k) block.R[k][l] = group_rotations_[g].data()[k];
  }
  Mat3Lanes A;
  Lanes squares = {};
  for (std::size_t k = 0; k < 9; ++k) {
    A[k] = T[k] - block.R[k];
    squares += A[k] * A[k];
    A[k] *= block.w;
  }
  Lanes last[3] = {};
  Lanes force;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t r = 0; r < 3; ++r) {
      force = A[r] * block.g[3 * i] + A[3 + r] * block.g[3 * i + 1] + A[6 + r] * block.g[3 * i + 2];
      last[r] -= force;
      std::copy_n(reinterpret_cast<const double*>(&force), W, &forces_[force_at(b, i, r, 0)]);
    }
  for (std::size_t r = 0; r < 3; ++r)
    std::copy_n(reinterpret_cast<const double*>(&last[r]), W, &forces_[force_at(b, 3, r, 0)]);
  tet_energies_[b] = block.w * squares;
  double sum = 0;
  for (std::size_t l = 0; l < W; ++l) sum += tet_energies_[b][l];
  return sum;
}

double TetEnergy::evaluate(std::span<const Vec3> x, Rotations rotations, std::span<Vec3> half_gradient) {
  CHECK(x.size() == vertex_count_ && half_gradient.size() == vertex_count_, x.size(), half_gradient.size());
  if (rotations == Rotations::Nearest) turn_groups(x);
  const bool small = tet_count_ < few;
  for_runs(blocks_.size(), block_run, small, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) energies_[b] = evaluate_block(b, x, rotations);
  });
  for_runs(vertex_count_, vertex_run, small, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t k = first_[v]; k < first_[v + 1]; ++k) {
        const double* force = &forces_[incident_[k]];
        sum += Vec3(force[0], force[W], force[2 * W]);
      }
      half_gradient[v] = sum;
    }
  });
  return std::accumulate(energies_.begin(), energies_.end(), 0.0) + add_ties(x, half_gradient);
}

double TetEnergy::add_ties(std::span<const Vec3> x, std::span<Vec3> half_gradient) {
  const double k = tie_weight * largest_diagonal_;
  tie_energy_ = 0;
  for (std::size_t i = 0; i < ties_.size(); ++i) {
    const TetTie& tie = ties_[i];
    Vec3 off = -targets_[i];
    for (std::size_t a = 0; a < 4; ++a) off += tie.weights[a] * x[tie.vertices[a]];
    tie_energy_ += k * off.squaredNorm();
    for (std::size_t a = 0; a < 4; ++a) half_gradient[tie.vertices[a]] += k * tie.weights[a] * off;
  }
  return tie_energy_;
}

Mat3 TetEnergy::rotation(Index tet) const {
  Mat3 R;
  for (std::size_t k = 0; k < 9; ++k) R.data()[k] = blocks_[tet / W].R[k][tet % W];
  return R;
}

void TetEnergy::set_rotation(Index tet, const Mat3& R) {
  for (std::size_t k = 0; k < 9; ++k) blocks_[tet / W].R[k][tet % W] = R.data()[k];
}

Mat3 TetEnergy::map(Index tet, std::span<const Vec3> x) const {
  const Block& block = blocks_[tet / W];
  const Eigen::Matrix<double, 3, 4> g = gradients(tet);
  Mat3 T = Mat3::Zero();
  for (int c = 0; c < 4; ++c) T += x[block.v[static_cast<std::size_t>(c)][tet % W]] * g.col(c).transpose();
  return T;
}

std::vector<double> TetEnergy::tet_energies() const {
  std::vector<double> out(tet_count_);
  for (std::size_t j = 0; j < tet_count_; ++j) out[j] = tet_energies_[j / W][j % W];
  return out;
}

}  // namespace sinew
