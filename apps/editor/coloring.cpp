#include "apps/editor/coloring.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/gpu/colormap.h"

namespace sinew::editor {

namespace {

constexpr gpu::PointColor plain{204, 202, 198, 0};
constexpr std::array<gpu::PointColor, 6> tints{{{206, 203, 198, 0},
                                                {198, 205, 210, 0},
                                                {204, 208, 196, 0},
                                                {211, 200, 197, 0},
                                                {201, 199, 211, 0},
                                                {194, 207, 204, 0}}};

bool can_color(const Shape& shape, const Attribute& attribute) {
  if (!attribute.per_point() || attribute.count() != shape.size()) return false;
  if (attribute.kind == Kind::Color) return attribute.components >= 3;
  return (attribute.kind == Kind::Scalar || attribute.kind == Kind::Id) && attribute.components == 1;
}

/// What stands for full brightness in a colour attribute.
double full_scale(const Attribute& attribute) {
  switch (attribute.type) {
    case Type::UInt8: return 255;
    case Type::UInt16: return 65535;
    default: break;
  }
  double largest = 0;
  for (std::size_t i = 0; i < attribute.count(); ++i)
    for (int c = 0; c < 3; ++c) largest = std::max(largest, attribute.number(i, c));
  return largest > 1 ? 255 : 1;  // written as 0..1 or as 0..255
}

void color_by_colors(const Attribute& attribute, std::vector<gpu::PointColor>& colors) {
  const double scale = 255 / full_scale(attribute);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto channel = [&](int c) {
      const double value = attribute.number(i, c) * scale;
      return static_cast<std::uint8_t>(value > 0 ? std::min(255.0, value) + 0.5 : 0);
    };
    colors[i] = {channel(0), channel(1), channel(2), 0};
  }
}

void color_by_numbers(const Attribute& attribute, Coloring& out) {
  std::vector<double> values;
  values.reserve(attribute.count());
  const std::size_t stride = attribute.count() / 200'000 + 1;
  for (std::size_t i = 0; i < attribute.count(); i += stride)
    if (const double value = attribute.number(i, 0); std::isfinite(value)) values.push_back(value);
  if (values.empty()) return;
  const auto percentile = [&](double part) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  out.low = percentile(0.01);
  out.high = percentile(0.99);
  out.has_range = true;
  const double range = out.high - out.low;
  for (std::size_t i = 0; i < out.colors.size(); ++i) {
    const double value = attribute.number(i, 0);
    if (std::isfinite(value))
      out.colors[i] = gpu::color_at(gpu::Colormap::Viridis, range > 0 ? (value - out.low) / range : 0.5);
  }
}

}  // namespace

std::vector<std::string> color_choices(const Shape& shape) {
  std::vector<std::string> names;
  for (const Attribute& attribute : shape.attributes)
    if (can_color(shape, attribute)) names.push_back(attribute.name);
  return names;
}

Coloring coloring_of(const Shape& shape, const std::string& attribute) {
  Coloring out;
  out.colors.assign(shape.size(), plain);
  for (std::size_t part = 0; part < shape.parts.size(); ++part)
    std::fill_n(out.colors.begin() + shape.parts[part].first, shape.parts[part].count, tints[part % tints.size()]);
  const Attribute* found = attribute.empty() ? nullptr : shape.find(attribute);
  if (found == nullptr || !can_color(shape, *found)) return out;
  if (found->kind == Kind::Color)
    color_by_colors(*found, out.colors);
  else
    color_by_numbers(*found, out);
  return out;
}

Coloring energy_coloring(const Shape& shape, const document::LayerResult& layer) {
  Coloring out = coloring_of(shape, "");
  if (layer.map_energy == nullptr || layer.weights == nullptr || layer.weights->size() != shape.size()) return out;
  Attribute energy;
  energy.type = Type::Float64;
  energy.values.resize(shape.size() * energy.row_size());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    double sum = 0;
    for (std::uint64_t e = layer.weights->offsets[i]; e < layer.weights->offsets[i + 1]; ++e)
      sum += static_cast<double>(layer.weights->weights[e]) * (*layer.map_energy)[layer.weights->maps[e]];
    energy.set_number(i, 0, sum);
  }
  color_by_numbers(energy, out);
  return out;
}

}  // namespace sinew::editor
