#include "engine/document/field.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "engine/geometry/parallel.h"
#include "engine/geometry/rotation.h"

namespace sinew::document {

namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t block = 4096;

bool bends(const LayerResult& layer, std::size_t n) {
  return layer.pose != nullptr && layer.weights != nullptr && layer.weights->size() == n;
}

/// Moves `position` by a layer, p' = sum_j w_ij (A_j p + t_j), and multiplies M by its matrix there.
void bend(const LayerResult& layer, std::size_t i, Vec3& position, Mat3& M) {
  const SkinWeights& weights = *layer.weights;
  Affine change = Affine::Zero();
  double sum = 0;
  for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e) {
    const double w = static_cast<double>(weights.weights[e]);
    change += w * (*layer.pose)[weights.maps[e]];
    sum += w;
  }
  change.leftCols<3>() += (1 - sum) * Mat3::Identity();  // a point that follows nothing stays
  position = change.leftCols<3>() * position + change.col(3);
  M = change.leftCols<3>() * M;
}

/// `value(position, M)` of every finite point, bent by all layers.
template <class Value>
std::vector<float> of_bent(std::span<const Vec3> rest, std::span<const LayerResult> layers, const Value& value) {
  std::vector<float> out(rest.size(), nothing);
  parallel_for(rest.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!rest[i].allFinite()) continue;
      Vec3 position = rest[i];
      Mat3 M = Mat3::Identity();
      for (const LayerResult& layer : layers)
        if (bends(layer, rest.size())) bend(layer, i, position, M);
      out[i] = static_cast<float>(value(i, position, M));
    }
  });
  return out;
}

/// The numbers of maps, blended by the points' weights and added.
void add_blended(const SkinWeights& weights, std::span<const double> of_maps, std::vector<float>& out) {
  parallel_for(out.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double sum = 0;
      for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
        sum += static_cast<double>(weights.weights[e]) * of_maps[weights.maps[e]];
      out[i] += static_cast<float>(sum);
    }
  });
}

std::vector<float> finite_of(std::span<const float> values) {
  std::vector<float> out;
  const std::size_t stride = values.size() / 200'000 + 1;
  for (std::size_t i = 0; i < values.size(); i += stride)
    if (std::isfinite(values[i])) out.push_back(values[i]);
  return out;
}

double percentile(std::vector<float>& values, double part) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

}  // namespace

std::optional<FieldKind> field_named(std::string_view name) {
  for (std::size_t i = 0; i < std::size(field_names); ++i)
    if (name == field_names[i]) return static_cast<FieldKind>(i);
  return std::nullopt;
}

double stretch_of(const Mat3& M) {
  if (M == Mat3::Identity()) return 0;
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(M.transpose() * M, Eigen::EigenvaluesOnly);
  double out = 0;
  for (int k = 0; k < 3; ++k) {
    const double change = std::sqrt(std::max(0.0, solver.eigenvalues()[k])) - 1;
    if (std::abs(change) > std::abs(out)) out = change;
  }
  return std::abs(out) < 1e-9 ? 0 : out;  // what rounding makes is none
}

double rotation_of(const Mat3& M) {
  if (M == Mat3::Identity()) return 0;
  // Newton's iteration for the polar factor, quadratic where the determinant is positive [Higham 1986]: many times as
  // fast as a singular value decomposition for the matrices of a pose, which are near rotations.
  Mat3 R = M;
  bool done = false;
  for (int k = 0; k < 12 && !done && R.determinant() > 1e-12; ++k) {
    const Mat3 next = 0.5 * (R + R.inverse().transpose());
    done = (next - R).squaredNorm() < 1e-20;
    R = next;
  }
  if (!done) R = nearest_rotation(M);
  const Vec3 axis(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  const double degrees = std::atan2(axis.norm(), R.trace() - 1) * (180 / std::numbers::pi);
  return degrees < 1e-6 ? 0 : degrees;
}

Field field_of(FieldKind kind, std::span<const Vec3> rest, std::span<const LayerResult> layers, Index map) {
  Field out;
  out.name = field_names[static_cast<std::size_t>(kind)];
  out.scale = kind == FieldKind::Stretch ? Field::Scale::Signed : Field::Scale::FromZero;
  switch (kind) {
    case FieldKind::Displacement:
      out.values =
          of_bent(rest, layers, [&](std::size_t i, const Vec3& p, const Mat3&) { return (p - rest[i]).norm(); });
      break;
    case FieldKind::Stretch:
      out.unit = " %";
      out.values = of_bent(rest, layers, [](std::size_t, const Vec3&, const Mat3& M) { return 100 * stretch_of(M); });
      break;
    case FieldKind::Rotation:
      out.unit = "°";
      out.values = of_bent(rest, layers, [](std::size_t, const Vec3&, const Mat3& M) { return rotation_of(M); });
      break;
    case FieldKind::Energy:
      out.values.assign(rest.size(), 0);
      for (const LayerResult& layer : layers)
        if (bends(layer, rest.size()) && layer.map_energy != nullptr)
          add_blended(*layer.weights, *layer.map_energy, out.values);
      break;
    case FieldKind::Influence:
      out.values.assign(rest.size(), 0);
      if (!layers.empty() && bends(layers.front(), rest.size())) {
        std::vector<double> one(layers.front().pose->size(), 0);
        if (map < one.size()) one[map] = 1;
        add_blended(*layers.front().weights, one, out.values);
      }
      break;
  }
  return out;
}

std::optional<Field> field_of(const Shape& shape, std::string_view name) {
  const Attribute* found = shape.find(std::string(name));
  if (found == nullptr || !found->per_point() || found->count() != shape.size() || found->components != 1 ||
      (found->kind != Kind::Scalar && found->kind != Kind::Id))
    return std::nullopt;
  Field out;
  out.name = found->name;
  out.values.resize(shape.size());
  for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = static_cast<float>(found->number(i, 0));
  return out;
}

Index strongest_map(const SkinWeights& weights, std::span<const Index> points) {
  std::map<Index, double> sums;
  for (const Index i : points)
    for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
      sums[weights.maps[e]] += static_cast<double>(weights.weights[e]);
  Index best = 0;
  double most = -1;
  for (const auto& [map, sum] : sums)
    if (sum > most) {
      best = map;
      most = sum;
    }
  return best;
}

ValueRange usual_range(std::span<const float> values, Field::Scale scale, bool around_zero) {
  std::vector<float> finite = finite_of(values);
  if (finite.empty()) return {};
  if (scale == Field::Scale::Any && around_zero) {
    const auto [least, most] = std::minmax_element(finite.begin(), finite.end());
    if (*least < 0 && *most > 0) scale = Field::Scale::Signed;
  }
  if (scale == Field::Scale::Signed)
    for (float& value : finite) value = std::abs(value);
  const double high = percentile(finite, 0.99);
  if (scale == Field::Scale::FromZero) return {std::min(0.0, high), high};
  if (scale == Field::Scale::Signed) return {-high, high};
  return {percentile(finite, 0.01), high};
}

ValueRange extent_of(std::span<const float> values) {
  ValueRange out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    out.low = std::min(out.low, static_cast<double>(value));
    out.high = std::max(out.high, static_cast<double>(value));
  }
  return out.low <= out.high ? out : ValueRange{};
}

}  // namespace sinew::document
