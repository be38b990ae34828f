#include "apps/editor/attribute_range.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/parallel.h"

namespace sinew::editor {

namespace {

constexpr std::size_t block = 1 << 16;
constexpr int most_components = 4;  ///< of more nobody knows what each is

bool has_numbers(const Shape& shape, const Attribute& attribute) {
  return attribute.per_point() && attribute.count() == shape.size() && attribute.components <= most_components;
}

std::string choice_of(const Attribute& attribute, int component) {
  if (attribute.components == 1) return attribute.name;
  const auto c = static_cast<std::size_t>(component);
  return attribute.name + "." + (c < attribute.fields.size() ? attribute.fields[c] : std::to_string(c + 1));
}

template <class Number>
std::vector<double> numbers(std::size_t n, const Number& number) {
  std::vector<double> out(n);
  parallel_for(n, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = number(i);
  });
  return out;
}

std::vector<double> values_of(const Shape& shape, const std::string& name) {
  const std::size_t axis = name.size() == 1 ? std::string("xyz").find(name) : std::string::npos;
  const auto a = static_cast<Eigen::Index>(axis);
  if (axis != std::string::npos)
    return numbers(shape.size(), [&](std::size_t i) { return shape.positions[i][a] + shape.origin[a]; });
  for (const Attribute& attribute : shape.attributes)
    for (int c = 0; has_numbers(shape, attribute) && c < attribute.components; ++c)
      if (choice_of(attribute, c) == name)
        return numbers(shape.size(), [&](std::size_t i) { return attribute.number(i, c); });
  return {};
}

/// Of each block, and then of all.
void count(AttributeRange& out, std::size_t bins) {
  const std::vector<double>& values = *out.values;
  const std::size_t blocks = (values.size() + block - 1) / block;
  std::vector<std::pair<double, double>> ends(blocks, {INFINITY, -INFINITY});
  parallel_for(values.size(), block, [&](std::size_t begin, std::size_t end) {
    auto& [least, most] = ends[begin / block];
    for (std::size_t i = begin; i < end; ++i) {
      if (!std::isfinite(values[i])) continue;
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
  });
  std::pair<double, double> all{INFINITY, -INFINITY};
  for (const auto& [least, most] : ends) all = {std::min(all.first, least), std::max(all.second, most)};
  out.bins.assign(bins, 0);
  if (all.first > all.second) return;  // nothing is finite
  out.least = out.low = all.first;
  out.most = out.high = all.second;
  const double width = out.most - out.least, scale = width > 0 ? static_cast<double>(bins) / width : 0;
  std::vector<std::vector<std::uint32_t>> parts(blocks);
  parallel_for(values.size(), block, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t>& part = parts[begin / block];
    part.assign(bins, 0);
    for (std::size_t i = begin; i < end; ++i)
      if (std::isfinite(values[i]))
        ++part[std::min(bins - 1, static_cast<std::size_t>((values[i] - out.least) * scale))];
  });
  for (const std::vector<std::uint32_t>& part : parts)
    for (std::size_t b = 0; b < bins; ++b) out.bins[b] += part[b];
}

}  // namespace

std::vector<std::string> range_choices(const Shape& shape) {
  std::vector<std::string> out{"x", "y", "z"};
  for (const Attribute& attribute : shape.attributes)
    for (int c = 0; has_numbers(shape, attribute) && c < attribute.components; ++c)
      out.push_back(choice_of(attribute, c));
  return out;
}

AttributeRange range_of(const Shape& shape, const std::string& name, std::size_t bins) {
  AttributeRange out;
  out.name = name;
  out.values = std::make_shared<const std::vector<double>>(values_of(shape, name));
  count(out, bins);
  return out;
}

std::string unit_of(const std::string& name) {
  for (const auto& [open, close] : {std::pair('(', ')'), std::pair('[', ']')}) {
    const std::size_t begin = name.rfind(open);
    if (begin != std::string::npos && begin > 0 && name.back() == close)
      return name.substr(begin + 1, name.size() - begin - 2);
  }
  return {};
}

PointSet in_range(const AttributeRange& range) {
  if (range.values == nullptr) return {};
  const std::vector<double>& values = *range.values;
  return set_where(values.size(), [&](std::size_t i) { return values[i] >= range.low && values[i] <= range.high; });
}

}  // namespace sinew::editor
