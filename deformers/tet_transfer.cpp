#include "deformers/tet_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/geometry/bounds.h"
#include "engine/geometry/check.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/parallel.h"

namespace sinew {

namespace {

/// Centres sorted into cells as wide as r: those within r of a point are in the 27 cells around it.
class Cells {
 public:
  Cells(const std::vector<Vec3>& centres, double radius) : bounds_(bounds_of(centres)), width_(radius) {
    const Vec3 extent = bounds_.max - bounds_.min;
    width_ = std::max(width_, extent.maxCoeff() / most);
    for (int a = 0; a < 3; ++a) count_[a] = width_ > 0 ? static_cast<int>(extent[a] / width_) + 1 : 1;
    std::vector<Index> cell(centres.size());
    first_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2] + 1, 0);
    for (std::size_t i = 0; i < centres.size(); ++i) {
      std::array<int, 3> at = cell_of(centres[i]);
      for (int a = 0; a < 3; ++a) at[a] = std::clamp(at[a], 0, count_[a] - 1);
      cell[i] = number(at);
      ++first_[cell[i] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    sorted_.resize(centres.size());
    for (Index i = 0; i < centres.size(); ++i) sorted_[next[cell[i]]++] = i;
  }

  template <class Visit>
  void around(const Vec3& p, const Visit& visit) const {
    const std::array<int, 3> at = cell_of(p);
    for (int z = std::max(at[2] - 1, 0); z <= std::min(at[2] + 1, count_[2] - 1); ++z)
      for (int y = std::max(at[1] - 1, 0); y <= std::min(at[1] + 1, count_[1] - 1); ++y) {
        const int from = std::max(at[0] - 1, 0), to = std::min(at[0] + 1, count_[0] - 1);
        if (from > to) continue;
        const Index begin = first_[number({from, y, z})], end = first_[number({to, y, z}) + 1];
        for (Index k = begin; k < end; ++k) visit(sorted_[k]);
      }
  }

 private:
  static constexpr int most = 128;  ///< cells along an axis
  std::array<int, 3> cell_of(const Vec3& p) const {
    std::array<int, 3> out;
    for (int a = 0; a < 3; ++a) {
      const double at = width_ > 0 ? std::floor((p[a] - bounds_.min[a]) / width_) : 0;
      out[static_cast<std::size_t>(a)] = static_cast<int>(std::clamp(at, -2.0, count_[a] + 1.0));
    }
    return out;
  }
  Index number(const std::array<int, 3>& at) const {
    return static_cast<Index>((at[2] * count_[1] + at[1]) * count_[0] + at[0]);
  }

  Bounds bounds_;
  double width_;
  std::array<int, 3> count_{};
  std::vector<Index> first_, sorted_;
};

/// phi and its derivative by d, over r.
std::pair<double, double> wendland(double d, double r) {
  const double u = d / r, rest = std::max(0.0, 1 - u);
  const double cube = rest * rest * rest;
  return {cube * rest * (4 * u + 1), -20 * u * cube / r};
}

/// The row of one point, by maps without repeats.
struct Row {
  std::vector<Index> maps;
  std::vector<double> weights;
  std::vector<Vec3> gradients;
};

class RowMaker {
 public:
  RowMaker(const TetFaces& faces, std::size_t maps) : faces_(faces), place_(maps, 0) {}

  void clear() {
    for (const Index map : row_.maps) place_[map] = 0;
    row_ = {std::move(row_.maps), std::move(row_.weights), std::move(row_.gradients)};
    row_.maps.clear();
    row_.weights.clear();
    row_.gradients.clear();
  }
  void add(Index face, const Vec3& p, double r) {
    const Vec3 away = p - faces_.centres[face];
    const double squares = away.squaredNorm();
    if (!(squares < r * r)) return;
    const double d = std::sqrt(squares);
    const auto [phi, slope] = wendland(d, r);
    Index& place = place_[faces_.tets[face]];
    if (place == 0) {
      row_.maps.push_back(faces_.tets[face]);
      row_.weights.push_back(0);
      row_.gradients.push_back(Vec3::Zero());
      place = static_cast<Index>(row_.maps.size());
    }
    row_.weights[place - 1] += phi;
    if (d > 0) row_.gradients[place - 1] += slope / d * away;
  }
  /// Weights that sum to 1, with their gradients.
  Row& normalised() {
    const double sum = std::accumulate(row_.weights.begin(), row_.weights.end(), 0.0);
    Vec3 slope = Vec3::Zero();
    for (const Vec3& g : row_.gradients) slope += g;
    for (std::size_t k = 0; k < row_.maps.size(); ++k) {
      row_.weights[k] /= sum;
      row_.gradients[k] = (row_.gradients[k] - row_.weights[k] * slope) / sum;
    }
    return row_;
  }
  bool empty() const { return row_.maps.empty(); }

