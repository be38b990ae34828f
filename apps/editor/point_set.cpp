#include "apps/editor/point_set.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "apps/editor/keys.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/topology.h"

namespace sinew::editor {

namespace {

std::span<const Index> neighbours_of(const Neighbourhood& neighbourhood, std::size_t i) {
  return std::span(neighbourhood.neighbours)
      .subspan(neighbourhood.offsets[i], neighbourhood.offsets[i + 1] - neighbourhood.offsets[i]);
}

/// CSR of both directions of each pair.
void join_pairs(std::span<const std::pair<Index, Index>> pairs, std::size_t n, Neighbourhood& out) {
  out.offsets.assign(n + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++out.offsets[a + 1];
    ++out.offsets[b + 1];
  }
  for (std::size_t i = 0; i < n; ++i) out.offsets[i + 1] += out.offsets[i];
  out.neighbours.resize(2 * pairs.size());
  std::vector<std::uint64_t> next(out.offsets.begin(), out.offsets.end() - 1);
  for (const auto& [a, b] : pairs) {
    out.neighbours[next[a]++] = b;
    out.neighbours[next[b]++] = a;
  }
}

/// The 8 nearest of each finite point that are nearer than 4 times the median distance between neighbours.
void join_nearest(const Shape& shape, Neighbourhood& out) {
  constexpr int k = 9;  // the point itself among them
  const std::vector<Index> finite = finite_points(shape.positions).indices();
  std::vector<Vec3> points;
  points.reserve(finite.size());
  for (const Index i : finite) points.push_back(shape.positions[i]);
  std::vector<std::uint32_t> nearest;
  std::vector<double> distance;
  const int columns = static_cast<int>(std::min<std::size_t>(k, points.size()));
  if (columns > 1) {
    nearest.resize(points.size() * k);
    distance.resize(points.size() * k);
    NearestTree(points).nearest(points, k, nearest, distance);
  }
  std::vector<double> spacing;
  for (std::size_t i = 0; columns > 1 && i < points.size(); ++i) spacing.push_back(distance[i * k + 1]);
  double reach = 0;
  if (!spacing.empty()) {
    const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
    std::nth_element(spacing.begin(), middle, spacing.end());
    reach = 4 * *middle;
  }
  out.offsets.assign(1, 0);
  for (std::size_t i = 0, row = 0; i < shape.size(); ++i) {
    if (row < finite.size() && finite[row] == i) {
      for (std::size_t e = row * k; columns > 1 && e < (row + 1) * k; ++e)
        if (nearest[e] != NearestTree::none && nearest[e] != row && distance[e] <= reach)
          out.neighbours.push_back(finite[nearest[e]]);
      ++row;
    }
    out.offsets.push_back(out.neighbours.size());
  }
}

}  // namespace

PointSet::PointSet(std::size_t n, std::span<const Index> points) : PointSet(n) {
  for (const Index i : points) {
    CHECK(i < n, i, n);
    words_[i / 64] |= std::uint64_t{1} << (i % 64);
  }
  recount();
}

void PointSet::add(std::size_t i) {
  CHECK(i < size_, i, size_);
  count_ += !(*this)[i];
  words_[i / 64] |= std::uint64_t{1} << (i % 64);
}

void PointSet::remove(std::size_t i) {
  CHECK(i < size_, i, size_);
  count_ -= (*this)[i];
  words_[i / 64] &= ~(std::uint64_t{1} << (i % 64));
}

void PointSet::clear() {
  std::fill(words_.begin(), words_.end(), 0);
  count_ = 0;
}

std::vector<Index> PointSet::indices() const {
  std::vector<Index> out;
  out.reserve(count_);
  each([&](std::size_t i) { out.push_back(static_cast<Index>(i)); });
  return out;
}

void PointSet::recount() {
  count_ = 0;
  for (const std::uint64_t word : words_) count_ += static_cast<std::size_t>(std::popcount(word));
}

SelectMode select_mode(int modifiers) {
  if (modifiers & modifier::control) return SelectMode::Remove;
  return modifiers & modifier::shift ? SelectMode::Add : SelectMode::Replace;
}

PointSet combined(const PointSet& selection, const PointSet& touched, SelectMode mode) {
  CHECK(selection.size() == touched.size(), selection.size(), touched.size());
  if (mode == SelectMode::Replace) return touched;
  PointSet out = selection;
  const std::span<std::uint64_t> words = out.words();
  for (std::size_t w = 0; w < words.size(); ++w)
    words[w] = mode == SelectMode::Add ? words[w] | touched.words()[w] : words[w] & ~touched.words()[w];
  out.recount();
  return out;
}

PointSet intersected(const PointSet& a, const PointSet& b) {
  CHECK(a.size() == b.size(), a.size(), b.size());
  PointSet out = a;
  for (std::size_t w = 0; w < out.words().size(); ++w) out.words()[w] &= b.words()[w];
  out.recount();
  return out;
}

PointSet inverted(const PointSet& selection, const PointSet& selectable) {
  return combined(selectable, selection, SelectMode::Remove);
}

PointSet finite_points(std::span<const Vec3> positions) {
  return set_where(positions.size(), [&](std::size_t i) { return positions[i].allFinite(); });
}

Neighbourhood neighbourhood_of(const Shape& shape) {
  Neighbourhood out;
  if (shape.faces.empty())
    join_nearest(shape, out);
  else
    join_pairs(edges_of(shape.faces), shape.size(), out);
  out.component = connected_components(shape).of_point;
  return out;
}

PointSet grown(const PointSet& selection, const Neighbourhood& neighbourhood) {
  return set_where(selection.size(), [&](std::size_t i) {
    if (selection[i]) return true;
    const auto around = neighbours_of(neighbourhood, i);
    return std::any_of(around.begin(), around.end(), [&](Index j) { return selection[j]; });
  });
}

PointSet shrunk(const PointSet& selection, const Neighbourhood& neighbourhood) {
  return set_where(selection.size(), [&](std::size_t i) {
    if (!selection[i]) return false;
    const auto around = neighbours_of(neighbourhood, i);
    return std::all_of(around.begin(), around.end(), [&](Index j) { return selection[j]; });
  });
}

PointSet connected(const PointSet& selection, const Neighbourhood& neighbourhood) {
  std::vector<bool> touched(selection.size() + 1, false);
  selection.each([&](std::size_t i) {
    if (neighbourhood.component[i] != Components::none) touched[neighbourhood.component[i]] = true;
  });
  return set_where(selection.size(), [&](std::size_t i) {
    return neighbourhood.component[i] != Components::none && touched[neighbourhood.component[i]];
  });
}

}  // namespace sinew::editor
