#include "engine/geometry/nearest.h"

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/geometry/check.h"
#include "engine/geometry/parallel.h"

namespace sinew {

using Distance = flann::L2_Simple<double>;

struct NearestTree::Tree {
  std::vector<Eigen::Vector3d> points;
  flann::KDTreeSingleIndex<Distance> index;

  explicit Tree(std::span<const Eigen::Vector3d> from)
      : points(from.begin(), from.end()),
        index(flann::Matrix<double>(points.empty() ? nullptr : points[0].data(), points.size(), 3),
              flann::KDTreeSingleIndexParams(10, /*reorder=*/true)) {
    if (!points.empty()) index.buildIndex();
  }
};

NearestTree::NearestTree(std::span<const Eigen::Vector3d> points) {
  for (const Eigen::Vector3d& p : points) CHECK(p.allFinite(), p.transpose());
  tree_ = std::make_unique<Tree>(points);
}
NearestTree::~NearestTree() = default;
NearestTree::NearestTree(NearestTree&&) noexcept = default;
NearestTree& NearestTree::operator=(NearestTree&&) noexcept = default;

std::size_t NearestTree::size() const {
  return tree_->points.size();
}

std::span<const Eigen::Vector3d> NearestTree::points() const {
  return tree_->points;
}

void NearestTree::nearest(std::span<const Eigen::Vector3d> queries, int k, std::span<std::uint32_t> out_index,
                          std::span<double> out_distance) const {
  const auto width = static_cast<std::size_t>(k);
  CHECK(k > 0 && out_index.size() == queries.size() * width && out_distance.size() == out_index.size(), k,
        queries.size(), out_index.size());
  std::fill(out_index.begin(), out_index.end(), none);
  std::fill(out_distance.begin(), out_distance.end(), std::numeric_limits<double>::infinity());
  const std::size_t found = std::min(width, size());
  if (found == 0) return;
  const flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED, 0.0F);

  parallel_for(queries.size(), 1024, [&](std::size_t begin, std::size_t end) {
    flann::KNNSimpleResultSet<double> result(found);
    std::vector<std::size_t> index(found);
    std::vector<double> square(found);
    std::vector<std::pair<double, std::uint32_t>> row(found);
    for (std::size_t q = begin; q < end; ++q) {
      // FLANN leaves its output uninitialised for a query that is not finite.
      if (!queries[q].allFinite()) continue;
      Eigen::Vector3d query = queries[q];
      result.clear();
      tree_->index.findNeighbors(result, query.data(), exact);
      result.copy(index.data(), square.data(), found);
      for (std::size_t i = 0; i < found; ++i) row[i] = {square[i], static_cast<std::uint32_t>(index[i])};
      std::sort(row.begin(), row.end());
      for (std::size_t i = 0; i < found; ++i) {
        out_index[q * width + i] = row[i].second;
        out_distance[q * width + i] = std::sqrt(row[i].first);
      }
    }
  });
}

}  // namespace sinew