 private:
  const TetFaces& faces_;
  std::vector<Index> place_;  ///< of each map, 1 + its place in the row; 0: not there
  Row row_;
};

constexpr std::size_t run = 4096;

}  // namespace

TetFaces faces_of(const TetMesh& mesh) {
  const TetMesh::Boundary boundary = mesh.boundary();
  TetFaces out{{}, boundary.tets, TetFaces::part * bounds_of(mesh.vertices).diagonal()};
  for (const auto& [a, b, c] : boundary.faces)
    out.centres.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  return out;
}

SkinWeights transfer_weights(const TetFaces& faces, std::span<const Vec3> points, Gradients gradients,
                             std::size_t* widened, const std::function<bool(double)>& progress) {
  CHECK(!faces.centres.empty());
  const Cells cells(faces.centres, faces.radius);
  const NearestTree tree(faces.centres);
  const std::size_t maps = *std::max_element(faces.tets.begin(), faces.tets.end()) + std::size_t{1};
  const bool slopes = gradients == Gradients::Yes;
  SkinWeights out;
  std::size_t wide = 0;
  // A part of the points at a time: progress is told in between.
  constexpr std::size_t part = 64 * run;
  for (std::size_t first = 0; first < points.size(); first += part) {
    if (progress && !progress(static_cast<double>(first) / static_cast<double>(points.size()))) return out;
    const std::size_t count = std::min(part, points.size() - first);
    std::vector<SkinWeights> runs((count + run - 1) / run);
    std::vector<std::size_t> wides(runs.size(), 0);
    parallel_for(count, run, [&](std::size_t begin, std::size_t end) {
      SkinWeights& rows = runs[begin / run];
      RowMaker maker(faces, maps);
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3& p = points[first + i];
        maker.clear();
        if (p.allFinite()) {
          cells.around(p, [&](Index face) { maker.add(face, p, faces.radius); });
          if (maker.empty()) {
            std::array<Index, 1> near;
            std::array<double, 1> distance;
            tree.nearest(std::span(&p, 1), 1, near, distance);
            const double r = std::max(2 * (p - faces.centres[near[0]]).norm(), 1e-300);
            for (Index face = 0; face < faces.centres.size(); ++face) maker.add(face, p, r);
            ++wides[begin / run];
          }
          const Row& row = maker.normalised();
          for (std::size_t k = 0; k < row.maps.size(); ++k) {
            rows.maps.push_back(row.maps[k]);
            rows.weights.push_back(static_cast<float>(row.weights[k]));
            if (slopes) rows.gradients.push_back(row.gradients[k].cast<float>());
          }
        }
        rows.offsets.push_back(rows.maps.size());
      }
    });
    for (const SkinWeights& rows : runs) {
      const std::uint64_t base = out.maps.size();
      for (std::size_t i = 1; i < rows.offsets.size(); ++i) out.offsets.push_back(base + rows.offsets[i]);
      out.maps.insert(out.maps.end(), rows.maps.begin(), rows.maps.end());
      out.weights.insert(out.weights.end(), rows.weights.begin(), rows.weights.end());
      out.gradients.insert(out.gradients.end(), rows.gradients.begin(), rows.gradients.end());
    }
    wide += std::accumulate(wides.begin(), wides.end(), std::size_t{0});
  }
  if (widened != nullptr) *widened = wide;
  return out;
}

}  // namespace sinew
