#pragma once
/// Nearest neighbours in space: a k-d tree over fixed points (FLANN's, which is not seen outside nearest.cpp).

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

namespace sinew {

/// A built tree may be asked from several threads at once. Points must be finite.
class NearestTree {
 public:
  explicit NearestTree(std::span<const Eigen::Vector3d> points);
  ~NearestTree();
  NearestTree(NearestTree&&) noexcept;
  NearestTree& operator=(NearestTree&&) noexcept;

  std::size_t size() const;
  std::span<const Eigen::Vector3d> points() const;  ///< in the order of the constructor

  /// The k nearest points of each query, nearest first; equal distances in order of index. out_index, out_distance:
  /// queries x k, row by row; a row has min(k, size) entries, the rest is `none` and infinity. A query that is not
  /// finite has none. Exact; the result does not depend on the number of threads.
  static constexpr std::uint32_t none = ~std::uint32_t{0};
  void nearest(std::span<const Eigen::Vector3d> queries, int k, std::span<std::uint32_t> out_index,
               std::span<double> out_distance) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sinew
