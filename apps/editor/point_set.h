#pragma once
/// PointSet: which of n points, a bit each and their count. A value type.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/parallel.h"
#include "engine/geometry/shape.h"

namespace sinew::editor {

class PointSet {
 public:
  PointSet() = default;
  explicit PointSet(std::size_t n) : size_(n), words_((n + 63) / 64, 0) {}
  /// Of n points those in `points`; each index < n.
  PointSet(std::size_t n, std::span<const Index> points);

  std::size_t size() const { return size_; }    ///< n
  std::size_t count() const { return count_; }  ///< how many are in the set
  bool empty() const { return count_ == 0; }
  bool operator[](std::size_t i) const { return (words_[i / 64] >> (i % 64) & 1) != 0; }

  void add(std::size_t i);
  void remove(std::size_t i);
  void clear();

  /// Ascending.
  std::vector<Index> indices() const;
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t w = 0; w < words_.size(); ++w)
      for (std::uint64_t bits = words_[w]; bits != 0; bits &= bits - 1)
        visit(64 * w + static_cast<std::size_t>(__builtin_ctzll(bits)));
  }

  /// 64 points a word, point 64 w in the lowest bit of word w; bits beyond n are 0. For loops over all points: after
  /// writing words, call recount().
  std::span<std::uint64_t> words() { return words_; }
  std::span<const std::uint64_t> words() const { return words_; }
  void recount();

  bool operator==(const PointSet&) const = default;

 private:
  std::size_t size_ = 0, count_ = 0;
  std::vector<std::uint64_t> words_;
};

/// The set of the points i of n for which `in(i)` holds, which is asked on several threads.
template <class In>
PointSet set_where(std::size_t n, const In& in) {
  constexpr std::size_t word_block = 256;  // 16,384 points
  PointSet out(n);
  const std::span<std::uint64_t> words = out.words();
  parallel_for(words.size(), word_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      std::uint64_t bits = 0;
      const std::size_t last = n - 64 * w < 64 ? n - 64 * w : 64;
      for (std::size_t b = 0; b < last; ++b) bits |= static_cast<std::uint64_t>(in(64 * w + b)) << b;
      words[w] = bits;
    }
  });
  out.recount();
  return out;
}

/// How what a tool touches changes the selection: alone, with Shift, with Ctrl.
enum class SelectMode { Replace, Add, Remove };
SelectMode select_mode(int modifiers);

/// Both of the same n.
PointSet combined(const PointSet& selection, const PointSet& touched, SelectMode mode);

PointSet intersected(const PointSet& a, const PointSet& b);
PointSet inverted(const PointSet& selection, const PointSet& selectable);
/// All points with finite coordinates: what can be selected.
PointSet finite_points(std::span<const Vec3> positions);

/// Which points are beside which: corners of one face, or the 8 nearest in space where there are no faces; and the
/// connected component of each (topology.h).
struct Neighbourhood {
  std::vector<std::uint64_t> offsets{0};  ///< n + 1
  std::vector<Index> neighbours;
  std::vector<Index> component;  ///< n; Components::none where not finite
};
/// Seconds for a million points; to be made on another thread.
Neighbourhood neighbourhood_of(const Shape& shape);

PointSet grown(const PointSet& selection, const Neighbourhood& neighbourhood);   ///< with all neighbours
PointSet shrunk(const PointSet& selection, const Neighbourhood& neighbourhood);  ///< without those beside others
/// All points of the components that `selection` touches.
PointSet connected(const PointSet& selection, const Neighbourhood& neighbourhood);

}  // namespace sinew::editor
