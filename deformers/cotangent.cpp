#include "deformers/cotangent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/geometry/check.h"
#include "engine/geometry/parallel.h"

namespace sinew {

namespace {

constexpr std::size_t block = 2048;  // vertices or triangles of a parallel loop
constexpr double least_slack = 1e-2, least_mass = 1e-2;

std::array<double, 3> edge_lengths(std::span<const Vec3> positions, const std::array<Index, 3>& t) {
  std::array<double, 3> l{};  // opposite to each corner
  for (std::size_t c = 0; c < 3; ++c) l[c] = (positions[t[(c + 1) % 3]] - positions[t[(c + 2) % 3]]).norm();
  return l;
}

/// Lengths of a triangle that has an area: each edge is shorter than the others together by `slack` at least.
void widen(std::array<double, 3>& l, double slack) {
  double lacking = 0;
  for (std::size_t c = 0; c < 3; ++c) lacking = std::max(lacking, slack - (l[(c + 1) % 3] + l[(c + 2) % 3] - l[c]));
  for (double& length : l) length += lacking;
}

/// Heron's formula in Kahan's order of operations, which loses no digits on thin triangles.
double area_of(std::array<double, 3> l) {
  std::sort(l.begin(), l.end());
  const auto [c, b, a] = l;
  return std::sqrt(std::max(0.0, (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c)))) / 4;
}

void find_corners(CotangentLaplacian& L, std::size_t n) {
  L.corner_offsets.assign(n + 1, 0);
  for (const auto& t : L.triangles)
    for (const Index v : t) ++L.corner_offsets[v + 1];
  for (std::size_t i = 0; i < n; ++i) L.corner_offsets[i + 1] += L.corner_offsets[i];
  L.corners.resize(3 * L.triangles.size());
  std::vector<Index> next(L.corner_offsets.begin(), L.corner_offsets.end() - 1);
  for (Index t = 0; t < L.triangles.size(); ++t)
    for (Index c = 0; c < 3; ++c) L.corners[next[L.triangles[t][c]]++] = 3 * t + c;
}

void find_rows(CotangentLaplacian& L, std::size_t n) {
  std::vector<std::pair<Index, double>> row;
  for (std::size_t i = 0; i < n; ++i) {
    row.clear();
    for (Index k = L.corner_offsets[i]; k < L.corner_offsets[i + 1]; ++k) {
      const Index t = L.corners[k] / 3, c = L.corners[k] % 3;
      row.emplace_back(L.triangles[t][(c + 1) % 3], L.cot[t][(c + 2) % 3]);
      row.emplace_back(L.triangles[t][(c + 2) % 3], L.cot[t][(c + 1) % 3]);
    }
    // Sums in an order that both ends of an edge share, so that L is symmetric to the bit.
    std::sort(row.begin(), row.end());
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (k > 0 && row[k].first == row[k - 1].first) {
        L.w.back() += row[k].second;
        continue;
      }
      L.to.push_back(row[k].first);
      L.w.push_back(row[k].second);
    }
    L.offsets.push_back(static_cast<Index>(L.to.size()));
  }
}

}  // namespace

CotangentLaplacian cotangent_laplacian(std::span<const Vec3> positions,
                                       const std::vector<std::array<Index, 3>>& triangles) {
  CotangentLaplacian L;
  for (const auto& t : triangles) {
    CHECK(t[0] < positions.size() && t[1] < positions.size() && t[2] < positions.size(), t[0], t[1], t[2]);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) L.triangles.push_back(t);
  }
  double sum = 0;
  for (const auto& t : L.triangles)
    for (const double l : edge_lengths(positions, t)) sum += l;
  const double mean = sum > 0 ? sum / (3 * static_cast<double>(L.triangles.size())) : 1;

  L.cot.resize(L.triangles.size());
  L.area.resize(L.triangles.size());
  L.M.assign(positions.size(), 0);
  double total = 0;
  for (std::size_t t = 0; t < L.triangles.size(); ++t) {
    std::array<double, 3> l = edge_lengths(positions, L.triangles[t]);
    widen(l, least_slack * mean);
    const double area = L.area[t] = area_of(l);
    for (std::size_t c = 0; c < 3; ++c) {
      const double a = l[(c + 1) % 3], b = l[(c + 2) % 3];
      L.cot[t][c] = (a * a + b * b - l[c] * l[c]) / (8 * area);
      L.M[L.triangles[t][c]] += area / 3;
    }
    total += area;
  }
  find_corners(L, positions.size());
  find_rows(L, positions.size());
  std::size_t used = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) used += L.offsets[i] != L.offsets[i + 1];
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (L.offsets[i] != L.offsets[i + 1]) L.M[i] = std::max(L.M[i], least_mass * total / static_cast<double>(used));
  return L;
}

std::vector<Vec3> multiply(const CotangentLaplacian& L, std::span<const Vec3> x) {
  CHECK(x.size() == L.size(), x.size(), L.size());
  std::vector<Vec3> out(x.size(), Vec3::Zero());
  parallel_for(x.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (Index e = L.offsets[i]; e < L.offsets[i + 1]; ++e) out[i] += L.w[e] * (x[i] - x[L.to[e]]);
  });
  return out;
}

std::vector<Vec3> divergence(const CotangentLaplacian& L, std::span<const Mat3> S, std::span<const Vec3> x) {
  CHECK(x.size() == L.size() && S.size() == L.triangles.size(), x.size(), S.size());
  std::vector<Vec3> out(x.size(), Vec3::Zero());
  parallel_for(x.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (Index k = L.corner_offsets[i]; k < L.corner_offsets[i + 1]; ++k) {
        const Index t = L.corners[k] / 3, c = L.corners[k] % 3, d = (c + 1) % 3, e = (c + 2) % 3;
        const auto& corner = L.triangles[t];
        out[i] += S[t] * (L.cot[t][e] * (x[i] - x[corner[d]]) + L.cot[t][d] * (x[i] - x[corner[e]]));
      }
  });
  return out;
}

}  // namespace sinew
